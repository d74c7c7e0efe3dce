// Drag on the four faces of every module [paper, Eq. 5], with the area projected on the flow.
#include <algorithm>
#include <cmath>

#include "face_drag_kernel.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"K_F", "1", 0.442, 0, 10, "drag coefficient of a face [Table 1: Lilies 0.442]"},
    {"segments", "1", 10, 1, kMostSegments, "segments of a face, N of Eq. 5", true},
};

// The gusts at a module's drag points: each point its own, or one for the whole module.
void draw_gusts(const Model& model, const Moment& now, int body, PointGusts& gusts) {
  const Draw draw{now.seed, Stream::gust, now.gust, static_cast<std::uint32_t>(body), 0};
  if (now.gusts && model.flow.gusts == Gusts::per_point) {
    bulk_normals(draw, false, gusts.x, gusts.y);
    return;
  }
  const auto z = now.gusts ? normal_pair(draw) : std::array<double, 2>{};
  std::fill_n(gusts.x, kDragPoints, static_cast<float>(z[0]));
  std::fill_n(gusts.y, kDragPoints, static_cast<float>(z[1]));
}

class FaceDrag final : public ForceTerm {
 public:
  std::string_view name() const override { return "face_drag"; }
  std::string_view summary() const override {
    return "quadratic drag of the water on the segments of each module's faces";
  }
  std::string_view equation() const override {
    return "dF = K_F 1/2 rho (draught side / N) max(0, -n.w) w at each of N segments a face, "
           "w = K_v (mu + sigma xi) - v - omega x r  [paper, Eqs. 4 and 5]";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool baseline() const override { return true; }

  void add(const Model& model, const Kinematics& k, const Moment& now, std::span<const double> p,
           std::span<Wrench> out) const override {
    const int segments = static_cast<int>(p[1]);
    const DragPoints points(segments, model.module.side);
    const FlowField& field = *model.field;
    const WaterView water{field.packed().data(),
                          field.cells(),
                          static_cast<float>(field.extent()),
                          static_cast<float>(field.cells() / (2 * field.extent())),
                          field.interpolation() == Interpolation::nearest,
                          static_cast<float>(model.flow.K_v)};
    const double scale =
        p[0] * 0.5 * model.flow.rho * model.module.draught * (model.module.side / segments);
    PointGusts gusts;
    for (int i = 0; i < k.modules; ++i) {
      draw_gusts(model, now, i, gusts);
      const auto f = [](double x) { return static_cast<float>(x); };
      const BodyView body{f(k.x[i]),  f(k.y[i]),  f(k.c[i]),    f(k.s[i]),
                          f(k.vx[i]), f(k.vy[i]), f(k.omega[i])};
      const unsigned covered = model.module.shadowing ? k.covered[i] : 0u;
      const Wrench sum = face_drag_sum(points, water, body, covered, gusts);
      out[i].fx += scale * sum.fx;
      out[i].fy += scale * sum.fy;
      out[i].torque += scale * sum.torque;
    }
  }
};

}  // namespace

const ForceTerm& face_drag() {
  static const FaceDrag term;
  return term;
}

}  // namespace lilytank
