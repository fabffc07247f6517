// spacetime-oracle: reads a hall, a vehicle, movers' ways and goals, and says when the vehicle can be there.
//
//     bounds X0 Y0 X1 Y1
//     polygon N x y ...                 any number
//     body N x y ... RADIUS             N 0: a disc
//     limits MARGIN V_MAX A_MAX D_MAX OMEGA_MAX ALPHA_MAX REACTION_TIME CREEP_CLEARANCE CREEP_SPEED
//     mover RADIUS V_BOUND N t x y ...  any number
//     start X Y THETA T
//     goal X Y TOLERANCE THETA TOLERANCE_THETA DWELL   any number, in order
//     solve T_END
// Answers a line: "found|none|undecided DONE BLIND STEP", DONE: s, with movers; BLIND: without; STEP: of time.
#include "spacetime_oracle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static spacetime_problem problem;
static spacetime_oracle oracle;

static bool read_numbers(double *out, int n) {
    for (int i = 0; i < n; i++) {
        if (scanf("%lf", &out[i]) != 1) {
            return false;
        }
    }
    return true;
}

static bool read_polygon(spacetime_polygon *out) {
    return scanf("%d", &out->n) == 1 && out->n >= 0 && out->n <= SPACETIME_VERTICES &&
           read_numbers(&out->v[0][0], 2 * out->n);
}

static bool read_mover(void) {
    spacetime_mover *m = &problem.mover[problem.movers];
    double v[2];
    if (problem.movers == SPACETIME_MOVERS || !read_numbers(v, 2) || scanf("%d", &m->count) != 1 || m->count < 1 ||
        m->count > 1000000) {
        return false;
    }
    double(*sample)[3] = malloc((size_t)m->count * sizeof *sample);
    m->radius = v[0];
    m->v_bound = v[1];
    m->sample = (const double(*)[3])sample;
    problem.movers++;
    return sample != NULL && read_numbers(&sample[0][0], 3 * m->count);
}

static bool read_goal(void) {
    double v[6];
    bool good = problem.goals < SPACETIME_GOALS && read_numbers(v, 6);
    if (good) {
        problem.goal[problem.goals++] = (spacetime_goal){v[0], v[1], v[2], v[3], v[4], v[5]};
    }
    return good;
}

static bool read_limits(void) {
    double v[9];
    spacetime_vehicle *car = &problem.vehicle;
    bool good = read_numbers(v, 9);
    car->margin = v[0];
    car->v_max = v[1];
    car->a_max = v[2];
    car->d_max = v[3];
    car->omega_max = v[4];
    car->alpha_max = v[5];
    car->reaction_time = v[6];
    car->creep_clearance = v[7];
    car->creep_speed = v[8];
    return good;
}

static bool solve(void) {
    static const char *const word[] = {"found", "none", "undecided"};
    double done = -1.0, blind = -1.0;
    if (!read_numbers(&problem.t_end, 1) || !spacetime_begin(&oracle, &problem)) {
        return false;
    }
    spacetime_verdict verdict = spacetime_run(&oracle, &done, NULL);
    oracle.blind = true;
    (void)spacetime_run(&oracle, &blind, NULL);
    printf("%s %.3f %.3f %.3f\n", word[verdict], done, blind, oracle.dt);
    spacetime_end(&oracle);
    return true;
}

static bool read_line(const char *word) {
    double v[4];
    if (strcmp(word, "bounds") == 0 && read_numbers(v, 4)) {
        problem.x_min = v[0];
        problem.y_min = v[1];
        problem.x_max = v[2];
        problem.y_max = v[3];
        return true;
    }
    if (strcmp(word, "polygon") == 0) {
        return problem.polygons < SPACETIME_POLYGONS && read_polygon(&problem.polygon[problem.polygons++]);
    }
    if (strcmp(word, "body") == 0) {
        return read_polygon(&problem.vehicle.body) && read_numbers(&problem.vehicle.radius, 1);
    }
    if (strcmp(word, "start") == 0) {
        return read_numbers(problem.start, 3) && read_numbers(&problem.t_start, 1);
    }
    return (strcmp(word, "limits") == 0 && read_limits()) || (strcmp(word, "mover") == 0 && read_mover()) ||
           (strcmp(word, "goal") == 0 && read_goal()) || (strcmp(word, "solve") == 0 && solve());
}

int main(void) {
    char word[16];
    while (scanf("%15s", word) == 1) {
        if (!read_line(word)) {
            fprintf(stderr, "spacetime-oracle: cannot use the line that begins with \"%s\"\n", word);
            return EXIT_FAILURE;
        }
    }
    for (int i = 0; i < problem.movers; i++) {
        free((void *)(uintptr_t)problem.mover[i].sample);
    }
    return EXIT_SUCCESS;
}
