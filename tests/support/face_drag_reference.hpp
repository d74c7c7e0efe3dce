// Eq. 5 written as it reads, in double precision: what the fast drag kernel is held against.
#pragma once
#include <cmath>
#include <functional>

#include "lilytank/model.hpp"

namespace lilytank::test {

/// A gust's standard normals (x and y) at segment q of a face.
using GustAt = std::function<Vec2(int face, int q)>;

/// Drag on module i with K_F and N segments a face.
inline Wrench face_drag_reference(const Model& model, const Kinematics& k, double K_F, int segments,
                                  int i, const GustAt& gust) {
  const double a = model.module.side, area = model.module.draught * a / segments;
  const Vec2 centre(k.x[i], k.y[i]), v(k.vx[i], k.vy[i]);
  Wrench sum;
  for (int face = 0; face < 4; ++face) {
    if (model.module.shadowing && (k.covered[i] >> face & 1)) continue;
    const Rot out = compose({k.c[i], k.s[i]}, quarter(face));
    const Vec2 n(out.c, out.s);
    for (int q = 0; q < segments; ++q) {
      const Vec2 r = rotate(out, Vec2(a / 2, ((q + 0.5) / segments - 0.5) * a));
      const Vec2 at = model.flow.at == FlowAt::centre ? centre : centre + r;
      const FlowSample f = model.field->at(at.x(), at.y());
      const Vec2 xi = gust(face, q);
      const Vec2 u =
          model.flow.K_v * Vec2(f.mu_x + f.sigma_x * xi.x(), f.mu_y + f.sigma_y * xi.y());
      const Vec2 point = v + k.omega[i] * Vec2(-r.y(), r.x()), w = u - point;
      const Vec2 dF = K_F * 0.5 * model.flow.rho * area * std::fmax(0, -n.dot(w)) * w;
      sum.fx += dF.x(), sum.fy += dF.y(), sum.torque += cross(r, dF);
    }
  }
  return sum;
}

}  // namespace lilytank::test
