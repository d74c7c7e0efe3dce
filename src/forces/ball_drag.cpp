// Drag on the balls of the flow measurements [paper, Eq. 2].
#include <cmath>

#include "float_bodies.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

class BallDrag final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"C", "1", 2.266, 0, 10, "drag coefficient of a ball [Table 1: balls 2.266; a sphere 0.47]"},
      {"draws", "1", 10, 1, 1000, "independent gusts that a ball averages over", true},
  };

 public:
  std::string_view name() const override { return "ball_drag"; }
  std::string_view summary() const override { return "quadratic drag of the water on each ball"; }
  std::string_view equation() const override {
    return "F = 1/2 rho A C |w| w, w = K_v (mu + sigma xi) - v, xi the mean of `draws` standard "
           "normals per axis  [paper, Eqs. 2 and 4]";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool baseline() const override { return true; }

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    const double scale = 0.5 * model.flow.rho * model.ball.drag_area * p[0];
    const FlowField& field = field_now(model, now);
    const double K_v = model.flow.K_v * now.gain;
    const double share = now.gusts ? now.gust_gain / std::sqrt(p[1]) : 0;
    for (int i = k.modules; i < k.size(); ++i) {
      const FlowSample f = field.at(k.x[i], k.y[i]);
      const auto xi =
          normal_pair({now.seed, Stream::gust, now.gust, static_cast<std::uint32_t>(i), 0});
      double wx = K_v * (f.mu_x + f.sigma_x * share * xi[0]) - k.vx[i];
      double wy = K_v * (f.mu_y + f.sigma_y * share * xi[1]) - k.vy[i];
      if (!now.ux.empty()) wx += now.ux[i], wy += now.uy[i];
      const double own = now.drag.empty() ? scale : scale * now.drag[i];
      const double size = own * std::sqrt(wx * wx + wy * wy);
      out[i].fx += size * wx;
      out[i].fy += size * wy;
    }
  }
  // Where there are no balls, without conversions.
  std::unique_ptr<LaneForce> in_lanes(const Model& model, std::span<const double>) const override {
    return model.ball.count == 0 ? std::make_unique<LaneForce>() : nullptr;
  }
};

}  // namespace

const ForceTerm& ball_drag() {
  static const BallDrag term;
  return term;
}

}  // namespace lilytank
