// Ways of exact bodies by the search over configurations. Every way is looked at placement by placement, 5 mm apart, by
// the brute-force judge of hall.h.
#include "plan/manoeuvre.h"

#include "cases.h"
#include "hall.h"

enum { WAYPOINTS = 768, SEEDS = CASES(30) };

#define MARGIN 0.05
#define PI 3.14159265358979323846

static aisle_manoeuvre manoeuvre;
static aisle_space space;
static aisle_waypoint_msg w[WAYPOINTS];
static uint32_t count, spent;

// A forklift of 2.4 x 1.0 m whose origin is its rear axle; curvature 0: turns on the spot.
static void forklift(float curvature) {
    aisle_vehicle_msg msg = {
        .vehicle_revision = 1, .num_vertices = 4, .margin = (float)MARGIN, .curvature_max = curvature};
    const double v[4][2] = {{-0.5, -0.5}, {1.9, -0.5}, {1.9, 0.5}, {-0.5, 0.5}};
    memcpy(msg.footprint, v, sizeof v);
    aisle_refusal why;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_vehicle_from_msg(&msg, &hall_vehicle, &why));
}

static void open_hall(void) {
    aisle_arena arena = hall_arena(HALL_BLOCK);
    memset(&manoeuvre, 0, sizeof manoeuvre);
    aisle_space_carve(&space, &arena, hall_limits.cells);
    aisle_manoeuvre_carve(&manoeuvre, &arena, &hall_limits);
    aisle_manoeuvre_carve_way(&manoeuvre, &arena);
    hall_open(&arena, 0.05F);
    aisle_space_begin(&space, &hall_layout, &hall_vehicle, AISLE_SPACE_ALONG);
}

// Racks of 1.1 m with aisles between, cross aisles of 3.5 m at both ends.
static void rack_hall(double aisle) {
    hall_begin(22.0, 14.0);
    for (double x = aisle; x + 1.1 + aisle < 22.0; x += 1.1 + aisle) {
        hall_add(x, 3.5, x + 1.1, 10.5);
    }
    open_hall();
}

static aisle_pose2 in_aisle(int n, double aisle, double y, double theta) {
    return (aisle_pose2){hall_boxes[n].x1 + 0.5 * aisle, y, theta};
}

static aisle_manoeuvre_request request_of(aisle_pose2 start, aisle_pose2 goal) {
    return (aisle_manoeuvre_request){
        .space = &space, .start = start, .goal = goal, .reach = hall_vehicle.inner_radius + MARGIN};
}

static aisle_status search(const aisle_manoeuvre_request *request, uint32_t slice) {
    aisle_status st;
    spent = count = 0;
    aisle_manoeuvre_start(&manoeuvre, request);
    while ((st = aisle_manoeuvre_step(&manoeuvre, slice, &spent)) == AISLE_BUSY) {
    }
    if (st == AISLE_OK) {
        count = aisle_manoeuvre_lay(&manoeuvre, w, WAYPOINTS);
        TEST_ASSERT_TRUE(count >= 2U);
    }
    return st;
}

// ---- judge

static double wrapped(double angle) {
    return remainder(angle, 2.0 * PI);
}

// The piece's place at f by its centre, in long double: nothing of src/.
static aisle_pose2 place_on(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b, long double f) {
    long double theta = (long double)a->theta + f * (long double)wrapped(b->theta - a->theta);
    long double k = (long double)b->curvature;
    long double dx = (long double)b->x - (long double)a->x, dy = (long double)b->y - (long double)a->y;
    long double chord = hypotl(dx, dy);
    if (fabsl(k) <= 0.0L || chord <= 0.0L) {
        return (aisle_pose2){(double)((long double)a->x + f * dx), (double)((long double)a->y + f * dy), (double)theta};
    }
    long double half = asinl(fminl(fmaxl(k * chord / 2.0L, -1.0L), 1.0L));
    long double from = atan2l(dy, dx) - half; // course at the first end
    long double to = from + 2.0L * half * f;
    return (aisle_pose2){(double)((long double)a->x + (sinl(to) - sinl(from)) / k),
                         (double)((long double)a->y - (cosl(to) - cosl(from)) / k), (double)theta};
}

static void judge_piece(const aisle_waypoint_msg *a, const aisle_waypoint_msg *b) {
    double travel = hypot(b->x - a->x, b->y - a->y), turn = fabs(wrapped(b->theta - a->theta));
    bool on_spot = (a->flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
    TEST_ASSERT_TRUE(on_spot ? travel <= 1e-9 && hall_vehicle.curvature_max <= 0.0 : travel > 1e-9);
    TEST_ASSERT_TRUE(fabs((double)b->curvature) <= hall_vehicle.curvature_max || hall_vehicle.curvature_max <= 0.0);
    if (!on_spot) { // heading along the motion, or against it
        double course = atan2(b->y - a->y, b->x - a->x);
        double middle = a->theta + 0.5 * wrapped(b->theta - a->theta);
        double back = (b->flags & AISLE_WAYPOINT_REVERSE) != 0 ? PI : 0.0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0, wrapped(course - middle - back));
    }
    double steps = ceil((1.1 * travel + 2.0 * turn) / 0.005) + 1.0;
    aisle_pose2 before = place_on(a, b, 0.0L);
    for (double i = 0.0; i <= steps; i += 1.0) {
        aisle_pose2 at = place_on(a, b, (long double)(i / steps));
        TEST_ASSERT_TRUE(hall_body_gap(at) >= MARGIN);
        TEST_ASSERT_TRUE(on_spot || hall_step_obeys(before.x, before.y, at.x, at.y));
        before = at;
    }
}

static void judge(const aisle_manoeuvre_request *request) {
    const aisle_waypoint_msg *last = &w[count - 1U];
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, request->start.x, w[0].x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, request->start.y, w[0].y);
    TEST_ASSERT_TRUE(request->start_is_free || fabs(wrapped(request->start.theta - w[0].theta)) < 1e-9);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, request->goal.x, last->x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, request->goal.y, last->y);
    TEST_ASSERT_TRUE(request->goal_is_free || fabs(wrapped(request->goal.theta - last->theta)) < 1e-6);
    for (uint32_t i = 1; i < count; i++) {
        judge_piece(&w[i - 1U], &w[i]);
    }
}

static double backwards(void) {
    double sum = 0.0;
    for (uint32_t i = 1; i < count; i++) {
        bool back = (w[i].flags & AISLE_WAYPOINT_REVERSE) != 0;
        sum += back ? hypot(w[i].x - w[i - 1U].x, w[i].y - w[i - 1U].y) : 0.0;
    }
    return sum;
}

void setUp(void) {
    forklift(0.0F);
}
void tearDown(void) {}

// ---- tests

// Is the i-th of so many cases among those that are to be looked at? They lie apart; `all` has no factor 7.
static bool is_drawn(int i, int all) {
    return i * 7 % all < OF_ALL(all);
}

static void test_from_aisle_to_aisle_by_every_heading_and_drive(void) {
    static const float curvature[2] = {0.0F, 0.6666F};
    int found = 0, asked = 0, seen = 0;
    for (int drive = 0; drive < 2; drive++) {
        for (double aisle = 1.2; aisle < 3.1; aisle += 0.6) {
            forklift(curvature[drive]);
            rack_hall(aisle);
            for (int k = 0; k < 6; k++) {
                if (!is_drawn(seen++, 48)) {
                    continue;
                }
                double theta = k % 2 == 0 ? 0.5 * PI : -0.5 * PI;
                aisle_manoeuvre_request request =
                    request_of(in_aisle(0, aisle, 7.0, theta), in_aisle(2, aisle, 7.0, k < 2 ? -theta : theta));
                request.goal_is_free = k >= 4;
                asked++;
                if (search(&request, 1000) == AISLE_OK) {
                    judge(&request);
                    found++;
                }
            }
        }
    }
    TEST_ASSERT_EQUAL(48, seen);
    TEST_ASSERT_EQUAL(OF_ALL(48), asked);
    TEST_ASSERT_EQUAL(asked, found);
}

static void test_out_of_a_dead_end_it_goes_backwards_and_only_there(void) {
    rack_hall(1.3);
    hall_add(hall_boxes[0].x1, 9.0, hall_boxes[1].x0, 10.0); // closes the first aisle above
    open_hall();
    aisle_manoeuvre_request request = request_of(in_aisle(0, 1.3, 6.5, 0.5 * PI), (aisle_pose2){15.0, 1.7, 0.0});
    TEST_ASSERT_EQUAL(AISLE_OK, search(&request, 1000));
    judge(&request);
    TEST_ASSERT_TRUE(backwards() >= 2.0 && backwards() <= 6.0);
    request.start.theta = -0.5 * PI; // nose first
    TEST_ASSERT_EQUAL(AISLE_OK, search(&request, 1000));
    judge(&request);
    TEST_ASSERT_TRUE(backwards() <= 2.5);
}

static void test_in_the_open_it_is_about_as_short_as_its_ends_allow(void) {
    hall_begin(30.0, 20.0);
    hall_add(14.0, 0.0, 15.0, 2.0);
    for (int drive = 0; drive < 2; drive++) {
        forklift(drive == 0 ? 0.0F : 0.6666F);
        open_hall();
        for (uint64_t s = 0; s < SEEDS; s++) {
            aisle_rng rng = aisle_rng_seed(s);
            aisle_vec2 p = uniform_point(&rng, aisle_vec2_of(3.0, 5.0), aisle_vec2_of(12.0, 17.0));
            aisle_vec2 q = uniform_point(&rng, aisle_vec2_of(18.0, 5.0), aisle_vec2_of(27.0, 17.0));
            double there = uniform(&rng, -3.0, 3.0), then = uniform(&rng, -3.0, 3.0);
            aisle_manoeuvre_request request = request_of((aisle_pose2){p.x, p.y, there}, (aisle_pose2){q.x, q.y, then});
            TEST_ASSERT_EQUAL(AISLE_OK, search(&request, 1000));
            judge(&request);
            double length = 0.0;
            for (uint32_t i = 0; i < manoeuvre.moves; i++) {
                length += fabs(manoeuvre.move[i].length);
            }
            TEST_ASSERT_TRUE(length <= aisle_vec2_distance(p, q) + (drive == 0 ? 2.5 : 2.0 * PI * 1.5));
        }
    }
}

// One-way aisles: out of one by its end and into another by its beginning, forwards or backwards, what is made from the
// goal included.
static void test_directed_zones_are_obeyed_by_every_drive(void) {
    static const double aisles[3] = {1.3, 1.7, 2.6};
    int found = 0;
    for (int k = 0; k < 16; k++) {
        if (!is_drawn(k, 16)) {
            continue;
        }
        const double aisle = aisles[k % 3], out = k % 2 == 0 ? 0.5 * PI : -0.5 * PI, in = k % 4 < 2 ? out : -out;
        forklift(k < 8 ? 0.0F : 0.6666F);
        rack_hall(aisle);
        hall_one_way(out, hall_boxes[0].x1, 4.5, hall_boxes[1].x0, 9.5);
        hall_one_way(in, hall_boxes[2].x1, 4.5, hall_boxes[3].x0, 9.5);
        open_hall();
        aisle_manoeuvre_request request =
            request_of(in_aisle(0, aisle, 7.0, 0.5 * PI), in_aisle(2, aisle, 7.0, k % 8 < 4 ? 0.5 * PI : -0.5 * PI));
        if (search(&request, 1000) == AISLE_OK) {
            judge(&request);
            found++;
        }
    }
    TEST_ASSERT_EQUAL(OF_ALL(16), found);
}

// Metres driven whose gap is below `clear`, by the judge's own gaps 5 cm apart; turns on the spot count nothing.
static double near_metres(double clear) {
    double sum = 0.0;
    for (uint32_t i = 1; i < count; i++) {
        const double steps = ceil(hypot(w[i].x - w[i - 1U].x, w[i].y - w[i - 1U].y) / 0.05);
        aisle_pose2 before = place_on(&w[i - 1U], &w[i], 0.0L);
        for (double k = 1.0; k <= steps; k += 1.0) {
            aisle_pose2 at = place_on(&w[i - 1U], &w[i], (long double)(k / steps));
            sum += hall_body_gap(at) < clear ? hypot(at.x - before.x, at.y - before.y) : 0.0;
            before = at;
        }
    }
    return sum;
}

static double driven(void) {
    double sum = 0.0;
    for (uint32_t i = 0; i < manoeuvre.moves; i++) {
        sum += fabs(manoeuvre.move[i].length);
    }
    return sum;
}

static void test_where_near_metres_are_dear_there_are_fewer_of_them_for_what_they_save(void) {
    int found = 0;
    double near = 0.0, near_eased = 0.0, cost = 0.0, cost_eased = 0.0;
    for (int k = 0; k < 12; k++) {
        const double aisle = 1.6 + 0.4 * (k % 3);
        forklift(k < 6 ? 0.0F : 0.6666F);
        rack_hall(aisle);
        aisle_manoeuvre_request request = request_of(in_aisle(0, aisle, 7.0, 0.5 * PI),
                                                     in_aisle(k % 2 + 2, aisle, 7.0, k % 4 < 2 ? 0.5 * PI : -0.5 * PI));
        TEST_ASSERT_EQUAL(AISLE_OK, search(&request, 1000));
        near += near_metres(0.5);
        cost += driven() + 4.0 * near_metres(0.5);
        request.clear = 0.5;
        request.dear = 5;
        if (search(&request, 1000) == AISLE_OK) {
            judge(&request);
            near_eased += near_metres(0.5);
            cost_eased += driven() + 4.0 * near_metres(0.5);
            found++;
        }
    }
    TEST_ASSERT_EQUAL(12, found);
    TEST_ASSERT_TRUE(near_eased < 0.85 * near);
    TEST_ASSERT_TRUE(cost_eased < 0.9 * cost);
}

static void test_a_search_ends_with_the_units_it_is_given(void) {
    hall_begin(12.0, 8.0);
    hall_add(0.0, 0.0, 5.0, 3.45); // as below
    hall_add(6.15, 0.0, 12.0, 8.0);
    hall_add(0.0, 4.6, 6.15, 8.0);
    open_hall();
    aisle_manoeuvre_request request = request_of((aisle_pose2){1.0, 4.025, 0.0}, (aisle_pose2){5.575, 2.5, -0.5 * PI});
    request.units = 3000;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search(&request, 100));
    TEST_ASSERT_TRUE(spent >= 3000U && spent < 6000U);
}

static void test_where_there_is_none_it_says_so_within_its_units(void) {
    hall_begin(12.0, 8.0);
    hall_add(0.0, 0.0, 5.0, 3.45); // aisles of 1.15 m with a right angle
    hall_add(6.15, 0.0, 12.0, 8.0);
    hall_add(0.0, 4.6, 6.15, 8.0);
    open_hall();
    aisle_manoeuvre_request request = request_of((aisle_pose2){1.0, 4.025, 0.0}, (aisle_pose2){5.575, 2.5, -0.5 * PI});
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, search(&request, 1000));
    TEST_ASSERT_TRUE(spent < AISLE_MANOEUVRE_UNITS + 100000U);
}

static void test_slices_change_nothing(void) {
    static aisle_waypoint_msg whole[WAYPOINTS];
    forklift(0.6666F);
    rack_hall(1.5);
    aisle_manoeuvre_request request = request_of(in_aisle(0, 1.5, 7.0, 0.5 * PI), in_aisle(2, 1.5, 7.0, 0.5 * PI));
    TEST_ASSERT_EQUAL(AISLE_OK, search(&request, UINT32_MAX));
    uint32_t n = count, units = spent;
    memcpy(whole, w, n * sizeof w[0]);
    static const uint32_t slices[3] = {1, 77, 5000};
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(AISLE_OK, search(&request, slices[i]));
        TEST_ASSERT_EQUAL_UINT32(n, count);
        TEST_ASSERT_EQUAL_UINT32(units, spent);
        TEST_ASSERT_EQUAL_MEMORY(whole, w, n * sizeof w[0]);
    }
}

static void test_waypoints_that_do_not_fit_are_none(void) {
    rack_hall(1.5);
    aisle_manoeuvre_request request = request_of(in_aisle(0, 1.5, 7.0, 0.5 * PI), in_aisle(2, 1.5, 7.0, 0.5 * PI));
    TEST_ASSERT_EQUAL(AISLE_OK, search(&request, 1000));
    TEST_ASSERT_EQUAL_UINT32(0U, aisle_manoeuvre_lay(&manoeuvre, w, count - 1U));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_from_aisle_to_aisle_by_every_heading_and_drive);
    RUN_TEST(test_out_of_a_dead_end_it_goes_backwards_and_only_there);
    RUN_TEST(test_in_the_open_it_is_about_as_short_as_its_ends_allow);
    RUN_TEST(test_directed_zones_are_obeyed_by_every_drive);
    RUN_TEST(test_where_near_metres_are_dear_there_are_fewer_of_them_for_what_they_save);
    RUN_TEST(test_a_search_ends_with_the_units_it_is_given);
    RUN_TEST(test_where_there_is_none_it_says_so_within_its_units);
    RUN_TEST(test_slices_change_nothing);
    RUN_TEST(test_waypoints_that_do_not_fit_are_none);
    return UNITY_END();
}
