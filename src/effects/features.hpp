// The forces that effects would exert on modules where they are.
#pragma once
#include <memory>
#include <vector>

#include "effects/effects.hpp"
#include "forces/force_sum.hpp"

namespace lilytank {

/// Wrenches of every scored component of every effect at its size, then of those that are beside
/// them, each by its own term. Terms that
/// only add are evaluated alone; what terms do to the water goes through the drag's derivative;
/// what they make of the sum is compared with the sum.
class Features {
 public:
  /// `model`: of these modules; must outlive this.
  Features(const std::vector<Effect>& effects, const std::vector<Effect>& beside,
           const Model& model);
  void find(const Kinematics& k, const StepContext& now);
  std::size_t size() const { return features_.size(); }
  const Wrench& at(std::size_t feature, std::size_t i) const { return wrenches_[feature][i]; }
  const Wrench& drag(std::size_t i) const { return drag_[i]; }
  const Wrench& baseline(std::size_t i) const { return baseline_[i]; }
  /// The drag's change by water that moves along x or y (a m/s) or turns (a rad/s), by a factor on
  /// the flow, and by one on its gusts alone.
  const Wrench& by_x(std::size_t i) const { return by_x_[i]; }
  const Wrench& by_y(std::size_t i) const { return by_y_[i]; }
  const Wrench& by_turning(std::size_t i) const { return by_turning_[i]; }
  const Wrench& by_gain(std::size_t i) const { return by_gain_[i]; }
  const Wrench& by_gusts(std::size_t i) const { return by_gusts_[i]; }
  const Model& model() const { return model_; }

 private:
  struct Feature {
    enum class Kind { adds, stirs, transforms } kind = Kind::adds;
    std::vector<ActiveForce> forces;
    std::unique_ptr<ForceSum> sum;
  };
  void add(const Effect& effect, std::size_t component);
  StepContext derive(const Kinematics& k, const StepContext& now);
  void sum_baseline(const Kinematics& k, const StepContext& now, const StepContext& water);
  void perturb_flow(const ForceTerm& term, const std::vector<double>& p, const Kinematics& k,
                    const StepContext& now, std::vector<Wrench>& out);

  const Model& model_;
  std::vector<Feature> features_;
  std::vector<ActiveForce> drag_only_;
  std::unique_ptr<ForceSum> base_, drag_sum_;
  std::vector<Wrench> baseline_, drag_, by_x_, by_y_, by_turning_, by_gain_, by_gusts_;
  std::vector<double> ux_, uy_, turning_, factor_;
  std::vector<std::vector<Wrench>> wrenches_;
};

}  // namespace lilytank
