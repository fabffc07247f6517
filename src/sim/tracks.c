#include "sim/tracks.h"

#include "base/angle.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ID_LEN 32
#define LINE_LEN 256

typedef struct row {
    char id[ID_LEN];
    uint32_t order; // of the line
    aisle_sim_sample sample;
    bool is_vehicle;
} row;

typedef struct rows {
    row *item;
    size_t count, capacity;
} rows;

// ---- reading

static bool number(char **at, double *out) {
    char *end = *at;
    *out = strtod(*at, &end);
    bool good = end != *at && (*end == ',' || *end == '\0' || *end == '\n' || *end == '\r') && isfinite(*out);
    *at = *end == ',' ? end + 1 : end;
    return good;
}

static bool word(char **at, char *out, size_t size) {
    char *end = strchr(*at, ',');
    size_t length = end == NULL ? 0 : (size_t)(end - *at);
    if (length == 0 || length >= size) {
        return false;
    }
    memcpy(out, *at, length);
    out[length] = '\0';
    *at = end + 1;
    return true;
}

static bool parse(char *line, row *out) {
    char kind[8];
    char *at = line;
    bool good = number(&at, &out->sample.t) && word(&at, out->id, sizeof out->id) && word(&at, kind, sizeof kind) &&
                number(&at, &out->sample.at.x) && number(&at, &out->sample.at.y);
    out->is_vehicle = good && strcmp(kind, "veh") == 0;
    return good && (out->is_vehicle || strcmp(kind, "ped") == 0);
}

static bool keep(rows *self, const row *item) {
    if (self->count == self->capacity) {
        size_t more = self->capacity == 0 ? 1024 : 2 * self->capacity;
        row *grown = realloc(self->item, more * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        self->item = grown;
        self->capacity = more;
    }
    self->item[self->count++] = *item;
    return true;
}

static bool complain(char *message, const char *path, uint32_t line, const char *what) {
    (void)snprintf(message, AISLE_SIM_TRACKS_MESSAGE_LEN, "%s:%u: %s", path, line, what);
    return false;
}

static bool read_rows(rows *out, FILE *file, const char *path, char *message) {
    char line[LINE_LEN];
    for (uint32_t number_of_line = 1; fgets(line, sizeof line, file) != NULL; number_of_line++) {
        row item = {.order = number_of_line};
        if (number_of_line == 1 && strncmp(line, "t_s,id,kind,x_m,y_m", 19) == 0) {
            continue;
        }
        if (!parse(line, &item)) {
            return complain(message, path, number_of_line, "not t_s,id,kind,x_m,y_m[,heading_rad]");
        }
        if (out->count > 0 && item.sample.t < out->item[out->count - 1].sample.t) {
            return complain(message, path, number_of_line, "not sorted by time");
        }
        if (!keep(out, &item)) {
            return complain(message, path, number_of_line, "no memory");
        }
    }
    return out->count > 0 ? true : complain(message, path, 1, "no samples");
}

// By id, then by time as read.
static int compare(const void *a, const void *b) {
    const row *x = a, *y = b;
    int by_id = strcmp(x->id, y->id);
    return by_id != 0 ? by_id : (x->order > y->order) - (x->order < y->order);
}

// ---- tracks

static double speed_between(const row *a, const row *b) {
    double dt = b->sample.t - a->sample.t;
    return dt > 0.0 ? aisle_vec2_distance(a->sample.at, b->sample.at) / dt : (double)INFINITY;
}

static void append(aisle_sim_tracks *self, const rows *from) {
    for (size_t i = 0; i < from->count; i++) {
        const row *item = &from->item[i];
        bool goes_on = i > 0 && strcmp(item->id, from->item[i - 1].id) == 0;
        double speed = goes_on ? speed_between(&from->item[i - 1], item) : 0.0;
        if (!goes_on || speed > AISLE_SIM_TRACK_SPEED_MAX) {
            self->track[self->num_tracks++] = (aisle_sim_track){.first = (uint32_t)i, .is_vehicle = item->is_vehicle};
            speed = 0.0;
        }
        aisle_sim_track *track = &self->track[self->num_tracks - 1];
        track->count++;
        track->v_max = aisle_max(track->v_max, speed);
        self->sample[self->num_samples++] = item->sample;
    }
}

static void measure(aisle_sim_tracks *self) {
    self->lo = self->hi = self->sample[0].at;
    for (uint32_t i = 0; i < self->num_samples; i++) {
        const aisle_sim_sample *s = &self->sample[i];
        self->lo = aisle_vec2_of(aisle_min(self->lo.x, s->at.x), aisle_min(self->lo.y, s->at.y));
        self->hi = aisle_vec2_of(aisle_max(self->hi.x, s->at.x), aisle_max(self->hi.y, s->at.y));
        self->duration = aisle_max(self->duration, s->t);
    }
}

bool aisle_sim_tracks_read(aisle_sim_tracks *self, const char *path, char *message) {
    memset(self, 0, sizeof *self);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        (void)snprintf(message, AISLE_SIM_TRACKS_MESSAGE_LEN, "%s: %s", path, strerror(errno));
        return false;
    }
    rows all = {0};
    bool good = read_rows(&all, file, path, message);
    (void)fclose(file);
    if (good) {
        qsort(all.item, all.count, sizeof all.item[0], compare);
        self->sample = malloc(all.count * sizeof *self->sample);
        self->track = malloc(all.count * sizeof *self->track);
        good = (self->sample != NULL && self->track != NULL) || complain(message, path, 1, "no memory");
    }
    if (good) {
        append(self, &all);
        measure(self);
    } else {
        aisle_sim_tracks_free(self);
    }
    free(all.item);
    return good;
}

void aisle_sim_tracks_map(aisle_sim_tracks *self, aisle_vec2 to, double turn, double scale) {
    double sine, cosine;
    aisle_sincos(turn, &sine, &cosine);
    aisle_vec2 centre = aisle_vec2_lerp(self->lo, self->hi, 0.5);
    for (uint32_t i = 0; i < self->num_samples; i++) {
        aisle_vec2 d = aisle_vec2_scale(aisle_vec2_sub(self->sample[i].at, centre), scale);
        self->sample[i].at = aisle_vec2_of(to.x + cosine * d.x - sine * d.y, to.y + sine * d.x + cosine * d.y);
        self->sample[i].t *= scale;
    }
    self->duration = 0.0;
    measure(self);
}

bool aisle_sim_tracks_at(const aisle_sim_tracks *self, uint32_t i, double t, aisle_vec2 *at, aisle_vec2 *velocity) {
    const aisle_sim_track *track = &self->track[i];
    const aisle_sim_sample *s = &self->sample[track->first];
    uint32_t lo = 0, hi = track->count - 1;
    if (t < s[0].t || t > s[hi].t || track->count < 2) {
        return false;
    }
    while (hi - lo > 1) { // s[lo].t <= t <= s[hi].t
        uint32_t middle = lo + (hi - lo) / 2;
        if (s[middle].t <= t) {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    double dt = s[hi].t - s[lo].t;
    *at = aisle_vec2_lerp(s[lo].at, s[hi].at, (t - s[lo].t) / dt);
    *velocity = aisle_vec2_scale(aisle_vec2_sub(s[hi].at, s[lo].at), 1.0 / dt);
    return true;
}

void aisle_sim_tracks_free(aisle_sim_tracks *self) {
    free(self->sample);
    free(self->track);
    memset(self, 0, sizeof *self);
}
