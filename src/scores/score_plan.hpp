// What is measured of an experiment: the list of effects, curves and numbers that scores are of.
#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effects/effects.hpp"
#include "lilytank/predictor.hpp"

namespace lilytank {

class Nuisances;

/// Number of different ids of tracks, over all recordings.
int identities_in(const std::vector<Recording>& recordings);

/// One number of the vector that is compared.
struct ScoreEntry {
  std::string group;  ///< score, module, noise, spectrum, contact, camera, bond, shape
  std::string name;
  double least_deviation = 0;  ///< among null experiments, by theory; 0: unknown
};

/// What is measured: fixed before anything is measured, the same for recordings and simulations.
struct ScorePlan {
  Model model;  ///< the predictor's
  PredictorOptions predictor;
  std::vector<Effect> effects;
  std::vector<Shape> shapes;
  double rate = 30;
  int modules = 15;  ///< identities in all recordings, of each call
  /// Every body keeps its identity, in all recordings: differences between single modules are
  /// tested.
  bool identities = true;
  /// Effects that are there as well, of any amplitude: scores are cleared of these, too.
  std::vector<Effect> beside;
  std::shared_ptr<const Nuisances> nuisances;  ///< empty: there are none
  /// s for which forces on a module are held, as it moves by millimetres meanwhile.
  double held = 0.1;
  /// Nuisances::known(); empty if there are none.
  Eigen::MatrixXd nuisances_known() const;

  /// Modules latch: assemblies are predicted as one body each, and bonds are counted.
  bool latched() const { return model.control.latches; }
  /// The modules' events were logged, in every recording with latches on.
  bool logged = false;

  std::vector<ScoreEntry> entries() const;
  /// Where the scores of the components of effect `index` begin, if it is scored; of one past the
  /// last their number.
  std::size_t first_of_effect(std::size_t index) const;
  /// Where the knots of shape `index` begin in the vector.
  std::size_t first_of_shape(std::size_t index) const;
};

/// Where an effect is, as Estimated::place has it.
struct FoundPlace {
  double x = 0, y = 0, width = 0.06;  ///< m
  std::vector<double> amplitudes;     ///< in sizes of the effect
  double gain = 0;                    ///< rise of twice the log-likelihood
  bool operator==(const FoundPlace&) const = default;
};

/// The places of an effect that were tried.
struct PlaceScan {
  FoundPlace best;
  /// Linear estimates about the places of a hexagonal grid, each alone, of one width, row by row.
  std::vector<FoundPlace> map;
};

/// The range or thickness of an effect, and its amplitude in sizes.
struct ScannedValue {
  double value = 0, amplitude = 0;
};

/// Direct estimates from recordings for effects that have a place or a range.
struct Scans {
  /// Of effects that have a place, by their terms.
  std::map<const ForceTerm*, PlaceScan> places;
  /// By the effect's term, of those that are clear; a repulsion is a negative attraction.
  std::map<const ForceTerm*, ScannedValue> values;
};

/// Beside the vector, what a verdict needs of one experiment.
struct ScoreDetails {
  double pulsation = 0;  ///< Hz, the strongest line in the flow's gain
  double swinging = 0;   ///< Hz, the clearest line across the slip; 0: none is clear
  int heaviest = 0;      ///< module with the weakest response
  Scans scans;           ///< computed on request
  /// Ranges, times and lengths by path, where experiments with others than those of the catalogue
  /// and of scans fit better.
  std::map<std::string, double> refined;
};

}  // namespace lilytank
