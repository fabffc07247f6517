#include "sim/sensors.h" // first: proves that the header stands alone

#include "hall.h"

static aisle_sim_scene scene;
static aisle_sim_movers movers;
static aisle_sim_chassis truth;
static aisle_sim_localiser localiser;
static aisle_sim_source source;
static aisle_obstacles_msg told;

void setUp(void) {
    hall_begin(20.0, 15.0);
    hall_open(&scene);
    aisle_sim_movers_start(&movers, &scene, 1);
    truth = (aisle_sim_chassis){.pose = {5.0, 6.0, 1.0}};
}
void tearDown(void) {
    aisle_sim_scene_free(&scene);
}

static void test_poses_are_near_the_truth_never_off_by_more_than_told(void) {
    aisle_sim_pose_traits traits = aisle_sim_pose_usual();
    double most_xy = 0.0, most_theta = 0.0;
    for (uint64_t seed = 0; seed < 10; seed++) {
        aisle_sim_localiser_start(&localiser, &traits, seed);
        int fixes = 0;
        int64_t before = -1;
        for (int i = 0; i < 4000; i++) {
            aisle_pose_msg pose;
            if (!aisle_sim_localiser_step(&localiser, i * 0.005, 0.005)) {
                continue;
            }
            double delay = aisle_sim_localiser_tell(&localiser, &truth, i * 5000, 3, &pose);
            TEST_ASSERT_TRUE(delay >= traits.delay.least && delay < traits.delay.most);
            TEST_ASSERT_TRUE(pose.utime > before && pose.map_id == 3 && pose.seq == ++fixes && pose.localized == 1);
            before = pose.utime;
            most_xy = fmax(most_xy, hypot(pose.x - 5.0, pose.y - 6.0));
            most_theta = fmax(most_theta, fabs(pose.theta - 1.0));
            TEST_ASSERT_EQUAL_FLOAT(0.0F, pose.vx); // the wheels stand
        }
        TEST_ASSERT_EQUAL_INT(400, fixes); // 20 Hz for 20 s
    }
    TEST_ASSERT_TRUE(most_xy <= 3.0 * (sqrt(2.0) * traits.wander_xy + traits.white_xy) && most_xy > 0.02);
    TEST_ASSERT_TRUE(most_theta <= 3.0 * (traits.wander_theta + traits.white_theta) && most_theta > 0.005);
}

static void test_the_controllers_estimate_is_what_the_pose_tells(void) {
    aisle_sim_pose_traits traits = aisle_sim_pose_usual();
    aisle_pose_msg pose;
    aisle_sim_localiser_start(&localiser, &traits, 4);
    TEST_ASSERT_TRUE(aisle_sim_localiser_step(&localiser, 0.0, 0.005));
    aisle_sim_estimate at = aisle_sim_localiser_estimate(&localiser, &truth);
    (void)aisle_sim_localiser_tell(&localiser, &truth, 0, 1, &pose);
    TEST_ASSERT_EQUAL_DOUBLE(at.pose.x, pose.x);
    TEST_ASSERT_EQUAL_DOUBLE(at.pose.theta, pose.theta);
}

static void test_snapshots_keep_rate_delay_and_three_sigma(void) {
    aisle_sim_source_traits traits = aisle_sim_source_usual();
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(3.0, 4.0), aisle_vec2_of(1.0, -0.5), 0.3);
    int snapshots = 0, lost = 0;
    double most = 0.0, most_v = 0.0;
    aisle_sim_source_start(&source, &traits, 0, 1, 9);
    for (int i = 0; i < 40000; i++) {
        if (!aisle_sim_source_step(&source, i * 0.005)) {
            continue;
        }
        double delay = aisle_sim_source_tell(&source, &movers, aisle_vec2_of(0.0, 0.0), i, 1, &told);
        snapshots++;
        lost += delay < 0.0 ? 1 : 0;
        TEST_ASSERT_TRUE(delay < 0.0 || (delay >= traits.delay.least && delay < traits.delay.most));
        TEST_ASSERT_EQUAL_INT16(1, told.num_obstacles);
        const aisle_obstacle_msg *o = &told.obstacles[0];
        most = fmax(most, hypot(o->x - 3.0, o->y - 4.0));
        most_v = fmax(most_v, hypot((double)o->vx - 1.0, (double)o->vy + 0.5));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, traits.sigma, sqrt((double)o->cov_xy[0]));
        TEST_ASSERT_EQUAL_FLOAT(0.3F, o->radius);
    }
    TEST_ASSERT_INT_WITHIN(1, 3000, snapshots); // 15 Hz for 200 s
    TEST_ASSERT_INT_WITHIN(25, 60, lost);
    TEST_ASSERT_TRUE(most <= 3.0 * traits.sigma && most > 2.0 * traits.sigma);
    TEST_ASSERT_TRUE(most_v <= 3.0 * traits.sigma_v + 1e-6);
}

static void test_sources_share_the_movers_and_none_is_left_out(void) {
    aisle_sim_source_traits traits = aisle_sim_source_usual();
    for (int i = 0; i < 10; i++) {
        (void)aisle_sim_movers_place(&movers, aisle_vec2_of(i, 4.0), aisle_vec2_of(0.0, 0.0), 0.3);
    }
    movers.mover[4].is_there = false;
    int seen[16] = {0};
    for (int32_t k = 0; k < 3; k++) {
        aisle_sim_source_start(&source, &traits, k, 3, 9);
        (void)aisle_sim_source_tell(&source, &movers, aisle_vec2_of(0.0, 0.0), 1, 1, &told);
        TEST_ASSERT_EQUAL_INT32(k, told.source);
        for (int16_t i = 0; i < told.num_obstacles; i++) {
            seen[told.obstacles[i].id]++;
        }
    }
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_INT(i == 4 ? 0 : 1, seen[movers.mover[i].id]);
    }
}

static void test_a_source_of_short_range_sees_what_is_near(void) {
    aisle_sim_source_traits traits = aisle_sim_source_usual();
    traits.range = 5.0;
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(4.0, 0.0), aisle_vec2_of(0.0, 0.0), 0.3);
    (void)aisle_sim_movers_place(&movers, aisle_vec2_of(6.0, 0.0), aisle_vec2_of(0.0, 0.0), 0.3);
    aisle_sim_source_start(&source, &traits, 0, 1, 9);
    (void)aisle_sim_source_tell(&source, &movers, aisle_vec2_of(0.0, 0.0), 1, 1, &told);
    TEST_ASSERT_EQUAL_INT16(1, told.num_obstacles);
    TEST_ASSERT_EQUAL_INT32(movers.mover[0].id, told.obstacles[0].id);
}

static void test_rectangles_are_told_with_their_corners(void) {
    aisle_sim_source_traits traits = aisle_sim_source_usual();
    aisle_sim_prey prey = {.at = {1.0, 1.0}, .reach = 0.5};
    TEST_ASSERT_TRUE(aisle_sim_movers_add(&movers, AISLE_SIM_AGV, 1.5, &prey, 2.0));
    aisle_sim_source_start(&source, &traits, 0, 1, 9);
    (void)aisle_sim_source_tell(&source, &movers, aisle_vec2_of(0.0, 0.0), 1, 1, &told);
    const aisle_obstacle_msg *o = &told.obstacles[0];
    TEST_ASSERT_EQUAL_INT16(4, o->num_vertices);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, o->vertices[1][0]);
    TEST_ASSERT_EQUAL_FLOAT(1.5F, o->v_bound);
    TEST_ASSERT_EQUAL_INT8(AISLE_OBSTACLE_VEHICLE, o->kind);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_poses_are_near_the_truth_never_off_by_more_than_told);
    RUN_TEST(test_the_controllers_estimate_is_what_the_pose_tells);
    RUN_TEST(test_snapshots_keep_rate_delay_and_three_sigma);
    RUN_TEST(test_sources_share_the_movers_and_none_is_left_out);
    RUN_TEST(test_a_source_of_short_range_sees_what_is_near);
    RUN_TEST(test_rectangles_are_told_with_their_corners);
    return UNITY_END();
}
