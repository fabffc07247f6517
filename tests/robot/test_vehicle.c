#include "robot/vehicle.h" // first: proves that the header stands alone

#include "base/angle.h"
#include "base/rng.h"
#include "unity.h"

#include <float.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

static aisle_vehicle_msg msg;
static aisle_vehicle vehicle;
static aisle_refusal why;

void setUp(void) {
    memset(&msg, 0, sizeof msg);
    memset(&vehicle, 0, sizeof vehicle);
    memset(&why, 0, sizeof why);
}
void tearDown(void) {}

// ---- helpers

static void take(void) {
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_vehicle_from_msg(&msg, &vehicle, &why));
}

static void set_footprint(const double (*v)[2], int16_t n) {
    msg.num_vertices = n;
    for (int16_t i = 0; i < n; i++) {
        msg.footprint[i][0] = v[i][0];
        msg.footprint[i][1] = v[i][1];
    }
}

static void set_box(double x0, double y0, double x1, double y1) {
    const double box[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    set_footprint(box, 4);
}

// Refused with this member; the vehicle that was there stays, byte for byte.
static void assert_refused(int32_t member) {
    aisle_vehicle before;
    memset(&before, 0x5A, sizeof before);
    memcpy(&vehicle, &before, sizeof before);
    why = (aisle_refusal){0};
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_DATA, aisle_vehicle_from_msg(&msg, &vehicle, &why));
    TEST_ASSERT_EQUAL_MEMORY(&before, &vehicle, sizeof before);
    TEST_ASSERT_EQUAL_INT16(AISLE_STATUS_MALFORMED, why.cause);
    TEST_ASSERT_EQUAL_INT32(member, why.id);
}

typedef struct row { // by hand from vehicle_t.lcm and the header, not from the table in vehicle.c
    const char *name;
    int32_t member;
    size_t in, out;
    float usual, most;
} row;
#define ROW(member, name, usual, most)                                                                                 \
    { #name, member, offsetof(aisle_vehicle_msg, name), offsetof(aisle_vehicle, name), usual, most }
static const row rows[] = {
    ROW(6, v_max, 1.5F, 20.0F),
    ROW(7, v_reverse_max, 0.3F, 20.0F),
    ROW(8, a_max, 0.5F, 1e6F),
    ROW(9, d_max, 0.5F, 1e6F),
    ROW(10, omega_max, 1.0F, 1e6F),
    ROW(11, alpha_max, 1.0F, 1e6F),
    ROW(12, lateral_a_max, 0.5F, 1e6F),
    ROW(13, curvature_max, 0.0F, 1e6F),
    ROW(14, reaction_time, 0.3F, 1e6F),
    ROW(15, margin, 0.1F, 1e6F),
    ROW(16, creep_clearance, 0.5F, 1e6F),
    ROW(17, creep_speed, 0.3F, 1e6F),
    ROW(18, pose_timeout, 0.2F, 1e6F),
    ROW(19, obstacles_timeout, 0.3F, 1e6F),
    ROW(20, mass, 500.0F, 1e6F),
    ROW(21, rolling_resistance, 0.015F, 1e6F),
    ROW(22, idle_power, 50.0F, 1e6F),
    ROW(23, drive_efficiency, 0.8F, 1.0F),
};
enum { ROWS = (int)(sizeof rows / sizeof rows[0]), MARGIN = 15, V_MAX = 6, V_REVERSE_MAX = 7, CREEP_SPEED = 17 };

static void set_number(const row *r, float value) {
    memcpy((char *)&msg + r->in, &value, sizeof value);
}

static double number(const row *r) {
    double value;
    memcpy(&value, (const char *)&vehicle + r->out, sizeof value);
    return value;
}

// ---- defaults and values

static void test_zeros_give_every_default(void) {
    take();
    for (int i = 0; i < ROWS; i++) {
        TEST_ASSERT_TRUE_MESSAGE(number(&rows[i]) >= (double)rows[i].usual && number(&rows[i]) <= (double)rows[i].usual,
                                 rows[i].name);
    }
    TEST_ASSERT_EQUAL_INT8(AISLE_VEHICLE_DIFFERENTIAL, vehicle.drive);
}

static void test_a_default_given_by_name_and_one_left_zero_give_the_same_bits(void) {
    take();
    const aisle_vehicle usual = vehicle;
    for (int i = 0; i < ROWS; i++) {
        set_number(&rows[i], rows[i].usual);
    }
    set_box(-0.5, -0.35, 0.5, 0.35);
    take();
    TEST_ASSERT_EQUAL_MEMORY(&usual, &vehicle, sizeof usual);
}

static void test_every_number_given_arrives_in_its_own_place_up_to_its_limit(void) {
    for (int i = 0; i < ROWS; i++) {
        setUp();
        set_number(&rows[0], 20.0F); // v_max, out of the way of creep_speed
        const float given[] = {rows[i].usual > 0.0F ? 0.7F * rows[i].usual : 0.125F,
                               rows[i].member == CREEP_SPEED ? 20.0F : rows[i].most};
        for (int k = 0; k < 2; k++) {
            set_number(&rows[i], given[k]);
            take();
            for (int j = 0; j < ROWS; j++) {
                const float expected = j == i ? given[k] : (j == 0 ? 20.0F : rows[j].usual);
                TEST_ASSERT_EQUAL_FLOAT_MESSAGE(expected, (float)number(&rows[j]), rows[j].name);
            }
        }
    }
}

static void test_revision_and_drive_are_taken_over(void) {
    msg.vehicle_revision = -7;
    msg.drive = AISLE_VEHICLE_OMNI;
    take();
    TEST_ASSERT_EQUAL_INT32(-7, vehicle.revision);
    TEST_ASSERT_EQUAL_INT8(AISLE_VEHICLE_OMNI, vehicle.drive);
}

static void test_negative_margin_means_none(void) {
    msg.margin = -1.0F;
    take();
    TEST_ASSERT_FALSE(vehicle.margin > 0.0 || vehicle.margin < 0.0);
    msg.margin = -FLT_MAX;
    take();
    TEST_ASSERT_FALSE(vehicle.margin > 0.0 || vehicle.margin < 0.0);
}

static void test_creep_speed_above_v_max_is_lowered_to_it(void) {
    msg.v_max = 0.2F;
    take();
    TEST_ASSERT_EQUAL_FLOAT(0.2F, (float)vehicle.creep_speed); // the default, too
    msg.creep_speed = 7.0F;
    take();
    TEST_ASSERT_EQUAL_FLOAT(0.2F, (float)vehicle.creep_speed);
    msg.creep_speed = 0.15F;
    take();
    TEST_ASSERT_EQUAL_FLOAT(0.15F, (float)vehicle.creep_speed);
}

static void test_default_reverse_speed_is_at_most_v_max_and_a_given_one_may_be_above(void) {
    msg.v_max = 0.2F;
    take();
    TEST_ASSERT_EQUAL_FLOAT(0.2F, (float)vehicle.v_reverse_max);
    msg.v_reverse_max = 0.9F;
    take();
    TEST_ASSERT_EQUAL_FLOAT(0.9F, (float)vehicle.v_reverse_max);
}

// ---- footprint

static void test_no_footprint_is_one_metre_by_seventy_centimetres_about_the_origin(void) {
    take();
    TEST_ASSERT_EQUAL_UINT32(4, vehicle.n);
    double lo_x = 9.0, hi_x = -9.0, lo_y = 9.0, hi_y = -9.0;
    for (int i = 0; i < 4; i++) {
        lo_x = fmin(lo_x, vehicle.footprint[i].x);
        hi_x = fmax(hi_x, vehicle.footprint[i].x);
        lo_y = fmin(lo_y, vehicle.footprint[i].y);
        hi_y = fmax(hi_y, vehicle.footprint[i].y);
    }
    const double found[4] = {lo_x, hi_x, lo_y, hi_y}, expected[4] = {-0.5, 0.5, -0.35, 0.35};
    TEST_ASSERT_EQUAL_MEMORY(expected, found, sizeof found);
    TEST_ASSERT_TRUE(aisle_convex_is_valid(vehicle.footprint, 4, 16));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.35, vehicle.inner_radius);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, sqrt(0.5 * 0.5 + 0.35 * 0.35), vehicle.outer_radius);
    TEST_ASSERT_FALSE(aisle_vehicle_is_disc(&vehicle));
}

static void test_a_radius_alone_is_a_disc_about_the_origin(void) {
    msg.footprint_radius = 0.25F;
    memset(msg.footprint, 0x33, sizeof msg.footprint); // behind the count: not to be looked at
    take();
    TEST_ASSERT_EQUAL_UINT32(1, vehicle.n);
    const aisle_vec2 origin = {0.0, 0.0};
    TEST_ASSERT_EQUAL_MEMORY(&origin, &vehicle.footprint[0], sizeof origin);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, vehicle.radius);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, vehicle.inner_radius);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, vehicle.outer_radius);
    TEST_ASSERT_TRUE(aisle_vehicle_is_disc(&vehicle));
}

static void test_a_polygon_is_taken_vertex_by_vertex_and_rounded_by_the_radius(void) {
    const double wedge[3][2] = {{-0.4, -0.5}, {1.25, 0.0}, {-0.4, 0.5}};
    set_footprint(wedge, 3);
    msg.footprint_radius = 0.125F;
    take();
    TEST_ASSERT_EQUAL_UINT32(3, vehicle.n);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(wedge[i][0], vehicle.footprint[i].x);
        TEST_ASSERT_EQUAL_DOUBLE(wedge[i][1], vehicle.footprint[i].y);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.125, vehicle.radius);
    TEST_ASSERT_FALSE(aisle_vehicle_is_disc(&vehicle));
}

// Distance from the origin to the rim along a direction that starts inside, by bisection on "is within radius of the
// polygon".
static bool brute_inside(double x, double y, double slack) {
    bool inside = vehicle.n >= 3;
    double gap = 1e9;
    for (uint32_t i = 0; i < vehicle.n; i++) {
        const aisle_vec2 a = vehicle.footprint[i], b = vehicle.footprint[(i + 1) % vehicle.n];
        inside = inside && (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) >= 0.0;
        const double sx = b.x - a.x, sy = b.y - a.y, square = sx * sx + sy * sy;
        const double along = square > 0.0 ? fmin(1.0, fmax(0.0, ((x - a.x) * sx + (y - a.y) * sy) / square)) : 0.0;
        gap = fmin(gap, hypot(x - a.x - along * sx, y - a.y - along * sy));
    }
    return inside || gap <= vehicle.radius + slack;
}

// Points of circles a little smaller than inner_radius lie inside, of the circle a little larger some do not; and the
// other way round for outer_radius.
static void assert_radii_are_right(void) {
    const double in = vehicle.inner_radius, out = vehicle.outer_radius, step = 2e-4;
    const double tip = 1e-2; // a sharp corner falls between two directions
    bool all_in = true, larger_leaves = false, smaller_reaches = false;
    for (int i = 0; i < 3600; i++) {
        const double c = cos(i * AISLE_PI / 1800.0), s = sin(i * AISLE_PI / 1800.0);
        all_in = all_in && (!(in > 0.0) || brute_inside((in - 1e-9) * c, (in - 1e-9) * s, 1e-12));
        larger_leaves = larger_leaves || !brute_inside((in + step) * c, (in + step) * s, 0.0);
        TEST_ASSERT_FALSE(brute_inside((out + 1e-9) * c, (out + 1e-9) * s, 0.0));
        smaller_reaches = smaller_reaches || brute_inside((out - tip) * c, (out - tip) * s, 0.0);
    }
    TEST_ASSERT_TRUE(all_in);
    TEST_ASSERT_TRUE(larger_leaves);
    TEST_ASSERT_TRUE(smaller_reaches);
}

// A convex polygon: points of an ellipse at rising angles, shifted.
static void random_footprint(aisle_rng *rng) {
    const int16_t n = (int16_t)(3 + aisle_rng_below(rng, 14));
    const double a = 0.3 + (double)aisle_rng_float(rng), b = 0.3 + 0.5 * (double)aisle_rng_float(rng);
    const double x = 1.5 * (double)aisle_rng_float(rng) - 0.75, y = (double)aisle_rng_float(rng) - 0.5;
    const double slot = 2.0 * AISLE_PI / n;
    msg.num_vertices = n;
    for (int i = 0; i < n; i++) {
        const double angle = slot * (i + 0.8 * (double)aisle_rng_float(rng));
        msg.footprint[i][0] = x + a * cos(angle);
        msg.footprint[i][1] = y + b * sin(angle);
    }
}

static void test_radii_agree_with_brute_force_for_200_of_200_footprints(void) {
    int outside = 0, rounded_over = 0;
    for (uint64_t seed = 0; seed < 200; seed++) {
        aisle_rng rng = aisle_rng_seed(seed);
        random_footprint(&rng);
        msg.footprint_radius = seed % 2 == 0 ? 0.0F : 0.4F * aisle_rng_float(&rng);
        take();
        assert_radii_are_right();
        outside += vehicle.inner_radius > 0.0 ? 0 : 1;
        rounded_over += vehicle.inner_radius > 0.0 && vehicle.inner_radius < vehicle.radius ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN_INT(10, outside); // the seeds meet the special cases
    TEST_ASSERT_GREATER_THAN_INT(5, rounded_over);
}

static void test_inner_radius_is_zero_if_the_origin_is_outside_and_counts_the_rounding_if_that_covers_it(void) {
    set_box(0.5, -0.5, 1.5, 0.5);
    take();
    TEST_ASSERT_EQUAL_DOUBLE(0.0, vehicle.inner_radius);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, sqrt(2.5), vehicle.outer_radius);
    msg.footprint_radius = 0.75F;
    take();
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.25, vehicle.inner_radius);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, sqrt(2.5) + 0.75, vehicle.outer_radius);
}

static void test_repeated_and_collinear_vertices_do_not_disturb_the_radii(void) {
    const double outline[7][2] = {{-0.5, -0.3}, {0.0, -0.3}, {0.5, -0.3}, {0.5, -0.3}, {0.5 - 1e-16, -0.3 + 1e-13},
                                  {0.5, 0.3},   {-0.5, 0.3}};
    set_footprint(outline, 7);
    take();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.3, vehicle.inner_radius);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, sqrt(0.34), vehicle.outer_radius);
}

static void test_the_arm_is_not_looked_at(void) {
    take();
    const aisle_vehicle without = vehicle;
    msg.num_links = 3;
    for (int i = 0; i < 3; i++) {
        msg.arm_base[i] = -1e300;
        msg.link_length[i] = -1.0F;
    }
    take();
    TEST_ASSERT_EQUAL_MEMORY(&without, &vehicle, sizeof without);
}

// ---- refusals

static void test_every_number_refuses_negative_too_large_nan_and_infinite(void) {
    for (int i = 0; i < ROWS; i++) {
        const float bad[] = {-0.001F, -FLT_MAX, nextafterf(rows[i].most, INFINITY), FLT_MAX, NAN, INFINITY, -INFINITY};
        for (int k = rows[i].member == MARGIN ? 2 : 0; k < 7; k++) {
            setUp();
            set_number(&rows[i], bad[k]);
            assert_refused(rows[i].member);
            TEST_ASSERT_TRUE(isnan(bad[k]) ? isnan(why.value) : memcmp(&bad[k], &why.value, sizeof bad[k]) == 0);
        }
    }
}

static void test_the_first_member_at_fault_is_named(void) {
    msg.mass = -1.0F;
    msg.a_max = -2.0F;
    assert_refused(8);
    TEST_ASSERT_EQUAL_FLOAT(-2.0F, why.value);
    msg.footprint_radius = -3.0F;
    assert_refused(5);
    msg.num_vertices = -4;
    assert_refused(3);
    msg.drive = -5;
    assert_refused(2);
}

static void test_unknown_drives_are_refused(void) {
    const int8_t bad[] = {-1, 3, 127, -128};
    for (int i = 0; i < 4; i++) {
        msg.drive = bad[i];
        assert_refused(2);
        TEST_ASSERT_EQUAL_FLOAT((float)bad[i], why.value);
    }
}

static void test_counts_of_vertices_that_make_no_polygon_are_refused(void) {
    const int16_t bad[] = {-1, 1, 2, 17, 32767, -32768};
    set_box(-1.0, -1.0, 1.0, 1.0);
    for (int i = 0; i < 6; i++) {
        msg.num_vertices = bad[i];
        assert_refused(3);
        TEST_ASSERT_EQUAL_FLOAT((float)bad[i], why.value);
    }
}

static void test_an_outline_that_is_clockwise_or_dented_or_without_area_is_refused(void) {
    const double clockwise[4][2] = {{-1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}};
    const double dented[5][2] = {{-1.0, -1.0}, {1.0, -1.0}, {0.2, 0.0}, {1.0, 1.0}, {-1.0, 1.0}};
    const double flat[3][2] = {{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};
    set_footprint(clockwise, 4);
    assert_refused(4);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, why.value);
    set_footprint(dented, 5);
    assert_refused(4);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, why.value);
    set_footprint(flat, 3);
    assert_refused(4);
}

static void test_a_vertex_not_finite_or_out_of_range_is_refused_and_named(void) {
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1.1e5, -1e300};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 10; k++) {
            set_box(-1.0, -1.0, 1.0, 1.0);
            msg.footprint[i][k % 2] = bad[k / 2];
            assert_refused(4);
            TEST_ASSERT_EQUAL_FLOAT((float)i, why.value);
        }
    }
}

static void test_outer_radius_up_to_twenty_metres_is_taken_and_beyond_is_refused(void) {
    set_box(-16.0, -12.0, 16.0, 12.0); // 3-4-5: half the diagonal is 20
    take();
    TEST_ASSERT_EQUAL_DOUBLE(20.0, vehicle.outer_radius);
    set_box(-16.0, -12.0, 16.01, 12.0);
    assert_refused(4);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, hypotf(16.01F, 12.0F), why.value);
    set_box(-16.0, -12.0, 16.0, 12.0);
    msg.footprint_radius = 0.001F;
    assert_refused(5);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 20.001F, why.value);
    setUp();
    msg.footprint_radius = 20.0F;
    take();
    msg.footprint_radius = 20.001F;
    assert_refused(5);
}

static void test_a_radius_negative_or_not_finite_is_refused(void) {
    const float bad[] = {-0.001F, -FLT_MAX, FLT_MAX, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 12; i++) {
        setUp();
        if (i >= 6) {
            set_box(-1.0, -1.0, 1.0, 1.0);
        }
        msg.footprint_radius = bad[i % 6];
        assert_refused(5);
    }
}

// ---- placing

static void test_placed_points_are_exact_to_the_stated_error(void) {
    aisle_rng rng = aisle_rng_seed(5);
    for (int trial = 0; trial < 2000; trial++) {
        random_footprint(&rng);
        msg.footprint_radius = 0.1F * aisle_rng_float(&rng);
        take();
        const double reach = trial % 3 == 0 ? 1e5 : 100.0, spin = trial % 5 == 0 ? AISLE_ANGLE_MAX : AISLE_PI;
        const aisle_pose2 pose = {reach * (2.0 * (double)aisle_rng_float(&rng) - 1.0),
                                  reach * (2.0 * (double)aisle_rng_float(&rng) - 1.0),
                                  spin * (2.0 * (double)aisle_rng_float(&rng) - 1.0)};
        aisle_vec2 out[AISLE_SHAPE_VERTICES_MAX];
        const double grow = trial % 2 == 0 ? 0.3 : -vehicle.radius;
        const aisle_convex placed = aisle_vehicle_place(&vehicle, pose, grow, out);
        TEST_ASSERT_TRUE(placed.v == out && placed.n == vehicle.n);
        TEST_ASSERT_EQUAL_DOUBLE(vehicle.radius + grow, placed.radius);
        const long double c = cosl((long double)pose.theta), s = sinl((long double)pose.theta);
        const long double px = (long double)pose.x, py = (long double)pose.y;
        const long double bound = 4e-15L * (fabsl(px) + fabsl(py) + (long double)vehicle.outer_radius);
        for (uint32_t i = 0; i < vehicle.n; i++) {
            const long double x = (long double)vehicle.footprint[i].x, y = (long double)vehicle.footprint[i].y;
            TEST_ASSERT_TRUE(fabsl(px + c * x - s * y - (long double)out[i].x) <= bound);
            TEST_ASSERT_TRUE(fabsl(py + s * x + c * y - (long double)out[i].y) <= bound);
        }
    }
}

static void test_place_writes_no_more_than_its_points(void) {
    aisle_vec2 out[AISLE_SHAPE_VERTICES_MAX];
    memset(out, 0x77, sizeof out);
    const aisle_vec2 canary = out[4];
    take();
    (void)aisle_vehicle_place(&vehicle, (aisle_pose2){1.0, 2.0, 0.5}, 0.0, out);
    TEST_ASSERT_EQUAL_MEMORY(&canary, &out[4], sizeof canary);
}

static void test_a_disc_is_placed_the_same_for_every_heading(void) {
    msg.footprint_radius = 0.5F;
    take();
    for (int i = 0; i < 100; i++) {
        aisle_vec2 at;
        const aisle_convex placed = aisle_vehicle_place(&vehicle, (aisle_pose2){3.0, -4.0, 0.1 * i}, 0.25, &at);
        const aisle_vec2 expected = {3.0, -4.0};
        TEST_ASSERT_EQUAL_MEMORY(&expected, &at, sizeof at);
        TEST_ASSERT_EQUAL_UINT32(1, placed.n);
        TEST_ASSERT_EQUAL_DOUBLE(0.75, placed.radius);
    }
}

static size_t content(uint8_t *out) {
    take();
    memset(out, 0, AISLE_VEHICLE_CONTENT_BYTES);
    return aisle_vehicle_content(&vehicle, out);
}

static void test_content_tells_every_member_but_the_revision(void) {
    uint8_t first[AISLE_VEHICLE_CONTENT_BYTES], other[AISLE_VEHICLE_CONTENT_BYTES];
    set_box(-0.5, -0.4, 0.6, 0.4);
    msg.footprint_radius = 0.1F;
    const size_t size = content(first);
    msg.vehicle_revision = 9;
    msg.utime = 1234;
    memset(&vehicle, 0xA5, sizeof vehicle); // padding
    TEST_ASSERT_EQUAL_size_t(size, content(other));
    TEST_ASSERT_EQUAL_MEMORY(first, other, size);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        float *number = (float *)((uint8_t *)&msg + rows[i].in);
        *number = rows[i].usual > 0.0F ? 0.9F * rows[i].usual : 1.0F;
        TEST_ASSERT_EQUAL_size_t(size, content(other));
        TEST_ASSERT_TRUE_MESSAGE(memcmp(first, other, size) != 0, rows[i].name);
        *number = 0.0F;
    }
    msg.drive = AISLE_VEHICLE_OMNI;
    (void)content(other);
    TEST_ASSERT_TRUE(memcmp(first, other, size) != 0);
    msg.drive = AISLE_VEHICLE_DIFFERENTIAL;
    set_box(-0.5, -0.4, 0.6, 0.41);
    (void)content(other);
    TEST_ASSERT_TRUE(memcmp(first, other, size) != 0);
    const double three[3][2] = {{-0.5, -0.4}, {0.6, -0.4}, {0.6, 0.4}};
    set_footprint(three, 3);
    TEST_ASSERT_EQUAL_size_t(size - sizeof(aisle_vec2), content(other));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_content_tells_every_member_but_the_revision);
    RUN_TEST(test_zeros_give_every_default);
    RUN_TEST(test_a_default_given_by_name_and_one_left_zero_give_the_same_bits);
    RUN_TEST(test_every_number_given_arrives_in_its_own_place_up_to_its_limit);
    RUN_TEST(test_revision_and_drive_are_taken_over);
    RUN_TEST(test_negative_margin_means_none);
    RUN_TEST(test_creep_speed_above_v_max_is_lowered_to_it);
    RUN_TEST(test_default_reverse_speed_is_at_most_v_max_and_a_given_one_may_be_above);
    RUN_TEST(test_no_footprint_is_one_metre_by_seventy_centimetres_about_the_origin);
    RUN_TEST(test_a_radius_alone_is_a_disc_about_the_origin);
    RUN_TEST(test_a_polygon_is_taken_vertex_by_vertex_and_rounded_by_the_radius);
    RUN_TEST(test_radii_agree_with_brute_force_for_200_of_200_footprints);
    RUN_TEST(test_inner_radius_is_zero_if_the_origin_is_outside_and_counts_the_rounding_if_that_covers_it);
    RUN_TEST(test_repeated_and_collinear_vertices_do_not_disturb_the_radii);
    RUN_TEST(test_the_arm_is_not_looked_at);
    RUN_TEST(test_every_number_refuses_negative_too_large_nan_and_infinite);
    RUN_TEST(test_the_first_member_at_fault_is_named);
    RUN_TEST(test_unknown_drives_are_refused);
    RUN_TEST(test_counts_of_vertices_that_make_no_polygon_are_refused);
    RUN_TEST(test_an_outline_that_is_clockwise_or_dented_or_without_area_is_refused);
    RUN_TEST(test_a_vertex_not_finite_or_out_of_range_is_refused_and_named);
    RUN_TEST(test_outer_radius_up_to_twenty_metres_is_taken_and_beyond_is_refused);
    RUN_TEST(test_a_radius_negative_or_not_finite_is_refused);
    RUN_TEST(test_placed_points_are_exact_to_the_stated_error);
    RUN_TEST(test_place_writes_no_more_than_its_points);
    RUN_TEST(test_a_disc_is_placed_the_same_for_every_heading);
    return UNITY_END();
}
