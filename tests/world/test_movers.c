#include "world/movers.h"

#include "base/rng.h"
#include "unity.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { SOURCES = AISLE_OBSTACLES_MAX_SOURCES, MOST = AISLE_OBSTACLES_MAX_OBSTACLES };
static const int64_t now = 1790000000000000; // us

static unsigned char memory[(size_t)AISLE_MOVERS_MAX * sizeof(aisle_mover) + 128U];
static aisle_movers movers;
static aisle_obstacles_msg msg;
static aisle_refusal why;
static aisle_rng dice;

static double uniform(double lo, double hi) {
    return lo + (hi - lo) * (double)aisle_rng_float(&dice);
}

void setUp(void) {
    unsigned char *start = memory + (64U - (uintptr_t)memory % 64U) % 64U;
    aisle_arena arena = aisle_arena_over(start, sizeof memory - 64U);
    memset(&movers, 0, sizeof movers);
    aisle_movers_carve(&movers, &arena);
    TEST_ASSERT_FALSE(arena.overflow);
    memset(&msg, 0, sizeof msg);
    msg.utime = now;
    msg.seq = 1;
}
void tearDown(void) {}

// A disc of 0.3 m that walks.
static aisle_obstacle_msg *add(int32_t id) {
    aisle_obstacle_msg *o = &msg.obstacles[msg.num_obstacles++];
    memset(o, 0, sizeof *o);
    o->id = id;
    o->kind = AISLE_OBSTACLE_PERSON;
    o->x = 0.5 * id;
    o->y = -0.25 * id;
    o->vx = 1.0F;
    o->radius = 0.3F;
    return o;
}

static aisle_status take(void) {
    why = (aisle_refusal){77, 77, 7.0F};
    return aisle_movers_take(&movers, &msg, now, 3, &why);
}

static void assert_taken(void) {
    const uint32_t before = movers.revision;
    TEST_ASSERT_EQUAL(AISLE_OK, take());
    TEST_ASSERT_EQUAL_UINT32(before + 1U, movers.revision);
    TEST_ASSERT_EQUAL_INT16(0, why.cause);
}

// And nothing has changed.
static void assert_answer(aisle_status status, int16_t cause, int32_t id) {
    static aisle_mover held[AISLE_MOVERS_MAX];
    const aisle_movers then = movers;
    memcpy(held, movers.mover, sizeof held);
    TEST_ASSERT_EQUAL(status, take());
    TEST_ASSERT_EQUAL_INT16(cause, why.cause);
    TEST_ASSERT_EQUAL_INT32(id, why.id);
    TEST_ASSERT_EQUAL_MEMORY(&then, &movers, sizeof then);
    TEST_ASSERT_EQUAL_MEMORY(held, movers.mover, sizeof held);
}

static void assert_refused(int16_t cause, int32_t id) {
    assert_answer(AISLE_ERR_DATA, cause, id);
}

static const aisle_mover *only(void) {
    TEST_ASSERT_EQUAL_UINT32(1, movers.count);
    return &movers.mover[0];
}

// ---- what a mover is

static void test_a_disc_is_taken_as_told(void) {
    aisle_obstacle_msg *o = add(9);
    o->vy = -0.5F;
    o->sigma_v = 0.4F;
    o->v_bound = 3.0F;
    o->cov_xy[0] = 0.04F;
    o->cov_xy[2] = 0.01F;
    msg.source = 2;
    assert_taken();
    const aisle_mover *m = only();
    TEST_ASSERT_EQUAL_INT32(9, m->id);
    TEST_ASSERT_EQUAL_UINT8(2, m->source);
    TEST_ASSERT_EQUAL_INT8(AISLE_OBSTACLE_PERSON, m->kind);
    TEST_ASSERT_EQUAL_DOUBLE(4.5, m->at.x);
    TEST_ASSERT_EQUAL_DOUBLE(-2.25, m->at.y);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, m->velocity.x);
    TEST_ASSERT_EQUAL_DOUBLE(-0.5, m->velocity.y);
    TEST_ASSERT_EQUAL_DOUBLE((double)0.3F, m->radius);
    TEST_ASSERT_EQUAL_DOUBLE((double)0.4F, m->sigma_v);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, m->v_bound);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.2, m->sigma);
    TEST_ASSERT_EQUAL_INT64(now, m->utime);
}

static void test_what_is_not_told_has_its_default(void) {
    const double bound[4] = {2.0, 1.6, 2.0, 0.0};
    for (int8_t kind = AISLE_OBSTACLE_UNKNOWN; kind <= AISLE_OBSTACLE_STATIC; kind++) {
        msg.num_obstacles = 0;
        aisle_obstacle_msg *o = add(1);
        o->kind = kind;
        o->vx = 0.0F;
        msg.seq++;
        assert_taken();
        TEST_ASSERT_EQUAL_DOUBLE(bound[kind], only()->v_bound);
        TEST_ASSERT_EQUAL_DOUBLE(AISLE_MOVERS_SIGMA, only()->sigma);
        TEST_ASSERT_EQUAL_DOUBLE(AISLE_MOVERS_SIGMA_V, only()->sigma_v);
    }
}

static void test_a_bound_is_never_below_the_speed_told(void) {
    aisle_obstacle_msg *o = add(1);
    o->vx = 3.0F;
    o->vy = -4.0F;
    assert_taken();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, only()->v_bound);
    o->v_bound = 4.0F;
    msg.seq++;
    assert_taken();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, only()->v_bound);
    o->kind = AISLE_OBSTACLE_STATIC;
    o->v_bound = 0.0F;
    msg.seq++;
    assert_taken();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, only()->v_bound);
}

// The disc holds every point of the body, whatever its heading, and one of them touches it.
static void test_the_disc_holds_the_body_however_it_turns(void) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        long double farthest = 0.0L;
        dice = aisle_rng_seed(seed);
        msg.num_obstacles = 0;
        aisle_obstacle_msg *o = add(1);
        o->num_vertices = (int16_t)(3U + aisle_rng_below(&dice, 6));
        const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), turn = uniform(0.0, 6.0);
        for (int i = 0; i < o->num_vertices; i++) {
            const double a = turn + 6.283185307 * i / o->num_vertices;
            o->vertices[i][0] = (float)(x + 0.8 * cos(a));
            o->vertices[i][1] = (float)(y + 0.8 * sin(a));
            farthest = fmaxl(farthest, hypotl((long double)o->vertices[i][0], (long double)o->vertices[i][1]));
        }
        o->radius = seed % 2U == 0U ? 0.0F : 0.1F;
        msg.seq++;
        assert_taken();
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, (double)(farthest + (long double)o->radius), only()->radius);
    }
}

// Against the largest variance over all directions.
static void test_sigma_is_that_of_the_worst_direction(void) {
    for (uint64_t seed = 0; seed < 300; seed++) {
        long double most = 0.0L;
        dice = aisle_rng_seed(seed);
        msg.num_obstacles = 0;
        aisle_obstacle_msg *o = add(1);
        const double a = uniform(0.0, 0.4), b = uniform(0.0, 0.4), c = uniform(-1.0, 1.0);
        o->cov_xy[0] = (float)(a * a);
        o->cov_xy[1] = (float)(a * b * c);
        o->cov_xy[2] = (float)(b * b);
        for (int i = 0; i < 20000; i++) {
            const long double u = cosl(1.5707963267948966L * i / 10000.0L),
                              v = sinl(1.5707963267948966L * i / 10000.0L);
            most = fmaxl(most, u * u * (long double)o->cov_xy[0] + 2.0L * u * v * (long double)o->cov_xy[1] +
                                   v * v * (long double)o->cov_xy[2]);
        }
        msg.seq++;
        assert_taken();
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, (double)sqrtl(most), only()->sigma);
    }
}

// ---- where it can be

static void test_the_reach_grows_by_the_bound_from_the_measurement_on(void) {
    aisle_obstacle_msg *o = add(1);
    o->v_bound = 2.5F;
    assert_taken();
    const aisle_mover *m = only();
    const double still = (double)0.3F + 3.0 * AISLE_MOVERS_SIGMA;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, still, aisle_mover_reach(m, now));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, still, aisle_mover_reach(m, now - 500000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, still, aisle_mover_reach(m, INT64_MIN));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, still + 2.5, aisle_mover_reach(m, now + 1000000));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, still + 2.5 * 3600.0, aisle_mover_reach(m, now + 3600000000));
    double before = 0.0;
    for (int64_t t = now - 1000000; t < now + 1000000; t += 12345) {
        TEST_ASSERT_TRUE(aisle_mover_reach(m, t) >= before);
        before = aisle_mover_reach(m, t);
    }
}

// Whatever it does within its bound, from anywhere within 3 sigma of where it was seen, its body stays in the reach.
static void test_no_motion_within_the_bound_leaves_the_reach(void) {
    for (uint64_t seed = 0; seed < 500; seed++) {
        dice = aisle_rng_seed(seed);
        msg.num_obstacles = 0;
        aisle_obstacle_msg *o = add(1);
        o->v_bound = (float)uniform(0.2, 3.0);
        o->vx = 0.1F;
        msg.seq++;
        assert_taken();
        const aisle_mover *m = only();
        const double off = uniform(0.0, 3.0 * AISLE_MOVERS_SIGMA), way = uniform(-3.1, 3.1);
        double x = m->at.x + off * cos(way), y = m->at.y + off * sin(way), course = uniform(-3.1, 3.1);
        for (int i = 1; i <= 100; i++) {
            course += uniform(-0.5, 0.5);
            x += (double)o->v_bound * 0.02 * cos(course);
            y += (double)o->v_bound * 0.02 * sin(course);
            const double edge = hypot(x - m->at.x, y - m->at.y) + (double)o->radius;
            TEST_ASSERT_TRUE(edge <= aisle_mover_reach(m, now + 20000 * i) + 1e-9);
        }
    }
}

static void test_it_is_likely_to_go_on_as_it_goes(void) {
    aisle_obstacle_msg *o = add(4);
    double sigma = 0.0;
    o->vy = -0.5F;
    o->sigma_v = 0.3F;
    assert_taken();
    const aisle_mover *m = only();
    aisle_vec2 at = aisle_mover_predicted(m, now + 2000000, &sigma);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, at.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2.0, at.y);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, sqrt(0.05 * 0.05 + 0.6 * 0.6), sigma);
    at = aisle_mover_predicted(m, now - 2000000, &sigma); // not before it was seen
    TEST_ASSERT_EQUAL_DOUBLE(2.0, at.x);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, AISLE_MOVERS_SIGMA, sigma);
    at = aisle_mover_predicted(m, now, NULL);
    TEST_ASSERT_EQUAL_DOUBLE(-1.0, at.y);
}

static void test_times_of_any_size_are_told_apart(void) {
    (void)add(1);
    msg.utime = INT64_MIN;
    assert_taken();
    TEST_ASSERT_TRUE(aisle_mover_reach(only(), INT64_MAX) > 1e13);
    TEST_ASSERT_TRUE(aisle_mover_predicted(only(), INT64_MAX, NULL).x > 1e13);
    int32_t source = 9;
    TEST_ASSERT_TRUE(aisle_movers_stale(&movers, now, 1e6, &source));
    msg.utime = INT64_MAX;
    assert_refused(AISLE_STATUS_CLOCK_JUMP, 0);
    why.cause = 0;
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_movers_take(&movers, &msg, INT64_MIN, 3, &why));
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_CLOCK_JUMP, why.cause);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_movers_take(&movers, &msg, INT64_MAX, 3, &why));
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, aisle_movers_stale_at(&movers, 0.3));
    TEST_ASSERT_FALSE(aisle_movers_stale(&movers, INT64_MAX, 0.3, &source));
}

// ---- snapshots

static void test_a_snapshot_replaces_all_that_its_source_told(void) {
    for (int32_t source = SOURCES - 1; source >= 0; source--) {
        msg.source = source;
        msg.num_obstacles = 0;
        for (int32_t id = 0; id < 3 + source; id++) {
            (void)add(10 * source + id);
        }
        assert_taken();
    }
    TEST_ASSERT_EQUAL_UINT32(3 + 4 + 5 + 6, movers.count);
    msg.source = 1;
    msg.seq = 2;
    msg.num_obstacles = 0;
    (void)add(13);
    (void)add(99);
    assert_taken();
    const int32_t ids[16] = {0, 1, 2, 13, 99, 20, 21, 22, 23, 24, 30, 31, 32, 33, 34, 35};
    TEST_ASSERT_EQUAL_UINT32(16, movers.count);
    for (uint32_t i = 0; i < 16U; i++) {
        TEST_ASSERT_EQUAL_INT32(ids[i], movers.mover[i].id);
    }
    msg.seq = 3;
    msg.num_obstacles = 0; // none any more
    assert_taken();
    TEST_ASSERT_EQUAL_UINT32(14, movers.count);
    TEST_ASSERT_TRUE(movers.source[1].known);
}

static void test_the_same_message_again_is_ignored(void) {
    (void)add(1);
    assert_taken();
    assert_answer(AISLE_PARTIAL, 0, 0);
    (void)add(2); // even if it is not the same
    assert_answer(AISLE_PARTIAL, 0, 0);
    msg.source = 1; // another source's
    assert_taken();
}

static void test_an_older_message_is_refused(void) {
    (void)add(1);
    msg.seq = 10;
    assert_taken();
    msg.seq = 9;
    assert_refused(AISLE_STATUS_OUTDATED, 9);
    msg.utime = now - 1;
    msg.seq = 11;
    assert_refused(AISLE_STATUS_OUTDATED, 11);
    msg.utime = now;
    assert_taken(); // the same time, told again
    msg.utime = now + 1;
    msg.seq = 1; // a source that began anew
    assert_taken();
    TEST_ASSERT_EQUAL_INT32(1, movers.source[0].seq);
    msg.source = 3;
    msg.utime = now - 100000; // others have their own time
    assert_taken();
}

static void test_a_message_from_the_future_is_refused(void) {
    (void)add(1);
    msg.source = 2;
    msg.utime = now + AISLE_MOVERS_AHEAD_US + 1;
    assert_refused(AISLE_STATUS_CLOCK_JUMP, 2);
    msg.utime = now + AISLE_MOVERS_AHEAD_US;
    assert_taken();
}

static void test_a_message_for_another_map_is_refused(void) {
    (void)add(1);
    msg.map_id = 4;
    assert_refused(AISLE_STATUS_MAP_MISMATCH, 4);
    msg.map_id = 3;
    assert_taken();
    msg.seq++;
    msg.map_id = 0;
    assert_taken();
    msg.seq++;
    msg.map_id = 4;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_movers_take(&movers, &msg, now, 0, &why)); // there is no map yet
}

static void test_sources_and_counts_have_their_bounds(void) {
    msg.source = -1;
    assert_refused(AISLE_STATUS_LIMIT, -1);
    msg.source = SOURCES;
    assert_refused(AISLE_STATUS_LIMIT, SOURCES);
    msg.source = 0;
    msg.num_obstacles = MOST + 1;
    assert_refused(AISLE_STATUS_LIMIT, MOST + 1);
    msg.num_obstacles = -1;
    assert_refused(AISLE_STATUS_MALFORMED, 0);
}

static void test_an_id_told_twice_is_refused(void) {
    for (int32_t id = 0; id < MOST; id++) {
        (void)add(id);
    }
    assert_taken();
    msg.seq++;
    msg.obstacles[MOST - 1].id = 17;
    assert_refused(AISLE_STATUS_CONFLICT, 17);
    msg.obstacles[MOST - 1].id = MOST - 2;
    assert_refused(AISLE_STATUS_CONFLICT, MOST - 2);
}

// ---- numbers

static void assert_malformed(void) {
    assert_refused(AISLE_STATUS_MALFORMED, 2);
}

static void three(void) {
    msg.num_obstacles = 0;
    for (int32_t id = 1; id <= 3; id++) {
        (void)add(id);
    }
}

static void test_every_number_out_of_range_is_refused_with_its_obstacle(void) {
    struct {
        size_t at;
        bool is_double;
        double lo, hi; // may be told
    } numbers[] = {{offsetof(aisle_obstacle_msg, x), true, -1e5, 1e5},
                   {offsetof(aisle_obstacle_msg, y), true, -1e5, 1e5},
                   {offsetof(aisle_obstacle_msg, theta), false, -1e5, 1e5},
                   {offsetof(aisle_obstacle_msg, vx), false, -50.0, 50.0},
                   {offsetof(aisle_obstacle_msg, vy), false, -50.0, 50.0},
                   {offsetof(aisle_obstacle_msg, omega), false, -1e5, 1e5},
                   {offsetof(aisle_obstacle_msg, cov_xy), false, 0.0, 2500.0},
                   {offsetof(aisle_obstacle_msg, cov_xy) + 4U, false, -2500.0, 2500.0},
                   {offsetof(aisle_obstacle_msg, cov_xy) + 8U, false, 0.0, 2500.0},
                   {offsetof(aisle_obstacle_msg, sigma_v), false, 0.0, 50.0},
                   {offsetof(aisle_obstacle_msg, v_bound), false, 0.0, 50.0},
                   {offsetof(aisle_obstacle_msg, radius), false, 1e-30, 50.0}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        const double lo = numbers[i].lo, hi = numbers[i].hi;
        const double values[7] = {lo, hi, lo - 0.01 * fmax(1.0, fabs(lo)), hi * 1.01, (double)NAN, HUGE_VAL, -HUGE_VAL};
        for (int k = 0; k < 7; k++) {
            three();
            unsigned char *at = (unsigned char *)&msg.obstacles[1] + numbers[i].at;
            const float value = (float)values[k];
            memcpy(at, numbers[i].is_double ? (const void *)&values[k] : (const void *)&value,
                   numbers[i].is_double ? sizeof(double) : sizeof(float));
            msg.seq++;
            if (k < 2) {
                assert_taken();
            } else {
                assert_malformed();
            }
        }
    }
}

static void test_a_kind_or_an_outline_that_there_is_not_is_refused(void) {
    static const float square[8][2] = {{1.0F, 1.0F}, {-1.0F, 1.0F}, {-1.0F, -1.0F}, {1.0F, -1.0F}};
    three();
    aisle_obstacle_msg *o = &msg.obstacles[1];
    o->kind = AISLE_OBSTACLE_STATIC + 1;
    assert_malformed();
    o->kind = -1;
    assert_malformed();
    o->kind = AISLE_OBSTACLE_VEHICLE;
    memcpy(o->vertices, square, sizeof square);
    const int16_t counts[5] = {-1, 1, 2, 9, 300};
    for (int i = 0; i < 5; i++) {
        o->num_vertices = counts[i];
        assert_malformed();
    }
    o->num_vertices = 4;
    assert_taken();
    msg.seq++;
    o->vertices[2][0] = 0.5F; // dented
    o->vertices[2][1] = 0.5F;
    assert_malformed();
    memcpy(o->vertices[0], square[1], sizeof square[1]); // the other way round
    memcpy(o->vertices[1], square[0], sizeof square[0]);
    memcpy(o->vertices[2], square[3], sizeof square[3]);
    memcpy(o->vertices[3], square[2], sizeof square[2]);
    assert_malformed();
    memcpy(o->vertices, square, sizeof square);
    o->vertices[3][1] = NAN;
    assert_malformed();
    for (int i = 0; i < 4; i++) {
        o->vertices[i][0] = square[i][0] * 40.0F;
        o->vertices[i][1] = square[i][1] * 40.0F; // farther than any body
    }
    assert_malformed();
    o->num_vertices = 0;
    o->radius = 0.0F; // nothing at all
    assert_malformed();
}

static void test_the_first_at_fault_is_named(void) {
    three();
    msg.obstacles[1].kind = 9;
    msg.obstacles[2].x = HUGE_VAL;
    assert_malformed();
    msg.obstacles[2].id = 1;
    assert_malformed();
    msg.obstacles[1].kind = 0;
    assert_refused(AISLE_STATUS_MALFORMED, 1); // it is the third that is not fit
    msg.obstacles[2].x = 0.0;
    assert_refused(AISLE_STATUS_CONFLICT, 1);
}

// ---- staleness

static void test_a_source_that_spoke_must_keep_speaking(void) {
    int32_t source = 77;
    TEST_ASSERT_FALSE(aisle_movers_stale(&movers, now + 1000000000, 0.3, &source)); // nobody spoke
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, aisle_movers_stale_at(&movers, 0.3));
    TEST_ASSERT_EQUAL_INT64(0, aisle_movers_utime(&movers));
    msg.source = 2;
    assert_taken(); // of nothing
    TEST_ASSERT_EQUAL_INT64(now, aisle_movers_utime(&movers));
    TEST_ASSERT_EQUAL_INT64(now + 300000, aisle_movers_stale_at(&movers, 0.3));
    TEST_ASSERT_FALSE(aisle_movers_stale(&movers, now + 300000, 0.3, &source));
    TEST_ASSERT_EQUAL_INT32(77, source);
    TEST_ASSERT_TRUE(aisle_movers_stale(&movers, now + 300001, 0.3, &source));
    TEST_ASSERT_EQUAL_INT32(2, source);
    msg.source = 1;
    msg.utime = now - 100000; // measured long before it was taken
    assert_taken();
    TEST_ASSERT_EQUAL_INT64(now + 200000, aisle_movers_stale_at(&movers, 0.3));
    TEST_ASSERT_TRUE(aisle_movers_stale(&movers, now + 200001, 0.3, &source));
    TEST_ASSERT_EQUAL_INT32(1, source);
    TEST_ASSERT_EQUAL_INT64(now, aisle_movers_utime(&movers));
    msg.utime = now + 500000; // ahead of our clock: counts from when it was taken
    assert_taken();
    TEST_ASSERT_TRUE(aisle_movers_stale(&movers, now + 300001, 0.3, &source));
    TEST_ASSERT_EQUAL_INT32(1, source);
    TEST_ASSERT_EQUAL_INT64(now + 500000, aisle_movers_utime(&movers));
}

// ---- against a model

typedef struct heard { // of one source
    int32_t id[MOST];
    int count;
} heard;

static void assert_as_heard(const heard *model) {
    uint32_t at = 0;
    for (int s = 0; s < SOURCES; s++) {
        TEST_ASSERT_EQUAL_UINT32((uint32_t)model[s].count, movers.source[s].count);
        TEST_ASSERT_TRUE(movers.source[s].count == 0U || movers.source[s].first == at);
        for (int i = 0; i < model[s].count; i++, at++) {
            TEST_ASSERT_EQUAL_INT32(model[s].id[i], movers.mover[at].id);
            TEST_ASSERT_EQUAL_UINT8(s, movers.mover[at].source);
            TEST_ASSERT_EQUAL_DOUBLE(0.5 * model[s].id[i], movers.mover[at].at.x);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(at, movers.count);
}

static void test_sources_in_any_order_leave_what_each_told_last(void) {
    static heard model[SOURCES];
    dice = aisle_rng_seed(5);
    memset(model, 0, sizeof model);
    for (int i = 0; i < 400; i++) {
        const int s = (int)aisle_rng_below(&dice, SOURCES);
        const uint32_t most = i % 3 == 0 ? MOST + 1U : 6U;
        heard *of = &model[s];
        msg.source = s;
        msg.seq++;
        msg.num_obstacles = 0;
        of->count = (int)aisle_rng_below(&dice, most);
        of->count = i > 390 ? MOST : of->count;
        for (int k = 0; k < of->count; k++) {
            of->id[k] = k * 7 + i;
            (void)add(of->id[k]);
        }
        assert_taken();
        assert_as_heard(model);
        if (of->count > 1) { // refused ones change nothing
            msg.seq++;
            msg.obstacles[of->count - 1].kind = 7;
            assert_refused(AISLE_STATUS_MALFORMED, of->id[of->count - 1]);
        }
    }
}

static void test_all_sources_may_be_full(void) {
    for (int32_t s = 0; s < SOURCES; s++) {
        msg.source = s;
        msg.num_obstacles = 0;
        for (int32_t id = 0; id < MOST; id++) {
            (void)add(id);
        }
        assert_taken();
    }
    TEST_ASSERT_EQUAL_UINT32(AISLE_MOVERS_MAX, movers.count);
    msg.source = 0;
    msg.seq++;
    assert_taken();
    TEST_ASSERT_EQUAL_UINT32(AISLE_MOVERS_MAX, movers.count);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_disc_is_taken_as_told);
    RUN_TEST(test_what_is_not_told_has_its_default);
    RUN_TEST(test_a_bound_is_never_below_the_speed_told);
    RUN_TEST(test_the_disc_holds_the_body_however_it_turns);
    RUN_TEST(test_sigma_is_that_of_the_worst_direction);
    RUN_TEST(test_the_reach_grows_by_the_bound_from_the_measurement_on);
    RUN_TEST(test_no_motion_within_the_bound_leaves_the_reach);
    RUN_TEST(test_it_is_likely_to_go_on_as_it_goes);
    RUN_TEST(test_times_of_any_size_are_told_apart);
    RUN_TEST(test_a_snapshot_replaces_all_that_its_source_told);
    RUN_TEST(test_the_same_message_again_is_ignored);
    RUN_TEST(test_an_older_message_is_refused);
    RUN_TEST(test_a_message_from_the_future_is_refused);
    RUN_TEST(test_a_message_for_another_map_is_refused);
    RUN_TEST(test_sources_and_counts_have_their_bounds);
    RUN_TEST(test_an_id_told_twice_is_refused);
    RUN_TEST(test_every_number_out_of_range_is_refused_with_its_obstacle);
    RUN_TEST(test_a_kind_or_an_outline_that_there_is_not_is_refused);
    RUN_TEST(test_the_first_at_fault_is_named);
    RUN_TEST(test_a_source_that_spoke_must_keep_speaking);
    RUN_TEST(test_sources_in_any_order_leave_what_each_told_last);
    RUN_TEST(test_all_sources_may_be_full);
    return UNITY_END();
}
