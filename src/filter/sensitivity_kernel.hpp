// The sums behind sensitivities in vectors of any length: a lane is always a feature and nothing is
// summed across lanes, so every instruction set gives the same bits.
#pragma once
#include <cstddef>

namespace lilytank {

inline constexpr std::size_t kFeatureLanes = 16;  ///< of which numbers of features are multiples
inline constexpr std::size_t kRowsAtOnce = 8;     ///< with their products summed together

/// One coordinate of all features over one frame. `found`: the innovation by its variance, 0 if it
/// does not count; `weight`: one over the variance, likewise.
struct FeatureAxis {
  float dt, keep, gain_x, gain_v, found, weight;
};

/// Arrays of `count` numbers, a multiple of kFeatureLanes. `now` becomes what the features are at
/// the next frame before it corrects them, by the root of the weight.
void pass_features(const FeatureAxis& axis, std::size_t count, const float* push, float* x,
                   float* v, float* now, float* score, float* information);

/// Adds the products of the `partners` numbers from `first` on with all `count` of each of
/// kRowsAtOnce rows, `count` apart, to sums, [partner * count + feature]. Products of two partners
/// are symmetric: those with a later partner may be left out.
void add_products(const float* rows, std::size_t count, std::size_t first, std::size_t partners,
                  float* sums);

/// Adds `count` recent sums, a multiple of kFeatureLanes, to those in double precision, and sets
/// them to 0.
void move_sums(float* recent, std::size_t count, double* all);

/// The sum of `number` rows of `count` numbers, a multiple of kFeatureLanes, each by its weight.
void mix_rows(const float* const* rows, const float* weights, std::size_t number, std::size_t count,
              float* out);

/// Products of numbers with a factor, in double precision, as single ones.
void scale_all(const double* values, std::size_t count, double factor, float* out);

}  // namespace lilytank
