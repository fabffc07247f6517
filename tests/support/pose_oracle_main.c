// pose_oracle: reads a hall, a body and queries, and says of each whether there is a way.
//
//     bounds WIDTH HEIGHT
//     polygon N x y ...          any number
//     body N x y ... MARGIN RADIUS_MIN
//     mode connect|enclose
//     query x y theta x y theta  any number; theta nan: any heading
// Answers a line a query: 1 joined, 0 not.
#include "pose_oracle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int read_polygon(double v[POSE_ORACLE_VERTICES][2]) {
    int n = 0;
    if (scanf("%d", &n) != 1 || n < 3 || n > POSE_ORACLE_VERTICES) {
        return 0;
    }
    for (int i = 0; i < n; i++) {
        if (scanf("%lf %lf", &v[i][0], &v[i][1]) != 2) {
            return 0;
        }
    }
    return n;
}

static bool read_line(pose_oracle *oracle, const char *word) {
    double v[POSE_ORACLE_VERTICES][2], a[6];
    char mode[16];
    if (strcmp(word, "bounds") == 0 && scanf("%lf %lf", &a[0], &a[1]) == 2) {
        pose_oracle_begin(oracle, a[0], a[1]);
        return true;
    }
    if (strcmp(word, "polygon") == 0) {
        int n = read_polygon(v);
        pose_oracle_add(oracle, (const double(*)[2])v, n);
        return n > 0;
    }
    if (strcmp(word, "body") == 0) {
        int n = read_polygon(v);
        bool known = n > 0 && scanf("%lf %lf", &a[0], &a[1]) == 2;
        if (known) {
            pose_oracle_body(oracle, (const double(*)[2])v, n, a[0], a[1]);
        }
        return known;
    }
    if (strcmp(word, "mode") == 0 && scanf("%15s", mode) == 1) {
        pose_oracle_end(oracle);
        return strcmp(mode, "connect") == 0 ? pose_oracle_connect(oracle) : pose_oracle_enclose(oracle);
    }
    if (strcmp(word, "query") == 0 && oracle->parent != NULL &&
        scanf("%lf %lf %lf %lf %lf %lf", &a[0], &a[1], &a[2], &a[3], &a[4], &a[5]) == 6) {
        printf("%d\n", pose_oracle_joined(oracle, a, a + 3) ? 1 : 0);
        return true;
    }
    return false;
}

int main(void) {
    static pose_oracle oracle;
    char word[16];
    while (scanf("%15s", word) == 1) {
        if (!read_line(&oracle, word)) {
            fprintf(stderr, "pose_oracle: cannot use the line that begins with \"%s\"\n", word);
            return EXIT_FAILURE;
        }
    }
    pose_oracle_end(&oracle);
    return EXIT_SUCCESS;
}
