#include "wire/codec.h"

#include "cases.h"
#include "fill.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SEEDS = CASES(12), ROOM = 70000 };

static any_msg msg, back, keep;
static uint8_t bytes[ROOM], again[ROOM];
static scalar scalars[FILL_SCALARS_MAX];
static aisle_msg_fault fault;

void setUp(void) {
    memset(&back, 0, sizeof back);
    memset(bytes, 0, sizeof bytes);
    memset(again, 0, sizeof again);
}
void tearDown(void) {}

// ---- an independent hand that writes the wire

typedef struct pen {
    uint8_t *at;
    size_t n;
} pen;

static void put(pen *to, uint64_t value, int width) {
    for (int shift = 8 * (width - 1); shift >= 0; shift -= 8) {
        to->at[to->n++] = (uint8_t)(value >> shift);
    }
}
static void put_float(pen *to, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 4);
}
static void put_double(pen *to, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 8);
}

// ---- helpers over all types

static size_t encoded(aisle_msg_type type, fill_shape shape, uint64_t seed) {
    size_t size = 0;
    fill_message(type, &msg, shape, seed);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AISLE_OK, aisle_msg_encode(type, &msg, bytes, ROOM, &size), aisle_msg_name(type));
    return size;
}

// Refused, for `kind`, and nothing written.
static void refused(aisle_msg_type type, const void *from, size_t size, aisle_msg_fault_kind kind) {
    memset(&keep, 0xA5, sizeof keep);
    memset(&back, 0xA5, sizeof back);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AISLE_ERR_DATA, aisle_msg_decode(type, from, size, &back, &fault),
                                  aisle_msg_name(type));
    TEST_ASSERT_EQUAL_INT_MESSAGE(kind, fault.kind, fault.field);
    TEST_ASSERT_EQUAL_INT(0, memcmp(&keep, &back, sizeof keep));
}

// Either refused, or these very bytes come out again.
static bool holds_its_word(aisle_msg_type type, const uint8_t *from, size_t size) {
    size_t again_size = 0;
    if (aisle_msg_decode(type, from, size, &back, NULL) != AISLE_OK) {
        return true;
    }
    return aisle_msg_encode(type, &back, again, ROOM, &again_size) == AISLE_OK && again_size == size &&
           memcmp(from, again, size) == 0;
}

// ---- bytes

static void test_a_polygon_is_the_bytes_written_by_hand(void) {
    static const uint8_t expected[] = {0x57, 0x66, 0x96, 0xdf, 0xec, 0x3e, 0x3b, 0x32, // fingerprint
                                       0x01, 0x02, 0x03, 0x04, 0x02,                   // id, kind
                                       0x3f, 0x00, 0x00, 0x00, 0xbf, 0x80, 0x00, 0x00, // 0.5F, -1.0F
                                       0x00, 0x03,                                     // three vertices
                                       0x3f, 0xf0, 0,    0,    0,    0,    0,    0,    0x40, 0, 0, 0, 0,    0,
                                       0,    0,    0xc0, 0x08, 0,    0,    0,    0,    0,    0, 0, 0, 0,    0,
                                       0,    0,    0,    0,    0x80, 0,    0,    0,    0,    0, 0, 0, 0x3f, 0xe0};
    const aisle_polygon_msg polygon = {.id = 0x01020304,
                                       .kind = AISLE_POLYGON_SPEED_LIMIT,
                                       .value = 0.5F,
                                       .direction = -1.0F,
                                       .num_vertices = 3,
                                       .vertices = {{1.0, 2.0}, {-3.0, 0.0}, {-0.0, 0.5}}};
    size_t size = 0;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_POLYGON, &polygon, bytes, ROOM, &size));
    TEST_ASSERT_EQUAL_size_t(8 + 15 + 48, size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, sizeof expected);
}

static size_t path_by_hand(const aisle_path_msg *path) { // every member, in the order of path_t.lcm
    pen to = {again, 0};
    put(&to, UINT64_C(0x6680d2e9a2c03d0f), 8);
    put(&to, (uint64_t)path->utime, 8);
    put(&to, (uint64_t)path->boot_id, 8);
    const int32_t inputs[] = {path->path_revision, path->query_id,     path->goal_list_id,    path->goal_list_revision,
                              path->map_id,        path->map_revision, path->vehicle_revision};
    for (size_t i = 0; i < 7; i++) {
        put(&to, (uint32_t)inputs[i], 4);
    }
    put(&to, (uint64_t)path->pose_utime, 8);
    put(&to, (uint64_t)path->obstacles_utime, 8);
    put(&to, (uint64_t)path->t0_utime, 8);
    put(&to, (uint64_t)path->valid_until_utime, 8);
    put(&to, (uint8_t)path->status, 1);
    put(&to, (uint16_t)path->cause, 2);
    put(&to, (uint32_t)path->cause_id, 4);
    put_float(&to, path->cause_value);
    put(&to, (uint8_t)path->planner, 1);
    put(&to, (uint8_t)path->cached, 1);
    put(&to, (uint32_t)path->work_units, 4);
    put(&to, (uint16_t)path->num_base, 2);
    const float facts[] = {
        path->length,        path->length_bound,         path->duration,     path->energy, path->risk,
        path->clearance_min, path->clearance_moving_min, path->planning_time};
    for (size_t i = 0; i < 8; i++) {
        put_float(&to, facts[i]);
    }
    put(&to, (uint32_t)path->certificate, 4);
    put(&to, (uint16_t)path->num_waypoints, 2);
    for (int i = 0; i < path->num_waypoints; i++) {
        const aisle_waypoint_msg *p = &path->waypoints[i];
        const float floats[] = {p->s, p->t, p->curvature, p->v, p->a, p->clearance};
        put_double(&to, p->x);
        put_double(&to, p->y);
        put_double(&to, p->theta);
        for (size_t k = 0; k < 6; k++) {
            put_float(&to, floats[k]);
        }
        put(&to, (uint16_t)p->flags, 2);
        put(&to, (uint32_t)p->goal_id, 4);
    }
    return to.n;
}

static void test_a_path_is_the_bytes_written_by_hand(void) {
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        size_t size = encoded(AISLE_MSG_PATH, seed == 1 ? FILL_FULL_OUTER : FILL_RANDOM, seed);
        TEST_ASSERT_EQUAL_size_t(path_by_hand(&msg.path), size);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(again, bytes, size);
    }
}

static void test_parallel_arrays_follow_their_counts(void) { // diag_t: five arrays of one count, two of the other
    size_t size = encoded(AISLE_MSG_DIAG, FILL_RANDOM, 3);
    const aisle_diag_msg *diag = &msg.diag;
    TEST_ASSERT_EQUAL_size_t(8U + 40U + 2U + 17U * (size_t)diag->num_timers + 2U + 10U * (size_t)diag->num_counters,
                             size);
    pen to = {again, 0};
    for (int i = 0; i < diag->num_counters; i++) {
        put(&to, (uint64_t)diag->counter[i], 8);
    }
    TEST_ASSERT_EQUAL_HEX8_ARRAY(again, bytes + size - to.n, to.n);
}

// As printed by lcm-gen; a change here is a change of the contract with every program on the bus.
static void test_fingerprints_are_those_of_lcm_gen(void) {
    static const struct {
        aisle_msg_type type;
        const char *name;
        uint64_t fingerprint;
    } known[] = {{AISLE_MSG_ARM_GOAL, "arm_goal_t", UINT64_C(0xb52afe327d0d2635)},
                 {AISLE_MSG_ARM_PATH, "arm_path_t", UINT64_C(0x398bd4fc20c831ea)},
                 {AISLE_MSG_ARM_WAYPOINT, "arm_waypoint_t", UINT64_C(0xd60da6b1e7676804)},
                 {AISLE_MSG_COMMAND, "command_t", UINT64_C(0x4e464bf8443eee26)},
                 {AISLE_MSG_DIAG, "diag_t", UINT64_C(0xab3904c85fa7b785)},
                 {AISLE_MSG_GOAL, "goal_t", UINT64_C(0x5f68570f974f9623)},
                 {AISLE_MSG_GOAL_LIST, "goal_list_t", UINT64_C(0x258bdf6d90ee3349)},
                 {AISLE_MSG_GRID_CHUNK, "grid_chunk_t", UINT64_C(0x29c727b898475251)},
                 {AISLE_MSG_LAYOUT, "layout_t", UINT64_C(0x72532c02602c694a)},
                 {AISLE_MSG_LAYOUT_PATCH, "layout_patch_t", UINT64_C(0x08cbad71e97b1c5b)},
                 {AISLE_MSG_OBSTACLE, "obstacle_t", UINT64_C(0x0f9c85dce07a15c5)},
                 {AISLE_MSG_OBSTACLES, "obstacles_t", UINT64_C(0xf3cd1af5926dc80c)},
                 {AISLE_MSG_OPTIONS, "options_t", UINT64_C(0x78d2e056a46d4bc5)},
                 {AISLE_MSG_PATH, "path_t", UINT64_C(0x6680d2e9a2c03d0f)},
                 {AISLE_MSG_POLYGON, "polygon_t", UINT64_C(0x576696dfec3e3b32)},
                 {AISLE_MSG_POSE, "pose_t", UINT64_C(0x0245212614d11321)},
                 {AISLE_MSG_QUERY, "query_t", UINT64_C(0x190e7f943f3010ad)},
                 {AISLE_MSG_STATUS, "status_t", UINT64_C(0x4b9d04252468ba09)},
                 {AISLE_MSG_VEHICLE, "vehicle_t", UINT64_C(0xfc763c31c1124a66)},
                 {AISLE_MSG_WAYPOINT, "waypoint_t", UINT64_C(0x8da9d4f95c83f200)}};
    TEST_ASSERT_EQUAL_size_t(AISLE_MSG_COUNT, sizeof known / sizeof known[0]);
    for (size_t i = 0; i < AISLE_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL_STRING(known[i].name, aisle_msg_name(known[i].type));
        TEST_ASSERT_EQUAL_HEX64_MESSAGE(known[i].fingerprint, aisle_msg_fingerprint(known[i].type), known[i].name);
    }
}

static void test_every_message_comes_back_as_it_went(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            for (uint64_t seed = 1; seed <= SEEDS; seed++) {
                size_t size = encoded(type, shape, seed), expected = 0;
                size_t n = fill_list(type, &msg, scalars, &expected);
                TEST_ASSERT_EQUAL_size_t(expected, size);
                fault = (aisle_msg_fault){AISLE_MSG_FAULT_TRAILING, "?", 1};
                TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(type, bytes, size, &back, &fault));
                TEST_ASSERT_EQUAL_INT(AISLE_MSG_FAULT_NONE, fault.kind);
                TEST_ASSERT_EQUAL_STRING("", fault.field);
                for (size_t i = 0; i < n; i++) {
                    TEST_ASSERT_EQUAL_INT(0, memcmp((uint8_t *)&msg + scalars[i].offset,
                                                    (uint8_t *)&back + scalars[i].offset,
                                                    fill_width(scalars[i].field->kind)));
                }
                TEST_ASSERT_TRUE(holds_its_word(type, bytes, size));
            }
        }
    }
}

static void test_entries_behind_a_count_are_neither_read_nor_written(void) {
    size_t size = 0, second = 0;
    fill_message(AISLE_MSG_GOAL_LIST, &msg, FILL_FULL_OUTER, 5);
    msg.goal_list.num_goals = 2;
    msg.goal_list.goals[2].x = (double)NAN;
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_GOAL_LIST, &msg, bytes, ROOM, &size));
    memset(&back, 0xA5, sizeof back);
    memset(&keep, 0xA5, sizeof keep);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(AISLE_MSG_GOAL_LIST, bytes, size, &back, NULL));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&keep.goal_list.goals[2], &back.goal_list.goals[2], sizeof(aisle_goal_msg) * 62));
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_GOAL_LIST, &back, again, ROOM, &second));
    TEST_ASSERT_EQUAL_size_t(size, second);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, again, size);
}

static void test_bytes_may_lie_at_any_address(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (size_t shift = 1; shift < 8; shift++) {
            size_t size = encoded(type, FILL_FULL_OUTER, shift), second = 0;
            TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(type, &msg, again + shift, ROOM - shift, &second));
            TEST_ASSERT_EQUAL_size_t(size, second);
            TEST_ASSERT_EQUAL_INT(0, memcmp(bytes, again + shift, size));
            TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(type, again + shift, size, &back, NULL));
        }
    }
}

// ---- refusals

static void test_every_truncation_is_refused(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            size_t size = encoded(type, shape, 1), step = 1 + size / 3000;
            uint8_t *tight = malloc(size); // a reader that runs over the end meets the sanitizer
            TEST_ASSERT_NOT_NULL(tight);
            for (size_t n = 0; n < size; n += (n < 1000 || size - n < 300) ? 1 : step) {
                memcpy(tight + size - n, bytes, n);
                TEST_ASSERT_EQUAL_INT(AISLE_ERR_DATA, aisle_msg_check(type, tight + size - n, n, &fault));
                TEST_ASSERT_EQUAL_INT(AISLE_MSG_FAULT_TRUNCATED, fault.kind);
            }
            refused(type, bytes, size - 1, AISLE_MSG_FAULT_TRUNCATED);
            free(tight);
        }
    }
}

static void test_of_a_message_cut_off_the_first_fault_is_told(void) {
    enum { X = 24, Y = 32, THETA = 40 }; // of pose_t: fields of one kind in a row
    (void)encoded(AISLE_MSG_POSE, FILL_FULL_OUTER, 1);
    refused(AISLE_MSG_POSE, bytes, Y + 4, AISLE_MSG_FAULT_TRUNCATED);
    TEST_ASSERT_EQUAL_STRING("y", fault.field);
    refused(AISLE_MSG_POSE, bytes, THETA, AISLE_MSG_FAULT_TRUNCATED);
    TEST_ASSERT_EQUAL_STRING("theta", fault.field);
    memset(bytes + Y, 0xFF, 8); // not a number
    refused(AISLE_MSG_POSE, bytes, Y + 4, AISLE_MSG_FAULT_TRUNCATED);
    TEST_ASSERT_EQUAL_STRING("y", fault.field);
    refused(AISLE_MSG_POSE, bytes, THETA + 4, AISLE_MSG_FAULT_NOT_FINITE);
    TEST_ASSERT_EQUAL_STRING("y", fault.field);
}

static void test_bytes_left_over_are_refused_and_counted(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_RANDOM, 7);
        for (size_t more = 1; more <= 20 && size + more <= AISLE_MSG_DATAGRAM_MAX; more++) {
            refused(type, bytes, size + more, AISLE_MSG_FAULT_TRAILING);
            TEST_ASSERT_EQUAL_INT64(more, fault.value);
        }
    }
}

static void test_a_size_no_datagram_has_is_refused_before_a_byte_is_read(void) {
    static const size_t sizes[] = {AISLE_MSG_DATAGRAM_MAX + 1, 65536, INT32_MAX, 4294967285U, SIZE_MAX / 2, SIZE_MAX};
    uint8_t *one = malloc(1);
    TEST_ASSERT_NOT_NULL(one);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        refused(AISLE_MSG_PATH, one, sizes[i], AISLE_MSG_FAULT_OVERSIZE);
        TEST_ASSERT_EQUAL_INT(AISLE_STATUS_LIMIT, aisle_msg_fault_cause(&fault));
        TEST_ASSERT_EQUAL_INT64(sizes[i] < INT32_MAX ? sizes[i] : INT32_MAX, fault.value);
    }
    free(one);
}

static void test_another_fingerprint_is_refused(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_RANDOM, 2);
        for (uint32_t other = 0; other < AISLE_MSG_COUNT; other++) {
            if (other != type) {
                refused(other, bytes, size, AISLE_MSG_FAULT_FINGERPRINT);
            }
        }
        for (int bit = 0; bit < 64; bit++) {
            bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
            refused(type, bytes, size, AISLE_MSG_FAULT_FINGERPRINT);
            bytes[bit / 8] ^= (uint8_t)(1U << (bit % 8));
        }
    }
}

static void refuse_count(aisle_msg_type type, const scalar *count, size_t size, int64_t value) {
    uint8_t held[4];
    pen to = {bytes + count->at, 0};
    size_t width = fill_width(count->field->kind);
    memcpy(held, to.at, width);
    put(&to, (uint64_t)value, (int)width);
    refused(type, bytes, size, value < 0 ? AISLE_MSG_FAULT_NEGATIVE_COUNT : AISLE_MSG_FAULT_OVER_BOUND);
    TEST_ASSERT_EQUAL_STRING(count->field->name, fault.field);
    TEST_ASSERT_EQUAL_INT64(value, fault.value);
    TEST_ASSERT_EQUAL_INT(value < 0 ? AISLE_STATUS_MALFORMED : AISLE_STATUS_LIMIT, aisle_msg_fault_cause(&fault));
    memcpy(bytes + count->at, held, width);

    size_t unchanged = 77;
    memcpy(&keep, &msg, sizeof keep);
    fill_set_count((uint8_t *)&keep + count->offset, count->field->kind, value);
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_DATA, aisle_msg_encode(type, &keep, again, ROOM, &unchanged));
    TEST_ASSERT_EQUAL_size_t(77, unchanged);
}

static void test_every_count_out_of_range_is_refused_by_name_both_ways(void) {
    unsigned counts = 0;
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_FULL_OUTER, 1);
        size_t n = fill_list(type, &msg, scalars, &size);
        for (size_t i = 0; i < n; i++) {
            const aisle_wire_field *field = scalars[i].field;
            if (field->slot == AISLE_WIRE_NO_SLOT || (i > 200 && i + 200 < n)) {
                continue;
            }
            int64_t most = field->kind == AISLE_WIRE_INT8    ? INT8_MAX
                           : field->kind == AISLE_WIRE_INT16 ? INT16_MAX
                                                             : INT32_MAX;
            refuse_count(type, &scalars[i], size, -1);
            refuse_count(type, &scalars[i], size, field->bound + 1);
            refuse_count(type, &scalars[i], size, -most - 1);
            refuse_count(type, &scalars[i], size, most);
            counts++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(50, counts);
}

static void test_bounds_are_the_constants_of_the_message_files(void) {
    static const struct {
        aisle_msg_type type;
        const char *count;
        int bound;
    } known[] = {{AISLE_MSG_LAYOUT, "num_polygons", 828},      {AISLE_MSG_POLYGON, "num_vertices", 16},
                 {AISLE_MSG_LAYOUT_PATCH, "num_removed", 256}, {AISLE_MSG_LAYOUT_PATCH, "num_polygons", 256},
                 {AISLE_MSG_GRID_CHUNK, "num_bytes", 60000},   {AISLE_MSG_OBSTACLES, "num_obstacles", 256},
                 {AISLE_MSG_OBSTACLE, "num_vertices", 8},      {AISLE_MSG_PATH, "num_waypoints", 1024},
                 {AISLE_MSG_ARM_PATH, "num_waypoints", 512},   {AISLE_MSG_GOAL_LIST, "num_goals", 64},
                 {AISLE_MSG_QUERY, "num_goals", 64},           {AISLE_MSG_VEHICLE, "num_vertices", 16},
                 {AISLE_MSG_VEHICLE, "num_links", 3},          {AISLE_MSG_DIAG, "num_timers", 16},
                 {AISLE_MSG_DIAG, "num_counters", 64}};
    unsigned found = 0;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const aisle_wire_type *type = &aisle_wire_types[known[i].type];
        for (uint32_t k = 0; k < type->num_fields; k++) {
            if (strcmp(type->fields[k].name, known[i].count) == 0) {
                TEST_ASSERT_EQUAL_INT(known[i].bound, type->fields[k].bound);
                found++;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(sizeof known / sizeof known[0], found);
}

static void refuse_float(aisle_msg_type type, const scalar *number, size_t size, uint64_t bits) {
    size_t width = fill_width(number->field->kind), unchanged = 77;
    uint32_t low = (uint32_t)bits;
    uint8_t held[8];
    pen to = {bytes + number->at, 0};
    memcpy(held, to.at, width);
    put(&to, bits, (int)width);
    refused(type, bytes, size, AISLE_MSG_FAULT_NOT_FINITE);
    TEST_ASSERT_EQUAL_STRING(number->field->name, fault.field);
    TEST_ASSERT_EQUAL_INT(AISLE_STATUS_MALFORMED, aisle_msg_fault_cause(&fault));
    memcpy(bytes + number->at, held, width);

    uint8_t *member = (uint8_t *)&msg + number->offset;
    memcpy(held, member, width);
    memcpy(member, width == 4 ? (void *)&low : (void *)&bits, width);
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_DATA, aisle_msg_encode(type, &msg, again, ROOM, &unchanged));
    TEST_ASSERT_EQUAL_size_t(77, unchanged);
    memcpy(member, held, width);
}

static void test_nan_and_infinity_are_refused_in_every_number_both_ways(void) {
    static const uint64_t doubles[] = {UINT64_C(0x7FF0000000000000), UINT64_C(0xFFF0000000000000),
                                       UINT64_C(0x7FF8000000000000), UINT64_C(0x7FF0000000000001),
                                       UINT64_C(0xFFFFFFFFFFFFFFFF)};
    static const uint64_t floats[] = {0x7F800000U, 0xFF800000U, 0x7FC00000U, 0x7F800001U, 0xFFFFFFFFU};
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_FULL_OUTER, 4);
        size_t n = fill_list(type, &msg, scalars, &size);
        for (size_t i = 0; i < n; i++) {
            bool is_double = scalars[i].field->kind == AISLE_WIRE_DOUBLE;
            if ((!is_double && scalars[i].field->kind != AISLE_WIRE_FLOAT) || (i > 120 && i + 60 < n)) {
                continue;
            }
            for (size_t k = 0; k < 5; k++) {
                refuse_float(type, &scalars[i], size, is_double ? doubles[k] : floats[k]);
            }
        }
    }
}

static void test_the_largest_finite_and_the_smallest_numbers_pass(void) {
    static const double edge[] = {0x1.fffffffffffffp+1023, -0x1.fffffffffffffp+1023, 0x1p-1074, -0.0};
    static const float edge_f[] = {0x1.fffffep+127F, -0x1.fffffep+127F, 0x1p-149F, -0.0F};
    size_t size = 0;
    fill_message(AISLE_MSG_POSE, &msg, FILL_EMPTY, 1);
    for (size_t i = 0; i < 4; i++) {
        msg.pose.x = edge[i];
        msg.pose.cov[5] = edge_f[i];
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_POSE, &msg, bytes, ROOM, &size));
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(AISLE_MSG_POSE, bytes, size, &back, NULL));
        TEST_ASSERT_EQUAL_INT(0, memcmp(&edge[i], &back.pose.x, sizeof edge[i]));
        TEST_ASSERT_EQUAL_INT(0, memcmp(&edge_f[i], &back.pose.cov[5], sizeof edge_f[i]));
    }
}

static void test_a_boolean_is_0_or_1_both_ways(void) {
    size_t at = 0, size = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_POSE, "localized", &at));
    for (unsigned value = 0; value < 256; value++) {
        size_t valid = encoded(AISLE_MSG_POSE, FILL_RANDOM, 9);
        bytes[at] = (uint8_t)value;
        msg.pose.localized = (int8_t)(value < 128 ? (int)value : (int)value - 256);
        if (value < 2) {
            TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(AISLE_MSG_POSE, bytes, valid, &back, &fault));
            TEST_ASSERT_EQUAL_INT(value, back.pose.localized);
            TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_POSE, &msg, again, ROOM, &size));
        } else {
            refused(AISLE_MSG_POSE, bytes, valid, AISLE_MSG_FAULT_BAD_BOOLEAN);
            TEST_ASSERT_EQUAL_STRING("localized", fault.field);
            TEST_ASSERT_EQUAL_INT64(msg.pose.localized, fault.value);
            TEST_ASSERT_EQUAL_INT(AISLE_STATUS_MALFORMED, aisle_msg_fault_cause(&fault));
            TEST_ASSERT_EQUAL_INT(AISLE_ERR_DATA, aisle_msg_encode(AISLE_MSG_POSE, &msg, again, ROOM, &size));
        }
    }
}

static void test_flipped_bits_are_refused_or_kept(void) {
    uint64_t state = 20240611;
    unsigned accepted = 0, tries = 0;
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint64_t seed = 1; seed <= SEEDS; seed++) {
            size_t size = encoded(type, seed % 2 ? FILL_EMPTY : FILL_FULL_OUTER, seed);
            for (int i = 0; i < 100; i++, tries++) {
                size_t at = 8 + (size_t)(fill_random(&state) % (size - 8));
                bytes[at] ^= (uint8_t)(1U << (fill_random(&state) % 8));
                TEST_ASSERT_TRUE_MESSAGE(holds_its_word(type, bytes, size), aisle_msg_name(type));
                accepted += aisle_msg_check(type, bytes, size, NULL) == AISLE_OK;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(tries / 20, accepted);
    TEST_ASSERT_LESS_THAN_UINT(tries, accepted);
}

static void test_noise_behind_a_fingerprint_is_refused_or_kept(void) {
    uint64_t state = 7;
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (int i = 0; i < 400; i++) {
            pen to = {bytes, 0};
            size_t size = 8 + (size_t)(fill_random(&state) % 300);
            put(&to, aisle_msg_fingerprint(type), 8);
            while (to.n < size) {
                put(&to, fill_random(&state) & 7U, 1);
            }
            TEST_ASSERT_TRUE(holds_its_word(type, bytes, size));
        }
    }
}

// What kills or bloats lcm-gen's decoders: short messages that promise gigabytes or less than nothing.
static void test_short_messages_that_promise_much_are_refused(void) {
    static const int32_t promises[] = {-1, INT32_MAX, 1 << 28, 0x20000001, INT32_MIN, 0x7fffffff / 8 + 1};
    size_t size = encoded(AISLE_MSG_GRID_CHUNK, FILL_EMPTY, 1), at = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_GRID_CHUNK, "num_bytes", &at));
    TEST_ASSERT_EQUAL_size_t(size, at + 4);
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; i++) {
        pen to = {bytes + at, 0};
        put(&to, (uint32_t)promises[i], 4);
        refused(AISLE_MSG_GRID_CHUNK, bytes, size,
                promises[i] < 0 ? AISLE_MSG_FAULT_NEGATIVE_COUNT : AISLE_MSG_FAULT_OVER_BOUND);
        TEST_ASSERT_EQUAL_INT64(promises[i], fault.value);
    }
    size = encoded(AISLE_MSG_LAYOUT, FILL_EMPTY, 1); // within the bound, but nothing follows
    bytes[size - 2] = 828 >> 8;
    bytes[size - 1] = 828 & 0xFF;
    refused(AISLE_MSG_LAYOUT, bytes, size, AISLE_MSG_FAULT_TRUNCATED);
    TEST_ASSERT_EQUAL_STRING("id", fault.field);
}

static void test_missing_arguments_are_refused(void) {
    size_t size = encoded(AISLE_MSG_POSE, FILL_EMPTY, 1), n = 77;
    const aisle_msg_type none = AISLE_MSG_COUNT;
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_decode(none, bytes, size, &back, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_decode(AISLE_MSG_POSE, NULL, size, &back, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_decode(AISLE_MSG_POSE, bytes, size, NULL, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_check(none, bytes, size, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_check(AISLE_MSG_POSE, NULL, size, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode(none, &msg, bytes, ROOM, &n));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode(AISLE_MSG_POSE, NULL, bytes, ROOM, &n));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode(AISLE_MSG_POSE, &msg, NULL, ROOM, &n));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode(AISLE_MSG_POSE, &msg, bytes, ROOM, NULL));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode_body(none, &msg, bytes, ROOM, &n));
    TEST_ASSERT_EQUAL_INT(AISLE_ERR_ARG, aisle_msg_encode_body(AISLE_MSG_POSE, &msg, NULL, ROOM, &n));
    TEST_ASSERT_EQUAL_size_t(77, n);
    TEST_ASSERT_EQUAL_STRING("?", aisle_msg_name(none));
    TEST_ASSERT_EQUAL_size_t(0, aisle_msg_max_size(none));
    TEST_ASSERT_EQUAL_size_t(0, aisle_msg_struct_size(none));
    TEST_ASSERT_EQUAL_UINT64(0, aisle_msg_fingerprint(none));
    TEST_ASSERT_FALSE(aisle_msg_field_offset(none, "utime", &n));
    TEST_ASSERT_FALSE(aisle_msg_field_offset(AISLE_MSG_POSE, NULL, &n));
    TEST_ASSERT_FALSE(aisle_msg_field_offset(AISLE_MSG_POSE, "utime", NULL));
}

static void test_only_limits_have_the_cause_limit(void) {
    for (uint32_t kind = AISLE_MSG_FAULT_NONE; kind <= AISLE_MSG_FAULT_BAD_BOOLEAN; kind++) {
        bool limit = kind == AISLE_MSG_FAULT_OVER_BOUND || kind == AISLE_MSG_FAULT_OVERSIZE;
        int cause = kind == AISLE_MSG_FAULT_NONE ? 0 : limit ? AISLE_STATUS_LIMIT : AISLE_STATUS_MALFORMED;
        fault = (aisle_msg_fault){kind, "", 0};
        TEST_ASSERT_EQUAL_INT(cause, aisle_msg_fault_cause(&fault));
    }
}

// ---- room

static void test_encoding_needs_its_size_and_writes_no_byte_more(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_RANDOM, 11), second = 77;
        for (size_t room = 0; room < size; room += 1 + size / 500) {
            memset(again, 0xC3, ROOM);
            TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, aisle_msg_encode(type, &msg, again, room, &second));
            TEST_ASSERT_EQUAL_size_t(77, second);
            TEST_ASSERT_EACH_EQUAL_HEX8(0xC3, again + room, 16);
        }
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, aisle_msg_encode(type, &msg, again, size - 1, &second));
        memset(again, 0xC3, ROOM);
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(type, &msg, again, size, &second));
        TEST_ASSERT_EQUAL_INT(0, memcmp(bytes, again, size));
        TEST_ASSERT_EACH_EQUAL_HEX8(0xC3, again + size, 16);
    }
}

static void test_more_than_a_datagram_is_refused_however_large_the_buffer(void) {
    size_t size = 0;
    int16_t fit = 0;
    fill_message(AISLE_MSG_LAYOUT, &msg, FILL_FULL_INNER, 1);
    for (int i = 0; i < 828; i++) {
        msg.layout.polygons[i] = msg.layout.polygons[0]; // 16 vertices, 271 bytes
    }
    for (int16_t n = 1; n <= 828; n++) {
        msg.layout.num_polygons = n;
        aisle_status status = aisle_msg_encode(AISLE_MSG_LAYOUT, &msg, bytes, ROOM, &size);
        fit = status == AISLE_OK ? n : fit;
        TEST_ASSERT_EQUAL_INT(8 + 68 + n * 271 <= 65000 ? AISLE_OK : AISLE_ERR_CAPACITY, status);
    }
    TEST_ASSERT_EQUAL_INT(239, fit);
}

static void test_a_buffer_of_max_size_is_never_too_small(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t most = aisle_msg_max_size(type), size = 0;
        TEST_ASSERT_TRUE(most <= AISLE_MSG_DATAGRAM_MAX);
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            fill_message(type, &msg, shape, 6);
            TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(type, &msg, bytes, most, &size));
        }
        bool layouts = type == AISLE_MSG_LAYOUT || type == AISLE_MSG_LAYOUT_PATCH;
        TEST_ASSERT_TRUE(layouts ? most == AISLE_MSG_DATAGRAM_MAX : size == most);
    }
}

static void test_the_tables_know_the_least_and_the_most_a_body_takes(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        TEST_ASSERT_EQUAL_size_t(8U + aisle_wire_types[type].body_min, encoded(type, FILL_EMPTY, 3));
        if (8U + aisle_wire_types[type].body_max <= AISLE_MSG_DATAGRAM_MAX) {
            TEST_ASSERT_EQUAL_size_t(8U + aisle_wire_types[type].body_max, encoded(type, FILL_FULL_INNER, 3));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(68 + 828 * 271, aisle_wire_types[AISLE_MSG_LAYOUT].body_max);
}

static void test_a_body_is_the_message_without_its_fingerprint(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        size_t size = encoded(type, FILL_RANDOM, 13), body = 0;
        TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode_body(type, &msg, again, size - 8, &body));
        TEST_ASSERT_EQUAL_size_t(size - 8, body);
        TEST_ASSERT_EQUAL_INT(0, memcmp(bytes + 8, again, body));
        TEST_ASSERT_EQUAL_INT(AISLE_ERR_CAPACITY, aisle_msg_encode_body(type, &msg, again, size - 9, &body));
    }
}

static void test_a_body_is_what_its_holder_carries(void) {
    size_t size = encoded(AISLE_MSG_LAYOUT, FILL_FULL_OUTER, 21), at = 8 + 68;
    for (int i = 0; i < msg.layout.num_polygons; i++) {
        size_t body = 0;
        TEST_ASSERT_EQUAL_INT(AISLE_OK,
                              aisle_msg_encode_body(AISLE_MSG_POLYGON, &msg.layout.polygons[i], again, ROOM, &body));
        TEST_ASSERT_EQUAL_INT(0, memcmp(bytes + at, again, body));
        at += body;
    }
    TEST_ASSERT_EQUAL_size_t(size, at);
}

// ---- places of members

static void test_members_before_the_first_array_have_an_offset(void) {
    size_t at = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "utime", &at));
    TEST_ASSERT_EQUAL_size_t(8, at);
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "valid_until_utime", &at));
    TEST_ASSERT_EQUAL_size_t(8 + 2 * 8 + 7 * 4 + 3 * 8, at);
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "waypoints", &at));
    TEST_ASSERT_EQUAL_size_t(8 + 133, at);
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_GOAL_LIST, "num_goals", &at)); // behind nested options
    TEST_ASSERT_EQUAL_size_t(8 + 21 + 25, at);
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_POSE, "localized", &at)); // behind a fixed array
    TEST_ASSERT_EQUAL_size_t(8 + 76, at);
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_VEHICLE, "footprint", &at));
    at = 77;
    TEST_ASSERT_FALSE(aisle_msg_field_offset(AISLE_MSG_VEHICLE, "footprint_radius", &at));
    TEST_ASSERT_FALSE(aisle_msg_field_offset(AISLE_MSG_PATH, "no_such_member", &at));
    TEST_ASSERT_FALSE(aisle_msg_field_offset(AISLE_MSG_GOAL_LIST, "planner", &at)); // of options_t
    TEST_ASSERT_EQUAL_size_t(77, at);
}

static void test_a_lease_is_renewed_in_the_encoded_bytes(void) {
    size_t utime = 0, until = 0, size = encoded(AISLE_MSG_PATH, FILL_RANDOM, 17), second = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "utime", &utime));
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "valid_until_utime", &until));
    msg.path.utime = INT64_C(0x0102030405060708);
    msg.path.valid_until_utime = -2;
    aisle_msg_put_int64(bytes + utime, msg.path.utime);
    aisle_msg_put_int64(bytes + until, msg.path.valid_until_utime);
    msg.path.work_units = -123456789;
    size_t units = 0;
    TEST_ASSERT_TRUE(aisle_msg_field_offset(AISLE_MSG_PATH, "work_units", &units));
    aisle_msg_put_int32(bytes + units, msg.path.work_units);
    TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(AISLE_MSG_PATH, &msg, again, ROOM, &second));
    TEST_ASSERT_EQUAL_size_t(size, second);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(again, bytes, size);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_polygon_is_the_bytes_written_by_hand);
    RUN_TEST(test_a_path_is_the_bytes_written_by_hand);
    RUN_TEST(test_parallel_arrays_follow_their_counts);
    RUN_TEST(test_fingerprints_are_those_of_lcm_gen);
    RUN_TEST(test_every_message_comes_back_as_it_went);
    RUN_TEST(test_entries_behind_a_count_are_neither_read_nor_written);
    RUN_TEST(test_bytes_may_lie_at_any_address);
    RUN_TEST(test_every_truncation_is_refused);
    RUN_TEST(test_of_a_message_cut_off_the_first_fault_is_told);
    RUN_TEST(test_bytes_left_over_are_refused_and_counted);
    RUN_TEST(test_a_size_no_datagram_has_is_refused_before_a_byte_is_read);
    RUN_TEST(test_another_fingerprint_is_refused);
    RUN_TEST(test_every_count_out_of_range_is_refused_by_name_both_ways);
    RUN_TEST(test_bounds_are_the_constants_of_the_message_files);
    RUN_TEST(test_nan_and_infinity_are_refused_in_every_number_both_ways);
    RUN_TEST(test_the_largest_finite_and_the_smallest_numbers_pass);
    RUN_TEST(test_a_boolean_is_0_or_1_both_ways);
    RUN_TEST(test_flipped_bits_are_refused_or_kept);
    RUN_TEST(test_noise_behind_a_fingerprint_is_refused_or_kept);
    RUN_TEST(test_short_messages_that_promise_much_are_refused);
    RUN_TEST(test_missing_arguments_are_refused);
    RUN_TEST(test_only_limits_have_the_cause_limit);
    RUN_TEST(test_encoding_needs_its_size_and_writes_no_byte_more);
    RUN_TEST(test_more_than_a_datagram_is_refused_however_large_the_buffer);
    RUN_TEST(test_a_buffer_of_max_size_is_never_too_small);
    RUN_TEST(test_the_tables_know_the_least_and_the_most_a_body_takes);
    RUN_TEST(test_a_body_is_the_message_without_its_fingerprint);
    RUN_TEST(test_a_body_is_what_its_holder_carries);
    RUN_TEST(test_members_before_the_first_array_have_an_offset);
    RUN_TEST(test_a_lease_is_renewed_in_the_encoded_bytes);
    return UNITY_END();
}
