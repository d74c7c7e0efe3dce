// Statistics of tracks: displacements, autocorrelations, distributions, neighbours. The same
// functions serve simulated and recorded motion.
//
// Every curve is a ratio of two sums over bodies, bin by bin: squared displacements over their
// number, bodies counted in a ring over all bodies counted. A body's sums are kept apart, as bodies
// are what a band resamples: the frames of one body are not independent of each other. Neither are
// modules that are latched together: an assembly is resampled as one body.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "lilytank/recording.hpp"
#include "lilytank/smoothing.hpp"
#include "lilytank/statistics.hpp"
#include "lilytank/trajectory.hpp"

namespace lilytank {

/// The modules' (balls') motion in a stored run as a recording without noise, on the clock of its
/// frames, which must be even to within a thousandth of the interval but for a last shorter one,
/// which is left out. Headings are unwrapped; balls have none. Modules that are in one assembly in
/// half of the frames or more, directly or in a chain, share Track::assembly. Throws InputError.
Recording as_recording(const Trajectory& trajectory, BodyKind body);

/// A curve's sums, kept by body; assemblies count as one. Tracks that share an id in one recording
/// are one body.
struct BodySums {
  int bins = 0;                      ///< bins of the curve: the length of a body's row
  std::vector<double> sum, weight;   ///< [body or assembly * bins + bin]
  std::vector<std::int64_t> tracks;  ///< [bin] tracks that add to it
  int bodies() const { return bins == 0 ? 0 : static_cast<int>(sum.size()) / bins; }
  /// Adds the bodies of another recording.
  void append(const BodySums& other);
};

/// Which instants count as the start of a displacement.
enum class Origins : std::uint8_t {
  /// Each track's first frame, of tracks that begin within a second of the recording's begin
  /// [paper, Eq. 8].
  first,
  all,  ///< every frame: less noise, for motion that has settled
};

/// Squared displacements (m^2) at lags in seconds, rising. A lag between two frames is interpolated
/// from three; pairs of which one frame was not seen do not count. By fast Fourier transforms
/// [Calandrini et al., Collection SFN 12, 2011], here with gaps.
BodySums squared_displacements(const Recording& recording, const std::vector<double>& lags,
                               Origins origins);
/// Squared turns of headings (rad^2), likewise; no bodies where there are no headings.
BodySums squared_turns(const Recording& recording, const std::vector<double>& lags,
                       Origins origins);
/// Products v(t) . v(t + lag) of smoothed velocities (m^2/s^2), from frames that were seen.
BodySums velocity_products(const SmoothRecording& recording, const std::vector<double>& lags);
/// Products of smoothed spins (rad^2/s^2); no bodies where there are no headings.
BodySums spin_products(const SmoothRecording& recording, const std::vector<double>& lags);

/// How bands are made.
struct Bootstrap {
  std::uint64_t seed = 1;  ///< fixes the resampling (Stream::bootstrap)
  int resamples = 1000;
  double level = 0.95;    ///< Two-sided coverage of bands and intervals
  bool relative = false;  ///< whether each curve is divided by its own first bin
};
/// A curve with its pointwise band. Bins without data are NaN. One body gives no band (infinite).
struct CurveEstimate {
  std::vector<double> value, low, high;  ///< [bins] value and ends of the band, in the curve's unit
};
/// Ratio of the sums over all bodies; NaN where there is no weight.
std::vector<double> ratio_values(const BodySums& sums, bool relative = false);
/// The same with a percentile-bootstrap band over bodies, widened about the curve by
/// sqrt(n / (n - 1)) t / z as few bodies need [Hesterberg, Am. Stat. 69, 2015].
CurveEstimate ratio_curve(const BodySums& sums, const Bootstrap& bootstrap = {});
/// The second curve less the first, with the band of independent bodies. Equal bins.
CurveEstimate ratio_difference(const BodySums& first, const BodySums& second,
                               const Bootstrap& bootstrap = {});
/// A statistic of the whole curve, with its interval over the same resamples, widened likewise.
Estimate ratio_functional(const BodySums& sums,
                          const std::function<double(const std::vector<double>&)>& functional,
                          const Bootstrap& bootstrap = {});

/// Motion between two lags read as diffusion: MSD = 4 D lag + a constant, as measurement noise
/// adds.
struct Diffusion {
  Estimate D;               ///< m^2/s; NaN where no lags were found
  double from = 0, to = 0;  ///< s, lags that were fitted
};
/// D from the widest range of lags (by their ratio, at least 2) in which the MSD's local exponent
/// is within 0.15 of 1; or from the lags from .. to, where `to` > 0. `dimensions` is 2 for
/// displacements, 1 for turns (MSD = 2 D lag, rad^2/s).
Diffusion diffusion(const BodySums& msd, const std::vector<double>& lags, int dimensions,
                    double from = 0, double to = 0, const Bootstrap& bootstrap = {});

}  // namespace lilytank
