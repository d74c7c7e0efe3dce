// One physical effect = one small file in src/forces plus one line in src/forces/library.cpp.
// The simulator adds these terms; calibration varies their parameters; the search for omitted
// effects reads from the same file how to try a term, and evaluates it on recorded motion.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/effect.hpp"
#include "lilytank/math.hpp"

namespace lilytank {

class FlowField;
class KeptGusts;
class LaneForce;
struct Model;

/// What a parameter measures: how synthetic experiments draw other values of it.
enum class ParameterKind : std::uint8_t {
  scale,      ///< a strength, range, time or frequency: times a factor
  place,      ///< a coordinate in the tank
  phase,      ///< of an oscillation: any
  direction,  ///< in the module's frame: stays as it is
  module,     ///< the number of one
};

/// A number that a user may set. Scenario files name it forces.<term>.<name>.
struct Parameter {
  /// Key in scenario files.
  std::string_view name;
  /// SI; "1" if dimensionless.
  std::string_view unit;
  /// The default.
  double standard;
  /// Bounds, inclusive. Values outside are refused when a scenario is read.
  double low, high;
  /// One sentence, with the source of the default.
  std::string_view meaning;
  /// Integers only.
  bool whole = false;
  ParameterKind kind = ParameterKind::scale;
};

/// Poses and twists of all bodies that water touches, structure of arrays, each of length n:
/// modules first, then balls. Views of a running World or of a smoothed recording.
struct Kinematics {
  /// Centres, m.
  std::span<const double> x, y;
  /// Headings: cosine and sine.
  std::span<const double> c, s;
  /// Velocities of the centres, m/s.
  std::span<const double> vx, vy;
  /// Angular velocities, rad/s, counter-clockwise.
  std::span<const double> omega;
  /// Bit f: face f is latched to a neighbour.
  std::span<const std::uint8_t> covered;
  /// Bodies [0, modules) are squares, the rest balls.
  int modules = 0;
  int size() const { return static_cast<int>(x.size()); }
};

/// The instant at which forces are evaluated, the key of their random draws, and the water then.
struct StepContext {
  /// s
  double time = 0;
  /// Steps of dt since the start.
  std::int64_t step = 0;
  /// Ticks of 25 ms since the start. A gust holds for one.
  std::int64_t gust = 0;
  /// Key of all draws (random.hpp).
  std::uint64_t seed = 0;
  /// false: random forces are off, and drag is that of the mean flow.
  bool gusts = true;
  /// With gusts = false: drag is its mean over gusts instead, which exceeds that of the mean flow
  /// because drag is quadratic.
  bool expected = false;
  /// The flow now; null: Model::field.
  const FlowField* field = nullptr;
  /// Factor on the field's mean and standard deviation, beside K_v.
  double gain = 1;
  /// Factor on its standard deviation alone, beside gain.
  double gust_gain = 1;
  /// [bodies] What perturb_flow() of the terms adds to the water's velocity at each body, m/s;
  /// empty: nothing.
  std::span<const double> ux, uy;
  /// [bodies] What it adds to the water's rotation about each body, rad/s; empty where ux is.
  std::span<const double> turning;
  /// [bodies] Factor on the drag of Eqs. 2 and 5; empty: 1.
  std::span<const double> drag;
  /// The gusts' random numbers, where the steps of a tick share them; null: drawn in each step.
  KeptGusts* kept = nullptr;
};

/// The flow field of the step: StepContext::field, or the model's.
const FlowField& field_now(const Model& model, const StepContext& now);

/// Changes of the flow by terms that perturb it. They start from no change and accumulate.
struct FlowPerturbation {
  /// Factor on the field's mean and standard deviation; terms multiply it.
  double gain = 1;
  /// [bodies] Added to the water's velocity at a body, m/s.
  std::span<double> ux, uy;
  /// [bodies] Added to the water's rotation there, rad/s: half of the curl of (ux, uy).
  std::span<double> turning;
  /// Factor on the field's standard deviation alone.
  double gust_gain = 1;
  /// [bodies] Factor on the drag; terms multiply it.
  std::span<double> drag;
};

/// Factors on linear and angular velocity at the end of a step; 1 leaves them unchanged. Those of
/// all terms multiply.
struct Decay {
  double linear = 1, angular = 1;
};

/// One physical effect on floating bodies. Objects are constant and hold no data.
class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  /// Key in scenario files: forces.<name>.
  virtual std::string_view name() const = 0;
  /// One sentence, for `lilytank forces`.
  virtual std::string_view summary() const = 0;
  /// The law as plain text, with its source.
  virtual std::string_view equation() const = 0;
  /// Constant for a term; defines its scenario keys, checks and documentation.
  virtual std::span<const Parameter> parameters() const = 0;
  /// Why these values, each within its bounds, make no sense together or in this model:
  /// "<parameter>: <reason>". Empty: they do.
  virtual std::string objection(const Model&, std::span<const double> p) const {
    static_cast<void>(p);
    return "";
  }
  /// How the search for omitted effects tries the term; empty: it does not.
  virtual std::span<const EffectDescription> effects() const { return {}; }
  /// Part of the paper's model: on unless a scenario says otherwise.
  virtual bool baseline() const { return false; }
  /// Adds the wrench on every body to `out` (length k.size()). `p` are the parameters' values in
  /// the order of parameters(). Never throws, never allocates.
  virtual void add(const Model&, const Kinematics&, const StepContext&, std::span<const double> p,
                   std::span<Wrench> out) const {
    static_cast<void>(p), static_cast<void>(out);
  }
  /// add() without conversions, for the engine's float32 arrays; null: there is only add(). The
  /// models' parameters `p` outlive it.
  virtual std::unique_ptr<LaneForce> in_lanes(const Model&, std::span<const double> p) const;
  /// Whether perturb_flow() does anything.
  virtual bool perturbs_flow() const { return false; }
  /// Whether that is to multiply `water.gain` alone: such terms come first, so that what others do
  /// to the water is done to as much of it as there is.
  virtual bool sets_gain() const { return false; }
  /// Changes the water that all other terms see: multiplies `water.gain` and `water.drag`, adds to
  /// its velocities and its rotation, which are to agree: bodies turn with half the curl of what
  /// moves them. Called before any add(); `now` holds what terms before this one did. Never throws
  /// or allocates.
  virtual void perturb_flow(const Model&, const Kinematics&, const StepContext& now,
                            std::span<const double> p, FlowPerturbation& water) const {
    static_cast<void>(now), static_cast<void>(p), static_cast<void>(water);
  }
  /// Whether transform() does anything.
  virtual bool transforms() const { return false; }
  /// Changes the sum of all terms' wrenches, once all have added theirs: what a body makes of a
  /// force. Never throws or allocates.
  virtual void transform(const Model&, const Kinematics&, const StepContext& now,
                         std::span<const double> p, std::span<Wrench> sum) const {
    static_cast<void>(now), static_cast<void>(p), static_cast<void>(sum);
  }
  /// Damping at the end of a step of length dt (s).
  virtual Decay decay(std::span<const double> p, double dt) const {
    static_cast<void>(p), static_cast<void>(dt);
    return {};
  }
};

/// A term that is switched on, with its parameters' values.
struct ActiveForce {
  /// Lives as long as the program.
  const ForceTerm* term = nullptr;
  /// In the order of term->parameters().
  std::vector<double> p;
};

/// Every term there is, in the order in which they are added (src/forces/library.cpp).
std::span<const ForceTerm* const> force_library();
/// The term of that name, or null.
const ForceTerm* find_force(std::string_view name);
/// The term with its parameters at their defaults.
ActiveForce with_defaults(const ForceTerm& term);

}  // namespace lilytank
