// The codec against lcm-gen's C code, every type, both ways. The members are carried over by hand, one by one: neither
// our generator nor our tables have a say in which member is which.
#include "wire/codec.h"

#include "aisle_arm_goal_t.h"
#include "aisle_arm_path_t.h"
#include "aisle_command_t.h"
#include "aisle_diag_t.h"
#include "aisle_goal_list_t.h"
#include "aisle_grid_chunk_t.h"
#include "aisle_layout_patch_t.h"
#include "aisle_layout_t.h"
#include "aisle_obstacles_t.h"
#include "aisle_path_t.h"
#include "aisle_pose_t.h"
#include "aisle_query_t.h"
#include "aisle_status_t.h"
#include "aisle_vehicle_t.h"
#include "fill.h"
#include "unity.h"

enum { SEEDS = 40, ROOM = 70000 };

static any_msg msg, back;
static uint8_t ours[ROOM], theirs[ROOM];

void setUp(void) {
    memset(&back, 0, sizeof back);
}
void tearDown(void) {}

// ---- our structs as theirs. COPY: a scalar; COPY_ALL: a fixed array; BORROW: a variable array of scalars, not copied

#define COPY(member) to->member = from->member
#define COPY_ALL(member) memcpy(to->member, from->member, sizeof to->member)
#define BORROW(member) to->member = from->member

static double *rows_d[AISLE_LAYOUT_MAX_POLYGONS][AISLE_POLYGON_MAX_VERTICES];
static float *rows_f[AISLE_OBSTACLES_MAX_OBSTACLES][AISLE_OBSTACLE_MAX_VERTICES];
static aisle_polygon_t polygons[AISLE_LAYOUT_MAX_POLYGONS];
static aisle_obstacle_t obstacles[AISLE_OBSTACLES_MAX_OBSTACLES];
static aisle_waypoint_t waypoints[AISLE_PATH_MAX_WAYPOINTS];
static aisle_arm_waypoint_t arm_waypoints[AISLE_ARM_PATH_MAX_WAYPOINTS];
static aisle_goal_t goals[AISLE_GOAL_LIST_MAX_GOALS];

static void carry_polygon(aisle_polygon_msg *from, aisle_polygon_t *to, size_t place) {
    COPY(id);
    COPY(kind);
    COPY(value);
    COPY(direction);
    COPY(num_vertices);
    for (int i = 0; i < from->num_vertices; i++) {
        rows_d[place][i] = from->vertices[i];
    }
    to->vertices = rows_d[place];
}

static void carry_polygons(aisle_polygon_msg *from, int n) {
    for (int i = 0; i < n; i++) {
        carry_polygon(&from[i], &polygons[i], (size_t)i);
    }
}

static void carry_obstacle(aisle_obstacle_msg *from, aisle_obstacle_t *to, size_t place) {
    COPY(id);
    COPY(kind);
    COPY(x);
    COPY(y);
    COPY(theta);
    COPY(vx);
    COPY(vy);
    COPY(omega);
    COPY_ALL(cov_xy);
    COPY(sigma_v);
    COPY(v_bound);
    COPY(radius);
    COPY(num_vertices);
    for (int i = 0; i < from->num_vertices; i++) {
        rows_f[place][i] = from->vertices[i];
    }
    to->vertices = rows_f[place];
}

static void carry_options(aisle_options_msg *from, aisle_options_t *to) {
    COPY(planner);
    COPY(objective);
    COPY(interpolation);
    COPY(num_samples);
    COPY(seed);
    COPY(work_units);
    COPY(risk_weight);
    COPY(step);
    COPY(zone);
}

static void carry_goal(aisle_goal_msg *from, aisle_goal_t *to) {
    COPY(id);
    COPY(x);
    COPY(y);
    COPY(theta);
    COPY(tolerance_xy);
    COPY(tolerance_theta);
    COPY(dwell);
}

static void carry_waypoint(aisle_waypoint_msg *from, aisle_waypoint_t *to) {
    COPY(x);
    COPY(y);
    COPY(theta);
    COPY(s);
    COPY(t);
    COPY(curvature);
    COPY(v);
    COPY(a);
    COPY(clearance);
    COPY(flags);
    COPY(goal_id);
}

static void carry_arm_waypoint(aisle_arm_waypoint_msg *from, aisle_arm_waypoint_t *to) {
    COPY(t);
    COPY_ALL(q);
    COPY_ALL(qd);
    COPY_ALL(qdd);
    COPY_ALL(torque);
    COPY(clearance);
}

static void carry_arm_goal(aisle_arm_goal_msg *from, aisle_arm_goal_t *to) {
    COPY(utime);
    COPY(arm_goal_id);
    COPY(kind);
    COPY(x);
    COPY(y);
    COPY(theta);
    COPY_ALL(q_start);
    COPY_ALL(q);
    COPY(tolerance_xy);
    COPY(tolerance_theta);
    carry_options(&from->options, &to->options);
}

static void carry_arm_path(aisle_arm_path_msg *from, aisle_arm_path_t *to) {
    COPY(utime);
    COPY(boot_id);
    COPY(path_revision);
    COPY(arm_goal_id);
    COPY(map_id);
    COPY(map_revision);
    COPY(vehicle_revision);
    COPY(t0_utime);
    COPY(valid_until_utime);
    COPY(status);
    COPY(cause);
    COPY(cause_id);
    COPY(planner);
    COPY(work_units);
    COPY(clearance_min);
    COPY(duration);
    COPY(travel);
    COPY(num_waypoints);
    for (int i = 0; i < from->num_waypoints; i++) {
        carry_arm_waypoint(&from->waypoints[i], &arm_waypoints[i]);
    }
    to->waypoints = arm_waypoints;
}

static void carry_command(aisle_command_msg *from, aisle_command_t *to) {
    COPY(utime);
    COPY(command_id);
    COPY(command);
    COPY(arg);
}

static void carry_diag(aisle_diag_msg *from, aisle_diag_t *to) {
    COPY(utime);
    COPY(boot_id);
    COPY(arena_bytes);
    COPY(arena_used_max);
    COPY(rss_bytes);
    COPY(num_timers);
    BORROW(timer_id);
    BORROW(timer_count);
    BORROW(timer_p50);
    BORROW(timer_p99);
    BORROW(timer_max);
    COPY(num_counters);
    BORROW(counter_id);
    BORROW(counter);
}

static void carry_goals(aisle_goal_msg *from, int n) {
    for (int i = 0; i < n; i++) {
        carry_goal(&from[i], &goals[i]);
    }
}

static void carry_goal_list(aisle_goal_list_msg *from, aisle_goal_list_t *to) {
    COPY(utime);
    COPY(goal_list_id);
    COPY(goal_list_revision);
    COPY(map_id);
    COPY(ordering);
    carry_options(&from->options, &to->options);
    COPY(num_goals);
    carry_goals(from->goals, from->num_goals);
    to->goals = goals;
}

static void carry_query(aisle_query_msg *from, aisle_query_t *to) {
    COPY(utime);
    COPY(query_id);
    COPY(map_id);
    COPY(ordering);
    carry_goal(&from->start, &to->start);
    carry_options(&from->options, &to->options);
    COPY(num_goals);
    carry_goals(from->goals, from->num_goals);
    to->goals = goals;
}

static void carry_grid_chunk(aisle_grid_chunk_msg *from, aisle_grid_chunk_t *to) {
    COPY(utime);
    COPY(map_id);
    COPY(map_revision);
    COPY(part);
    COPY(num_parts);
    COPY(origin_x);
    COPY(origin_y);
    COPY(resolution);
    COPY(x0);
    COPY(y0);
    COPY(width);
    COPY(height);
    COPY(encoding);
    COPY(num_bytes);
    BORROW(data);
}

static void carry_layout(aisle_layout_msg *from, aisle_layout_t *to) {
    COPY(utime);
    COPY(map_id);
    COPY(map_revision);
    COPY(part);
    COPY(num_parts);
    COPY(num_grid_chunks);
    COPY(total_polygons);
    COPY(crc32);
    COPY(x_min);
    COPY(y_min);
    COPY(x_max);
    COPY(y_max);
    COPY(resolution);
    COPY(num_polygons);
    carry_polygons(from->polygons, from->num_polygons);
    to->polygons = polygons;
}

static void carry_layout_patch(aisle_layout_patch_msg *from, aisle_layout_patch_t *to) {
    COPY(utime);
    COPY(map_id);
    COPY(base_revision);
    COPY(map_revision);
    COPY(num_removed);
    BORROW(removed);
    COPY(num_polygons);
    carry_polygons(from->polygons, from->num_polygons);
    to->polygons = polygons;
}

static void carry_obstacles(aisle_obstacles_msg *from, aisle_obstacles_t *to) {
    COPY(utime);
    COPY(seq);
    COPY(source);
    COPY(map_id);
    COPY(num_obstacles);
    for (int i = 0; i < from->num_obstacles; i++) {
        carry_obstacle(&from->obstacles[i], &obstacles[i], (size_t)i);
    }
    to->obstacles = obstacles;
}

static void carry_path(aisle_path_msg *from, aisle_path_t *to) {
    COPY(utime);
    COPY(boot_id);
    COPY(path_revision);
    COPY(query_id);
    COPY(goal_list_id);
    COPY(goal_list_revision);
    COPY(map_id);
    COPY(map_revision);
    COPY(vehicle_revision);
    COPY(pose_utime);
    COPY(obstacles_utime);
    COPY(t0_utime);
    COPY(valid_until_utime);
    COPY(status);
    COPY(cause);
    COPY(cause_id);
    COPY(cause_value);
    COPY(planner);
    COPY(cached);
    COPY(work_units);
    COPY(num_base);
    COPY(length);
    COPY(length_bound);
    COPY(duration);
    COPY(energy);
    COPY(risk);
    COPY(clearance_min);
    COPY(clearance_moving_min);
    COPY(planning_time);
    COPY(certificate);
    COPY(num_waypoints);
    for (int i = 0; i < from->num_waypoints; i++) {
        carry_waypoint(&from->waypoints[i], &waypoints[i]);
    }
    to->waypoints = waypoints;
}

static void carry_pose(aisle_pose_msg *from, aisle_pose_t *to) {
    COPY(utime);
    COPY(seq);
    COPY(map_id);
    COPY(x);
    COPY(y);
    COPY(theta);
    COPY(vx);
    COPY(vy);
    COPY(omega);
    COPY_ALL(cov);
    COPY(localized);
}

static void carry_status(aisle_status_msg *from, aisle_status_t *to) {
    COPY(utime);
    COPY(boot_id);
    COPY(uptime);
    COPY(seq);
    COPY(protocol);
    COPY(state);
    COPY(cause);
    COPY(cause_id);
    COPY(map_id);
    COPY(map_revision);
    COPY(vehicle_revision);
    COPY(goal_list_id);
    COPY(goal_list_revision);
    COPY(goal_id);
    COPY(path_revision);
    COPY(command_id);
    COPY(pose_age);
    COPY(obstacles_age);
    COPY(distance_remaining);
    COPY(time_remaining);
    COPY(num_rejected);
    COPY(num_deadline_missed);
}

static void carry_vehicle_arm(aisle_vehicle_msg *from, aisle_vehicle_t *to) {
    COPY(num_links);
    COPY_ALL(arm_base);
    BORROW(link_length);
    BORROW(link_radius);
    BORROW(link_mass);
    BORROW(joint_min);
    BORROW(joint_max);
    BORROW(joint_v_max);
    BORROW(joint_a_max);
    BORROW(joint_j_max);
    BORROW(joint_torque_max);
}

static void carry_vehicle(aisle_vehicle_msg *from, aisle_vehicle_t *to) {
    COPY(utime);
    COPY(vehicle_revision);
    COPY(drive);
    COPY(num_vertices);
    for (int i = 0; i < from->num_vertices; i++) {
        rows_d[0][i] = from->footprint[i];
    }
    to->footprint = rows_d[0];
    COPY(footprint_radius);
    COPY(v_max);
    COPY(v_reverse_max);
    COPY(a_max);
    COPY(d_max);
    COPY(omega_max);
    COPY(alpha_max);
    COPY(lateral_a_max);
    COPY(curvature_max);
    COPY(reaction_time);
    COPY(margin);
    COPY(creep_clearance);
    COPY(creep_speed);
    COPY(pose_timeout);
    COPY(obstacles_timeout);
    COPY(mass);
    COPY(rolling_resistance);
    COPY(idle_power);
    COPY(drive_efficiency);
    carry_vehicle_arm(from, to);
}

// ---- one row of functions per type

static void carry_polygon_alone(aisle_polygon_msg *from, aisle_polygon_t *to) {
    carry_polygon(from, to, 0);
}
static void carry_obstacle_alone(aisle_obstacle_msg *from, aisle_obstacle_t *to) {
    carry_obstacle(from, to, 0);
}

// encode_NAME: *from as lcm-gen writes it. reencode_NAME: bytes read and written again by lcm-gen alone.
#define TYPE(name, carry)                                                                                              \
    static int encode_##name(void *from, uint8_t *out) {                                                               \
        aisle_##name##_t to;                                                                                           \
        carry(from, &to);                                                                                              \
        return aisle_##name##_t_encode(out, 0, ROOM, &to);                                                             \
    }                                                                                                                  \
    static int reencode_##name(const uint8_t *from, int size, uint8_t *out) {                                          \
        aisle_##name##_t held;                                                                                         \
        if (aisle_##name##_t_decode(from, 0, size, &held) != size) {                                                   \
            return -1;                                                                                                 \
        }                                                                                                              \
        int written = aisle_##name##_t_encode(out, 0, ROOM, &held);                                                    \
        (void)aisle_##name##_t_decode_cleanup(&held);                                                                  \
        return written;                                                                                                \
    }
#define ROW(number, name)                                                                                              \
    [number] = {#name "_t", __aisle_##name##_t_get_hash, encode_##name, reencode_##name, sizeof(aisle_##name##_msg)}

TYPE(arm_goal, carry_arm_goal)
TYPE(arm_path, carry_arm_path)
TYPE(arm_waypoint, carry_arm_waypoint)
TYPE(command, carry_command)
TYPE(diag, carry_diag)
TYPE(goal, carry_goal)
TYPE(goal_list, carry_goal_list)
TYPE(grid_chunk, carry_grid_chunk)
TYPE(layout, carry_layout)
TYPE(layout_patch, carry_layout_patch)
TYPE(obstacle, carry_obstacle_alone)
TYPE(obstacles, carry_obstacles)
TYPE(options, carry_options)
TYPE(path, carry_path)
TYPE(polygon, carry_polygon_alone)
TYPE(pose, carry_pose)
TYPE(query, carry_query)
TYPE(status, carry_status)
TYPE(vehicle, carry_vehicle)
TYPE(waypoint, carry_waypoint)

static const struct {
    const char *name;
    int64_t (*hash)(void);
    int (*encode)(void *from, uint8_t *out);
    int (*reencode)(const uint8_t *from, int size, uint8_t *out);
    size_t struct_size;
} theirs_of[AISLE_MSG_COUNT] = {ROW(AISLE_MSG_ARM_GOAL, arm_goal),   ROW(AISLE_MSG_ARM_PATH, arm_path),
                                ROW(AISLE_MSG_COMMAND, command),     ROW(AISLE_MSG_ARM_WAYPOINT, arm_waypoint),
                                ROW(AISLE_MSG_DIAG, diag),           ROW(AISLE_MSG_GOAL, goal),
                                ROW(AISLE_MSG_GOAL_LIST, goal_list), ROW(AISLE_MSG_GRID_CHUNK, grid_chunk),
                                ROW(AISLE_MSG_LAYOUT, layout),       ROW(AISLE_MSG_LAYOUT_PATCH, layout_patch),
                                ROW(AISLE_MSG_OBSTACLE, obstacle),   ROW(AISLE_MSG_OBSTACLES, obstacles),
                                ROW(AISLE_MSG_OPTIONS, options),     ROW(AISLE_MSG_PATH, path),
                                ROW(AISLE_MSG_POLYGON, polygon),     ROW(AISLE_MSG_POSE, pose),
                                ROW(AISLE_MSG_QUERY, query),         ROW(AISLE_MSG_STATUS, status),
                                ROW(AISLE_MSG_VEHICLE, vehicle),     ROW(AISLE_MSG_WAYPOINT, waypoint)};

static void same(uint32_t type, size_t size, int their_size) {
    TEST_ASSERT_EQUAL_INT_MESSAGE((int)size, their_size, aisle_msg_name(type));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(ours, theirs, size), aisle_msg_name(type));
}

// ---- tests

static void test_every_type_has_lcm_gens_name_and_fingerprint(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        TEST_ASSERT_NOT_NULL(theirs_of[type].hash);
        TEST_ASSERT_EQUAL_STRING(theirs_of[type].name, aisle_msg_name(type));
        TEST_ASSERT_EQUAL_HEX64((uint64_t)theirs_of[type].hash(), aisle_msg_fingerprint(type));
        TEST_ASSERT_EQUAL_size_t(theirs_of[type].struct_size, aisle_msg_struct_size(type));
    }
}

static void test_we_write_the_bytes_lcm_gen_writes(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            for (uint64_t seed = 1; seed <= SEEDS; seed++) {
                size_t size = 0;
                fill_message(type, &msg, shape, seed);
                TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(type, &msg, ours, ROOM, &size));
                memset(theirs, 0, size);
                same(type, size, theirs_of[type].encode(&msg, theirs));
            }
        }
    }
}

static void test_we_read_what_lcm_gen_writes(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            for (uint64_t seed = 1; seed <= SEEDS; seed++) {
                fill_message(type, &msg, shape, seed);
                int size = theirs_of[type].encode(&msg, ours);
                TEST_ASSERT_GREATER_THAN_INT(0, size);
                fill_message(type, &back, FILL_RANDOM, seed + 1); // what must be overwritten
                TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_decode(type, ours, (size_t)size, &back, NULL));
                memset(theirs, 0, (size_t)size);
                same(type, (size_t)size, theirs_of[type].encode(&back, theirs));
            }
        }
    }
}

static void test_lcm_gen_reads_what_we_write(void) {
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
            for (uint64_t seed = 1; seed <= SEEDS; seed++) {
                size_t size = 0;
                fill_message(type, &msg, shape, seed);
                TEST_ASSERT_EQUAL_INT(AISLE_OK, aisle_msg_encode(type, &msg, ours, ROOM, &size));
                memset(theirs, 0, size);
                same(type, size, theirs_of[type].reencode(ours, (int)size, theirs));
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_every_type_has_lcm_gens_name_and_fingerprint);
    RUN_TEST(test_we_write_the_bytes_lcm_gen_writes);
    RUN_TEST(test_we_read_what_lcm_gen_writes);
    RUN_TEST(test_lcm_gen_reads_what_we_write);
    return UNITY_END();
}
