#include "sim/post.h"

#include <stdlib.h>
#include <string.h>

bool aisle_sim_post_send(aisle_sim_post *self, int64_t due_us, aisle_channel channel, const void *bytes, size_t size) {
    uint8_t *copy = self->count < AISLE_SIM_POST_MAX ? malloc(size > 0 ? size : 1) : NULL;
    if (copy == NULL) {
        return false;
    }
    memcpy(copy, bytes, size);
    self->letter[self->count++] =
        (aisle_sim_letter){.due_us = due_us, .order = self->order++, .channel = channel, .size = size, .bytes = copy};
    return true;
}

static bool is_before(const aisle_sim_letter *a, const aisle_sim_letter *b) {
    return a->due_us < b->due_us || (a->due_us == b->due_us && a->order < b->order);
}

aisle_sim_letter *aisle_sim_post_first(aisle_sim_post *self) {
    uint32_t first = 0;
    for (uint32_t i = 1; i < self->count; i++) {
        first = is_before(&self->letter[i], &self->letter[first]) ? i : first;
    }
    return self->count > 0 ? &self->letter[first] : NULL;
}

bool aisle_sim_post_take(aisle_sim_post *self, int64_t now_us, aisle_sim_letter *out) {
    aisle_sim_letter *first = aisle_sim_post_first(self);
    if (first == NULL || first->due_us > now_us) {
        return false;
    }
    *out = *first;
    *first = self->letter[--self->count];
    return true;
}

void aisle_sim_post_free(aisle_sim_post *self) {
    while (self->count > 0) {
        free(self->letter[--self->count].bytes);
    }
}
