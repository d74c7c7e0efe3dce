#include "effects/features.hpp"

#include <algorithm>

#include "forces/library.hpp"

namespace lilytank {
namespace {

constexpr double kProbe = 0.02;    // m/s, and share of the gain: steps of the drag's derivatives
constexpr double kTurnRate = 0.5;  // rad/s, likewise
constexpr double kGusty = 0.1;     // share of the gusts, likewise

}  // namespace

Features::Features(const std::vector<Effect>& effects, const std::vector<Effect>& beside,
                   const Model& model)
    : model_(model) {
  for (const Effect& effect : effects) {
    for (std::size_t c = 0; effect.scored && c < effect.paths.size(); ++c) add(effect, c);
  }
  for (const Effect& effect : beside) {
    for (std::size_t c = 0; c < effect.paths.size(); ++c) add(effect, c);
  }
  // The list has its place now.
  for (Feature& one : features_) one.sum = std::make_unique<ForceSum>(model_, one.forces);
  const auto n = static_cast<std::size_t>(model.module.count);
  base_ = std::make_unique<ForceSum>(model_);
  for (const ActiveForce& force : model_.forces) {
    if (force.term == &face_drag()) drag_only_.push_back(force);
  }
  drag_sum_ = std::make_unique<ForceSum>(model_, drag_only_);
  for (auto* of : {&baseline_, &drag_, &by_x_, &by_y_, &by_turning_, &by_gain_, &by_gusts_}) {
    of->resize(n);
  }
  for (auto* of : {&ux_, &uy_, &turning_, &factor_}) of->resize(n);
  wrenches_.assign(features_.size(), std::vector<Wrench>(n));
}

void Features::find(const Kinematics& k, const StepContext& now) {
  const StepContext water = derive(k, now);
  sum_baseline(k, now, water);
  for (std::size_t f = 0; f < features_.size(); ++f) {
    Feature& feature = features_[f];
    std::vector<Wrench>& out = wrenches_[f];
    if (feature.kind == Feature::Kind::stirs) {
      perturb_flow(*feature.forces.front().term, feature.forces.front().p, k, now, out);
      continue;
    }
    if (feature.kind == Feature::Kind::adds) {
      (*feature.sum)(k, now, out);
      continue;
    }
    const ActiveForce& term = feature.forces.front();
    std::copy(baseline_.begin(), baseline_.end(), out.begin());
    term.term->transform(model_, k, now, term.p, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].fx -= baseline_[i].fx, out[i].fy -= baseline_[i].fy;
      out[i].torque -= baseline_[i].torque;
    }
  }
}

void Features::add(const Effect& effect, std::size_t component) {
  std::vector<double> amplitudes(effect.paths.size(), 0.0);
  amplitudes[component] = effect.sizes[component];
  Feature feature;
  feature.forces = with_effect(model_, effect, amplitudes).forces;
  std::erase_if(feature.forces,
                [&](const ActiveForce& force) { return force.term != effect.term; });
  for (const ActiveForce& force : feature.forces) {
    if (force.term->transforms()) feature.kind = Feature::Kind::transforms;
    if (force.term->perturbs_flow()) feature.kind = Feature::Kind::stirs;
  }
  features_.push_back(std::move(feature));
}

// The sum of the model's forces, which begins with the drag that is known already.
void Features::sum_baseline(const Kinematics& k, const StepContext& now, const StepContext& water) {
  if (drag_only_.size() != 1 || model_.forces.front().term != &face_drag()) {
    (*base_)(k, now, baseline_);
    return;
  }
  std::copy(drag_.begin(), drag_.end(), baseline_.begin());
  for (const ActiveForce& force : model_.forces) {
    if (force.term != &face_drag()) force.term->add(model_, k, water, force.p, baseline_);
  }
  for (const ActiveForce& force : model_.forces) {
    if (force.term->transforms()) force.term->transform(model_, k, water, force.p, baseline_);
  }
}

// The drag and its derivatives in the flow that the model's own terms perturb, which is returned.
StepContext Features::derive(const Kinematics& k, const StepContext& now) {
  StepContext water = now;
  base_->perturb_flow(k, water);
  const bool stirred = !water.ux.empty();
  const auto drag = [&](double x, double y, double turning, double gain, double gusts,
                        std::vector<Wrench>& out) {
    for (std::size_t i = 0; i < ux_.size(); ++i) {
      ux_[i] = (stirred ? water.ux[i] : 0) + x, uy_[i] = (stirred ? water.uy[i] : 0) + y;
      turning_[i] = (stirred ? water.turning[i] : 0) + turning;
    }
    StepContext other = now;
    other.ux = ux_, other.uy = uy_, other.turning = turning_, other.drag = water.drag;
    other.gain = water.gain + gain, other.gust_gain = water.gust_gain + gusts;
    (*drag_sum_)(k, other, out);
  };
  drag(0, 0, 0, 0, 0, drag_);
  const auto probe = [&](double x, double y, double turning, double gain, double gusts, double step,
                         std::vector<Wrench>& out) {
    drag(x, y, turning, gain, gusts, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].fx = (out[i].fx - drag_[i].fx) / step;
      out[i].fy = (out[i].fy - drag_[i].fy) / step;
      out[i].torque = (out[i].torque - drag_[i].torque) / step;
    }
  };
  probe(kProbe, 0, 0, 0, 0, kProbe, by_x_);
  probe(0, kProbe, 0, 0, 0, kProbe, by_y_);
  probe(0, 0, kTurnRate, 0, 0, kTurnRate, by_turning_);
  probe(0, 0, 0, kProbe, 0, kProbe, by_gain_);
  probe(0, 0, 0, 0, kGusty, kGusty, by_gusts_);
  return water;
}

void Features::perturb_flow(const ForceTerm& term, const std::vector<double>& p,
                            const Kinematics& k, const StepContext& now, std::vector<Wrench>& out) {
  for (auto* of : {&ux_, &uy_, &turning_}) std::fill(of->begin(), of->end(), 0.0);
  std::fill(factor_.begin(), factor_.end(), 1.0);
  FlowPerturbation water{1, ux_, uy_, turning_, 1, factor_};
  term.perturb_flow(model_, k, now, p, water);
  const double gain = water.gain - 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Wrench &x = by_x_[i], &y = by_y_[i], &turned = by_turning_[i], &all = by_gain_[i];
    const double ux = ux_[i], uy = uy_[i], turning = turning_[i], more = factor_[i] - 1;
    const auto sum = [&](double Wrench::*part) {
      return x.*part * ux + y.*part * uy + turned.*part * turning + all.*part * gain +
             drag_[i].*part * more;
    };
    out[i] = {sum(&Wrench::fx), sum(&Wrench::fy), sum(&Wrench::torque)};
  }
}

}  // namespace lilytank
