// Recordings of point bodies that are not our tank's, in one or two dimensions, and what a simple
// model of them leaves out. docs/bodies.md.
#pragma once
#include <string>
#include <vector>

#include "lilytank/diagnosis.hpp"
#include "lilytank/error.hpp"

namespace lilytank {

/// What was recorded of bodies that move together, or of one alone. A sample is a row of all of
/// them; a position that was not seen is NaN.
struct BodyRun {
  std::string name;
  std::string part_of;               ///< the run that was cut at gaps; "": this is a whole one
  std::vector<std::string> bodies;   ///< their names
  std::vector<double> mass, radius;  ///< of each, kg and m; without masses 1: forces are per mass
  std::vector<double> time;          ///< s, rising
  std::vector<double> position;      ///< [sample][body][dimension]
  std::vector<double> drivers;       ///< [sample][driver]
  bool held_out = false;
  std::size_t samples() const { return time.size(); }
  std::size_t coordinates() const { return position.size() / time.size(); }  ///< of a sample
  /// A sample's drivers; null where there are none.
  const double* drivers_at(std::size_t sample) const {
    return drivers.empty() ? nullptr : &drivers[sample * (drivers.size() / time.size())];
  }
};

/// A law that the simple model has: its numbers are given, or fitted where `fit` is set.
struct BaselineLaw {
  std::string law;
  double value = 0;
  bool fit = false;
  SourcePlace place;
};

/// Which runs have the same coefficients.
enum class Coefficients { shared, each_body, each_run };

struct BodyExperiment {
  std::string name;
  int dimensions = 1;
  std::string unit = "m";  ///< of a position
  /// Tables give longitudes (x) and latitudes (y) in degrees; positions are metres east and north
  /// on the plane that touches the Earth at their centre.
  bool geographic = false;
  double noise = 0;  ///< deviation of a position; 0: it is estimated
  Coefficients coefficients = Coefficients::shared;
  bool masses = false;  ///< masses are known
  double density = 0;   ///< of the medium, kg/m^3; 0: unknown
  double turning = 0;   ///< f of the Coriolis force, 1/s; 0: of the driver below, or unknown
  int latitude = -1;    ///< the driver that is a latitude in degrees; -1: none is
  /// Drivers that are the velocity (m/s) along x and y of the medium that bodies float in, and of
  /// the wind above it; -1: none are.
  int current[2] = {-1, -1}, wind[2] = {-1, -1};
  std::vector<BaselineLaw> baseline;
  std::vector<std::string> drivers;
  std::vector<BodyRun> runs;
  std::vector<std::string> files;     ///< of the tables
  std::vector<std::string> left_out;  ///< what of the tables is too short to be a run, a line each
};

/// Whether a file is an experiment of point bodies: [experiment] body = "point". False for files
/// that cannot be read or are no TOML, which other readers refuse. Throws InputError where there is
/// a [baseline] but another body, or none.
bool is_body_experiment(const std::string& file);

/// Reads an experiment and its tables. Throws InputError with file, line, column and value.
BodyExperiment load_body_experiment(const std::string& file);

/// Carries a diagnosis through, or goes on with one that was stopped in `options.out`. `minutes`
/// scales the simulated baselines; hold_out does not count. Throws Stopped and InputError.
Diagnosis diagnose_bodies(const BodyExperiment& experiment, const DiagnosisOptions& options);

}  // namespace lilytank
