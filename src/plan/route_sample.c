#include "base/angle.h"
#include "base/check.h"
#include "plan/route_stages.h"

#include <math.h>
#include <string.h>

#define SHARE 2U     // half of the budget is the trees', all legs' together; the rest builds and proves
#define HEADINGS 16U // tried at a stop where any will do

bool aisle_route_is_sampling(const aisle_route *self) {
    const int8_t planner = self->request.options.planner;
    return planner >= AISLE_OPTIONS_RRT && planner <= AISLE_OPTIONS_PRM;
}

static bool is_by_roadmap(const aisle_route *self) {
    return self->request.options.planner == AISLE_OPTIONS_PRM;
}

// ---- the ends

// A heading at which the body may stand there: the one given, or where any will do the first free one from a guess on.
static double heading_at(aisle_route *self, aisle_vec2 p, double theta, bool is_free, double guess) {
    const double need = self->vehicle->margin + AISLE_SPACE_SLACK;
    for (uint32_t i = 0; is_free && i < HEADINGS; i++) {
        const double turned = aisle_angle_wrap(guess + 2.0 * AISLE_PI * i / HEADINGS);
        self->spent++;
        if (aisle_space_gap(&self->space, (aisle_pose2){p.x, p.y, turned}, need, NULL) >= need) {
            return turned;
        }
    }
    return is_free ? guess : theta; // not free: then no motion is
}

static void find_ends(aisle_route *self) {
    const aisle_leg *leg = &self->legs[self->leg];
    const aisle_goal_msg *goal = &self->request.goals[self->leg];
    const aisle_vec2 from = aisle_route_place(aisle_route_leg_start(self, self->leg)), to = aisle_route_place(goal);
    const aisle_vehicle_space *configurations = &self->sample.configurations;
    double start_theta = 0.0, goal_theta = 0.0;
    if (configurations->kind == AISLE_VEHICLE_SPACE_POSE) {
        const double course = leg->bound > 0.0 ? aisle_atan2(to.y - from.y, to.x - from.x) : leg->heading;
        start_theta = heading_at(self, from, leg->heading, leg->heading_is_free, course);
        goal_theta = heading_at(self, to, goal->theta, aisle_goal_heading_is_free(goal), course);
    }
    aisle_vehicle_space_of_pose(configurations, (aisle_pose2){from.x, from.y, start_theta}, self->sample.start);
    aisle_vehicle_space_of_pose(configurations, (aisle_pose2){to.x, to.y, goal_theta}, self->sample.goal);
}

// ---- TREE, MAP

aisle_rrt_config aisle_route_tree_config(const aisle_route *self) {
    const aisle_options_msg *options = &self->request.options;
    const int8_t planner = aisle_route_is_sampling(self) ? options->planner : AISLE_OPTIONS_RRT_ADAPTIVE;
    const bool adaptive = planner == AISLE_OPTIONS_RRT_ADAPTIVE || planner == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    const bool star = planner == AISLE_OPTIONS_RRT_STAR || planner == AISLE_OPTIONS_RRT_STAR_ADAPTIVE;
    aisle_rrt_config cfg = aisle_vehicle_space_rrt(&self->sample.configurations, star, adaptive,
                                                   options->objective == AISLE_OPTIONS_PAPER, (double)options->step);
    cfg.seed = (uint64_t)(uint32_t)options->seed + self->leg;
    return cfg;
}

uint32_t aisle_route_share(const aisle_route *self) {
    const uint32_t all = self->budget - self->budget / SHARE;
    const uint32_t legs = (uint32_t)self->request.num_goals - self->leg;
    return self->spent < all ? self->spent + (all - self->spent) / legs : self->spent;
}

static void begin_tree(aisle_route *self) {
    aisle_route_sample *sample = &self->sample;
    aisle_rrt_config cfg = aisle_route_tree_config(self);
    memcpy(cfg.start, sample->start, sizeof cfg.start);
    memcpy(cfg.goal, sample->goal, sizeof cfg.goal);
    const aisle_status st = aisle_rrt_start(&sample->tree, &cfg);
    AISLE_ASSERT(st == AISLE_OK);
    sample->phase = AISLE_ROUTE_SAMPLE_TREE;
}

static void begin_search(aisle_route *self) {
    aisle_route_sample *sample = &self->sample;
    aisle_leg *leg = &self->legs[self->leg];
    const bool has_heading = aisle_route_has_heading(self);
    leg->mode = has_heading ? AISLE_SPACE_ALONG : AISLE_SPACE_FREE_TURN;
    aisle_space_begin(&self->space, self->layout, self->vehicle, leg->mode);
    aisle_vehicle_space_begin(&sample->configurations, &self->space,
                              has_heading ? AISLE_VEHICLE_SPACE_POSE : AISLE_VEHICLE_SPACE_PLACE);
    find_ends(self);
    sample->limit = sample->is_spare ? self->budget - (self->budget - self->spent) / 2U : aisle_route_share(self);
    self->stage = AISLE_ROUTE_SAMPLE;
    if (is_by_roadmap(self)) {
        aisle_route_begin_roadmap(self);
    } else {
        begin_tree(self);
    }
}

void aisle_route_begin_sample_leg(aisle_route *self) {
    (void)aisle_route_take_leg(self);
    aisle_route_begin_zones(self);
    self->sample.is_spare = false;
    begin_search(self);
}

void aisle_route_begin_sample(aisle_route *self) {
    self->leg = 0;
    self->point_count = 0;
    self->piece_count = 0;
    self->sample.copy.is_begun = false;
    aisle_route_begin_sample_leg(self);
}

bool aisle_route_begin_spare(aisle_route *self) {
    if (self->request.options.planner != AISLE_OPTIONS_AUTO || self->legs[self->leg].is_sampled ||
        self->spent >= self->budget) {
        return false;
    }
    self->legs[self->leg].is_sampled = true;
    self->sample.is_spare = true;
    begin_search(self);
    return true;
}

// No way was found. The reason that is known is told; one that sampling alone was asked for gets WHY to look for a proof.
aisle_status aisle_route_no_sampled_way(aisle_route *self) {
    if (self->sample.is_spare) {
        self->legs[self->leg].is_sampled = false;
        self->stage = AISLE_ROUTE_END;
        return AISLE_OK;
    }
    return aisle_route_refuse_unproved(self);
}

// ---- PULL, SHORTEN

static aisle_status too_long(aisle_route *self) {
    if (self->sample.is_spare) {
        return aisle_route_no_sampled_way(self);
    }
    const aisle_vec2 place = aisle_route_place(&self->request.goals[self->leg]);
    return aisle_route_give_way_up(self, AISLE_STATUS_LIMIT, 0, (double)self->sample.path_count, place);
}

static const double *on_path(const aisle_route *self, uint32_t i) {
    const aisle_route_sample *sample = &self->sample;
    return is_by_roadmap(self) ? sample->way + (size_t)i * sample->configurations.cspace.dim
                               : aisle_rrt_at(&sample->tree, sample->path[i]);
}

static aisle_vec2 place_on_path(const aisle_route *self, uint32_t i) {
    const double *q = on_path(self, i);
    return aisle_vec2_of(q[0], q[1]);
}

// The tree's path as moves; its memory is the search's again then.
static bool take_moves(aisle_route *self) {
    const aisle_route_sample *sample = &self->sample;
    const aisle_vehicle_space *configurations = &sample->configurations;
    aisle_move moves[AISLE_REEDS_SHEPP_MOVES];
    const aisle_manoeuvre_request request = {.space = &self->space,
                                             .start = aisle_vehicle_space_pose(configurations, on_path(self, 0))};
    aisle_manoeuvre_begin_way(&self->manoeuvre, &request);
    for (uint32_t i = 1; i < sample->path_count; i++) {
        const double *from = on_path(self, i - 1U), *to = on_path(self, i);
        const uint32_t count = aisle_vehicle_space_moves(configurations, from, to, moves);
        if (!aisle_manoeuvre_add(&self->manoeuvre, moves, count, aisle_vehicle_space_pose(configurations, to))) {
            return false;
        }
    }
    return true;
}

aisle_status aisle_route_take_sampled_way(aisle_route *self) {
    aisle_route_sample *sample = &self->sample;
    if (sample->configurations.kind == AISLE_VEHICLE_SPACE_POSE) {
        sample->phase = AISLE_ROUTE_SAMPLE_SHORTEN;
        return take_moves(self) ? AISLE_BUSY : too_long(self);
    }
    if (AISLE_ROUTE_POINTS - self->point_count < AISLE_SEED_POINTS_MAX) {
        return too_long(self);
    }
    self->points[self->legs[self->leg].first] = place_on_path(self, 0);
    self->legs[self->leg].count = 1;
    sample->at = 1;
    sample->phase = AISLE_ROUTE_SAMPLE_PULL;
    return AISLE_BUSY;
}

static void found(aisle_route *self) {
    self->legs[self->leg].is_sampled = true;
    self->cause = (aisle_refusal){0, 0, 0.0F};
    self->told_count = 0;
    self->named = AISLE_ROUTE_NONE;
}

// The next place of the path is left out if the one after it is seen from the last one kept.
static aisle_status pull(aisle_route *self) {
    aisle_route_sample *sample = &self->sample;
    aisle_leg *leg = &self->legs[self->leg];
    aisle_vec2 *points = self->points + leg->first;
    const bool is_last = sample->at + 1U >= sample->path_count;
    if (is_last || !aisle_space_sweep_free(&self->space, points[leg->count - 1U], place_on_path(self, sample->at + 1U),
                                           &self->spent)) {
        if (leg->count == AISLE_SEED_POINTS_MAX) {
            return too_long(self);
        }
        points[leg->count++] = place_on_path(self, sample->at);
    }
    sample->at++;
    if (is_last) {
        found(self);
        aisle_route_begin_taut(self, leg->count);
    }
    return AISLE_BUSY;
}

static aisle_status shorten(aisle_route *self, uint32_t units) {
    aisle_leg *leg = &self->legs[self->leg];
    if (aisle_manoeuvre_step(&self->manoeuvre, units, &self->spent) == AISLE_BUSY) {
        return AISLE_BUSY;
    }
    leg->piece_first = self->piece_count;
    leg->piece_count =
        aisle_manoeuvre_lay(&self->manoeuvre, self->pieces + leg->piece_first, AISLE_ROUTE_PIECES - self->piece_count);
    if (leg->piece_count == 0U) {
        return too_long(self);
    }
    self->piece_count += leg->piece_count;
    leg->count = 0;
    found(self);
    aisle_route_next_leg(self);
    return AISLE_BUSY;
}

// ---- all together

static aisle_status grow(aisle_route *self, uint32_t units) {
    aisle_route_sample *sample = &self->sample;
    const uint32_t left = sample->limit > self->spent ? sample->limit - self->spent : 0U;
    const aisle_status st =
        left > 0U ? aisle_rrt_step(&sample->tree, units < left ? units : left, &self->spent) : AISLE_BUSY;
    if (st == AISLE_BUSY && self->spent < sample->limit) {
        return AISLE_BUSY;
    }
    const bool reached = aisle_rrt_cost(&sample->tree) < (double)INFINITY;
    self->is_cut = self->is_cut || (st == AISLE_BUSY && reached);
    if (!reached) {
        return aisle_route_no_sampled_way(self);
    }
    sample->path_count = aisle_rrt_path(&sample->tree, sample->path, sample->tree.capacity + 1U);
    self->nodes += (int64_t)sample->tree.near.count;
    return aisle_route_take_sampled_way(self);
}

aisle_status aisle_route_step_sample(aisle_route *self, uint32_t units) {
    switch (self->sample.phase) {
    case AISLE_ROUTE_SAMPLE_TREE:
        return grow(self, units);
    case AISLE_ROUTE_SAMPLE_MAP:
        return aisle_route_step_roadmap(self, units);
    case AISLE_ROUTE_SAMPLE_ASK:
        return aisle_route_step_ask(self, units);
    case AISLE_ROUTE_SAMPLE_PULL:
        return pull(self);
    default:
        return shorten(self, units);
    }
}
