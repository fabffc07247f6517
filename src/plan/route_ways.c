#include "plan/route_stages.h"

#include "base/check.h"
#include "plan/zones.h"

#include <math.h>

#define SHORT_SLACK 2e-4 // m, what a disc's exact way keeps beyond the margin, for the proof: nobody searches about it
#define BRED_SLACK 6e-4  // m, likewise: the sweeps that judge what is bred of it keep AISLE_SPACE_SLACK
#define RISK_STEP 1e-4   // risks nearer to each other than this are alike
#define LENGTH_SPAN 1048576.0 // m, no path is so long

// What each objective tries, in order. The same candidates for fastest and least energy, so that neither can be beaten
// by the other's answer, nor by the safest or the shortest one.
static const aisle_way shortest[] = {{AISLE_WAY_SHORT, AISLE_OPTIONS_SHORTEST}};
static const aisle_way safest[] = {{AISLE_WAY_SHORT, AISLE_OPTIONS_SHORTEST}, {AISLE_WAY_CLEAR, AISLE_OPTIONS_SAFEST}};
// The tangent search knows no tolls: where zones ask some, the grid's search has its turn, too.
static const aisle_way shortest_tolled[] = {{AISLE_WAY_SHORT, AISLE_OPTIONS_SHORTEST},
                                            {AISLE_WAY_GRID, AISLE_OPTIONS_SHORTEST}};
static const aisle_way safest_tolled[] = {{AISLE_WAY_SHORT, AISLE_OPTIONS_SHORTEST},
                                          {AISLE_WAY_CLEAR, AISLE_OPTIONS_SAFEST},
                                          {AISLE_WAY_GRID, AISLE_OPTIONS_SAFEST}};
static const aisle_way quickest[] = {{AISLE_WAY_SHORT, AISLE_OPTIONS_SHORTEST},
                                     {AISLE_WAY_CLEAR, AISLE_OPTIONS_SAFEST},
                                     {AISLE_WAY_GRID, AISLE_OPTIONS_FASTEST},
                                     {AISLE_WAY_GRID, AISLE_OPTIONS_LEAST_ENERGY}};
static const aisle_way papers = {AISLE_WAY_PAPER, AISLE_OPTIONS_SHORTEST};
static const aisle_way ga_papers = {AISLE_WAY_GA_PAPER, AISLE_OPTIONS_SHORTEST};
static const aisle_way local = {AISLE_WAY_LOCAL, AISLE_OPTIONS_SHORTEST};
static const aisle_way repaired[] = {{AISLE_WAY_REPAIR, AISLE_OPTIONS_SAFEST},
                                     {AISLE_WAY_REPAIR, AISLE_OPTIONS_SHORTEST},
                                     {AISLE_WAY_REPAIR, AISLE_OPTIONS_FASTEST},
                                     {AISLE_WAY_REPAIR, AISLE_OPTIONS_LEAST_ENERGY}};
static const aisle_way sampled[] = {{AISLE_WAY_SAMPLE, AISLE_OPTIONS_SAFEST},
                                    {AISLE_WAY_SAMPLE, AISLE_OPTIONS_SHORTEST},
                                    {AISLE_WAY_SAMPLE, AISLE_OPTIONS_FASTEST},
                                    {AISLE_WAY_SAMPLE, AISLE_OPTIONS_LEAST_ENERGY},
                                    {AISLE_WAY_SAMPLE, AISLE_OPTIONS_SHORTEST}}; // PAPER
static const aisle_way by_grid[] = {{AISLE_WAY_GRID, AISLE_OPTIONS_SAFEST},
                                    {AISLE_WAY_GRID, AISLE_OPTIONS_SHORTEST},
                                    {AISLE_WAY_GRID, AISLE_OPTIONS_FASTEST},
                                    {AISLE_WAY_GRID, AISLE_OPTIONS_LEAST_ENERGY}};

// The n-th way of the request; NULL: there are no more.
static const aisle_way *way_of(const aisle_route *self, uint32_t n) {
    int8_t wish = self->request.options.objective;
    if (self->request.options.planner == AISLE_OPTIONS_PSO) { // the swarm by name: on its own objective's seed alone
        const aisle_way *way = wish == AISLE_OPTIONS_PAPER ? &papers : &by_grid[wish];
        return n == 0U ? way : NULL;
    }
    if (self->request.options.planner == AISLE_OPTIONS_GA) {
        const aisle_way *way = wish == AISLE_OPTIONS_PAPER ? &ga_papers : &by_grid[wish];
        return n == 0U ? (wish == AISLE_OPTIONS_SHORTEST ? &shortest[0] : way) : NULL;
    }
    if (self->request.options.planner == AISLE_OPTIONS_PSO_LOCAL) {
        return n == 0U ? &local : NULL;
    }
    if (aisle_route_is_sampling(self)) {
        return n == 0U ? &sampled[wish] : NULL;
    }
    bool tolls = aisle_zones_any_toll(self->layout, wish);
    switch (wish) {
    case AISLE_OPTIONS_SHORTEST:
        if (tolls) {
            return n < sizeof shortest_tolled / sizeof shortest_tolled[0] ? &shortest_tolled[n] : NULL;
        }
        return n < sizeof shortest / sizeof shortest[0] ? &shortest[n] : NULL;
    case AISLE_OPTIONS_SAFEST:
        if (tolls) {
            return n < sizeof safest_tolled / sizeof safest_tolled[0] ? &safest_tolled[n] : NULL;
        }
        if (!aisle_vehicle_is_disc(self->vehicle)) { // whose clear ways are found in fewer places
            return n < sizeof quickest / sizeof quickest[0] ? &quickest[n] : NULL;
        }
        return n < sizeof safest / sizeof safest[0] ? &safest[n] : NULL;
    default:
        return n < sizeof quickest / sizeof quickest[0] ? &quickest[n] : NULL;
    }
}

static void begin_way(aisle_route *self) {
    const aisle_vehicle *vehicle = self->vehicle;
    aisle_options_msg options = self->request.options;
    options.objective = self->way->objective;
    bool known = aisle_objective_of(&options, vehicle, &self->objective);
    AISLE_ASSERT(known);
    self->objective.has_tolls = aisle_zones_any_toll(self->layout, self->objective.kind);
    bool is_short = self->way->kind == AISLE_WAY_SHORT && aisle_vehicle_is_disc(vehicle);
    bool is_bred = self->request.options.planner == AISLE_OPTIONS_GA;
    double keep = vehicle->margin + (is_bred ? BRED_SLACK : (is_short ? SHORT_SLACK : AISLE_SPACE_SLACK));
    bool is_clear = self->way->kind == AISLE_WAY_CLEAR;
    self->room = is_clear ? aisle_max(vehicle->creep_clearance + AISLE_ROUTE_CREEP_SPARE, keep) : keep;
    if (self->way->kind == AISLE_WAY_PAPER) {
        aisle_route_begin_paper(self);
    } else if (self->way->kind == AISLE_WAY_REPAIR) {
        aisle_route_begin_repair_leg(self);
    } else if (self->way->kind == AISLE_WAY_LOCAL) {
        aisle_route_begin_local(self);
    } else if (self->way->kind == AISLE_WAY_SAMPLE) {
        aisle_route_begin_sample(self);
    } else if (self->way->kind == AISLE_WAY_GA_PAPER) {
        aisle_route_begin_ga_paper(self);
    } else {
        aisle_route_begin_legs(self);
    }
}

void aisle_route_begin_ways(aisle_route *self) {
    self->way_index = 0;
    self->way = way_of(self, 0);
    begin_way(self);
}

void aisle_route_begin_repair_way(aisle_route *self) {
    const int8_t wish = self->request.options.objective;
    AISLE_ASSERT(wish >= AISLE_OPTIONS_SAFEST && wish <= AISLE_OPTIONS_LEAST_ENERGY);
    self->way_index = 0;
    self->way = &repaired[wish];
    begin_way(self);
}

// Is there nothing left to gain? A way without risk that is the shortest of all is the safest.
static bool is_best(const aisle_route *self) {
    const aisle_proof *best = aisle_route_answer(self);
    bool by_risk =
        self->request.options.objective == AISLE_OPTIONS_SAFEST && !(self->request.options.risk_weight > 0.0F);
    return by_risk && best != NULL && best->value < LENGTH_SPAN;
}

aisle_status aisle_route_announce(aisle_route *self) {
    if (self->announced || !self->best.ready) {
        return AISLE_BUSY;
    }
    self->announced = true;
    self->best.told = true;
    return AISLE_PARTIAL;
}

aisle_status aisle_route_next_way(aisle_route *self) {
    self->way_index++;
    self->way = is_best(self) ? NULL : way_of(self, self->way_index);
    if (self->way == NULL) {
        self->stage = AISLE_ROUTE_END;
        return AISLE_OK;
    }
    self->stops = false;
    self->is_wide = false;
    self->is_unbred = false;
    begin_way(self);
    return self->way->kind == AISLE_WAY_GRID ? aisle_route_announce(self) : AISLE_BUSY;
}

aisle_status aisle_route_give_way_up(aisle_route *self, int16_t cause, int32_t id, double value, aisle_vec2 place) {
    if (self->cause.cause == 0) { // the first way's reason is the one that is told, if none works out
        (void)aisle_route_refuse_at(self, cause, id, value, place);
    }
    return aisle_route_next_way(self);
}

// Risk first, then length: as one number.
static double safety(const aisle_route *self) {
    const aisle_path_msg *path = self->path;
    double weight = (double)self->request.options.risk_weight;
    double penalty = self->compose.penalty;
    if (weight > 0.0) {
        return (double)path->length * (1.0 + weight * (double)path->risk) + penalty;
    }
    double length = aisle_max((double)path->length, 1e-9);
    double share = penalty / (AISLE_PENALTY_WEIGHT * length); // a metre at value 1 counts as one at the margin
    double steps = floor(((double)path->risk + share) / RISK_STEP + 0.5);
    return steps * LENGTH_SPAN + aisle_min((double)path->length, 0.5 * LENGTH_SPAN);
}

double aisle_route_measure(const aisle_route *self) {
    double length = aisle_max((double)self->path->length, 1e-9);
    double dearer = 1.0 + self->compose.penalty / length;
    switch (self->request.options.objective) {
    case AISLE_OPTIONS_SAFEST:
        return safety(self);
    case AISLE_OPTIONS_FASTEST:
        return (double)self->path->duration * dearer;
    case AISLE_OPTIONS_LEAST_ENERGY:
        return (double)self->path->energy * dearer;
    default:
        return (double)self->path->length + self->compose.penalty;
    }
}

void aisle_route_judge(aisle_route *self, bool by_name) {
    self->spare.value = aisle_route_measure(self);
    self->spare.ready = true;
    self->spare.told = false;
    if (!self->best.ready || by_name || self->spare.value < self->best.value) {
        aisle_proof swap = self->best;
        self->best = self->spare;
        self->spare = swap;
    }
    self->spare.ready = false;
}
