#include "sim/report.h"

#include "daemon/loop.h"
#include "replay/report.h"

#include <inttypes.h>

static double ms(const aisle_histogram *h, double share) {
    return (double)aisle_histogram_percentile(h, share) * 1e-3;
}

static void text_of_times(const char *what, const aisle_histogram *h, FILE *out) {
    (void)fprintf(out, "%s, ms: p50 %.3f, p99 %.3f, max %.3f\n", what, ms(h, 0.5), ms(h, 0.99),
                  (double)h->max_us * 1e-3);
}

static void json_of_times(const char *name, const aisle_histogram *h, FILE *out) {
    (void)fprintf(out, ",\n  \"%s\": {\"p50\": %.4g, \"p99\": %.4g, \"max\": %.4g, \"count\": %" PRId64 "}", name,
                  ms(h, 0.5), ms(h, 0.99), (double)h->max_us * 1e-3, h->count);
}

// What the daemon tells of a timer of its; count 0: nothing.
typedef struct told {
    int64_t count;
    double p50, p99, max; // ms
} told;

static told told_of(const aisle_sim_host *host, aisle_timer which) {
    const aisle_diag_msg *d = &host->told;
    for (int16_t i = 0; i < d->num_timers; i++) {
        if (d->timer_id[i] == (int8_t)which) {
            return (told){d->timer_count[i], 1e3 * (double)d->timer_p50[i], 1e3 * (double)d->timer_p99[i],
                          1e3 * (double)d->timer_max[i]};
        }
    }
    return (told){0, 0.0, 0.0, 0.0};
}

static void text_of_told(const char *what, const aisle_sim_host *host, aisle_timer which, FILE *out) {
    const told t = told_of(host, which);
    (void)fprintf(out, "%s, ms: %" PRId64 " times, p50 %.3f, p99 %.3f, max %.3f\n", what, t.count, t.p50, t.p99, t.max);
}

static void json_of_told(const char *name, const aisle_sim_host *host, aisle_timer which, FILE *out) {
    const told t = told_of(host, which);
    (void)fprintf(out, ",\n  \"%s\": {\"p50\": %.4g, \"p99\": %.4g, \"max\": %.4g, \"count\": %" PRId64 "}", name,
                  t.p50, t.p99, t.max, t.count);
}

static void text_of_contacts(const aisle_sim_judge *judge, FILE *out) {
    (void)fprintf(out,
                  "collisions while moving %" PRId64 " (with the hall %" PRId64 "), contacts at rest %" PRId64
                  ", encounters %" PRId64 "\n",
                  judge->collisions + judge->static_collisions, judge->static_collisions, judge->contacts_at_rest,
                  judge->encounters);
    for (uint32_t i = 0; i < judge->num_contacts; i++) {
        const aisle_sim_contact *c = &judge->contact[i];
        (void)fprintf(out, "  %8.3f s: %s %s %" PRId32 " at %.3f, %.3f, up to %.3f m/s\n", c->t,
                      c->moving ? "collision with" : "touched at rest by", c->is_static ? "hall" : "mover", c->id,
                      c->pose.x, c->pose.y, c->speed);
    }
}

static void text_of_gap(const char *name, double gap, FILE *out) {
    if (isfinite(gap)) {
        (void)fprintf(out, ", %s %.3f m", name, gap);
    }
}

static void text_of_paths(const aisle_sim_episode *e, FILE *out) {
    (void)fprintf(out,
                  "paths: revisions %" PRId64 ", renewals %" PRId64 ", lapses of the lease %" PRId64
                  ", unplanned stops %" PRId64 ";",
                  e->revisions, e->renewals, e->driver.lapses, e->stops);
    for (uint32_t i = 0; i < e->num_causes; i++) {
        const aisle_sim_cause *c = &e->cause[i];
        (void)fprintf(out, " %s%s%s %" PRId64, aisle_report_path_status(c->status), c->cause == 0 ? "" : "/",
                      c->cause == 0 ? "" : aisle_cause_name(c->cause), c->paths);
    }
    (void)fputc('\n', out);
}

static void text_of_faults(const aisle_sim_episode *e, FILE *out) {
    for (uint32_t i = 0; i < e->setup.faults.count; i++) {
        const aisle_sim_fault *f = &e->setup.faults.fault[i];
        (void)fprintf(out, "fault %s at %.2f s for %.2f s:", aisle_sim_fault_name(f->kind), f->at, f->lasts);
        if (f->answered >= 0.0) {
            (void)fprintf(out, " %s/%s after %.3f s,", aisle_report_path_status(f->status),
                          f->cause == 0 ? "-" : aisle_cause_name(f->cause), f->answered);
        } else {
            (void)fprintf(out, " never answered,");
        }
        (void)fprintf(out, f->rested >= 0.0 ? " at rest after %.3f s\n" : " never at rest\n", f->rested);
    }
}

void aisle_sim_report_text(const aisle_sim_episode *e, FILE *out) {
    const aisle_sim_judge *judge = &e->judge;
    (void)fprintf(out, "seed %" PRIu64 ": %s, %d of %d goals, %.2f s", e->setup.seed,
                  e->arrived ? "arrived"
                             : (judge->arrival >= 0.0 ? "there, but the planner does not say so" : "not arrived"),
                  judge->num_visited, judge->goals.num_goals,
                  judge->arrival >= 0.0 ? judge->arrival : aisle_sim_episode_seconds(e));
    if (e->optimum > 0.0 && judge->arrival >= 0.0) {
        (void)fprintf(out, ", %.3f of the %.2f s without movers", (judge->arrival - e->goals_at) / e->optimum,
                      e->optimum);
    }
    (void)fprintf(out, "\nway %.2f m, in motion %.2f s", judge->way, judge->moving_time);
    text_of_gap("least gap to movers", judge->separation, out);
    text_of_gap("in motion", judge->separation_moving, out);
    text_of_gap("to the hall", judge->static_gap, out);
    (void)fputc('\n', out);
    text_of_contacts(judge, out);
    text_of_paths(e, out);
    text_of_faults(e, out);
    if (e->host->lcm != NULL) {
        text_of_told("aisled, from pose or obstacles to verdict", e->host, AISLE_TIMER_CYCLE, out);
        text_of_told("of those that changed the path, to its sending", e->host, AISLE_TIMER_ANSWER, out);
        text_of_told("the planner's processor time in it", e->host, AISLE_TIMER_ANSWER_WORK, out);
        return;
    }
    text_of_times("work of what brought a path", &e->host->answers, out);
    text_of_times("the same in processor time", &e->host->answers_cpu, out);
    text_of_times("of what brought another path", &e->host->changes_cpu, out);
    text_of_times("work of each input and deadline", &e->host->work, out);
}

static void json_number(const char *name, double value, FILE *out) {
    if (value >= 0.0 && isfinite(value)) {
        (void)fprintf(out, ", \"%s\": %.6g", name, value);
    } else {
        (void)fprintf(out, ", \"%s\": null", name);
    }
}

static void json_of_contacts(const aisle_sim_judge *judge, FILE *out) {
    (void)fprintf(out, ",\n  \"contacts\": [");
    for (uint32_t i = 0; i < judge->num_contacts; i++) {
        const aisle_sim_contact *c = &judge->contact[i];
        (void)fprintf(out,
                      "%s\n    {\"t\": %.3f, \"id\": %" PRId32
                      ", \"hall\": %s, \"moving\": %s, \"speed\": %.4f, \"x\": "
                      "%.4f, \"y\": %.4f, \"theta\": %.4f}",
                      i == 0 ? "" : ",", c->t, c->id, c->is_static ? "true" : "false", c->moving ? "true" : "false",
                      c->speed, c->pose.x, c->pose.y, c->pose.theta);
    }
    (void)fprintf(out, "]");
}

static void json_of_causes(const aisle_sim_episode *e, FILE *out) {
    (void)fprintf(out, ",\n  \"paths\": [");
    for (uint32_t i = 0; i < e->num_causes; i++) {
        const aisle_sim_cause *c = &e->cause[i];
        (void)fprintf(out, "%s{\"status\": \"%s\", \"cause\": \"%s\", \"count\": %" PRId64 "}", i == 0 ? "" : ", ",
                      aisle_report_path_status(c->status), c->cause == 0 ? "" : aisle_cause_name(c->cause), c->paths);
    }
    (void)fprintf(out, "]");
}

static void json_of_faults(const aisle_sim_episode *e, FILE *out) {
    (void)fprintf(out, ",\n  \"faults\": [");
    for (uint32_t i = 0; i < e->setup.faults.count; i++) {
        const aisle_sim_fault *f = &e->setup.faults.fault[i];
        (void)fprintf(out, "%s\n    {\"kind\": \"%s\", \"at\": %.6g", i == 0 ? "" : ",", aisle_sim_fault_name(f->kind),
                      f->at);
        json_number("lasts", f->lasts, out);
        json_number("answered", f->answered, out);
        json_number("rested", f->rested, out);
        (void)fprintf(out, ", \"status\": \"%s\", \"cause\": \"%s\"}",
                      f->answered < 0.0 ? "" : aisle_report_path_status(f->status),
                      f->answered < 0.0 || f->cause == 0 ? "" : aisle_cause_name(f->cause));
    }
    (void)fprintf(out, "]");
}

void aisle_sim_report_json(const aisle_sim_episode *e, FILE *out) {
    const aisle_sim_judge *judge = &e->judge;
    (void)fprintf(out, "{\"seed\": %" PRIu64 ", \"arrived\": %s, \"goals\": %d, \"visited\": %d", e->setup.seed,
                  e->arrived ? "true" : "false", judge->goals.num_goals, judge->num_visited);
    json_number("arrival", judge->arrival, out);
    json_number("time", judge->arrival >= 0.0 ? judge->arrival - e->goals_at : -1.0, out);
    json_number("optimum", e->optimum > 0.0 ? e->optimum : -1.0, out);
    json_number("seconds", aisle_sim_episode_seconds(e), out);
    json_number("way", judge->way, out);
    json_number("moving_time", judge->moving_time, out);
    (void)fprintf(out, ",\n  \"collisions\": %" PRId64 ", \"hall_collisions\": %" PRId64, judge->collisions,
                  judge->static_collisions);
    (void)fprintf(out, ", \"contacts_at_rest\": %" PRId64 ", \"encounters\": %" PRId64, judge->contacts_at_rest,
                  judge->encounters);
    json_number("separation", judge->separation, out);
    json_number("separation_moving", judge->separation_moving, out);
    json_number("hall_gap", judge->static_gap, out);
    (void)fprintf(
        out, ",\n  \"revisions\": %" PRId64 ", \"renewals\": %" PRId64 ", \"lapses\": %" PRId64 ", \"stops\": %" PRId64,
        e->revisions, e->renewals, e->driver.lapses, e->stops);
    json_of_causes(e, out);
    json_of_contacts(judge, out);
    json_of_faults(e, out);
    if (e->host->lcm != NULL) {
        json_of_told("cycle_ms", e->host, AISLE_TIMER_CYCLE, out);
        json_of_told("answer_ms", e->host, AISLE_TIMER_ANSWER, out);
        json_of_told("answer_cpu_ms", e->host, AISLE_TIMER_ANSWER_WORK, out);
    } else {
        json_of_times("answer_ms", &e->host->answers, out);
        json_of_times("answer_cpu_ms", &e->host->answers_cpu, out);
        json_of_times("change_cpu_ms", &e->host->changes_cpu, out);
    }
    json_of_times("work_ms", &e->host->work, out);
    (void)fprintf(out, "}\n");
}
