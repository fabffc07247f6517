// tables.h - the form of the generated field tables. Level 1, private to the codec.
//
// tools/codegen/lcm_codec.py writes aisle_wire_types[] (tables.c) from lcmtypes/*.lcm.
#ifndef AISLE_WIRE_TABLES_H
#define AISLE_WIRE_TABLES_H

#include "aisle/messages.h"

#include <stdint.h>

#define AISLE_WIRE_DEPTH_MAX 2 // levels of structs in a message; tables.c refuses to compile if more are needed
#define AISLE_WIRE_SLOTS_MAX 2 // counts in one struct; likewise
#define AISLE_WIRE_NO_SLOT 0xFF

typedef enum aisle_wire_kind {
    AISLE_WIRE_INT8,
    AISLE_WIRE_INT16,
    AISLE_WIRE_INT32,
    AISLE_WIRE_INT64,
    AISLE_WIRE_BYTE,
    AISLE_WIRE_BOOLEAN,
    AISLE_WIRE_FLOAT,
    AISLE_WIRE_DOUBLE,
    AISLE_WIRE_STRUCT
} aisle_wire_kind;

typedef struct aisle_wire_field {
    const char *name;
    uint32_t offset;   // in the C struct
    uint32_t each;     // elements in a row of a variable array, or in all
    int32_t bound;     // of a count: its largest value; of a variable array: its rows; else 0
    uint8_t kind;      // aisle_wire_kind
    uint8_t nested;    // aisle_msg_type of the elements of a STRUCT
    uint8_t slot;      // of a count: where its value is kept for the arrays behind it; else NO_SLOT
    uint8_t rows_slot; // of a variable array: the slot of its count; else NO_SLOT
} aisle_wire_field;

typedef struct aisle_wire_type {
    const char *name; // as in the .lcm file
    const aisle_wire_field *fields;
    uint64_t fingerprint; // as computed by lcm-gen
    uint32_t struct_size; // bytes of the C struct
    uint32_t body_min;    // encoded bytes without fingerprint: all counts 0
    uint32_t body_max;    // and all counts at their bounds; equal to body_min: no variable arrays
    uint32_t num_fields;
} aisle_wire_type;

extern const aisle_wire_type aisle_wire_types[AISLE_MSG_COUNT];
#endif
