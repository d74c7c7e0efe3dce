#include "bodies/driver_history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lilytank::bodies {

double driver_at(const BodyRun& run, int driver, double time) {
  const auto value = [&](std::size_t sample) { return run.drivers_at(sample)[driver]; };
  const auto after = static_cast<std::size_t>(
      std::upper_bound(run.time.begin(), run.time.end(), time) - run.time.begin());
  if (after == 0) return value(0);
  if (after == run.samples()) return value(after - 1);
  const double from = run.time[after - 1];
  const double share = (time - from) / (run.time[after] - from);
  return value(after - 1) + share * (value(after) - value(after - 1));
}

double amplitude_at(const BodyRun& run, int driver, double time, double window) {
  constexpr int kPoints = 32;
  const double from = std::max(run.time.front(), time - window);
  double sum = 0, squares = 0;
  for (int k = 0; k < kPoints; ++k) {
    const double d = driver_at(run, driver, from + (k + 0.5) / kPoints * window);
    sum += d, squares += d * d;
  }
  const double mean = sum / kPoints;
  return std::numbers::sqrt2 * std::sqrt(std::max(0.0, squares / kPoints - mean * mean));
}

double period_of(const std::vector<const BodyRun*>& runs, int driver) {
  constexpr int kLeastCrossings = 8;
  constexpr double kLeastSamples = 6;
  double duration = 0;
  int crossings = 0;
  std::size_t samples = 0;
  for (const BodyRun* run : runs) {
    double mean = 0;
    for (std::size_t k = 0; k < run->samples(); ++k) {
      mean += run->drivers_at(k)[driver] / static_cast<double>(run->samples());
    }
    for (std::size_t k = 1; k < run->samples(); ++k) {
      const bool before = run->drivers_at(k - 1)[driver] > mean;
      crossings += before != (run->drivers_at(k)[driver] > mean) ? 1 : 0;
    }
    duration += run->time.back() - run->time.front(), samples += run->samples();
  }
  if (crossings < kLeastCrossings) return 0;
  const double period = 2 * duration / crossings;
  return static_cast<double>(samples) * period < kLeastSamples * duration ? 0 : period;
}

}  // namespace lilytank::bodies
