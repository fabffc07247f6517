#include "plan/manoeuvre_parts.h"

#include "base/angle.h"
#include "base/check.h"

#include <math.h>
#include <string.h>

#define OPEN_IN_CELL 2U  // nodes waiting in one cell, more only if they are cheaper
#define KEY_SCALE 4096.0 // of f, to a heap's key

// ---- cells of configurations

static uint64_t key_of(const aisle_manoeuvre *self, aisle_pose2 pose, int direction) {
    const aisle_lattice *lattice = &self->request.space->grid->lattice;
    double ix = floor((pose.x - lattice->x0) / self->cell);
    double iy = floor((pose.y - lattice->y0) / self->cell);
    double bin = floor(pose.theta * (double)self->headings / (2.0 * AISLE_PI) + 0.5);
    uint64_t heading = (uint64_t)(int64_t)(bin + (double)self->headings) % self->headings; // theta in [-pi, pi]
    uint64_t x = (uint64_t)aisle_clamp(ix, 0.0, 1048575.0), y = (uint64_t)aisle_clamp(iy, 0.0, 1048575.0);
    return (x << 40U | y << 20U | heading << 4U | (uint64_t)(direction + 1) << 1U) + 1U;
}

// The slot of a key, taken if it is new; NULL: the table is full.
static aisle_manoeuvre_slot *slot_of(aisle_manoeuvre *self, uint64_t key) {
    uint32_t mask = self->slot_capacity - 1U;
    uint32_t at = (uint32_t)((key * 0x9E3779B97F4A7C15ULL) >> 40U) & mask;
    while (self->slot[at].key != key) {
        if (self->slot[at].key == 0U) {
            if (self->slots >= self->slot_capacity / 4U * 3U) {
                return NULL;
            }
            self->slots++;
            self->slot[at] = (aisle_manoeuvre_slot){.key = key};
            return &self->slot[at];
        }
        at = (at + 1U) & mask;
    }
    return &self->slot[at];
}

// ---- in

void aisle_manoeuvre_begin_open(aisle_manoeuvre *self, double side) {
    self->side = side;
    self->expanded = 0;
    self->link_next = self->link_fails = 0;
    self->slots = 0;
    self->spare_count = 0;
    memset(self->slot, 0, self->slot_capacity * sizeof(aisle_manoeuvre_slot));
    aisle_heap_forget(&self->open);
}

static uint32_t take_node(aisle_manoeuvre *self) {
    if (self->spare_count > 0U) {
        return self->spare[--self->spare_count];
    }
    return self->node_count < self->node_capacity ? self->node_count++ : AISLE_HEAP_NONE;
}

static void give_back(aisle_manoeuvre *self, uint32_t n) {
    self->spare[self->spare_count++] = n;
}

void aisle_manoeuvre_push(aisle_manoeuvre *self, const aisle_manoeuvre_node *node) {
    double togo = aisle_togo_at(&self->togo, aisle_pose_place(node->pose));
    if (!(togo < (double)INFINITY)) {
        return;
    }
    bool is_step = node->target == AISLE_MANOEUVRE_TARGETS;
    if (is_step) {
        aisle_manoeuvre_slot *slot = slot_of(self, key_of(self, node->pose, node->direction));
        if (slot == NULL || slot->closed || (slot->open >= OPEN_IN_CELL && node->cost >= slot->least)) {
            return;
        }
        slot->least = slot->open == 0U || node->cost < slot->least ? node->cost : slot->least;
        slot->open = slot->open < UINT8_MAX ? (uint8_t)(slot->open + 1U) : UINT8_MAX;
    } else {
        togo = self->target[node->target].togo;
    }
    uint32_t n = take_node(self);
    if (n == AISLE_HEAP_NONE) {
        self->full = true;
        return; // the cheapest are in: it goes on with those
    }
    self->node[n] = *node;
    bool known = !is_step && self->target[node->target].node != AISLE_HEAP_NONE;
    double weight = self->side < 0.0 ? 0.0 : (known ? 1.0 : AISLE_MANOEUVRE_WEIGHT);
    double f = (double)node->cost + weight * togo;
    aisle_status st = aisle_heap_add(&self->open, n, (uint64_t)(f * KEY_SCALE));
    AISLE_ASSERT(st == AISLE_OK);
}

// ---- out

// A link's price is known only when its motion is: is it higher, the link waits for its turn once more.
static bool waits_for_its_price(aisle_manoeuvre *self, uint32_t n, const aisle_move *moves, uint32_t count) {
    aisle_manoeuvre_node node = self->node[n];
    double more = aisle_manoeuvre_surcharge(self, self->node[node.parent].pose, moves, count);
    if (!(more > 0.0)) {
        return false;
    }
    node.cost += (float)more;
    node.is_weighed = true;
    aisle_manoeuvre_push(self, &node);
    return true;
}

// Was its cell or target closed by another one; else it is closed by this one if its motion is free.
static bool closes(aisle_manoeuvre *self, uint32_t n) {
    const aisle_manoeuvre_node *node = &self->node[n];
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    bool *closed = NULL;
    if (node->target == AISLE_MANOEUVRE_TARGETS) {
        aisle_manoeuvre_slot *slot = slot_of(self, key_of(self, node->pose, node->direction));
        if (slot == NULL) {
            return false;
        }
        slot->open = slot->open > 0U ? (uint8_t)(slot->open - 1U) : 0U;
        closed = &slot->closed;
    } else {
        closed = &self->target[node->target].closed;
    }
    if (*closed) {
        return false;
    }
    uint32_t count = node->is_weighed ? 0U : aisle_manoeuvre_moves_to(self, n, moves);
    bool is_free = count == 0U || aisle_manoeuvre_moves_free(self, self->node[node->parent].pose, moves, count);
    if (node->target < AISLE_MANOEUVRE_TARGETS) {
        self->link_fails = is_free ? 0U : self->link_fails + 1U;
        if (is_free && !node->is_weighed && waits_for_its_price(self, n, moves, count)) {
            return false;
        }
    }
    *closed = is_free;
    return is_free;
}

uint32_t aisle_manoeuvre_next(aisle_manoeuvre *self, uint32_t most, bool *ended) {
    uint32_t n = self->expanded < most ? aisle_heap_pop(&self->open) : AISLE_HEAP_NONE;
    *ended = n == AISLE_HEAP_NONE;
    if (!*ended && !closes(self, n)) {
        give_back(self, n);
        return AISLE_HEAP_NONE;
    }
    return n;
}
