// OMPL's planners on one leg of a scene: when do planner and PathSimplifier together reach a given length?
//
// Numbers on standard input, in m and s:
//     x_min y_min x_max y_max (of the centre)  radius  x0 y0 x1 y1  length  cap  polygons  { vertices x y ... } ...
// JSON out: {"planner": which was first or null, "ms": when, "cap": s, "best": least ratio to `length` of any}
// Motions are tested as in scene.h: exactly.
#include "scene.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/RandomNumbers.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

namespace og = ompl::geometric;

struct Task {
    Leg leg;
    double length, cap;
};

static Task read_task() {
    Task t{};
    t.leg = read_leg();
    std::cin >> t.length >> t.cap;
    read_polygons();
    return t;
}

using Make = std::function<ob::PlannerPtr(const ob::SpaceInformationPtr &)>;

struct Outcome {
    double ms = std::numeric_limits<double>::infinity(); // when the length was reached
    double best = std::numeric_limits<double>::infinity();
};

// Short slices: solve, simplify a copy, look at its length, on.
static Outcome run(const Task &t, const Make &make) {
    og::SimpleSetup setup(space_of(t.leg));
    auto si = setup.getSpaceInformation();
    setup.setStateValidityChecker([](const ob::State *s) { return is_free(point_of(s), point_of(s)); });
    si->setMotionValidator(std::make_shared<ExactMotion>(si));
    ob::ScopedState<> a(setup.getStateSpace()), b(setup.getStateSpace());
    a[0] = t.leg.start.x, a[1] = t.leg.start.y, b[0] = t.leg.goal.x, b[1] = t.leg.goal.y;
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
