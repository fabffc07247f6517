#include "sim/batch.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct drive { // one at a time, on the heap
    aisle_sim_drawn drawn;
    aisle_sim_host host;
    aisle_sim_episode episode;
} drive;

void aisle_sim_batch_start(aisle_sim_batch *self, aisle_sim_kind kind, uint64_t first) {
    memset(self, 0, sizeof *self);
    self->kind = kind;
    self->first = first;
    self->episodes = INT64_MAX;
    self->separation_moving = (double)INFINITY;
    aisle_settings_defaults(&self->settings);
}

const char *aisle_sim_batch_kind(const aisle_sim_batch *self) {
    return self->kind == AISLE_SIM_KIND_COUNT ? "all" : aisle_sim_kind_name(self->kind);
}

static void add_work(aisle_histogram *sum, const aisle_histogram *part) {
    for (uint32_t i = 0; i < AISLE_HISTOGRAM_BUCKETS; i++) {
        sum->bucket[i] += part->bucket[i];
    }
    sum->count += part->count;
    sum->max_us = part->max_us > sum->max_us ? part->max_us : sum->max_us;
}

static void add(aisle_sim_batch *self, const aisle_sim_episode *e) {
    const aisle_sim_judge *judge = &e->judge;
    self->done++;
    self->met += judge->encounters;
    self->arrived += e->arrived ? 1 : 0;
    self->unreachable += e->optimum > 0.0 ? 0 : 1;
    self->with_collision += judge->collisions + judge->static_collisions > 0 ? 1 : 0;
    self->collisions += judge->collisions;
    self->hall_collisions += judge->static_collisions;
    self->contacts_at_rest += judge->contacts_at_rest;
    self->revisions += e->revisions;
    self->stops += e->stops;
    self->seconds += aisle_sim_episode_seconds(e);
    self->way += judge->way;
    self->separation_moving = aisle_min(self->separation_moving, judge->separation_moving);
    self->late += e->arrived ? (judge->arrival - e->goals_at) / e->optimum : 0.0;
    add_work(&self->work, &e->host->work);
    add_work(&self->answers_cpu, &e->host->answers_cpu);
}

static void tell(const aisle_sim_batch *self, const aisle_sim_episode *e, FILE *out) {
    const aisle_sim_judge *judge = &e->judge;
    bool collided = judge->collisions + judge->static_collisions > 0;
    if (!collided && (e->arrived || !self->told)) {
        return;
    }
    (void)fprintf(out, "%s: seed %" PRIu64 ", kind %s", collided ? "COLLISION" : "not arrived", e->setup.seed,
                  aisle_sim_batch_kind(self));
    for (uint32_t i = 0; i < judge->num_contacts; i++) {
        const aisle_sim_contact *c = &judge->contact[i];
        if (c->moving) {
            (void)fprintf(out, "; %.3f s %s %" PRId32 " at %.3f m/s", c->t, c->is_static ? "hall" : "mover", c->id,
                          c->speed);
        }
    }
    (void)fputc('\n', out);
    (void)fflush(out);
}

static bool run_one(aisle_sim_batch *self, drive *d, uint64_t seed, FILE *out) {
    char message[AISLE_SETTINGS_MESSAGE_LEN];
    aisle_sim_draw(&d->drawn, seed, self->kind, self->num_movers);
    if (aisle_sim_host_start_core(&d->host, &self->settings, NULL, aisle_sim_episode_hear, &d->episode, message) !=
        AISLE_OK) {
        return false;
    }
    if (self->units_per_ms > 0) {
        (void)aisle_sim_host_slice(&d->host, self->units_per_ms, NULL);
    }
    if (self->faults) {
        aisle_sim_draw_faults(&d->drawn);
    }
    d->drawn.setup.num_sources = self->blind ? 0 : d->drawn.setup.num_sources;
    aisle_sim_episode_start(&d->episode, &d->drawn.setup, &d->host);
    bool good = aisle_sim_drawn_prepare(&d->drawn, &d->episode) && aisle_sim_episode_run(&d->episode, message);
    if (good) {
        add(self, &d->episode);
        tell(self, &d->episode, out);
    }
    aisle_sim_host_stop(&d->host);
    aisle_sim_episode_end(&d->episode);
    return good;
}

bool aisle_sim_batch_run(aisle_sim_batch *self, FILE *out) {
    drive *d = malloc(sizeof *d);
    bool good = d != NULL;
    while (good && self->met < self->encounters && self->done < self->episodes) {
        good = run_one(self, d, self->first + (uint64_t)self->done, out);
    }
    free(d);
    return good;
}

static double ms(const aisle_histogram *h, double share) {
    return (double)aisle_histogram_percentile(h, share) * 1e-3;
}

void aisle_sim_batch_report(const aisle_sim_batch *self, double host_seconds, FILE *out) {
    double arrived = self->arrived > 0 ? (double)self->arrived : 1.0;
    (void)fprintf(out,
                  "kind %s, seeds %" PRIu64 " to %" PRIu64 ": encounters %" PRId64 ", collisions while moving %" PRId64
                  " (in %" PRId64 " drives), with the hall %" PRId64 ", contacts at rest %" PRId64 "\n",
                  aisle_sim_batch_kind(self), self->first, self->first + (uint64_t)self->done - 1, self->met,
                  self->collisions, self->with_collision, self->hall_collisions, self->contacts_at_rest);
    (void)fprintf(out,
                  "drives %" PRId64 ", arrived %" PRId64 ", without a way %" PRId64
                  ", mean time over the way without movers %.3f, revisions %" PRId64 ", unplanned stops %" PRId64 "\n",
                  self->done, self->arrived, self->unreachable, self->late / arrived, self->revisions, self->stops);
    (void)fprintf(
        out,
        "%.0f s and %.0f m driven in %.1f s; least gap in motion %.4f m; a path's work in processor ms: p50 %.3f, p99 "
        "%.3f, max %.3f\n",
        self->seconds, self->way, host_seconds, self->separation_moving, ms(&self->answers_cpu, 0.5),
        ms(&self->answers_cpu, 0.99), (double)self->answers_cpu.max_us * 1e-3);
}

void aisle_sim_batch_json(const aisle_sim_batch *self, double host_seconds, FILE *out) {
    double arrived = self->arrived > 0 ? (double)self->arrived : 1.0;
    (void)fprintf(out,
                  "{\"kind\": \"%s\", \"first\": %" PRIu64 ", \"drives\": %" PRId64 ", \"encounters\": %" PRId64
                  ", \"collisions\": %" PRId64 ", \"hall_collisions\": %" PRId64
                  ", \"drives_with_collision\": %" PRId64,
                  aisle_sim_batch_kind(self), self->first, self->done, self->met, self->collisions,
                  self->hall_collisions, self->with_collision);
    (void)fprintf(out,
                  ",\n \"contacts_at_rest\": %" PRId64 ", \"arrived\": %" PRId64 ", \"without_a_way\": %" PRId64
                  ", \"mean_time_over_optimum\": %.6g, \"revisions\": %" PRId64 ", \"stops\": %" PRId64,
                  self->contacts_at_rest, self->arrived, self->unreachable, self->late / arrived, self->revisions,
                  self->stops);
    (void)fprintf(out, ",\n \"seconds\": %.6g, \"way\": %.6g, \"host_seconds\": %.6g", self->seconds, self->way,
                  host_seconds);
    if (isfinite(self->separation_moving)) {
        (void)fprintf(out, ", \"separation_moving\": %.6g", self->separation_moving);
    }
    (void)fprintf(out, ", \"answer_cpu_ms\": {\"p50\": %.4g, \"p99\": %.4g, \"max\": %.4g}",
                  ms(&self->answers_cpu, 0.5), ms(&self->answers_cpu, 0.99), (double)self->answers_cpu.max_us * 1e-3);
    (void)fprintf(out, ", \"work_ms\": {\"p50\": %.4g, \"p99\": %.4g, \"max\": %.4g}}\n", ms(&self->work, 0.5),
                  ms(&self->work, 0.99), (double)self->work.max_us * 1e-3);
}
