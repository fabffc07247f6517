#include "sim/host.h"

#include "base/check.h"

#include <lcm/lcm.h>
#include <poll.h>
#include <string.h>
#include <time.h>

#define BURST 8       // messages between two pauses: receivers' queues are short
#define PAUSE_US 2000 // and how long they are
#define QUEUE 512     // messages of a subscription in liblcm

static const aisle_channel outputs[] = {AISLE_CHANNEL_PATH, AISLE_CHANNEL_REPLY, AISLE_CHANNEL_STATUS,
                                        AISLE_CHANNEL_DIAG};
enum { OUTPUTS = sizeof outputs / sizeof outputs[0] };

static int64_t now_us(const aisle_sim_host *self) {
    return self->epoch_us + aisle_sim_host_wall_us() - self->start_us;
}

// The first path that rests on an input answers it.
static void note_answer(aisle_sim_host *self, const uint8_t *bytes, size_t size, int64_t now) {
    static aisle_path_msg path; // large; one thread
    if (aisle_msg_decode(AISLE_MSG_PATH, bytes, size, &path, NULL) != AISLE_OK) {
        return;
    }
    int64_t last = -1;
    for (uint32_t i = 0; i < AISLE_SIM_SENT_MAX; i++) {
        aisle_sim_sent *sent = &self->sent[i];
        if (sent->at_us > last && (sent->utime == path.pose_utime || sent->utime == path.obstacles_utime)) {
            last = sent->at_us;
        }
    }
    if (last >= 0) {
        aisle_histogram_add(&self->answers, now - last);
    }
    for (uint32_t i = 0; i < AISLE_SIM_SENT_MAX; i++) { // no later path answers these
        self->sent[i].at_us = self->sent[i].at_us <= last ? -1 : self->sent[i].at_us;
    }
}

static void on_message(const lcm_recv_buf_t *received, const char *name, void *user) {
    aisle_sim_host *self = user;
    int64_t now = now_us(self);
    aisle_channel channel = aisle_channel_find(self->prefix, name, strlen(name));
    if (received->data_size > AISLE_MSG_DATAGRAM_MAX || channel == AISLE_CHANNEL_COUNT) {
        return;
    }
    if (channel == AISLE_CHANNEL_PATH) {
        note_answer(self, received->data, received->data_size, now);
    }
    aisle_sim_host_write_log(self, now, channel, received->data, received->data_size);
    self->heard(self->ctx, channel, now, received->data, received->data_size);
}

static bool subscribe(aisle_sim_host *self, aisle_channel channel) {
    char name[AISLE_CHANNEL_NAME_LEN];
    aisle_channel_name(self->prefix, channel, name);
    lcm_subscription_t *handle = lcm_subscribe(self->lcm, name, on_message, self);
    return handle != NULL && lcm_subscription_set_queue_capacity(handle, QUEUE) == 0;
}

aisle_status aisle_sim_host_start_bus(aisle_sim_host *self, const char *url, const char *prefix, FILE *log,
                                      aisle_sim_heard heard, void *ctx, char *message) {
    memset(self, 0, sizeof *self);
    self->prefix = prefix;
    self->log = log;
    self->heard = heard;
    self->ctx = ctx;
    for (uint32_t i = 0; i < AISLE_SIM_SENT_MAX; i++) {
        self->sent[i].at_us = -1;
    }
    self->lcm = lcm_create(*url == '\0' ? NULL : url);
    bool good = self->lcm != NULL;
    for (int i = 0; i < OUTPUTS && good; i++) {
        good = subscribe(self, outputs[i]);
    }
    if (!good) {
        (void)snprintf(message, AISLE_SETTINGS_MESSAGE_LEN, "the bus cannot be joined: %s", url);
        aisle_sim_host_bus_stop(self);
        return AISLE_ERR_ARG;
    }
    self->fd = lcm_get_fileno(self->lcm);
    struct timespec t = {0, 0};
    (void)clock_gettime(CLOCK_REALTIME, &t);
    self->epoch_us = (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
    self->start_us = aisle_sim_host_wall_us();
    return AISLE_OK;
}

// Waits up to `us` for a message; true: one waits.
static bool wait_for_message(const aisle_sim_host *self, int64_t us) {
    struct pollfd p = {.fd = self->fd, .events = POLLIN, .revents = 0};
    return poll(&p, 1, (int)((us + 999) / 1000)) > 0 && (p.revents & POLLIN) != 0;
}

void aisle_sim_host_bus_advance(aisle_sim_host *self, int64_t utime) {
    for (;;) {
        int64_t left = utime - now_us(self);
        if (!wait_for_message(self, left > 0 ? left : 0)) {
            if (utime <= now_us(self)) {
                return;
            }
        } else if (lcm_handle(self->lcm) != 0) {
            self->failed = true;
            return;
        }
    }
}

static void note_sent(aisle_sim_host *self, aisle_channel channel, const uint8_t *bytes) {
    if (channel != AISLE_CHANNEL_POSE && channel != AISLE_CHANNEL_OBSTACLES) {
        return;
    }
    uint64_t utime = 0; // the first member, big-endian
    for (size_t i = 0; i < 8; i++) {
        utime = utime << 8U | bytes[AISLE_MSG_FINGERPRINT_SIZE + i];
    }
    self->sent[self->num_sent++ % AISLE_SIM_SENT_MAX] =
        (aisle_sim_sent){.utime = (int64_t)utime, .at_us = now_us(self)};
}

void aisle_sim_host_bus_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                             size_t size) {
    char name[AISLE_CHANNEL_NAME_LEN];
    AISLE_ASSERT(size > AISLE_MSG_FINGERPRINT_SIZE + 8U && size <= AISLE_MSG_DATAGRAM_MAX);
    aisle_sim_host_bus_advance(self, utime);
    aisle_channel_name(self->prefix, channel, name);
    note_sent(self, channel, bytes);
    aisle_sim_host_write_log(self, now_us(self), channel, bytes, size);
    if (lcm_publish(self->lcm, name, bytes, (unsigned int)size) != 0) {
        self->failed = true;
    }
    if (++self->burst % BURST == 0) {
        struct timespec pause = {0, PAUSE_US * 1000};
        (void)nanosleep(&pause, NULL);
    }
}

void aisle_sim_host_bus_stop(aisle_sim_host *self) {
    if (self->lcm != NULL) {
        lcm_destroy(self->lcm);
    }
    self->lcm = NULL;
}
