// post.h - messages under way: what was sent arrives later, each at its own time. Level 5.
//
// Letters come out by time of arrival, then in the order they went in. Memory: heap, one block a letter; freed when it is
// taken or by aisle_sim_post_free(). Time: O(letters).
#ifndef AISLE_SIM_POST_H
#define AISLE_SIM_POST_H

#include "daemon/channel.h"

#include <stdint.h>

#define AISLE_SIM_POST_MAX 512 // letters under way at once

typedef struct aisle_sim_letter {
    int64_t due_us;
    uint64_t order;
    aisle_channel channel;
    size_t size;
    uint8_t *bytes;
} aisle_sim_letter;

typedef struct aisle_sim_post {
    aisle_sim_letter letter[AISLE_SIM_POST_MAX];
    uint32_t count;
    uint64_t order;
} aisle_sim_post;

// Takes a copy of the bytes. False: no memory, or too many under way.
bool aisle_sim_post_send(aisle_sim_post *self, int64_t due_us, aisle_channel channel, const void *bytes, size_t size);

// The first letter due at now_us or before; its bytes are the caller's to free. False: none.
bool aisle_sim_post_take(aisle_sim_post *self, int64_t now_us, aisle_sim_letter *out);

// The first letter, left where it is; NULL: none. Valid until the next call.
aisle_sim_letter *aisle_sim_post_first(aisle_sim_post *self);

void aisle_sim_post_free(aisle_sim_post *self);
#endif
