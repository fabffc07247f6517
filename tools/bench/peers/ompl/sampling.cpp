// OMPL's sampling planners on one leg of a scene: the first path of each, and its length as time goes by.
//
// Words on standard input, in m and s:
//     planner  first_seed  seeds  cap  x_min y_min x_max y_max (of the centre)  radius  x0 y0 x1 y1
//     polygons  { vertices x y ... } ...
// planner: RRT, RRTstar, RRTConnect, InformedRRTstar, BITstar, PRM, PRMstar; OMPL's own defaults. JSON out, one object per
// seed: {"first_ms", "first", "at", "path", "nodes", "bytes"}: lengths at 1, 5, 20 and 100 ms, the last path, nodes and the
// heap bytes of all; null where there is none. Nothing is simplified. Times are the processor's; it is asked for the time
// every 32nd time that a planner wants to know it, for that is dear. Motions are tested as in scene.h: exactly.
#include "scene.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
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
#include <malloc.h>

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
    std::size_t mark = 0, nodes = 0, bytes = 0;
    std::vector<Point> path;

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

static std::vector<Point> points_of(const og::PathGeometric &path) {
    std::vector<Point> out;
    for (std::size_t i = 0; i < path.getStateCount(); i++) {
        out.push_back(point_of(path.getState(i)));
    }
    return out;
}

// PRM and PRM* grown as OMPL's solve() does in its first 0.2 s, milestone by milestone, but in one thread: solve() looks for a
// way once a millisecond from a second one. Here it is looked for as soon as both ends hang together, and at each mark.
class SteppedPRM : public og::PRM {
  public:
    SteppedPRM(const ob::SpaceInformationPtr &si, bool star) : og::PRM(si, star) {}

    void run(Outcome &out, double began, double cap_ms) {
        ob::State *drawn = si_->allocState();
        const auto sampler = si_->allocValidStateSampler();
        startM_.push_back(addMilestone(si_->cloneState(pis_.nextStart())));
        goalM_.push_back(addMilestone(si_->cloneState(pis_.nextGoal())));
        double now = 0.0;
        for (unsigned i = 0; now < cap_ms; i++) {
            const bool is_first = out.first == none && sameComponent(startM_[0], goalM_[0]);
            if (i % 32 == 0 || is_first) {
                now = ms_now() - began;
            }
            if (is_first) {
                look(out);
                out.note(ms_now() - began, out.last);
            } else if (out.mark < 4 && now > marks[out.mark]) {
                look(out); // what it has at the mark is its, though it takes a little longer to tell
                out.pass(now);
            }
            if (sampler->sample(drawn)) {
                addMilestone(si_->cloneState(drawn));
            }
        }
        look(out);
        si_->freeState(drawn);
    }

  private:
    void look(Outcome &out) {
        if (!sameComponent(startM_[0], goalM_[0])) {
            return;
        }
        const ob::PathPtr found = constructSolution(startM_[0], goalM_[0]);
        if (found && found->length() < out.last) {
            out.path = points_of(*found->as<og::PathGeometric>());
            out.last = found->length();
        }
    }
};

static og::SimpleSetup setup_of(const Leg &leg) {
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
    return setup;
}

static void solve(og::SimpleSetup &setup, Outcome &out, double cap_ms) {
    double began = 0.0;
    unsigned asked = 0;
    bool is_over = false;
    setup.getProblemDefinition()->setIntermediateSolutionCallback(
        [&](const ob::Planner *, const std::vector<const ob::State *> &, const ob::Cost cost) {
            out.note(ms_now() - began, cost.value());
        });
    began = ms_now();
    setup.solve(ob::PlannerTerminationCondition([&] {
        is_over = is_over || (++asked % 32 == 0 && ms_now() - began > cap_ms);
        return is_over;
    }));
    if (setup.haveExactSolutionPath()) {
        out.note(ms_now() - began, setup.getSolutionPath().length());
        out.path = points_of(setup.getSolutionPath());
    }
}

static Outcome run(const std::string &name, const Leg &leg, double cap_ms) {
    og::SimpleSetup setup = setup_of(leg);
    const bool is_prm = name == "PRM" || name == "PRMstar";
    const auto prm = std::make_shared<SteppedPRM>(setup.getSpaceInformation(), name == "PRMstar");
    setup.setPlanner(is_prm ? prm : make(name, setup.getSpaceInformation()));
    setup.setup();
    Outcome out;
    const std::size_t before = mallinfo2().uordblks;
    if (is_prm) {
        prm->run(out, ms_now(), cap_ms);
    } else {
        solve(setup, out, cap_ms);
    }
    out.pass(none);
    out.bytes = mallinfo2().uordblks - before;
    ob::PlannerData data(setup.getSpaceInformation());
    setup.getPlanner()->getPlannerData(data);
    out.nodes = data.numVertices();
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
    std::printf("], \"path\": [");
    for (std::size_t i = 0; i < out.path.size(); i++) {
        std::printf("%s[%.9f, %.9f]", i > 0 ? ", " : "", out.path[i].x, out.path[i].y);
    }
    std::printf("], \"nodes\": %zu, \"bytes\": %zu}", out.nodes, out.bytes);
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
