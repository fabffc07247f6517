// options.h - command lines: --name, --name VALUE, --name=VALUE and plain arguments. Level 5.
#ifndef AISLE_DAEMON_OPTIONS_H
#define AISLE_DAEMON_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#define AISLE_OPTIONS_MESSAGE_LEN 256

// Exactly one of flag and value is not NULL.
typedef struct aisle_option {
    const char *name;   // "--config"
    bool *flag;         // set to true when given
    const char **value; // set to the text behind it (into argv); the last one given counts
} aisle_option;

// Reads argv[1..]. Plain arguments go to plain[0..plain_max), their number to *plain_count. False: message[..._LEN]
// says in one line what is wrong; the targets may have been written then.
bool aisle_options_parse(const aisle_option *options, size_t count, int argc, char **argv, const char **plain,
                         size_t plain_max, size_t *plain_count, char *message);
#endif
