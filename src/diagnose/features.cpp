#include "diagnose/features.hpp"

#include <algorithm>

namespace lilytank {
namespace {

constexpr double kProbe = 0.02;  // m/s, and share of the gain: steps of the drag's derivatives

}  // namespace

Features::Features(const ScorePlan& plan, const Model& model) : model_(model) {
  for (const Effect& effect : plan.effects) {
    for (std::size_t c = 0; effect.scored && c < effect.paths.size(); ++c) add(effect, c);
  }
  // The list has its place now.
  for (Feature& one : features_) one.sum = std::make_unique<ForceSum>(model_, one.forces);
  const auto n = static_cast<std::size_t>(model.module.count);
  base_ = std::make_unique<ForceSum>(model_);
  for (const ActiveForce& force : model_.forces) {
    if (force.term->name() == "face_drag") drag_only_.push_back(force);
  }
  drag_sum_ = std::make_unique<ForceSum>(model_, drag_only_);
  for (auto* of : {&baseline_, &drag_, &by_x_, &by_y_, &by_gain_}) of->resize(n);
  for (auto* of : {&ux_, &uy_, &probe_, &none_}) of->resize(n);
  std::fill(probe_.begin(), probe_.end(), kProbe);
  wrenches_.assign(features_.size(), std::vector<Wrench>(n));
}

void Features::find(const Kinematics& k, const Moment& now) {
  (*base_)(k, now, baseline_), (*drag_sum_)(k, now, drag_);
  derive(k, now);
  for (std::size_t f = 0; f < features_.size(); ++f) {
    Feature& feature = features_[f];
    std::vector<Wrench>& out = wrenches_[f];
    if (feature.kind == Feature::Kind::stirs) {
      stir(*feature.forces.front().term, feature.forces.front().p, k, now, out);
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
  const std::string term = effect.paths[0].substr(7, effect.paths[0].rfind('.') - 7);
  for (const ActiveForce& force : feature.forces) {
    if (force.term->name() != term) continue;
    if (force.term->transforms()) feature.kind = Feature::Kind::transforms;
    if (force.term->stirs()) feature.kind = Feature::Kind::stirs;
  }
  std::erase_if(feature.forces,
                [&](const ActiveForce& force) { return force.term->name() != term; });
  features_.push_back(std::move(feature));
}

// The drag's change by water that moves along x, along y, and by the gain of the whole flow.
void Features::derive(const Kinematics& k, const Moment& now) {
  const auto probe = [&](std::span<const double> ux, std::span<const double> uy, double gain,
                         std::vector<Wrench>& out) {
    Moment other = now;
    other.ux = ux, other.uy = uy, other.gain = gain;
    (*drag_sum_)(k, other, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].fx = (out[i].fx - drag_[i].fx) / kProbe;
      out[i].fy = (out[i].fy - drag_[i].fy) / kProbe;
      out[i].torque = (out[i].torque - drag_[i].torque) / kProbe;
    }
  };
  probe(probe_, none_, 1, by_x_), probe(none_, probe_, 1, by_y_);
  probe(none_, none_, 1 + kProbe, by_gain_);
}

void Features::stir(const ForceTerm& term, const std::vector<double>& p, const Kinematics& k,
                    const Moment& now, std::vector<Wrench>& out) {
  std::fill(ux_.begin(), ux_.end(), 0.0), std::fill(uy_.begin(), uy_.end(), 0.0);
  Stirring water{1, ux_, uy_, 1};
  term.stir(model_, k, now, p, water);
  const double gain = water.gain - 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].fx = by_x_[i].fx * ux_[i] + by_y_[i].fx * uy_[i] + by_gain_[i].fx * gain;
    out[i].fy = by_x_[i].fy * ux_[i] + by_y_[i].fy * uy_[i] + by_gain_[i].fy * gain;
    out[i].torque = by_x_[i].torque * ux_[i] + by_y_[i].torque * uy_[i] + by_gain_[i].torque * gain;
  }
}

}  // namespace lilytank
