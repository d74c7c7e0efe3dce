// Loss of speed and spin per second, relative to the tank [paper, section 3.1].
#include "float_bodies.hpp"
#include "library.hpp"

namespace lilytank {
namespace {

class Damping final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"D_linear", "1", 0.332, 0, 0.999,
       "share of the speed lost in a second [Table 1: Lilies 0.332, balls 0.3483]"},
      {"D_angular", "1", 0.12, 0, 0.999,
       "share of the spin lost in a second [Table 1: Lilies 0.12, balls 0.2476]"},
  };

 public:
  std::string_view name() const override { return "damping"; }
  std::string_view summary() const override {
    return "loss of each body's own speed and spin, relative to the tank, at the end of a step";
  }
  std::string_view equation() const override {
    return "v *= (1 - D_linear)^dt, omega *= (1 - D_angular)^dt, dt in s; acts on every module of "
           "an assembly, which keeps the sum of their momenta  [paper, section 3.1]";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool baseline() const override { return true; }
  std::unique_ptr<LaneForce> in_lanes(const Model&, std::span<const double>) const override {
    return std::make_unique<LaneForce>();
  }
  Decay decay(std::span<const double> p, double dt) const override {
    return {pow_portable(1 - p[0], dt), pow_portable(1 - p[1], dt)};
  }
};

}  // namespace

const ForceTerm& damping() {
  static const Damping term;
  return term;
}

}  // namespace lilytank
