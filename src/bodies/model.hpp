// A model of point bodies: terms of the library, the tracker's noise, and random pushes for
// everything else. Its fitted parameters as one vector.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bodies/law.hpp"
#include "lilytank/bodies.hpp"

namespace lilytank::bodies {

struct Term {
  const Law* law = nullptr;
  std::vector<LawParameter> parameters;
  std::vector<double> value;
  std::vector<double> scale;  ///< of each number: a typical size
  std::vector<bool> fitted;
};

/// Pushes are an acceleration with a memory: an Ornstein-Uhlenbeck process of deviation `push`
/// (m/s^2) and correlation time `memory` (s) [Singer, IEEE Trans. AES 6, 1970], alike for every
/// coordinate.
struct BodyModel {
  std::vector<Term> terms;
  double noise = 0, push = 0, memory = 1;
  double noise_y = 0;  ///< of the second axis; 0: `noise`
  bool noise_fitted = false;
  double bias =
      0;  ///< deviation of an acceleration that lasts a whole run, m/s^2; 0: there is none
  double restitution = -1;  ///< of contacts between bodies; negative: they pass each other
  double least_noise = 0, least_push = 0, usual_push = 0, most_push = 0;
  double least_memory = 0, most_memory = 0;

  double noise_of(int axis) const { return axis == 1 && noise_y > 0 ? noise_y : noise; }
  /// Mean square over the axes.
  double squared_noise() const { return (noise * noise + noise_of(1) * noise_of(1)) / 2; }
  /// Both axes' noise times `by`, if it is fitted, down to the least.
  void scale_noise(double by);
};

/// The fitted numbers: log noise (if fitted), log push, log memory, log bias (if there is one),
/// then those of the terms: amplitudes and places by their scale, positive ones as logarithms.
std::vector<double> packed(const BodyModel& model);
BodyModel unpacked(const BodyModel& model, const std::vector<double>& numbers);
/// How many come before those of the terms.
std::size_t own_numbers(const BodyModel& model);
/// One of them.
struct OwnValue {
  std::string name, unit;                 ///< in units of "m" for a position
  double value = 0, least = 0, most = 0;  ///< with its bounds
};
std::vector<OwnValue> own_values(const BodyModel& model);
/// A parameter of a term, both by index.
struct TermParameter {
  std::size_t term = 0, parameter = 0;
  bool operator==(const TermParameter&) const = default;
};
/// Those that are fitted, in the order of their numbers.
std::vector<TermParameter> fitted_parameters(const BodyModel& model);
/// The index of a parameter's number; nothing if it is not fitted.
std::optional<std::size_t> number_of(const BodyModel& model, const TermParameter& of);

/// A run's bodies with the drivers of one of its samples, at positions and velocities of
/// [body][dimension].
Scene scene_of(const BodyRun& run, int dimensions, std::size_t sample, double time, const double* x,
               const double* v);

/// Accelerations at [body][dimension].
void accelerate(const BodyModel& model, const Scene& scene, double* out);

/// A term of a law with one of its starts; `push` (m/s^2) is a size for its acceleration,
/// `size` the share of it at which amplitudes start.
Term term_of(const Law& law, const Typical& typical, const std::vector<double>& start,
             const std::vector<const BodyRun*>& runs, double push, double size = 1e-3);

/// Rate (rad/s) of the strongest line in the spectrum of the velocities, all bodies together; in
/// two dimensions positive where velocities turn clockwise. 0 where there are none.
double strongest_rate(const std::vector<const BodyRun*>& runs, int dimensions);

/// Sizes that occur in some runs.
Typical typical_of(const BodyExperiment& experiment, const std::vector<const BodyRun*>& runs);

}  // namespace lilytank::bodies
