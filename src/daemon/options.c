#include "daemon/options.h"

#include <stdio.h>
#include <string.h>

static bool complain(char *message, const char *what, const char *argument) {
    (void)snprintf(message, AISLE_OPTIONS_MESSAGE_LEN, "%s \"%.120s\"; see --help", what, argument);
    return false;
}

// The option named by argument; *inline_value = what stands behind its '=', or NULL.
static const aisle_option *find(const aisle_option *options, size_t count, const char *argument,
                                const char **inline_value) {
    const char *equals = strchr(argument, '=');
    size_t length = equals == NULL ? strlen(argument) : (size_t)(equals - argument);
    *inline_value = equals == NULL ? NULL : equals + 1;
    for (size_t i = 0; i < count; i++) {
        if (strlen(options[i].name) == length && memcmp(options[i].name, argument, length) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

bool aisle_options_parse(const aisle_option *options, size_t count, int argc, char **argv, const char **plain,
                         size_t plain_max, size_t *plain_count, char *message) {
    *plain_count = 0;
    for (int i = 1; i < argc; i++) {
        if (argv[i][0] != '-' || argv[i][1] == '\0') {
            if (*plain_count == plain_max) {
                return complain(message, "unexpected argument", argv[i]);
            }
            plain[(*plain_count)++] = argv[i];
            continue;
        }
        const char *value = NULL;
        const aisle_option *option = find(options, count, argv[i], &value);
        if (option == NULL) {
            return complain(message, "unknown option", argv[i]);
        }
        if (option->flag != NULL && value != NULL) {
            return complain(message, "no value is allowed for", option->name);
        }
        if (option->flag != NULL) {
            *option->flag = true;
            continue;
        }
        if (value == NULL && i + 1 == argc) {
            return complain(message, "a value is missing for", option->name);
        }
        *option->value = value != NULL ? value : argv[++i];
    }
    return true;
}
