// optimum: exact shortest paths of a disc (optimum.h), text in, JSON out.
//
//   optimum < scene.txt
//
// The scene, words and numbers parted by white space, metres:
//   radius R                        first
//   bounds X_MIN Y_MIN X_MAX Y_MAX  of the disc's centre, then
//   polygon N X Y X Y ...           any number of these
// or
//   grid FILE X Y RESOLUTION        binary PGM (P5, 8 bit), first row on top, 0 = occupied; X, Y: its lower left corner
// and then
//   upper L                         a length known to suffice for the next query only
//   query START_X START_Y GOAL_X GOAL_Y
// and for another scene
//   done                            and begin anew
// Prints for each scene {"arcs": N, "queries": [{"result": "found" | "none" | "end occupied", "length": L or null, "tangents": N,
// "steps": [[x, y, curvature of the piece that ends here], ...]}, ...]}. Exit 2 with a line if the scene is not right.
#include "optimum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct scene {
    double radius, bounds[4], x, y, upper;
    optimum_polygon *polygons;
    size_t count, queries;
    optimum_world *world;
} scene;

static void fail(const char *why) {
    (void)fprintf(stderr, "optimum: %s\n", why);
    exit(2);
}

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1 || !isfinite(value)) {
        fail("a number is missing");
    }
    return value;
}

static void *memory(void *block, size_t bytes) {
    void *got = realloc(block, bytes);
    if (got == NULL) {
        fail("out of memory");
    }
    return got;
}

static void read_polygon(scene *s) {
    double said = number();
    if (!(said >= 1.0 && said <= 1e6)) {
        fail("polygon: a count from 1 is needed");
    }
    size_t n = (size_t)said;
    optimum_point *points = memory(NULL, n * sizeof *points);
    for (size_t i = 0; i < n; i++) {
        points[i].x = number();
        points[i].y = number();
    }
    s->polygons = memory(s->polygons, (s->count + 1) * sizeof *s->polygons);
    s->polygons[s->count].points = points;
    s->polygons[s->count].count = n;
    s->count++;
}

// Rows from the bottom, 1 = occupied.
static uint8_t *read_pgm(const char *name, uint32_t *width, uint32_t *height) {
    FILE *file = fopen(name, "rb");
    unsigned max = 0;
    if (file == NULL || fscanf(file, "P5 %u %u %u", width, height, &max) != 3 || max != 255 || fgetc(file) == EOF ||
        *width < 1 || *height < 1 || *width > 65535 || *height > 65535) {
        fail("grid: not a binary PGM of 8 bit");
    }
    size_t cells = (size_t)*width * *height;
    uint8_t *occupied = memory(NULL, cells);
    for (uint32_t j = *height; j-- > 0;) {
        uint8_t *row = &occupied[(size_t)j * *width];
        if (fread(row, 1, *width, file) != *width) {
            fail("grid: the image is too short");
        }
        for (uint32_t i = 0; i < *width; i++) {
            row[i] = row[i] == 0;
        }
    }
    (void)fclose(file);
    return occupied;
}

static void read_grid(scene *s) {
    char name[4096];
    uint32_t width, height;
    if (scanf("%4095s", name) != 1) {
        fail("grid: a file is needed");
    }
    s->x = number();
    s->y = number();
    double resolution = number();
    uint8_t *occupied = read_pgm(name, &width, &height);
    s->world = optimum_grid(s->radius, resolution, width, height, occupied);
    free(occupied);
}

static void print_path(const scene *s, const optimum_path *path) {
    static const char *const results[] = {"found", "none", "end occupied"};
    printf("%s\n {\"result\": \"%s\", ", s->queries > 0 ? "," : "", results[path->result]);
    if (path->result == OPTIMUM_FOUND) {
        printf("\"length\": %.10f, ", path->length);
    } else {
        printf("\"length\": null, ");
    }
    printf("\"tangents\": %zu, \"steps\": [", path->tangents);
    for (size_t i = 0; i < path->count; i++) {
        const optimum_step *step = &path->steps[i];
        printf("%s[%.9f, %.9f, %.9g]", i > 0 ? ", " : "", step->x + s->x, step->y + s->y, step->curvature);
    }
    printf("]}");
    (void)fflush(stdout);
}

static void answer(scene *s) {
    if (s->world == NULL) {
        s->world = optimum_polygons(s->radius, s->bounds, s->polygons, s->count);
    }
    if (s->queries == 0) {
        printf("{\"arcs\": %zu, \"queries\": [", optimum_arcs(s->world));
    }
    double at[4];
    for (int i = 0; i < 4; i++) {
        at[i] = number() - (i % 2 == 0 ? s->x : s->y);
    }
    optimum_point start = {at[0], at[1]}, goal = {at[2], at[3]};
    optimum_path path = optimum_shortest(s->world, start, goal, s->upper);
    print_path(s, &path);
    optimum_path_free(&path);
    s->queries++;
    s->upper = INFINITY;
}

static void begin(scene *s) {
    *s = (scene){.radius = -1.0, .upper = INFINITY};
}

static void end(scene *s) {
    printf("%s\n]}\n", s->queries > 0 ? "" : "{\"arcs\": 0, \"queries\": [");
    (void)fflush(stdout);
    optimum_free(s->world);
    for (size_t i = 0; i < s->count; i++) {
        free((void *)(uintptr_t)s->polygons[i].points);
    }
    free(s->polygons);
}

static void obey(scene *s, const char *word) {
    if (strcmp(word, "done") == 0) {
        end(s);
        begin(s);
    } else if (strcmp(word, "radius") == 0) {
        s->radius = number();
    } else if (strcmp(word, "bounds") == 0) {
        for (int i = 0; i < 4; i++) {
            s->bounds[i] = number();
        }
    } else if (strcmp(word, "polygon") == 0) {
        read_polygon(s);
    } else if (strcmp(word, "grid") == 0) {
        read_grid(s);
    } else if (strcmp(word, "upper") == 0) {
        s->upper = number();
    } else if (strcmp(word, "query") == 0) {
        answer(s);
    } else {
        fail("radius, bounds, polygon, grid, upper, query or done is expected");
    }
}

int main(void) {
    scene s;
    begin(&s);
    char word[16];
    while (scanf("%15s", word) == 1) {
        const int is_done = strcmp(word, "done") == 0;
        obey(&s, word);
        if (!is_done && s.radius != 0.0 && !(s.radius >= 1e-6)) {
            fail("radius comes first and is 0 or at least 1e-6");
        }
    }
    if (s.radius >= 0.0) {
        end(&s);
    }
    return 0;
}
