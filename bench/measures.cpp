#include "measures.hpp"

#include <algorithm>
#include <cmath>

#include "support/reference/collide.hpp"

namespace lilytank::bench {
namespace {

using reference::Square;

constexpr double kTouch = 3e-4;  // m

Square square(const Model& model, const Kinematics& k, int i) {
  return {k.x[i], k.y[i], {k.c[i], k.s[i]}, model.module.side / 2};
}

bool joined_to(std::span<const Face> faces, int i, int j) {
  if (faces.empty()) return false;
  const auto own = faces.subspan(4 * static_cast<std::size_t>(i), 4);
  return std::any_of(own.begin(), own.end(), [&](const Face& f) { return f.partner == j; });
}

Vec2 face_centre(const Model& model, const Kinematics& k, int i, int face) {
  const Rot out = compose({k.c[i], k.s[i]}, quarter(face));
  return Vec2(k.x[i], k.y[i]) + model.module.side / 2 * Vec2(out.c, out.s);
}

}  // namespace

void Measures::sample(const Kinematics& k, std::span<const Face> faces) {
  for (int i = 0; i < k.modules; ++i) {
    ++bodies_;
    speed_ += std::hypot(k.vx[i], k.vy[i]);
    spin_ += std::fabs(k.omega[i]);
    radius_ += std::hypot(k.x[i], k.y[i]);
    const double gap = reference::wall_separation(square(*model_, k, i), model_->tank.radius);
    at_wall_ += gap < kTouch;
    beyond_wall_ = std::max(beyond_wall_, -gap);
    for (int j = i + 1; j < k.modules; ++j) pair(k, faces, i, j);
    if (!faces.empty()) bonds(k, faces, i);
  }
}

void Measures::pair(const Kinematics& k, std::span<const Face> faces, int i, int j) {
  const double dx = k.x[j] - k.x[i], dy = k.y[j] - k.y[i], side = model_->module.side;
  if (dx * dx + dy * dy >= 2 * side * side) return;
  ++near_;
  const double gap = reference::separation(square(*model_, k, i), square(*model_, k, j)).size;
  touching_ += gap < kTouch;
  if (gap < 0 && !joined_to(faces, i, j)) depths_.push_back(-gap);
}

void Measures::bonds(const Kinematics& k, std::span<const Face> faces, int i) {
  bool any = false;
  for (int f = 0; f < 4; ++f) {
    const Face& face = faces[4 * static_cast<std::size_t>(i) + f];
    if (face.partner < 0) continue;
    any = true;
    if (face.partner < i) continue;
    ++joints_;
    const Vec2 gap =
        face_centre(*model_, k, i, f) - face_centre(*model_, k, face.partner, face.partner_face);
    joint_errors_.push_back(gap.norm());
  }
  joined_ += any;
}

double Measures::deep_share(double bound) const {
  if (depths_.empty()) return 0;
  const auto deep =
      std::count_if(depths_.begin(), depths_.end(), [&](double d) { return d > bound; });
  return static_cast<double>(deep) / static_cast<double>(depths_.size());
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto at =
      std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace lilytank::bench
