#include "sensitivity_kernel.hpp"

#include <cmath>

// Compiled once for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filter/sensitivity_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kFeatureLanes>;
using Float = hn::Vec<Floats>;

}  // namespace

void pass(const FeatureAxis& a, float root, std::size_t count, const float* push, float* x,
          float* v, float* now, float* score, float* information) {
  const Floats d;
  const Float dt = hn::Set(d, a.dt), half = hn::Set(d, 0.5f * a.dt), keep = hn::Set(d, a.keep);
  const Float gain_x = hn::Set(d, a.gain_x), gain_v = hn::Set(d, a.gain_v);
  const Float found = hn::Set(d, a.found), weight = hn::Set(d, a.weight), scale = hn::Set(d, root);
  for (std::size_t f = 0; f < count; f += hn::Lanes(d)) {
    const Float pushed = hn::LoadU(d, push + f), speed = hn::LoadU(d, v + f);
    const Float at =
        hn::Add(hn::LoadU(d, x + f), hn::Mul(dt, hn::Add(speed, hn::Mul(half, pushed))));
    const Float later = hn::Add(hn::Mul(keep, speed), hn::Mul(dt, pushed));
    hn::StoreU(hn::Mul(scale, at), d, now + f);
    hn::StoreU(hn::Add(hn::LoadU(d, score + f), hn::Mul(found, at)), d, score + f);
    hn::StoreU(hn::Add(hn::LoadU(d, information + f), hn::Mul(hn::Mul(weight, at), at)), d,
               information + f);
    hn::StoreU(hn::Sub(at, hn::Mul(gain_x, at)), d, x + f);
    hn::StoreU(hn::Sub(later, hn::Mul(gain_v, at)), d, v + f);
  }
}

void products(const float* rows, std::size_t count, std::size_t first, std::size_t partners,
              float* sums) {
  const Floats d;
  for (std::size_t f = 0; f < count; f += hn::Lanes(d)) {
    Float of[kRowsAtOnce];
    for (std::size_t k = 0; k < kRowsAtOnce; ++k) of[k] = hn::LoadU(d, rows + k * count + f);
    // Products of a partner with later ones are summed by those.
    for (std::size_t n = f > first ? f - first : 0; n < partners; ++n) {
      float* sum = sums + n * count + f;
      Float all = hn::LoadU(d, sum);
      for (std::size_t k = 0; k < kRowsAtOnce; ++k) {
        all = hn::Add(all, hn::Mul(of[k], hn::Set(d, rows[k * count + first + n])));
      }
      hn::StoreU(all, d, sum);
    }
  }
}

void move(float* recent, std::size_t count, double* all) {
  const hn::CappedTag<double, kFeatureLanes / 2> d;
  const hn::Rebind<float, decltype(d)> half;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto sum = hn::Add(hn::LoadU(d, all + k), hn::PromoteTo(d, hn::LoadU(half, recent + k)));
    hn::StoreU(sum, d, all + k);
    hn::StoreU(hn::Zero(half), half, recent + k);
  }
}

void mix(const float* const* rows, const float* weights, std::size_t number, std::size_t count,
         float* out) {
  const Floats d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    Float sum = hn::Zero(d);
    for (std::size_t n = 0; n < number; ++n) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[n]), hn::LoadU(d, rows[n] + k)));
    }
    hn::StoreU(sum, d, out + k);
  }
}

void scale(const double* values, std::size_t count, double factor, float* out) {
  const hn::CappedTag<double, kFeatureLanes / 2> d;
  const hn::Rebind<float, decltype(d)> half;
  const auto by = hn::Set(d, factor);
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) {
    hn::StoreU(hn::DemoteTo(half, hn::Mul(hn::LoadU(d, values + k), by)), half, out + k);
  }
  for (; k < count; ++k) out[k] = static_cast<float>(values[k] * factor);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(pass);
HWY_EXPORT(products);
HWY_EXPORT(move);
HWY_EXPORT(mix);
HWY_EXPORT(scale);

void pass_features(const FeatureAxis& axis, std::size_t count, const float* push, float* x,
                   float* v, float* now, float* score, float* information) {
  HWY_DYNAMIC_DISPATCH(pass)
  (axis, std::sqrt(axis.weight), count, push, x, v, now, score, information);
}

void add_products(const float* rows, std::size_t count, std::size_t first, std::size_t partners,
                  float* sums) {
  HWY_DYNAMIC_DISPATCH(products)(rows, count, first, partners, sums);
}

void move_sums(float* recent, std::size_t count, double* all) {
  HWY_DYNAMIC_DISPATCH(move)(recent, count, all);
}

void mix_rows(const float* const* rows, const float* weights, std::size_t number, std::size_t count,
              float* out) {
  HWY_DYNAMIC_DISPATCH(mix)(rows, weights, number, count, out);
}

void scale_all(const double* values, std::size_t count, double factor, float* out) {
  HWY_DYNAMIC_DISPATCH(scale)(values, count, factor, out);
}

}  // namespace lilytank
#endif
