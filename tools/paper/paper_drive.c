// What a polyline takes, driven as it is: lines with blended corners, speeds, the proof. Like any path of the planner.
//
//     paper-drive < hall and numbers
//
// The hall as hall.h says (its ends are not used), then numbers: acceleration (m/s2, forwards, backwards and sideways),
// turning acceleration (rad/s2, and so many rad/s at most), mass (kg), rolling resistance, idle power (W), efficiency;
// speeds { m/s }, zones { m, as options_t has it: < 0 none }, lines { points  x y ... }. A vehicle that never creeps.
// A JSON object a line, speed and zone, in this order nested: proved, length (m), duration (s), energy (J) and of that what
// turning on the spot takes, places where it stands, waypoints. Not proved: why, as verify.h has it; 0: it was not built.
#include "aisle/energy.h"
#include "hall.h"
#include "plan/compose.h"
#include "plan/verify.h"

#include <stdio.h>
#include <string.h>

enum { BLOCK = 96 << 20, CELLS = 1 << 20, POINTS = 4096, MANY = 32, BYTES = 1 << 17 };

static hall scene;
static aisle_space space;
static aisle_compose compose;
static aisle_verify verify;
static aisle_path_msg path, decoded;
static uint8_t bytes[BYTES];
static aisle_vehicle_msg told;
static aisle_vec2 points[POINTS];
static double speeds[MANY], zones[MANY];
static uint32_t speed_count, zone_count;

static double number(void) {
    double value = 0.0;
    if (scanf("%lf", &value) != 1) {
        hall_fail("the numbers end too early");
    }
    return value;
}

static uint32_t count_up_to(uint32_t most) {
    const double value = number();
    if (!(value >= 0.0 && value <= (double)most)) {
        hall_fail("a count is out of range");
    }
    return (uint32_t)value;
}

static uint32_t read_list(double *out) {
    const uint32_t count = count_up_to(MANY);
    for (uint32_t i = 0; i < count; i++) {
        out[i] = number();
    }
    return count;
}

static void read_vehicle(void) {
    told = (aisle_vehicle_msg){.vehicle_revision = 1,
                               .footprint_radius = (float)scene.vehicle.outer_radius,
                               .margin = scene.vehicle.margin > 0.0 ? (float)scene.vehicle.margin : -1.0F};
    told.a_max = told.d_max = told.lateral_a_max = (float)number();
    told.omega_max = told.alpha_max = (float)number();
    told.mass = (float)number();
    told.rolling_resistance = (float)number();
    told.idle_power = (float)number();
    told.drive_efficiency = (float)number();
    told.creep_clearance = 1e-6F;
}

static void take_speed(double speed) {
    aisle_refusal why;
    told.v_max = told.creep_speed = (float)speed;
    if (aisle_vehicle_from_msg(&told, &scene.vehicle, &why) != AISLE_OK) {
        hall_fail("the vehicle is refused");
    }
    aisle_space_begin(&space, &scene.layout, &scene.vehicle, AISLE_SPACE_FREE_TURN);
}

static aisle_goal_msg end_at(aisle_vec2 p, int32_t id) {
    return (aisle_goal_msg){.id = id, .x = p.x, .y = p.y, .tolerance_theta = 4.0F};
}

static bool build(uint32_t count, double zone, const aisle_goal_msg *ends) {
    const aisle_options_msg options = {.objective = AISLE_OPTIONS_SHORTEST, .zone = (float)zone};
    aisle_objective objective;
    aisle_leg leg = {.count = count, .seed_value = -1.0, .swarm_value = -1.0};
    if (!aisle_objective_of(&options, &scene.vehicle, &objective)) {
        hall_fail("no such objective");
    }
    const aisle_compose_request request = {.space = &space,
                                           .objective = &objective,
                                           .options = &options,
                                           .points = points,
                                           .legs = &leg,
                                           .leg_count = 1,
                                           .start = &ends[0],
                                           .goals = &ends[1]};
    path = (aisle_path_msg){.path_revision = 1,
                            .map_id = aisle_layout_map_id(&scene.layout),
                            .map_revision = aisle_layout_map_revision(&scene.layout),
                            .vehicle_revision = scene.vehicle.revision};
    aisle_status st = aisle_compose_start(&compose, &request, &path);
    uint32_t spent = 0;
    while (st == AISLE_OK && (st = aisle_compose_step(&compose, 1U << 20, &spent)) == AISLE_BUSY) {
        st = AISLE_OK;
    }
    return st == AISLE_OK;
}

static bool prove(const aisle_goal_msg *ends) {
    size_t size = 0;
    if (aisle_path_encode(&path, bytes, sizeof bytes, &size) != AISLE_OK) {
        hall_fail("a path cannot be encoded");
    }
    const aisle_waypoint_msg *w = path.waypoints;
    const aisle_verify_request request = {.layout = &scene.layout,
                                          .vehicle = &scene.vehicle,
                                          .bytes = bytes,
                                          .size = size,
                                          .start = {w[0].x, w[0].y, w[0].theta},
                                          .goals = &ends[1],
                                          .num_goals = 1};
    aisle_stamp stamp;
    aisle_status st;
    uint32_t spent = 0;
    aisle_verify_start(&verify, &request, &decoded);
    while ((st = aisle_verify_step(&verify, 1U << 20, &spent, &stamp)) == AISLE_BUSY) {
    }
    return st == AISLE_OK;
}

static uint32_t stops_on_the_way(void) {
    uint32_t stops = 0;
    for (int16_t i = 1; i + 1 < path.num_waypoints; i++) {
        const bool rests = path.waypoints[i].v <= 0.0F && (path.waypoints[i].flags & AISLE_WAYPOINT_TURN_IN_PLACE) != 0;
        stops += rests ? 1U : 0U;
    }
    return stops;
}

static void drive(uint32_t line, uint32_t count, double speed, double zone) {
    const aisle_goal_msg ends[2] = {end_at(points[0], 0), end_at(points[count - 1U], 1)};
    (void)printf("{\"line\": %u, \"speed\": %.9g, \"zone\": %.9g, \"proved\": ", (unsigned)line, speed, zone);
    aisle_energy sum;
    verify.fault = AISLE_VERIFY_NONE;
    if (!build(count, zone, ends) || !prove(ends) ||
        aisle_path_energy(&path, &told, &ends[1], 1, NULL, &sum) != AISLE_OK) {
        (void)printf("false, \"fault\": %d}\n", (int)verify.fault);
        return;
    }
    (void)printf("true, \"length\": %.9g, \"duration\": %.9g, \"energy\": %.9g, \"turning\": %.9g, \"stops\": %u, "
                 "\"waypoints\": %d}\n",
                 (double)path.length, (double)path.duration, (double)path.energy, (double)sum.turning,
                 (unsigned)stops_on_the_way(), (int)path.num_waypoints);
}

static void drive_line(uint32_t line) {
    const uint32_t count = count_up_to(POINTS);
    if (count < 2U) {
        hall_fail("a line has fewer than two points");
    }
    for (uint32_t i = 0; i < count; i++) {
        points[i].x = number();
        points[i].y = number();
    }
    for (uint32_t v = 0; v < speed_count; v++) {
        take_speed(speeds[v]);
        for (uint32_t z = 0; z < zone_count; z++) {
            drive(line, count, speeds[v], zones[z]);
        }
    }
}

int main(void) {
    aisle_arena arena = hall_arena(BLOCK);
    hall_read(&scene, &arena, CELLS);
    aisle_space_carve(&space, &arena, CELLS);
    aisle_compose_carve(&compose, &arena);
    if (arena.overflow) {
        hall_fail("no memory");
    }
    read_vehicle();
    speed_count = read_list(speeds);
    zone_count = read_list(zones);
    const uint32_t lines = count_up_to(1U << 20);
    for (uint32_t i = 0; i < lines; i++) {
        drive_line(i);
    }
    return 0;
}
