// hall.h - test fixture: a hall of boxes as the simulator's scene and as messages.
#ifndef AISLE_TESTS_SIM_HALL_H
#define AISLE_TESTS_SIM_HALL_H

#include "aisle/planner.h"
#include "sim/scene.h"
#include "unity.h"

#include <string.h>

#define HALL_UNUSED __attribute__((unused)) static

static aisle_layout_msg hall_layout;

HALL_UNUSED void hall_begin(double width, double height) {
    memset(&hall_layout, 0, sizeof hall_layout);
    hall_layout.map_id = 1;
    hall_layout.map_revision = 1;
    hall_layout.num_parts = 1;
    hall_layout.x_max = width;
    hall_layout.y_max = height;
}

HALL_UNUSED void hall_add(double x0, double y0, double x1, double y1) {
    aisle_polygon_msg *p = &hall_layout.polygons[hall_layout.num_polygons++];
    *p = (aisle_polygon_msg){
        .id = hall_layout.num_polygons, .num_vertices = 4, .vertices = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
    hall_layout.total_polygons = hall_layout.num_polygons;
}

HALL_UNUSED void hall_open(aisle_sim_scene *scene) {
    hall_layout.crc32 = (int32_t)aisle_layout_crc32(0, &hall_layout);
    TEST_ASSERT_TRUE(aisle_sim_scene_take_layout(scene, &hall_layout));
}
#endif
