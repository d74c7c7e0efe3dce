// Experiments with a known secret: what is in them, and the recordings of them.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "effects/effects.hpp"
#include "lilytank/flow_field.hpp"
#include "lilytank/recording.hpp"

namespace lilytank {

inline constexpr double kSealedRate = 30;    ///< frames per second
inline constexpr int kSealedRecordings = 3;  ///< of an experiment
inline constexpr int kSealedSteps = 10;      ///< steps a tick: 2.5 ms

/// An effect and its amplitudes, in units of its sizes.
struct SealedEffect {
  int like = -1;  ///< the catalogue's effect that it is nearest to; -1: a law that has no name
  Effect effect;
  std::vector<double> amplitudes;
};

/// The ground truth of one blinded experiment.
struct Sealed {
  int world = 0;                   ///< its number in the sequence of a seed
  std::string kind;                ///< null, named, two, unnamed
  std::vector<std::string> names;  ///< of the effects; of a law without one its variable
  std::vector<SealedEffect> effects;
  std::vector<double> factors;  ///< on the five parameters
  bool foreign = false;         ///< recorded with another engine (foreign_tank.hpp)
  bool logged = false;          ///< the modules' events are logged, if the tank's have latches
};

/// A tank of synthetic experiments without omitted effects: the built-in one.
Model tank_model();
/// Another, drawn from a seed: a flow of 0.6 to 1.4 times the built-in one's strength from other
/// inlets, and the parameters of Lilies up to a quarter off (but K_v, as balls meet this flow).
struct DrawnTank {
  AnalyticTank water;
  std::vector<double> factors;  ///< on the parameters of standard_parameters but K_v
};
DrawnTank drawn_tank(std::uint64_t seed);
Model tank_model(const DrawnTank& tank);
/// Its line of the key.
std::string key_text(const DrawnTank& tank);
/// At so many steps a tick.
Model with_steps(Model model, int steps);
/// Recordings of so many bodies and seconds, each body unseen in some frames.
RecordingShape shape_named(const std::string& name, BodyKind body, int bodies, double seconds);

/// What a camera over the tank sees, at `cameras` with the values `seen` (paths of
/// emulator_parameter()); nothing if a world diverged. `foreign`: Box2D moves the bodies. Throws
/// InputError if this program was built without it.
std::optional<std::vector<Recording>> film_tank(const Model& model,
                                                const std::vector<std::string>& cameras,
                                                const std::vector<double>& seen,
                                                const std::vector<RecordingShape>& shapes,
                                                std::uint64_t seed, bool foreign);

/// The secret of one world: of eight two are complete, one has a law of no effect, one two effects.
/// Effects have other ranges, times, frequencies and places than those of the catalogue.
Sealed seal(const Model& tank, const std::vector<Effect>& effects, const std::vector<Shape>& shapes,
            std::uint64_t seed, int world);
/// A line of the key.
std::string key_text(const Sealed& s);
/// Recordings of it, `count` of so many modules; nothing if a world diverged.
std::optional<std::vector<Recording>> film_sealed(const Model& tank, const Sealed& s, int modules,
                                                  double seconds, int count, std::uint64_t seed);
/// An experiment of it: as many recordings as one has, of the tank's modules.
std::optional<std::vector<Recording>> film_sealed(const Model& tank, const Sealed& s,
                                                  double seconds, std::uint64_t seed);
/// Every number of a synthetic experiment that a diagnosis may report, by path.
std::map<std::string, double> truth_of(const Model& tank, const Sealed& s);

}  // namespace lilytank
