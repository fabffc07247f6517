#include "fake_planner.h"

#include "base/check.h"
#include "wire/codec.h"

#include <string.h>

enum { QUEUE_MAX = 64 };

typedef struct request {
    aisle_input_kind kind;
    int32_t id, revision;
    uint32_t left; // work units
} request;

struct aisle_planner {
    request queue[QUEUE_MAX];
    uint32_t waiting;
    uint32_t building; // work units left of a layout
    uint32_t cycle;    // and of a cycle
    int64_t counters[AISLE_COUNTER_COUNT];
    int64_t now, next_lease;
    int32_t path_revision;
    bool path_held, event_waits, event_is_path;
    aisle_path_msg path;
};

fake_planner fake;
static uint8_t event_bytes[AISLE_MSG_DATAGRAM_MAX];

void fake_reset(void) {
    memset(&fake, 0, sizeof fake);
}

size_t aisle_planner_memsize(const aisle_limits *limits) {
    return limits->requests > 64U ? 0 : FAKE_MEMSIZE;
}

static struct aisle_planner the_planner;

aisle_status aisle_planner_init(void *memory, size_t size, const aisle_config *config, aisle_planner **planner) {
    if (memory == NULL || size < FAKE_MEMSIZE || config->vehicle.drive == AISLE_VEHICLE_OMNI) {
        return AISLE_ERR_ARG;
    }
    memset(&the_planner, 0, sizeof the_planner);
    fake.config = *config;
    *planner = &the_planner;
    return AISLE_OK;
}

static int32_t id_of(const aisle_input *input) {
    switch (input->kind) {
    case AISLE_INPUT_LAYOUT:
        return input->as.layout->part;
    case AISLE_INPUT_LAYOUT_PATCH:
        return input->as.layout_patch->map_revision;
    case AISLE_INPUT_GRID:
        return input->as.grid->part;
    case AISLE_INPUT_VEHICLE:
        return input->as.vehicle->vehicle_revision;
    case AISLE_INPUT_POSE:
        return input->as.pose->seq;
    case AISLE_INPUT_GOALS:
        return input->as.goals->goal_list_id;
    case AISLE_INPUT_QUERY:
        return input->as.query->query_id;
    case AISLE_INPUT_OBSTACLES:
        return input->as.obstacles->seq;
    case AISLE_INPUT_ARM_GOAL:
        return input->as.arm_goal->arm_goal_id;
    case AISLE_INPUT_COMMAND:
    default:
        return input->as.command->command_id;
    }
}

aisle_status aisle_planner_submit(aisle_planner *self, int64_t now_us, const aisle_input *input) {
    if (input->kind == AISLE_INPUT_LAYOUT && self->building > 0) {
        return AISLE_BUSY;
    }
    bool asks = fake.units_per_cycle > 0 && (input->kind == AISLE_INPUT_POSE || input->kind == AISLE_INPUT_OBSTACLES);
    bool is_request = input->kind == AISLE_INPUT_QUERY || input->kind == AISLE_INPUT_GOALS;
    uint32_t most = fake.requests_max == 0 ? 4U : fake.requests_max;
    if (fake.busy_always || (is_request && self->waiting == most) || (asks && self->cycle > 0)) {
        return AISLE_BUSY;
    }
    if (fake.refuse_all) {
        self->counters[AISLE_COUNTER_REJECTED]++;
        return AISLE_ERR_DATA;
    }
    AISLE_ASSERT(fake.num_taken < FAKE_LOG_MAX);
    fake.taken[fake.num_taken++] = (fake_taken){.kind = input->kind, .id = id_of(input), .now_us = now_us};
    self->now = now_us;
    self->counters[AISLE_COUNTER_INPUTS]++;
    if (input->kind == AISLE_INPUT_LAYOUT) {
        self->building = fake.units_per_layout;
    }
    if (asks) {
        self->counters[AISLE_COUNTER_CYCLE_INPUTS]++;
        self->cycle = fake.units_per_cycle;
    }
    if (is_request) {
        self->queue[self->waiting++] =
            (request){.kind = input->kind,
                      .id = id_of(input),
                      .revision = input->kind == AISLE_INPUT_GOALS ? input->as.goals->goal_list_revision : 0,
                      .left = fake.units_per_request == 0 ? 10U : fake.units_per_request};
    }
    return AISLE_OK;
}

static void answer(aisle_planner *self, const request *r) {
    bool goals = r->kind == AISLE_INPUT_GOALS;
    self->path = (aisle_path_msg){.utime = self->now,
                                  .boot_id = fake.config.boot_id,
                                  .query_id = goals ? 0 : r->id,
                                  .goal_list_id = goals ? r->id : 0,
                                  .goal_list_revision = r->revision,
                                  .path_revision = goals ? ++self->path_revision : 0,
                                  .valid_until_utime = self->now + AISLE_LEASE_US,
                                  .status = fake.give_paths ? AISLE_PATH_OK : AISLE_PATH_NONE,
                                  .cause = fake.give_paths ? 0 : AISLE_STATUS_NO_LAYOUT,
                                  .work_units = (int32_t)fake.units_per_request,
                                  .length = 3.0F,
                                  .certificate = r->id * 7,
                                  .num_waypoints = fake.give_paths ? 2 : 0};
    self->path.waypoints[1].x = (double)r->id;
    self->event_waits = true;
    self->event_is_path = goals;
    self->path_held = self->path_held || goals;
    self->next_lease = self->now + fake.lease_us;
    fake.answered++;
}

static void work(aisle_planner *self, uint32_t work_units) {
    request *first = &self->queue[0];
    uint32_t done = first->left < work_units ? first->left : work_units;
    first->left -= done;
    self->counters[AISLE_COUNTER_WORK_UNITS] += done;
    if (first->left == 0) {
        answer(self, first);
        self->waiting--;
        memmove(self->queue, self->queue + 1, self->waiting * sizeof self->queue[0]);
    }
}

static void work_on_cycle(aisle_planner *self, uint32_t work_units) {
    const uint32_t done = self->cycle < work_units ? self->cycle : work_units;
    self->cycle -= done;
    self->counters[AISLE_COUNTER_WORK_UNITS] += done;
    if (self->cycle == 0) {
        self->counters[AISLE_COUNTER_CYCLES]++;
        self->path.path_revision = self->path_revision += fake.cycle_changes ? 1 : 0;
        self->event_waits = self->event_is_path = fake.cycle_changes || fake.cycle_renews;
    }
}

aisle_status aisle_planner_step(aisle_planner *self, int64_t now_us, uint32_t work_units) {
    self->now = now_us > self->now ? now_us : self->now;
    fake.steps++;
    if (fake.on_step != NULL) {
        fake.on_step(work_units);
    }
    if (fake.hang) {
        return AISLE_BUSY;
    }
    if (self->building > 0) {
        self->building -= self->building < work_units ? self->building : work_units;
        self->counters[AISLE_COUNTER_LAYOUTS] += self->building == 0 ? 1 : 0;
        return AISLE_BUSY;
    }
    if (!self->event_waits && self->cycle > 0) {
        work_on_cycle(self, work_units);
    } else if (!self->event_waits && self->waiting > 0) {
        work(self, work_units);
    } else if (fake.lease_us > 0 && self->path_held && self->now >= self->next_lease) {
        self->path.utime = self->now;
        self->path.valid_until_utime = self->now + AISLE_LEASE_US;
        self->event_waits = self->event_is_path = true;
        self->next_lease = self->now + fake.lease_us;
    }
    return self->event_waits || self->cycle > 0 || self->waiting > 0 ? AISLE_BUSY : AISLE_OK;
}

bool aisle_planner_next_event(aisle_planner *self, aisle_event *event) {
    if (!self->event_waits) {
        return false;
    }
    self->event_waits = false;
    size_t size = 0;
    aisle_status status = aisle_msg_encode(AISLE_MSG_PATH, &self->path, event_bytes, sizeof event_bytes, &size);
    AISLE_ASSERT(status == AISLE_OK);
    *event = (aisle_event){
        .kind = self->event_is_path ? AISLE_EVENT_PATH : AISLE_EVENT_REPLY, .bytes = event_bytes, .size = size};
    return true;
}

int64_t aisle_planner_next_deadline(const aisle_planner *self) {
    return fake.lease_us > 0 && self->path_held ? self->next_lease : INT64_MAX;
}

void aisle_planner_status(const aisle_planner *self, int64_t now_us, aisle_status_msg *status) {
    (void)self;
    *status = fake.status;
    status->utime = now_us;
    status->boot_id = fake.config.boot_id;
}

const int64_t *aisle_planner_counters(const aisle_planner *self) {
    return self->counters;
}

size_t aisle_planner_memory(const aisle_planner *self, aisle_memory_row *rows, size_t capacity) {
    (void)self;
    if (capacity >= 2) {
        rows[0] = (aisle_memory_row){.name = "grid", .bytes = FAKE_MEMSIZE - 192U, .used_max = 100};
        rows[1] = (aisle_memory_row){.name = "rest", .bytes = 192, .used_max = 0};
    }
    return 2;
}

const char *aisle_cause_name(int16_t cause) {
    return cause == AISLE_STATUS_NO_LAYOUT ? "NO_LAYOUT" : "CAUSE";
}
