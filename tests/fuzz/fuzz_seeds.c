// Writes the seeds of fuzz_decode into a directory that is there: valid messages of every type and shape, one a file.
#include "fill.h"
#include "wire/codec.h"

#include <stdio.h>

enum { SEEDS = 3 };

static any_msg msg;
static uint8_t bytes[1 + AISLE_MSG_DATAGRAM_MAX];

static int write_file(const char *dir, uint32_t type, uint32_t shape, uint32_t seed, size_t size) {
    char path[4096];
    int length = snprintf(path, sizeof path, "%s/%s-%u-%u", dir, aisle_msg_name(type), shape, seed);
    if (length < 0 || (size_t)length >= sizeof path) {
        return 0;
    }
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return 0;
    }
    size_t written = fwrite(bytes, 1, size, file);
    return fclose(file) == 0 && written == size;
}

static int write_type(const char *dir, uint32_t type) {
    for (uint32_t shape = 0; shape < FILL_SHAPES; shape++) {
        for (uint32_t seed = 1; seed <= SEEDS; seed++) {
            size_t size = 0;
            fill_message(type, &msg, shape, seed);
            bytes[0] = (uint8_t)type;
            if (aisle_msg_encode(type, &msg, bytes + 1, sizeof bytes - 1, &size) != AISLE_OK ||
                !write_file(dir, type, shape, seed, size + 1)) {
                return 0;
            }
        }
    }
    return 1;
}

int main(int argc, char **argv) {
    if (argc != 2) {
        (void)fprintf(stderr, "usage: fuzz_seeds directory\n");
        return 2;
    }
    for (uint32_t type = 0; type < AISLE_MSG_COUNT; type++) {
        if (!write_type(argv[1], type)) {
            (void)fprintf(stderr, "fuzz_seeds: cannot write the seeds of %s to %s\n", aisle_msg_name(type), argv[1]);
            return 1;
        }
    }
    return 0;
}
