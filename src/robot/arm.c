#include "robot/arm.h"

#include "base/angle.h"
#include "base/check.h"

#include <stddef.h>
#include <string.h>

#define MEMBER_NUM_LINKS 24 // places in vehicle_t
#define MEMBER_BASE 25
#define MEMBER_JOINT_MIN 29
#define MEMBER_JOINT_MAX 30
#define HEADINGS 48U      // of the tip that are tried where any will do
#define JOINT_SLACK 1e-9  // rad: what rounding may put beyond a limit is moved back to it
#define REACH_SLACK 1e-12 // m, of links stretched out

// ---- from the message

typedef struct number_row { // floats of vehicle_t, one a link, that become doubles
    size_t in, out;         // offsets
    float fallback;         // for 0
    float most;
    int32_t member;
} number_row;

#define NUMBER(place, theirs, ours, fallback, most)                                                                    \
    { offsetof(aisle_vehicle_msg, theirs), offsetof(aisle_arm, ours), (fallback), (float)(most), (place) }

static const number_row numbers[] = {
    NUMBER(26, link_length, length, 0.4F, AISLE_ARM_LENGTH_MAX),
    NUMBER(27, link_radius, radius, 0.04F, AISLE_ARM_LENGTH_MAX),
    NUMBER(28, link_mass, mass, 2.0F, AISLE_ARM_VALUE_MAX),
    NUMBER(31, joint_v_max, v_max, 1.5F, AISLE_ARM_VALUE_MAX),
    NUMBER(32, joint_a_max, a_max, 3.0F, AISLE_ARM_VALUE_MAX),
    NUMBER(33, joint_j_max, j_max, 30.0F, AISLE_ARM_VALUE_MAX),
    NUMBER(34, joint_torque_max, torque_max, 100.0F, AISLE_ARM_VALUE_MAX),
};

static aisle_status refuse(aisle_refusal *why, int32_t member, double value) {
    *why = (aisle_refusal){.cause = AISLE_STATUS_MALFORMED, .id = member, .value = (float)value};
    return AISLE_ERR_DATA;
}

static aisle_status take_number(const aisle_vehicle_msg *msg, const number_row *row, aisle_arm *self,
                                aisle_refusal *why) {
    for (uint32_t i = 0; i < self->links; i++) {
        float value;
        memcpy(&value, (const char *)msg + row->in + i * sizeof value, sizeof value);
        if (!isfinite(value) || value < 0.0F || value > row->most) {
            return refuse(why, row->member, (double)value);
        }
        const double taken = value > 0.0F ? (double)value : (double)row->fallback;
        memcpy((char *)self + row->out + i * sizeof taken, &taken, sizeof taken);
    }
    return AISLE_OK;
}

static bool is_angle(float value) { // written so that NaN fails
    return fabs((double)value) <= AISLE_ARM_ANGLE_MAX;
}

static aisle_status take_joints(const aisle_vehicle_msg *msg, aisle_arm *self, aisle_refusal *why) {
    for (uint32_t i = 0; i < self->links; i++) {
        const float lo = msg->joint_min[i], hi = msg->joint_max[i];
        if (!is_angle(lo)) {
            return refuse(why, MEMBER_JOINT_MIN, (double)lo);
        }
        const bool are_usual = fabs((double)lo) <= 0.0 && fabs((double)hi) <= 0.0;
        if (!is_angle(hi) || (hi <= lo && !are_usual)) {
            return refuse(why, MEMBER_JOINT_MAX, (double)hi);
        }
        self->min[i] = are_usual ? -AISLE_PI : (double)lo;
        self->max[i] = are_usual ? AISLE_PI : (double)hi;
    }
    return AISLE_OK;
}

static aisle_status take_base(const aisle_vehicle_msg *msg, aisle_arm *self, aisle_refusal *why) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(msg->arm_base[i]) <= (i < 2 ? AISLE_ARM_LENGTH_MAX : AISLE_ARM_ANGLE_MAX))) {
            return refuse(why, MEMBER_BASE, msg->arm_base[i]);
        }
    }
    self->base = (aisle_pose2){msg->arm_base[0], msg->arm_base[1], msg->arm_base[2]};
    return AISLE_OK;
}

aisle_status aisle_arm_from_msg(const aisle_vehicle_msg *msg, aisle_arm *out, aisle_refusal *why) {
    AISLE_ASSERT(msg != NULL && out != NULL && why != NULL);
    aisle_arm taken;
    memset(&taken, 0, sizeof taken);
    if (msg->num_links < 0 || msg->num_links > AISLE_VEHICLE_MAX_LINKS) {
        return refuse(why, MEMBER_NUM_LINKS, msg->num_links);
    }
    taken.links = (uint32_t)msg->num_links;
    aisle_status status = taken.links > 0U ? take_base(msg, &taken, why) : AISLE_OK;
    for (size_t i = 0; status == AISLE_OK && i < sizeof numbers / sizeof numbers[0]; i++) {
        status = take_number(msg, &numbers[i], &taken, why);
    }
    if (status == AISLE_OK) {
        status = take_joints(msg, &taken, why);
    }
    if (status == AISLE_OK) {
        *out = taken;
    }
    return status;
}

// ---- kinematics

aisle_pose2 aisle_arm_base(const aisle_arm *self, aisle_pose2 vehicle) {
    double s, c;
    aisle_sincos(vehicle.theta, &s, &c);
    return (aisle_pose2){vehicle.x + c * self->base.x - s * self->base.y,
                         vehicle.y + s * self->base.x + c * self->base.y, vehicle.theta + self->base.theta};
}

double aisle_arm_place(const aisle_arm *self, aisle_pose2 base, const double *q, aisle_vec2 *points) {
    double direction = base.theta;
    points[0] = aisle_vec2_of(base.x, base.y);
    for (uint32_t i = 0; i < self->links; i++) {
        double s, c;
        direction += q[i];
        aisle_sincos(direction, &s, &c);
        points[i + 1U] = aisle_vec2_add(points[i], aisle_vec2_scale(aisle_vec2_of(c, s), self->length[i]));
    }
    return direction;
}

void aisle_arm_jacobian(const aisle_arm *self, aisle_pose2 base, const double *q, aisle_vec2 *jacobian) {
    aisle_vec2 points[AISLE_ARM_LINKS + 1U];
    (void)aisle_arm_place(self, base, q, points);
    for (uint32_t j = 0; j < self->links; j++) {
        const aisle_vec2 lever = aisle_vec2_sub(points[self->links], points[j]);
        jacobian[j] = aisle_vec2_of(-lever.y, lever.x);
    }
}

double aisle_arm_reach(const aisle_arm *self, uint32_t joint, uint32_t link) {
    double sum = 0.0;
    AISLE_ASSERT(joint <= link && link < self->links);
    for (uint32_t i = joint; i <= link; i++) {
        sum += self->length[i];
    }
    return sum;
}

uint32_t aisle_arm_joint_out(const aisle_arm *self, const double *q, double slack) {
    for (uint32_t i = 0; i < self->links; i++) {
        if (!(q[i] >= self->min[i] - slack && q[i] <= self->max[i] + slack)) {
            return i + 1U;
        }
    }
    return 0U;
}

void aisle_arm_stow(const aisle_arm *self, double *q) {
    for (uint32_t i = 0; i < self->links; i++) {
        q[i] = aisle_clamp(0.0, self->min[i], self->max[i]);
    }
}

// ---- inverse kinematics

typedef struct solver {
    const aisle_arm *arm;
    const double *from;
    aisle_arm_solutions *out;
    double travel[AISLE_ARM_SOLUTIONS_MAX]; // of each in out
    double least_out;                       // rad, that a way is out of a joint's limits by, of the best such
} solver;

// Angles of joint j that are `angle` but for whole turns, within limits: the one or two nearest to where it is.
static uint32_t turns(const solver *self, uint32_t j, double angle, double *out) {
    const double lo = self->arm->min[j] - JOINT_SLACK, hi = self->arm->max[j] + JOINT_SLACK;
    const double turn = 2.0 * AISLE_PI, near = angle + turn * floor((self->from[j] - angle) / turn);
    uint32_t count = 0;
    const double first = near + turn <= hi ? near + turn : angle + turn * floor((hi - angle) / turn);
    for (double q = first; q >= lo && count < 2U; q -= turn) {
        out[count++] = aisle_clamp(q, self->arm->min[j], self->arm->max[j]);
    }
    if (count == 0U && near + turn < lo) { // it is below its limits
        const double up = angle - turn * floor((angle - lo) / turn);
        if (up <= hi) {
            out[count++] = aisle_clamp(up, self->arm->min[j], self->arm->max[j]);
        }
    }
    return count;
}

static void insert(solver *self, const double *q) {
    aisle_arm_solutions *out = self->out;
    double travel = 0.0;
    for (uint32_t j = 0; j < self->arm->links; j++) {
        travel += fabs(q[j] - self->from[j]);
    }
    uint32_t at = out->count;
    while (at > 0U && travel < self->travel[at - 1U]) {
        at--;
    }
    if (at == AISLE_ARM_SOLUTIONS_MAX) {
        return;
    }
    out->count += out->count < AISLE_ARM_SOLUTIONS_MAX ? 1U : 0U;
    for (uint32_t i = out->count - 1U; i > at; i--) {
        memcpy(out->q[i], out->q[i - 1U], sizeof out->q[0]);
        self->travel[i] = self->travel[i - 1U];
    }
    memset(out->q[at], 0, sizeof out->q[0]);
    memcpy(out->q[at], q, self->arm->links * sizeof *q);
    self->travel[at] = travel;
}

// One way to the target but for whole turns; every combination of turns within limits becomes a solution.
static void offer(solver *self, const double *angles) {
    double choice[AISLE_ARM_LINKS][2];
    uint32_t count[AISLE_ARM_LINKS] = {1, 1, 1}, all = 1;
    for (uint32_t j = 0; j < self->arm->links; j++) {
        const double angle = aisle_angle_wrap(angles[j]);
        count[j] = turns(self, j, angle, choice[j]);
        if (count[j] == 0U) {
            const double out = aisle_min(fabs(aisle_angle_difference(angle, self->arm->min[j])),
                                         fabs(aisle_angle_difference(angle, self->arm->max[j])));
            if (out < self->least_out) {
                self->least_out = out;
                self->out->joint = j + 1U;
            }
            return;
        }
        all *= count[j];
    }
    for (uint32_t n = 0; n < all; n++) {
        double q[AISLE_ARM_LINKS] = {0.0, 0.0, 0.0};
        uint32_t rest = n;
        for (uint32_t j = 0; j < self->arm->links; j++) {
            q[j] = choice[j][rest % count[j]];
            rest /= count[j];
        }
        insert(self, q);
    }
}

static void note_miss(solver *self, double miss) {
    self->out->miss = self->out->miss > 0.0 ? aisle_min(self->out->miss, miss) : miss;
}

// Moves p (in the base's frame) to where `count` links reach it, if it is at most `tolerance` off.
static bool pull_into_reach(solver *self, uint32_t count, double tolerance, aisle_vec2 *p) {
    double sum = 0.0, longest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += self->arm->length[i];
        longest = aisle_max(longest, self->arm->length[i]);
    }
    const double least = aisle_max(0.0, 2.0 * longest - sum), d = aisle_vec2_length(*p);
    const double kept = aisle_clamp(d, least, sum);
    if (fabs(d - kept) > tolerance) {
        note_miss(self, fabs(d - kept));
        return false;
    }
    *p = d > 0.0 ? aisle_vec2_scale(*p, kept / d) : aisle_vec2_of(kept, 0.0);
    return true;
}

// Joint angles of the first two links for their end to be at p; elbow 1 or -1. False: out of reach.
static bool bend(const aisle_arm *arm, aisle_vec2 p, double elbow, double *q) {
    const double a = arm->length[0], b = arm->length[1], d = aisle_vec2_length(p);
    if (d > a + b + REACH_SLACK * (a + b) || d < fabs(a - b) - REACH_SLACK * (a + b)) {
        return false;
    }
    const double cosine = aisle_clamp((d * d - a * a - b * b) / (2.0 * a * b), -1.0, 1.0); // a, b > 0
    const double sine = elbow * sqrt(1.0 - cosine * cosine);
    q[0] = aisle_atan2(p.y, p.x) - aisle_atan2(b * sine, a + b * cosine);
    q[1] = aisle_atan2(sine, cosine);
    return true;
}

static void solve_one(solver *self, aisle_vec2 p, const aisle_arm_target *target, double theta) {
    double q[AISLE_ARM_LINKS] = {aisle_atan2(p.y, p.x), 0.0, 0.0};
    const double off = target->has_theta ? fabs(aisle_angle_difference(q[0], theta)) : 0.0;
    if (off > target->tolerance_theta) {
        note_miss(self, off * self->arm->length[0]);
    } else {
        offer(self, q);
    }
}

static void solve_two(solver *self, aisle_vec2 p, const aisle_arm_target *target, double theta) {
    for (int side = 0; side < 2; side++) {
        double q[AISLE_ARM_LINKS] = {0.0, 0.0, 0.0};
        if (!bend(self->arm, p, side == 0 ? 1.0 : -1.0, q)) {
            continue;
        }
        const double off = target->has_theta ? fabs(aisle_angle_difference(aisle_angle_wrap(q[0] + q[1]), theta)) : 0.0;
        if (off > target->tolerance_theta) {
            note_miss(self, off * self->arm->length[1]);
        } else {
            offer(self, q);
        }
    }
}

// Three links with the tip pointing to `theta`, the wrist at most `tolerance` beside its place.
static void solve_three(solver *self, aisle_vec2 p, double theta, double tolerance) {
    double s, c;
    aisle_sincos(theta, &s, &c);
    aisle_vec2 wrist = aisle_vec2_sub(p, aisle_vec2_scale(aisle_vec2_of(c, s), self->arm->length[2]));
    if (!pull_into_reach(self, 2U, tolerance, &wrist)) {
        return;
    }
    for (int side = 0; side < 2; side++) {
        double q[AISLE_ARM_LINKS];
        if (bend(self->arm, wrist, side == 0 ? 1.0 : -1.0, q)) {
            q[2] = theta - q[0] - q[1];
            offer(self, q);
        }
    }
}

// Any direction: that of the way there and back, where links stretched out or folded must lie, the present one, and a fan.
static void solve_fan(solver *self, aisle_vec2 p) {
    const double straight = aisle_atan2(p.y, p.x), now = self->from[0] + self->from[1] + self->from[2];
    const double tolerance = REACH_SLACK * aisle_arm_reach(self->arm, 0, 2);
    solve_three(self, p, straight, tolerance);
    solve_three(self, p, straight + AISLE_PI, tolerance);
    solve_three(self, p, aisle_angle_wrap(now), tolerance);
    for (uint32_t i = 0; i < HEADINGS; i++) {
        solve_three(self, p, straight + ((double)i + 0.5) * 2.0 * AISLE_PI / (double)HEADINGS, tolerance);
    }
}

void aisle_arm_solve(const aisle_arm *self, aisle_pose2 base, const aisle_arm_target *target, const double *from,
                     aisle_arm_solutions *out) {
    double s, c;
    memset(out, 0, sizeof *out);
    solver run = {.arm = self, .from = from, .out = out, .least_out = (double)INFINITY};
    const aisle_vec2 d = {target->at.x - base.x, target->at.y - base.y};
    aisle_sincos(base.theta, &s, &c);
    aisle_vec2 p = {c * d.x + s * d.y, c * d.y - s * d.x};
    const double theta = target->has_theta ? aisle_angle_wrap(target->theta - base.theta) : 0.0;
    if (self->links == 3U && target->has_theta) {
        solve_three(&run, p, theta, target->tolerance_xy);
    } else if (pull_into_reach(&run, self->links, target->tolerance_xy, &p)) {
        if (self->links == 3U) {
            solve_fan(&run, p);
            out->miss = 0.0; // of single directions
        } else if (self->links == 2U) {
            solve_two(&run, p, target, theta);
        } else {
            solve_one(&run, p, target, theta);
        }
    }
    out->miss = out->count > 0U ? 0.0 : out->miss;
}
