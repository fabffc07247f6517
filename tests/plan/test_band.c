#include "plan/band.h" // first: proves that the header stands alone

#include "cases.h"
#include "driven.h"
#include "unity.h"

static aisle_band band;

void setUp(void) {
    static const aisle_vehicle_msg usual;
    set_vehicle(&usual);
    memset(dwell, 0, sizeof dwell);
    count = 0;
}
void tearDown(void) {}

static aisle_band_motion motion_from(aisle_place at, double v, double lease) {
    return (aisle_band_motion){.vehicle = &vehicle,
                               .w = path,
                               .n = count,
                               .dwell = dwell,
                               .at = at,
                               .v = v,
                               .cap = (double)INFINITY,
                               .lease = lease,
                               .spacing = 0.03};
}

// m between two poses, headings weighed by half a metre unless they are of a disc.
static real apart(const sample *a, const aisle_band_place *b) {
    const real turn = remainderl(a->theta - wide(b->pose.theta), 2.0L * acosl(-1.0L));
    const real lever = aisle_vehicle_is_disc(&vehicle) ? 0.0L : 0.5L;
    return hypotl(hypotl(a->x - wide(b->pose.x), a->y - wide(b->pose.y)), lever * turn);
}

static uint32_t nearest(const sample *a) {
    uint32_t best = 0;
    for (uint32_t k = 1; k < band.n; k++) {
        best = apart(a, &band.at[k]) < apart(a, &band.at[best]) ? k : best;
    }
    return best;
}

// A case: way, place, speed (too fast in every fifth), lease. Some seeds go forwards and back over one track, where poses
// do not tell when they are meant: not for the test of times.
static aisle_band_motion random_case(uint64_t seed, bool reverses) {
    aisle_rng rng = aisle_rng_seed(seed);
    some_vehicle(seed);
    random_way(seed, 12, reverses);
    const aisle_place at = random_place(&rng);
    double v = aisle_motion_speed(&vehicle, path, count, dwell, at);
    if (seed % 5 == 0 && v > 0.0) { // too fast for the path, but not for its next rest
        const aisle_place rest = aisle_motion_rest(&vehicle, path, count, dwell, at, 50.0, 0.0);
        const double way = aisle_motion_length_to(path, count, rest) - aisle_motion_length_to(path, count, at);
        v = fmax(v, fmin(v + uniform(&rng, 0.0, 0.3), sqrt(2.0 * vehicle.d_max * way)));
    }
    return motion_from(at, v, uniform(&rng, 0.2, 1.2));
}

static void test_it_tells_where_a_vehicle_may_be_moving_and_until_when_for_150_of_150_ways(void) {
    uint32_t turning = 0, places = 0;
    for (uint64_t seed = 0; seed < CASES(150); seed++) {
        static real latest[AISLE_BAND_MAX];
        const aisle_band_motion motion = random_case(seed, false);
        aisle_band_make(&band, &motion);
        TEST_ASSERT_FALSE(band.overflow);
        drive_all(path, count, dwell, motion.at, wide(motion.v), wide(motion.lease), 0.002L, 20);
        memset(latest, 0, sizeof latest);
        for (uint32_t i = 0; i < sampled; i += 5) {
            const sample *at = &samples[i];
            TEST_ASSERT_GREATER_THAN_UINT32(0, band.n);
            const uint32_t k = nearest(at);
            uint32_t next = k; // the last place about there: runs, and turns of a disc, begin where the one before ends
            while (next + 1 < band.n && (next == k || apart(at, &band.at[next]) < 0.04L)) {
                next++;
            }
            TEST_ASSERT_TRUE(apart(at, &band.at[k]) < 0.04L); // no place is missed
            TEST_ASSERT_TRUE(at->t <= wide(band.at[next].until) +
                                          0.05L); // nor a time; each start from rest costs the judge some 10 ms
            for (uint32_t j = k > 0 ? k - 1 : 0; j <= next; j++) {
                latest[j] = fmaxl(latest[j], at->t);
            }
            turning += spot(path, at->piece) ? 1U : 0U;
        }
        for (uint32_t k = 0; k + 1 < band.n; k++) { // and it does not tell later ones than there are, by much
            const real slow = vehicle.d_max < 0.5 ? 0.5L : 0.4L; // a creeping end: 3 cm take sqrt(2 * 0.03 / d)
            TEST_ASSERT_TRUE(wide(band.at[k].until) <= latest[k] + slow);
            TEST_ASSERT_TRUE(band.at[k].until <= band.at[k + 1].until + 1e-9);
            places++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(1000), turning);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(4000), places);
}

static void test_travel_bounds_what_a_body_point_makes_between_places(void) {
    for (uint64_t seed = 0; seed < CASES(200); seed++) {
        const aisle_band_motion motion = random_case(seed, true);
        aisle_band_make(&band, &motion);
        for (uint32_t k = 1; k < band.n; k++) {
            real most = 0.0L;
            for (uint32_t i = 0; i < vehicle.n; i++) {
                aisle_vec2 a[AISLE_SHAPE_VERTICES_MAX], b[AISLE_SHAPE_VERTICES_MAX];
                (void)aisle_vehicle_place(&vehicle, band.at[k - 1].pose, 0.0, a);
                (void)aisle_vehicle_place(&vehicle, band.at[k].pose, 0.0, b);
                most = fmaxl(most, hypotl(wide(a[i].x) - wide(b[i].x), wide(a[i].y) - wide(b[i].y)));
            }
            TEST_ASSERT_TRUE(most <=
                             wide(band.at[k].travel) + 1e-9L); // of a new run 0: it begins where the last one ended
            TEST_ASSERT_TRUE(band.at[k].travel <= 0.03 * (1.0 + vehicle.outer_radius / 0.5) + 1e-9);
        }
    }
}

static void test_a_disc_is_clear_only_if_it_is_off_the_body_at_all_times(void) {
    uint32_t clear = 0, not_clear = 0, near = 0;
    for (uint64_t seed = 0; seed < CASES(250); seed++) {
        aisle_rng rng = aisle_rng_seed(seed + 7000U);
        const aisle_band_motion motion = random_case(seed, true);
        aisle_band_make(&band, &motion);
        TEST_ASSERT_FALSE(band.overflow);
        drive_all(path, count, dwell, motion.at, wide(motion.v), wide(motion.lease), 0.004L, 5);
        for (int i = 0; i < 12 && sampled > 0; i++) {
            const sample *about = &samples[aisle_rng_below(&rng, sampled)];
            const aisle_band_disc disc = {
                {(double)about->x + uniform(&rng, -3.0, 3.0), (double)about->y + uniform(&rng, -3.0, 3.0)},
                uniform(&rng, 0.1, 0.8),
                uniform(&rng, 0.0, 2.0)};
            const real slack =
                worst_slack(wide(disc.centre.x), wide(disc.centre.y), wide(disc.reach), wide(disc.bound), 0.1L) - 0.1L;
            uint32_t where, looked = 0;
            const bool is_clear = aisle_band_is_clear(&band, &vehicle, &disc, 0.1, 0.1, &where, &looked);
            TEST_ASSERT_TRUE(!is_clear ||
                             slack > -0.02L * wide(disc.bound) - 0.005L); // steps of 4 ms add up to some 15
            // half of 3 cm and what turns add, and the disc's growth while a creeping vehicle makes 3 cm
            TEST_ASSERT_TRUE(is_clear || slack < 0.05L + 0.4L * wide(disc.bound));
            TEST_ASSERT_TRUE(is_clear || where < band.n);
            TEST_ASSERT_TRUE(looked <= band.n);
            near += fabsl(slack) < 0.1L ? 1U : 0U;
            clear += is_clear ? 1U : 0U;
            not_clear += is_clear ? 0U : 1U;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(500), clear);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(500), not_clear);
    TEST_ASSERT_GREATER_THAN_UINT32(CASES(100) * 3 / 4, near);
}

static void test_a_long_line_is_as_the_closed_form_says(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(30.0, 0.5);
    fill_way();
    const aisle_place middle = {20, 0.0}; // at 9.5 m, 1.5 m/s
    const aisle_band_motion motion = motion_from(middle, 1.5, 1.0);
    aisle_band_make(&band, &motion);
    const double stop = 1.5 * 1.5 / (2.0 * 0.5), first = 0.3 * 1.5 + stop, last = 1.3 * 1.5 + stop;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 9.5 + last, band.at[band.n - 1].pose.x); // v is a float
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1.3 + 3.0, band.at[band.n - 1].until);
    for (uint32_t k = 0; k < band.n; k++) {
        const double x = band.at[k].pose.x - 9.5, braked = sqrt(fmax(2.25 - (x - 0.45), 0.0));
        const double until = x <= 0.45 ? x / 1.5 : (x <= first ? 0.3 + (1.5 - braked) / 0.5 : (x - stop) / 1.5 + 3.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, until, band.at[k].until);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.5, band.peak);
}

static void test_a_vehicle_that_dwells_longer_than_the_lease_has_no_band(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(4.0, 0.5);
    set_flag(&path[4], AISLE_WAYPOINT_STOP | AISLE_WAYPOINT_GOAL);
    dwell[4] = 5.0F;
    fill_way();
    aisle_band_motion motion = motion_from((aisle_place){4, 1.0}, 0.0, 1.0);
    aisle_band_make(&band, &motion);
    TEST_ASSERT_EQUAL_UINT32(0, band.n);
    const aisle_band_disc on_it = {{2.0, 0.0}, 1.0, 2.0};
    uint32_t where, looked = 0;
    TEST_ASSERT_TRUE(aisle_band_is_clear(&band, &vehicle, &on_it, 0.1, 0.1, &where, &looked)); // contact at rest
    motion.rested = 4.5; // it leaves in half a second
    aisle_band_make(&band, &motion);
    TEST_ASSERT_GREATER_THAN_UINT32(3, band.n);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.5, band.at[0].until);
    TEST_ASSERT_FALSE(aisle_band_is_clear(&band, &vehicle, &on_it, 0.1, 0.1, &where, &looked));
    motion.at = (aisle_place){8, 1.0}; // the end
    aisle_band_make(&band, &motion);
    TEST_ASSERT_EQUAL_UINT32(0, band.n);
}

static void test_a_cap_holds_from_where_braking_lets_it(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(30.0, 1.5);
    fill_way();
    aisle_band_motion motion = motion_from((aisle_place){7, 0.5}, 1.5, 1.0);
    motion.cap = 0.5;
    aisle_band_walk walk;
    aisle_band_part part;
    TEST_ASSERT_TRUE(aisle_band_walk_begin(&walk, &motion));
    double x = 0.0, t = 0.0;
    while (aisle_band_walk_next(&walk, &part) && part.x0 < 15.0) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, x, part.x0);
        const double end = fmin(0.25, 19.75 - part.x1 + 1e-9); // squares; the path brakes at its end
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, fmax(2.25 - part.x1, end), part.q1);
        x = part.x1;
        t = part.t1;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 2.0 + (x - 2.0) / 0.5, t);
}

static void test_it_gains_speed_no_faster_than_it_can(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(30.0, 1.5);
    fill_way();
    const aisle_band_motion motion = motion_from((aisle_place){7, 0.5}, 0.5, 1.0); // the path: 1.5 m/s
    aisle_band_walk walk;
    aisle_band_part part;
    TEST_ASSERT_TRUE(aisle_band_walk_begin(&walk, &motion));
    while (aisle_band_walk_next(&walk, &part) && part.x0 < 5.0) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, fmin(0.25 + part.x1, 2.25), part.q1);
        for (int i = 0; i <= 4; i++) {
            const double t = part.t0 + 0.25 * i * (part.t1 - part.t0), at = aisle_band_part_at(&part, t);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, t, aisle_band_part_time(&part, at));
        }
    }
}

// A path that is made anew in a turn begins it at rest; told how fast the vehicle turns its places and times are those of the
// turn that was under way.
static void test_a_turn_made_anew_goes_on_from_the_rate_that_is_told(void) {
    static aisle_band whole;
    set_flag(add(0.0, 0.0, 0.0), AISLE_WAYPOINT_TURN_IN_PLACE);
    (void)add(0.0, 0.0, 2.5);
    (void)add(-4.0, 3.0, 2.5);
    fill_way();
    for (double u = 0.05; u < 0.6; u += 0.1) { // getting faster, even, and nearly slowing down
        aisle_band_motion motion = motion_from((aisle_place){1, u}, 0.0, 0.4);
        aisle_band_make(&whole, &motion);
        const double turned = 2.5 * u;
        const double rate = fmin(sqrt(2.0 * vehicle.alpha_max * fmin(turned, 2.5 - turned)), vehicle.omega_max);
        aisle_waypoint_msg cut[3] = {path[0], path[1], path[2]};
        cut[0].theta = turned;
        motion.w = cut;
        motion.at.u = 0.0;
        motion.omega = rate;
        motion.rested = (double)INFINITY;
        aisle_band_make(&band, &motion);
        TEST_ASSERT_TRUE(band.n > 3 && whole.n > 3);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, whole.at[whole.n - 1U].pose.theta, band.at[band.n - 1U].pose.theta);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, whole.at[whole.n - 1U].until, band.at[band.n - 1U].until);
        motion.omega = 0.0;
        aisle_band_make(&band, &motion);
        TEST_ASSERT_TRUE(band.at[band.n - 1U].until < whole.at[whole.n - 1U].until - 0.05);
    }
}

static void test_too_many_places_are_told(void) {
    (void)add(0.0, 0.0, 0.0);
    add_line(30.0, 0.5);
    fill_way();
    aisle_band_motion motion = motion_from((aisle_place){20, 0.0}, 1.5, 1.0);
    motion.spacing = 0.005;
    aisle_band_make(&band, &motion);
    TEST_ASSERT_TRUE(band.overflow && band.n == AISLE_BAND_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_it_tells_where_a_vehicle_may_be_moving_and_until_when_for_150_of_150_ways);
    RUN_TEST(test_travel_bounds_what_a_body_point_makes_between_places);
    RUN_TEST(test_a_disc_is_clear_only_if_it_is_off_the_body_at_all_times);
    RUN_TEST(test_a_long_line_is_as_the_closed_form_says);
    RUN_TEST(test_a_vehicle_that_dwells_longer_than_the_lease_has_no_band);
    RUN_TEST(test_a_cap_holds_from_where_braking_lets_it);
    RUN_TEST(test_it_gains_speed_no_faster_than_it_can);
    RUN_TEST(test_a_turn_made_anew_goes_on_from_the_rate_that_is_told);
    RUN_TEST(test_too_many_places_are_told);
    return UNITY_END();
}
