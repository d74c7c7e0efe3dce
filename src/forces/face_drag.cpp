// Drag on the four faces of every module [paper, Eq. 5], with the area projected on the flow.
#include <algorithm>
#include <cmath>

#include "face_drag_kernel.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

// Bodies [first, first + count) as the kernel takes them; lanes beyond stay at rest in the centre.
void load_block(const Kinematics& k, int first, int count, bool shadowing, DragBlock& block) {
  const auto load = [&](std::span<const double> from, float* to) {
    for (int i = 0; i < count; ++i) to[i] = static_cast<float>(from[first + i]);
    std::fill(to + count, to + kBulkBodies, 0.0f);
  };
  load(k.x, block.x), load(k.y, block.y), load(k.c, block.c), load(k.s, block.s);
  load(k.vx, block.vx), load(k.vy, block.vy), load(k.omega, block.omega);
  std::fill_n(block.covered, kBulkBodies, std::uint8_t{0});
  if (shadowing) std::copy_n(&k.covered[first], count, block.covered);
}

class FaceDrag final : public ForceTerm {
  static constexpr Parameter kParameters[] = {
      {"K_F", "1", 0.442, 0, 10, "drag coefficient of a face [Table 1: Lilies 0.442]"},
      {"segments", "1", 10, 1, kMostSegments, "segments of a face, N of Eq. 5", true},
  };

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

  void add(const Model& model, const Kinematics& k, const StepContext& now,
           std::span<const double> p, std::span<Wrench> out) const override {
    const int segments = static_cast<int>(p[1]);
    DragSettings settings(model, segments, now);
    const double scale =
        p[0] * 0.5 * model.flow.rho * model.module.draught * (model.module.side / segments);
    for (int first = 0; first < k.modules; first += kBulkBodies) {
      const int count = std::min(kBulkBodies, k.modules - first);
      DragBlock block;
      DragSums sums;
      load_block(k, first, count, model.module.shadowing, block);
      // Water that moves and turns faster is a module that does so slower.
      for (int i = 0; i < count && !now.ux.empty(); ++i) {
        block.vx[i] = static_cast<float>(k.vx[first + i] - now.ux[first + i]);
        block.vy[i] = static_cast<float>(k.vy[first + i] - now.uy[first + i]);
        block.omega[i] = static_cast<float>(k.omega[first + i] - now.turning[first + i]);
      }
      settings.draw.body = static_cast<std::uint32_t>(first);
      face_drag_sums(settings, block, now.kept, sums);
      for (int i = 0; i < count; ++i) {
        Wrench& w = out[first + i];
        w.fx += scale * static_cast<double>(sums.fx[i]);
        w.fy += scale * static_cast<double>(sums.fy[i]);
        w.torque += scale * static_cast<double>(sums.torque[i]);
      }
    }
  }
};

}  // namespace

const ForceTerm& face_drag() {
  static const FaceDrag term;
  return term;
}

}  // namespace lilytank
