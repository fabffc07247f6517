#include "sim/drawn.h"

#include "base/angle.h"
#include "base/check.h"

#include <string.h>

#define STOP_ROOM 0.15 // m beyond body and margin at start and goals
#define APART 5.0      // m between stops, at least
#define DRAWS 400

static double draw(aisle_rng *rng, double lo, double hi) {
    return aisle_sim_uniform(rng, lo, hi);
}

// ---- halls

static aisle_polygon_msg *add(aisle_layout_msg *hall) {
    if (hall->num_polygons >= AISLE_SIM_DRAWN_POLYGONS) {
        return NULL;
    }
    aisle_polygon_msg *p = &hall->polygons[hall->num_polygons++];
    memset(p, 0, sizeof *p);
    p->id = hall->num_polygons;
    return p;
}

static void add_box(aisle_layout_msg *hall, double x0, double y0, double x1, double y1) {
    aisle_polygon_msg *p = add(hall);
    if (p != NULL && x1 - x0 > 1e-3 && y1 - y0 > 1e-3) {
        const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
        p->num_vertices = 4;
        memcpy(p->vertices, v, sizeof v);
    } else if (p != NULL) {
        hall->num_polygons--;
    }
}

static void draw_open(aisle_layout_msg *hall, aisle_rng *rng) {
    for (uint32_t i = aisle_rng_below(rng, 6); i > 0; i--) {
        double x = draw(rng, 1.0, hall->x_max - 3.0), y = draw(rng, 1.0, hall->y_max - 3.0);
        double w = draw(rng, 0.4, 2.0);
        add_box(hall, x, y, x + w, y + draw(rng, 0.4, 2.0));
    }
}

// A regular polygon, turned and stretched.
static void add_stone(aisle_layout_msg *hall, aisle_rng *rng) {
    aisle_polygon_msg *p = add(hall);
    double x = draw(rng, 1.0, hall->x_max - 1.0), y = draw(rng, 1.0, hall->y_max - 1.0);
    double a = draw(rng, 0.2, 0.9), b = draw(rng, 0.2, 0.9), turn = draw(rng, 0.0, AISLE_PI), c, s;
    aisle_sincos(turn, &s, &c);
    p->num_vertices = (int16_t)(3 + aisle_rng_below(rng, 5));
    for (int16_t i = 0; i < p->num_vertices; i++) {
        double sine, cosine;
        aisle_sincos(2.0 * AISLE_PI * i / p->num_vertices, &sine, &cosine);
        p->vertices[i][0] = x + c * a * cosine - s * b * sine;
        p->vertices[i][1] = y + s * a * cosine + c * b * sine;
    }
}

static void draw_clutter(aisle_layout_msg *hall, aisle_rng *rng) {
    for (uint32_t i = 6 + aisle_rng_below(rng, 14); i > 0; i--) {
        add_stone(hall, rng);
    }
}

static void draw_racks(aisle_layout_msg *hall, aisle_rng *rng) {
    double aisle = draw(rng, 1.8, 3.2), rack = draw(rng, 0.8, 1.6), gap = draw(rng, 2.0, 3.0);
    for (double y = gap; y + rack + gap < hall->y_max; y += rack + aisle) {
        double middle = draw(rng, 0.35, 0.65) * hall->x_max;
        add_box(hall, gap, y, middle - 1.2, y + rack);
        add_box(hall, middle + 1.2, y, hall->x_max - gap, y + rack);
    }
}

static void draw_rooms(aisle_layout_msg *hall, aisle_rng *rng) {
    double wall = 0.2;
    uint32_t count = 1 + aisle_rng_below(rng, 3);
    for (uint32_t i = 1; i <= count; i++) {
        double x = hall->x_max * i / (count + 1), door = draw(rng, 1.8, 3.0);
        double y = draw(rng, 0.5, hall->y_max - door - 0.5);
        add_box(hall, x, 0.0, x + wall, y);
        add_box(hall, x, y + door, x + wall, hall->y_max);
    }
}

static void draw_hall(aisle_layout_msg *hall, aisle_rng *rng) {
    static void (*const kinds[])(aisle_layout_msg *, aisle_rng *) = {draw_open, draw_clutter, draw_racks, draw_rooms};
    memset(hall, 0, sizeof *hall);
    hall->map_id = hall->map_revision = 1;
    hall->num_parts = 1;
    hall->x_max = draw(rng, 14.0, 24.0);
    hall->y_max = draw(rng, 14.0, 24.0);
    kinds[aisle_rng_below(rng, 4)](hall, rng);
    hall->total_polygons = hall->num_polygons;
    hall->crc32 = (int32_t)aisle_layout_crc32(0, hall);
}

// ---- vehicles

static void give_box(aisle_vehicle_msg *v, double back, double front, double half_width) {
    const double corners[4][2] = {{-back, -half_width}, {front, -half_width}, {front, half_width}, {-back, half_width}};
    v->num_vertices = 4;
    memcpy(v->footprint, corners, sizeof corners);
}

static void draw_vehicle(aisle_vehicle_msg *v, aisle_rng *rng) {
    memset(v, 0, sizeof *v);
    v->vehicle_revision = 1;
    switch (aisle_rng_below(rng, 5)) {
    case 0:
        v->footprint_radius = (float)draw(rng, 0.25, 0.5);
        break;
    case 1:
        give_box(v, 0.5, 0.5, 0.35);
        break;
    case 2:
        give_box(v, 0.9, 0.9, 0.45);
        break;
    case 3: // a forklift
        give_box(v, 0.4, 1.4, 0.4);
        break;
    default:
        give_box(v, 0.3, 0.9, 0.3);
        v->drive = AISLE_VEHICLE_TRICYCLE;
        v->curvature_max = (float)draw(rng, 0.7, 1.5);
    }
    v->v_max = (float)draw(rng, 0.6, 2.0);
    v->a_max = (float)draw(rng, 0.4, 1.5);
    v->d_max = (float)draw(rng, 0.4, 2.0);
    v->reaction_time = (float)draw(rng, 0.2, 0.5);
    v->margin = (float)draw(rng, 0.1, 0.15);
    v->v_reverse_max = (float)draw(rng, 0.2, 0.5);
}

// ---- stops

static bool draw_stop(const aisle_sim_scene *scene, aisle_rng *rng, double room, const aisle_vec2 *before, int count,
                      aisle_vec2 *out) {
    for (int i = 0; i < DRAWS; i++) {
        out->x = draw(rng, scene->x_min, scene->x_max);
        out->y = draw(rng, scene->y_min, scene->y_max);
        double apart = count > 0 ? aisle_vec2_distance(*out, before[count - 1]) : APART;
        if (apart >= APART && aisle_sim_scene_has_room(scene, *out, room)) {
            return true;
        }
    }
    return false;
}

static void draw_goal(aisle_goal_msg *goal, int32_t id, aisle_vec2 at, bool turns, aisle_rng *rng) {
    bool heading = turns && aisle_rng_below(rng, 3) == 0;
    *goal = (aisle_goal_msg){.id = id,
                             .x = at.x,
                             .y = at.y,
                             .theta = draw(rng, -3.0, 3.0),
                             .tolerance_xy = 0.1F,
                             .tolerance_theta = heading ? 0.1F : 4.0F,
                             .dwell = aisle_rng_below(rng, 3) == 0 ? 1.0F : 0.0F};
}

// False: too narrow for this vehicle, draw anew.
static bool draw_stops(aisle_sim_drawn *self, aisle_rng *rng) {
    aisle_sim_scene scene;
    aisle_vehicle vehicle;
    aisle_refusal why;
    aisle_vec2 stop[4];
    memset(&scene, 0, sizeof scene);
    aisle_status status = aisle_vehicle_from_msg(&self->vehicle, &vehicle, &why);
    AISLE_ASSERT(status == AISLE_OK);
    bool good = aisle_sim_scene_take_layout(&scene, &self->layout);
    int count = 2 + (int)aisle_rng_below(rng, 3);
    for (int i = 0; i < count && good; i++) {
        good = draw_stop(&scene, rng, vehicle.outer_radius + vehicle.margin + STOP_ROOM, stop, i, &stop[i]);
    }
    aisle_sim_scene_free(&scene);
    memset(&self->goals, 0, sizeof self->goals);
    self->start =
        (aisle_pose_msg){.map_id = 1, .x = stop[0].x, .y = stop[0].y, .theta = draw(rng, -3.0, 3.0), .localized = 1};
    self->goals.goal_list_id = self->goals.goal_list_revision = self->goals.map_id = 1;
    self->goals.num_goals = (int16_t)(count - 1);
    for (int i = 1; i < count && good; i++) {
        draw_goal(&self->goals.goals[i - 1], i, stop[i], !(vehicle.curvature_max > 0.0), rng);
    }
    return good;
}

static void draw_setup(aisle_sim_setup *setup, uint64_t seed, aisle_sim_kind kind, uint32_t num_movers,
                       double reaction_time, aisle_rng *rng) {
    *setup = aisle_sim_setup_usual(seed);
    setup->num_groups = 1;
    setup->group[0] =
        (aisle_sim_group){.kind = kind, .count = num_movers > 0 ? num_movers : 2 + aisle_rng_below(rng, 7)};
    if (kind == AISLE_SIM_KIND_COUNT) {
        setup->num_groups = (uint32_t)AISLE_SIM_TRACK;
        for (uint32_t i = 0; i < setup->num_groups; i++) {
            setup->group[i] = (aisle_sim_group){.kind = (aisle_sim_kind)i,
                                                .count = num_movers > 0 ? num_movers : aisle_rng_below(rng, 3)};
        }
    }
    setup->num_sources = 1 + (int32_t)aisle_rng_below(rng, 3);
    setup->source.period = draw(rng, 0.05, 0.1);
    setup->source.sigma = draw(rng, 0.0, 0.06);
    setup->source.lost = draw(rng, 0.0, 0.05);
    setup->latency = draw(rng, 0.02, reaction_time - 0.02); // with the control's period just what the vehicle promises
    setup->time_limit = 120.0;
    setup->few_are_good = true;
}

void aisle_sim_draw(aisle_sim_drawn *self, uint64_t seed, aisle_sim_kind kind, uint32_t num_movers) {
    aisle_rng rng = aisle_sim_stream(seed, 64 + (uint64_t)kind);
    do {
        draw_vehicle(&self->vehicle, &rng);
        draw_hall(&self->layout, &rng);
    } while (!draw_stops(self, &rng));
    draw_setup(&self->setup, seed, kind, num_movers, (double)self->vehicle.reaction_time, &rng);
}

void aisle_sim_draw_faults(aisle_sim_drawn *self) {
    aisle_rng rng = aisle_sim_stream(self->setup.seed, 5);
    uint32_t count = 1 + aisle_rng_below(&rng, 4);
    aisle_sim_faults_draw(&self->setup.faults, &rng, count, 30.0);
}

static bool prepare(aisle_sim_episode *episode, aisle_channel channel, const void *message) {
    static uint8_t bytes[AISLE_MSG_DATAGRAM_MAX]; // one thread
    size_t size = 0;
    aisle_status status = aisle_msg_encode(aisle_channel_type(channel), message, bytes, sizeof bytes, &size);
    AISLE_ASSERT(status == AISLE_OK);
    return aisle_sim_episode_prepare(episode, channel, bytes, size);
}

bool aisle_sim_drawn_prepare(const aisle_sim_drawn *self, aisle_sim_episode *episode) {
    return prepare(episode, AISLE_CHANNEL_LAYOUT, &self->layout) &&
           prepare(episode, AISLE_CHANNEL_VEHICLE, &self->vehicle) &&
           prepare(episode, AISLE_CHANNEL_POSE, &self->start) && prepare(episode, AISLE_CHANNEL_GOALS, &self->goals);
}
