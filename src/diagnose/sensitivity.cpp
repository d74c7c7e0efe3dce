#include "diagnose/sensitivity.hpp"

#include <algorithm>

namespace lilytank {
namespace {

// One coordinate of all features over one frame. `found`: the innovation by its variance, 0 if it
// does not count; `weight`: one over the variance, likewise.
struct Axis {
  float dt, keep, gain_x, gain_v, found, weight;
};

void pass_axis(const Axis& a, std::size_t n, const float* __restrict push, float* __restrict x,
               float* __restrict v, double* __restrict score, double* __restrict information) {
  const float half = 0.5f * a.dt;
  for (std::size_t f = 0; f < n; ++f) {
    const float at = x[f] + a.dt * (v[f] + half * push[f]);
    const float speed = a.keep * v[f] + a.dt * push[f];
    score[f] += static_cast<double>(a.found * at);
    information[f] += static_cast<double>(a.weight * at * at);
    x[f] = at - a.gain_x * at, v[f] = speed - a.gain_v * at;
  }
}

}  // namespace

Sensitivities::Sensitivities(std::size_t features, std::size_t modules)
    : features_(features), score_(features), information_(features) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) of->assign(features * modules, 0.0f);
}

void Sensitivities::forget(std::size_t module) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) {
    const auto begin = of->begin() + static_cast<std::ptrdiff_t>(module * features_);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(features_), 0.0f);
  }
}

void Sensitivities::pass(std::size_t module, const Pushes& pushes, const PredictedFrame& frame,
                         std::size_t i, double loss, bool told) {
  const std::size_t at = module * features_;
  const auto dt = static_cast<float>(frame.interval);
  const auto axis = [&](double innovation, double sd, double gain_x, double gain_v) {
    const double weight = told ? 1 / (sd * sd) : 0;
    return Axis{dt,
                static_cast<float>(1 - loss * frame.interval),
                static_cast<float>(gain_x),
                static_cast<float>(gain_v),
                told ? static_cast<float>(weight * innovation) : 0.0f,
                static_cast<float>(weight)};
  };
  const auto place = [&](double innovation) {
    return axis(innovation, frame.sd_x[i], frame.gain_x[i], frame.gain_v[i]);
  };
  double *score = score_.data(), *information = information_.data();
  pass_axis(place(frame.dx[i]), features_, pushes.x.data(), &x_[at], &vx_[at], score, information);
  pass_axis(place(frame.dy[i]), features_, pushes.y.data(), &y_[at], &vy_[at], score, information);
  pass_axis(axis(frame.dtheta[i], frame.sd_theta[i], frame.gain_theta[i], frame.gain_omega[i]),
            features_, pushes.turn.data(), &t_[at], &w_[at], score, information);
}

double Sensitivities::estimate(std::size_t feature, double known) const {
  return information_[feature] > 0 ? score_[feature] / (information_[feature] + known) : 0;
}

}  // namespace lilytank
