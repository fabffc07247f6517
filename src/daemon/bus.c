#include "daemon/bus.h"

#include "base/check.h"

#include <errno.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <string.h>

static void tell(aisle_bus *self, aisle_bus_fault_kind fault, aisle_channel channel) {
    self->fault_count++;
    self->fault = fault;
    self->fault_channel = channel;
}

// liblcm may say 4294967285 bytes for a hostile packet: nothing is read before inbox_put() has judged the size.
static void on_message(const lcm_recv_buf_t *received, const char *name, void *user) {
    aisle_bus_subscription *subscription = user;
    aisle_bus *self = subscription->bus;
    (void)name;
    aisle_status status =
        aisle_inbox_put(self->inbox, subscription->channel, received->recv_utime, received->data, received->data_size);
    if (status == AISLE_ERR_DATA) {
        tell(self, AISLE_BUS_OVERSIZE, subscription->channel);
    } else if (status == AISLE_ERR_CAPACITY) {
        tell(self, AISLE_BUS_FULL, subscription->channel);
    }
    if (++subscription->burst == AISLE_BUS_QUEUE) {
        self->flooded++;
        tell(self, AISLE_BUS_FLOODED, subscription->channel);
    }
}

static bool subscribe(aisle_bus *self, aisle_channel channel) {
    aisle_bus_subscription *subscription = &self->subscriptions[channel];
    *subscription = (aisle_bus_subscription){.bus = self, .channel = channel};
    lcm_subscription_t *handle = lcm_subscribe(self->lcm, self->names[channel], on_message, subscription);
    return handle != NULL && lcm_subscription_set_queue_capacity(handle, AISLE_BUS_QUEUE) == 0;
}

aisle_status aisle_bus_open(aisle_bus *self, const char *url, const char *prefix, aisle_inbox *inbox) {
    memset(self, 0, sizeof *self);
    self->fd = -1;
    self->inbox = inbox;
    self->lcm = lcm_create(*url == '\0' ? NULL : url);
    bool ok = self->lcm != NULL;
    for (int i = 0; ok && i < (int)AISLE_CHANNEL_COUNT; i++) {
        aisle_channel_name(prefix, (aisle_channel)i, self->names[i]);
        ok = i >= AISLE_CHANNEL_INPUTS || subscribe(self, (aisle_channel)i);
    }
    if (ok) {
        self->fd = lcm_get_fileno(self->lcm);
    }
    if (self->fd < 0) {
        aisle_bus_close(self);
        return AISLE_ERR_ARG;
    }
    return AISLE_OK;
}

int aisle_bus_fd(const aisle_bus *self) {
    return self->fd;
}

static bool readable(int fd) {
    struct pollfd p = {.fd = fd, .events = POLLIN, .revents = 0};
    return poll(&p, 1, 0) > 0 && (p.revents & POLLIN) != 0;
}

int aisle_bus_drain(aisle_bus *self) {
    int count = 0;
    bool more = readable(self->fd);
    for (; more && count < AISLE_BUS_DRAIN_MAX; count++) {
        if (lcm_handle(self->lcm) != 0) {
            return -1;
        }
        more = readable(self->fd);
    }
    for (int i = 0; !more && i < AISLE_CHANNEL_INPUTS; i++) {
        self->subscriptions[i].burst = 0;
    }
    return count;
}

aisle_status aisle_bus_publish(aisle_bus *self, aisle_channel channel, const void *bytes, size_t size) {
    AISLE_ASSERT((int)channel >= AISLE_CHANNEL_INPUTS && channel < AISLE_CHANNEL_COUNT &&
                 size <= AISLE_MSG_DATAGRAM_MAX);
    bool sent = lcm_publish(self->lcm, self->names[channel], bytes, (unsigned int)size) == 0;
    self->published += sent ? 1 : 0;
    self->failed += sent ? 0 : 1;
    return sent ? AISLE_OK : AISLE_ERR_DATA;
}

void aisle_bus_close(aisle_bus *self) {
    if (self->lcm != NULL) {
        lcm_destroy(self->lcm);
    }
    self->lcm = NULL;
    self->fd = -1;
}
