// Attraction of modules that are near each other, as of menisci between floating bodies, and its
// mirror image, repulsion.
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "pairs.hpp"

namespace lilytank {
namespace {

constexpr EffectDescription at_range(double range) {
  return {.order = 10,
          .variable = "pair",
          .amplitudes = {{"strength", 5e-3}},
          .held = {{.parameter = "range",
                    .value = range,
                    .low = 0.0015,
                    .high = 0.08,
                    .scanned_from = 0.002}},
          .split = split_by::kLatches};
}
constexpr EffectDescription opposite(EffectDescription of) {
  of.negative_of = pair_attraction;
  return of;
}
constexpr EffectDescription kAttraction[] = {at_range(0.004), at_range(0.012), at_range(0.03)};
constexpr EffectDescription kRepulsion[] = {opposite(kAttraction[0]), opposite(kAttraction[1]),
                                            opposite(kAttraction[2])};

class PairForce final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"strength", "N", 0, 0, 0.1, "force at contact"},
      {"range", "m", 0.012, 0.001, 0.1, "gap over which the force falls by e"},
  };

 public:
  explicit constexpr PairForce(bool attracts) : attracts_(attracts) {}
  std::string_view name() const override {
    return attracts_ ? "pair_attraction" : "pair_repulsion";
  }
  std::string_view summary() const override {
    return attracts_
               ? "attraction between modules along the line of their centres, falling with the gap"
               : "repulsion between modules along the line of their centres, falling with the gap";
  }
  std::string_view equation() const override {
    return attracts_ ? "F = strength exp(-g / range), g = max(0, r - side), r the distance of the "
                       "centres; nothing beyond g = 8 range"
                     : "F = -strength exp(-g / range), g = max(0, r - side), r the distance of the "
                       "centres; nothing beyond g = 8 range";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  std::span<const EffectDescription> effects() const override {
    return attracts_ ? kAttraction : kRepulsion;
  }

  void add(const Model& model, const Kinematics& k, const StepContext&, std::span<const double> p,
           std::span<Wrench> out) const override {
    const double strength = attracts_ ? p[0] : -p[0];
    for_near_pairs(k, model.module.side + 8 * p[1], [&](const NearPair& pair) {
      const double gap = std::fmax(0, pair.r - model.module.side);
      pull_together(pair, strength * exp_portable(-gap / p[1]), out);
    });
  }

 private:
  bool attracts_;
};

}  // namespace

const ForceTerm& pair_attraction() {
  static const PairForce term(true);
  return term;
}
const ForceTerm& pair_repulsion() {
  static const PairForce term(false);
  return term;
}

}  // namespace lilytank
