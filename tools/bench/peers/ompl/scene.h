// scene.h - a scene of convex polygons and a disc for OMPL: its motions, tested exactly.
//
// The segment's distance to every convex polygon, a box around it first.
#ifndef AISLE_PEERS_SCENE_H
#define AISLE_PEERS_SCENE_H

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace ob = ompl::base;

struct Point {
    double x, y;
};

struct Obstacle {
    std::vector<Point> v;
    double x0, y0, x1, y1;
};

inline std::vector<Obstacle> obstacles;
inline double radius;

inline double point_segment(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double t = square > 0.0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0.0;
    t = std::clamp(t, 0.0, 1.0);
    return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

inline double side(Point a, Point b, Point p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

inline bool is_inside(const Obstacle &o, Point p) {
    for (std::size_t i = 0; i < o.v.size(); i++) {
        if (side(o.v[i], o.v[(i + 1) % o.v.size()], p) < 0.0) {
            return false;
        }
    }
    return true;
}

inline bool is_clear(const Obstacle &o, Point a, Point b) {
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

inline bool is_free(Point a, Point b) {
    return std::all_of(obstacles.begin(), obstacles.end(), [&](const Obstacle &o) { return is_clear(o, a, b); });
}

inline Point point_of(const ob::State *s) {
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

struct Leg {
    double box[4];
    Point start, goal;
};

// x_min y_min x_max y_max  radius  x0 y0 x1 y1
inline Leg read_leg() {
    Leg t{};
    std::cin >> t.box[0] >> t.box[1] >> t.box[2] >> t.box[3] >> radius >> t.start.x >> t.start.y >> t.goal.x >>
        t.goal.y;
    return t;
}

inline void read_polygons() {
    double count = 0.0;
    std::cin >> count;
    const auto n = static_cast<std::size_t>(count);
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
}

inline ob::StateSpacePtr space_of(const Leg &leg) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(2);
    ob::RealVectorBounds bounds(2);
    for (unsigned i = 0; i < 2; i++) {
        bounds.setLow(i, leg.box[i]);
        bounds.setHigh(i, leg.box[i + 2]);
    }
    space->setBounds(bounds);
    return space;
}
#endif
