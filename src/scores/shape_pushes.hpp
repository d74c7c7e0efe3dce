// Accelerations by nonparametric force laws, one for each knot of each law.
#pragma once
#include <vector>

#include "effects/effects.hpp"
#include "filter/sensitivity.hpp"

namespace lilytank {

/// Laws over the same variable and range share its place between the knots.
class ShapePushes {
 public:
  /// The knots of the first shape begin at feature `first`.
  ShapePushes(const std::vector<Shape>& shapes, std::size_t first);

  /// Sets what shapes along a variable of module `i` do to it; `slip`: the water's velocity
  /// relative to it, m/s. The knots of pairs are set to 0.
  void push(const Model& model, const Kinematics& k, const StepContext& now, const Vec2& slip,
            int i, Pushes& to) const;
  /// Adds what shapes along the gap between modules do to each.
  void push_pairs(const Model& model, const Kinematics& k, std::vector<Pushes>& to) const;

 private:
  struct Law {
    Toward toward;
    std::size_t first = 0;  ///< feature of the first knot
    double size = 0;
  };
  struct Variable {
    ForceCurve curve;  ///< of each law but for the direction
    std::vector<Law> laws;
  };
  std::vector<Variable> alone_, pairs_;
  std::size_t first_, count_;  ///< features
};

}  // namespace lilytank
