// What model selection chooses from: effects, and curves without a name, by their fingerprints.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "finder/fingerprint.hpp"
#include "finder/whitening.hpp"

namespace lilytank {

/// An effect, or a shape without a name, and how well it explains residuals.
struct EffectFit {
  int effect = -1;             ///< index into the plan's effects; -1: a shape
  int shape = -1;              ///< index into the plan's shapes
  Eigen::VectorXd amplitudes;  ///< in units of the effect's sizes
  Eigen::VectorXd moved;       ///< how far it moves a calibration that omits it, in its scale
  double gain = 0;             ///< fall of the squared distance
  int about = 0;               ///< experiments of a fingerprint about found amplitudes; 0: learned
  bool at_bound = false;       ///< as far as its fingerprint holds: the truth may be beyond
  double z = 0;                ///< standard normal quantile of the same probability
};

/// An effect or a shape with its response, whitened.
struct EffectCandidate {
  int effect = -1, shape = -1;
  Fingerprint source;
  Eigen::MatrixXd learned;  ///< first orders of residuals at usual sizes
  /// Of the named statistics, and of all. Shapes overlap, so a gain in all has a scale of its own.
  ResponseModel named, all;
  Eigen::MatrixXd basis;  ///< first orders of all statistics, as learned at usual sizes
  /// Mean gain of nulls by its degrees of freedom, in the named statistics and in all.
  double scale = 1, scale_all = 1;
};

EffectCandidate candidate_of(const Whitening& whitening, const Fingerprint& fingerprint, int effect,
                             int shape);
/// The candidate with another fingerprint or whitening; what was learned at usual sizes and the
/// scales stay.
EffectCandidate renewed(const EffectCandidate& candidate, const Whitening& whitening,
                        const Fingerprint& fingerprint);
/// Index of the last candidate of this effect or shape; their number if there is none.
std::size_t place_of(const std::vector<EffectCandidate>& candidates, int effect, int shape);

/// Gains that differ by less do not distinguish effects.
inline constexpr double kSameGain = 4;

/// Standard errors below which a statistic of a fingerprint is noise.
inline constexpr double kNoisy = 2.5;

/// Standard normal quantile of a gain, by its scale and degrees of freedom.
double z_of_gain(double gain, double scale, Eigen::Index freedom);
/// The fit by one of the candidate's responses; without z.
EffectFit fitted(const EffectCandidate& candidate, const ResponseModel& response,
                 const Eigen::VectorXd& data);
/// The fit to whitened residuals by the named statistics, with the z of these or of all, whichever
/// is larger. A curve's other knots overlap with its own, so its z is of the named ones.
EffectFit fit_of(const EffectCandidate& candidate, const Eigen::VectorXd& whitened);

/// Indices of two candidates.
using CandidatePair = std::pair<std::size_t, std::size_t>;
/// The pairs that together explain most of whitened residuals, in first order; at most `count`.
std::vector<CandidatePair> leading_pairs(const std::vector<EffectCandidate>& candidates,
                                         const Eigen::VectorXd& whitened, std::size_t count);

}  // namespace lilytank
