#include "robot/vehicle.h"

#include "base/check.h"

#include <stddef.h>
#include <string.h>

enum { // places in vehicle_t
    MEMBER_DRIVE = 2,
    MEMBER_NUM_VERTICES = 3,
    MEMBER_FOOTPRINT = 4,
    MEMBER_FOOTPRINT_RADIUS = 5,
    MEMBER_MARGIN = 15
};

typedef struct number_row { // a float of vehicle_t that becomes a double of aisle_vehicle
    size_t in, out;         // offsets
    float fallback;         // for 0
    float most;
    int32_t member;
} number_row;

#define NUMBER(place, name, fallback, most)                                                                            \
    { offsetof(aisle_vehicle_msg, name), offsetof(aisle_vehicle, name), (fallback), (float)(most), (place) }

static const number_row numbers[] = {
    NUMBER(6, v_max, 1.5F, AISLE_VEHICLE_SPEED_MAX),
    NUMBER(7, v_reverse_max, 0.3F, AISLE_VEHICLE_SPEED_MAX),
    NUMBER(8, a_max, 0.5F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(9, d_max, 0.5F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(10, omega_max, 1.0F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(11, alpha_max, 1.0F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(12, lateral_a_max, 0.5F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(13, curvature_max, 0.0F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(14, reaction_time, 0.3F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(MEMBER_MARGIN, margin, 0.1F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(16, creep_clearance, 0.5F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(17, creep_speed, 0.3F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(18, pose_timeout, 0.2F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(19, obstacles_timeout, 0.3F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(20, mass, 500.0F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(21, rolling_resistance, 0.015F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(22, idle_power, 50.0F, AISLE_VEHICLE_VALUE_MAX),
    NUMBER(23, drive_efficiency, 0.8F, 1.0F),
};

#define NUMBERS (sizeof numbers / sizeof numbers[0])

static aisle_status refuse(aisle_refusal *why, int32_t member, double value) {
    *why = (aisle_refusal){.cause = AISLE_STATUS_MALFORMED, .id = member, .value = (float)value};
    return AISLE_ERR_DATA;
}

// Index of the first vertex that is not finite or out of range; -1 if all are fit.
static int32_t first_unfit_vertex(const aisle_vec2 *v, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        if (!(fabs(v[i].x) <= AISLE_SHAPE_COORD_MAX) || !(fabs(v[i].y) <= AISLE_SHAPE_COORD_MAX)) {
            return (int32_t)i;
        }
    }
    return -1;
}

static double farthest_vertex(const aisle_vehicle *self) {
    double farthest = 0.0;
    for (uint32_t i = 0; i < self->n; i++) {
        farthest = aisle_max(farthest, aisle_vec2_length(self->footprint[i]));
    }
    return farthest;
}

// Distance from the origin to the outline, negative outside. By segments, not by the lines of the sides: the line
// through two vertices a nanometre apart may point anywhere.
static double depth_of_origin(const aisle_vehicle *self) {
    const aisle_vec2 origin = {0.0, 0.0};
    const aisle_convex outline = {self->footprint, self->n, 0.0};
    const double gap = aisle_convex_point_gap(&outline, origin);
    double depth = AISLE_VEHICLE_VALUE_MAX;
    for (uint32_t i = 0; i < self->n; i++) {
        const aisle_vec2 next = self->footprint[(i + 1) % self->n];
        depth = aisle_min(depth, aisle_segment_gap(origin, origin, self->footprint[i], next));
    }
    return gap > 0.0 ? -gap : depth;
}

// Distance to the rim of a rounded outline: that to the outline plus the radius, inside and outside alike.
static void measure_radii(aisle_vehicle *self) {
    self->outer_radius = farthest_vertex(self) + self->radius;
    self->inner_radius = aisle_max(0.0, depth_of_origin(self) + self->radius);
}

static void take_vertices(const aisle_vehicle_msg *msg, aisle_vehicle *self) {
    static const aisle_vec2 usual[4] = {{-0.5, -0.35}, {0.5, -0.35}, {0.5, 0.35}, {-0.5, 0.35}};
    self->n = (uint32_t)msg->num_vertices;
    for (uint32_t i = 0; i < self->n; i++) {
        self->footprint[i] = aisle_vec2_of(msg->footprint[i][0], msg->footprint[i][1]);
    }
    if (self->n == 0 && self->radius > 0.0) {
        self->n = 1; // the point (0, 0): the struct starts zeroed
    } else if (self->n == 0) {
        self->n = 4;
        memcpy(self->footprint, usual, sizeof usual);
    }
}

static aisle_status take_footprint(const aisle_vehicle_msg *msg, aisle_vehicle *self, aisle_refusal *why) {
    const int16_t count = msg->num_vertices;
    if (count < 0 || count == 1 || count == 2 || count > AISLE_SHAPE_VERTICES_MAX) {
        return refuse(why, MEMBER_NUM_VERTICES, count);
    }
    const bool radius_is_fit = isfinite(msg->footprint_radius) && msg->footprint_radius >= 0.0F;
    self->radius = radius_is_fit ? (double)msg->footprint_radius : 0.0;
    take_vertices(msg, self);
    if (self->n > 1 && !aisle_convex_is_valid(self->footprint, self->n, AISLE_SHAPE_VERTICES_MAX)) {
        return refuse(why, MEMBER_FOOTPRINT, first_unfit_vertex(self->footprint, self->n));
    }
    measure_radii(self);
    if (farthest_vertex(self) > AISLE_VEHICLE_RADIUS_MAX) {
        return refuse(why, MEMBER_FOOTPRINT, self->outer_radius);
    }
    if (!radius_is_fit) {
        return refuse(why, MEMBER_FOOTPRINT_RADIUS, (double)msg->footprint_radius);
    }
    return self->outer_radius > AISLE_VEHICLE_RADIUS_MAX ? refuse(why, MEMBER_FOOTPRINT_RADIUS, self->outer_radius)
                                                         : AISLE_OK;
}

static aisle_status take_number(const aisle_vehicle_msg *msg, const number_row *row, aisle_vehicle *self,
                                aisle_refusal *why) {
    float value;
    memcpy(&value, (const char *)msg + row->in, sizeof value);
    const bool may_be_negative = row->member == MEMBER_MARGIN;
    if (!isfinite(value) || value > row->most || (value < 0.0F && !may_be_negative)) {
        return refuse(why, row->member, (double)value);
    }
    double taken = (double)value;
    if (value < 0.0F) {
        taken = 0.0;
    } else if (!(value > 0.0F)) {
        taken = (double)row->fallback;
    }
    memcpy((char *)self + row->out, &taken, sizeof taken);
    return AISLE_OK;
}

static aisle_status take_numbers(const aisle_vehicle_msg *msg, aisle_vehicle *self, aisle_refusal *why) {
    for (size_t i = 0; i < NUMBERS; i++) {
        const aisle_status status = take_number(msg, &numbers[i], self, why);
        if (status != AISLE_OK) {
            return status;
        }
    }
    if (!(msg->v_reverse_max > 0.0F)) {
        self->v_reverse_max = aisle_min(self->v_reverse_max, self->v_max);
    }
    self->creep_speed = aisle_min(self->creep_speed, self->v_max);
    return AISLE_OK;
}

aisle_status aisle_vehicle_from_msg(const aisle_vehicle_msg *msg, aisle_vehicle *out, aisle_refusal *why) {
    AISLE_ASSERT(msg != NULL && out != NULL && why != NULL);
    aisle_vehicle taken;
    memset(&taken, 0, sizeof taken);
    taken.revision = msg->vehicle_revision;
    taken.drive = msg->drive;
    if (msg->drive < AISLE_VEHICLE_DIFFERENTIAL || msg->drive > AISLE_VEHICLE_OMNI) {
        return refuse(why, MEMBER_DRIVE, msg->drive);
    }
    aisle_status status = take_footprint(msg, &taken, why);
    if (status == AISLE_OK) {
        status = take_numbers(msg, &taken, why);
    }
    if (status == AISLE_OK) {
        AISLE_ASSERT(taken.inner_radius <= taken.outer_radius && taken.outer_radius > 0.0);
        *out = taken;
    }
    return status;
}

aisle_convex aisle_vehicle_place(const aisle_vehicle *self, aisle_pose2 pose, double grow, aisle_vec2 *out) {
    AISLE_ASSERT(self->n >= 1 && self->n <= AISLE_SHAPE_VERTICES_MAX && self->radius + grow >= 0.0);
    aisle_convex_place(self->footprint, self->n, pose, out);
    return (aisle_convex){out, self->n, self->radius + grow};
}

// From the radius on a vehicle is doubles alone, so no padding is among them.
size_t aisle_vehicle_content(const aisle_vehicle *self, uint8_t *out) {
    const size_t numbers_at = offsetof(aisle_vehicle, radius);
    const size_t outline = self->n * sizeof self->footprint[0];
    AISLE_ASSERT(self->n <= AISLE_SHAPE_VERTICES_MAX && (sizeof *self - numbers_at) % sizeof(double) == 0U);
    out[0] = (uint8_t)self->drive;
    out[1] = (uint8_t)self->n;
    memcpy(out + 2U, self->footprint, outline);
    memcpy(out + 2U + outline, (const uint8_t *)self + numbers_at, sizeof *self - numbers_at);
    return 2U + outline + (sizeof *self - numbers_at);
}

bool aisle_vehicle_is_disc(const aisle_vehicle *self) {
    return self->n == 1;
}
