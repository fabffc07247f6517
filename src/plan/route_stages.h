// route_stages.h - what the files of route share with each other and with nobody else. Level 4.
//
// route.c: memory, budget, the order of stages. route_cache.c: RECALL, REPROVE. route_repair.c: REPAIR. route_check.c: CHECK, NEAREST.
// route_order.c: ORDER. route_tangent.c: TANGENT. route_manoeuvre.c: MANOEUVRE. route_seed.c: SEED, TAUT.
// route_zones.c: ONE_WAY. route_why.c: WHY, OPENING. route_proof.c: BUILD, VERIFY, SWARM. route_paper.c: PAPER. route_local.c: LOCAL.
// route_sample.c, route_roadmap.c: SAMPLE. route_ga.c: GA.
// Steps spend about `units`; AISLE_BUSY: go on, AISLE_PARTIAL: the first proof is ready, AISLE_OK: the request has
// ended.
#ifndef AISLE_PLAN_ROUTE_STAGES_H
#define AISLE_PLAN_ROUTE_STAGES_H

#include "plan/route.h"
#include "plan/zones.h"

#define AISLE_ROUTE_ATTEMPTS_CHEAP 2U // at a seed, before the proof of WHY, see route.h

// Where a stop is; where a leg begins.
static inline aisle_vec2 aisle_route_place(const aisle_goal_msg *goal) {
    return aisle_vec2_of(goal->x, goal->y);
}

static inline const aisle_goal_msg *aisle_route_leg_start(const aisle_route *self, uint32_t leg) {
    return leg == 0U ? &self->request.start : &self->request.goals[leg - 1U];
}

// End the request with a cause, with or without its place.
static inline aisle_status aisle_route_refuse(aisle_route *self, int16_t cause, int32_t id, double value) {
    self->cause = (aisle_refusal){cause, id, (float)value};
    self->told_count = 0;
    self->named = AISLE_ROUTE_NONE;
    self->stage = AISLE_ROUTE_END;
    return AISLE_OK;
}

// One more place of a refusal; beyond the last one that fits none is told.
static inline void aisle_route_tell(aisle_route *self, aisle_vec2 place, int32_t id, int16_t flags) {
    if (self->told_count < AISLE_ROUTE_TOLD_MAX) {
        self->told[self->told_count++] =
            (aisle_waypoint_msg){.x = place.x, .y = place.y, .goal_id = id, .flags = flags};
    }
}

static inline aisle_status aisle_route_refuse_at(aisle_route *self, int16_t cause, int32_t id, double value,
                                                 aisle_vec2 place) {
    aisle_status st = aisle_route_refuse(self, cause, id, value);
    aisle_route_tell(self, place, 0, 0);
    return st;
}

// The goal that is not reached, one of the request's; after aisle_route_refuse_at().
static inline void aisle_route_name_goal(aisle_route *self, const aisle_goal_msg *goal) {
    self->told[0].goal_id = goal->id;
    self->named = (uint32_t)(goal - self->request.goals);
}

// Is there an order to be found? Not if no goal, or only one, may come anywhere.
static inline bool aisle_route_is_to_order(const aisle_route *self) {
    const aisle_request *request = &self->request;
    return request->ordering == AISLE_GOAL_LIST_ANY_ORDER && request->kept + 1 < request->num_goals;
}

// route_cache.c
aisle_status aisle_route_recall(aisle_route *self);
aisle_status aisle_route_step_reprove(aisle_route *self, uint32_t units);
// What is remembered is of no use: plans from nothing.
aisle_status aisle_route_plan_anew(aisle_route *self);
// The request has ended: a query's answer is remembered, unless it was.
void aisle_route_remember(aisle_route *self);

// route_repair.c

// Begins REPAIR; false: there is no answer to repair.
bool aisle_route_begin_repair(aisle_route *self, const aisle_cache_question *question);
void aisle_route_begin_repair_leg(aisle_route *self);
aisle_status aisle_route_step_repair(aisle_route *self, uint32_t units);
// It is built and was proved or not: the answer, or all is planned anew.
aisle_status aisle_route_end_repair(aisle_route *self, bool is_proved);

// route_check.c
aisle_status aisle_route_check(aisle_route *self);
// NEAREST: how far an occupied stop has to move; its cause is told already.
aisle_status aisle_route_step_nearest(aisle_route *self, uint32_t units);

// route_ways.c

// Begin the first way; go on to the next, or end the request.
void aisle_route_begin_ways(aisle_route *self);
aisle_status aisle_route_next_way(aisle_route *self);
void aisle_route_begin_repair_way(aisle_route *self);
// What comes next takes long: AISLE_PARTIAL if there is an answer that was not told yet, else AISLE_BUSY.
aisle_status aisle_route_announce(aisle_route *self);
// The way under way has no path; the cause is told if no other has one.
aisle_status aisle_route_give_way_up(aisle_route *self, int16_t cause, int32_t id, double value, aisle_vec2 place);
// What the path just composed is worth by the request's objective: m, s, J, or risk and then m.
double aisle_route_measure(const aisle_route *self);
// The spare one is proved: it becomes the best if it is the first, better, or asked for by name.
void aisle_route_judge(aisle_route *self, bool by_name);

// route_order.c: begins ORDER, or the ways if there is nothing to order.
void aisle_route_begin_order(aisle_route *self);
aisle_status aisle_route_step_order(aisle_route *self, uint32_t units);

// route_tangent.c
void aisle_route_begin_tangent(aisle_route *self);
// A leg on which the grid sees no way though there is one: its shortest way is the seed.
void aisle_route_begin_slit(aisle_route *self);
aisle_status aisle_route_step_tangent(aisle_route *self, uint32_t units);

// route_manoeuvre.c

// Does heading matter to the vehicle at all? Not to a disc that turns on the spot.
bool aisle_route_has_heading(const aisle_route *self);
// The heading with which the leg under way begins, from the start's or the last leg's end.
void aisle_route_take_heading(aisle_route *self);
// Can the body turn at both ends of the leg's polyline as it must; a car: must it not?
bool aisle_route_ends_free(aisle_route *self);
// Keeps the leg's polyline, a way for a disc of `reach` (m) whose corners are rounded by `radius`, as what leads the
// search: the first one and the last one kept.
void aisle_route_keep_guide(aisle_route *self, double radius, double reach);

// For a leg that has a manoeuvre already: one that keeps clear of obstacles where that is cheaper and ends with the same
// heading; the other is kept if there is none. First a way of the disc inside to lead it, then the search.
void aisle_route_begin_eased(aisle_route *self);
void aisle_route_ease_manoeuvre(aisle_route *self);
// Begins the search for a manoeuvre on the leg under way; false: it was searched before, or heading does not matter. In
// the first way alone: what it finds serves the later ones.
bool aisle_route_begin_manoeuvre(aisle_route *self);
aisle_status aisle_route_step_manoeuvre(aisle_route *self, uint32_t units);

// route_seed.c

// Begin the first leg; go on to the next leg or to BUILD.
void aisle_route_begin_legs(aisle_route *self);
void aisle_route_next_leg(aisle_route *self);
// The leg under way, of which nothing is known but the beeline and the heading it begins with.
aisle_leg *aisle_route_take_leg(aisle_route *self);
// Starts the seed of the leg under way with the first attempt from n on that finds its ends; none does: WHY.
void aisle_route_begin_seed(aisle_route *self, uint32_t n);
// No way was found: the first way of all asks why, others are given up.
void aisle_route_end_attempts(aisle_route *self);
aisle_status aisle_route_step_seed(aisle_route *self, uint32_t units);
// Pulls the leg's polyline of `count` points taut.
void aisle_route_begin_taut(aisle_route *self, uint32_t count);
aisle_status aisle_route_step_taut(aisle_route *self, uint32_t units);

// route_why.c

// Asks why there is no seed for the leg under way; stride: cells, of the searches for width.
void aisle_route_begin_why(aisle_route *self, uint32_t stride);
aisle_status aisle_route_step_why(aisle_route *self, uint32_t units);
// A search that proves nothing found no way: BUDGET, and WHY to look for a proof.
aisle_status aisle_route_refuse_unproved(aisle_route *self);
// OPENING: what would have to go; the cause is told already.
aisle_status aisle_route_step_sides(aisle_route *self, uint32_t units); // SIDES: the same
aisle_status aisle_route_step_opening(aisle_route *self, uint32_t units);

// The polygon at its centre, as one of those whose removal opens the way.
void aisle_route_tell_zone(aisle_route *self, const aisle_zone *zone);

// route_zones.c
// A leg begins: what of its search hangs on zones.
void aisle_route_begin_zones(aisle_route *self);
// Does the leg's seed, laid, obey DIRECTED zones? If not, the first one is remembered.
bool aisle_route_way_obeys(aisle_route *self);
// ONE_WAY: do the zones shut every way? False: not to be asked (again), nothing begun.
bool aisle_route_begin_one_way(aisle_route *self);
aisle_status aisle_route_step_one_way(aisle_route *self, uint32_t units);

// route_paper.c: the paper's own swarm in place of everything before BUILD.
void aisle_route_begin_paper(aisle_route *self);
aisle_status aisle_route_step_paper(aisle_route *self, uint32_t units);

// route_ga.c: the genetic search.

// The paper's form in place of everything before BUILD.
void aisle_route_begin_ga_paper(aisle_route *self);
void aisle_route_begin_ga_paper_leg(aisle_route *self);
// Planner GA: begins to breed the leg under way, whose seed lies in the points. False: not asked for, done, or not possible.
bool aisle_route_begin_ga(aisle_route *self);
aisle_status aisle_route_step_ga(aisle_route *self, uint32_t units);

// route_local.c: the local swarm in place of everything before BUILD.
void aisle_route_begin_local(aisle_route *self);
aisle_status aisle_route_step_local(aisle_route *self, uint32_t units);

// route_sample.c: a sampling planner in place of everything before BUILD.
void aisle_route_begin_sample(aisle_route *self);
void aisle_route_begin_sample_leg(aisle_route *self);
aisle_status aisle_route_step_sample(aisle_route *self, uint32_t units);
// The leg under way has a reason by now for having no way, but no proof: true if sampling is tried before it is told.
bool aisle_route_begin_spare(aisle_route *self);
// The leg's way is in sample.path or sample.way, path_count configurations: on with it. There is none: the reason that is
// known is told, or, where sampling was asked for by name, WHY looks for a proof.
aisle_status aisle_route_take_sampled_way(aisle_route *self);
aisle_status aisle_route_no_sampled_way(aisle_route *self);
// Is it one of those by name?
bool aisle_route_is_sampling(const aisle_route *self);
// The tree of the planner asked for over the configurations begun, but for its ends.
aisle_rrt_config aisle_route_tree_config(const aisle_route *self);
// Work units at which the leg under way ends its search: its even share of the half of the budget that searches have.
uint32_t aisle_route_share(const aisle_route *self);

// route_roadmap.c: what SAMPLE does for PRM. The leg's ends are in sample.start and sample.goal.
void aisle_route_begin_roadmap(aisle_route *self);
aisle_status aisle_route_step_roadmap(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_ask(aisle_route *self, uint32_t units);

// route_proof.c
aisle_compose_request aisle_route_build_request(aisle_route *self);
void aisle_route_begin_build(aisle_route *self);
// The verifier's request for what is in spare.
aisle_verify_request aisle_route_verify_request(const aisle_route *self, double first_theta);
void aisle_route_count_verify(aisle_route *self);
aisle_status aisle_route_step_build(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_verify(aisle_route *self, uint32_t units);
aisle_status aisle_route_step_swarm(aisle_route *self, uint32_t units);
#endif
