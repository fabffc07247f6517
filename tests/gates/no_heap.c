// The core plans a path round an obstacle, proves it and hands it out in a process whose heap ends the program: neither
// libaisle nor the libccd it links may ask for memory. Own malloc and kin take the C library's place.
#include "aisle/planner.h"
#include "base/crc32.h"
#include "wire/codec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool armed; // from here on, the heap is closed
static unsigned char early[1 << 20];
static size_t early_used;

// The start-up code of the C library and stdio may allocate before main() arms the trap; nothing is given back.
static void *take(size_t size) {
    static const char complaint[] = "the heap was used\n";
    if (armed) {
        (void)!write(2, complaint, sizeof complaint - 1);
        _exit(1);
    }
    size_t at = early_used;
    early_used += (size + 63U) / 64U * 64U;
    return early_used <= sizeof early ? early + at : NULL;
}

void *malloc(size_t size) {
    return take(size);
}
void *calloc(size_t count, size_t size) {
    return take(count * size);
}
void *realloc(void *old, size_t size) {
    (void)old;
    return take(size);
}
void free(void *block) {
    if (armed && block != NULL) {
        (void)take(0);
    }
}

static unsigned char memory[(64U << 20) + 64U];
static aisle_config config;
static aisle_layout_msg layout;
static aisle_query_msg query;

static void room_with_a_pillar(void) {
    uint8_t bytes[512];
    size_t size = 0;
    layout = (aisle_layout_msg){.map_id = 1, .map_revision = 1, .num_parts = 1, .total_polygons = 1, .num_polygons = 1};
    layout.x_max = 12.0;
    layout.y_max = 8.0;
    layout.polygons[0] =
        (aisle_polygon_msg){.id = 7, .num_vertices = 4, .vertices = {{5.0, 3.0}, {6.0, 3.0}, {6.0, 5.0}, {5.0, 5.0}}};
    if (aisle_msg_encode_body(AISLE_MSG_POLYGON, &layout.polygons[0], bytes, sizeof bytes, &size) == AISLE_OK) {
        layout.crc32 = (int32_t)aisle_crc32(0, bytes, size);
    }
}

static void across(void) {
    query = (aisle_query_msg){.query_id = 3, .map_id = 1, .num_goals = 1};
    query.start = (aisle_goal_msg){.x = 2.0, .y = 4.0};
    query.goals[0] = (aisle_goal_msg){.id = 1, .x = 10.0, .y = 4.0};
}

// Waypoints of the one reply that must come; 0 if it carries no path.
static int waypoints_planned(aisle_planner *planner) {
    static aisle_path_msg path;
    aisle_event event;
    aisle_status status;
    int waypoints = 0;
    do {
        status = aisle_planner_step(planner, 1000000, 1000);
        while (aisle_planner_next_event(planner, &event)) {
            if (aisle_msg_decode(AISLE_MSG_PATH, event.bytes, event.size, &path, NULL) == AISLE_OK) {
                waypoints = path.num_waypoints;
            }
        }
    } while (status == AISLE_BUSY);
    return waypoints;
}

static int plan(void) {
    aisle_planner *planner = NULL;
    unsigned char *block = memory + (64U - (uintptr_t)memory % 64U) % 64U;
    if (aisle_planner_init(block, sizeof memory - 64U, &config, &planner) != AISLE_OK) {
        return -1;
    }
    const aisle_input inputs[] = {{.kind = AISLE_INPUT_LAYOUT, .as.layout = &layout},
                                  {.kind = AISLE_INPUT_QUERY, .as.query = &query}};
    for (size_t i = 0; i < sizeof inputs / sizeof inputs[0]; i++) {
        while (aisle_planner_submit(planner, 1000000, &inputs[i]) == AISLE_BUSY) {
            (void)aisle_planner_step(planner, 1000000, 1000);
        }
    }
    return waypoints_planned(planner);
}

int main(int argc, char **argv) {
    (void)argv;
    config.has_vehicle = true;
    room_with_a_pillar();
    across();
    armed = true;
    if (argc > 1) { // prove that the trap springs
        void *volatile bait = malloc(16);
        return bait != NULL ? 0 : 2;
    }
    int waypoints = plan();
    armed = false;
    (void)printf("%d waypoints without the heap\n", waypoints);
    return waypoints > 1 ? 0 : 2;
}
