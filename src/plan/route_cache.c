#include "plan/route_stages.h"

#include "base/check.h"

#include <string.h>

static aisle_cache_question question_of(const aisle_route *self) {
    const aisle_request *request = &self->request;
    return (aisle_cache_question){.start = &request->start,
                                  .goals = self->asked,
                                  .num_goals = (uint32_t)request->num_goals,
                                  .ordering = request->kept > 0 ? AISLE_GOAL_LIST_ORDERED : request->ordering,
                                  .options = &request->options,
                                  .vehicle = self->vehicle,
                                  .layout = self->layout,
                                  .readonly = !request->is_query};
}

// A cache that was not carved remembers nothing.
static bool has_memory(const aisle_route *self) {
    return !self->forgetful && self->cache.capacity > 0U;
}

aisle_status aisle_route_plan_anew(aisle_route *self) {
    memcpy(self->request.goals, self->asked, sizeof self->asked); // in place of a recalled answer's order
    self->recalled = AISLE_CACHE_NONE;
    self->stage = AISLE_ROUTE_CHECK;
    return AISLE_BUSY;
}

aisle_status aisle_route_recall(aisle_route *self) {
    const aisle_cache_question question = question_of(self);
    aisle_proof *proof = &self->spare;
    if (!has_memory(self) || (self->request.kept > 0 && aisle_route_is_to_order(self))) { // no query asks so
        return aisle_route_plan_anew(self);
    }
    self->spent += 1U;
    aisle_cache_found found;
    self->recalled = aisle_cache_find(&self->cache, &question, proof->bytes, &found);
    if (self->recalled == AISLE_CACHE_NONE) {
        return aisle_route_begin_repair(self, &question) ? AISLE_BUSY : aisle_route_plan_anew(self);
    }
    for (int16_t i = 0; i < self->request.num_goals; i++) {
        self->request.goals[i] = self->asked[found.order[i]];
    }
    proof->size = found.size;
    proof->basis = found.basis;
    aisle_path_msg *head = self->path;
    head->path_revision = self->revision;
    head->cached = 1;
    head->work_units = (int32_t)self->spent;
    aisle_path_rehead(proof->bytes, head, found.basis.waypoints);
    head->cached = 0;
    aisle_verify_request request = aisle_route_verify_request(self, found.theta);
    request.basis = &proof->basis;
    aisle_verify_start(&self->verify, &request, self->decoded);
    self->stage = AISLE_ROUTE_REPROVE;
    return AISLE_BUSY;
}

aisle_status aisle_route_step_reprove(aisle_route *self, uint32_t units) {
    aisle_proof *proof = &self->spare;
    aisle_status st = aisle_verify_step(&self->verify, units, &self->spent, &proof->stamp);
    if (st == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    aisle_route_count_verify(self);
    if (st != AISLE_OK) {
        self->verify_failed++;
        aisle_cache_disprove(&self->cache, self->recalled);
        return aisle_route_plan_anew(self);
    }
    proof->basis = *aisle_verify_basis(&self->verify);
    aisle_cache_confirm(&self->cache, self->recalled, self->request.is_query ? &proof->basis : NULL);
    aisle_proof swap = self->best;
    self->best = self->spare;
    self->spare = swap;
    self->best.ready = true;
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

void aisle_route_remember(aisle_route *self) {
    const aisle_proof *best = aisle_route_answer(self);
    if (best == NULL || !has_memory(self) || !self->request.is_query || self->recalled != AISLE_CACHE_NONE) {
        return;
    }
    const aisle_cache_question question = question_of(self);
    aisle_status st = aisle_msg_decode(AISLE_MSG_PATH, best->bytes, best->size, self->decoded, NULL);
    AISLE_ASSERT(st == AISLE_OK);
    const aisle_cache_answer answer = {.bytes = best->bytes,
                                       .size = best->size,
                                       .path = self->decoded,
                                       .goals = self->request.goals,
                                       .value = best->value,
                                       .worth = self->repair.is_done ? self->repair.worth : best->value,
                                       .basis = best->basis};
    aisle_cache_put(&self->cache, &question, &answer);
}

void aisle_route_layout_changed(aisle_route *self, const aisle_layout *layout) {
    aisle_roadmap_keep_note(&self->keep, layout);
    aisle_cache_change_begin(&self->cache, layout, self->decoded, self->spare.bytes);
}

aisle_status aisle_route_step_change(aisle_route *self, uint32_t units) {
    return aisle_cache_change_step(&self->cache, units);
}
