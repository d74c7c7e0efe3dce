#include "bulk_random.hpp"

// Compiled once for each instruction set; the best that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/bulk_random.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bulk_random_inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lilytank::HWY_NAMESPACE {

void normals(const std::uint32_t counter[4], const std::uint32_t key[2], int count, float* out) {
  normals_of_all(counter, key, count, out);
}

void words(const std::uint32_t counter[4], const std::uint32_t key[2], std::uint32_t* out) {
  const Words w;
  const int lanes = static_cast<int>(hn::Lanes(w));
  const Philox philox(counter, key);
  const auto index = philox.index(0);
  for (int i = 0; i < kBulkBodies; i += lanes)
    hn::Store(word_of<0>(philox(philox.body(i), index)), w, out + i);
}

}  // namespace lilytank::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lilytank {

HWY_EXPORT(normals);
HWY_EXPORT(words);

void bulk_normals(const Draw& draw, int count, float* out) {
  const auto counter = counter_of(draw);
  const auto key = key_of(draw.seed);
  HWY_DYNAMIC_DISPATCH(normals)(counter.data(), key.data(), count, out);
}

void bulk_words(const Draw& draw, std::uint32_t* out) {
  const auto counter = counter_of(draw);
  const auto key = key_of(draw.seed);
  HWY_DYNAMIC_DISPATCH(words)(counter.data(), key.data(), out);
}

}  // namespace lilytank
#endif
