// The rules of goal lists, on the module alone; what the planner makes of them is tested in test_planner_goals.c.
#include "plan/mission.h"

#include "base/rng.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define MAX AISLE_GOAL_LIST_MAX_GOALS

static aisle_mission mission;
static aisle_vehicle vehicle;
static aisle_goal_list_msg list;
static aisle_pose_msg pose;
static aisle_request asked; // a copy, as the planner holds one

// Goal `id` lies at (id, 0).
static aisle_goal_msg goal_at(int32_t id) {
    return (aisle_goal_msg){.id = id, .x = (double)id};
}

static void begin_list(int32_t id, int32_t revision, int8_t ordering) {
    memset(&list, 0, sizeof list);
    list.goal_list_id = id;
    list.goal_list_revision = revision;
    list.ordering = ordering;
}

static aisle_goal_msg *add(int32_t id) {
    list.goals[list.num_goals] = goal_at(id);
    return &list.goals[list.num_goals++];
}

// List 4 of these goals, by revision.
static void fill(int32_t revision, int8_t ordering, int n, const int32_t *ids) {
    begin_list(4, revision, ordering);
    for (int i = 0; i < n; i++) {
        (void)add(ids[i]);
    }
}

static void take(void) {
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_mission_judge(&mission, &list, &why));
    aisle_mission_take(&mission, &list);
}

static void refused(int16_t cause, int32_t id) {
    static aisle_mission before;
    aisle_refusal why = {0, 0, 0.0F};
    before = mission;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_mission_judge(&mission, &list, &why));
    TEST_ASSERT_EQUAL_INT16(cause, why.cause);
    TEST_ASSERT_EQUAL_INT32(id, why.id);
    TEST_ASSERT_EQUAL_MEMORY(&before, &mission, sizeof mission);
}

static void ask(void) {
    asked = *aisle_mission_ask(&mission, NULL);
    mission.replan = false; // as the planner does when it begins
}

// The plan for what was asked, as asked.
static uint32_t plan(void) {
    TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
    TEST_ASSERT_TRUE(aisle_mission_fits(&mission, &asked));
    return aisle_mission_take_order(&mission, &asked);
}

// In this order.
static void plan_as(const int32_t *ids) {
    ask();
    for (int16_t i = 0; i < asked.num_goals; i++) {
        int16_t k = i;
        while (asked.goals[k].id != ids[i]) {
            TEST_ASSERT_LESS_THAN_INT16(asked.num_goals - 1, k);
            k++;
        }
        const aisle_goal_msg moved = asked.goals[k];
        asked.goals[k] = asked.goals[i];
        asked.goals[i] = moved;
    }
    TEST_ASSERT_EQUAL_UINT32(0, plan());
}

static void take_and_plan(void) {
    take();
    ask();
    (void)plan();
}

// A pose 0.1 s later.
static uint32_t stand(double x, double y) {
    pose.utime += 100000;
    pose.x = x;
    pose.y = y;
    return aisle_mission_note_pose(&mission, &vehicle, &pose);
}

static uint32_t stand_on(int32_t id) {
    return stand((double)id, 0.0);
}

// The goals left, as they would be asked for.
static void left_are(int n, const int32_t *ids) {
    TEST_ASSERT_EQUAL_UINT32(n, mission.left);
    TEST_ASSERT_EQUAL(n > 0, mission.wanted);
    for (int i = 0; i < n; i++) {
        TEST_ASSERT_EQUAL_INT32(ids[i], mission.list[mission.order[i]].id);
    }
    if (n > 0) {
        TEST_ASSERT_EQUAL_INT32(ids[0], aisle_mission_goal(&mission)->id);
    } else {
        TEST_ASSERT_NULL(aisle_mission_goal(&mission));
    }
}

static void done_are(int n, const int32_t *ids) {
    TEST_ASSERT_EQUAL_UINT32(n, mission.done_count);
    for (int i = 0; i < n; i++) {
        TEST_ASSERT_EQUAL_INT32(ids[i], mission.list[mission.done[i]].id);
    }
}

#define IDS(...)                                                                                                       \
    (int)(sizeof((const int32_t[]){__VA_ARGS__}) / sizeof(int32_t)), (const int32_t[]) {                               \
        __VA_ARGS__                                                                                                    \
    }
#define NONE 0, NULL

void setUp(void) {
    memset(&mission, 0, sizeof mission);
    vehicle = (aisle_vehicle){.d_max = 0.5, .alpha_max = 2.0, .pose_timeout = 0.2};
    pose = (aisle_pose_msg){.utime = 5000000, .localized = 1};
}
void tearDown(void) {}

// ---- lists

static void test_a_list_is_asked_for_as_it_came_from_the_pose(void) {
    begin_list(4, 7, AISLE_GOAL_LIST_ANY_ORDER);
    list.map_id = 3;
    list.options.objective = AISLE_OPTIONS_FASTEST;
    (void)add(9);
    add(2)->dwell = 3.0F;
    take();
    pose.x = 1.5;
    pose.y = -2.0;
    pose.theta = 0.5;
    const aisle_request *request = aisle_mission_ask(&mission, &pose);
    TEST_ASSERT_FALSE(request->is_query);
    TEST_ASSERT_EQUAL_INT32(0, request->query_id);
    TEST_ASSERT_EQUAL_INT32(4, request->goal_list_id);
    TEST_ASSERT_EQUAL_INT32(7, request->goal_list_revision);
    TEST_ASSERT_EQUAL_INT32(3, request->map_id);
    TEST_ASSERT_EQUAL_INT8(AISLE_OPTIONS_FASTEST, request->options.objective);
    TEST_ASSERT_EQUAL_INT8(AISLE_GOAL_LIST_ANY_ORDER, request->ordering);
    TEST_ASSERT_EQUAL_INT16(0, request->kept);
    TEST_ASSERT_EQUAL_INT16(2, request->num_goals);
    TEST_ASSERT_EQUAL_MEMORY(list.goals, request->goals, 2 * sizeof list.goals[0]);
    TEST_ASSERT_EQUAL_INT64(5000000, request->pose_utime);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, request->start.x);
    TEST_ASSERT_EQUAL_DOUBLE(-2.0, request->start.y);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, request->start.theta);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, request->start.tolerance_theta); // heading fixed
    request = aisle_mission_ask(&mission, NULL);
    TEST_ASSERT_EQUAL_INT64(0, request->pose_utime);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, request->start.x);
}

static void test_lists_over_the_limit_or_that_cannot_be_told_apart_are_refused(void) {
    static const int16_t bad[] = {-1, MAX + 1, INT16_MAX, INT16_MIN};
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take_and_plan();
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1));
        list.num_goals = bad[i];
        refused(AISLE_STATUS_LIMIT, bad[i]);
    }
    fill(2, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2, 3, 2));
    refused(AISLE_STATUS_MALFORMED, 2);
    list.goals[3].id = 1;
    refused(AISLE_STATUS_MALFORMED, 1);
    list.goals[3].id = 2;
    list.ordering = 2;
    refused(AISLE_STATUS_MALFORMED, 0);
    list.ordering = -1;
    refused(AISLE_STATUS_MALFORMED, 0);
    list.ordering = AISLE_GOAL_LIST_ORDERED; // which is told by its place
    take();
    left_are(IDS(1, 2, 3, 2));
}

static void test_64_goals_are_taken(void) {
    begin_list(4, 1, AISLE_GOAL_LIST_ANY_ORDER);
    for (int32_t i = 0; i < MAX; i++) {
        (void)add(100 + i);
    }
    take_and_plan();
    for (int32_t i = 0; i < MAX; i++) {
        TEST_ASSERT_EQUAL_INT32(100 + i, aisle_mission_goal(&mission)->id);
        TEST_ASSERT_EQUAL_UINT32(1, stand_on(100 + i));
    }
    TEST_ASSERT_FALSE(mission.wanted);
    TEST_ASSERT_EQUAL_UINT32(MAX, mission.done_count);
}

static void test_the_same_list_again_is_a_duplicate_and_another_one_of_its_name_a_conflict(void) {
    aisle_refusal why;
    fill(5, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take();
    list.utime = 77;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_mission_judge(&mission, &list, &why));
    const aisle_goal_list_msg same = list;
    for (int i = 0; i < 9; i++) {
        list = same;
        aisle_goal_msg *goal = &list.goals[1];
        switch (i) {
        case 0:
            list.map_id = 1;
            break;
        case 1:
            list.ordering = AISLE_GOAL_LIST_ANY_ORDER;
            break;
        case 2:
            list.options.seed = 1;
            break;
        case 3:
            list.num_goals = 1;
            break;
        case 4:
            goal->x += 1e-9;
            break;
        case 5:
            goal->theta = 0.1;
            break;
        case 6:
            goal->tolerance_xy = 0.1F;
            break;
        case 7:
            goal->dwell = 0.1F;
            break;
        default:
            goal->id = 8;
            break;
        }
        refused(AISLE_STATUS_CONFLICT, 5);
    }
    list = same;
    list.goal_list_revision = 4;
    refused(AISLE_STATUS_OUTDATED, 4);
    list.goal_list_id = 3; // another list may have any
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_mission_judge(&mission, &list, &why));
}

static void test_what_names_a_list_stays_known_when_it_is_finished_or_cancelled(void) {
    aisle_refusal why;
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1));
    take_and_plan();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    left_are(NONE);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_mission_judge(&mission, &list, &why));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(2));
    take_and_plan();
    aisle_mission_cancel(&mission);
    left_are(NONE);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_mission_judge(&mission, &list, &why));
    fill(3, AISLE_GOAL_LIST_ORDERED, NONE);
    take();
    left_are(NONE);
    TEST_ASSERT_TRUE(mission.cancelled);
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_mission_judge(&mission, &list, &why));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(2));
    refused(AISLE_STATUS_OUTDATED, 2);
}

// ---- arrival

static void arrives(bool yes) {
    TEST_ASSERT_EQUAL_UINT32(yes ? 1 : 0, aisle_mission_note_pose(&mission, &vehicle, &pose));
    setUp();
    take_and_plan();
}

static void test_arriving_is_resting_within_the_tolerances(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    take_and_plan();
    for (int set = 0; set < 2; set++) { // as by default, and set
        const double xy = set ? 0.2 : 0.05, turn = set ? 0.3 : 0.05;
        list.goals[0].theta = 3.1;
        list.goals[0].tolerance_xy = set ? 0.2F : 0.0F;
        list.goals[0].tolerance_theta = set ? 0.3F : 0.0F;
        setUp();
        take_and_plan();
        for (int i = 0; i < 8; i++) {
            const double angle = 0.8 * i;
            for (int in = 0; in < 2; in++) {
                const double off = (in ? 0.999 : 1.001) * xy;
                pose.x = 3.0 + off * cos(angle);
                pose.y = off * sin(angle);
                pose.theta = 3.1;
                arrives(in);
                pose.x = 3.0;
                pose.theta = 3.1 + (i % 2 ? 1.0 : -1.0) * (in ? 0.999 : 1.001) * turn + 6.283185307179586 * (i - 4);
                arrives(in);
            }
        }
    }
}

static void test_a_heading_that_is_free_may_be_any(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    list.goals[0].tolerance_theta = 3.1415927F;
    take_and_plan();
    for (int i = 0; i < 16; i++) {
        pose.x = 3.0;
        pose.theta = 0.4 * i;
        arrives(true);
    }
}

static void test_who_moves_in_any_way_does_not_arrive(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    take_and_plan();
    for (int i = 0; i < 12; i++) {
        const float v = (i % 2 ? 0.0101F : 0.0099F) * (i < 6 ? 1.0F : -1.0F);
        pose.x = 3.0;
        pose.vx = i / 2 % 3 == 0 ? v : 0.0F;
        pose.vy = i / 2 % 3 == 1 ? v : 0.0F; // sideways
        pose.omega = i / 2 % 3 == 2 ? v : 0.0F;
        arrives(i % 2 == 0);
    }
    pose.x = 3.0;
    pose.vx = pose.vy = 0.008F;
    arrives(false);
}

static void test_a_goal_counts_only_when_a_plan_stood_that_drives_there(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take();
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    ask();
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(2)); // it is not its turn
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(2));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(2));
    left_are(NONE);
    done_are(IDS(1, 2));
}

static void test_goals_reached_are_kept_in_their_order_of_reaching(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2, 3));
    take();
    plan_as((const int32_t[]){3, 1, 2});
    left_are(IDS(3, 1, 2));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    done_are(IDS(3, 1));
    left_are(IDS(2));
}

// ---- stopping over a goal on the way

// Two poses on the way over goal 3, with goal 4 behind: the first one this far from 3 and this fast, the second one farther.
static uint32_t pass(double off, float v) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    setUp();
    list.goals[0].tolerance_theta = 4.0F;
    take_and_plan();
    pose.vx = v;
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.0 + off, 0.0));
    return stand(3.0 + fabs(off) + 0.02, 0.0);
}

static void test_whoever_stopped_over_a_goal_and_goes_on_has_reached_it(void) {
    const float v = 0.2236F; // sqrt(2 * 0.5 * 0.05)
    TEST_ASSERT_EQUAL_UINT32(1, pass(0.0, 0.02F));
    TEST_ASSERT_EQUAL_UINT32(1, pass(-0.049, 0.02F));
    TEST_ASSERT_EQUAL_UINT32(0, pass(-0.051, 0.02F)); // not on it
    TEST_ASSERT_EQUAL_UINT32(1, pass(0.0, v));
    TEST_ASSERT_EQUAL_UINT32(1, pass(0.0, -v));
    TEST_ASSERT_EQUAL_UINT32(0, pass(0.0, v * 1.01F)); // through, not over
    left_are(IDS(3, 4));
}

static void test_coming_near_is_not_reaching_yet(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    take_and_plan();
    pose.vx = 0.1F;
    TEST_ASSERT_EQUAL_UINT32(0, stand(2.96, 0.0));
    TEST_ASSERT_EQUAL_UINT32(0, stand(2.98, 0.0));
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.01, 0.0));
    TEST_ASSERT_EQUAL_UINT32(1, stand(3.02, 0.0));
}

// Noise of the pose must not take a goal from a vehicle that is about to rest on it.
static void test_who_brakes_still_has_not_left_whatever_its_poses_noise(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    take_and_plan();
    static const float speed[] = {0.18F, 0.15F, 0.12F, 0.10F, 0.06F};
    static const double place[] = {2.970, 2.981, 2.992, 2.978, 3.015};
    for (int i = 0; i < 5; i++) {
        pose.vx = speed[i];
        TEST_ASSERT_EQUAL_UINT32(0, stand(place[i], 0.0));
    }
    pose.vx = 0.09F; // up again, but where it was
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.007, 0.0));
    TEST_ASSERT_EQUAL_UINT32(1, stand(3.016, 0.0));
}

static void test_only_poses_in_a_row_show_that_it_stopped(void) {
    for (int how = 0; how < 3; how++) {
        fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
        setUp();
        take_and_plan();
        pose.vx = 0.1F;
        TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
        if (how == 1) {
            pose.utime += 1000000;
        } else if (how == 2) {
            TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, NULL));
        }
        TEST_ASSERT_EQUAL_UINT32(how == 0 ? 1 : 0, stand(3.1, 0.0));
    }
}

static void test_the_last_goal_and_one_with_dwell_want_a_rest(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    take_and_plan();
    pose.vx = 0.02F;
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.02, 0.0));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 0.1F;
    take_and_plan();
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.02, 0.0));
    pose.vx = 0.0F;
    for (int32_t id = 3; id <= 4; id++) {
        setUp();
        begin_list(4, 1, AISLE_GOAL_LIST_ORDERED);
        add(3)->dwell = 1.0F; // before others it need not be seen to the end
        if (id == 4) {
            (void)add(4);
        }
        take_and_plan();
        for (int i = 0; i < 10; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
        }
        pose.vx = 0.02F;
        TEST_ASSERT_EQUAL_UINT32(id == 4 ? 1 : 0, stand(3.001, 0.0));
    }
}

static void test_whoever_leaves_before_the_dwell_can_be_over_has_not_reached_the_goal(void) {
    for (int rests = 7; rests <= 9; rests++) {
        fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
        list.goals[0].dwell = 1.0F;
        setUp();
        take_and_plan();
        pose.vx = 0.3F;
        TEST_ASSERT_EQUAL_UINT32(0, stand(2.96, 0.0)); // too fast to stop here: at rest after it, if at all
        pose.vx = 0.0F;
        for (int i = 0; i < rests; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
        }
        pose.vx = 0.1F;
        TEST_ASSERT_EQUAL_UINT32(rests == 9 ? 1 : 0, stand(3.06, 0.0)); // 0.1 s to either side
        TEST_ASSERT_EQUAL_UINT32(0, stand(3.2, 0.0));
        left_are(rests == 9 ? 1 : 2, rests == 9 ? (const int32_t[]){4, 0} : (const int32_t[]){3, 4});
    }
}

static void test_a_dwell_wants_one_pose_at_rest(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 1.0F;
    take_and_plan();
    pose.vx = 0.02F;
    for (int i = 0; i < 20; i++) { // creeps over it
        TEST_ASSERT_EQUAL_UINT32(0, stand(2.96 + 0.002 * i, 0.0));
    }
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.04, 0.0));
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.1, 0.0));
}

static void test_a_shake_begins_the_dwell_again_but_is_no_leaving(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 1.0F;
    take_and_plan();
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    pose.vx = 0.02F;
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    pose.vx = 0.0F;
    for (int i = 0; i < 10; i++) { // a noisy pose
        TEST_ASSERT_EQUAL_UINT32(0, stand(3.0 + 1e-4 * i, 0.0));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_who_leaves_slowly_has_stayed_all_the_same(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 1.0F;
    list.goals[0].tolerance_theta = 4.0F;
    take_and_plan();
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    pose.omega = 0.5F; // where it turns first
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_who_has_rested_and_shakes_has_rested(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 1.0F;
    take_and_plan();
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    pose.vx = 0.02F;
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_what_was_before_a_break_is_no_part_of_a_stay(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 1.0F;
    take_and_plan();
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, NULL));
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    pose.vx = 0.1F;
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.06, 0.0));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(3, 3, 4)); // nor what was spent on the goal before
    list.goals[1].dwell = 0.5F;
    take_and_plan();
    pose.vx = 0.0F;
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    pose.vx = 0.1F;
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.06, 0.0));
}

static void test_the_smallest_tolerance_can_be_met(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    list.goals[0].tolerance_xy = list.goals[0].tolerance_theta = 1e-6F;
    take_and_plan();
    pose.x = 3.0;
    pose.vx = pose.omega = 0.009F;
    arrives(true);
}

static void test_a_heading_given_is_part_of_stopping_over_a_goal(void) {
    const float rate = 0.4472F; // sqrt(2 * 2 * 0.05)
    for (int i = 0; i < 4; i++) {
        fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
        list.goals[0].theta = 1.0;
        setUp();
        take_and_plan();
        pose.theta = i == 1 ? 1.06 : 1.04;
        pose.omega = i == 2 ? rate * 1.01F : rate;
        TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
        pose.theta = i == 3 ? 1.03 : 1.07; // turns away
        TEST_ASSERT_EQUAL_UINT32(i == 0 ? 1 : 0, stand(3.0, 0.0));
    }
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].tolerance_theta = 3.1415927F; // it does not matter: turning is not leaving
    setUp();
    take_and_plan();
    pose.omega = 5.0F;
    for (int i = 0; i < 8; i++) {
        pose.theta += 0.1;
        TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand(3.01, 0.0));
}

static void test_a_stop_over_a_goal_counts_though_the_list_is_extended_just_then(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(3, 4));
    take_and_plan();
    pose.vx = 0.02F;
    TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, 0.0));
    fill(2, AISLE_GOAL_LIST_ANY_ORDER, IDS(4, 5, 3));
    take();
    TEST_ASSERT_EQUAL_UINT32(1, stand(3.01, 0.0));
}

// Along a line with a goal at every metre, braking to rest on each and leaving it in time, by a controller that lags behind.
static void test_a_vehicle_that_follows_its_path_reaches_every_goal_whatever_its_lag_and_rate_of_poses(void) {
    int hits = 0;
    for (int run = 0; run < 60; run++) {
        const double lag = 0.04 * (run % 6), dwell = run < 30 ? 0.0 : 1.0, period = 0.02 + 0.02 * (run / 6 % 5),
                     phase = 0.0071 * run;
        setUp();
        begin_list(4, 1, AISLE_GOAL_LIST_ORDERED);
        for (int32_t id = 1; id <= 9; id++) {
            add(id)->dwell = (float)dwell;
        }
        take_and_plan();
        double x = 0.0, v = 0.0, next = phase;
        const double half = sqrt(1.0 / 0.5); // s, from rest to the middle of a metre
        const double way = 2.0 * half + dwell;
        for (double t = 0.0; t < 9.0 * way + 2.0; t += 0.001) {
            const double in = fmod(t, way);
            const double wanted = t >= 9.0 * way ? 0.0 : 0.5 * fmax(in < half ? in : 2.0 * half - in, 0.0);
            v += lag > 0.0 ? (wanted - v) * 0.001 / lag : wanted - v;
            x += v * 0.001;
            if (t >= next) {
                next += period;
                pose.utime = 5000000 + (int64_t)(t * 1e6);
                pose.vx = (float)v;
                pose.x = x;
                (void)aisle_mission_note_pose(&mission, &vehicle, &pose);
            }
        }
        hits += !mission.wanted;
    }
    TEST_ASSERT_EQUAL_INT(60, hits);
}

// ---- dwell

static void dwell_list(float dwell) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3));
    list.goals[0].dwell = dwell;
    take_and_plan();
}

static void test_a_goal_is_reached_after_its_dwell_by_the_poses_time(void) {
    dwell_list(2.0F);
    for (int i = 0; i < 20; i++) { // from the first one on: 1.9 s
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_whoever_leaves_or_moves_begins_the_dwell_again(void) {
    for (int how = 0; how < 5; how++) {
        setUp();
        dwell_list(1.0F);
        for (int i = 0; i < 9; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
        }
        pose.vx = how == 0 ? 0.1F : 0.0F;
        pose.omega = how == 1 ? 0.1F : 0.0F;
        pose.theta = how == 2 ? 0.1 : 0.0;
        if (how == 4) {
            TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, NULL)); // who knows where it is
        } else {
            TEST_ASSERT_EQUAL_UINT32(0, stand(3.0, how == 3 ? 0.1 : 0.0));
        }
        pose.vx = pose.omega = 0.0F;
        pose.theta = 0.0;
        for (int i = 0; i < 10; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
        }
        TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    }
}

static void test_poses_too_far_apart_do_not_tell_that_it_rested(void) {
    dwell_list(1.0F);
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    pose.utime += 900000; // 1.0 s with the one that stand() adds
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    setUp();
    dwell_list(1.0F);
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    pose.utime += 900001;
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    vehicle.pose_timeout = 3.0; // where more is usual
    pose.utime += 2900000;
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    setUp();
    dwell_list(1.0F);
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    pose.utime += 3600000000; // a clock that jumps
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_times_far_apart_overflow_nothing(void) {
    dwell_list(1.0F);
    vehicle.pose_timeout = 1e9;
    pose.utime = INT64_MIN;
    pose.x = 3.0;
    TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, &pose));
    pose.utime = INT64_MAX;
    TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, &pose)); // no row
    TEST_ASSERT_EQUAL_UINT32(0, aisle_mission_note_pose(&mission, &vehicle, &pose));
}

static void test_goals_in_one_place_have_their_dwells_in_turn(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 3, 3, 3));
    list.goals[0].dwell = 0.3F;
    list.goals[2].dwell = 0.5F;
    take_and_plan();
    static const uint32_t counts[] = {0, 0, 0, 2, 0, 0, 0, 0, 2, 0};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32(counts[i], stand_on(3));
    }
}

static void test_a_new_plan_for_the_same_goal_does_not_begin_the_dwell_again(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 2.0F;
    take_and_plan();
    for (int i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    aisle_mission_reconsider(&mission);
    ask();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.0F, asked.goals[0].dwell); // what is left of it
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    (void)plan();
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    ask();
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.1F, asked.goals[0].dwell);
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    TEST_ASSERT_EQUAL_FLOAT(2.0F, mission.list[0].dwell); // which is still the list's
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(3, 4));
    list.goals[0].dwell = 2.0F;
    take();
    left_are(IDS(4));
}

static void test_a_plan_that_drives_elsewhere_first_begins_a_dwell_of_its_own(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(3, 4));
    list.goals[0].dwell = list.goals[1].dwell = 1.0F;
    list.goals[1].x = 3.0; // in one place
    take_and_plan();
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    aisle_mission_reconsider(&mission);
    plan_as((const int32_t[]){4, 3});
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    left_are(IDS(3));
}

static void test_a_dwell_that_is_over_is_asked_for_as_none(void) {
    dwell_list(1.0F);
    (void)stand_on(3);
    pose.utime += 700000;
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    mission.list[0].dwell = 0.5F; // as if it were shorter
    ask();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, asked.goals[0].dwell);
}

// ---- plans

static void test_goals_reached_while_planning_are_passed_by_the_plan(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3, 2));
    take_and_plan();
    ask();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(2));
    TEST_ASSERT_EQUAL_UINT32(2, plan());
    left_are(IDS(3, 2));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
    left_are(IDS(2));
}

static void test_a_plan_whose_order_has_a_reached_goal_in_the_middle_is_not_taken(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2, 3));
    take_and_plan();
    aisle_mission_reconsider(&mission);
    ask();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    const aisle_goal_msg first = asked.goals[0];
    asked.goals[0] = asked.goals[2];
    asked.goals[2] = first;
    TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
    TEST_ASSERT_FALSE(aisle_mission_fits(&mission, &asked)); // 3, 2, 1
    left_are(IDS(2, 3));
    asked.goals[2] = asked.goals[0];
    asked.goals[0] = first;
    TEST_ASSERT_EQUAL_UINT32(1, plan()); // 1, 2, 3
}

static void test_requests_are_out_of_date_when_list_or_wishes_change(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take_and_plan();
    ask();
    TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
    (void)stand_on(1);
    aisle_mission_reconsider(&mission); // planned on the other layout already: it is not taken while one is planned
    TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 3));
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
    ask();
    TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
    ask();
    aisle_mission_cancel(&mission);
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
    begin_list(6, 1, AISLE_GOAL_LIST_ORDERED);
    (void)add(2);
    take_and_plan();
    ask();
    (void)stand_on(2); // all is reached
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
}

static void test_an_order_is_kept_until_there_is_a_reason(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2, 3, 4, 5));
    take();
    ask();
    TEST_ASSERT_EQUAL_INT16(0, asked.kept);
    plan_as((const int32_t[]){5, 3, 1, 2, 4});
    ask();
    TEST_ASSERT_EQUAL_INT16(5, asked.kept);
    TEST_ASSERT_EQUAL_INT32(5, asked.goals[0].id);
    (void)stand_on(5);
    ask();
    TEST_ASSERT_EQUAL_INT16(4, asked.kept);
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 1));
    ask();
    TEST_ASSERT_EQUAL_INT16(1, asked.kept); // the one being driven to
    TEST_ASSERT_EQUAL_INT32(3, asked.goals[0].id);
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 3));
    ask();
    TEST_ASSERT_EQUAL_INT16(0, asked.kept);
    (void)plan();
    aisle_mission_reconsider(&mission);
    ask();
    TEST_ASSERT_EQUAL_INT16(0, asked.kept);
}

// ---- another list or revision

static void test_another_list_begins_anew(void) {
    fill(3, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    (void)stand_on(1);
    begin_list(5, 1, AISLE_GOAL_LIST_ORDERED);
    (void)add(1);
    (void)add(2);
    take();
    left_are(IDS(1, 2));
    done_are(NONE);
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1)); // not planned yet
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
}

static void test_an_extended_list_keeps_what_was_reached(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    (void)stand_on(1);
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    left_are(IDS(2, 3));
    done_are(IDS(1));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(2)); // still the one driven to, plan or not
    done_are(IDS(1, 2));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3)); // which no plan drives to yet
    left_are(IDS(3));
}

static void test_a_list_extended_after_its_end_goes_on(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    (void)stand_on(1);
    (void)stand_on(2);
    left_are(NONE);
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    left_are(IDS(3));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

static void test_a_revision_of_which_all_is_reached_is_finished_at_once(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    (void)stand_on(1);
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1));
    take();
    left_are(NONE);
    TEST_ASSERT_FALSE(mission.cancelled);
    done_are(IDS(1));
}

static void test_a_goal_of_other_content_is_another_goal(void) {
    for (int i = 0; i < 7; i++) {
        setUp();
        fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
        take_and_plan();
        (void)stand_on(1);
        list.goal_list_revision = 2;
        aisle_goal_msg *goal = &list.goals[0];
        switch (i) {
        case 0:
            goal->x += 1e-9;
            break;
        case 1:
            goal->y = -1e-9;
            break;
        case 2:
            goal->theta = 1e-9;
            break;
        case 3:
            goal->tolerance_xy = 0.01F;
            break;
        case 4:
            goal->tolerance_theta = 0.01F;
            break;
        case 5:
            goal->id = 8;
            break;
        default:
            goal->dwell = 0.01F;
            break;
        }
        take();
        left_are(2, (const int32_t[]){i == 5 ? 8 : 1, 2});
        done_are(NONE);
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(1)); // and not driven to yet
    }
}

static void test_a_number_that_is_none_equals_nothing(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    (void)stand_on(1);
    list.goal_list_revision = 2;
    list.goals[0].x = (double)NAN;
    take();
    left_are(IDS(1, 2));
}

static void test_of_equal_goals_as_many_stay_reached_as_were(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 1, 2));
    take_and_plan();
    (void)stand_on(1);
    (void)stand_on(2);
    (void)stand_on(1);
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 1, 2, 1, 2));
    take();
    left_are(IDS(2, 1, 2));
    done_are(IDS(1, 2, 1));
    fill(3, AISLE_GOAL_LIST_ORDERED, IDS(2, 2, 1));
    take();
    left_are(IDS(2));
    done_are(IDS(1, 2));
}

static void test_a_goal_put_in_front_is_driven_to_first_in_an_ordered_list(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take_and_plan();
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(7, 1, 2));
    take();
    left_are(IDS(7, 1, 2));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(7));
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(7));
}

static void test_in_any_order_the_goal_being_driven_to_stays_the_first(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2, 3, 4));
    take();
    plan_as((const int32_t[]){3, 4, 2, 1});
    (void)stand_on(3);
    fill(2, AISLE_GOAL_LIST_ANY_ORDER, IDS(9, 1, 2, 3, 4));
    take();
    left_are(IDS(4, 9, 1, 2));
    ask();
    TEST_ASSERT_EQUAL_INT16(1, asked.kept);
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(4)); // it counts, plan or not
    TEST_ASSERT_EQUAL_UINT32(1, plan());
    ask();
    TEST_ASSERT_EQUAL_INT16(3, asked.kept);
    fill(3, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2)); // it is gone
    take();
    left_are(IDS(1, 2));
    ask();
    TEST_ASSERT_EQUAL_INT16(0, asked.kept);
}

static void test_a_goal_no_plan_drives_to_yet_is_kept_in_no_place(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(3, 4));
    take();
    fill(2, AISLE_GOAL_LIST_ANY_ORDER, IDS(4, 3));
    take();
    left_are(IDS(4, 3));
    ask();
    TEST_ASSERT_EQUAL_INT16(0, asked.kept);
}

static void test_the_dwell_goes_on_in_a_newer_revision(void) {
    fill(1, AISLE_GOAL_LIST_ANY_ORDER, IDS(1, 2));
    list.goals[0].dwell = 1.0F;
    take_and_plan();
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    }
    fill(2, AISLE_GOAL_LIST_ANY_ORDER, IDS(2, 1));
    list.goals[1].dwell = 1.0F;
    take();
    left_are(IDS(1, 2));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
}

static void test_a_cancelled_list_is_forgotten(void) {
    for (int how = 0; how < 2; how++) {
        setUp();
        fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
        take_and_plan();
        (void)stand_on(1);
        if (how == 0) {
            aisle_mission_cancel(&mission);
        } else {
            fill(2, AISLE_GOAL_LIST_ORDERED, NONE);
            take();
        }
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(2));
        fill(3, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
        take();
        left_are(IDS(1, 2));
        done_are(NONE);
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(1));
    }
}

// ---- skipping

static void test_a_goal_is_skipped_by_its_id_and_the_last_one_ends_the_mission(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take_and_plan();
    (void)stand_on(1);
    TEST_ASSERT_FALSE(aisle_mission_skip(&mission, 1)); // reached
    TEST_ASSERT_FALSE(aisle_mission_skip(&mission, 9));
    TEST_ASSERT_FALSE(mission.replan);
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 3));
    TEST_ASSERT_TRUE(mission.replan);
    left_are(IDS(2));
    TEST_ASSERT_FALSE(aisle_mission_skip(&mission, 3));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 2));
    left_are(NONE);
    TEST_ASSERT_FALSE(mission.replan);
    TEST_ASSERT_FALSE(mission.cancelled);
    TEST_ASSERT_FALSE(aisle_mission_skip(&mission, 2));
    done_are(IDS(1));
}

static void test_after_the_first_goal_is_skipped_the_next_one_waits_for_its_plan(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take_and_plan();
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 3));
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1)); // driven to all the while
    ask();
    (void)plan();
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 2));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(4, 5));
    take_and_plan();
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 4));
    TEST_ASSERT_EQUAL_UINT32(0, stand_on(5));
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(5));
}

static void test_of_goals_that_share_an_id_the_first_one_left_is_skipped(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 1, 2));
    take_and_plan();
    (void)stand_on(1);
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 1));
    left_are(IDS(2, 2));
    TEST_ASSERT_FALSE(aisle_mission_skip(&mission, 1));
}

static void test_what_was_skipped_on_command_stays_so_in_a_newer_revision(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take_and_plan();
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 2));
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3, 4));
    take();
    left_are(IDS(1, 3, 4));
    done_are(NONE);
    fill(3, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3, 4));
    list.goals[1].dwell = 1.0F; // another one
    take();
    left_are(IDS(1, 2, 3, 4));
    begin_list(5, 1, AISLE_GOAL_LIST_ORDERED);
    (void)add(2);
    take();
    left_are(IDS(2));
}

static void test_the_dwell_of_the_goal_behind_one_that_is_skipped_begins_anew(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(3, 3));
    list.goals[0].dwell = list.goals[1].dwell = 1.0F;
    take_and_plan();
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 3));
    ask();
    (void)plan();
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, stand_on(3));
    }
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(3));
}

// ---- out of reach

static void test_what_is_a_proof_and_what_is_none(void) {
    int proofs = 0;
    for (int16_t cause = 0; cause < 600; cause++) {
        proofs += aisle_mission_is_out_of_reach(cause);
    }
    TEST_ASSERT_EQUAL_INT(4, proofs);
    TEST_ASSERT_TRUE(aisle_mission_is_out_of_reach(AISLE_STATUS_NO_PATH));
    TEST_ASSERT_TRUE(aisle_mission_is_out_of_reach(AISLE_STATUS_TOO_NARROW));
    TEST_ASSERT_TRUE(aisle_mission_is_out_of_reach(AISLE_STATUS_GOAL_OCCUPIED));
    TEST_ASSERT_TRUE(aisle_mission_is_out_of_reach(AISLE_STATUS_GOAL_OUTSIDE));
}

static void test_a_goal_out_of_reach_is_given_up_when_the_others_are_planned(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    ask();
    TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 1));
    TEST_ASSERT_TRUE(mission.replan);
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
    left_are(IDS(1, 3));
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT8(AISLE_GOAL_UNREACHABLE, mission.fate[1]);
    aisle_mission_reconsider(&mission);
    left_are(IDS(1, 3)); // for good,
    (void)stand_on(1);
    fill(2, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    left_are(IDS(2, 3)); // but for a newer revision
}

static void test_a_mission_ends_without_what_was_given_up(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2));
    take();
    ask();
    TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 1));
    ask();
    (void)plan();
    TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
    left_are(NONE);
    TEST_ASSERT_FALSE(mission.replan);
    done_are(IDS(1));
}

static void test_if_none_can_be_reached_none_is_given_up(void) {
    for (int8_t ordering = 0; ordering < 2; ordering++) {
        setUp();
        fill(1, ordering, IDS(1, 2, 3));
        take();
        ask();
        TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 1));
        ask();
        TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 0));
        ask();
        TEST_ASSERT_FALSE(aisle_mission_set_aside(&mission, &asked, 0));
        TEST_ASSERT_FALSE(mission.replan);
        left_are(IDS(1, 2, 3));
        ask();
        (void)plan(); // when the hall is another one
        TEST_ASSERT_EQUAL_UINT32(1, stand_on(1));
        left_are(IDS(2, 3));
    }
}

static void test_what_is_set_aside_is_tried_again_on_another_layout(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 3));
    take();
    ask();
    TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 0)); // and the others are not planned: no budget, say
    ask();
    aisle_mission_reconsider(&mission);
    TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
    left_are(IDS(1, 2, 3));
}

static void test_what_comes_back_does_not_touch_the_goal_being_driven_to(void) {
    for (int8_t ordering = 0; ordering < 2; ordering++) {
        setUp();
        fill(1, ordering, IDS(2));
        list.goals[0].dwell = 1.0F;
        take_and_plan();
        fill(2, ordering, IDS(2, 3, 4));
        list.goals[0].dwell = 1.0F;
        take();
        ask();
        TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 1));
        for (int i = 0; i < 10; i++) {
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(2));
        }
        aisle_mission_reconsider(&mission);
        TEST_ASSERT_EQUAL_INT32(2, aisle_mission_goal(&mission)->id);
        TEST_ASSERT_EQUAL_UINT32(3, mission.left);
        TEST_ASSERT_EQUAL_UINT32(1, stand_on(2));
    }
}

static void test_a_goal_reached_meanwhile_is_not_set_aside(void) {
    for (int8_t ordering = 0; ordering < 2; ordering++) {
        setUp();
        fill(1, ordering, IDS(1, 2, 3));
        take_and_plan();
        ask();
        (void)stand_on(1);
        TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 0));
        TEST_ASSERT_TRUE(mission.replan);
        left_are(IDS(2, 3));
        TEST_ASSERT_FALSE(aisle_mission_is_stale(&mission, &asked));
        TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 2)); // the right one of those behind
        left_are(IDS(2));
    }
}

static void test_the_last_goal_reached_or_skipped_brings_back_what_is_only_set_aside(void) {
    for (int how = 0; how < 2; how++) {
        for (int8_t ordering = 0; ordering < 2; ordering++) {
            setUp();
            fill(1, ordering, IDS(1));
            take_and_plan();
            fill(2, ordering, IDS(1, 2));
            take();
            ask();
            TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 1));
            ask();
            if (how == 0) {
                TEST_ASSERT_EQUAL_UINT32(1, stand_on(1)); // before the others' plan stands
            } else {
                TEST_ASSERT_TRUE(aisle_mission_skip(&mission, 1));
            }
            left_are(IDS(2));
            TEST_ASSERT_TRUE(mission.replan);
            TEST_ASSERT_TRUE(aisle_mission_is_stale(&mission, &asked));
            TEST_ASSERT_EQUAL_UINT32(0, stand_on(2));
        }
    }
}

static void test_of_goals_that_share_an_id_the_one_meant_is_set_aside(void) {
    fill(1, AISLE_GOAL_LIST_ORDERED, IDS(1, 2, 1, 3));
    list.goals[2].y = 5.0;
    take();
    ask();
    TEST_ASSERT_TRUE(aisle_mission_set_aside(&mission, &asked, 2));
    left_are(IDS(1, 2, 3));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, mission.list[mission.order[0]].y);
}

// ---- long runs against a plain model

// Goals are ids 1 to 9 in two kinds each (their dwell); sets are bits, sequences strings of ids.
enum { RUNS = 400, EVENTS = 120, GOALS = 9 };

typedef struct model {
    char given[GOALS + 1], left[GOALS + 1], driven[GOALS + 1], done[GOALS + 1]; // driven: by the plan, in its order
    int kind[GOALS + 1];
    bool was[GOALS + 1][2];   // reached or skipped on command, in this list
    unsigned aside, given_up; // sets
    int32_t id, revision;
    bool any_order, cancelled;
} model;

static model expected;
static aisle_rng rng;

static int draw(int n) {
    return (int)(aisle_rng_float(&rng) * (float)n);
}

static void append(char *sequence, int id) {
    const size_t n = strlen(sequence);
    sequence[n] = (char)('0' + id);
    sequence[n + 1] = '\0';
}

static void drop(char *sequence, int id) {
    char *at = strchr(sequence, '0' + id);
    if (at != NULL) {
        memmove(at, at + 1, strlen(at));
    }
}

static void cut_from(char *sequence, int id) {
    char *at = strchr(sequence, '0' + id);
    if (at != NULL) {
        *at = '\0';
    }
}

static void to_front(char *sequence, int id) {
    drop(sequence, id);
    memmove(sequence + 1, sequence, strlen(sequence) + 1);
    sequence[0] = (char)('0' + id);
}

// Left in the order they were given; whoever was driven to stays the first if it may.
static void model_line_up(model *it, int first) {
    it->left[0] = '\0';
    for (const char *c = it->given; *c != '\0'; c++) {
        const int id = *c - '0';
        if (!it->was[id][it->kind[id]] && ((it->aside | it->given_up) >> id & 1U) == 0U) {
            append(it->left, id);
        }
    }
    it->driven[0] = '\0';
    if (first != 0 && strchr(it->left, '0' + first) != NULL && (it->any_order || it->left[0] == '0' + first)) {
        to_front(it->left, first);
        append(it->driven, first);
    }
}

static int driven_to(const model *it) {
    return it->driven[0] == '\0' ? 0 : it->driven[0] - '0';
}

static void model_bring_back(model *it) {
    const int first = driven_to(it);
    if (it->any_order && it->left[0] != '\0') {
        for (const char *c = it->given; *c != '\0'; c++) {
            if ((it->aside >> (*c - '0') & 1U) != 0U) {
                append(it->left, *c - '0');
            }
        }
        it->aside = 0;
    } else if (it->aside != 0U) {
        it->aside = 0;
        model_line_up(it, first);
    }
}

static void random_list(void) {
    model *it = &expected;
    const bool is_other = draw(6) == 0;
    const int first = is_other || it->cancelled ? 0 : driven_to(it), first_kind = it->kind[first];
    char before[GOALS + 1];
    memcpy(before, it->done, sizeof before);
    const int kinds_before[GOALS + 1] = {0,           it->kind[1], it->kind[2], it->kind[3], it->kind[4],
                                         it->kind[5], it->kind[6], it->kind[7], it->kind[8], it->kind[9]};
    it->id += is_other;
    it->revision += 1 + draw(3);
    it->any_order = draw(2) == 0;
    begin_list(it->id, it->revision, it->any_order ? AISLE_GOAL_LIST_ANY_ORDER : AISLE_GOAL_LIST_ORDERED);
    if (is_other || it->cancelled) {
        memset(it->was, 0, sizeof it->was);
        before[0] = '\0';
    }
    it->given[0] = it->done[0] = '\0';
    for (int n = draw(GOALS); n >= 0; n--) {
        const int id = 1 + draw(GOALS);
        if (strchr(it->given, '0' + id) == NULL) {
            append(it->given, id);
            it->kind[id] = draw(5) == 0 ? !it->kind[id] : it->kind[id];
            add(id)->dwell = it->kind[id] ? 0.05F : 0.0F;
        }
    }
    for (const char *c = before; *c != '\0'; c++) {
        if (strchr(it->given, *c) != NULL && kinds_before[*c - '0'] == it->kind[*c - '0']) {
            append(it->done, *c - '0');
        }
    }
    bool kept[GOALS + 1][2] = {{false}};
    for (const char *c = it->given; *c != '\0'; c++) { // what is not in the newest list is forgotten
        const int id = *c - '0';
        kept[id][it->kind[id]] = it->was[id][it->kind[id]];
    }
    memcpy(it->was, kept, sizeof kept);
    it->aside = it->given_up = 0;
    it->cancelled = false;
    model_line_up(it, first != 0 && it->kind[first] == first_kind ? first : 0);
    take();
}

static void random_pose(void) {
    model *it = &expected;
    int id = draw(3) == 0 ? 1 + draw(GOALS) : driven_to(it);
    id = id == 0 ? 1 : id;
    const bool counts = driven_to(it) == id;
    uint32_t reached = stand_on(id);
    if (reached == 0 && counts) { // a dwell of half the time between poses
        TEST_ASSERT_EQUAL_INT(1, it->kind[id]);
        reached = stand_on(id);
    }
    TEST_ASSERT_EQUAL_UINT32(counts, reached);
    if (counts) {
        drop(it->left, id);
        drop(it->driven, id);
        append(it->done, id);
        it->was[id][it->kind[id]] = true;
        if (it->left[0] == '\0') {
            model_bring_back(it);
        }
    }
}

static void random_skip(void) {
    model *it = &expected;
    const int id = 1 + draw(GOALS);
    const bool is_left = strchr(it->left, '0' + id) != NULL;
    TEST_ASSERT_EQUAL(is_left, aisle_mission_skip(&mission, id));
    if (is_left) {
        cut_from(it->driven, id);
        drop(it->left, id);
        it->was[id][it->kind[id]] = true;
        if (it->left[0] == '\0') {
            model_bring_back(it);
        }
    }
}

// A plan from asking to its end, with or without poses in between: in a random order of those that may be ordered.
static void random_plan(void) {
    model *it = &expected;
    if (!mission.wanted) {
        return;
    }
    ask();
    TEST_ASSERT_EQUAL_size_t(strlen(it->left), asked.num_goals);
    for (int16_t i = asked.kept; it->any_order && i + 1 < asked.num_goals; i++) {
        const int k = i + draw(asked.num_goals - i);
        const aisle_goal_msg moved = asked.goals[i];
        asked.goals[i] = asked.goals[k];
        asked.goals[k] = moved;
    }
    if (draw(3) == 0) {
        const int k = draw(asked.num_goals), id = asked.goals[k].id;
        cut_from(it->driven, id);
        drop(it->left, id);
        it->aside |= 1U << id;
        TEST_ASSERT_EQUAL(it->left[0] != '\0', aisle_mission_set_aside(&mission, &asked, (uint32_t)k));
        if (it->left[0] == '\0') {
            model_bring_back(it);
        }
        return;
    }
    if (draw(2) == 0) {
        random_pose();
    }
    if (aisle_mission_is_stale(&mission, &asked)) {
        return;
    }
    const size_t ahead = (size_t)asked.num_goals - strlen(it->left);
    bool fits = true; // what was reached is what the plan has first
    for (size_t i = 0; i < (size_t)asked.num_goals; i++) {
        fits = fits && (strchr(it->left, '0' + asked.goals[i].id) == NULL) == (i < ahead);
    }
    TEST_ASSERT_EQUAL(fits, aisle_mission_fits(&mission, &asked));
    if (fits) {
        TEST_ASSERT_EQUAL_size_t(ahead, aisle_mission_take_order(&mission, &asked));
        it->left[0] = '\0';
        for (size_t i = ahead; i < (size_t)asked.num_goals; i++) {
            append(it->left, asked.goals[i].id);
        }
        memcpy(it->driven, it->left, sizeof it->left);
        it->given_up |= it->aside;
        it->aside = 0;
    }
}

static void random_event(void) {
    model *it = &expected;
    switch (draw(12)) {
    case 0:
        random_list();
        break;
    case 1:
        random_skip();
        break;
    case 2:
        aisle_mission_reconsider(&mission);
        model_bring_back(it);
        break;
    case 3:
        if (draw(5) == 0) {
            aisle_mission_cancel(&mission);
            memset(it->was, 0, sizeof it->was);
            it->given[0] = it->left[0] = it->driven[0] = it->done[0] = '\0';
            it->aside = it->given_up = 0;
            it->cancelled = true;
        }
        break;
    case 4:
    case 5:
    case 6:
        random_plan();
        break;
    default:
        random_pose();
        break;
    }
}

static void is_as_expected(void) {
    const model *it = &expected;
    TEST_ASSERT_EQUAL_size_t(strlen(it->left), mission.left);
    TEST_ASSERT_EQUAL_size_t(strlen(it->done), mission.done_count);
    TEST_ASSERT_EQUAL_size_t(strlen(it->driven), mission.sent);
    TEST_ASSERT_EQUAL(it->left[0] != '\0', mission.wanted);
    TEST_ASSERT_TRUE(mission.kept <= mission.left);
    TEST_ASSERT_EQUAL_INT(0, strncmp(it->driven, it->left, strlen(it->driven)));
    for (uint32_t i = 0; i < mission.left; i++) {
        TEST_ASSERT_EQUAL_INT32(it->left[i] - '0', mission.list[mission.order[i]].id);
    }
    for (uint32_t i = 0; i < mission.done_count; i++) {
        TEST_ASSERT_EQUAL_INT32(it->done[i] - '0', mission.list[mission.done[i]].id);
    }
}

static void test_long_runs_go_as_a_plain_model_says(void) {
    int ended = 0, reached = 0, given_up = 0;
    for (int run = 0; run < RUNS; run++) {
        setUp();
        memset(&expected, 0, sizeof expected);
        expected.cancelled = true; // there is no list yet
        rng = aisle_rng_seed((uint64_t)run);
        random_list();
        for (int i = 0; i < EVENTS; i++) {
            random_event();
            is_as_expected();
            ended += expected.left[0] == '\0' && expected.done[0] != '\0';
            given_up += expected.given_up != 0U;
        }
        reached += (int)strlen(expected.done);
    }
    TEST_ASSERT_GREATER_THAN_INT(RUNS, ended); // it is not idle
    TEST_ASSERT_GREATER_THAN_INT(RUNS / 2, reached);
    TEST_ASSERT_GREATER_THAN_INT(RUNS, given_up);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_list_is_asked_for_as_it_came_from_the_pose);
    RUN_TEST(test_lists_over_the_limit_or_that_cannot_be_told_apart_are_refused);
    RUN_TEST(test_64_goals_are_taken);
    RUN_TEST(test_the_same_list_again_is_a_duplicate_and_another_one_of_its_name_a_conflict);
    RUN_TEST(test_what_names_a_list_stays_known_when_it_is_finished_or_cancelled);
    RUN_TEST(test_arriving_is_resting_within_the_tolerances);
    RUN_TEST(test_a_heading_that_is_free_may_be_any);
    RUN_TEST(test_who_moves_in_any_way_does_not_arrive);
    RUN_TEST(test_a_goal_counts_only_when_a_plan_stood_that_drives_there);
    RUN_TEST(test_goals_reached_are_kept_in_their_order_of_reaching);
    RUN_TEST(test_whoever_stopped_over_a_goal_and_goes_on_has_reached_it);
    RUN_TEST(test_coming_near_is_not_reaching_yet);
    RUN_TEST(test_who_brakes_still_has_not_left_whatever_its_poses_noise);
    RUN_TEST(test_only_poses_in_a_row_show_that_it_stopped);
    RUN_TEST(test_the_last_goal_and_one_with_dwell_want_a_rest);
    RUN_TEST(test_whoever_leaves_before_the_dwell_can_be_over_has_not_reached_the_goal);
    RUN_TEST(test_a_dwell_wants_one_pose_at_rest);
    RUN_TEST(test_a_shake_begins_the_dwell_again_but_is_no_leaving);
    RUN_TEST(test_who_leaves_slowly_has_stayed_all_the_same);
    RUN_TEST(test_who_has_rested_and_shakes_has_rested);
    RUN_TEST(test_what_was_before_a_break_is_no_part_of_a_stay);
    RUN_TEST(test_the_smallest_tolerance_can_be_met);
    RUN_TEST(test_a_heading_given_is_part_of_stopping_over_a_goal);
    RUN_TEST(test_a_stop_over_a_goal_counts_though_the_list_is_extended_just_then);
    RUN_TEST(test_a_vehicle_that_follows_its_path_reaches_every_goal_whatever_its_lag_and_rate_of_poses);
    RUN_TEST(test_a_goal_is_reached_after_its_dwell_by_the_poses_time);
    RUN_TEST(test_whoever_leaves_or_moves_begins_the_dwell_again);
    RUN_TEST(test_poses_too_far_apart_do_not_tell_that_it_rested);
    RUN_TEST(test_times_far_apart_overflow_nothing);
    RUN_TEST(test_goals_in_one_place_have_their_dwells_in_turn);
    RUN_TEST(test_a_new_plan_for_the_same_goal_does_not_begin_the_dwell_again);
    RUN_TEST(test_a_plan_that_drives_elsewhere_first_begins_a_dwell_of_its_own);
    RUN_TEST(test_a_dwell_that_is_over_is_asked_for_as_none);
    RUN_TEST(test_goals_reached_while_planning_are_passed_by_the_plan);
    RUN_TEST(test_a_plan_whose_order_has_a_reached_goal_in_the_middle_is_not_taken);
    RUN_TEST(test_requests_are_out_of_date_when_list_or_wishes_change);
    RUN_TEST(test_an_order_is_kept_until_there_is_a_reason);
    RUN_TEST(test_another_list_begins_anew);
    RUN_TEST(test_an_extended_list_keeps_what_was_reached);
    RUN_TEST(test_a_list_extended_after_its_end_goes_on);
    RUN_TEST(test_a_revision_of_which_all_is_reached_is_finished_at_once);
    RUN_TEST(test_a_goal_of_other_content_is_another_goal);
    RUN_TEST(test_a_number_that_is_none_equals_nothing);
    RUN_TEST(test_of_equal_goals_as_many_stay_reached_as_were);
    RUN_TEST(test_a_goal_put_in_front_is_driven_to_first_in_an_ordered_list);
    RUN_TEST(test_in_any_order_the_goal_being_driven_to_stays_the_first);
    RUN_TEST(test_a_goal_no_plan_drives_to_yet_is_kept_in_no_place);
    RUN_TEST(test_the_dwell_goes_on_in_a_newer_revision);
    RUN_TEST(test_a_cancelled_list_is_forgotten);
    RUN_TEST(test_a_goal_is_skipped_by_its_id_and_the_last_one_ends_the_mission);
    RUN_TEST(test_after_the_first_goal_is_skipped_the_next_one_waits_for_its_plan);
    RUN_TEST(test_of_goals_that_share_an_id_the_first_one_left_is_skipped);
    RUN_TEST(test_what_was_skipped_on_command_stays_so_in_a_newer_revision);
    RUN_TEST(test_the_dwell_of_the_goal_behind_one_that_is_skipped_begins_anew);
    RUN_TEST(test_what_is_a_proof_and_what_is_none);
    RUN_TEST(test_a_goal_out_of_reach_is_given_up_when_the_others_are_planned);
    RUN_TEST(test_a_mission_ends_without_what_was_given_up);
    RUN_TEST(test_if_none_can_be_reached_none_is_given_up);
    RUN_TEST(test_what_is_set_aside_is_tried_again_on_another_layout);
    RUN_TEST(test_what_comes_back_does_not_touch_the_goal_being_driven_to);
    RUN_TEST(test_a_goal_reached_meanwhile_is_not_set_aside);
    RUN_TEST(test_the_last_goal_reached_or_skipped_brings_back_what_is_only_set_aside);
    RUN_TEST(test_of_goals_that_share_an_id_the_one_meant_is_set_aside);
    RUN_TEST(test_long_runs_go_as_a_plain_model_says);
    return UNITY_END();
}
