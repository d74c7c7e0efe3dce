#include "scores/shape_pushes.hpp"

#include <algorithm>
#include <cmath>

#include "forces/pairs.hpp"

namespace lilytank {
namespace {

// Slots of both knots that a value lies between, and their shares of a force of size 1.
struct KnotPushes {
  std::size_t first, second;
  double of_first, of_second;

  void add(double acceleration, std::vector<float>& to) const {
    to[first] += static_cast<float>(of_first * acceleration);
    to[second] += static_cast<float>(of_second * acceleration);
  }
};

KnotPushes pushes_at(const KnotShare& at, std::size_t first, double size, double sign) {
  return {first + static_cast<std::size_t>(at.first), first + static_cast<std::size_t>(at.second),
          sign * (1 - at.share) * size, sign * at.share * size};
}

double value_at(Along along, const Model& model, const Kinematics& k, const StepContext& now,
                const Vec2& slip, int i) {
  return along == Along::slip ? slip.norm() : value_along(along, model, k, now, i);
}

// Of a force; torques have no direction.
Vec2 direction(Toward toward, const Model& model, const Kinematics& k, const StepContext& now,
               const Vec2& slip, int i) {
  if (toward != Toward::slip && toward != Toward::across_slip) {
    const Wrench unit = unit_toward(toward, model, k, now, i);
    return {unit.fx, unit.fy};
  }
  const double speed = std::sqrt(slip.x() * slip.x() + slip.y() * slip.y());
  if (!(speed > 0)) return Vec2::Zero();
  if (toward == Toward::slip) return {slip.x() / speed, slip.y() / speed};
  return {-slip.y() / speed, slip.x() / speed};
}

}  // namespace

ShapePushes::ShapePushes(const std::vector<Shape>& shapes, std::size_t first)
    : first_(first), count_(shapes.size() * kKnots) {
  for (const Shape& shape : shapes) {
    const ForceCurve& own = shape.curve;
    std::vector<Variable>& all = own.along == Along::gap ? pairs_ : alone_;
    auto of = std::find_if(all.begin(), all.end(), [&](const Variable& v) {
      return v.curve.along == own.along && v.curve.low == own.low && v.curve.high == own.high;
    });
    if (of == all.end()) of = all.insert(all.end(), {own, {}});
    of->laws.push_back({own.toward, first, shape.size});
    first += kKnots;
  }
}

void ShapePushes::push(const Model& model, const Kinematics& k, const StepContext& now,
                       const Vec2& slip, int i, Pushes& to) const {
  for (auto* of : {&to.x, &to.y, &to.turn}) {
    std::fill_n(of->begin() + static_cast<std::ptrdiff_t>(first_), count_, 0.0f);
  }
  const double mass = model.module.mass, torque = 1 / model.module.inertia();
  for (const Variable& variable : alone_) {
    const double value = value_at(variable.curve.along, model, k, now, slip, i);
    const KnotShare at = place_on(variable.curve, value);
    for (const Law& law : variable.laws) {
      const KnotPushes knots = pushes_at(at, law.first, law.size, 1);
      if (law.toward == Toward::torque) {
        knots.add(torque, to.turn);
        continue;
      }
      const Vec2 unit = direction(law.toward, model, k, now, slip, i);
      knots.add(unit.x() / mass, to.x), knots.add(unit.y() / mass, to.y);
    }
  }
}

void ShapePushes::push_pairs(const Model& model, const Kinematics& k,
                             std::vector<Pushes>& to) const {
  const double side = model.module.side, mass = model.module.mass;
  const double torque = 1 / model.module.inertia();
  for (const Variable& variable : pairs_) {
    for_near_pairs(k, variable.curve.high + side, [&](const NearPair& pair) {
      const KnotShare at = place_on(variable.curve, pair.r - side);
      Pushes &one = to[static_cast<std::size_t>(pair.i)],
             &two = to[static_cast<std::size_t>(pair.j)];
      const double x = pair.dx / pair.r, y = pair.dy / pair.r;
      for (const Law& law : variable.laws) {
        const KnotPushes forth = pushes_at(at, law.first, law.size, 1);
        if (law.toward == Toward::torque) {
          forth.add(torque, one.turn), forth.add(torque, two.turn);
          continue;
        }
        const KnotPushes back = pushes_at(at, law.first, law.size, -1);
        const bool out = law.toward == Toward::out;
        const double ax = (out ? x : -y) / mass, ay = (out ? y : x) / mass;
        back.add(ax, one.x), back.add(ay, one.y), forth.add(ax, two.x), forth.add(ay, two.y);
      }
    });
  }
}

}  // namespace lilytank
