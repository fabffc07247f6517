#include "sim/scene.h"

#include <stdlib.h>
#include <string.h>

#define CELLS_MAX 67108864.0
#define RESOLUTION_MIN 1e-3 // m

// ---- from messages

static void forget(aisle_sim_scene *self, int32_t id) {
    for (uint32_t i = 0; i < self->count; i++) {
        if (self->solid[i].id == id) {
            self->solid[i] = self->solid[--self->count];
            return;
        }
    }
}

static bool add(aisle_sim_scene *self, const aisle_polygon_msg *p) {
    if (p->kind != AISLE_POLYGON_OBSTACLE && p->kind != AISLE_POLYGON_KEEPOUT) {
        return true;
    }
    if (self->count == self->capacity) {
        uint32_t more = self->capacity == 0 ? 64 : 2 * self->capacity;
        aisle_sim_solid *grown = realloc(self->solid, more * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        self->solid = grown;
        self->capacity = more;
    }
    aisle_sim_solid *s = &self->solid[self->count++];
    memset(s, 0, sizeof *s);
    s->id = p->id;
    s->outline.n = (uint32_t)p->num_vertices;
    for (uint32_t i = 0; i < s->outline.n; i++) {
        s->outline.v[i] = aisle_vec2_of(p->vertices[i][0], p->vertices[i][1]);
        s->centre = aisle_vec2_add(s->centre, aisle_vec2_scale(s->outline.v[i], 1.0 / (double)s->outline.n));
    }
    for (uint32_t i = 0; i < s->outline.n; i++) {
        s->reach = fmax(s->reach, aisle_vec2_distance(s->centre, s->outline.v[i]));
    }
    return true;
}

bool aisle_sim_scene_take_layout(aisle_sim_scene *self, const aisle_layout_msg *part) {
    if (part->map_id != self->map_id || part->map_revision != self->map_revision) {
        self->count = 0;
        self->has_scan = false;
        self->map_id = part->map_id;
        self->map_revision = part->map_revision;
    }
    self->x_min = part->x_min;
    self->y_min = part->y_min;
    self->x_max = part->x_max;
    self->y_max = part->y_max;
    for (int16_t i = 0; i < part->num_polygons; i++) {
        if (!add(self, &part->polygons[i])) {
            return false;
        }
    }
    return true;
}

bool aisle_sim_scene_take_patch(aisle_sim_scene *self, const aisle_layout_patch_msg *patch) {
    self->map_revision = patch->map_revision;
    for (int16_t i = 0; i < patch->num_removed; i++) {
        forget(self, patch->removed[i]);
    }
    for (int16_t i = 0; i < patch->num_polygons; i++) {
        forget(self, patch->polygons[i].id);
        if (!add(self, &patch->polygons[i])) {
            return false;
        }
    }
    return true;
}

// A lattice that covers the bounds, all of it occupied.
static bool begin_scan(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile) {
    double resolution = floor((double)tile->resolution * 1e6 + 0.5) * 1e-6; // 0.05F is meant as 0.05
    double width = ceil((self->x_max - tile->origin_x) / resolution + 1.0);
    double height = ceil((self->y_max - tile->origin_y) / resolution + 1.0);
    if (!(resolution >= RESOLUTION_MIN) || !(width >= 1.0 && height >= 1.0 && width * height <= CELLS_MAX)) {
        return false;
    }
    free(self->occupied);
    self->occupied = malloc((size_t)width * (size_t)height);
    if (self->occupied == NULL) {
        return false;
    }
    memset(self->occupied, 1, (size_t)width * (size_t)height);
    self->width = (int32_t)width;
    self->height = (int32_t)height;
    self->origin_x = tile->origin_x;
    self->origin_y = tile->origin_y;
    self->resolution = resolution;
    self->has_scan = true;
    return true;
}

static void put_cell(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile, int64_t index, bool occupied) {
    int64_t x = tile->x0 + index % tile->width, y = tile->y0 + index / tile->width;
    if (x >= 0 && y >= 0 && x < self->width && y < self->height) {
        self->occupied[y * self->width + x] = occupied ? 1 : 0;
    }
}

static void put_bits(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile) {
    int64_t stride = (tile->width + 7) / 8;
    for (int64_t i = 0; i < (int64_t)tile->width * tile->height; i++) {
        int64_t x = i % tile->width, at = i / tile->width * stride + x / 8;
        if (at < tile->num_bytes) {
            put_cell(self, tile, i, (tile->data[at] >> (x % 8) & 1U) != 0);
        }
    }
}

// Alternating run lengths, free first, unsigned LEB128.
static void put_runs(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile) {
    int64_t cells = (int64_t)tile->width * tile->height, next = 0;
    bool occupied = false;
    for (int32_t at = 0; at < tile->num_bytes && next < cells; occupied = !occupied) {
        int64_t run = 0;
        for (int shift = 0; at < tile->num_bytes && shift < 56; shift += 7) {
            uint8_t byte = tile->data[at++];
            run |= (int64_t)(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) {
                break;
            }
        }
        for (int64_t end = run < cells - next ? next + run : cells; next < end; next++) {
            put_cell(self, tile, next, occupied);
        }
    }
}

bool aisle_sim_scene_take_tile(aisle_sim_scene *self, const aisle_grid_chunk_msg *tile) {
    if (tile->width <= 0 || tile->height <= 0 || (!self->has_scan && !begin_scan(self, tile))) {
        return false;
    }
    if (tile->encoding == AISLE_GRID_CHUNK_RLE) {
        put_runs(self, tile);
    } else {
        put_bits(self, tile);
    }
    return true;
}

void aisle_sim_scene_free(aisle_sim_scene *self) {
    free(self->solid);
    free(self->occupied);
    memset(self, 0, sizeof *self);
}

// ---- questions

typedef struct extent {
    double x0, y0, x1, y1;
} extent;

static extent extent_of(const aisle_sim_outline *body) {
    extent e = {(double)INFINITY, (double)INFINITY, -(double)INFINITY, -(double)INFINITY};
    for (uint32_t i = 0; i < body->n; i++) {
        e.x0 = fmin(e.x0, body->v[i].x - body->radius);
        e.y0 = fmin(e.y0, body->v[i].y - body->radius);
        e.x1 = fmax(e.x1, body->v[i].x + body->radius);
        e.y1 = fmax(e.y1, body->v[i].y + body->radius);
    }
    return e;
}

static void note(double gap, int32_t id, double *least, int32_t *which) {
    if (gap < *least) {
        *least = fmax(gap, 0.0);
        *which = id;
    }
}

static void gap_to_solids(const aisle_sim_scene *self, const aisle_sim_outline *body, const extent *e, double *least,
                          int32_t *which) {
    double cx = 0.5 * (e->x0 + e->x1), cy = 0.5 * (e->y0 + e->y1),
           reach = aisle_vec2_length(aisle_vec2_of(e->x1 - cx, e->y1 - cy));
    for (uint32_t i = 0; i < self->count; i++) {
        const aisle_sim_solid *s = &self->solid[i];
        if (aisle_vec2_length(aisle_vec2_of(s->centre.x - cx, s->centre.y - cy)) - s->reach - reach < *least) {
            note(aisle_sim_gap(body, &s->outline), s->id, least, which);
        }
    }
}

static int32_t cell_of(double x, double origin, double resolution, int32_t size) {
    double c = floor((x - origin) / resolution);
    return c < 0.0 ? 0 : (c >= (double)size ? size - 1 : (int32_t)c);
}

// Occupied cells near, each row's runs as one box.
static void gap_to_cells(const aisle_sim_scene *self, const aisle_sim_outline *body, const extent *e, double *least,
                         int32_t *which) {
    double r = self->resolution;
    int32_t x0 = cell_of(e->x0 - *least, self->origin_x, r, self->width),
            x1 = cell_of(e->x1 + *least, self->origin_x, r, self->width);
    int32_t y0 = cell_of(e->y0 - *least, self->origin_y, r, self->height),
            y1 = cell_of(e->y1 + *least, self->origin_y, r, self->height);
    for (int32_t y = y0; y <= y1; y++) {
        const uint8_t *row = self->occupied + (size_t)y * (size_t)self->width;
        for (int32_t x = x0; x <= x1; x++) {
            int32_t first = x;
            while (x <= x1 && row[x] != 0) {
                x++;
            }
            if (x > first) {
                aisle_sim_outline box = aisle_sim_box(self->origin_x + first * r, self->origin_y + y * r,
                                                      self->origin_x + x * r, self->origin_y + (y + 1) * r);
                note(aisle_sim_gap(body, &box), AISLE_SIM_ID_SCAN, least, which);
            }
        }
    }
}

double aisle_sim_scene_gap(const aisle_sim_scene *self, const aisle_sim_outline *body, double most, int32_t *id) {
    extent e = extent_of(body);
    double least = most;
    int32_t which = 0;
    note(e.x0 - self->x_min, AISLE_SIM_ID_BOUNDS, &least, &which);
    note(e.y0 - self->y_min, AISLE_SIM_ID_BOUNDS, &least, &which);
    note(self->x_max - e.x1, AISLE_SIM_ID_BOUNDS, &least, &which);
    note(self->y_max - e.y1, AISLE_SIM_ID_BOUNDS, &least, &which);
    gap_to_solids(self, body, &e, &least, &which);
    if (self->has_scan) {
        gap_to_cells(self, body, &e, &least, &which);
    }
    if (id != NULL) {
        *id = which;
    }
    return least;
}

bool aisle_sim_scene_has_room(const aisle_sim_scene *self, aisle_vec2 at, double radius) {
    aisle_sim_outline disc = aisle_sim_disc(at, radius);
    return aisle_sim_scene_gap(self, &disc, 1e-3, NULL) > 0.0;
}

bool aisle_sim_scene_sees(const aisle_sim_scene *self, aisle_vec2 a, aisle_vec2 b, double radius) {
    double step = fmax(radius / 3.0, 0.05);
    double count = ceil(aisle_vec2_distance(a, b) / step);
    for (double i = 0.0; i <= count; i += 1.0) {
        if (!aisle_sim_scene_has_room(self, aisle_vec2_lerp(a, b, count > 0.0 ? i / count : 0.0), radius)) {
            return false;
        }
    }
    return true;
}
