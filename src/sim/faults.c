#include "sim/faults.h"

#include "aisle/messages.h"
#include "sim/noise.h"

#include <stdio.h>
#include <string.h>

static const char *const names[AISLE_SIM_FAULT_COUNT] = {"pose_silent", "unlocalized", "pose_jump", "obstacles_silent",
                                                         "paths_lost",  "push",        "slow",      "hold"};

const char *aisle_sim_fault_name(aisle_sim_fault_kind kind) {
    return names[kind];
}

static void add(aisle_sim_faults *self, aisle_sim_fault_kind kind, double at, double lasts, double amount) {
    self->fault[self->count++] =
        (aisle_sim_fault){.kind = kind, .at = at, .lasts = lasts, .amount = amount, .answered = -1.0, .rested = -1.0};
}

static bool read_one(aisle_sim_faults *self, const char *text, size_t length) {
    char copy[96], name[24];
    double at, lasts, amount = 0.5;
    int end = 0;
    if (length >= sizeof copy || self->count == AISLE_SIM_FAULTS_MAX) {
        return false;
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    bool good =
        (sscanf(copy, "%23[a-z_]:%lf:%lf%n", name, &at, &lasts, &end) == 3 && (size_t)end == length) ||
        (sscanf(copy, "%23[a-z_]:%lf:%lf:%lf%n", name, &at, &lasts, &amount, &end) == 4 && (size_t)end == length);
    if (!good || !(at >= 0.0 && at <= 1e5 && lasts >= 0.0 && lasts <= 1e5 && fabs(amount) <= 100.0)) {
        return false;
    }
    for (int i = 0; i < (int)AISLE_SIM_FAULT_COUNT; i++) {
        if (strcmp(name, names[i]) == 0) {
            add(self, (aisle_sim_fault_kind)i, at, lasts, amount);
            return true;
        }
    }
    return false;
}

bool aisle_sim_faults_read(aisle_sim_faults *self, const char *text) {
    memset(self, 0, sizeof *self);
    while (*text != '\0') {
        size_t length = strcspn(text, ",");
        if (!read_one(self, text, length)) {
            return false;
        }
        text += length + (text[length] == ',' ? 1 : 0);
    }
    return true;
}

void aisle_sim_faults_draw(aisle_sim_faults *self, aisle_rng *rng, uint32_t count, double span) {
    static const aisle_sim_fault_kind kinds[] = {
        AISLE_SIM_POSE_SILENT, AISLE_SIM_UNLOCALIZED, AISLE_SIM_OBSTACLES_SILENT,
        AISLE_SIM_PATHS_LOST,  AISLE_SIM_SLOW,        AISLE_SIM_HOLD};
    for (uint32_t i = 0; i < count && self->count < AISLE_SIM_FAULTS_MAX; i++) {
        aisle_sim_fault_kind kind = kinds[aisle_rng_below(rng, sizeof kinds / sizeof kinds[0])];
        double at = aisle_sim_uniform(rng, 1.0, span);
        double lasts = aisle_sim_uniform(rng, 0.2, 3.0);
        add(self, kind, at, lasts, kind == AISLE_SIM_SLOW ? aisle_sim_uniform(rng, 0.1, 0.9) : 0.0);
    }
}

const aisle_sim_fault *aisle_sim_faults_active(const aisle_sim_faults *self, aisle_sim_fault_kind kind, double now) {
    for (uint32_t i = 0; i < self->count; i++) {
        const aisle_sim_fault *f = &self->fault[i];
        if (f->kind == kind && now >= f->at && now < f->at + f->lasts) {
            return f;
        }
    }
    return NULL;
}

void aisle_sim_faults_note_path(aisle_sim_faults *self, double now, int8_t status, int16_t cause) {
    for (uint32_t i = 0; i < self->count; i++) {
        aisle_sim_fault *f = &self->fault[i];
        if (f->answered < 0.0 && now >= f->at && (status == AISLE_PATH_NONE || status == AISLE_PATH_STOP)) {
            f->answered = now - f->at;
            f->status = status;
            f->cause = cause;
        }
    }
}

void aisle_sim_faults_note_rest(aisle_sim_faults *self, double now) {
    for (uint32_t i = 0; i < self->count; i++) {
        aisle_sim_fault *f = &self->fault[i];
        f->rested = f->rested < 0.0 && now >= f->at ? now - f->at : f->rested;
    }
}
