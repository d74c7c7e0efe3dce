// About ninety summary statistics of the motion of bodies in a tank, which a model must reproduce.
//
// Every number is computed from the tracks as they were recorded, without a smoother, over all
// bodies and recordings together. They are meant to be compared with those of a simulated recording
// of the same shape and noise (emulator.hpp), never with theory.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "lilytank/flow_field.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

/// What the numbers are, and what they are of.
struct MotionSummary {
  double tank_radius = 0.30;  ///< m
  double body_size = 0.035;   ///< m, side or diameter
  double rate = 30;           ///< frames per second; lags are whole frames of it
  double longest = 60;        ///< s, of the MSD
  bool headings = true;
  /// The mean flow that the balance of momentum is taken against: any field near the truth, the
  /// same for all that is compared. Without one these numbers are absent.
  std::shared_ptr<const FlowField> field;
};

/// Names of the numbers, "msd 0.4 s", and the group of each: displacement, velocity, place, kicks,
/// balance, turning, neighbours.
struct SummaryEntry {
  std::string group, name;  ///< the name is unique and has the lag or distance with its unit
};
/// Depends on the settings alone, not on data: vectors of equal settings can be compared.
std::vector<SummaryEntry> summary_entries(const MotionSummary& summary);

/// The numbers of recordings of one kind of body, at one rate, in the order of summary_entries.
/// Means, most of them as logarithms, ratios or roots, so that their scatter hardly depends on the
/// values. Always finite; 0 where the recordings say nothing.
std::vector<double> summarise(const std::vector<Recording>& recordings,
                              const MotionSummary& summary);

/// At which lags MSDs are compared by Eq. 9.
struct Eq9 {
  double seconds = 60;   ///< longest lag
  double lag = 0.1;      ///< s between lags: whole frames at 30 Hz, whole steps of 25 ms
  double origins = 0.2;  ///< s between starts of displacements
  bool first_origin =
      false;  ///< the first frame is the only start, as in a piece of just that length
};
/// The MSD that Eq. 9 compares, m^2: at lags 0.1 s, 0.2 s, ... (the nearest frames), aggregated
/// over all bodies of all recordings. NaN at lags for which there is nothing.
std::vector<double> eq9_curve(const std::vector<Recording>& recordings, const Eq9& rule = {});
/// Eq. 9 of two such curves: the sum over 2400 lags of 25 ms of |difference|, m^2; the curves' own
/// lags are fewer, so it is 2400 times the mean. Infinite if they share no lag.
double eq9(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace lilytank
