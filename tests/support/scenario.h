// scenario.h - a scenario of tests/data (JSON, see its README) as messages, for tests in C. Shares nothing with src/ but
// the message structs.
//
// Reads what those files hold and no other JSON: keys bounds, robot, start, goals, obstacles, each once.
#ifndef AISLE_TESTS_SCENARIO_H
#define AISLE_TESTS_SCENARIO_H

#include "aisle/messages.h"

#include <stdbool.h>

// The layout is whole in one part, without its CRC; polygons' ids count from 1, as `aisle` gives them. Its bounds are
// the file's grown by the body's radius, by `margin` where that is above 0, and by 1 mm: the file's hold the centre. The
// vehicle has the body (a point: a disc of 1 mm) and `margin`, else all defaults; the query the start and the goals in
// order, any heading. False, with a line on stderr: the file cannot be read, or is not one of these.
bool scenario_read(const char *path, float margin, aisle_layout_msg *layout, aisle_vehicle_msg *vehicle,
                   aisle_query_msg *query);
#endif
