// fill.h - valid messages from a seed, and where each scalar of a message lies. For tests, fuzzing and measuring.
//
// Walks the field tables by recursion, in code of its own: the codec's walk is what it is held against.
#ifndef AISLE_TESTS_WIRE_FILL_H
#define AISLE_TESTS_WIRE_FILL_H

#include "aisle/messages.h"
#include "wire/tables.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

// What the counts are: all 0; random; outer ones at their bound and inner ones 3; inner ones at their bound and outer
// ones as large as still fits a datagram.
typedef enum fill_shape { FILL_EMPTY, FILL_RANDOM, FILL_FULL_OUTER, FILL_FULL_INNER, FILL_SHAPES } fill_shape;

typedef union any_msg {
    aisle_arm_goal_msg arm_goal;
    aisle_arm_path_msg arm_path;
    aisle_diag_msg diag;
    aisle_goal_list_msg goal_list;
    aisle_grid_chunk_msg grid_chunk;
    aisle_layout_msg layout;
    aisle_layout_patch_msg layout_patch;
    aisle_obstacles_msg obstacles;
    aisle_path_msg path;
    aisle_polygon_msg polygon;
    aisle_pose_msg pose;
    aisle_query_msg query;
    aisle_status_msg status;
    aisle_vehicle_msg vehicle;
    aisle_waypoint_msg waypoint;
} any_msg;

typedef struct scalar { // one number of an encoded message
    const aisle_wire_field *field;
    size_t at;     // in the bytes, fingerprint counted
    size_t offset; // in the struct
} scalar;

enum { FILL_SCALARS_MAX = 65000 };

static inline uint64_t fill_random(uint64_t *state) { // splitmix64
    uint64_t z = (*state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

static inline size_t fill_width(uint8_t kind) {
    switch (kind) {
    case AISLE_WIRE_INT16:
        return 2;
    case AISLE_WIRE_INT32:
    case AISLE_WIRE_FLOAT:
        return 4;
    case AISLE_WIRE_INT64:
    case AISLE_WIRE_DOUBLE:
        return 8;
    default:
        return 1;
    }
}

static inline int64_t fill_get_count(const uint8_t *member, uint8_t kind) {
    int16_t v16;
    int32_t v32;
    switch (kind) {
    case AISLE_WIRE_INT16:
        memcpy(&v16, member, sizeof v16);
        return v16;
    case AISLE_WIRE_INT32:
        memcpy(&v32, member, sizeof v32);
        return v32;
    default:
        return (int8_t)member[0];
    }
}

static inline void fill_set_count(uint8_t *member, uint8_t kind, int64_t value) {
    int8_t v8 = (int8_t)value;
    int16_t v16 = (int16_t)value;
    int32_t v32 = (int32_t)value;
    const void *from = kind == AISLE_WIRE_INT16 ? (void *)&v16 : kind == AISLE_WIRE_INT32 ? (void *)&v32 : (void *)&v8;
    memcpy(member, from, fill_width(kind));
}

// Any bits that are a valid value: floats of every exponent but that of NaN and infinity.
static inline void fill_scalar(uint8_t *member, uint8_t kind, uint64_t *state) {
    uint64_t bits = fill_random(state);
    uint32_t low = (uint32_t)bits;
    if (kind == AISLE_WIRE_FLOAT && (low & 0x7F800000U) == 0x7F800000U) {
        low &= ~0x00800000U;
    } else if (kind == AISLE_WIRE_DOUBLE && (bits & UINT64_C(0x7FF0000000000000)) == UINT64_C(0x7FF0000000000000)) {
        bits &= ~UINT64_C(0x0010000000000000);
    } else if (kind == AISLE_WIRE_BOOLEAN) {
        low &= 1U;
    }
    uint8_t byte = (uint8_t)low;
    uint16_t half = (uint16_t)low;
    const void *from[9] = {NULL, &byte, &half, NULL, &low, NULL, NULL, NULL, &bits};
    memcpy(member, from[fill_width(kind)], fill_width(kind));
}

// The rows a count may promise in this shape.
static inline int64_t fill_rows(const aisle_wire_type *type, const aisle_wire_field *count, fill_shape shape, int depth,
                                uint64_t *state) {
    uint32_t element = 0; // largest encoded size of what it counts
    for (uint32_t i = 0; i < type->num_fields; i++) {
        const aisle_wire_field *field = &type->fields[i];
        if (field->rows_slot == count->slot) {
            element += field->kind == AISLE_WIRE_STRUCT ? aisle_wire_types[field->nested].body_max
                                                        : field->each * (uint32_t)fill_width(field->kind);
        }
    }
    int64_t fit = 60061 / (int64_t)element; // what is left of a datagram behind other fields
    int64_t most = count->bound < fit ? count->bound : fit;
    switch (shape) {
    case FILL_EMPTY:
        return 0;
    case FILL_RANDOM:
        return (int64_t)(fill_random(state) % (uint64_t)(most + 1));
    case FILL_FULL_OUTER:
        return depth == 0 ? count->bound : 3;
    default:
        return most;
    }
}

static inline void fill_struct(uint32_t number, uint8_t *at, fill_shape shape, int depth, uint64_t *state) {
    const aisle_wire_type *type = &aisle_wire_types[number];
    int64_t rows[AISLE_WIRE_SLOTS_MAX] = {0};
    for (uint32_t i = 0; i < type->num_fields; i++) {
        const aisle_wire_field *field = &type->fields[i];
        uint8_t *member = at + field->offset;
        if (field->slot != AISLE_WIRE_NO_SLOT) {
            rows[field->slot] = fill_rows(type, field, shape, depth, state);
            fill_set_count(member, field->kind, rows[field->slot]);
            continue;
        }
        int64_t n = field->each * (field->rows_slot == AISLE_WIRE_NO_SLOT ? 1 : rows[field->rows_slot]);
        for (int64_t k = 0; k < n; k++) {
            if (field->kind == AISLE_WIRE_STRUCT) {
                fill_struct(field->nested, member + (size_t)k * aisle_wire_types[field->nested].struct_size, shape,
                            depth + 1, state);
            } else {
                fill_scalar(member + (size_t)k * fill_width(field->kind), field->kind, state);
            }
        }
    }
}

// A valid message of `type` in *msg. Bytes no field covers, and entries behind a count, are random.
static inline void fill_message(aisle_msg_type type, any_msg *msg, fill_shape shape, uint64_t seed) {
    uint64_t state = seed * 1000003U + (uint64_t)type * 101U + (uint64_t)shape;
    for (size_t i = 0; i + 8 <= sizeof *msg; i += 8) {
        memcpy((uint8_t *)msg + i, &(uint64_t){fill_random(&state)}, 8);
    }
    fill_struct((uint32_t)type, (uint8_t *)msg, shape, 0, &state);
}

static inline size_t fill_list_struct(uint32_t number, const uint8_t *msg, size_t offset, size_t *at, scalar *out,
                                      size_t used) {
    const aisle_wire_type *type = &aisle_wire_types[number];
    int64_t rows[AISLE_WIRE_SLOTS_MAX] = {0};
    for (uint32_t i = 0; i < type->num_fields; i++) {
        const aisle_wire_field *field = &type->fields[i];
        size_t place = offset + field->offset;
        if (field->slot != AISLE_WIRE_NO_SLOT) {
            rows[field->slot] = fill_get_count(msg + place, field->kind);
        }
        int64_t n = field->each * (field->rows_slot == AISLE_WIRE_NO_SLOT ? 1 : rows[field->rows_slot]);
        for (int64_t k = 0; k < n; k++) {
            if (field->kind == AISLE_WIRE_STRUCT) {
                used = fill_list_struct(field->nested, msg, place, at, out, used);
                place += aisle_wire_types[field->nested].struct_size;
            } else {
                out[used++] = (scalar){field, *at, place};
                place += fill_width(field->kind);
                *at += fill_width(field->kind);
            }
        }
    }
    return used;
}

// Every scalar of *msg in the order of the wire into out[FILL_SCALARS_MAX]; returns how many. *size: encoded length.
static inline size_t fill_list(aisle_msg_type type, const any_msg *msg, scalar *out, size_t *size) {
    *size = 8;
    return fill_list_struct((uint32_t)type, (const uint8_t *)msg, 0, size, out, 0);
}
#endif
