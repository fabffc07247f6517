#include "sim/host.h"

#include "base/check.h"

#include <lcm/lcm.h>
#include <poll.h>
#include <string.h>
#include <time.h>

#define BURST 8       // messages between two pauses, of the computer's or ours: receivers' queues are short
#define PAUSE_US 2000 // and how long they are
#define QUEUE 512     // messages of a subscription in liblcm

static const aisle_channel outputs[] = {AISLE_CHANNEL_PATH, AISLE_CHANNEL_REPLY, AISLE_CHANNEL_STATUS,
                                        AISLE_CHANNEL_DIAG};
enum { OUTPUTS = sizeof outputs / sizeof outputs[0] };

static int64_t now_us(const aisle_sim_host *self) {
    return self->epoch_us + aisle_sim_host_wall_us() - self->start_us;
}

static void on_message(const lcm_recv_buf_t *received, const char *name, void *user) {
    aisle_sim_host *self = user;
    int64_t now = now_us(self);
    aisle_channel channel = aisle_channel_find(self->prefix, name, strlen(name));
    if (received->data_size > AISLE_MSG_DATAGRAM_MAX || channel == AISLE_CHANNEL_COUNT) {
        return;
    }
    if (channel == AISLE_CHANNEL_DIAG) {
        (void)aisle_msg_decode(AISLE_MSG_DIAG, received->data, received->data_size, &self->told, NULL);
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
    self->burst = utime - now_us(self) < PAUSE_US ? self->burst : 0;
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

void aisle_sim_host_bus_send(aisle_sim_host *self, int64_t utime, aisle_channel channel, const uint8_t *bytes,
                             size_t size) {
    char name[AISLE_CHANNEL_NAME_LEN];
    AISLE_ASSERT(size <= AISLE_MSG_DATAGRAM_MAX);
    aisle_sim_host_bus_advance(self, utime);
    aisle_channel_name(self->prefix, channel, name);
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
