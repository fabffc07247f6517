// arm_door.h - test fixture: a planner with a layout of boxes, a vehicle with an arm, and one arm goal at a time.
#ifndef AISLE_TESTS_ARM_DOOR_H
#define AISLE_TESTS_ARM_DOOR_H

#include "aisle/planner.h"
#include "arm_usual.h"
#include "unity.h"
#include "wire/codec.h"

#include <stdlib.h>
#include <string.h>

#define DOOR_UNUSED __attribute__((unused)) static

static aisle_planner *door;
static aisle_layout_msg door_layout;
static aisle_vehicle_msg door_vehicle;
static aisle_pose_msg door_pose;
static aisle_arm_goal_msg door_goal;
static aisle_arm_path_msg door_path;
static uint8_t door_bytes[65000];
static size_t door_size;
static int64_t door_now;

DOOR_UNUSED void door_box(double x0, double y0, double x1, double y1) {
    aisle_polygon_msg *p = &door_layout.polygons[door_layout.num_polygons++];
    const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    p->id = door_layout.num_polygons;
    p->num_vertices = 4;
    memcpy(p->vertices, v, sizeof v);
}

// The usual arm, its vehicle at (5, 5) looking along x.
DOOR_UNUSED void door_prepare(void) {
    memset(&door_layout, 0, sizeof door_layout);
    memset(&door_pose, 0, sizeof door_pose);
    memset(&door_goal, 0, sizeof door_goal);
    door_layout.map_id = door_layout.map_revision = 1;
    door_layout.num_parts = 1;
    door_layout.x_max = door_layout.y_max = 10.0;
    arm_usual(&door_vehicle);
    door_vehicle.vehicle_revision = 1;
    door_pose = (aisle_pose_msg){.utime = 1, .seq = 1, .map_id = 1, .x = 5.0, .y = 5.0, .localized = 1};
    door_goal = (aisle_arm_goal_msg){.arm_goal_id = 7, .kind = AISLE_ARM_GOAL_POINT, .x = 6.2, .y = 5.4};
    door_goal.q_start[0] = -0.8F;
    door_now = 1000;
}

DOOR_UNUSED void door_submit(const aisle_input *input) {
    while (aisle_planner_submit(door, door_now, input) == AISLE_BUSY) {
        (void)aisle_planner_step(door, door_now, 100000);
    }
}

// A planner that holds layout, vehicle and pose.
DOOR_UNUSED void door_open(void) {
    static unsigned char *block;
    static aisle_config config;
    const size_t size = aisle_planner_memsize(&config.limits);
    if (block == NULL) {
        block = (unsigned char *)malloc(size + AISLE_PLANNER_ALIGN);
    }
    TEST_ASSERT_NOT_NULL(block);
    unsigned char *at = block + (AISLE_PLANNER_ALIGN - (uintptr_t)block % AISLE_PLANNER_ALIGN);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_planner_init(at, size, &config, &door));
    door_layout.total_polygons = door_layout.num_polygons;
    door_layout.crc32 = (int32_t)aisle_layout_crc32(0, &door_layout);
    door_submit(&(aisle_input){.kind = AISLE_INPUT_LAYOUT, .as.layout = &door_layout});
    door_submit(&(aisle_input){.kind = AISLE_INPUT_VEHICLE, .as.vehicle = &door_vehicle});
    door_submit(&(aisle_input){.kind = AISLE_INPUT_POSE, .as.pose = &door_pose});
}

// The one answer to door_goal, in door_path and door_bytes, by steps of `units`.
DOOR_UNUSED void door_ask(uint32_t units) {
    aisle_event event;
    aisle_status status;
    int answers = 0;
    door_submit(&(aisle_input){.kind = AISLE_INPUT_ARM_GOAL, .as.arm_goal = &door_goal});
    do {
        status = aisle_planner_step(door, door_now, units);
        while (aisle_planner_next_event(door, &event)) {
            TEST_ASSERT_EQUAL(AISLE_EVENT_ARM_PATH, event.kind);
            memcpy(door_bytes, event.bytes, event.size);
            door_size = event.size;
            answers++;
        }
    } while (status == AISLE_BUSY);
    TEST_ASSERT_EQUAL_INT(1, answers);
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_msg_decode(AISLE_MSG_ARM_PATH, door_bytes, door_size, &door_path, NULL));
    TEST_ASSERT_EQUAL_INT32(door_goal.arm_goal_id, door_path.arm_goal_id);
}

DOOR_UNUSED void door_assert_cause(int16_t cause, int32_t id) {
    door_ask(100000);
    TEST_ASSERT_EQUAL_STRING(aisle_cause_name(cause), aisle_cause_name(door_path.cause));
    TEST_ASSERT_EQUAL_INT32(id, door_path.cause_id);
    TEST_ASSERT_EQUAL_INT8(AISLE_PATH_NONE, door_path.status);
    TEST_ASSERT_EQUAL_INT16(0, door_path.num_waypoints);
}
#endif
