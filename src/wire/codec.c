#include "wire/codec.h"

#include "base/check.h"
#include "wire/tables.h"

#include <string.h>

// ---- the walk: from one run of scalars to the next

typedef struct run { // one field, or several of one kind that follow one another in the struct as on the wire
    const aisle_wire_field *field; // the first
    uint32_t offset;               // in the C struct
    uint32_t count;                // scalars, > 0
    uint32_t width;                // bytes of each, on the wire and in the struct
} run;

typedef struct frame { // an array of structs being walked, or one struct
    const aisle_wire_type *type;
    uint32_t field; // next one
    uint32_t base;  // offset of the present element
    uint32_t left;  // elements, the present one counted
    uint32_t rows[AISLE_WIRE_SLOTS_MAX];
} frame;

#define FLAT_RUNS_MAX 6 // a waypoint has 4

typedef struct flat {        // an array of structs that all have the same few runs: these are found once
    run runs[FLAT_RUNS_MAX]; // as told last
    uint32_t count, at;      // runs; the next one
    uint32_t left;           // elements, the present one counted
    uint32_t size;           // of an element in the C struct
} flat;

typedef struct walk {
    frame stack[AISLE_WIRE_DEPTH_MAX];
    uint32_t depth;
    flat flat; // none is left: the walk is on the stack's top
    run now;   // if it is
} walk;

static void enter(walk *self, uint32_t type, uint32_t base, uint32_t elements) {
    AISLE_ASSERT(self->depth < AISLE_WIRE_DEPTH_MAX && type < AISLE_MSG_COUNT);
    frame *top = &self->stack[self->depth++];
    top->type = &aisle_wire_types[type];
    top->field = 0;
    top->base = base;
    top->left = elements;
}

static void leave_element(walk *self) {
    frame *top = &self->stack[self->depth - 1];
    top->field = 0;
    top->base += top->type->struct_size;
    if (--top->left == 0) {
        self->depth--;
    }
}

static uint32_t elements_of(const frame *top, const aisle_wire_field *field) {
    if (field->rows_slot == AISLE_WIRE_NO_SLOT) {
        return field->each;
    }
    AISLE_ASSERT(top->rows[field->rows_slot] <= (uint32_t)field->bound);
    return field->each * top->rows[field->rows_slot];
}

static uint32_t width_of(uint8_t kind) {
    static const uint8_t widths[] = {1, 2, 4, 8, 1, 1, 4, 8}; // in the order of aisle_wire_kind
    AISLE_ASSERT(kind < sizeof widths);
    return widths[kind];
}

static bool is_plain(const aisle_wire_field *field) {
    return field->slot == AISLE_WIRE_NO_SLOT && field->rows_slot == AISLE_WIRE_NO_SLOT;
}

// Takes in the fields behind that may be moved in one go: in messages of many small structs most of the time.
static void lengthen(frame *top, run *out) {
    const aisle_wire_field *fields = top->type->fields;
    if (!is_plain(out->field)) {
        return;
    }
    uint32_t end = out->offset + out->width * out->count - top->base; // in the present element
    for (; top->field < top->type->num_fields; top->field++) {
        const aisle_wire_field *next = &fields[top->field];
        if (next->kind != out->field->kind || next->offset != end || !is_plain(next)) {
            return;
        }
        out->count += next->each;
        end += out->width * next->each;
    }
}

// Name of the field that scalar `at` of a run belongs to.
static const char *name_at(const run *what, uint32_t at) {
    const aisle_wire_field *field = what->field;
    if (is_plain(field)) {
        for (; at >= field->each; field++) {
            at -= field->each;
        }
    }
    return field->name;
}

// The runs of such an array. False: its struct holds counts, other structs or too many runs.
static bool flatten(flat *self, uint32_t type, uint32_t base, uint32_t elements) {
    frame element = {.type = &aisle_wire_types[type], .base = base};
    self->size = element.type->struct_size;
    self->left = 0;
    self->at = 0;
    for (self->count = 0; element.field < element.type->num_fields; self->count++) {
        const aisle_wire_field *field = &element.type->fields[element.field++];
        if (self->count == FLAT_RUNS_MAX || field->kind == AISLE_WIRE_STRUCT || !is_plain(field)) {
            return false;
        }
        run *next = &self->runs[self->count];
        *next = (run){field, base + field->offset, field->each, width_of(field->kind)};
        lengthen(&element, next);
        next->offset -= self->size; // it goes on by one element each time
    }
    self->left = self->count > 0 ? elements : 0;
    return self->left > 0;
}

static inline const run *next_flat_run(flat *self) {
    run *next = &self->runs[self->at];
    next->offset += self->size;
    if (++self->at == self->count) {
        self->at = 0;
        self->left--;
    }
    return next;
}

static const run *next_stacked_run(walk *self) {
    while (self->depth > 0) {
        frame *top = &self->stack[self->depth - 1];
        if (top->field == top->type->num_fields) {
            leave_element(self);
            continue;
        }
        const aisle_wire_field *field = &top->type->fields[top->field++];
        uint32_t count = elements_of(top, field);
        if (count == 0) {
            continue;
        }
        if (field->kind != AISLE_WIRE_STRUCT) {
            self->now = (run){field, top->base + field->offset, count, width_of(field->kind)};
            lengthen(top, &self->now);
            return &self->now;
        }
        if (count > 1 && flatten(&self->flat, field->nested, top->base + field->offset, count)) {
            return next_flat_run(&self->flat);
        }
        enter(self, field->nested, top->base + field->offset, count);
    }
    return NULL;
}

// NULL: no more. It stays as it is until the next call. Where a count lies ahead, the caller must have given its value to
// keep_count() before it asks for the next run.
static inline const run *next_run(walk *self) {
    return self->flat.left > 0 ? next_flat_run(&self->flat) : next_stacked_run(self);
}

static void keep_count(walk *self, const aisle_wire_field *field, uint32_t value) {
    AISLE_ASSERT(self->depth > 0 && field->slot < AISLE_WIRE_SLOTS_MAX);
    self->stack[self->depth - 1].rows[field->slot] = value;
}

// ---- bytes

static uint16_t load16(const uint8_t *at) {
    return (uint16_t)((uint32_t)at[0] << 8 | at[1]);
}

static uint32_t load32(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static uint64_t load64(const uint8_t *at) {
    return (uint64_t)load32(at) << 32 | load32(at + 4);
}

static void store16(uint8_t *at, uint16_t value) {
    at[0] = (uint8_t)(value >> 8);
    at[1] = (uint8_t)value;
}

static void store32(uint8_t *at, uint32_t value) {
    at[0] = (uint8_t)(value >> 24);
    at[1] = (uint8_t)(value >> 16);
    at[2] = (uint8_t)(value >> 8);
    at[3] = (uint8_t)value;
}

static void store64(uint8_t *at, uint64_t value) {
    store32(at, (uint32_t)(value >> 32));
    store32(at + 4, (uint32_t)value);
}

// Wire to struct. memcpy: the struct's members are of other types than the unsigned integers moved here.
static void unpack(const uint8_t *from, uint8_t *to, uint32_t width, uint32_t count) {
    switch (width) {
    case 1:
        memcpy(to, from, count);
        break;
    case 2:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(to + 2U * i, &(uint16_t){load16(from + 2U * i)}, 2);
        }
        break;
    case 4:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(to + 4U * i, &(uint32_t){load32(from + 4U * i)}, 4);
        }
        break;
    default:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(to + 8U * i, &(uint64_t){load64(from + 8U * i)}, 8);
        }
        break;
    }
}

// Struct to wire: the same exchange of bytes the other way.
static void pack(const uint8_t *from, uint8_t *to, uint32_t width, uint32_t count) {
    uint16_t v16;
    uint32_t v32;
    uint64_t v64;
    switch (width) {
    case 1:
        memcpy(to, from, count);
        break;
    case 2:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(&v16, from + 2U * i, 2);
            store16(to + 2U * i, v16);
        }
        break;
    case 4:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(&v32, from + 4U * i, 4);
            store32(to + 4U * i, v32);
        }
        break;
    default:
        for (uint32_t i = 0; i < count; i++) {
            memcpy(&v64, from + 8U * i, 8);
            store64(to + 8U * i, v64);
        }
        break;
    }
}

// ---- checks, on the wire's bytes in both directions

static bool blame(aisle_msg_fault *fault, aisle_msg_fault_kind kind, const char *field, int64_t value) {
    *fault = (aisle_msg_fault){kind, field, value};
    return false;
}

// NaN and infinity are the values whose exponent bits are all set. Place of the first of them, or count.
static uint32_t first_not_finite32(const uint8_t *at, uint32_t count) {
    uint32_t i = 0;
    while (i < count && (load32(at + 4U * i) & 0x7F800000U) != 0x7F800000U) {
        i++;
    }
    return i;
}

static uint32_t first_not_finite64(const uint8_t *at, uint32_t count) {
    uint32_t i = 0;
    while (i < count && (load32(at + 8U * i) & 0x7FF00000U) != 0x7FF00000U) {
        i++;
    }
    return i;
}

static int64_t count_at(const uint8_t *at, uint32_t width) {
    int8_t v8;
    int16_t v16;
    int32_t v32;
    switch (width) {
    case 1:
        unpack(at, (uint8_t *)&v8, 1, 1);
        return v8;
    case 2:
        unpack(at, (uint8_t *)&v16, 2, 1);
        return v16;
    default:
        AISLE_ASSERT(width == 4);
        unpack(at, (uint8_t *)&v32, 4, 1);
        return v32;
    }
}

static bool check_booleans(const uint8_t *at, const run *what, aisle_msg_fault *fault) {
    for (uint32_t i = 0; i < what->count; i++) {
        if (at[i] > 1) {
            return blame(fault, AISLE_MSG_FAULT_BAD_BOOLEAN, name_at(what, i), count_at(at + i, 1));
        }
    }
    return true;
}

static bool check_count(walk *at, const uint8_t *bytes, const run *what, aisle_msg_fault *fault) {
    int64_t value = count_at(bytes, what->width);
    if (value < 0) {
        return blame(fault, AISLE_MSG_FAULT_NEGATIVE_COUNT, what->field->name, value);
    }
    if (value > what->field->bound) {
        return blame(fault, AISLE_MSG_FAULT_OVER_BOUND, what->field->name, value);
    }
    keep_count(at, what->field, (uint32_t)value);
    return true;
}

static inline bool check_run(walk *at, const uint8_t *bytes, const run *what, aisle_msg_fault *fault) {
    uint32_t finite = what->count;
    if (what->field->kind == AISLE_WIRE_FLOAT) {
        finite = first_not_finite32(bytes, what->count);
    } else if (what->field->kind == AISLE_WIRE_DOUBLE) {
        finite = first_not_finite64(bytes, what->count);
    } else if (what->field->kind == AISLE_WIRE_BOOLEAN) {
        return check_booleans(bytes, what, fault);
    } else if (what->field->slot != AISLE_WIRE_NO_SLOT) {
        return check_count(at, bytes, what, fault);
    }
    return finite == what->count || blame(fault, AISLE_MSG_FAULT_NOT_FINITE, name_at(what, finite), 0);
}

// ---- decoding

static bool is_type(aisle_msg_type type) {
    return (uint32_t)type < AISLE_MSG_COUNT;
}

// Only `left` bytes of a run are there. The fields that are whole are looked at first: the first fault is the one told.
static bool blame_truncated(walk *at, const uint8_t *bytes, size_t left, const run *what, aisle_msg_fault *fault) {
    run whole = *what;
    whole.count = 0;
    if (is_plain(what->field)) {
        for (const aisle_wire_field *field = what->field; whole.count + field->each <= left / what->width; field++) {
            whole.count += field->each;
        }
        if (!check_run(at, bytes, &whole, fault)) {
            return false;
        }
    }
    return blame(fault, AISLE_MSG_FAULT_TRUNCATED, name_at(what, whole.count), 0);
}

static bool check_body(aisle_msg_type type, const uint8_t *bytes, size_t size, aisle_msg_fault *fault) {
    walk at = {.depth = 0};
    const run *now;
    size_t done = 0;
    for (enter(&at, type, 0, 1); (now = next_run(&at)) != NULL; done += (size_t)now->width * now->count) {
        if (size - done < (size_t)now->width * now->count) {
            return blame_truncated(&at, bytes + done, size - done, now, fault);
        }
        if (!check_run(&at, bytes + done, now, fault)) {
            return false;
        }
    }
    return done == size || blame(fault, AISLE_MSG_FAULT_TRAILING, "", (int64_t)(size - done));
}

static bool check_message(aisle_msg_type type, const uint8_t *bytes, size_t size, aisle_msg_fault *fault) {
    if (size > AISLE_MSG_DATAGRAM_MAX) {
        return blame(fault, AISLE_MSG_FAULT_OVERSIZE, "", size < INT32_MAX ? (int64_t)size : INT32_MAX);
    }
    if (size < AISLE_MSG_FINGERPRINT_SIZE) {
        return blame(fault, AISLE_MSG_FAULT_TRUNCATED, "", 0);
    }
    if (load64(bytes) != aisle_wire_types[type].fingerprint) {
        return blame(fault, AISLE_MSG_FAULT_FINGERPRINT, "", 0);
    }
    return check_body(type, bytes + AISLE_MSG_FINGERPRINT_SIZE, size - AISLE_MSG_FINGERPRINT_SIZE, fault);
}

// For a body that check_body() has passed.
static void unpack_body(aisle_msg_type type, const uint8_t *bytes, uint8_t *msg) {
    walk at = {.depth = 0};
    const run *now;
    for (enter(&at, type, 0, 1); (now = next_run(&at)) != NULL; bytes += (size_t)now->width * now->count) {
        AISLE_ASSERT(now->offset + (size_t)now->width * now->count <= aisle_wire_types[type].struct_size);
        unpack(bytes, msg + now->offset, now->width, now->count);
        if (now->field->slot != AISLE_WIRE_NO_SLOT) {
            keep_count(&at, now->field, (uint32_t)count_at(bytes, now->width));
        }
    }
}

aisle_status aisle_msg_check(aisle_msg_type type, const void *bytes, size_t size, aisle_msg_fault *fault) {
    aisle_msg_fault found = {AISLE_MSG_FAULT_NONE, "", 0};
    if (!is_type(type) || bytes == NULL) {
        return AISLE_ERR_ARG;
    }
    bool valid = check_message(type, bytes, size, &found);
    if (fault != NULL) {
        *fault = found;
    }
    return valid ? AISLE_OK : AISLE_ERR_DATA;
}

aisle_status aisle_msg_decode(aisle_msg_type type, const void *bytes, size_t size, void *msg, aisle_msg_fault *fault) {
    if (msg == NULL) {
        return AISLE_ERR_ARG;
    }
    aisle_status status = aisle_msg_check(type, bytes, size, fault);
    if (status == AISLE_OK) {
        unpack_body(type, (const uint8_t *)bytes + AISLE_MSG_FINGERPRINT_SIZE, msg);
    }
    return status;
}

int16_t aisle_msg_fault_cause(const aisle_msg_fault *fault) {
    switch (fault->kind) {
    case AISLE_MSG_FAULT_NONE:
        return 0;
    case AISLE_MSG_FAULT_OVER_BOUND:
    case AISLE_MSG_FAULT_OVERSIZE:
        return AISLE_STATUS_LIMIT;
    default:
        return AISLE_STATUS_MALFORMED;
    }
}

// ---- encoding

// Each run is packed first and then checked as the wire's bytes: one set of rules for what goes out and what comes in.
aisle_status aisle_msg_encode_body(aisle_msg_type type, const void *msg, void *out, size_t capacity, size_t *size) {
    if (!is_type(type) || msg == NULL || out == NULL || size == NULL) {
        return AISLE_ERR_ARG;
    }
    walk at = {.depth = 0};
    const run *now;
    aisle_msg_fault fault;
    size_t done = 0;
    for (enter(&at, type, 0, 1); (now = next_run(&at)) != NULL; done += (size_t)now->width * now->count) {
        uint8_t *to = (uint8_t *)out + done;
        if (capacity - done < (size_t)now->width * now->count) {
            return AISLE_ERR_CAPACITY;
        }
        pack((const uint8_t *)msg + now->offset, to, now->width, now->count);
        if (!check_run(&at, to, now, &fault)) {
            return AISLE_ERR_DATA;
        }
    }
    *size = done;
    return AISLE_OK;
}

aisle_status aisle_msg_encode(aisle_msg_type type, const void *msg, void *out, size_t capacity, size_t *size) {
    if (!is_type(type) || msg == NULL || out == NULL || size == NULL) {
        return AISLE_ERR_ARG;
    }
    size_t room = capacity < AISLE_MSG_DATAGRAM_MAX ? capacity : AISLE_MSG_DATAGRAM_MAX;
    if (room < AISLE_MSG_FINGERPRINT_SIZE) {
        return AISLE_ERR_CAPACITY;
    }
    store64(out, aisle_wire_types[type].fingerprint);
    size_t body = 0;
    aisle_status status = aisle_msg_encode_body(type, msg, (uint8_t *)out + AISLE_MSG_FINGERPRINT_SIZE,
                                                room - AISLE_MSG_FINGERPRINT_SIZE, &body);
    if (status == AISLE_OK) {
        *size = AISLE_MSG_FINGERPRINT_SIZE + body;
    }
    return status;
}

// ---- facts

// Encoded bytes of a member whose length never varies; 0 if it may.
static uint32_t fixed_size(const aisle_wire_field *field) {
    if (field->rows_slot != AISLE_WIRE_NO_SLOT) {
        return 0;
    }
    if (field->kind != AISLE_WIRE_STRUCT) {
        return field->each * width_of(field->kind);
    }
    const aisle_wire_type *nested = &aisle_wire_types[field->nested];
    return nested->body_min == nested->body_max ? field->each * nested->body_min : 0;
}

bool aisle_msg_field_offset(aisle_msg_type type, const char *name, size_t *offset) {
    if (!is_type(type) || name == NULL || offset == NULL) {
        return false;
    }
    const aisle_wire_type *table = &aisle_wire_types[type];
    size_t at = AISLE_MSG_FINGERPRINT_SIZE;
    for (uint32_t i = 0; i < table->num_fields; i++) {
        if (strcmp(table->fields[i].name, name) == 0) {
            *offset = at;
            return true;
        }
        uint32_t size = fixed_size(&table->fields[i]);
        if (size == 0) {
            return false;
        }
        at += size;
    }
    return false;
}

void aisle_msg_put_int64(void *at, int64_t value) {
    store64(at, (uint64_t)value);
}

void aisle_msg_put_int32(void *at, int32_t value) {
    store32(at, (uint32_t)value);
}

void aisle_msg_put_float(void *at, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    store32(at, bits);
}

const char *aisle_msg_name(aisle_msg_type type) {
    return is_type(type) ? aisle_wire_types[type].name : "?";
}

size_t aisle_msg_max_size(aisle_msg_type type) {
    if (!is_type(type)) {
        return 0;
    }
    size_t most = AISLE_MSG_FINGERPRINT_SIZE + aisle_wire_types[type].body_max;
    return most < AISLE_MSG_DATAGRAM_MAX ? most : AISLE_MSG_DATAGRAM_MAX;
}

size_t aisle_msg_struct_size(aisle_msg_type type) {
    return is_type(type) ? aisle_wire_types[type].struct_size : 0;
}

uint64_t aisle_msg_fingerprint(aisle_msg_type type) {
    return is_type(type) ? aisle_wire_types[type].fingerprint : 0;
}
