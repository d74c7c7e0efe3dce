// The check of the contact solver, written apart from it: corners and projections only.
#include <algorithm>
#include <array>
#include <cmath>

#include "motion.hpp"

namespace lilytank {
namespace {

using Corners = std::array<Vec2, 4>;

Corners corners_of(const Assemblies& a, int i, double side) {
  const Vec2 centre(a.x[i], a.y[i]), u = 0.5 * side * Vec2(a.c[i], a.s[i]), v(-u.y(), u.x());
  return {centre + u + v, centre - u + v, centre - u - v, centre + u - v};
}

struct Range {
  double low, high;
};

Range shadow(const Corners& corners, const Vec2& direction) {
  Range r{corners[0].dot(direction), corners[0].dot(direction)};
  for (const Vec2& p : corners) {
    r.low = std::min(r.low, p.dot(direction));
    r.high = std::max(r.high, p.dot(direction));
  }
  return r;
}

// Least shift that parts two squares: over all side directions, the overlap of their shadows.
double depth(const Corners& p, const Corners& q, double side) {
  double least = 2 * side;
  for (const Corners* square : {&p, &q}) {
    for (int k = 0; k < 2; ++k) {
      const Vec2 direction = ((*square)[k + 1] - (*square)[k]) / side;
      const Range a = shadow(p, direction), b = shadow(q, direction);
      least = std::min(least, std::min(a.high - b.low, b.high - a.low));
    }
  }
  return least;
}

// Least shift that parts a square and a disc: over the sides and the direction to the nearest
// corner.
double depth(const Corners& p, double side, const Vec2& centre, double radius) {
  double least = 2 * (side + radius);
  const auto along = [&](const Vec2& direction) {
    const Range a = shadow(p, direction);
    const double at = centre.dot(direction);
    least = std::min(least, std::min(a.high - (at - radius), at + radius - a.low));
  };
  Vec2 nearest = p[0];
  for (int k = 0; k < 4; ++k) {
    if ((p[k] - centre).squaredNorm() < (nearest - centre).squaredNorm()) nearest = p[k];
  }
  along((p[1] - p[0]) / side), along((p[2] - p[1]) / side);
  const double distance = std::sqrt((nearest - centre).squaredNorm());
  if (distance > 0) along((nearest - centre) / distance);
  return least;
}

struct Check {
  const Model& model;
  const Assemblies& bodies;
  bool is_module(int i) const { return i < model.module.count; }
  Vec2 centre(int i) const { return {bodies.x[i], bodies.y[i]}; }
  double reach(int i) const {
    return is_module(i) ? model.module.side * std::sqrt(0.5) : model.ball.radius;
  }

  double wall(int i) const {
    double farthest = 0;
    if (is_module(i)) {
      for (const Vec2& p : corners_of(bodies, i, model.module.side))
        farthest = std::max(farthest, std::sqrt(p.squaredNorm()));
    } else {
      farthest = std::sqrt(centre(i).squaredNorm()) + model.ball.radius;
    }
    return farthest - model.tank.radius;
  }

  double pair(int i, int j) const {
    const double side = model.module.side, touch = reach(i) + reach(j);
    const double distance2 = (centre(i) - centre(j)).squaredNorm();
    if (distance2 >= touch * touch) return 0;
    if (is_module(j)) return depth(corners_of(bodies, i, side), corners_of(bodies, j, side), side);
    if (is_module(i)) return depth(corners_of(bodies, i, side), side, centre(j), model.ball.radius);
    return touch - std::sqrt(distance2);
  }
};

}  // namespace

double deepest_overlap(const Model& model, const Assemblies& assemblies) {
  return deepest_pair(model, assemblies).depth;
}

Overlap deepest_pair(const Model& model, const Assemblies& assemblies) {
  const Check check{model, assemblies};
  Overlap deepest;
  const auto take = [&](double depth, int a, int b) {
    if (depth > deepest.depth) deepest = {depth, a, b};
  };
  for (const int p : assemblies.live) {
    for (int i = assemblies.first[p]; i >= 0; i = assemblies.next[i]) take(check.wall(i), -1, i);
    for (const int q : assemblies.live) {
      if (q <= p) continue;
      const double dx = assemblies.x[q] - assemblies.x[p], dy = assemblies.y[q] - assemblies.y[p];
      const double near = 2 * (assemblies.reach[p] + assemblies.reach[q]);
      if (dx * dx + dy * dy > near * near) continue;  // member to member, so twice the reach
      for (int i = assemblies.first[p]; i >= 0; i = assemblies.next[i]) {
        for (int j = assemblies.first[q]; j >= 0; j = assemblies.next[j]) {
          const int low = std::min(i, j), high = std::max(i, j);
          take(check.pair(low, high), low, high);
        }
      }
    }
  }
  return deepest;
}

}  // namespace lilytank
