// OMPL's planners on one leg of a scene: when do planner and PathSimplifier together reach a given length?
//
// Numbers on standard input, in m and s:
//     x_min y_min x_max y_max (of the centre)  radius  x0 y0 x1 y1  length  cap  polygons  { vertices x y ... } ...
// JSON out: {"planner": which was first or null, "ms": when, "cap": s, "best": least ratio to `length` of any}
// Motions are tested exactly: the segment's distance to every convex polygon, a box around it first.
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

struct Point {
    double x, y;
};

struct Obstacle {
    std::vector<Point> v;
    double x0, y0, x1, y1;
};

static std::vector<Obstacle> obstacles;
static double radius;

static double point_segment(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double t = square > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0.0;
    t = std::clamp(t, 0.0, 1.0);
    return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

static double side(Point a, Point b, Point p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static bool is_inside(const Obstacle &o, Point p) {
    for (std::size_t i = 0; i < o.v.size(); i++) {
        if (side(o.v[i], o.v[(i + 1) % o.v.size()], p) < 0.0) {
            return false;
        }
    }
    return true;
}

static bool is_clear(const Obstacle &o, Point a, Point b) {
    if (std::max(a.x, b.x) + radius < o.x0 || std::min(a.x, b.x) - radius > o.x1 ||
        std::max(a.y, b.y) + radius < o.y0 || std::min(a.y, b.y) - radius > o.y1) {
        return true;
    }
    if (is_inside(o, a)) {
        return false;
    }
    for (std::size_t i = 0; i < o.v.size(); i++) {
        const Point c = o.v[i], d = o.v[(i + 1) % o.v.size()];
        const bool crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
        const double gap = std::min(std::min(point_segment(a, c, d), point_segment(b, c, d)),
                                    std::min(point_segment(c, a, b), point_segment(d, a, b)));
        if (crosses || gap < radius) {
            return false;
        }
    }
    return true;
}

static bool is_free(Point a, Point b) {
    return std::all_of(obstacles.begin(), obstacles.end(), [&](const Obstacle &o) { return is_clear(o, a, b); });
}

static Point point_of(const ob::State *s) {
    const auto *v = s->as<ob::RealVectorStateSpace::StateType>();
    return {v->values[0], v->values[1]};
}

class ExactMotion : public ob::MotionValidator {
  public:
    explicit ExactMotion(const ob::SpaceInformationPtr &si) : ob::MotionValidator(si) {}
    bool checkMotion(const ob::State *a, const ob::State *b) const override {
        return is_free(point_of(a), point_of(b));
    }
    // The last free place by halving, as the interface asks.
    bool checkMotion(const ob::State *a, const ob::State *b, std::pair<ob::State *, double> &last) const override {
        if (checkMotion(a, b)) {
            return true;
        }
        const Point p = point_of(a), q = point_of(b);
        double good = 0.0, bad = 1.0;
        for (int i = 0; i < 20; i++) {
            const double t = 0.5 * (good + bad);
            (is_free(p, {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)}) ? good : bad) = t;
        }
        last.second = good;
        if (last.first != nullptr) {
            si_->getStateSpace()->interpolate(a, b, good, last.first);
        }
        return false;
    }
};

struct Task {
    double box[4];
    Point start, goal;
    double length, cap;
};

static Task read_task() {
    Task t{};
    std::size_t n = 0;
    std::cin >> t.box[0] >> t.box[1] >> t.box[2] >> t.box[3] >> radius >> t.start.x >> t.start.y >> t.goal.x >>
        t.goal.y >> t.length >> t.cap;
    double count = 0.0;
    std::cin >> count;
    n = static_cast<std::size_t>(count);
    const double far = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < n; i++) {
        Obstacle o{{}, far, far, -far, -far};
        std::cin >> count;
        for (int k = 0; k < static_cast<int>(count); k++) {
            Point p{};
            std::cin >> p.x >> p.y;
            o.v.push_back(p);
            o.x0 = std::min(o.x0, p.x), o.y0 = std::min(o.y0, p.y);
            o.x1 = std::max(o.x1, p.x), o.y1 = std::max(o.y1, p.y);
        }
        obstacles.push_back(o);
    }
    return t;
}

using Make = std::function<ob::PlannerPtr(const ob::SpaceInformationPtr &)>;

struct Outcome {
    double ms = std::numeric_limits<double>::infinity(); // when the length was reached
    double best = std::numeric_limits<double>::infinity();
};

// Short slices: solve, simplify a copy, look at its length, on.
static Outcome run(const Task &t, const Make &make) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(2);
    ob::RealVectorBounds bounds(2);
    for (unsigned i = 0; i < 2; i++) {
        bounds.setLow(i, t.box[i]);
        bounds.setHigh(i, t.box[i + 2]);
    }
    space->setBounds(bounds);
    og::SimpleSetup setup(space);
    auto si = setup.getSpaceInformation();
    setup.setStateValidityChecker([](const ob::State *s) { return is_free(point_of(s), point_of(s)); });
    si->setMotionValidator(std::make_shared<ExactMotion>(si));
    ob::ScopedState<> a(space), b(space);
    a[0] = t.start.x, a[1] = t.start.y, b[0] = t.goal.x, b[1] = t.goal.y;
    setup.setStartAndGoalStates(a, b);
    setup.setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(si));
    setup.setPlanner(make(si));
    setup.setup();
    Outcome out;
    const auto began = std::chrono::steady_clock::now();
    auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };
    for (double slice = 1e-3; passed() < t.cap && !(out.best <= t.length); slice = std::min(2.0 * slice, 0.05)) {
        setup.solve(std::min(slice, t.cap - passed()));
        if (!setup.haveExactSolutionPath()) {
            continue;
        }
        og::PathGeometric path(setup.getSolutionPath());
        og::PathSimplifier simplifier(si);
        simplifier.simplifyMax(path);
        simplifier.shortcutPath(path, 200, 50);
        out.best = std::min(out.best, path.length());
        out.ms = out.best <= t.length ? 1e3 * passed() : out.ms;
    }
    return out;
}

int main() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::RNG::setSeed(20180617);
    const Task t = read_task();
    const std::vector<std::pair<std::string, Make>> planners = {
        {"BITstar", [](auto &si) { return std::make_shared<og::BITstar>(si); }},
        {"RRTstar", [](auto &si) { return std::make_shared<og::RRTstar>(si); }},
        {"InformedRRTstar", [](auto &si) { return std::make_shared<og::InformedRRTstar>(si); }},
        {"PRMstar", [](auto &si) { return std::make_shared<og::PRMstar>(si); }},
        {"RRTConnect", [](auto &si) { return std::make_shared<og::RRTConnect>(si); }}};
    Outcome first;
    std::string winner;
    double best = std::numeric_limits<double>::infinity();
    for (const auto &[name, make] : planners) {
        const Outcome out = run(t, make);
        best = std::min(best, out.best);
        if (out.ms < first.ms) {
            first = out;
            winner = name;
        }
    }
    if (std::isfinite(first.ms)) {
        std::printf("{\"planner\": \"%s\", \"ms\": %.4f", winner.c_str(), first.ms);
    } else {
        std::printf("{\"planner\": null, \"ms\": null");
    }
    std::printf(", \"cap\": %g, \"best\": %.6f}\n", t.cap, std::isfinite(best) ? best / t.length : 0.0);
    return 0;
}
