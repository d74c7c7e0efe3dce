#include "forces/force_sum.hpp"

#include <algorithm>

#include "forces/face_drag_kernel.hpp"
#include "forces/library.hpp"

namespace lilytank {

Decay total_decay(const std::vector<ActiveForce>& forces, double dt) {
  Decay all;
  for (const ActiveForce& force : forces) {
    const Decay one = force.term->decay(force.p, dt);
    all.linear *= one.linear, all.angular *= one.angular;
  }
  return all;
}

ForceSum::ForceSum(const Model& model, const std::vector<ActiveForce>& forces)
    : model_(&model), forces_(&forces) {
  for (const ActiveForce& force : forces) {
    if (force.term->perturbs_flow()) stirring_.push_back(&force);
    if (force.term->transforms()) transforming_.push_back(&force);
    lanes_.push_back(force.term->in_lanes(model, force.p));
    if (force.term == &face_drag() && model.steps_per_tick > 1)
      gusts_ = {model.module.count, gust_numbers(model.flow.gusts, static_cast<int>(force.p[1]))};
  }
  // What changes the water or the sum must meet all terms.
  if (!stirring_.empty() || !transforming_.empty()) {
    for (auto& lane : lanes_) lane.reset();
  }
  if (std::find(lanes_.begin(), lanes_.end(), nullptr) != lanes_.end())
    wrenches_.resize(static_cast<std::size_t>(model.bodies()));
  if (stirring_.empty()) return;
  std::stable_partition(stirring_.begin(), stirring_.end(),
                        [](const ActiveForce* force) { return force->term->sets_gain(); });
  stirred_x_.resize(static_cast<std::size_t>(model.bodies()));
  stirred_y_.resize(stirred_x_.size()), stirred_turning_.resize(stirred_x_.size());
  drag_.resize(stirred_x_.size());
}

void ForceSum::perturb_flow(const Kinematics& k, StepContext& now) {
  if (stirring_.empty()) return;
  std::fill(stirred_x_.begin(), stirred_x_.end(), 0.0);
  std::fill(stirred_y_.begin(), stirred_y_.end(), 0.0);
  std::fill(stirred_turning_.begin(), stirred_turning_.end(), 0.0);
  std::fill(drag_.begin(), drag_.end(), 1.0);
  now.ux = stirred_x_, now.uy = stirred_y_, now.turning = stirred_turning_, now.drag = drag_;
  FlowPerturbation water{1, stirred_x_, stirred_y_, stirred_turning_, 1, drag_};
  for (const ActiveForce* force : stirring_) {
    force->term->perturb_flow(*model_, k, now, force->p, water);
    now.gain = water.gain, now.gust_gain = water.gust_gain;
  }
}

void ForceSum::operator()(const Kinematics& k, StepContext now, std::span<Wrench> out) {
  std::fill(out.begin(), out.end(), Wrench{});
  now.kept = &gusts_;
  perturb_flow(k, now);
  for (const ActiveForce& force : *forces_) force.term->add(*model_, k, now, force.p, out);
  for (const ActiveForce* force : transforming_)
    force->term->transform(*model_, k, now, force->p, out);
}

void ForceSum::operator()(const FloatBodies& b, const Kinematics& k, StepContext now) {
  const auto padded =
      static_cast<std::size_t>((b.count + kBulkBodies - 1) / kBulkBodies * kBulkBodies);
  for (float* f : {b.fx, b.fy, b.torque}) std::fill_n(f, padded, 0.0f);
  now.kept = &gusts_;
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  perturb_flow(k, now);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const ActiveForce& force = (*forces_)[i];
    if (lanes_[i] != nullptr)
      lanes_[i]->add(b, now);
    else
      force.term->add(*model_, k, now, force.p, wrenches_);
  }
  for (const ActiveForce* force : transforming_)
    force->term->transform(*model_, k, now, force->p, wrenches_);
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    const Wrench& w = wrenches_[i];
    b.fx[i] += static_cast<float>(w.fx), b.fy[i] += static_cast<float>(w.fy);
    b.torque[i] += static_cast<float>(w.torque);
  }
}

}  // namespace lilytank
