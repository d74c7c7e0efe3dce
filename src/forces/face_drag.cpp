// Drag on the four faces of every module [paper, Eq. 5], with the area projected on the flow.
#include <algorithm>
#include <cmath>
#include <optional>

#include "face_drag_kernel.hpp"
#include "float_bodies.hpp"
#include "library.hpp"
#include "lilytank/model.hpp"

namespace lilytank {
namespace {

// A block's modules as the kernel takes them; lanes beyond stay at rest in the centre.
struct Lanes {
  alignas(64) float x[kBulkBodies], y[kBulkBodies], c[kBulkBodies], s[kBulkBodies];
  alignas(64) float vx[kBulkBodies], vy[kBulkBodies], omega[kBulkBodies];
  alignas(16) std::uint8_t covered[kBulkBodies];
  DragBlock block() const { return {x, y, c, s, vx, vy, omega, covered}; }
};

void load_block(const Kinematics& k, int first, int count, bool shadowing, Lanes& lanes) {
  const auto load = [&](std::span<const double> from, float* to) {
    for (int i = 0; i < count; ++i) to[i] = static_cast<float>(from[first + i]);
    std::fill(to + count, to + kBulkBodies, 0.0f);
  };
  load(k.x, lanes.x), load(k.y, lanes.y), load(k.c, lanes.c), load(k.s, lanes.s);
  load(k.vx, lanes.vx), load(k.vy, lanes.vy), load(k.omega, lanes.omega);
  std::fill_n(lanes.covered, kBulkBodies, std::uint8_t{0});
  if (shadowing) std::copy_n(&k.covered[first], count, lanes.covered);
}

double drag_scale(const Model& model, std::span<const double> p, int segments) {
  return p[0] * 0.5 * model.flow.rho * model.module.draught * (model.module.side / segments);
}

class DragLanes final : public LaneForce {
 public:
  DragLanes(const Model& model, std::span<const double> p)
      : model_(&model),
        segments_(static_cast<int>(p[1])),
        scale_(static_cast<float>(drag_scale(model, p, segments_))) {}

  void add(const FloatBodies& b, const StepContext& now) override {
    if (!settings_)
      settings_.emplace(*model_, segments_, now);
    else
      settings_->set_moment(*model_, now);
    static constexpr std::uint8_t kOpen[kBulkBodies] = {};
    for (int i = 0; i < b.modules; i += kBulkBodies) {
      DragSums sums;
      settings_->draw.body = static_cast<std::uint32_t>(i);
      face_drag_sums(*settings_,
                     {b.x + i, b.y + i, b.c + i, b.s + i, b.vx + i, b.vy + i, b.omega + i,
                      model_->module.shadowing ? b.covered + i : kOpen},
                     now.kept, sums);
      const int count = std::min(kBulkBodies, b.modules - i);
      for (int k = 0; k < count; ++k) {
        b.fx[i + k] += scale_ * sums.fx[k], b.fy[i + k] += scale_ * sums.fy[k];
        b.torque[i + k] += scale_ * sums.torque[k];
      }
    }
  }

 private:
  const Model* model_;
  int segments_;
  float scale_;
  std::optional<DragSettings> settings_;  // made in the first step
};

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
    const double scale = drag_scale(model, p, segments);
    for (int first = 0; first < k.modules; first += kBulkBodies) {
      const int count = std::min(kBulkBodies, k.modules - first);
      Lanes block;
      DragSums sums;
      load_block(k, first, count, model.module.shadowing, block);
      // Water that moves and turns faster is a module that does so slower.
      for (int i = 0; i < count && !now.ux.empty(); ++i) {
        block.vx[i] = static_cast<float>(k.vx[first + i] - now.ux[first + i]);
        block.vy[i] = static_cast<float>(k.vy[first + i] - now.uy[first + i]);
        block.omega[i] = static_cast<float>(k.omega[first + i] - now.turning[first + i]);
      }
      settings.draw.body = static_cast<std::uint32_t>(first);
      face_drag_sums(settings, block.block(), now.kept, sums);
      for (int i = 0; i < count; ++i) {
        Wrench& w = out[first + i];
        const double own = now.drag.empty() ? scale : scale * now.drag[first + i];
        w.fx += own * static_cast<double>(sums.fx[i]);
        w.fy += own * static_cast<double>(sums.fy[i]);
        w.torque += own * static_cast<double>(sums.torque[i]);
      }
    }
  }
  std::unique_ptr<LaneForce> in_lanes(const Model& model,
                                      std::span<const double> p) const override {
    return std::make_unique<DragLanes>(model, p);
  }
};

}  // namespace

const ForceTerm& face_drag() {
  static const FaceDrag term;
  return term;
}

}  // namespace lilytank
