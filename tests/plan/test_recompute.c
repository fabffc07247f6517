// Paths out of the public door, recomputed from their waypoints alone by support/recompute.h: every limit, sum, time and
// gap, for all drives, bodies, objectives, corner zones, zones of the layout, and the scenarios of tests/data.
// With an argument, so many seeds, and a table of the largest deviations.
#include "aisle/energy.h"
#include "aisle/planner.h"

#include "base/rng.h"
#include "cases.h"
#include "recompute.h"
#include "robot/profile.h"
#include "scenario.h"
#include "unity.h"
#include "wire/codec.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned long seeds = CASES(12);
static unsigned char block[(40U << 20) + AISLE_PLANNER_ALIGN];
static aisle_planner *planner;
static aisle_layout_msg layout, held;
static aisle_vehicle_msg vehicle;
static aisle_query_msg query;
static aisle_path_msg answer, good;
static recompute_report report;
static long double deviation[RECOMPUTE_RULES];
enum { OBJECTIVES = 4 };

static long paths, with_zones, refused, scenario_paths;
static aisle_rng rng;

static double drawn(double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(&rng);
}
static bool one_in(uint32_t n) {
    return aisle_rng_below(&rng, n) == 0;
}

void setUp(void) {}
void tearDown(void) {}

// ---- the door

static void open_door(void) {
    unsigned char *at = block + (AISLE_PLANNER_ALIGN - (uintptr_t)block % AISLE_PLANNER_ALIGN) % AISLE_PLANNER_ALIGN;
    aisle_config config = {.limits = {.requests = 2U}, .has_vehicle = true, .vehicle = vehicle};
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(at, 40U << 20, &config, &planner));
}

static void settle(void) {
    aisle_event event;
    while (aisle_planner_step(planner, 1000000, 100000) == AISLE_BUSY) {
        while (aisle_planner_next_event(planner, &event)) {
            TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, event.bytes, event.size, &answer, NULL));
        }
    }
    while (aisle_planner_next_event(planner, &event)) {
        TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_PATH, event.bytes, event.size, &answer, NULL));
    }
}

static aisle_status send_layout(void) {
    layout.total_polygons = layout.num_polygons;
    layout.crc32 = (int32_t)aisle_layout_crc32(0, &layout);
    aisle_status st =
        aisle_planner_submit(planner, 1000000, &(aisle_input){.kind = AISLE_INPUT_LAYOUT, .as.layout = &layout});
    settle();
    return st;
}

static bool ask(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_submit(planner, 1000000,
                                                     &(aisle_input){.kind = AISLE_INPUT_QUERY, .as.query = &query}));
    settle();
    TEST_ASSERT_EQUAL_INT32(query.query_id, answer.query_id);
    return answer.status == AISLE_PATH_OK;
}

// ---- worlds

static void hall(double width, double height) {
    memset(&layout, 0, sizeof layout);
    layout = (aisle_layout_msg){.map_id = 1, .map_revision = 1, .num_parts = 1, .x_max = width, .y_max = height};
}

static aisle_polygon_msg *add_box(int8_t kind, double x0, double y0, double x1, double y1) {
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    aisle_polygon_msg *p = &layout.polygons[layout.num_polygons++];
    *p = (aisle_polygon_msg){.id = layout.num_polygons, .kind = kind, .num_vertices = 4};
    memcpy(p->vertices, v, sizeof v);
    return p;
}

static void draw_hall(void) {
    hall(drawn(8.0, 16.0), drawn(6.0, 12.0));
    for (uint32_t n = aisle_rng_below(&rng, 7U); n > 0; n--) {
        double x = drawn(1.0, layout.x_max - 2.0), y = drawn(0.0, layout.y_max - 1.0);
        double w = drawn(0.2, 2.0), h = drawn(0.2, 2.0);
        (void)add_box(one_in(4) ? AISLE_POLYGON_KEEPOUT : AISLE_POLYGON_OBSTACLE, x, y, x + w, y + h);
    }
    for (uint32_t n = aisle_rng_below(&rng, 4U); n > 0; n--) {
        double x = drawn(1.0, layout.x_max - 3.0), y = drawn(0.0, layout.y_max - 2.0);
        double w = drawn(0.5, 3.0), h = drawn(0.5, 3.0);
        aisle_polygon_msg *p =
            add_box((int8_t)(AISLE_POLYGON_SPEED_LIMIT + (int8_t)aisle_rng_below(&rng, 3U)), x, y, x + w, y + h);
        p->value = p->kind == AISLE_POLYGON_SPEED_LIMIT ? (float)drawn(0.1, 1.0) : 0.0F;
        p->value = p->kind == AISLE_POLYGON_PENALTY ? (float)drawn(0.0, 1.0) : p->value;
        p->direction = (float)drawn(-3.1, 3.1);
    }
}

static void draw_vehicle(void) {
    vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .utime = 1};
    vehicle.drive = (int8_t)aisle_rng_below(&rng, 3U);
    vehicle.curvature_max = vehicle.drive == AISLE_VEHICLE_TRICYCLE ? (float)drawn(0.5, 2.0) : 0.0F;
    vehicle.margin = one_in(3) ? -1.0F : (float)drawn(0.01, 0.15);
    vehicle.v_max = one_in(2) ? (float)drawn(0.4, 2.5) : 0.0F;
    vehicle.a_max = one_in(2) ? (float)drawn(0.2, 1.5) : 0.0F;
    vehicle.d_max = one_in(2) ? (float)drawn(0.2, 1.5) : 0.0F;
    vehicle.lateral_a_max = one_in(2) ? (float)drawn(0.1, 1.0) : 0.0F;
    vehicle.omega_max = one_in(2) ? (float)drawn(0.3, 1.5) : 0.0F;
    vehicle.mass = one_in(2) ? (float)drawn(50.0, 2000.0) : 0.0F;
    if (one_in(2)) {
        vehicle.footprint_radius = (float)drawn(0.1, 0.4);
    } else {
        double length = drawn(0.6, 1.6), half = 0.5 * drawn(0.4, 0.9), rear = -length * drawn(0.3, 0.7);
        const double v[4][2] = {{rear, -half}, {rear + length, -half}, {rear + length, half}, {rear, half}};
        memcpy(vehicle.footprint, v, sizeof v);
        vehicle.num_vertices = 4;
        vehicle.footprint_radius = one_in(3) ? 0.05F : 0.0F;
    }
}

static aisle_goal_msg draw_stop(int32_t id) {
    aisle_goal_msg stop = {.id = id, .tolerance_theta = one_in(4) ? 0.0F : 4.0F, .dwell = one_in(4) ? 1.5F : 0.0F};
    stop.x = drawn(0.8, layout.x_max - 0.8);
    stop.y = drawn(0.8, layout.y_max - 0.8);
    stop.theta = drawn(-3.1, 3.1);
    return stop;
}

static void draw_query(int32_t id) {
    query = (aisle_query_msg){.query_id = id, .map_id = 1, .num_goals = one_in(3) ? 2 : 1};
    query.start = draw_stop(0);
    query.goals[0] = draw_stop(1);
    query.goals[1] = draw_stop(2);
    query.options.planner = one_in(3) ? AISLE_OPTIONS_AUTO : AISLE_OPTIONS_ASTAR;
    query.options.objective = (int8_t)aisle_rng_below(&rng, 4U);
    query.options.interpolation = (int8_t)aisle_rng_below(&rng, 2U);
    query.options.zone = one_in(2) ? (float)drawn(-0.05, 0.4) : 0.0F;
    query.options.work_units = 300000;
}

// ---- the judge

static void judge(void) {
    const recompute_world world = {layout.x_min, layout.y_min,    layout.x_max,
                                   layout.y_max, layout.polygons, layout.num_polygons};
    recompute(&answer, &vehicle, &world, query.goals, query.num_goals, &report);
    paths++;
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        deviation[r] = fmaxl(deviation[r], report.worst[r].excess);
    }
    recompute_rule rule;
    if (!recompute_is_fine(&report, &rule)) {
        char text[200];
        (void)snprintf(text, sizeof text, "query %d: %s off by %.3Lg at waypoint %d", (int)query.query_id,
                       recompute_name(rule), report.worst[rule].excess, report.worst[rule].waypoint);
        TEST_FAIL_MESSAGE(text);
    }
}

// The library's own split of the energy beside the recomputed one.
static void judge_energy(void) {
    static aisle_energy each[AISLE_PATH_MAX_WAYPOINTS];
    aisle_energy sum;
    TEST_ASSERT_EQUAL(AISLE_OK,
                      aisle_path_energy(&answer, &vehicle, query.goals, (uint32_t)query.num_goals, each, &sum));
    double total = 0.0;
    for (int i = 1; i < answer.num_waypoints; i++) {
        const recompute_energy *want = &report.each[i];
        double within = 0.01 + 2e-3 * (double)recompute_sum(want);
        TEST_ASSERT_DOUBLE_WITHIN(within, (double)want->rolling, (double)each[i].rolling);
        TEST_ASSERT_DOUBLE_WITHIN(within + 2e-3 * (double)want->acceleration, (double)want->acceleration,
                                  (double)each[i].acceleration);
        TEST_ASSERT_DOUBLE_WITHIN(within, (double)want->turning, (double)each[i].turning);
        TEST_ASSERT_DOUBLE_WITHIN(within + 0.06, (double)want->idle, (double)each[i].idle);
        total +=
            (double)each[i].rolling + (double)each[i].acceleration + (double)each[i].turning + (double)each[i].idle;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * total + 1e-3, (double)answer.energy, total);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * total + 1e-3, total,
                              (double)sum.rolling + (double)sum.acceleration + (double)sum.turning + (double)sum.idle);
}

// ---- tests

static void test_random_paths_of_all_drives_with_zones_are_what_they_say_for_every_seed(void) {
    for (unsigned long seed = 0; seed < seeds; seed++) {
        rng = aisle_rng_seed(seed);
        draw_vehicle();
        draw_hall();
        open_door();
        TEST_ASSERT_EQUAL(AISLE_OK, send_layout());
        for (int32_t k = 0; k < 4; k++) {
            draw_query((int32_t)seed * 4 + k + 1);
            if (!ask()) {
                TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_VERIFY_FAILED, answer.cause);
                TEST_ASSERT_NOT_EQUAL(AISLE_STATUS_INTERNAL, answer.cause);
                refused++;
                continue;
            }
            judge();
            judge_energy();
            for (int i = 0; i < layout.num_polygons; i++) {
                with_zones += layout.polygons[i].kind >= AISLE_POLYGON_SPEED_LIMIT ? 1 : 0;
            }
        }
    }
    TEST_ASSERT_TRUE(paths >= (long)seeds);
}

// Corners of a way between boxes, by ever larger zones. PAPERS 4, tables 3 and 4: the larger the zone, the less time and
// energy; an arc takes no more of a leg than the zone, nor than half of it.
static void test_larger_corner_zones_take_no_longer_and_no_more_energy(void) {
    static const float zones[] = {-1.0F, 0.05F, 0.1F, 0.15F, 0.2F};
    vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .footprint_radius = 0.3F, .margin = 0.1F};
    hall(12.0, 8.0);
    (void)add_box(AISLE_POLYGON_OBSTACLE, 3.0, 0.0, 4.0, 5.0);
    (void)add_box(AISLE_POLYGON_OBSTACLE, 7.0, 3.0, 8.0, 8.0);
    open_door();
    TEST_ASSERT_EQUAL(AISLE_OK, send_layout());
    double time = 1e9, energy = 1e9;
    for (int32_t k = 0; k < 5; k++) {
        query = (aisle_query_msg){.query_id = k + 1, .map_id = 1, .num_goals = 1};
        query.start = (aisle_goal_msg){.x = 1.0, .y = 1.0, .tolerance_theta = 4.0F};
        query.goals[0] = (aisle_goal_msg){.id = 1, .x = 11.0, .y = 7.0, .tolerance_theta = 4.0F};
        query.options.planner = AISLE_OPTIONS_ASTAR;
        query.options.objective = AISLE_OPTIONS_SHORTEST;
        query.options.zone = zones[k];
        TEST_ASSERT_TRUE(ask());
        judge();
        const double ramp = AISLE_PROFILE_RAMP_GAIN; // a piece may be left whole for less
        TEST_ASSERT_TRUE((double)answer.duration <= time + ramp && (double)answer.energy <= energy);
        time = (double)answer.duration;
        energy = (double)answer.energy;
        int arcs = 0;
        for (int i = 1; i < answer.num_waypoints; i++) {
            const aisle_waypoint_msg *w = &answer.waypoints[i];
            double turn = fabs(remainder(w->theta - (w - 1)->theta, 6.283185307179586));
            double cut = fabs((double)w->curvature) > 0.0 ? tan(0.5 * turn) / fabs((double)w->curvature) : 0.0;
            arcs += cut > 0.0 ? 1 : 0;
            TEST_ASSERT_TRUE(cut <= fmax((double)zones[k], 0.0) + 1e-6);
        }
        TEST_ASSERT_TRUE(zones[k] < 0.0F ? arcs == 0 : arcs > 0);
    }
}

// ---- scenarios

// All legs in one path by each objective, or from the first-th on by as many as there are cases. Without a margin every
// scenario has a way; some gaps are too narrow for more.
static void judge_scenario(const char *file, float margin, int first) {
    static aisle_layout_msg floor_plan;
    TEST_ASSERT_TRUE_MESSAGE(scenario_read(file, margin, &floor_plan, &vehicle, &query), file);
    open_door();
    layout = floor_plan;
    TEST_ASSERT_EQUAL(AISLE_OK, send_layout());
    for (int k = 0; k < OF_ALL(OBJECTIVES); k++) {
        query.options.objective = (int8_t)((first + k) % OBJECTIVES);
        query.query_id = query.options.objective + 1;
        if (ask()) {
            judge();
            judge_energy();
            scenario_paths++;
        } else {
            TEST_ASSERT_TRUE_MESSAGE(margin > 0.0F, file);
            refused++;
        }
    }
}

static void test_paths_of_every_scenario_are_what_they_say_by_every_objective(void) {
    glob_t found;
    TEST_ASSERT_EQUAL(0, glob(AISLE_TEST_DATA "/scenarios/*.json", 0, NULL, &found));
    for (size_t i = 0; i < found.gl_pathc; i++) {
        if (strstr(found.gl_pathv[i], "optimum.json") == NULL) {
            judge_scenario(found.gl_pathv[i], -1.0F, (int)i);
            judge_scenario(found.gl_pathv[i], 0.05F, (int)i + 2);
        }
    }
    TEST_ASSERT_EQUAL(17, found.gl_pathc);
    TEST_ASSERT_TRUE(scenario_paths >= (16 + 13) * OF_ALL(OBJECTIVES)); // with the margin all but the narrowest three
    globfree(&found);
}

// ---- the judge itself

// A path with arcs, by a slow zone and along a directed one.
static void ask_for_a_path_with_everything(void) {
    vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .footprint_radius = 0.3F, .margin = 0.1F};
    hall(12.0, 8.0);
    (void)add_box(AISLE_POLYGON_OBSTACLE, 3.0, 0.0, 4.0, 5.0);
    (void)add_box(AISLE_POLYGON_OBSTACLE, 7.0, 3.0, 8.0, 8.0);
    add_box(AISLE_POLYGON_SPEED_LIMIT, 0.0, 2.0, 3.0, 4.0)->value = 0.25F;
    add_box(AISLE_POLYGON_DIRECTED, 4.5, 2.5, 6.5, 5.5)->direction = -0.75F;
    open_door();
    TEST_ASSERT_EQUAL(AISLE_OK, send_layout());
    query = (aisle_query_msg){.query_id = 1, .map_id = 1, .num_goals = 1};
    query.start = (aisle_goal_msg){.x = 1.0, .y = 1.0, .tolerance_theta = 4.0F};
    query.goals[0] = (aisle_goal_msg){.id = 1, .x = 11.0, .y = 7.0, .tolerance_theta = 4.0F};
    query.options.planner = AISLE_OPTIONS_ASTAR;
    query.options.objective = AISLE_OPTIONS_SHORTEST;
    TEST_ASSERT_TRUE(ask());
}

static void spoil(recompute_rule rule) {
    aisle_waypoint_msg *w = answer.waypoints, *last = &w[answer.num_waypoints - 1];
    float *const limits[RECOMPUTE_RULES] = {
        [RECOMPUTE_CREEP] = &vehicle.creep_speed,       [RECOMPUTE_SPEED] = &vehicle.v_max,
        [RECOMPUTE_ACCELERATION] = &vehicle.a_max,      [RECOMPUTE_BRAKING] = &vehicle.d_max,
        [RECOMPUTE_LATERAL] = &vehicle.lateral_a_max,   [RECOMPUTE_TURN_RATE] = &vehicle.omega_max,
        [RECOMPUTE_CURVATURE] = &vehicle.curvature_max, [RECOMPUTE_ZONE_SPEED] = &layout.polygons[2].value};
    float *const told[RECOMPUTE_RULES] = {
        [RECOMPUTE_S] = &w[2].s, [RECOMPUTE_T] = &w[2].t, [RECOMPUTE_REST] = &last->v};
    float *const sums[RECOMPUTE_RULES] = {[RECOMPUTE_LENGTH] = &answer.length,
                                          [RECOMPUTE_DURATION] = &answer.duration,
                                          [RECOMPUTE_ENERGY] = &answer.energy};
    if (limits[rule] != NULL) {
        *limits[rule] = 0.05F;
    } else if (told[rule] != NULL) {
        *told[rule] += 0.01F;
    } else if (sums[rule] != NULL) {
        *sums[rule] *= 1.01F;
    } else if (rule == RECOMPUTE_MARGIN) {
        vehicle.margin += 0.05F;
    } else if (rule == RECOMPUTE_CLEARANCE) {
        answer.clearance_min += 0.01F;
    } else if (rule == RECOMPUTE_HEADING) {
        w[1].theta += 0.01;
    } else {
        layout.polygons[3].direction += 3.0F;
    }
}

static void test_the_judge_notices_each_figure_that_is_wrong(void) {
    ask_for_a_path_with_everything();
    good = answer;
    const aisle_vehicle_msg body = vehicle;
    held = layout;
    judge();
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        answer = good;
        vehicle = body;
        layout = held;
        spoil((recompute_rule)r);
        const recompute_world spoilt = {layout.x_min, layout.y_min,    layout.x_max,
                                        layout.y_max, layout.polygons, layout.num_polygons};
        recompute(&answer, &vehicle, &spoilt, query.goals, query.num_goals, &report);
        recompute_rule first;
        TEST_ASSERT_FALSE_MESSAGE(recompute_is_fine(&report, &first), recompute_name((recompute_rule)r));
        TEST_ASSERT_TRUE_MESSAGE(report.worst[r].excess > 4e-3L, recompute_name((recompute_rule)r));
    }
}

static void tell(void) {
    printf("%ld paths, %ld refusals, %ld zones beside them\n", paths, refused, with_zones);
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        printf("  %-22s %11.3Le\n", recompute_name((recompute_rule)r), deviation[r]);
    }
}

int main(int argc, char **argv) {
    seeds = argc > 1 ? strtoul(argv[1], NULL, 10) : seeds;
    for (int r = 0; r < RECOMPUTE_RULES; r++) {
        deviation[r] = -1e9L;
    }
    UNITY_BEGIN();
    RUN_TEST(test_random_paths_of_all_drives_with_zones_are_what_they_say_for_every_seed);
    RUN_TEST(test_paths_of_every_scenario_are_what_they_say_by_every_objective);
    RUN_TEST(test_the_judge_notices_each_figure_that_is_wrong);
    RUN_TEST(test_larger_corner_zones_take_no_longer_and_no_more_energy);
    const int failed = UNITY_END();
    tell();
    return failed;
}
