// One-step predictions of a model for recorded runs, and runs that a model makes up.
#pragma once
#include "bodies/model.hpp"

namespace lilytank::bodies {

/// BodyResiduals (m) and their variances, one for every seen coordinate, in the order of the runs.
struct BodyResiduals {
  std::vector<double> value, variance;
  int lost = 0;  ///< coordinates whose prediction was not finite; the filter starts again there
};

/// What the filter believes after each sample: positions, velocities, pushes at
/// [sample][coordinate].
struct Believed {
  std::vector<double> x, v, push;
};

/// Extended Kalman filter: between samples the mean is integrated (Runge and Kutta, fourth order)
/// and the covariance goes with its derivative. Appends to `out`.
void filter_run(const BodyModel& model, const Typical& typical, const BodyRun& run,
                BodyResiduals& out);
/// The same filter's estimates.
Believed believed(const BodyModel& model, const Typical& typical, const BodyRun& run);

/// Positions at a later sample by the model without pushes, from a belief at `from`; [coordinate].
std::vector<double> predicted(const BodyModel& model, const Typical& typical, const BodyRun& run,
                              const Believed& believed, std::size_t from, std::size_t to);

/// The run's samples as this model would have given them, pushes and noise drawn.
BodyRun simulated(const BodyModel& model, const Typical& typical, const BodyRun& run,
                  std::uint64_t seed, std::uint32_t number);

}  // namespace lilytank::bodies
