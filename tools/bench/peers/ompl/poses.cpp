// OMPL's planners for a body with a heading on one leg of a scene: the first path, and what there is after a time.
//
// Words on standard input, in m, rad and s:
//     planner seed x_min y_min x_max y_max turning_radius cap  n x y ... (the body, counter-clockwise, about its origin)
//     x y theta (start)  x y theta (goal)  polygons  { n x y ... (convex, counter-clockwise) } ...
// planner: RRTConnect, BITstar (both over SE(2)) or ReedsShepp (BIT* over ways of Reeds and Shepp).
// JSON out: {"first_ms", "first" (length), "last" (length at the end), "first_poses", "last_poses": a pose a centimetre};
// nulls where nothing was found in time. Paths are simplified before they are measured, and the time counts that.
// Times are the processor's. The body is tested exactly every 5 cm, polygons near it found by a grid.
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

static const double CHECK = 0.05, CELL = 2.0; // m

struct Point {
    double x, y;
};
using Polygon = std::vector<Point>;

struct Scene {
    std::string planner;
    unsigned seed = 0;
    double box[4] = {}, turning = 0.0, cap = 0.0, start[3] = {}, goal[3] = {}, around = 0.0; // around: of the body
    Polygon body;
    std::vector<Polygon> polygons;
    int nx = 0, ny = 0;
    std::vector<std::vector<int>> near; // of each cell: polygons that a body whose origin is there might meet
};

static Polygon read_polygon() {
    std::size_t n = 0;
    std::cin >> n;
    Polygon out(n);
    for (Point &p : out) {
        std::cin >> p.x >> p.y;
    }
    return out;
}

static void index_polygon(Scene &s, int which) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const Point &p : s.polygons[static_cast<std::size_t>(which)]) {
        x0 = std::min(x0, p.x), y0 = std::min(y0, p.y), x1 = std::max(x1, p.x), y1 = std::max(y1, p.y);
    }
    const auto cell = [](double at, double low, int n) {
        return std::clamp(static_cast<int>(std::floor((at - low) / CELL)), 0, n - 1);
    };
    for (int iy = cell(y0 - s.around, s.box[1], s.ny); iy <= cell(y1 + s.around, s.box[1], s.ny); iy++) {
        for (int ix = cell(x0 - s.around, s.box[0], s.nx); ix <= cell(x1 + s.around, s.box[0], s.nx); ix++) {
            s.near[static_cast<std::size_t>(iy * s.nx + ix)].push_back(which);
        }
    }
}

static Scene read_scene() {
    Scene s;
    std::size_t n = 0;
    std::cin >> s.planner >> s.seed >> s.box[0] >> s.box[1] >> s.box[2] >> s.box[3] >> s.turning >> s.cap;
    s.body = read_polygon();
    for (double &v : s.start) {
        std::cin >> v;
    }
    for (double &v : s.goal) {
        std::cin >> v;
    }
    std::cin >> n;
    for (const Point &p : s.body) {
        s.around = std::max(s.around, std::hypot(p.x, p.y));
    }
    s.nx = static_cast<int>((s.box[2] - s.box[0]) / CELL) + 1;
    s.ny = static_cast<int>((s.box[3] - s.box[1]) / CELL) + 1;
    s.near.resize(static_cast<std::size_t>(s.nx * s.ny));
    for (std::size_t i = 0; i < n; i++) {
        s.polygons.push_back(read_polygon());
        index_polygon(s, static_cast<int>(i));
    }
    return s;
}

// Does an edge of a have all of b on its outer side?
static bool parts(const Polygon &a, const Polygon &b) {
    for (std::size_t i = 0; i < a.size(); i++) {
        const Point p = a[i], q = a[(i + 1) % a.size()];
        if (std::all_of(b.begin(), b.end(),
                        [&](Point r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) <= 0.0; })) {
            return true;
        }
    }
    return false;
}

static bool is_free(const Scene &s, double x, double y, double theta) {
    const double c = std::cos(theta), t = std::sin(theta);
    thread_local Polygon placed;
    placed.clear();
    for (const Point &p : s.body) {
        const Point q{x + c * p.x - t * p.y, y + t * p.x + c * p.y};
        if (q.x < s.box[0] || q.y < s.box[1] || q.x > s.box[2] || q.y > s.box[3]) {
            return false;
        }
        placed.push_back(q);
    }
    const int ix = static_cast<int>((x - s.box[0]) / CELL), iy = static_cast<int>((y - s.box[1]) / CELL);
    const auto &near = s.near[static_cast<std::size_t>(iy * s.nx + ix)];
    return std::all_of(near.begin(), near.end(), [&](int i) {
        const Polygon &p = s.polygons[static_cast<std::size_t>(i)];
        return parts(placed, p) || parts(p, placed);
    });
}

static double seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The path's places every centimetre, and their length over the ground.
static std::vector<double> poses_of(og::PathGeometric path, double &length) {
    std::vector<double> out;
    path.interpolate(static_cast<unsigned>(std::max(2.0, std::ceil(path.length() / 0.01))));
    length = 0.0;
    for (std::size_t i = 0; i < path.getStateCount(); i++) {
        const auto *v = path.getState(i)->as<ob::SE2StateSpace::StateType>();
        if (i > 0) {
            length += std::hypot(v->getX() - out[out.size() - 3], v->getY() - out[out.size() - 2]);
        }
        out.insert(out.end(), {v->getX(), v->getY(), v->getYaw()});
    }
    return out;
}

static void print_poses(const char *name, const std::vector<double> &poses) {
    std::printf(", \"%s\": [", name);
    for (std::size_t i = 0; i + 2 < poses.size(); i += 3) {
        std::printf("%s[%.6f,%.6f,%.6f]", i > 0 ? "," : "", poses[i], poses[i + 1], poses[i + 2]);
    }
    std::printf("]");
}

static ob::StateSpacePtr space_of(const Scene &s) {
    std::shared_ptr<ob::SE2StateSpace> space;
    if (s.planner == "ReedsShepp") {
        space = std::make_shared<ob::ReedsSheppStateSpace>(s.turning);
    } else {
        space = std::make_shared<ob::SE2StateSpace>();
    }
    ob::RealVectorBounds bounds(2);
    for (unsigned i = 0; i < 2; i++) {
        bounds.setLow(i, s.box[i]);
        bounds.setHigh(i, s.box[i + 2]);
    }
    space->setBounds(bounds);
    return space;
}

static void set_up(og::SimpleSetup &setup, const Scene &s) {
    auto si = setup.getSpaceInformation();
    setup.setStateValidityChecker([&s](const ob::State *state) {
        const auto *v = state->as<ob::SE2StateSpace::StateType>();
        return is_free(s, v->getX(), v->getY(), v->getYaw());
    });
    si->setStateValidityCheckingResolution(CHECK / setup.getStateSpace()->getMaximumExtent());
    ob::ScopedState<ob::SE2StateSpace> a(setup.getStateSpace()), b(setup.getStateSpace());
    a->setXY(s.start[0], s.start[1]);
    a->setYaw(s.start[2]);
    b->setXY(s.goal[0], s.goal[1]);
    b->setYaw(s.goal[2]);
    a.enforceBounds();
    b.enforceBounds();
    setup.setStartAndGoalStates(a, b);
    setup.setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(si));
    if (s.planner == "RRTConnect") {
        setup.setPlanner(std::make_shared<og::RRTConnect>(si));
    } else {
        setup.setPlanner(std::make_shared<og::BITstar>(si));
    }
    setup.setup();
    if (!si->isValid(a.get()) || !si->isValid(b.get()) || !a.satisfiesBounds() ||
        !b.satisfiesBounds()) { // it would wait for better ones without end
        std::fprintf(stderr, "an end is not free\n");
        std::exit(1);
    }
}

int main() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const Scene s = read_scene();
    ompl::RNG::setSeed(s.seed);
    og::SimpleSetup setup(space_of(s));
    set_up(setup, s);
    std::vector<double> first_poses, last_poses;
    double first = 0.0, last = std::numeric_limits<double>::infinity(), first_ms = 0.0;
    const double began = seconds();
    for (double end = began + s.cap; seconds() < end;) {
        const double slice = last_poses.empty() ? end : std::min(end, seconds() + 0.1);
        const bool one = first_poses.empty();
        if (auto *bit = setup.getPlanner()->as<og::BITstar>(); s.planner != "RRTConnect") {
            bit->setStopOnSolnImprovement(one);
        }
        setup.solve(ob::PlannerTerminationCondition([&] { return seconds() >= slice; }));
        if (setup.haveExactSolutionPath()) {
            og::PathGeometric path(setup.getSolutionPath());
            og::PathSimplifier(setup.getSpaceInformation())
                .simplify(path, ob::PlannerTerminationCondition([&] { return seconds() >= end; }), false);
            const double now = seconds();
            double length = 0.0;
            const std::vector<double> poses = poses_of(path, length);
            if (first_poses.empty()) {
                first_poses = poses, first = length, first_ms = 1e3 * (now - began);
            }
            if (length < last) {
                last_poses = poses, last = length;
            }
        }
        if (s.planner == "RRTConnect") { // it has no better one: again from nothing
            setup.clear();
        }
    }
    if (first_poses.empty()) {
        std::printf("{\"first_ms\": null}\n");
        return 0;
    }
    std::printf("{\"first_ms\": %.4f, \"first\": %.6f, \"last\": %.6f", first_ms, first, last);
    print_poses("first_poses", first_poses);
    print_poses("last_poses", last_poses);
    std::printf("}\n");
    return 0;
}
