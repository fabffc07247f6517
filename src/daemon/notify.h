// notify.h - tells systemd that the daemon is ready, alive and stopping, without libsystemd. Level 5.
//
// Protocol: sd_notify(3), one datagram per message to the socket named by NOTIFY_SOCKET ('@' in front: abstract).
// Memory: the struct and one socket. Nothing blocks, nothing fails loudly: without systemd all calls do nothing.
#ifndef AISLE_DAEMON_NOTIFY_H
#define AISLE_DAEMON_NOTIFY_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/socket.h>
#include <sys/un.h>

typedef struct aisle_notify {
    int fd; // -1: nobody to tell
    struct sockaddr_un address;
    socklen_t address_len;
    int64_t period_us; // of watchdog pings; 0 = no watchdog
    int64_t next_us;   // monotonic time of the next one
} aisle_notify;

// The values of NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID, each may be NULL. False: socket_name is not one (all
// calls then do nothing). A watchdog meant for another process is not served. Pings are due every half of
// WATCHDOG_USEC.
bool aisle_notify_open(aisle_notify *self, const char *socket_name, const char *watchdog_usec,
                       const char *watchdog_pid);

// Sends e.g. "READY=1". False: not sent.
bool aisle_notify_send(const aisle_notify *self, const char *text);

// Sends WATCHDOG=1 if due at now_us and the caller got on since the last one. True: it was sent.
bool aisle_notify_ping(aisle_notify *self, int64_t now_us, bool progress);

void aisle_notify_close(aisle_notify *self);
#endif
