// Goal lists while driving, through the public door, with a vehicle that follows what it is sent.
#include "aisle/planner.h"

#include "door.h"
#include "robot/motion.h"

static aisle_pose_msg here;
static aisle_goal_list_msg list;
static float dwell[AISLE_PATH_MAX_WAYPOINTS]; // of the path out, by waypoint
static int32_t ids[AISLE_GOAL_LIST_MAX_GOALS];

// 12 x 8 m, a pillar (id 1) in the middle, a disc of 0.3 m at (1, 1).
static void open_door(bool skips) {
    door_config = (aisle_config){
        .limits = {.cells = 65536U, .requests = 4U}, .boot_id = 77, .has_vehicle = true, .skip_unreachable = skips};
    door_config.vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .footprint_radius = 0.3F, .margin = 0.1F};
    hall_disc(0.3, 0.1F);
    door_open(0);
    here = door_pose(1.0, 1.0, 0.0);
}

static void build_hall(int32_t revision) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(revision));
    door_settle();
}

void setUp(void) {
    open_door(false);
    hall_begin(12.0, 8.0);
    hall_add(5.0, 3.0, 7.0, 5.0);
    build_hall(1);
}
void tearDown(void) {}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

static int32_t next_goal(void) {
    return status_now().goal_id;
}

static void begin_list(int32_t revision) {
    list = door_goals(revision, 0.0, 0.0);
    list.options.objective = AISLE_OPTIONS_SHORTEST;
    list.num_goals = 0;
}

static aisle_goal_msg *add(int32_t id, double x, double y) {
    aisle_goal_msg *goal = &list.goals[list.num_goals++];
    *goal = (aisle_goal_msg){.id = id, .x = x, .y = y, .tolerance_theta = 4.0F};
    return goal;
}

static void send_list(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &list));
    door_settle();
}

static aisle_status command(int8_t which, int32_t arg, int32_t id) {
    aisle_command_msg msg = {.command = which, .command_id = id, .arg = arg};
    aisle_status st = door_submit(AISLE_INPUT_COMMAND, &msg);
    door_settle();
    return st;
}

// ---- the vehicle

static void look_up_dwells(void) {
    for (int16_t i = 0; i < door_path.num_waypoints; i++) {
        dwell[i] = 0.0F;
        for (int16_t k = 0; k < list.num_goals && (door_path.waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0; k++) {
            if (list.goals[k].id == door_path.waypoints[i].goal_id) {
                dwell[i] = list.goals[k].dwell;
            }
        }
    }
}

// 50 ms on along what is out and leased, or at rest.
static void move(void) {
    door_now += 50000;
    here.vx = here.omega = 0.0F;
    if (door_path.status != AISLE_PATH_NONE && door_path.num_waypoints > 0 && door_now <= door_path.valid_until_utime) {
        const aisle_waypoint_msg *w = door_path.waypoints;
        const uint32_t n = (uint32_t)(uint16_t)door_path.num_waypoints;
        look_up_dwells();
        const double t = (double)(door_now - door_path.t0_utime) * 1e-6;
        const aisle_place place = aisle_motion_at_time(&hall_vehicle, w, n, dwell, t);
        const aisle_pose2 pose = aisle_motion_pose(w, n, place);
        here.vx = (float)aisle_motion_speed(&hall_vehicle, w, n, dwell, place);
        here.omega = (float)(remainder(pose.theta - here.theta, 2.0 * DOOR_PI) / 0.05);
        here.x = pose.x;
        here.y = pose.y;
        here.theta = pose.theta;
    }
    here.utime = door_now;
    here.seq++;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
}

static void follow(void) {
    move();
    door_settle();
}

static void drive(double seconds) {
    for (int64_t end = door_now + (int64_t)(seconds * 1e6); door_now < end;) {
        follow();
    }
}

// Until another goal is next (0: none); the seconds it took.
static double drive_until(int32_t goal) {
    const int64_t begin = door_now;
    while (next_goal() != goal) {
        follow();
        TEST_ASSERT_LESS_THAN_INT64(120000000, door_now - begin);
    }
    return (double)(door_now - begin) * 1e-6;
}

static void start_list(void) {
    door_now += 50000;
    here.utime = door_now;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    send_list();
}

// The path out passes these goals in this order.
static void passes(int n, const int32_t *expected) {
    int count = 0;
    door_judge(&door_path);
    for (int16_t i = 0; i < door_path.num_waypoints; i++) {
        if ((door_path.waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0) {
            TEST_ASSERT_LESS_THAN_INT(AISLE_GOAL_LIST_MAX_GOALS, count);
            ids[count++] = door_path.waypoints[i].goal_id;
        }
    }
    TEST_ASSERT_EQUAL_INT(n, count);
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, ids, n);
}

#define IDS(...)                                                                                                       \
    (int)(sizeof((const int32_t[]){__VA_ARGS__}) / sizeof(int32_t)), (const int32_t[]) {                               \
        __VA_ARGS__                                                                                                    \
    }

static void is_finished(void) {
    const aisle_status_msg status = status_now();
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status.state);
    TEST_ASSERT_EQUAL_INT32(0, status.goal_id);
    TEST_ASSERT_EQUAL_INT32(list.goal_list_id, status.goal_list_id); // which tells it from one that was cancelled
    TEST_ASSERT_EQUAL_INT32(list.goal_list_revision, status.goal_list_revision);
}

static void is_at(double x, double y) {
    TEST_ASSERT_DOUBLE_WITHIN(0.06, x, here.x);
    TEST_ASSERT_DOUBLE_WITHIN(0.06, y, here.y);
}

static void refused_with(int16_t cause, int32_t goal) {
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(cause, door_path.cause);
    TEST_ASSERT_GREATER_OR_EQUAL_INT16(1, door_path.num_waypoints);
    TEST_ASSERT_EQUAL_INT32(goal, door_path.waypoints[0].goal_id);
}

// ---- arriving

static void test_goals_are_reached_in_turn_on_one_path(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    (void)add(13, 10.0, 6.0);
    start_list();
    passes(IDS(11, 12, 13));
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    const int32_t revision = door_path.path_revision;
    (void)drive_until(12);
    is_at(4.0, 1.0);
    (void)drive_until(13);
    is_at(9.0, 1.0);
    TEST_ASSERT_EQUAL_INT32(revision, door_path.path_revision); // nothing was planned anew
    (void)drive_until(0);
    is_at(10.0, 6.0);
    is_finished();
}

static void test_a_goal_is_left_when_its_dwell_is_over(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 6.0, 1.0);
    start_list();
    const double way = drive_until(12);
    drive(0.5);
    (void)drive_until(0);
    setUp();
    list.goals[0].dwell = 3.0F;
    start_list();
    const double with_dwell = drive_until(12);
    TEST_ASSERT_DOUBLE_WITHIN(0.11, way + 3.0, with_dwell);
    is_at(4.0, 1.0);
    drive(0.5);
    TEST_ASSERT_TRUE(here.x > 4.01); // it goes on
    (void)drive_until(0);
    is_finished();
}

static void test_the_last_goals_dwell_is_waited_for_too(void) {
    begin_list(1);
    add(11, 4.0, 1.0)->dwell = 2.0F;
    start_list();
    while (hypot(here.x - 4.0, here.y - 1.0) > 0.001 || (double)here.vx > 0.001) {
        follow();
    }
    drive(1.8);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    TEST_ASSERT_EQUAL(AISLE_STATUS_ACTIVE, status_now().state);
    drive(0.3);
    is_finished();
}

static void test_a_pose_that_cannot_be_trusted_breaks_the_dwell(void) {
    begin_list(1);
    add(11, 1.0, 1.0)->dwell = 2.0F;
    start_list();
    drive(1.5);
    here.localized = 0;
    follow();
    here.localized = 1;
    drive(1.9);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    drive(0.3);
    is_finished();
}

static void test_a_pose_on_another_map_counts_for_nothing(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    start_list();
    here.map_id = 9;
    here.x = 4.0;
    door_wait(500000, &here);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
}

static void test_a_heading_is_part_of_arriving(void) {
    begin_list(1);
    add(11, 3.0, 1.0)->theta = 2.0;
    list.goals[0].tolerance_theta = 0.1F;
    start_list();
    (void)drive_until(0);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 0.0, remainder(here.theta - 2.0, 2.0 * DOOR_PI));
}

static void test_whoever_is_close_enough_has_arrived_by_the_goals_own_tolerance(void) {
    begin_list(1);
    add(11, 3.0, 1.0)->tolerance_xy = 2.1F;
    start_list();
    door_wait(50000, &here);
    is_finished(); // it stood there when the path was found
}

// ---- a list replaced or extended under way

static void test_a_list_extended_under_way_goes_on_without_a_stop_at_the_beginning(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    start_list();
    (void)drive_until(12);
    drive(2.0);
    list.goal_list_revision = 2;
    (void)add(13, 10.0, 6.0);
    send_list();
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(2, status_now().goal_list_revision);
    TEST_ASSERT_EQUAL_INT32(12, next_goal()); // 11 stays reached
    passes(IDS(12, 13));
    (void)drive_until(13);
    is_at(9.0, 1.0);
    (void)drive_until(0);
    is_at(10.0, 6.0);
    is_finished();
}

static void test_a_list_extended_after_its_end_goes_on(void) {
    begin_list(1);
    (void)add(11, 3.0, 1.0);
    start_list();
    (void)drive_until(0);
    list.goal_list_revision = 2;
    (void)add(12, 5.0, 1.0);
    send_list();
    passes(IDS(12));
    (void)drive_until(0);
    is_at(5.0, 1.0);
    is_finished();
}

static void test_a_list_of_which_all_was_reached_is_finished_and_its_path_revoked(void) {
    begin_list(1);
    (void)add(11, 2.0, 1.0);
    (void)add(12, 10.0, 1.0);
    start_list();
    (void)drive_until(12);
    list.goal_list_revision = 2;
    list.num_goals = 1;
    send_list();
    drive(3.0);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(0, door_path.cause);
    is_finished();
    const int paths = door_paths;
    drive(2.0);
    TEST_ASSERT_EQUAL_INT(paths, door_paths);
}

static void test_another_list_takes_over_from_its_first_goal_on(void) {
    begin_list(1);
    (void)add(11, 2.0, 1.0);
    (void)add(12, 10.0, 1.0);
    start_list();
    (void)drive_until(12);
    drive(2.0); // it is on its way
    list.goal_list_id = 5;
    send_list();
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(5, status_now().goal_list_id);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    (void)drive_until(12);
    is_at(2.0, 1.0);
}

static void test_a_changed_goal_is_driven_to_again(void) {
    begin_list(1);
    (void)add(11, 2.0, 1.0);
    (void)add(12, 10.0, 1.0);
    start_list();
    (void)drive_until(12);
    list.goal_list_revision = 2;
    list.goals[0].y = 3.0;
    send_list();
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    (void)drive_until(12);
    is_at(2.0, 3.0);
}

// ---- what was reached stays reached

static void test_what_was_reached_stays_so_when_the_hall_or_the_vehicle_changes(void) {
    begin_list(1);
    (void)add(11, 3.0, 1.0);
    (void)add(12, 9.0, 1.0);
    start_list();
    (void)drive_until(12);
    hall_add(6.0, 0.6, 6.2, 3.0); // the way is another one
    build_hall(2);
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(12, next_goal());
    TEST_ASSERT_EQUAL_INT32(2, door_path.map_revision);
    passes(IDS(12));
    aisle_vehicle_msg body = {.vehicle_revision = 5, .footprint_radius = 0.35F, .margin = 0.1F};
    hall_disc(0.35, 0.1F);
    while (door_submit(AISLE_INPUT_VEHICLE, &body) == AISLE_BUSY) {
        door_settle();
    }
    door_settle();
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(5, door_path.vehicle_revision);
    TEST_ASSERT_EQUAL_INT32(12, next_goal());
    (void)drive_until(0);
    is_at(9.0, 1.0);
    is_finished();
}

static void test_the_dwell_goes_on_while_the_hall_changes(void) {
    begin_list(1);
    add(11, 1.0, 1.0)->dwell = 6.0F;
    (void)add(12, 3.0, 1.0);
    start_list();
    drive(4.0);
    hall_add(9.0, 6.0, 10.0, 7.0);
    build_hall(2);
    drive(0.1);
    passes(IDS(11, 12));
    drive(1.8);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    drive(0.3);
    TEST_ASSERT_EQUAL_INT32(12, next_goal());
    drive(1.0);
    TEST_ASSERT_TRUE(here.x > 1.05); // nor does the new path wait for all of it again
    (void)drive_until(0);
}

// A list whose first goal is where the vehicle stands: when that is reached the others are still told.
static void test_goals_behind_one_at_the_start_are_kept_when_it_is_reached(void) {
    begin_list(1);
    add(11, 1.0, 1.0)->dwell = 1.0F;
    (void)add(12, 4.0, 1.0);
    (void)add(13, 9.0, 1.0);
    start_list();
    drive_until(12);
    drive(0.5);
    aisle_obstacles_msg seen = {.utime = door_now, .seq = 1, .num_obstacles = 1};
    seen.obstacles[0] =
        (aisle_obstacle_msg){.id = 7, .kind = AISLE_OBSTACLE_PERSON, .x = 4.2, .y = 1.0, .radius = 0.3F};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_OBSTACLES, &seen));
    door_settle(); // slower, by a new path
    TEST_ASSERT_EQUAL(AISLE_STATUS_YIELDING, door_path.cause);
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, door_path.status);
    int goals = 0;
    for (int16_t i = 0; i < door_path.num_waypoints; i++) {
        goals += (door_path.waypoints[i].flags & AISLE_WAYPOINT_GOAL) != 0;
    }
    TEST_ASSERT_EQUAL_INT(2, goals);
}

// Whatever its controller does: where no proof sees it, it is stopped.
static void test_who_goes_on_over_a_goal_that_is_not_counted_is_stopped(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    start_list();
    drive(4.0);
    TEST_ASSERT_TRUE(here.x > 2.0 && here.x < 3.9 && next_goal() == 11);
    for (int i = 0; i < 40 && door_path.status == AISLE_PATH_OK; i++) { // through, at 0.8 m/s
        door_now += 50000;
        here.x += 0.04;
        here.vx = 0.8F;
        here.utime = door_now;
        here.seq++;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        door_settle();
    }
    TEST_ASSERT_EQUAL(AISLE_STATUS_OFF_PATH, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    TEST_ASSERT_TRUE(here.x > 4.09 && here.x < 4.2);
}

// ---- any order

// Goals at the ends of the hall; from (1, 1) the best order is 11, 12, 13.
static void list_in_any_order(int32_t revision) {
    begin_list(revision);
    list.ordering = AISLE_GOAL_LIST_ANY_ORDER;
    (void)add(13, 1.0, 7.0);
    (void)add(12, 11.0, 7.0);
    (void)add(11, 11.0, 1.0);
}

static void test_what_is_left_in_any_order_is_ordered_anew_when_the_hall_changes(void) {
    list_in_any_order(1);
    start_list();
    passes(IDS(13, 12, 11)); // 6 + 10 + 6 m
    hall_add(0.0, 3.0, 4.2, 3.2);
    hall_add(4.2, 3.2, 5.0, 3.4); // no way up on the left
    build_hall(2);
    drive(0.2);
    passes(IDS(11, 12, 13));
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    (void)drive_until(12);
    (void)drive_until(13);
    (void)drive_until(0);
    is_at(1.0, 7.0);
}

static void test_an_order_stays_when_there_is_no_reason_to_change_it(void) {
    list_in_any_order(1);
    start_list();
    passes(IDS(13, 12, 11));
    here.localized = 0;
    door_wait(1000000, &here);
    here.localized = 1;
    here.x = 10.0; // moved by hand: 11 would be nearer
    door_wait(500000, &here);
    TEST_ASSERT_EQUAL_INT32(13, next_goal());
}

static void test_in_any_order_the_goal_being_driven_to_stays_the_first_of_a_longer_list(void) {
    list_in_any_order(1);
    start_list();
    drive(3.0);
    TEST_ASSERT_EQUAL_INT32(13, next_goal());
    list.goal_list_revision = 2;
    (void)add(14, 1.5, 1.0); // nearer than all others
    send_list();
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(13, next_goal());
    (void)drive_until(14); // the rest is in its best order: down again, then right
    is_at(1.0, 7.0);
    (void)drive_until(11);
    (void)drive_until(12);
    (void)drive_until(0);
    is_at(11.0, 7.0);
}

// Goals behind the first one: no order of them is shorter.
static void test_behind_a_goal_that_is_kept_the_order_is_the_best(void) {
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    aisle_rng rng = aisle_rng_seed(5);
    int hits = 0;
    for (int32_t round = 0; round < 12; round++) {
        setUp();
        begin_list(1);
        list.ordering = AISLE_GOAL_LIST_ANY_ORDER;
        (void)add(20, 10.0, 4.0);
        start_list();
        list.goal_list_revision = 2;
        for (int32_t i = 0; i < 3; i++) {
            aisle_vec2 p;
            do {
                p = uniform_point(&rng, aisle_vec2_of(0.5, 0.5), aisle_vec2_of(11.5, 7.5));
            } while (hall_disc_gap(p.x, p.y, 0.41) < 0.0L);
            (void)add(21 + i, p.x, p.y);
        }
        send_list();
        follow();
        TEST_ASSERT_EQUAL_INT32(20, next_goal());
        const float told = door_path.length;
        door_judge(&door_path);
        aisle_query_msg query = door_query(1, 1.0, 1.0, 10.0, 4.0);
        query.options.objective = AISLE_OPTIONS_SHORTEST;
        query.num_goals = 4;
        float least = INFINITY;
        for (int k = 0; k < 6; k++) {
            for (int i = 0; i < 3; i++) {
                query.goals[1 + i] = list.goals[1 + orders[k][i]];
            }
            least = fminf(least, door_ask(&query)->length);
        }
        hits += told < least + 5e-3F;
        TEST_ASSERT_TRUE(told > least - 0.2F);
    }
    TEST_ASSERT_EQUAL_INT(12, hits);
}

// ---- at any moment

// What happens to a mission over 11 and 12 after this many seconds of driving; in the end it is at 13.
static void at_every_moment(void (*event)(void)) {
    for (int i = 0; i < 36; i++) {
        setUp();
        begin_list(1);
        (void)add(11, 3.0, 1.0);
        (void)add(12, 3.0, 4.0);
        start_list();
        drive(0.35 * i);
        event();
        (void)drive_until(0);
        is_at(2.0, 6.0);
        is_finished();
    }
}

static void extend(void) {
    list.goal_list_revision = 2;
    (void)add(13, 2.0, 6.0);
    send_list();
}

static void extend_and_skip_12(void) {
    extend();
    (void)command(AISLE_COMMAND_CANCEL, 12, 1); // or it is reached
}

static void extend_and_skip_what_is_next(void) {
    extend();
    follow();
    if (next_goal() != 13) {
        TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, next_goal(), 1));
    }
}

static void extend_and_change_the_hall(void) {
    extend();
    hall_add(9.0, 6.0, 10.0, 7.0);
    build_hall(2);
}

static void replace(void) {
    begin_list(1);
    list.goal_list_id = 9;
    (void)add(13, 2.0, 6.0);
    send_list();
}

static void replace_twice(void) {
    begin_list(1);
    list.goal_list_id = 9;
    (void)add(11, 1.0, 1.0);
    send_list();
    follow();
    list.goal_list_revision = 2;
    list.goals[0] = (aisle_goal_msg){.id = 13, .x = 2.0, .y = 6.0, .tolerance_theta = 4.0F};
    send_list();
}

static void test_a_list_may_be_extended_at_any_moment(void) {
    at_every_moment(extend);
}

static void test_a_goal_on_the_way_may_be_skipped_at_any_moment(void) {
    at_every_moment(extend_and_skip_12);
}

static void test_the_goal_being_driven_to_may_be_skipped_at_any_moment(void) {
    at_every_moment(extend_and_skip_what_is_next);
}

static void test_the_hall_may_change_at_any_moment(void) {
    at_every_moment(extend_and_change_the_hall);
}

static void test_a_list_may_be_replaced_at_any_moment(void) {
    at_every_moment(replace);
    at_every_moment(replace_twice);
}

// ---- skipping on command

static void test_a_goal_is_skipped_on_command(void) {
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    (void)add(13, 10.0, 6.0);
    start_list();
    drive(1.0);
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 12, 41));
    TEST_ASSERT_EQUAL_INT32(41, status_now().command_id);
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    passes(IDS(11, 13));
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 11, 42)); // the one being driven to
    drive(0.5);
    TEST_ASSERT_EQUAL_INT32(13, next_goal());
    passes(IDS(13));
    (void)drive_until(0);
    is_at(10.0, 6.0);
    is_finished();
}

static void test_skipping_a_goal_that_is_not_left_is_refused_and_nothing_changes(void) {
    begin_list(1);
    (void)add(11, 2.0, 1.0);
    (void)add(12, 9.0, 1.0);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, command(AISLE_COMMAND_CANCEL, 11, 7)); // there is no list
    start_list();
    (void)drive_until(12);
    const int paths = door_paths;
    static const int32_t none[] = {11, 99, -1, INT32_MIN};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        TEST_ASSERT_EQUAL(AISLE_ERR_DATA, command(AISLE_COMMAND_CANCEL, none[i], 8));
        TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, status_now().cause);
        TEST_ASSERT_EQUAL_INT32(none[i], status_now().cause_id);
    }
    TEST_ASSERT_EQUAL_INT32(0, status_now().command_id);
    TEST_ASSERT_EQUAL_INT(paths, door_paths);
    TEST_ASSERT_EQUAL_INT32(12, next_goal());
}

static void test_skipping_the_last_goal_ends_the_mission(void) {
    begin_list(1);
    (void)add(11, 9.0, 1.0);
    start_list();
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 11, 3));
    drive(3.0);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(0, door_path.cause);
    is_finished();
}

static void test_a_goal_skipped_while_it_is_planned_for_is_in_no_path(void) {
    here.utime = door_now;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &list));
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 10));
    }
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 11, 3));
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    passes(IDS(12));
}

// ---- goals out of reach

// 12 lies in a room without a door.
static void shut_in(void) {
    hall_add(9.0, 5.5, 12.0, 5.7);
    hall_add(9.0, 5.5, 9.2, 8.0);
    build_hall(2);
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 11.0, 7.0);
    (void)add(13, 10.0, 1.0);
}

static void test_a_goal_out_of_reach_is_named_and_not_skipped_unless_told_to(void) {
    shut_in();
    start_list();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    refused_with(AISLE_STATUS_NO_PATH, 12);
    drive(2.0);
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, status_now().cause);
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 12, 3));
    passes(IDS(11, 13));
    (void)drive_until(0);
    is_at(10.0, 1.0);
}

static void test_a_goal_out_of_reach_is_named_and_then_skipped_if_so_configured(void) {
    open_door(true);
    shut_in();
    here.utime = door_now;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &list));
    while (door_paths == 0) {
        (void)aisle_planner_step(door, door_now, 1000);
        door_pull_events();
    }
    refused_with(AISLE_STATUS_NO_PATH, 12);
    door_settle();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    passes(IDS(11, 13));
    (void)drive_until(13);
    hall_begin(12.0, 8.0); // the room is gone; but 12 was given up
    build_hall(3);
    drive(0.5);
    passes(IDS(13));
    list.goal_list_revision = 2;
    send_list(); // a newer revision tries it again
    drive(0.5);
    passes(IDS(12, 13));
    TEST_ASSERT_EQUAL_INT32(12, next_goal());
    (void)drive_until(13);
    is_at(11.0, 7.0);
    (void)drive_until(0);
}

static void test_every_proof_skips_and_several_goals_may_be(void) {
    for (int8_t ordering = AISLE_GOAL_LIST_ORDERED; ordering <= AISLE_GOAL_LIST_ANY_ORDER; ordering++) {
        open_door(true);
        hall_begin(12.0, 8.0);
        hall_add(5.0, 3.0, 7.0, 5.0);
        hall_add(9.0, 5.5, 11.5, 5.7); // a door of 0.5 m to the right
        hall_add(9.0, 5.5, 9.2, 8.0);
        build_hall(1);
        begin_list(1);
        list.ordering = ordering;
        (void)add(11, 6.0, 4.0);  // occupied
        (void)add(12, 11.0, 7.0); // too narrow
        (void)add(13, 10.0, 1.0);
        (void)add(14, 13.0, 1.0); // outside
        (void)add(15, 10.0, 3.0);
        here.utime = door_now;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &list));
        static const struct {
            int16_t cause;
            int32_t goal;
        } expected[] = {
            {AISLE_STATUS_GOAL_OCCUPIED, 11}, {AISLE_STATUS_GOAL_OUTSIDE, 14}, {AISLE_STATUS_TOO_NARROW, 12}};
        for (int i = 0; i < 3; i++) {
            while (door_paths == i) {
                (void)aisle_planner_step(door, door_now, 1000);
                door_pull_events();
            }
            refused_with(expected[i].cause, expected[i].goal);
        }
        door_settle();
        TEST_ASSERT_EQUAL_INT(4, door_paths);
        passes(IDS(13, 15));
        (void)drive_until(0);
        is_at(10.0, 3.0);
    }
}

static void test_a_vehicle_that_is_shut_in_keeps_its_mission(void) {
    open_door(true);
    hall_begin(12.0, 8.0);
    hall_add(3.0, 0.0, 3.2, 8.0);
    build_hall(1);
    begin_list(1);
    (void)add(11, 6.0, 4.0);
    (void)add(12, 11.0, 7.0);
    start_list();
    TEST_ASSERT_EQUAL_INT(2, door_paths);
    refused_with(AISLE_STATUS_NO_PATH, 12);
    drive(2.0);
    TEST_ASSERT_EQUAL_INT(2, door_paths); // and it does not try again for nothing
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    hall_begin(12.0, 8.0);
    build_hall(2);
    follow();
    passes(IDS(11, 12));
}

static void test_what_is_no_proof_skips_nothing(void) {
    open_door(true);
    build_hall(1);
    begin_list(1);
    (void)add(11, 4.0, 1.0);
    (void)add(12, 9.0, 1.0);
    list.options.work_units = 5;
    start_list();
    TEST_ASSERT_EQUAL_INT(1, door_paths);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_BUDGET, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    here.x = 6.0;
    here.y = 4.0; // in the pillar: the start's fault
    list.options.work_units = 0;
    list.goal_list_revision = 2;
    start_list();
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_START_OCCUPIED, door_path.cause);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    TEST_ASSERT_EQUAL_INT32(2, status_now().goal_list_revision);
}

static void test_a_query_skips_nothing(void) {
    open_door(true);
    shut_in();
    aisle_query_msg query = door_query(1, 1.0, 1.0, 11.0, 7.0);
    query.goals[1] = (aisle_goal_msg){.id = 12, .x = 10.0, .y = 1.0, .tolerance_theta = 4.0F};
    query.num_goals = 2;
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_NO_PATH, door_ask(&query)->cause);
    TEST_ASSERT_EQUAL_INT(1, door_replies);
}

// 12 is added under way, in a room without a door.
static void add_one_out_of_reach(bool skips) {
    open_door(skips);
    hall_add(9.0, 5.5, 12.0, 5.7);
    hall_add(9.0, 5.5, 9.2, 8.0);
    build_hall(1);
    begin_list(1);
    (void)add(11, 10.0, 1.0);
    start_list();
    drive(2.0);
    list.goal_list_revision = 2;
    (void)add(12, 11.0, 7.0);
    (void)add(13, 10.0, 3.0);
    send_list();
}

static void test_a_goal_out_of_reach_that_is_added_under_way_is_named_and_waits(void) {
    add_one_out_of_reach(false);
    drive(5.0);
    refused_with(AISLE_STATUS_NO_PATH, 12);
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT32(11, next_goal());
    TEST_ASSERT_EQUAL(AISLE_OK, command(AISLE_COMMAND_CANCEL, 12, 1));
    drive(0.5);
    passes(IDS(11, 13));
    (void)drive_until(0);
    is_at(10.0, 3.0);
}

static void test_a_goal_out_of_reach_that_is_added_under_way_is_named_and_skipped_if_so_configured(void) {
    add_one_out_of_reach(true);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_STOP, door_path.status); // it has to be at rest to be told
    while (door_path.status != AISLE_PATH_NONE || door_path.num_waypoints == 0) {
        move();
        TEST_ASSERT_TRUE(door_path.status != AISLE_PATH_OK && door_now < 20000000);
        do {
            door_pull_events();
        } while ((door_path.status != AISLE_PATH_NONE || door_path.num_waypoints == 0) &&
                 aisle_planner_step(door, door_now, 1000) == AISLE_BUSY);
    }
    refused_with(AISLE_STATUS_NO_PATH, 12);
    door_settle();
    passes(IDS(11, 13));
    (void)drive_until(0);
    is_at(10.0, 3.0);
    is_finished();
}

static void test_of_goals_that_share_an_id_the_one_out_of_reach_is_skipped(void) {
    open_door(true);
    shut_in();
    for (int i = 0; i < 3; i++) {
        list.goals[i].id = 7;
    }
    start_list();
    passes(IDS(7, 7));
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 10.0, door_path.waypoints[door_path.num_waypoints - 1].x);
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 1.0, door_path.waypoints[door_path.num_waypoints - 1].y);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_goals_are_reached_in_turn_on_one_path);
    RUN_TEST(test_a_goal_is_left_when_its_dwell_is_over);
    RUN_TEST(test_the_last_goals_dwell_is_waited_for_too);
    RUN_TEST(test_a_pose_that_cannot_be_trusted_breaks_the_dwell);
    RUN_TEST(test_a_pose_on_another_map_counts_for_nothing);
    RUN_TEST(test_a_heading_is_part_of_arriving);
    RUN_TEST(test_whoever_is_close_enough_has_arrived_by_the_goals_own_tolerance);
    RUN_TEST(test_a_list_extended_under_way_goes_on_without_a_stop_at_the_beginning);
    RUN_TEST(test_a_list_extended_after_its_end_goes_on);
    RUN_TEST(test_a_list_of_which_all_was_reached_is_finished_and_its_path_revoked);
    RUN_TEST(test_another_list_takes_over_from_its_first_goal_on);
    RUN_TEST(test_a_changed_goal_is_driven_to_again);
    RUN_TEST(test_what_was_reached_stays_so_when_the_hall_or_the_vehicle_changes);
    RUN_TEST(test_the_dwell_goes_on_while_the_hall_changes);
    RUN_TEST(test_goals_behind_one_at_the_start_are_kept_when_it_is_reached);
    RUN_TEST(test_who_goes_on_over_a_goal_that_is_not_counted_is_stopped);
    RUN_TEST(test_what_is_left_in_any_order_is_ordered_anew_when_the_hall_changes);
    RUN_TEST(test_an_order_stays_when_there_is_no_reason_to_change_it);
    RUN_TEST(test_in_any_order_the_goal_being_driven_to_stays_the_first_of_a_longer_list);
    RUN_TEST(test_behind_a_goal_that_is_kept_the_order_is_the_best);
    RUN_TEST(test_a_list_may_be_extended_at_any_moment);
    RUN_TEST(test_a_goal_on_the_way_may_be_skipped_at_any_moment);
    RUN_TEST(test_the_goal_being_driven_to_may_be_skipped_at_any_moment);
    RUN_TEST(test_the_hall_may_change_at_any_moment);
    RUN_TEST(test_a_list_may_be_replaced_at_any_moment);
    RUN_TEST(test_a_goal_is_skipped_on_command);
    RUN_TEST(test_skipping_a_goal_that_is_not_left_is_refused_and_nothing_changes);
    RUN_TEST(test_skipping_the_last_goal_ends_the_mission);
    RUN_TEST(test_a_goal_skipped_while_it_is_planned_for_is_in_no_path);
    RUN_TEST(test_a_goal_out_of_reach_is_named_and_not_skipped_unless_told_to);
    RUN_TEST(test_a_goal_out_of_reach_is_named_and_then_skipped_if_so_configured);
    RUN_TEST(test_every_proof_skips_and_several_goals_may_be);
    RUN_TEST(test_a_vehicle_that_is_shut_in_keeps_its_mission);
    RUN_TEST(test_what_is_no_proof_skips_nothing);
    RUN_TEST(test_a_query_skips_nothing);
    RUN_TEST(test_a_goal_out_of_reach_that_is_added_under_way_is_named_and_waits);
    RUN_TEST(test_a_goal_out_of_reach_that_is_added_under_way_is_named_and_skipped_if_so_configured);
    RUN_TEST(test_of_goals_that_share_an_id_the_one_out_of_reach_is_skipped);
    return UNITY_END();
}
