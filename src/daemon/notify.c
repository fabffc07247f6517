#include "daemon/notify.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A positive decimal number, or 0.
static int64_t parse_positive(const char *text) {
    if (text == NULL || *text < '0' || *text > '9') {
        return 0;
    }
    char *end = NULL;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    return errno == 0 && *end == '\0' && value > 0 ? (int64_t)value : 0;
}

bool aisle_notify_open(aisle_notify *self, const char *socket_name, const char *watchdog_usec,
                       const char *watchdog_pid) {
    *self = (aisle_notify){.fd = -1};
    size_t length = socket_name == NULL ? 0 : strlen(socket_name);
    if (length < 2 || length >= sizeof self->address.sun_path || (socket_name[0] != '/' && socket_name[0] != '@')) {
        return false;
    }
    self->address.sun_family = AF_UNIX;
    memcpy(self->address.sun_path, socket_name, length);
    if (socket_name[0] == '@') {
        self->address.sun_path[0] = '\0';
    }
    self->address_len = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    self->fd = socket(AF_UNIX, SOCK_DGRAM, 0);
    if (self->fd < 0 || fcntl(self->fd, F_SETFD, FD_CLOEXEC) != 0) {
        return false;
    }
    bool ours = watchdog_pid == NULL || parse_positive(watchdog_pid) == (int64_t)getpid();
    self->period_us = ours ? parse_positive(watchdog_usec) / 2 : 0;
    return true;
}

bool aisle_notify_send(const aisle_notify *self, const char *text) {
    if (self->fd < 0) {
        return false;
    }
    size_t length = strlen(text);
    ssize_t sent = sendto(self->fd, text, length, MSG_NOSIGNAL | MSG_DONTWAIT, (const struct sockaddr *)&self->address,
                          self->address_len);
    return sent == (ssize_t)length;
}

bool aisle_notify_ping(aisle_notify *self, int64_t now_us, bool progress) {
    if (self->period_us == 0 || now_us < self->next_us || !progress) {
        return false;
    }
    self->next_us = now_us + self->period_us;
    return aisle_notify_send(self, "WATCHDOG=1");
}

void aisle_notify_close(aisle_notify *self) {
    if (self->fd >= 0) {
        (void)close(self->fd);
    }
    self->fd = -1;
    self->period_us = 0;
}
