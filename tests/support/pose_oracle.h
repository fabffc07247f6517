// pose_oracle.h - can a body get from one configuration to another at all? Slow, exhaustive, shares nothing with src/.
//
// A lattice of places (POSE_ORACLE_STEP apart) and headings, all of it, and which configurations hang together (driving
// backwards is allowed, so every motion can be driven both ways and this is one relation: union-find).
//
// pose_oracle_connect(): motions that the vehicle can make, each proved by bisection: an interval is free if the body in
// its middle keeps the margin and half of what any point of it travels. Headings are those of short lattice vectors, so
// that straight motions end on the lattice; turns on the spot to the next heading, or, of a car, line - arc - line to
// the next two headings, the corner on the lattice, the arc no tighter than the car's. "Yes" is a proof; "no" is none.
//
// pose_oracle_enclose(): the opposite. A configuration is open if the body shrunk by what a lattice cell may be off
// keeps the margin; all neighbours are joined, whatever the drive. "No" is a proof that there is no way.
//
// Obstacles are convex polygons and the bounds. Distances by brute force over vertices and edges, in double.
#ifndef POSE_ORACLE_H
#define POSE_ORACLE_H

#include <stdbool.h>
#include <stdint.h>

#define POSE_ORACLE_STEP 0.05   // m
#define POSE_ORACLE_VERTICES 16 // of a polygon
#define POSE_ORACLE_POLYGONS 512
#define POSE_ORACLE_HEADINGS 32 // of connect(); enclose() has four times as many

typedef struct pose_polygon {
    double v[POSE_ORACLE_VERTICES][2]; // convex, counter-clockwise
    int n;
    double box[4]; // x0, y0, x1, y1
} pose_polygon;

typedef struct pose_oracle {
    double width, height; // bounds [0, width] x [0, height]
    pose_polygon polygon[POSE_ORACLE_POLYGONS];
    int polygons;
    pose_polygon body; // about its origin
    double margin;
    double radius_min; // m, of a car; 0: turns on the spot
    int nx, ny, headings;
    uint32_t *parent; // union-find, [nx * ny * headings]; UINT32_MAX: not free
} pose_oracle;

void pose_oracle_begin(pose_oracle *self, double width, double height);
void pose_oracle_add(pose_oracle *self, const double (*v)[2], int n);
void pose_oracle_body(pose_oracle *self, const double (*v)[2], int n, double margin, double radius_min);

// Gap between the body at a configuration and obstacles and bounds; negative: they overlap (how much is not said).
double pose_oracle_gap(const pose_oracle *self, double x, double y, double theta);

// Fills the lattice. False: no memory. free() by pose_oracle_end().
bool pose_oracle_connect(pose_oracle *self);
bool pose_oracle_enclose(pose_oracle *self);
void pose_oracle_end(pose_oracle *self);

// The k-th heading of connect(), rad; those that are multiples of a quarter of pi are among them.
double pose_oracle_heading(int k);

// Are two configurations joined? Places are taken to the nearest lattice point, headings to the nearest one; headings
// NAN: any. After connect() both should lie on it.
bool pose_oracle_joined(const pose_oracle *self, const double from[3], const double to[3]);
#endif
