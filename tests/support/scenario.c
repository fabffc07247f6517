#include "scenario.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_MAX (1U << 20)
#define NUMBERS_MAX 16384
#define LISTS_MAX 1024
#define POINT_RADIUS 0.001 // m
#define SLACK 0.001        // m

typedef struct numbers { // of nested arrays, in their order
    double value[NUMBERS_MAX];
    int count;
    int end[LISTS_MAX]; // of value, where each array of the second depth ends
    int lists;
} numbers;

static char text[TEXT_MAX];
static numbers read;

static bool load(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return false;
    }
    size_t size = fread(text, 1, TEXT_MAX - 1U, file);
    text[size] = '\0';
    bool whole = feof(file) != 0 && ferror(file) == 0;
    return fclose(file) == 0 && whole && size > 0U;
}

// After the key and its colon; NULL: there is none.
static const char *value_of(const char *key) {
    const char *at = strstr(text, key);
    at = at != NULL ? strchr(at, ':') : NULL;
    return at != NULL ? at + 1 + strspn(at + 1, " \t\r\n") : NULL;
}

static bool read_number(const char **at, double *value) {
    char *end;
    *value = strtod(*at, &end);
    bool is_number = end != *at;
    *at = end;
    return is_number;
}

// Numbers of an array, however deep; false: something else is in it, or too much.
static bool read_arrays(const char *key) {
    const char *at = value_of(key);
    int depth = 0;
    read.count = read.lists = 0;
    if (at == NULL || *at != '[') {
        return false;
    }
    do {
        if (*at == '[') {
            depth++, at++;
        } else if (*at == ']') {
            if (depth == 2 && read.lists < LISTS_MAX) {
                read.end[read.lists++] = read.count;
            }
            depth--, at++;
        } else if (*at == ',' || isspace((unsigned char)*at)) {
            at++;
        } else if (read.count >= NUMBERS_MAX || !read_number(&at, &read.value[read.count++])) {
            return false;
        }
    } while (depth > 0);
    return read.lists < LISTS_MAX;
}

static bool read_body(float margin, aisle_vehicle_msg *vehicle, double *radius) {
    const char *at = value_of("\"radius\"");
    *vehicle = (aisle_vehicle_msg){.vehicle_revision = 1, .utime = 1, .margin = margin};
    if (at == NULL || !read_number(&at, radius)) {
        return false;
    }
    *radius = *radius > 0.0 ? *radius : POINT_RADIUS;
    if (!read_arrays("\"footprint\"")) {
        vehicle->footprint_radius = (float)*radius;
        return true;
    }
    vehicle->num_vertices = (int16_t)read.lists;
    bool fits = read.lists <= AISLE_VEHICLE_MAX_VERTICES && read.count == 2 * read.lists;
    for (int i = 0; fits && i < read.count; i++) {
        vehicle->footprint[i / 2][i % 2] = read.value[i];
    }
    return fits;
}

static bool read_bounds(double grow, aisle_layout_msg *layout) {
    if (!read_arrays("\"bounds\"") || read.count != 4) {
        return false;
    }
    layout->x_min = read.value[0] - grow;
    layout->y_min = read.value[1] - grow;
    layout->x_max = read.value[2] + grow;
    layout->y_max = read.value[3] + grow;
    return true;
}

static bool read_obstacles(aisle_layout_msg *layout) {
    if (!read_arrays("\"obstacles\"") || read.lists > AISLE_LAYOUT_MAX_POLYGONS) {
        return false;
    }
    layout->num_polygons = (int16_t)read.lists;
    for (int k = 0, from = 0; k < read.lists; from = read.end[k++]) {
        int count = read.end[k] - from;
        if (count % 2 != 0 || count < 6 || count > 2 * AISLE_POLYGON_MAX_VERTICES) {
            return false;
        }
        aisle_polygon_msg *polygon = &layout->polygons[k];
        *polygon =
            (aisle_polygon_msg){.id = k + 1, .kind = AISLE_POLYGON_OBSTACLE, .num_vertices = (int16_t)(count / 2)};
        for (int i = 0; i < count; i++) {
            polygon->vertices[i / 2][i % 2] = read.value[from + i];
        }
    }
    return true;
}

static aisle_goal_msg stop_at(int32_t id, const double *at) {
    return (aisle_goal_msg){.id = id, .x = at[0], .y = at[1], .tolerance_theta = 4.0F};
}

static bool read_stops(aisle_query_msg *query) {
    if (!read_arrays("\"start\"") || read.count < 2) {
        return false;
    }
    query->start = stop_at(0, read.value);
    if (!read_arrays("\"goals\"") || read.lists == 0 || read.lists > AISLE_QUERY_MAX_GOALS) {
        return false;
    }
    query->num_goals = (int16_t)read.lists;
    for (int k = 0, from = 0; k < read.lists; from = read.end[k++]) {
        if (read.end[k] - from < 2) {
            return false;
        }
        query->goals[k] = stop_at(k + 1, &read.value[from]);
    }
    return true;
}

bool scenario_read(const char *path, float margin, aisle_layout_msg *layout, aisle_vehicle_msg *vehicle,
                   aisle_query_msg *query) {
    double radius = 0.0;
    memset(layout, 0, sizeof *layout);
    *layout = (aisle_layout_msg){.map_id = 1, .map_revision = 1, .num_parts = 1};
    memset(query, 0, sizeof *query);
    *query = (aisle_query_msg){.query_id = 1, .map_id = 1};
    bool good = load(path) && read_body(margin, vehicle, &radius) &&
                read_bounds(radius + (margin > 0.0F ? (double)margin : 0.0) + SLACK, layout) &&
                read_obstacles(layout) && read_stops(query);
    layout->total_polygons = layout->num_polygons;
    if (!good) {
        (void)fprintf(stderr, "scenario: cannot use %s\n", path);
    }
    return good;
}
