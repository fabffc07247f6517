// A vehicle that is driven through the public door: it follows what comes out, the test moves it and everything else.
#include "aisle/planner.h"
#include "robot/motion.h"
#include "robot/vehicle.h"

#include "door.h"

#define TICK_US 50000

static aisle_pose_msg here;
static aisle_obstacles_msg seen;
static aisle_vehicle limits;

// The vehicle as it follows the newest path: by its times, from where the path begins, as long as its lease stands.
typedef struct follower {
    aisle_path_msg path;
    double t; // s on it
    int32_t revision;
    bool drives; // there is one
    double s;    // m driven
} follower;
static follower agv;

static void setup_hall(double w, double h) {
    door_config = (aisle_config){.limits = {.cells = 1048576U, .requests = 4U}, .boot_id = 77, .has_vehicle = true};
    hall_rectangle(1.0, 0.7, 0.1F);
    hall_begin(w, h);
    aisle_vehicle_msg msg = door_config.vehicle;
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &limits, &why));
}

static double nearest_told;   // m, clearance_moving_min of all paths; 1e9: none was told
static int64_t shortest_told; // us, lease of all paths that were to be driven

static void open_hall(double x, double y, double theta) {
    door_open(0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(1));
    door_settle();
    memset(&agv, 0, sizeof agv);
    memset(&seen, 0, sizeof seen);
    nearest_told = 1e9;
    shortest_told = INT64_MAX;
    here = door_pose(x, y, theta);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
}

static aisle_status_msg status_now(void) {
    aisle_status_msg status;
    aisle_planner_status(door, door_now, &status);
    return status;
}

static void take_path(void) {
    if (door_paths == 0) {
        return;
    }
    if (door_path.path_revision != agv.revision || door_path.status == AISLE_PATH_NONE) {
        agv.path = door_path;
        agv.revision = door_path.path_revision;
        agv.drives = door_path.status != AISLE_PATH_NONE;
        agv.t = 0.0;
    }
    agv.path.valid_until_utime = door_path.valid_until_utime;
    const int64_t lease = door_path.valid_until_utime - door_path.utime;
    if (door_path.status == AISLE_PATH_OK || door_path.status == AISLE_PATH_PARTIAL) {
        shortest_told = lease < shortest_told ? lease : shortest_told;
    }
    if (door_path.clearance_moving_min > 0.0F) {
        nearest_told = fmin(nearest_told, (double)door_path.clearance_moving_min);
    }
}

static void move(double dt) {
    const uint32_t n = (uint32_t)agv.path.num_waypoints;
    here.vx = here.omega = 0.0F;
    if (!agv.drives || n < 2U || door_now > agv.path.valid_until_utime) {
        return;
    }
    agv.t += dt;
    const aisle_place at = aisle_motion_at_time(&limits, agv.path.waypoints, n, NULL, agv.t);
    const aisle_pose2 pose = aisle_motion_pose(agv.path.waypoints, n, at);
    here.vx = (float)aisle_motion_speed(&limits, agv.path.waypoints, n, NULL, at);
    here.omega = (float)((pose.theta - here.theta) / dt);
    here.x = pose.x;
    here.y = pose.y;
    here.theta = pose.theta;
}

// One tick: the vehicle moves, tells its pose, and what is seen is told if anything was.
static void tick(void) {
    door_now += TICK_US;
    take_path();
    move(1e-6 * TICK_US);
    here.utime = door_now;
    here.seq++;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    door_settle();
    if (seen.seq > 0) {
        seen.utime = door_now;
        seen.seq++;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_OBSTACLES, &seen));
        door_settle();
    }
    take_path();
}

static void ticks(int n) {
    for (int i = 0; i < n; i++) {
        tick();
    }
}

static bool has_arrived(double x, double y) {
    return hypot(here.x - x, here.y - y) < 0.05 && here.vx < 0.01F && status_now().state == AISLE_STATUS_IDLE;
}

// Ticks until it has arrived; how many it took, -1: not in time.
static int drive_to(double x, double y, int ticks) {
    for (int i = 0; i < ticks; i++) {
        tick();
        if (has_arrived(x, y)) {
            return i;
        }
    }
    return -1;
}

static void go(int32_t revision, double x, double y) {
    const aisle_goal_list_msg goals = door_goals(revision, x, y);
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
}

static void see(int32_t id, double x, double y, double vx, double vy) {
    int16_t i = 0;
    while (i < seen.num_obstacles && seen.obstacles[i].id != id) {
        i++;
    }
    seen.num_obstacles = (int16_t)(i < seen.num_obstacles ? seen.num_obstacles : i + 1);
    seen.obstacles[i] = (aisle_obstacle_msg){
        .id = id, .kind = AISLE_OBSTACLE_PERSON, .x = x, .y = y, .vx = (float)vx, .vy = (float)vy, .radius = 0.3F};
    seen.seq++;
}

void setUp(void) {
    setup_hall(20.0, 10.0);
}
void tearDown(void) {}

static void test_a_vehicle_alone_follows_one_path_to_its_goal(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
    TEST_ASSERT_EQUAL_INT32(1, agv.revision);
    TEST_ASSERT_TRUE(nearest_told > 1e8);
}

static void test_a_person_far_away_changes_nothing(void) {
    setup_hall(40.0, 40.0);
    open_hall(2.0, 5.0, 0.0);
    see(7, 20.0, 35.0, 0.0, 0.0);
    go(1, 18.0, 5.0);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
    TEST_ASSERT_EQUAL_INT32(1, agv.revision);
}

static int64_t count(aisle_counter which) {
    return aisle_planner_counters(door)[which];
}

static void test_poses_and_obstacles_are_counted_for_cycles_while_there_is_a_plan(void) {
    setup_hall(40.0, 40.0);
    open_hall(2.0, 5.0, 0.0);
    see(7, 20.0, 35.0, 0.0, 0.0);
    ticks(5);
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CYCLE_INPUTS));
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CYCLES));
    go(1, 18.0, 5.0);
    const int64_t first = count(AISLE_COUNTER_CYCLES); // of the plan, which no pose asked for
    TEST_ASSERT_EQUAL_INT64(0, count(AISLE_COUNTER_CYCLE_INPUTS));
    TEST_ASSERT_TRUE(first >= 1);
    ticks(20);
    TEST_ASSERT_EQUAL_INT64(40, count(AISLE_COUNTER_CYCLE_INPUTS));
    TEST_ASSERT_EQUAL_INT64(first + 40, count(AISLE_COUNTER_CYCLES));
}

static void test_a_person_in_the_way_stops_the_vehicle_until_it_leaves(void) {
    setup_hall(20.0, 3.0);
    open_hall(2.0, 1.5, 0.0);
    see(7, 12.0, 1.5, 0.0, 0.0);
    go(1, 18.0, 1.5);
    TEST_ASSERT_EQUAL_INT(-1, drive_to(18.0, 1.5, 600));
    TEST_ASSERT_TRUE(here.x > 8.0 && here.x < 11.0);
    TEST_ASSERT_TRUE(here.vx < 0.01F);
    TEST_ASSERT_TRUE(nearest_told > 0.0 &&
                     nearest_told < 1.0); // the way to the person's reach, as told with each lease
    TEST_ASSERT_EQUAL(AISLE_STATUS_BLOCKED, status_now().state);
    TEST_ASSERT_EQUAL_INT32(7, status_now().cause_id);
    seen.num_obstacles = 0;
    TEST_ASSERT_TRUE(drive_to(18.0, 1.5, 600) > 0);
}

// Up to a person who stands in the way, by leases no shorter than that; where it waits, m from the person.
static double wait_before_a_person(float shortest_lease) {
    setup_hall(20.0, 3.0);
    door_config.shortest_lease = shortest_lease;
    open_hall(2.0, 1.5, 0.0);
    see(7, 12.0, 1.5, 0.0, 0.0);
    go(1, 18.0, 1.5);
    TEST_ASSERT_EQUAL_INT(-1, drive_to(18.0, 1.5, 600));
    TEST_ASSERT_TRUE(here.vx < 0.01F);
    return 12.0 - here.x;
}

static void test_no_lease_is_shorter_than_the_shortest_and_who_takes_short_ones_comes_nearer(void) {
    static const float leases[] = {0.05F, 0.125F, 0.3F, 0.5F, 1.0F};
    double nearer = 0.0;
    for (size_t i = 0; i < sizeof leases / sizeof leases[0]; i++) {
        const double gap = wait_before_a_person(leases[i]);
        const double least = 1e6 * (double)leases[i];
        TEST_ASSERT_TRUE((double)shortest_told >= least - 1.0);
        TEST_ASSERT_TRUE((double)shortest_told <= least + 1.0); // and it makes use of it
        TEST_ASSERT_TRUE(gap > nearer);
        nearer = gap;
    }
    const double usual = wait_before_a_person(0.0625F);
    TEST_ASSERT_EQUAL_DOUBLE(usual, wait_before_a_person(0.0F));
    TEST_ASSERT_TRUE(shortest_told >= 62500 && shortest_told < 125000);
}

static void test_at_rest_it_is_told_once_that_it_yields_whoever_is_nearest(void) {
    setup_hall(20.0, 3.0);
    open_hall(2.0, 1.5, 0.0);
    see(7, 3.2, 1.2, 0.0, 0.0);
    see(8, 3.4, 1.8, 0.0, 0.0);
    tick();
    go(1, 18.0, 1.5);
    tick();
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_path.status);
    const int paths = door_paths;
    int named[2] = {0, 0};
    for (int i = 0; i < 40; i++) {
        see(7, i % 4 < 2 ? 3.2 : 12.0, 1.2, 0.0, 0.0);
        see(8, i % 4 < 2 ? 12.0 : 3.2, 1.8, 0.0, 0.0);
        tick();
        TEST_ASSERT_TRUE(status_now().cause_id == 7 || status_now().cause_id == 8);
        named[status_now().cause_id - 7]++;
    }
    TEST_ASSERT_TRUE(named[0] > 10 && named[1] > 10);
    TEST_ASSERT_EQUAL_INT(paths, door_paths);
}

static void test_a_way_round_that_is_none_is_looked_for_ever_more_rarely(void) {
    setup_hall(20.0, 3.0);
    open_hall(2.0, 1.5, 0.0);
    see(7, 12.0, 1.5, 0.0, 0.0);
    go(1, 18.0, 1.5);
    TEST_ASSERT_EQUAL_INT(-1, drive_to(18.0, 1.5, 1200)); // a minute, about 50 s of it at rest
    const int64_t *counters = aisle_planner_counters(door);
    // Its plan, and looks after 0.5, 1, 2, 4, 8, 8 ... s of each stand; every half second it were a hundred.
    TEST_ASSERT_TRUE(counters[AISLE_COUNTER_GOAL_LISTS] >= 6 && counters[AISLE_COUNTER_GOAL_LISTS] <= 20);
    TEST_ASSERT_EQUAL_INT64(0, counters[AISLE_COUNTER_ROUNDS]);
}

static void test_a_person_who_stays_is_driven_round_where_there_is_room(void) {
    setup_hall(20.0, 12.0);
    open_hall(2.0, 6.0, 0.0);
    see(7, 11.0, 6.0, 0.0, 0.0);
    go(1, 18.0, 6.0);
    double aside = 0.0, near = 1e9;
    int arrived = -1;
    for (int i = 0; i < 900 && arrived < 0; i++) {
        tick();
        aside = fmax(aside, fabs(here.y - 6.0));
        near = fmin(near, hypot(here.x - 11.0, here.y - 6.0));
        arrived = has_arrived(18.0, 6.0) ? i : -1;
    }
    TEST_ASSERT_GREATER_THAN_INT(0, arrived);
    TEST_ASSERT_TRUE(aside > 1.5 && near > 1.0);
    const int64_t *counters = aisle_planner_counters(door);
    TEST_ASSERT_TRUE(counters[AISLE_COUNTER_ROUNDS] >= 1);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_PSO_LOCAL, agv.path.planner);
    TEST_ASSERT_TRUE(counters[AISLE_COUNTER_ROUND_MS] > 0 &&
                     counters[AISLE_COUNTER_WAIT_MS] > 0); // both costs are told
}

// By its velocity it is gone at once, each time that it is asked.
static void test_a_way_round_is_taken_of_one_who_always_seems_to_be_leaving(void) {
    setup_hall(20.0, 12.0);
    open_hall(2.0, 6.0, 0.0);
    see(7, 11.0, 6.0, 0.0, 1.2);
    go(1, 18.0, 6.0);
    TEST_ASSERT_EQUAL_INT(-1, drive_to(18.0, 6.0, 1200));
    const int64_t *counters = aisle_planner_counters(door);
    TEST_ASSERT_TRUE(counters[AISLE_COUNTER_ROUNDS] >= 1);
    TEST_ASSERT_TRUE(counters[AISLE_COUNTER_WAIT_MS] > counters[AISLE_COUNTER_ROUND_MS]);
}

static void test_a_person_who_blocks_an_aisle_is_driven_round_by_another_one(void) {
    setup_hall(20.0, 14.0);
    hall_add(4.0, 4.0, 16.0, 10.0); // aisles of 4 m below and above
    open_hall(2.0, 2.0, 0.0);
    see(7, 10.0, 2.0, 0.0, 0.0);
    go(1, 18.0, 2.0);
    double highest = 0.0;
    int arrived = -1;
    for (int i = 0; i < 3600 && arrived < 0; i++) {
        tick();
        highest = fmax(highest, here.y);
        arrived = has_arrived(18.0, 2.0) ? i : -1;
    }
    TEST_ASSERT_GREATER_THAN_INT(0, arrived);
    TEST_ASSERT_TRUE(highest > 10.0);
}

// To a goal half way, to stay there for 8 s, and on.
static void dwell_on_the_way(double x) {
    aisle_goal_list_msg goals = door_goals(1, x, 1.5);
    goals.goals[0].dwell = 8.0F;
    goals.goals[1] = goals.goals[0];
    goals.goals[1].id = goals.goals[0].id + 1;
    goals.goals[1].x = 18.0;
    goals.num_goals = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    for (int i = 0; i < 400 && hypot(here.x - x, here.y - 1.5) > 0.01; i++) {
        tick();
    }
}

// How long a dwell is left is the vehicle's own count: by the planner's it may still have seconds.
static void test_one_that_dwells_has_no_path_by_which_it_must_not_leave_at_once(void) {
    setup_hall(20.0, 3.0);
    open_hall(2.0, 1.5, 0.0);
    dwell_on_the_way(8.0);
    ticks(20);
    TEST_ASSERT_TRUE(agv.drives && here.vx < 0.01F);
    see(7, 9.5, 1.5, 0.0, 0.0);
    ticks(4);
    TEST_ASSERT_FALSE(agv.drives);
    seen.num_obstacles = 0;
    TEST_ASSERT_TRUE(drive_to(18.0, 1.5, 900) > 100); // 5 s and more, for what was left of the dwell
}

static void command(int8_t what, int32_t arg) {
    static int32_t id;
    const aisle_command_msg msg = {.utime = door_now, .command_id = ++id, .command = what, .arg = arg};
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_COMMAND, &msg));
    door_settle();
    take_path();
}

// A vehicle that rolls or turns without a path brakes, where no proof sees it.
static void test_nothing_is_sent_to_one_that_has_no_path_and_moves_until_it_rests(void) {
    for (int turns = 0; turns < 2; turns++) {
        open_hall(2.0, 5.0, 0.0);
        for (int i = 0; i < 20; i++) {
            door_now += TICK_US;
            here.utime = door_now;
            here.seq++;
            here.vx = turns != 0 ? 0.0F : 0.3F;
            here.omega = turns != 0 ? 0.7F : 0.0F;
            TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
            door_settle();
            if (i == 2) {
                go(1, 18.0, 5.0);
            }
            take_path();
            TEST_ASSERT_FALSE(agv.drives);
        }
        TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
    }
}

// ---- stops and what follows them

// The newest path brakes within what d_max and the reaction time allow, along the one before.
static void is_braking(int16_t cause) {
    TEST_ASSERT_EQUAL(AISLE_PATH_STOP, agv.path.status);
    TEST_ASSERT_EQUAL_INT16(cause, agv.path.cause);
    const double v = (double)agv.path.waypoints[0].v;
    const double way = v * (limits.reaction_time + 0.2) + v * v / (2.0 * limits.d_max);
    TEST_ASSERT_TRUE((double)agv.path.length <= way + 0.05);
}

static void rests_within(int n) {
    int i = 0;
    while (i < n && here.vx > 0.001F) {
        tick();
        i++;
    }
    TEST_ASSERT_LESS_THAN_INT(n, i);
}

// Under way at full speed, and a person is there all at once, ahead and a little aside: nothing but braking is proved.
static void be_taken_by_surprise(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    TEST_ASSERT_TRUE(here.vx > 1.0F);
    see(7, here.x + 1.5, 6.0, 0.0, 0.0);
    tick();
    is_braking(AISLE_STATUS_YIELDING);
}

static void test_one_that_brakes_is_told_so_once_and_the_lease_of_that_renewed(void) {
    be_taken_by_surprise();
    const int32_t revision = agv.revision;
    const int paths = door_paths;
    int n = 0;
    for (; here.vx > 0.001F; n++) {
        TEST_ASSERT_LESS_THAN_INT(80, n);
        TEST_ASSERT_EQUAL_INT32(revision, door_path.path_revision);
        TEST_ASSERT_EQUAL(AISLE_PATH_STOP, door_path.status);
        TEST_ASSERT_TRUE(door_now + TICK_US <= agv.path.valid_until_utime);
        tick();
    }
    TEST_ASSERT_GREATER_THAN_INT(20, n);                                                // of 50 ms
    TEST_ASSERT_TRUE(door_paths - paths >= n / 20 && door_paths - paths <= 2 + n / 10); // each half second
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_TRUE(door_path.status == AISLE_PATH_NONE || door_path.status == AISLE_PATH_OK);
        tick();
    }
}

static void test_one_that_brakes_is_told_anew_when_the_hall_changes(void) {
    be_taken_by_surprise();
    for (int32_t map = 2; map < 5; map++) {
        const int32_t revision = agv.revision;
        hall_add(15.0, 8.0 - 0.5 * map, 15.2, 8.2 - 0.5 * map);
        TEST_ASSERT_EQUAL(AISLE_OK, door_layout(map));
        ticks(3);
        TEST_ASSERT_TRUE(here.vx > 0.1F);
        is_braking(AISLE_STATUS_YIELDING);
        TEST_ASSERT_EQUAL_INT32(map, agv.path.map_revision); // proved in the hall as it is
        TEST_ASSERT_TRUE(agv.revision <= revision + 2);      // for the hall, and for the plan made anew in it
    }
}

static void test_hold_brakes_along_the_path_and_resume_goes_on(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    TEST_ASSERT_TRUE(here.vx > 1.0F);
    command(AISLE_COMMAND_HOLD, 0);
    is_braking(0);
    TEST_ASSERT_EQUAL(AISLE_STATUS_HELD, status_now().state);
    rests_within(80);
    const double x = here.x;
    ticks(60);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, x, here.x);
    command(AISLE_COMMAND_RESUME, 0);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

// What is out begins where the vehicle is believed to be when it is made, and the next pose may say that it is not so far.
static void test_a_turn_is_braked_though_the_pose_is_behind_the_path_that_is_out(void) {
    for (int late = 0; late < 6; late++) {
        open_hall(10.0, 5.0, 0.0);
        go(1, 4.0, 5.0);
        for (int i = 0; i < 200 && fabs(here.theta) < 1.0 + 0.05 * late; i++) {
            tick();
        }
        see(7, 12.9, 5.0, 0.0, 0.0);
        ticks(1);
        TEST_ASSERT_TRUE(agv.drives);
        here.theta -= here.theta > 0.0 ? 0.06 : -0.06;
        here.utime += 1000;
        door_now += 1000;
        here.seq++;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
        door_settle();
        take_path();
        command(AISLE_COMMAND_HOLD, 0);
        TEST_ASSERT_EQUAL(AISLE_PATH_STOP, agv.path.status);
    }
}

static void test_cancel_brakes_along_the_path_and_then_nothing_is_out(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    command(AISLE_COMMAND_CANCEL, 0);
    is_braking(0);
    rests_within(80);
    ticks(3);
    TEST_ASSERT_EQUAL(AISLE_STATUS_IDLE, status_now().state);
    const int before = door_paths;
    ticks(40);
    TEST_ASSERT_EQUAL_INT(before, door_paths);
}

// From the last good pose on: without any, or with poses `old` us old.
static void brakes_within_the_timeout(int64_t old) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    const int64_t last = door_now;
    while (agv.path.status != AISLE_PATH_STOP && door_now < last + 1000000) {
        door_now += 10000;
        if (old > 0) {
            here.utime = door_now - old;
            here.seq++;
            (void)door_submit(AISLE_INPUT_POSE, &here);
        }
        door_settle();
        take_path();
    }
    is_braking(AISLE_STATUS_POSE_STALE);
    TEST_ASSERT_TRUE(door_now - last <= (int64_t)(limits.pose_timeout * 1e6) + 100000);
}

static void test_a_stale_pose_brakes_the_vehicle_within_the_timeout(void) {
    brakes_within_the_timeout(0);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_POSE_STALE, status_now().cause);
}

static void test_a_clock_that_leaps_ahead_brakes_the_vehicle_until_poses_come_by_it(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    TEST_ASSERT_TRUE(here.vx > 1.0F);
    door_now += 3600 * (int64_t)1000000; // whatever is known is an hour old
    door_settle();
    take_path();
    is_braking(AISLE_STATUS_POSE_STALE);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

static void test_poses_by_a_clock_set_back_are_none_and_brake_the_vehicle_within_the_timeout(void) {
    brakes_within_the_timeout(5000000);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0); // the clock is right again
}

static void test_a_pose_that_comes_back_lets_the_vehicle_drive_on(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    for (int i = 0; i < 10; i++) { // it moves on unseen
        door_now += TICK_US;
        door_settle();
        take_path();
        move(1e-6 * TICK_US);
    }
    TEST_ASSERT_EQUAL(AISLE_PATH_STOP, agv.path.status);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

static void test_a_vehicle_that_is_not_localized_brakes(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    here.localized = 0;
    tick();
    is_braking(AISLE_STATUS_NOT_LOCALIZED);
    rests_within(80);
    here.localized = 1;
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

static void test_a_pose_off_the_path_brakes_and_plans_anew_from_rest(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    here.y += 0.5;
    here.utime = door_now += TICK_US;
    here.seq++;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    door_settle();
    take_path();
    is_braking(AISLE_STATUS_OFF_PATH);
    here.vx = here.omega = 0.0F; // it is at rest there
    here.utime = door_now += TICK_US;
    here.seq++;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_POSE, &here));
    door_settle();
    take_path();
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, agv.path.status);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, here.y, agv.path.waypoints[0].y);
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

static void test_a_source_that_falls_silent_brakes_the_vehicle(void) {
    open_hall(2.0, 5.0, 0.0);
    see(7, 3.0, 9.5, 0.0, 0.0);
    seen.num_obstacles = 0;
    go(1, 18.0, 5.0);
    ticks(100);
    const int64_t last = door_now;
    const int32_t seq = seen.seq;
    seen.seq = 0; // nothing more is told
    int n = 0;
    while (agv.path.status != AISLE_PATH_STOP && n++ < 20) {
        tick();
    }
    is_braking(AISLE_STATUS_OBSTACLES_STALE);
    TEST_ASSERT_TRUE(door_now - last <= (int64_t)(limits.obstacles_timeout * 1e6) + 100000);
    rests_within(80);
    seen.seq = seq;
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 600) > 0);
}

// ---- what changes under the vehicle

static void test_another_goal_under_way_bends_the_path_behind_the_base(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(100);
    const float v = here.vx;
    go(2, 16.0, 8.0);
    take_path();
    TEST_ASSERT_EQUAL(AISLE_PATH_OK, agv.path.status);
    TEST_ASSERT_EQUAL_INT32(2, agv.path.goal_list_revision);
    TEST_ASSERT_TRUE(agv.path.num_base >= 2);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, v, agv.path.waypoints[0].v);
    for (int16_t i = 0; i < agv.path.num_base; i++) { // straight on as before
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 5.0, agv.path.waypoints[i].y);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, agv.path.length, status_now().distance_remaining); // of the joined way
    TEST_ASSERT_FLOAT_WITHIN(0.2F, agv.path.duration, status_now().time_remaining);
    TEST_ASSERT_TRUE(drive_to(16.0, 8.0, 600) > 0);
}

static void test_revisions_rise_whatever_happens_while_a_plan_is_made(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    aisle_goal_list_msg goals = door_goals(2, 16.0, 8.0);
    goals.options.planner = AISLE_OPTIONS_AUTO;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    for (int i = 0; i < 3; i++) { // it is under way
        TEST_ASSERT_EQUAL(AISLE_BUSY, aisle_planner_step(door, door_now, 1));
    }
    int32_t revision = door_path.path_revision;
    for (int there = 1; there >= 0; there--) { // a person comes in front of it, and is gone
        see(7, 2.95, 5.0, 0.0, 0.0);
        seen.num_obstacles = (int16_t)there;
        seen.utime = ++door_now;
        TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_OBSTACLES, &seen));
        for (int i = 0; i < 100 && door_path.path_revision == revision; i++) {
            (void)aisle_planner_step(door, door_now, 1);
            door_pull_events();
        }
        TEST_ASSERT_EQUAL_INT32(revision + 1, door_path.path_revision);
        revision++;
    }
    TEST_ASSERT_EQUAL_INT32(1, door_path.goal_list_revision); // the other plan is not there yet
    door_settle();
    TEST_ASSERT_EQUAL_INT32(2, door_path.goal_list_revision);
    TEST_ASSERT_TRUE(door_path.path_revision > revision);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 8.0, door_path.waypoints[door_path.num_waypoints - 1].y);
}

static void test_a_wall_across_the_way_ahead_is_driven_round(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(80);
    hall_add(13.0, 2.0, 13.5, 8.0);
    TEST_ASSERT_EQUAL(AISLE_OK, door_layout(2));
    door_settle();
    take_path();
    TEST_ASSERT_TRUE(drive_to(18.0, 5.0, 900) > 0);
    TEST_ASSERT_EQUAL_INT32(2, agv.path.map_revision);
}

static void test_a_goal_that_cannot_be_reached_any_more_stops_the_vehicle_and_says_why(void) {
    open_hall(2.0, 5.0, 0.0);
    go(1, 18.0, 5.0);
    ticks(80);
    go(2, 25.0, 5.0);
    take_path();
    TEST_ASSERT_EQUAL(AISLE_PATH_STOP, agv.path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OUTSIDE, agv.path.cause);
    rests_within(80);
    ticks(3);
    TEST_ASSERT_EQUAL(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_GOAL_OUTSIDE, door_path.cause);
}

static void test_several_goals_are_reached_in_one_drive(void) {
    open_hall(2.0, 5.0, 0.0);
    aisle_goal_list_msg goals = door_goals(1, 8.0, 5.0);
    goals.goals[1] = (aisle_goal_msg){.id = 12, .x = 15.0, .y = 8.0, .tolerance_theta = 4.0F};
    goals.num_goals = 2;
    TEST_ASSERT_EQUAL(AISLE_OK, door_submit(AISLE_INPUT_GOALS, &goals));
    door_settle();
    TEST_ASSERT_TRUE(drive_to(15.0, 8.0, 800) > 0);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_vehicle_alone_follows_one_path_to_its_goal);
    RUN_TEST(test_a_person_far_away_changes_nothing);
    RUN_TEST(test_poses_and_obstacles_are_counted_for_cycles_while_there_is_a_plan);
    RUN_TEST(test_a_person_in_the_way_stops_the_vehicle_until_it_leaves);
    RUN_TEST(test_no_lease_is_shorter_than_the_shortest_and_who_takes_short_ones_comes_nearer);
    RUN_TEST(test_at_rest_it_is_told_once_that_it_yields_whoever_is_nearest);
    RUN_TEST(test_a_way_round_that_is_none_is_looked_for_ever_more_rarely);
    RUN_TEST(test_a_person_who_stays_is_driven_round_where_there_is_room);
    RUN_TEST(test_one_that_dwells_has_no_path_by_which_it_must_not_leave_at_once);
    RUN_TEST(test_nothing_is_sent_to_one_that_has_no_path_and_moves_until_it_rests);
    RUN_TEST(test_a_way_round_is_taken_of_one_who_always_seems_to_be_leaving);
    RUN_TEST(test_a_person_who_blocks_an_aisle_is_driven_round_by_another_one);
    RUN_TEST(test_one_that_brakes_is_told_so_once_and_the_lease_of_that_renewed);
    RUN_TEST(test_one_that_brakes_is_told_anew_when_the_hall_changes);
    RUN_TEST(test_hold_brakes_along_the_path_and_resume_goes_on);
    RUN_TEST(test_a_turn_is_braked_though_the_pose_is_behind_the_path_that_is_out);
    RUN_TEST(test_cancel_brakes_along_the_path_and_then_nothing_is_out);
    RUN_TEST(test_a_stale_pose_brakes_the_vehicle_within_the_timeout);
    RUN_TEST(test_a_clock_that_leaps_ahead_brakes_the_vehicle_until_poses_come_by_it);
    RUN_TEST(test_poses_by_a_clock_set_back_are_none_and_brake_the_vehicle_within_the_timeout);
    RUN_TEST(test_a_pose_that_comes_back_lets_the_vehicle_drive_on);
    RUN_TEST(test_a_vehicle_that_is_not_localized_brakes);
    RUN_TEST(test_a_pose_off_the_path_brakes_and_plans_anew_from_rest);
    RUN_TEST(test_a_source_that_falls_silent_brakes_the_vehicle);
    RUN_TEST(test_another_goal_under_way_bends_the_path_behind_the_base);
    RUN_TEST(test_revisions_rise_whatever_happens_while_a_plan_is_made);
    RUN_TEST(test_a_wall_across_the_way_ahead_is_driven_round);
    RUN_TEST(test_a_goal_that_cannot_be_reached_any_more_stops_the_vehicle_and_says_why);
    RUN_TEST(test_several_goals_are_reached_in_one_drive);
    return UNITY_END();
}
