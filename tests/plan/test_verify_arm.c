#include "plan/verify_arm.h" // first: proves that the header stands alone

#include "arm_door.h"
#include "hall.h"
#include "plan/arm_world.h"

// Motions come from the planner's door; the verifier is then shown them, and spoiled ones, on a layout of its own.

static aisle_arm arm;
static aisle_vehicle vehicle;
static aisle_verify_arm verify;
static aisle_arm_path_msg decoded;
static aisle_stamp stamp;

static void open_layout(void) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    aisle_refusal why;
    memset(&hall_layout, 0, sizeof hall_layout);
    aisle_layout_carve(&hall_layout, &arena, &hall_limits);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_layout_take_part(&hall_layout, &door_layout, &why));
    aisle_layout_commit(&hall_layout);
    while (aisle_layout_build(&hall_layout, 1000) == AISLE_BUSY) {
    }
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_arm_from_msg(&door_vehicle, &arm, &why));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&door_vehicle, &vehicle, &why));
}

void setUp(void) {
    door_prepare();
    door_box(6.2, 4.95, 6.4, 5.05);
    door_goal.kind = AISLE_ARM_GOAL_JOINTS;
    door_goal.q[0] = 0.8F;
    door_open();
    door_ask(100000);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_OK, door_path.status);
    open_layout();
}
void tearDown(void) {}

static aisle_status prove(uint32_t units) {
    uint32_t spent = 0;
    const aisle_verify_arm_request request = {.layout = &hall_layout,
                                              .vehicle = &vehicle,
                                              .arm = &arm,
                                              .pose = {5.0, 5.0, 0.0},
                                              .goal = &door_goal,
                                              .bytes = door_bytes,
                                              .size = door_size};
    aisle_verify_arm_start(&verify, &request, &decoded);
    aisle_status st;
    do {
        st = aisle_verify_arm_step(&verify, units, &spent, &stamp);
    } while (st == AISLE_BUSY);
    return st;
}

// The spoiled door_path, encoded, is refused for this.
static void assert_fault(aisle_verify_arm_fault fault) {
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, prove(1000));
    TEST_ASSERT_EQUAL(fault, verify.fault);
    TEST_ASSERT_EQUAL_UINT32(0, stamp.size);
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(door_bytes, door_size, &stamp, &(aisle_event){.size = 0}));
}

static void test_what_the_planner_sends_is_proved_however_it_is_cut(void) {
    static const uint32_t units[] = {1, 7, UINT32_MAX};
    uint32_t intervals = 0;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, prove(units[i]));
        TEST_ASSERT_EQUAL_UINT32(door_size, stamp.size);
        TEST_ASSERT_TRUE(i == 0 || intervals == verify.intervals);
        intervals = verify.intervals;
        TEST_ASSERT_EQUAL_INT64(0, verify.collide.unfit);
    }
}
static void test_only_proved_bytes_and_refusals_leave(void) {
    aisle_event event;
    TEST_ASSERT_EQUAL(AISLE_OK, prove(1000));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release_arm(door_bytes, door_size, &stamp, &event));
    TEST_ASSERT_EQUAL(AISLE_EVENT_ARM_PATH, event.kind);
    door_bytes[door_size - 1U] ^= 1U;
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(door_bytes, door_size, &stamp, &event));
    door_path.status = AISLE_PATH_NONE;
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_release_arm(door_bytes, door_size, NULL, &event));
    door_path.num_waypoints = 0;
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_release_arm(door_bytes, door_size, NULL, &event));
}
static void run_faster(double factor) { // the same curve in less time
    for (int16_t i = 0; i < door_path.num_waypoints; i++) {
        aisle_arm_waypoint_msg *w = &door_path.waypoints[i];
        w->t = (float)((double)w->t / factor);
        for (int j = 0; j < 3; j++) {
            w->qd[j] = (float)((double)w->qd[j] * factor);
            w->qdd[j] = (float)((double)w->qdd[j] * factor * factor);
            w->torque[j] = (float)((double)w->torque[j] * factor * factor);
        }
    }
    door_path.duration = door_path.waypoints[door_path.num_waypoints - 1].t;
}
static void test_three_thousandths_faster_is_over_a_limit(void) { // as far as the planner's own reserve may go
    run_faster(1.003);
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, prove(1000));
    TEST_ASSERT_TRUE(verify.fault >= AISLE_VERIFY_ARM_VELOCITY && verify.fault <= AISLE_VERIFY_ARM_TORQUE);
}
static void test_each_limit_is_looked_at_by_itself(void) {
    const aisle_arm kept = arm;
    for (uint32_t j = 0; j < 3U; j++) {
        arm.v_max[j] = 0.01;
        assert_fault(AISLE_VERIFY_ARM_VELOCITY);
        arm = kept;
        arm.a_max[j] = 0.01;
        assert_fault(AISLE_VERIFY_ARM_ACCELERATION);
        arm = kept;
        arm.j_max[j] = 0.01;
        assert_fault(AISLE_VERIFY_ARM_JERK);
        arm = kept;
    }
    float most = 0.0F;
    for (int16_t i = 0; i < door_path.num_waypoints; i++) {
        most = fmaxf(most, fabsf(door_path.waypoints[i].torque[0]));
    }
    arm.torque_max[0] = 0.99 * (double)most;
    assert_fault(AISLE_VERIFY_ARM_TORQUE);
    arm = kept;
    arm.max[0] = 0.7;
    assert_fault(AISLE_VERIFY_ARM_JOINT);
}
static void test_a_box_on_the_way_is_found_by_its_id_and_one_beside_it_is_not(void) {
    for (int k = 0; k < 60; k++) { // all along the way of the tip
        const aisle_arm_waypoint_msg *w = &door_path.waypoints[(k * door_path.num_waypoints) / 60];
        const double q[3] = {(double)w->q[0], (double)w->q[1], (double)w->q[2]};
        aisle_vec2 p[4];
        (void)aisle_arm_place(&arm, (aisle_pose2){5.5, 5.0, 0.0}, q, p);
        door_layout.num_polygons = 1;
        door_box(p[3].x - 0.005, p[3].y - 0.005, p[3].x + 0.005, p[3].y + 0.005);
        door_layout.total_polygons = 2;
        door_layout.crc32 = (int32_t)aisle_layout_crc32(0, &door_layout);
        open_layout();
        assert_fault(AISLE_VERIFY_ARM_CONTACT);
        TEST_ASSERT_EQUAL_INT32(2, verify.fault_id);
    }
    door_layout.num_polygons = 1;
    door_box(1.0, 1.0, 2.0, 2.0);
    door_layout.crc32 = (int32_t)aisle_layout_crc32(0, &door_layout);
    open_layout();
    TEST_ASSERT_EQUAL(AISLE_OK, prove(1000));
}
static void test_a_wider_link_touches(void) {
    arm.radius[0] = arm.radius[1] = arm.radius[2] = 0.3;
    arm.torque_max[0] = arm.torque_max[1] = arm.torque_max[2] = 1e6; // what is told of them will do
    assert_fault(AISLE_VERIFY_ARM_CONTACT);
}
static void test_ends_ids_sums_and_numbers_told_must_fit(void) {
    const aisle_arm_path_msg *kept = &door_path;
    static aisle_arm_path_msg good;
    good = *kept;
    const int16_t last = (int16_t)(good.num_waypoints - 1);
    door_path.map_revision = 2;
    assert_fault(AISLE_VERIFY_ARM_DECODE);
    door_path = good;
    door_path.vehicle_revision = 9;
    assert_fault(AISLE_VERIFY_ARM_DECODE);
    door_path = good;
    door_path.clearance_min *= 0.5F;
    assert_fault(AISLE_VERIFY_ARM_DECODE);
    door_path = good;
    door_path.duration += 0.1F;
    assert_fault(AISLE_VERIFY_ARM_DECODE);
    door_path = good;
    door_path.waypoints[0].q[1] += 1e-5F;
    assert_fault(AISLE_VERIFY_ARM_START);
    door_path = good;
    door_path.waypoints[last].q[2] += 0.01F;
    assert_fault(AISLE_VERIFY_ARM_GOAL);
    door_path = good;
    door_path.waypoints[last].qd[2] = 0.01F;
    assert_fault(AISLE_VERIFY_ARM_REST);
    door_path = good;
    door_path.waypoints[1].t = 0.0F;
    assert_fault(AISLE_VERIFY_ARM_TIME);
    door_path = good;
    door_path.waypoints[1].torque[0] += 1.0F;
    assert_fault(AISLE_VERIFY_ARM_TORQUE);
    door_path = good;
}
static void test_a_jump_in_between_is_over_a_limit(void) {
    door_path.waypoints[door_path.num_waypoints / 2].q[0] += 0.02F;
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_msg_encode(AISLE_MSG_ARM_PATH, &door_path, door_bytes, sizeof door_bytes, &door_size));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, prove(1000));
    TEST_ASSERT_TRUE(verify.fault >= AISLE_VERIFY_ARM_VELOCITY && verify.fault <= AISLE_VERIFY_ARM_TORQUE);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_what_the_planner_sends_is_proved_however_it_is_cut);
    RUN_TEST(test_only_proved_bytes_and_refusals_leave);
    RUN_TEST(test_three_thousandths_faster_is_over_a_limit);
    RUN_TEST(test_each_limit_is_looked_at_by_itself);
    RUN_TEST(test_a_box_on_the_way_is_found_by_its_id_and_one_beside_it_is_not);
    RUN_TEST(test_a_wider_link_touches);
    RUN_TEST(test_ends_ids_sums_and_numbers_told_must_fit);
    RUN_TEST(test_a_jump_in_between_is_over_a_limit);
    return UNITY_END();
}
