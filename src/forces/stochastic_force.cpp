// The random force that stands for everything not modelled [paper, section 3.2].
#include <algorithm>
#include <cmath>

#include "float_bodies.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"
#include "math/bulk_random.hpp"

namespace lilytank {
namespace {

double deviation(const Model& model, std::span<const double> p) {
  return p[0] * std::sqrt(static_cast<double>(model.steps_per_tick));
}

class StochasticLanes final : public LaneForce {
 public:
  explicit StochasticLanes(double sigma) : sigma_(static_cast<float>(sigma)) {}
  void add(const FloatBodies& b, const StepContext& now) override {
    if (!now.gusts) return;
    alignas(64) float z[2 * kBulkBodies];
    for (int i = 0; i < b.count; i += kBulkBodies) {
      bulk_normals({now.seed, Stream::stochastic, now.step, static_cast<std::uint32_t>(i), 0}, 2,
                   z);
      for (int k = 0; k < kBulkBodies; ++k) {
        b.fx[i + k] += sigma_ * z[k], b.fy[i + k] += sigma_ * z[kBulkBodies + k];
      }
    }
  }

 private:
  float sigma_;
};

class StochasticForce final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"sigma_stoch", "N", 12.682e-3, 0, 1,
       "standard deviation per axis of one draw a 25 ms [Table 1, in 1e-4 N: Lilies 126.82, balls "
       "195.25]"},
  };

 public:
  std::string_view name() const override { return "stochastic"; }
  std::string_view summary() const override {
    return "a normal random force on each body's centre, the same in all directions";
  }
  std::string_view equation() const override {
    return "F = sigma_stoch sqrt(25 ms / dt) N(0,1) per axis, drawn for each body and step  "
           "[paper, section 3.2]";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool baseline() const override { return true; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    if (!now.gusts) return;
    const double sigma = deviation(model, p);
    alignas(64) float z[2 * kBulkBodies];
    for (int first = 0; first < k.size(); first += kBulkBodies) {
      bulk_normals({now.seed, Stream::stochastic, now.step, static_cast<std::uint32_t>(first), 0},
                   2, z);
      const int n = std::min(kBulkBodies, k.size() - first);
      for (int i = 0; i < n; ++i) {
        out[first + i].fx += sigma * static_cast<double>(z[i]);
        out[first + i].fy += sigma * static_cast<double>(z[kBulkBodies + i]);
      }
    }
  }
  std::unique_ptr<LaneForce> in_lanes(const Model& model,
                                      std::span<const double> p) const override {
    return std::make_unique<StochasticLanes>(deviation(model, p));
  }
};

}  // namespace

const ForceTerm& stochastic_force() {
  static const StochasticForce term;
  return term;
}

}  // namespace lilytank
