// hall_route.h - test fixture: a route carved beside hall.h's hall.
#ifndef AISLE_TESTS_HALL_ROUTE_H
#define AISLE_TESTS_HALL_ROUTE_H

#include "hall.h"
#include "plan/route.h"

#include <string.h>

// Opens the hall as drawn, and a route over it with a budget of so many work units.
HALL_UNUSED void hall_open_route(aisle_route *route, const aisle_limits *limits, uint32_t budget) {
    aisle_arena arena = hall_arena(24U << 20);
    memset(route, 0, sizeof *route);
    aisle_route_carve(route, &arena, limits);
    aisle_route_carve_roadmap(route, &arena, limits);
    route->budget_default = budget;
    hall_open(&arena, 0.05F);
}
#endif
