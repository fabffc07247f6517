#include "test_verify_fixture.h"

static aisle_goal_msg goals[3];

static void usual_world(void) {
    world_begin(-20.0, -20.0, 20.0, 20.0, 0.5F);
    (void)world_box(AISLE_POLYGON_OBSTACLE, 1.0, 1.0, 2.0, 2.0);
    world_build();
    vehicle_box(0.5, 0.5, 0.7, 0.0);
}

// Lines and an arc past the box, with goals 11 and 12 at waypoints 2 and 4 and the last one at the end.
static void usual_path(void) {
    path_begin(-2.0, 0.0, 0.0);
    path_line(1.0);
    path_line(1.0);
    path_arc(-0.5, 0.5);
    path_line(1.0);
    path_line(1.5);
    path_end();
    const int places[3] = {2, 4, 5};
    for (int i = 0; i < 3; i++) {
        aisle_waypoint_msg *w = &path.waypoints[places[i]];
        w->flags |= AISLE_WAYPOINT_GOAL;
        w->goal_id = i < 2 ? 11 + i : GOAL_ID;
        goals[i] = (aisle_goal_msg){.id = w->goal_id, .x = w->x, .y = w->y, .theta = w->theta};
    }
    path_seal();
}

static aisle_verify_request request_of_three(void) {
    aisle_verify_request request = usual_request();
    request.goals = goals;
    request.num_goals = 3;
    return request;
}

static void assert_fault(aisle_verify_fault fault) {
    aisle_verify_request request = request_of_three();
    (void)verify_request(&request, UINT32_MAX);
    TEST_ASSERT_EQUAL(fault, verify.fault);
}

void setUp(void) {
    usual_world();
    usual_path();
    assert_fault(AISLE_VERIFY_NONE);
}
void tearDown(void) {}

// ---- bytes

static void test_every_truncation_is_refused(void) {
    size_t whole = path_size;
    for (path_size = 0; path_size < whole; path_size++) {
        assert_fault(AISLE_VERIFY_DECODE);
    }
}

static void test_bytes_left_over_are_refused(void) {
    path_bytes[path_size++] = 0;
    assert_fault(AISLE_VERIFY_DECODE);
}

static void test_not_a_number_anywhere_is_refused(void) {
    const uint8_t nan_bytes[8] = {0x7F, 0xF8, 0, 0, 0, 0, 0, 0};
    size_t offset = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "waypoints", &offset));
    for (int number = 0; number < 3; number++) { // x, y, theta of the first
        path_seal();
        memcpy(path_bytes + offset + 8 * number, nan_bytes, 8);
        assert_fault(AISLE_VERIFY_DECODE);
    }
    for (int number = 0; number < 6; number++) {
        path_seal();
        memcpy(path_bytes + offset + 24 + 4 * number, nan_bytes, 4);
        assert_fault(AISLE_VERIFY_DECODE);
    }
}

static void test_any_bit_turned_over_is_refused_but_in_the_lease(void) {
    size_t utime = 0, until = 0, refused = 0, passed = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "utime", &utime));
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "valid_until_utime", &until));
    size_t first = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "num_waypoints", &first));
    for (size_t bit = first * 8; bit < path_size * 8; bit++) { // of the waypoints: all are under the certificate
        path_bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
        aisle_verify_request request = request_of_three();
        if (verify_request(&request, UINT32_MAX) == AISLE_OK) {
            passed++;
        } else {
            refused++;
        }
        path_bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
    }
    TEST_ASSERT_EQUAL_size_t(0, passed);
    TEST_ASSERT_EQUAL_size_t((path_size - first) * 8, refused);
    path_bytes[utime + 7] ^= 1U;
    path_bytes[until + 7] ^= 1U;
    assert_fault(AISLE_VERIFY_NONE);
}

static void test_status_and_counts_must_be_those_of_a_path(void) {
    const int8_t fit[2] = {AISLE_PATH_OK, AISLE_PATH_PARTIAL};
    for (int i = 0; i < 2; i++) {
        path.status = fit[i];
        path_seal();
        assert_fault(AISLE_VERIFY_NONE);
    }
    const int8_t unfit[3] = {AISLE_PATH_NONE, -1, 4};
    for (int i = 0; i < 3; i++) {
        path.status = unfit[i];
        path_seal();
        assert_fault(AISLE_VERIFY_DECODE);
    }
    path.status = AISLE_PATH_OK;
    path.num_base = 6;
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    path.num_base = 7;
    path_seal();
    assert_fault(AISLE_VERIFY_DECODE);
    path.num_base = -1;
    path_seal();
    assert_fault(AISLE_VERIFY_DECODE);
    path.num_base = 0;
    path.num_waypoints = 0;
    path_seal();
    aisle_verify_request request = request_of_three();
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DECODE, verify.fault);
}

static void test_figures_of_the_header_make_sense(void) {
    float *figures[4] = {&path.energy, &path.risk, &path.clearance_moving_min, &path.planning_time};
    for (int i = 0; i < 4; i++) {
        *figures[i] = -1.0F;
        path_seal();
        assert_fault(AISLE_VERIFY_DECODE);
        *figures[i] = 0.5F;
        path_seal();
        assert_fault(AISLE_VERIFY_NONE);
    }
    path.risk = 1.5F;
    path_seal();
    assert_fault(AISLE_VERIFY_DECODE);
}

static void test_bytes_that_change_during_the_proof_are_refused(void) {
    aisle_verify_request request = request_of_three();
    aisle_verify_start(&verify, &request, &verify_scratch);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_verify_step(&verify, 3, &spent, &stamp));
    path_bytes[path_size - 1] ^= 1U;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_verify_step(&verify, UINT32_MAX, &spent, &stamp));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_DECODE, verify.fault);
    TEST_ASSERT_EQUAL_UINT32(0, stamp.size);
}

// ---- start, goals

static void test_the_path_begins_at_the_start(void) {
    const aisle_pose2 off[4] = {{2e-6, 0.0, 0.0}, {0.0, -2e-6, 0.0}, {0.0, 0.0, 2e-6}, {5e-7, -5e-7, 2.0 * AISLE_PI}};
    for (int i = 0; i < 4; i++) {
        aisle_verify_request request = request_of_three();
        request.start.x += off[i].x;
        request.start.y += off[i].y;
        request.start.theta += off[i].theta;
        (void)verify_request(&request, UINT32_MAX);
        TEST_ASSERT_EQUAL(i < 3 ? AISLE_VERIFY_START : AISLE_VERIFY_NONE, verify.fault);
    }
}

static void test_goals_are_met_within_their_tolerance(void) {
    goals[1].x += 0.049;
    assert_fault(AISLE_VERIFY_NONE);
    goals[1].x += 0.002;
    assert_fault(AISLE_VERIFY_GOAL);
    TEST_ASSERT_EQUAL_UINT32(4, verify.fault_waypoint);
    goals[1].tolerance_xy = 0.06F;
    assert_fault(AISLE_VERIFY_NONE);
    goals[1].theta += 0.051;
    assert_fault(AISLE_VERIFY_GOAL);
    goals[1].tolerance_theta = 0.06F;
    assert_fault(AISLE_VERIFY_NONE);
    goals[1].theta = goals[1].theta + 3.0;
    goals[1].tolerance_theta = (float)AISLE_PI;
    assert_fault(AISLE_VERIFY_NONE);
}

static void test_goals_come_in_order_and_all(void) {
    aisle_goal_msg swap = goals[0];
    goals[0] = goals[1];
    goals[1] = swap;
    assert_fault(AISLE_VERIFY_GOAL);
    usual_path();
    goals[0].id = 99; // the right place by another name
    assert_fault(AISLE_VERIFY_GOAL);
    usual_path();
    path.waypoints[5].goal_id = path.waypoints[4].goal_id; // ends one goal early
    path.waypoints[4].goal_id = path.waypoints[2].goal_id;
    path.waypoints[2].flags = 0;
    for (int i = 0; i < 2; i++) {
        const aisle_waypoint_msg *w = &path.waypoints[4 + i];
        goals[i] = (aisle_goal_msg){.id = w->goal_id, .x = w->x, .y = w->y, .theta = w->theta};
    }
    path_seal();
    assert_fault(AISLE_VERIFY_GOAL);
    TEST_ASSERT_EQUAL_UINT32(5, verify.fault_waypoint);
    usual_path();
    path.waypoints[2].flags = 0; // passes the first unseen
    path_seal();
    assert_fault(AISLE_VERIFY_GOAL);
    usual_path();
    path.waypoints[5].flags &= (int16_t)~AISLE_WAYPOINT_GOAL; // never says it arrived
    path_seal();
    assert_fault(AISLE_VERIFY_GOAL);
    path.status = AISLE_PATH_PARTIAL;
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
}

static void test_more_goals_than_asked_and_none_at_all_are_refused(void) {
    aisle_verify_request request = request_of_three();
    request.num_goals = 2;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_GOAL, verify.fault);
    for (int i = 0; i < path.num_waypoints; i++) {
        path.waypoints[i].flags &= (int16_t)~AISLE_WAYPOINT_GOAL;
    }
    path_seal();
    request = request_of_three();
    request.num_goals = 0;
    request.goals = NULL;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_GOAL, verify.fault);
    path.status = AISLE_PATH_PARTIAL;
    path_seal();
    request = request_of_three();
    request.num_goals = 0;
    request.goals = NULL;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
}

static void test_the_last_goal_is_at_the_last_waypoint(void) {
    path_begin(0.0, 0.0, 0.0);
    path_line(1.0);
    path_line(1.0);
    path_end();
    path.waypoints[1].flags |= AISLE_WAYPOINT_GOAL;
    path.waypoints[1].goal_id = GOAL_ID;
    path.waypoints[2].flags = 0;
    path_goal.x = path.waypoints[1].x;
    path_seal();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_GOAL, verified());
    TEST_ASSERT_EQUAL_UINT32(2, verify.fault_waypoint);
}

static void test_a_goal_with_dwell_is_a_stop(void) {
    path_drive(0.3);
    assert_fault(AISLE_VERIFY_NONE);
    goals[1].dwell = 1.0F;
    assert_fault(AISLE_VERIFY_REST);
    TEST_ASSERT_EQUAL_UINT32(4, verify.fault_waypoint);
}

// ---- sums, certificate

static void test_sums_fit_the_waypoints(void) {
    float *sums[2] = {&path.length, &path.duration};
    for (int i = 0; i < 2; i++) {
        float was = *sums[i];
        *sums[i] = was * 1.0005F;
        path_seal();
        assert_fault(AISLE_VERIFY_SUMS);
        *sums[i] = was * 1.00001F;
        path_seal();
        assert_fault(AISLE_VERIFY_NONE);
        *sums[i] = was;
    }
    path.length_bound = path.length;
    path_seal();
    assert_fault(AISLE_VERIFY_NONE);
    path.length_bound = path.length * 1.0001F;
    path_seal();
    assert_fault(AISLE_VERIFY_SUMS);
}

static void test_certificate_and_revisions_are_those_proved_against(void) {
    path.certificate ^= 1;
    size_t size = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_encode(AISLE_MSG_PATH, &path, path_bytes, sizeof path_bytes, &size));
    assert_fault(AISLE_VERIFY_CERTIFICATE);
    path_seal();
    world_msg.map_revision++; // another one than the layout in force
    path_seal();
    assert_fault(AISLE_VERIFY_CERTIFICATE);
    world_msg.map_revision--;
    world_msg.map_id++;
    path_seal();
    assert_fault(AISLE_VERIFY_CERTIFICATE);
    world_msg.map_id--;
    path_seal();
    vehicle.revision++;
    assert_fault(AISLE_VERIFY_CERTIFICATE);
}

static void test_a_layout_that_changes_during_the_proof_ends_it(void) {
    aisle_verify_request request = request_of_three();
    aisle_verify_start(&verify, &request, &verify_scratch);
    TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_verify_step(&verify, 3, &spent, &stamp));
    aisle_refusal why;
    world_msg.map_revision++;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&world, &world_msg, &why));
    aisle_layout_commit(&world);
    while (aisle_layout_build(&world, 100000) == AISLE_BUSY) {
    }
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_verify_step(&verify, UINT32_MAX, &spent, &stamp));
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CERTIFICATE, verify.fault);
    TEST_ASSERT_EQUAL_UINT32(0, stamp.size);
}

// ---- slices

typedef struct outcome { // no padding: compared as memory
    int64_t calls;
    aisle_stamp stamp;
    aisle_verify_fault fault;
    uint32_t waypoint, intervals, spent, support_max;
    int32_t id;
} outcome;

static outcome outcome_in_steps_of(uint32_t units) {
    aisle_verify_request request = usual_request();
    (void)verify_request(&request, units);
    return (outcome){.calls = verify.collide.calls,
                     .stamp = stamp,
                     .fault = verify.fault,
                     .waypoint = verify.fault_waypoint,
                     .intervals = verify.intervals,
                     .spent = spent,
                     .support_max = verify.collide.support_max,
                     .id = verify.fault_id};
}

static void assert_same_in_any_slices(void) {
    const outcome whole = outcome_in_steps_of(UINT32_MAX);
    for (uint32_t units = 1; units < 30; units++) {
        const outcome sliced = outcome_in_steps_of(units);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &sliced, sizeof whole);
    }
}

static void test_any_slicing_gives_the_same_answer_and_counts(void) {
    path_begin(0.0, 0.2, 0.0);
    path_line(0.5);
    path_arc(1.0, 0.7);
    path_line(2.0);
    path_end();
    assert_same_in_any_slices(); // into the box
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verify.fault);
    path_begin(0.0, 0.4, 0.0);
    path_line(3.0);
    path_turn(2.0);
    path_end();
    vehicle.margin = 0.2;
    assert_same_in_any_slices(); // past it, with many intervals
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verify.fault);
    path.waypoints[1].v = 1.0F;
    path_seal();
    assert_same_in_any_slices(); // never gets to the motion
    TEST_ASSERT_EQUAL_UINT32(0, verify.intervals);
}

static void test_the_answer_is_repeated_and_costs_nothing(void) {
    aisle_verify_request request = request_of_three();
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, 1));
    aisle_stamp first = stamp;
    uint32_t more = 0;
    stamp = (aisle_stamp){0, 0};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_verify_step(&verify, 5, &more, &stamp));
    TEST_ASSERT_EQUAL_UINT32(0, more);
    TEST_ASSERT_EQUAL_MEMORY(&first, &stamp, sizeof first);
    request.start.x += 1.0;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, verify_request(&request, 1));
    stamp = first;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_verify_step(&verify, 5, &more, &stamp));
    TEST_ASSERT_EQUAL_UINT32(0, stamp.size);
}

// ---- proved once, shown again

static aisle_proof_basis basis;

// Proves the path and gives it a new head.
static aisle_verify_request proved_once(void) {
    aisle_verify_request request = request_of_three();
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    basis = *aisle_verify_basis(&verify);
    path.query_id = 99;
    path.cached = 1;
    path.work_units = 5;
    aisle_path_rehead(path_bytes, &path, basis.waypoints);
    request.basis = &basis;
    return request;
}

static bool is_taken_on_trust(const aisle_verify_request *request) {
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(request, 1));
    return verify.intervals == 0;
}

static void test_a_path_shown_with_the_basis_of_its_proof_is_proved_at_once(void) {
    aisle_verify_request request = proved_once();
    aisle_event event;
    TEST_ASSERT_TRUE(is_taken_on_trust(&request));
    TEST_ASSERT_EQUAL_UINT32(1, spent);
    TEST_ASSERT_EQUAL_MEMORY(&basis, aisle_verify_basis(&verify), sizeof basis);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release(AISLE_EVENT_REPLY, path_bytes, path_size, &stamp, NULL, &event));
    request.basis = NULL;
    TEST_ASSERT_FALSE(is_taken_on_trust(&request));
}

static void test_a_basis_of_anything_else_spares_nothing(void) {
    aisle_verify_request request = proved_once();
    const aisle_proof_basis right = basis;
    for (int i = 0; i < 6; i++) {
        basis = right;
        basis.path ^= i == 0 ? 1U : 0U;
        basis.given ^= i == 1 ? 1U : 0U;
        basis.layout ^= i == 2 ? 1U : 0U;
        basis.map_id += i == 3;
        basis.map_revision += i == 4;
        basis.size += i == 5;
        TEST_ASSERT_FALSE(is_taken_on_trust(&request));
    }
    basis = right;
    basis.waypoints ^= 1U; // the certificate is not the one it would have
    TEST_ASSERT_FALSE(is_taken_on_trust(&request));
}

static void test_a_changed_input_is_proved_anew(void) {
    aisle_verify_request request = proved_once();
    request.start.x += 1e-8;
    TEST_ASSERT_FALSE(is_taken_on_trust(&request));
    request.start.x -= 1e-8;
    goals[1].tolerance_xy = 0.06F;
    TEST_ASSERT_FALSE(is_taken_on_trust(&request));
    goals[1].tolerance_xy = 0.0F;
    vehicle.v_max += 1e-6;
    TEST_ASSERT_FALSE(is_taken_on_trust(&request));
    vehicle.v_max -= 1e-6;
    goals[2].x += 1.0;
    (void)verify_request(&request, UINT32_MAX);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_GOAL, verify.fault);
    goals[2].x -= 1.0;
    vehicle.margin = 1.0;
    (void)verify_request(&request, UINT32_MAX);
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verify.fault);
}

// Though the basis would let it pass: revisions and certificate are looked at again.
static void test_a_basis_excuses_no_wrong_revision(void) {
    aisle_verify_request request = proved_once();
    const int32_t map_id = path.map_id, map_revision = path.map_revision, vehicle_revision = path.vehicle_revision;
    for (int i = 0; i < 3; i++) {
        path.map_id = map_id + (i == 0);
        path.map_revision = map_revision + (i == 1);
        path.vehicle_revision = vehicle_revision + (i == 2);
        aisle_path_rehead(path_bytes, &path, basis.waypoints);
        (void)verify_request(&request, UINT32_MAX);
        TEST_ASSERT_EQUAL(AISLE_VERIFY_CERTIFICATE, verify.fault);
    }
    path.map_id = map_id;
    path.map_revision = map_revision;
    path.vehicle_revision = vehicle_revision;
    aisle_path_rehead(path_bytes, &path, basis.waypoints);
    TEST_ASSERT_TRUE(is_taken_on_trust(&request));
}

static void test_any_bit_turned_over_is_refused_whatever_the_basis(void) {
    aisle_verify_request request = proved_once();
    for (size_t i = 0; i < path_size; i++) {
        bool lease = (i >= AISLE_PATH_AT_UTIME && i < AISLE_PATH_AT_UTIME + 8) ||
                     (i >= AISLE_PATH_AT_VALID_UNTIL_UTIME && i < AISLE_PATH_AT_VALID_UNTIL_UTIME + 8) ||
                     (i >= AISLE_PATH_AT_WORK_UNITS && i < AISLE_PATH_AT_WORK_UNITS + 4);
        path_bytes[i] ^= 0x04U;
        aisle_status st = verify_request(&request, UINT32_MAX);
        if (i >= AISLE_PATH_AT_WAYPOINTS) {
            TEST_ASSERT_EQUAL(AISLE_ERR_DATA, st);
        } else if (st == AISLE_OK && !lease) {
            TEST_ASSERT_TRUE(verify.intervals > 0 || i < AISLE_PATH_AT_STATUS); // by the whole proof, or an id
        }
        path_bytes[i] ^= 0x04U;
    }
}

// ---- pieces known

static aisle_verify_known known[AISLE_PATH_MAX_WAYPOINTS];

// Intervals looked at; the verdict is that of a proof that knows nothing.
static uint32_t looks_with_known(void) {
    aisle_verify_request request = request_of_three();
    (void)verify_request(&request, UINT32_MAX);
    const aisle_verify anew = verify;
    const uint64_t digest = stamp.digest;
    request.known = known;
    (void)verify_request(&request, 7);
    TEST_ASSERT_EQUAL(anew.fault, verify.fault);
    TEST_ASSERT_EQUAL_UINT32(anew.fault_waypoint, verify.fault_waypoint);
    TEST_ASSERT_EQUAL_INT32(anew.fault_id, verify.fault_id);
    TEST_ASSERT_EQUAL_UINT64(digest, stamp.digest);
    return verify.intervals;
}

static void knows_the_usual_path(void) {
    memset(known, 0, sizeof known);
    TEST_ASSERT_GREATER_THAN_UINT32(4, looks_with_known());
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
}

static void test_pieces_known_are_not_looked_at_again(void) {
    knows_the_usual_path();
    path.goal_list_id++; // another message
    path_seal();
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
}

static void test_a_path_that_begins_later_knows_its_pieces(void) {
    knows_the_usual_path();
    memmove(&path.waypoints[0], &path.waypoints[1], 5 * sizeof path.waypoints[0]);
    path.num_waypoints--;
    path_retime(0.5 * vehicle.creep_speed);
    path_seal();
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
}

static void test_a_piece_of_another_curve_is_looked_at(void) {
    knows_the_usual_path();
    for (int i = 0; i < 6; i++) { // each waypoint in turn, by less than any check minds
        usual_path();
        path.waypoints[i].x += 1e-9;
        path_seal();
        TEST_ASSERT_GREATER_THAN_UINT32(0, looks_with_known());
        TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verify.fault);
        usual_path();
        (void)looks_with_known();
    }
}

static void test_other_ground_and_another_vehicle_know_nothing(void) {
    knows_the_usual_path();
    const double margin = vehicle.margin;
    vehicle.margin = 1.0;
    TEST_ASSERT_GREATER_THAN_UINT32(0, looks_with_known());
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verify.fault);
    vehicle.margin = margin;
    (void)looks_with_known();
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
    world_begin(-20.0, -20.0, 20.0, 20.0, 0.5F);
    (void)world_box(AISLE_POLYGON_OBSTACLE, 0.0, 0.3, 2.0, 2.0);
    world_build();
    TEST_ASSERT_GREATER_THAN_UINT32(0, looks_with_known());
    TEST_ASSERT_EQUAL(AISLE_VERIFY_COLLISION, verify.fault);
}

static void test_a_piece_is_known_no_faster_than_it_was_proved(void) {
    vehicle.creep_clearance = 1.0; // slow beside the box
    knows_the_usual_path();
    path_drive(0.5 * vehicle.creep_speed);
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
    path_drive(2.0 * vehicle.creep_speed);
    (void)looks_with_known();
    TEST_ASSERT_EQUAL(AISLE_VERIFY_CREEP, verify.fault);
}

static void test_who_looks_anew_learns_and_asks_nothing(void) {
    memset(known, 0, sizeof known);
    aisle_verify_request request = request_of_three();
    request.known = known;
    request.looks_anew = true;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    const uint32_t all = verify.intervals, units = spent;
    TEST_ASSERT_EQUAL(AISLE_OK, verify_request(&request, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(all, verify.intervals);
    TEST_ASSERT_EQUAL_UINT32(units, spent);
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
}

static void test_a_path_that_ends_elsewhere_leaves_what_is_known(void) {
    knows_the_usual_path();
    const int16_t n = path.num_waypoints;
    path.status = AISLE_PATH_PARTIAL;
    path.num_waypoints = 3; // to the first goal
    path.waypoints[2].flags |= AISLE_WAYPOINT_STOP;
    path_retime(vehicle.creep_speed);
    path_seal();
    TEST_ASSERT_GREATER_THAN_UINT32(0, looks_with_known());
    TEST_ASSERT_EQUAL(AISLE_VERIFY_NONE, verify.fault);
    path.status = AISLE_PATH_OK;
    path.num_waypoints = n;
    usual_path();
    TEST_ASSERT_EQUAL_UINT32(0, looks_with_known());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_pieces_known_are_not_looked_at_again);
    RUN_TEST(test_a_path_that_begins_later_knows_its_pieces);
    RUN_TEST(test_a_piece_of_another_curve_is_looked_at);
    RUN_TEST(test_other_ground_and_another_vehicle_know_nothing);
    RUN_TEST(test_a_piece_is_known_no_faster_than_it_was_proved);
    RUN_TEST(test_who_looks_anew_learns_and_asks_nothing);
    RUN_TEST(test_a_path_that_ends_elsewhere_leaves_what_is_known);
    RUN_TEST(test_a_path_shown_with_the_basis_of_its_proof_is_proved_at_once);
    RUN_TEST(test_a_basis_of_anything_else_spares_nothing);
    RUN_TEST(test_a_changed_input_is_proved_anew);
    RUN_TEST(test_a_basis_excuses_no_wrong_revision);
    RUN_TEST(test_any_bit_turned_over_is_refused_whatever_the_basis);
    RUN_TEST(test_every_truncation_is_refused);
    RUN_TEST(test_bytes_left_over_are_refused);
    RUN_TEST(test_not_a_number_anywhere_is_refused);
    RUN_TEST(test_any_bit_turned_over_is_refused_but_in_the_lease);
    RUN_TEST(test_status_and_counts_must_be_those_of_a_path);
    RUN_TEST(test_figures_of_the_header_make_sense);
    RUN_TEST(test_bytes_that_change_during_the_proof_are_refused);
    RUN_TEST(test_the_path_begins_at_the_start);
    RUN_TEST(test_goals_are_met_within_their_tolerance);
    RUN_TEST(test_goals_come_in_order_and_all);
    RUN_TEST(test_more_goals_than_asked_and_none_at_all_are_refused);
    RUN_TEST(test_the_last_goal_is_at_the_last_waypoint);
    RUN_TEST(test_a_goal_with_dwell_is_a_stop);
    RUN_TEST(test_sums_fit_the_waypoints);
    RUN_TEST(test_certificate_and_revisions_are_those_proved_against);
    RUN_TEST(test_a_layout_that_changes_during_the_proof_ends_it);
    RUN_TEST(test_any_slicing_gives_the_same_answer_and_counts);
    RUN_TEST(test_the_answer_is_repeated_and_costs_nothing);
    return UNITY_END();
}
