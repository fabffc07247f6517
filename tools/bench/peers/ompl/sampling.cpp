// OMPL's sampling planners on one leg of a scene: the first path of each, and its length as time goes by.
//
// Words on standard input, in m and s:
//     planner  first_seed  seeds  cap  x_min y_min x_max y_max (of the centre)  radius  x0 y0 x1 y1
//     polygons  { vertices x y ... } ...
// planner: RRT, RRTstar, RRTConnect, InformedRRTstar, BITstar; OMPL's own defaults. JSON out, one object per seed:
// {"first_ms", "first", "at"}: lengths at 1, 5, 20 and 100 ms, null where there is none. Nothing is simplified. Times are the
// processor's. Motions are tested as in scene.h: exactly.
#include "scene.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/RandomNumbers.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

namespace og = ompl::geometric;

static const double marks[] = {1.0, 5.0, 20.0, 100.0}; // ms
static const double none = std::numeric_limits<double>::infinity();

static double ms_now() {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

static ob::PlannerPtr make(const std::string &name, const ob::SpaceInformationPtr &si) {
    if (name == "RRT") {
        return std::make_shared<og::RRT>(si);
    }
    if (name == "RRTstar") {
        return std::make_shared<og::RRTstar>(si);
    }
    if (name == "RRTConnect") {
        return std::make_shared<og::RRTConnect>(si);
    }
    if (name == "InformedRRTstar") {
        return std::make_shared<og::InformedRRTstar>(si);
    }
    if (name == "BITstar") {
        return std::make_shared<og::BITstar>(si);
    }
    std::fprintf(stderr, "no planner %s\n", name.c_str());
    std::exit(1);
}

struct Outcome {
    double first_ms = none, first = none, at[4] = {none, none, none, none}, last = none;
    std::size_t mark = 0;

    void pass(double now) {
        for (; mark < 4 && now > marks[mark]; mark++) {
            at[mark] = last;
        }
    }
    void note(double now, double length) {
        pass(now);
        if (first == none) {
            first_ms = now;
            first = length;
        }
        last = std::min(last, length);
    }
};

static Outcome run(const std::string &name, const Leg &leg, double cap_ms) {
    og::SimpleSetup setup(space_of(leg));
    auto si = setup.getSpaceInformation();
    setup.setStateValidityChecker([](const ob::State *s) { return is_free(point_of(s), point_of(s)); });
    si->setMotionValidator(std::make_shared<ExactMotion>(si));
    ob::ScopedState<> a(setup.getStateSpace()), b(setup.getStateSpace());
    a[0] = leg.start.x, a[1] = leg.start.y, b[0] = leg.goal.x, b[1] = leg.goal.y;
    setup.setStartAndGoalStates(a, b);
    auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(si);
    objective->setCostThreshold(ob::Cost(0.0));
    setup.setOptimizationObjective(objective);
    setup.setPlanner(make(name, si));
    Outcome out;
    double began = 0.0;
    setup.getProblemDefinition()->setIntermediateSolutionCallback(
        [&](const ob::Planner *, const std::vector<const ob::State *> &, const ob::Cost cost) {
            out.note(ms_now() - began, cost.value());
        });
    setup.setup();
    began = ms_now();
    setup.solve(ob::PlannerTerminationCondition([&] { return ms_now() - began > cap_ms; }));
    if (setup.haveExactSolutionPath()) {
        out.note(ms_now() - began, setup.getSolutionPath().length());
    }
    out.pass(none);
    return out;
}

static void print(const Outcome &out, const char *before) {
    const auto number = [](double value) {
        if (value < none) {
            std::printf("%.6f", value);
        } else {
            std::printf("null");
        }
    };
    std::printf("%s{\"first_ms\": ", before);
    number(out.first_ms);
    std::printf(", \"first\": ");
    number(out.first);
    for (int i = 0; i < 4; i++) {
        std::printf(i > 0 ? ", " : ", \"at\": [");
        number(out.at[i]);
    }
    std::printf("]}");
}

int main() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    std::string name;
    double first_seed = 0.0, seeds = 0.0, cap = 0.0;
    std::cin >> name >> first_seed >> seeds >> cap;
    const Leg leg = read_leg();
    read_polygons();
    for (int i = 0; i < static_cast<int>(seeds); i++) {
        ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(first_seed) + static_cast<std::uint_fast32_t>(i));
        print(run(name, leg, 1e3 * cap), i > 0 ? ",\n" : "[");
    }
    std::printf("]\n");
    return 0;
}
