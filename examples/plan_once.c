// One shelf, one disc-shaped vehicle, one query: asks the planner in a static block and prints the way.
#include <aisle/planner.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned char memory[3U << 20]; // aisle_planner_memsize() tells how much these limits need
static aisle_layout_msg layout = {
    .map_id = 1,
    .map_revision = 1,
    .num_parts = 1,
    .total_polygons = 1,
    .x_max = 10.0,
    .y_max = 6.0,
    .num_polygons = 1,
    .polygons = {{.id = 1, .num_vertices = 4, .vertices = {{4.0, 0.0}, {5.0, 0.0}, {5.0, 4.0}, {4.0, 4.0}}}}};
static aisle_path_msg path;

void aisle_assert_failed(const char *file, int line, const char *condition) { // yours: reset, log, stop
    (void)fprintf(stderr, "%s:%d: %s\n", file, line, condition);
    abort();
}

int main(void) {
    const aisle_config config = {
        .limits =
            {.cells = 65536, .polygons = 16, .vertices = 64, .open_nodes = 8192, .requests = 1, .cached_paths = 1},
        .vehicle = {.footprint_radius = 0.3F, .margin = 0.1F},
        .has_vehicle = true};
    const aisle_query_msg query = {.query_id = 7,
                                   .map_id = 1,
                                   .start = {.x = 1.0, .y = 1.0, .tolerance_theta = 4.0F}, // any heading
                                   .num_goals = 1,
                                   .goals = {{.id = 1, .x = 9.0, .y = 5.0, .tolerance_theta = 4.0F}}};
    layout.crc32 = (int32_t)aisle_layout_crc32(0, &layout);
    unsigned char *block =
        memory + (AISLE_PLANNER_ALIGN - (uintptr_t)memory % AISLE_PLANNER_ALIGN) % AISLE_PLANNER_ALIGN;
    aisle_planner *planner;
    if (aisle_planner_init(block, sizeof memory - AISLE_PLANNER_ALIGN, &config, &planner) != AISLE_OK) {
        return 1;
    }
    const aisle_input inputs[] = {{.kind = AISLE_INPUT_LAYOUT, .as.layout = &layout},
                                  {.kind = AISLE_INPUT_QUERY, .as.query = &query}};
    for (int i = 0; i < 2; i++) {
        while (aisle_planner_submit(planner, 0, &inputs[i]) == AISLE_BUSY) {
            (void)aisle_planner_step(planner, 0, 1000);
        }
    }
    aisle_event event;
    while (!aisle_planner_next_event(planner, &event)) {
        (void)aisle_planner_step(planner, 0, 1000); // 1000 work units, then your loop may do something else
    }
    if (aisle_path_decode(event.bytes, event.size, &path) != AISLE_OK) {
        return 1;
    }
    (void)printf("status %d, cause %s, %.2f m, %d waypoints\n", path.status, aisle_cause_name(path.cause),
                 (double)path.length, path.num_waypoints);
    return path.status == AISLE_PATH_OK ? 0 : 1;
}
