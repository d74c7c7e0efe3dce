#include "eddies_kernel.hpp"

// Compiled once for each instruction set, with the same bits from each: a lane is a body.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forces/eddies_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "math/bulk_random_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

// Chebyshev's interpolations of cos(2 pi r) and sin(2 pi r) / r in r^2, |r| <= 1/2: 8e-7 and 2e-7.
constexpr float kCosine[] = {0.9999991998f,   -19.7389781759f, 64.9285878399f,
                             -85.2708436269f, 58.7869407632f,  -21.0654294077f};
constexpr float kSine[] = {6.2831849118f,   -41.3415883022f, 81.5999136194f,
                           -76.6141403010f, 41.3413653860f,  -12.4688186192f};

struct Turned {
  Float c, s;
};
HWY_INLINE Turned turned(Float turns) {
  const Float r = hn::Sub(turns, hn::Round(turns)), square = hn::Mul(r, r);
  return {poly<5>(square, kCosine), hn::Mul(r, poly<5>(square, kSine))};
}

}  // namespace

void differences(float half_side, EddyWaves& waves) {
  const Floats d;
  const Float half = hn::Set(d, half_side), inverse = hn::Set(d, 1 / half_side);
  for (int m = 0; m < kWaves; m += static_cast<int>(hn::Lanes(d))) {
    const Float across_x = turned(hn::Mul(hn::Load(d, waves.kx + m), half)).s;
    const Float across_y = turned(hn::Mul(hn::Load(d, waves.ky + m), half)).s;
    hn::Store(hn::Mul(hn::Mul(hn::Load(d, waves.ay + m), across_x), inverse), d, waves.bx + m);
    hn::Store(hn::Mul(hn::Mul(hn::Load(d, waves.ax + m), across_y), inverse), d, waves.by + m);
  }
}

void eddies(const EddyWaves& waves, EddyBlock& block) {
  const Floats d;
  for (int i = 0; i < kBulkBodies; i += static_cast<int>(hn::Lanes(d))) {
    const Float x = hn::Load(d, block.x + i), y = hn::Load(d, block.y + i);
    Float ux = hn::Zero(d), uy = hn::Zero(d), y_by_x = hn::Zero(d), x_by_y = hn::Zero(d);
    for (int m = 0; m < kWaves; ++m) {
      const Float along_x = hn::Mul(hn::Set(d, waves.kx[m]), x);
      const Float along_y = hn::Mul(hn::Set(d, waves.ky[m]), y);
      const auto [c, s] = turned(hn::Add(hn::Add(along_x, along_y), hn::Set(d, waves.offset[m])));
      ux = hn::Add(ux, hn::Mul(c, hn::Set(d, waves.ax[m])));
      uy = hn::Add(uy, hn::Mul(c, hn::Set(d, waves.ay[m])));
      y_by_x = hn::Sub(y_by_x, hn::Mul(s, hn::Set(d, waves.bx[m])));
      x_by_y = hn::Sub(x_by_y, hn::Mul(s, hn::Set(d, waves.by[m])));
    }
    hn::Store(ux, d, block.ux + i), hn::Store(uy, d, block.uy + i);
    hn::Store(y_by_x, d, block.y_by_x + i), hn::Store(x_by_y, d, block.x_by_y + i);
  }
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(eddies);
HWY_EXPORT(differences);

void find_differences(float half_side, EddyWaves& waves) {
  HWY_DYNAMIC_DISPATCH(differences)(half_side, waves);
}

void sum_eddies(const EddyWaves& waves, EddyBlock& block) {
  HWY_DYNAMIC_DISPATCH(eddies)(waves, block);
}

}  // namespace lilytank
#endif
