#include "plan/zones.h"

#include "base/angle.h"
#include "base/check.h"
#include "robot/curve.h"
#include "robot/profile.h"

#include <math.h>

#define CHORDS_MAX 512.0

bool aisle_zones_any_directed(const aisle_layout *layout) {
    return aisle_layout_has_kind(layout, AISLE_POLYGON_DIRECTED);
}

bool aisle_zones_any_toll(const aisle_layout *layout, int8_t objective) {
    const bool by_time = objective == AISLE_OPTIONS_FASTEST || objective == AISLE_OPTIONS_LEAST_ENERGY;
    return aisle_layout_has_kind(layout, AISLE_POLYGON_PENALTY) ||
           (by_time && aisle_layout_has_kind(layout, AISLE_POLYGON_SPEED_LIMIT));
}

bool aisle_zones_clip(const aisle_convex *outline, double room, aisle_vec2 a, aisle_vec2 b, double *from, double *to) {
    *from = 0.0;
    *to = 1.0;
    for (uint32_t i = 0; i < outline->n; i++) {
        const aisle_vec2 v = outline->v[i];
        const aisle_vec2 edge = aisle_vec2_sub(outline->v[i + 1U < outline->n ? i + 1U : 0U], v);
        const double length = aisle_vec2_length(edge);
        const double grown = room * length;
        const double at_a = aisle_vec2_cross(edge, aisle_vec2_sub(a, v)) + grown; // inside: above 0
        const double at_b = aisle_vec2_cross(edge, aisle_vec2_sub(b, v)) + grown;
        if (at_a <= 0.0 && at_b <= 0.0 && length > 0.0) {
            return false;
        }
        if (at_a < 0.0) {
            *from = aisle_max(*from, at_a / (at_a - at_b));
        } else if (at_b < 0.0) {
            *to = aisle_min(*to, at_a / (at_a - at_b));
        }
    }
    return *from < *to;
}

static aisle_aabb box_about(aisle_vec2 a, aisle_vec2 b, double by) {
    const aisle_aabb box = {{aisle_min(a.x, b.x), aisle_min(a.y, b.y)}, {aisle_max(a.x, b.x), aisle_max(a.y, b.y)}};
    return aisle_aabb_grow(box, by);
}

// ---- one way

// Is moving along `way` (any length) against the zone, the direction being `slack` (rad) uncertain?
static bool is_against(const aisle_zone *zone, aisle_vec2 way, double slack) {
    double sine, cosine;
    aisle_sincos((double)zone->direction, &sine, &cosine);
    const double along = way.x * cosine + way.y * sine;
    return along < aisle_min(slack - AISLE_ZONES_AGAINST, 1.0) * aisle_vec2_length(way); // sin x is nearly x
}

static bool allow(const aisle_layout *layout, aisle_vec2 a, aisle_vec2 b, double room, double slack, int32_t *id) {
    const aisle_vec2 way = aisle_vec2_sub(b, a);
    const aisle_zone *zone;
    double from, to;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_about(a, b, room));
         aisle_layout_walk_next(&walk, &zone);) {
        if (zone->kind != AISLE_POLYGON_DIRECTED || !is_against(zone, way, slack)) {
            continue;
        }
        const aisle_convex outline = aisle_layout_zone_shape(layout, zone);
        if (aisle_zones_clip(&outline, room, a, b, &from, &to)) {
            if (id != NULL) {
                *id = zone->id;
            }
            return false;
        }
    }
    return true;
}

bool aisle_zones_allow(const aisle_layout *layout, aisle_vec2 a, aisle_vec2 b, double room, int32_t *id) {
    return !aisle_zones_any_directed(layout) || allow(layout, a, b, room, 0.0, id);
}

static aisle_vec2 origin_at(const aisle_waypoint_msg *from, const aisle_waypoint_msg *to, double f) {
    if (f <= 0.0) {
        return aisle_vec2_of(from->x, from->y);
    }
    if (f >= 1.0) {
        return aisle_vec2_of(to->x, to->y);
    }
    const aisle_pose2 pose = aisle_piece_at(from, to, f);
    return aisle_vec2_of(pose.x, pose.y);
}

// Into how many chords a piece is cut.
static double chords_of(const aisle_waypoint_msg *to, double length) {
    const bool straight = fabs((double)to->curvature) <= 0.0;
    return straight ? 1.0 : aisle_min(floor(length / AISLE_ZONES_CHORD) + 1.0, CHORDS_MAX);
}

bool aisle_zones_allow_piece(const aisle_layout *layout, const aisle_waypoint_msg *from, const aisle_waypoint_msg *to,
                             int32_t *id) {
    const double length = aisle_piece_length(from, to);
    if (!aisle_zones_any_directed(layout) || length <= 0.0) {
        return true;
    }
    const double chords = chords_of(to, length);
    const double turn = fabs((double)to->curvature) * length / chords; // of the course, along one
    const double sagitta = turn * length / chords / 8.0;
    bool allowed = true;
    for (double i = 0.0; allowed && i < chords; i += 1.0) {
        const aisle_vec2 a = origin_at(from, to, i / chords);
        const aisle_vec2 b = origin_at(from, to, (i + 1.0) / chords);
        allowed = allow(layout, a, b, sagitta, 0.5 * turn, id);
    }
    return allowed;
}

bool aisle_zones_is_near_directed(const aisle_layout *layout, aisle_vec2 p, double room) {
    const aisle_zone *zone;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_about(p, p, room));
         aisle_layout_walk_next(&walk, &zone);) {
        const aisle_convex outline = aisle_layout_zone_shape(layout, zone);
        double from, to;
        if (zone->kind == AISLE_POLYGON_DIRECTED && aisle_zones_clip(&outline, room, p, p, &from, &to)) {
            return true;
        }
    }
    return false;
}

// ---- tolls

// Of a metre inside; objective NULL: of penalties alone.
static double toll_of(const aisle_objective *objective, const aisle_zone *zone) {
    if (zone->kind == AISLE_POLYGON_PENALTY) {
        return AISLE_PENALTY_WEIGHT * (double)zone->value;
    }
    if (zone->kind != AISLE_POLYGON_SPEED_LIMIT || objective == NULL || (double)zone->value >= objective->v_max) {
        return 0.0;
    }
    const double slower = aisle_min(objective->v_max / (double)zone->value, AISLE_OBJECTIVE_DENSITY_MAX) - 1.0;
    switch (objective->kind) {
    case AISLE_OPTIONS_FASTEST:
        return slower;
    case AISLE_OPTIONS_LEAST_ENERGY:
        return objective->idle / objective->v_max * slower;
    default:
        return 0.0;
    }
}

static double toll_between(const aisle_layout *layout, const aisle_objective *objective, aisle_vec2 a, aisle_vec2 b) {
    const double length = aisle_vec2_distance(a, b);
    const aisle_zone *zone;
    double sum = 0.0, from, to;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_about(a, b, 0.0));
         aisle_layout_walk_next(&walk, &zone);) {
        const double toll = toll_of(objective, zone);
        const aisle_convex outline = aisle_layout_zone_shape(layout, zone);
        if (toll > 0.0 && aisle_zones_clip(&outline, 0.0, a, b, &from, &to)) {
            sum += toll * (to - from) * length;
        }
    }
    return sum;
}

static double toll_of_piece(const aisle_layout *layout, const aisle_objective *objective,
                            const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    const double length = aisle_piece_length(from, to);
    if (length <= 0.0) {
        return 0.0;
    }
    const double chords = chords_of(to, length);
    double sum = 0.0;
    for (double i = 0.0; i < chords; i += 1.0) {
        sum +=
            toll_between(layout, objective, origin_at(from, to, i / chords), origin_at(from, to, (i + 1.0) / chords));
    }
    return sum;
}

double aisle_zones_toll(const aisle_layout *layout, const aisle_objective *objective, aisle_vec2 a, aisle_vec2 b) {
    return objective->has_tolls ? toll_between(layout, objective, a, b) : 0.0;
}

double aisle_zones_toll_piece(const aisle_layout *layout, const aisle_objective *objective,
                              const aisle_waypoint_msg *from, const aisle_waypoint_msg *to) {
    return objective->has_tolls ? toll_of_piece(layout, objective, from, to) : 0.0;
}

double aisle_zones_penalty_piece(const aisle_layout *layout, const aisle_waypoint_msg *from,
                                 const aisle_waypoint_msg *to) {
    return aisle_layout_has_kind(layout, AISLE_POLYGON_PENALTY) ? toll_of_piece(layout, NULL, from, to) : 0.0;
}

double aisle_zones_toll_at(const aisle_layout *layout, const aisle_objective *objective, aisle_vec2 p) {
    const aisle_zone *zone;
    double sum = 0.0, from, to;
    for (aisle_layout_walk walk = aisle_layout_walk_over(layout, box_about(p, p, 0.0));
         objective->has_tolls && aisle_layout_walk_next(&walk, &zone);) {
        const double toll = toll_of(objective, zone);
        const aisle_convex outline = aisle_layout_zone_shape(layout, zone);
        sum += toll > 0.0 && aisle_zones_clip(&outline, 0.0, p, p, &from, &to) ? toll : 0.0;
    }
    return sum;
}
