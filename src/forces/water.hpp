// The water's mean velocity where a body is, for terms that need it.
#pragma once
#include "lilytank/force.hpp"
#include "lilytank/model.hpp"

namespace lilytank {

/// The field's mean velocity at a point (m/s), with its factors.
inline Vec2 mean_flow(const Model& model, const StepContext& now, double x, double y) {
  const FlowSample f = field_now(model, now).at(x, y);
  const double K_v = model.flow.K_v * now.gain;
  return {K_v * f.mu_x, K_v * f.mu_y};
}

/// The mean velocity of the water at body i, with its perturbations (m/s).
inline Vec2 water_at(const Model& model, const Kinematics& k, const StepContext& now, int i) {
  Vec2 u = mean_flow(model, now, k.x[i], k.y[i]);
  if (!now.ux.empty()) u += Vec2(now.ux[i], now.uy[i]);
  return u;
}

/// Mean velocity relative to body i (m/s).
inline Vec2 slip_of(const Model& model, const Kinematics& k, const StepContext& now, int i) {
  return water_at(model, k, now, i) - Vec2(k.vx[i], k.vy[i]);
}

/// Derivatives of the field's mean velocity at a point (1/s), over a side of a module.
struct FlowGradient {
  Vec2 by_x, by_y;
  double curl() const { return by_x.y() - by_y.x(); }
};
inline FlowGradient gradient_at(const Model& model, const StepContext& now, double x, double y) {
  const double h = model.module.side / 2;
  const auto at = [&](double px, double py) { return mean_flow(model, now, px, py); };
  return {(at(x + h, y) - at(x - h, y)) / (2 * h), (at(x, y + h) - at(x, y - h)) / (2 * h)};
}

}  // namespace lilytank
