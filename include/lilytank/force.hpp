// One physical effect = one small file in src/forces plus one line in src/forces/library.cpp.
// The simulator adds these terms; calibration varies their parameters; the search for missing
// physics asks each term what it would have done to a recorded motion. All read the same file.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/math.hpp"

namespace lilytank {

class FlowField;
struct Model;

/// A number that a user may set: its name in scenario files, unit, default and bounds (inclusive).
struct Parameter {
  std::string_view name;
  std::string_view unit;  ///< SI, "1" for none
  double standard;        ///< the default
  double low, high;
  std::string_view meaning;  ///< one sentence
  bool whole = false;        ///< integers only
};

/// Poses and twists of all bodies that water touches, structure of arrays, each of length n:
/// modules first, then balls. Read from a running World or from a smoothed recording.
struct Kinematics {
  std::span<const double> x, y;           ///< m
  std::span<const double> c, s;           ///< heading
  std::span<const double> vx, vy;         ///< m/s
  std::span<const double> omega;          ///< rad/s
  std::span<const std::uint8_t> covered;  ///< bit f: face f is latched to a neighbour
  int modules = 0;                        ///< bodies [0, modules) are squares, the rest balls
  int size() const { return static_cast<int>(x.size()); }
};

/// When a force is asked for, and the key of its random draws.
struct Moment {
  double time = 0;        ///< s
  std::int64_t step = 0;  ///< steps of dt since the start
  std::int64_t gust = 0;  ///< 25 ms intervals since the start: a gust is held for one
  std::uint64_t seed = 0;
  bool gusts = true;                 ///< false: nothing random, and the drag of the mean flow
  bool expected = false;             ///< beside gusts = false: drag's mean over gusts instead
  const FlowField* field = nullptr;  ///< the flow now; null: the model's
  double gain = 1;                   ///< factor on its mean and deviation, beside K_v
  double gust_gain = 1;              ///< factor on its deviation alone, beside gain
  /// m/s, [bodies] what terms that stir add to the water's velocity at each body; empty: nothing.
  std::span<const double> ux, uy;
  /// rad/s, [bodies] and to its rotation about each body; empty where ux is.
  std::span<const double> turning;
};

/// The flow field at that moment.
const FlowField& field_now(const Model& model, const Moment& now);

/// What terms that stir do to the water.
struct Stirring {
  double gain = 1;            ///< factor on the field's mean and deviation
  std::span<double> ux, uy;   ///< m/s, [bodies] added to the water's velocity at a body
  std::span<double> turning;  ///< rad/s, [bodies] added to its rotation there, half of its curl
  double gust_gain = 1;       ///< factor on the field's deviation alone
};

/// Factors on twists at the end of a step; 1 leaves them alone.
struct Decay {
  double linear = 1, angular = 1;
};

/// One physical effect on floating bodies. Objects are constant and hold no data.
class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  virtual std::string_view name() const = 0;      ///< key in scenario files: forces.<name>
  virtual std::string_view summary() const = 0;   ///< one sentence
  virtual std::string_view equation() const = 0;  ///< plain text, with its source
  virtual std::span<const Parameter> parameters() const = 0;
  /// Why these values, each within its bounds, make no sense together or in this model:
  /// "<parameter>: <reason>". Empty: they do.
  virtual std::string objection(const Model&, std::span<const double> p) const {
    static_cast<void>(p);
    return "";
  }
  /// Part of the paper's model: on unless a scenario says otherwise.
  virtual bool baseline() const { return false; }
  /// Adds the wrench on every body to `out` (length k.size()). `p` are the parameters' values in
  /// the order of parameters(). Never throws, never allocates.
  virtual void add(const Model&, const Kinematics&, const Moment&, std::span<const double> p,
                   std::span<Wrench> out) const {
    static_cast<void>(p), static_cast<void>(out);
  }
  /// Whether stir() does anything.
  virtual bool stirs() const { return false; }
  /// Whether that is to multiply `water.gain` alone: such terms come first, so that what others do
  /// to the water is done to as much of it as there is.
  virtual bool sets_gain() const { return false; }
  /// Changes the water that all other terms see: multiplies `water.gain`, adds to its velocities
  /// and its rotation, which are to agree: bodies turn with half the curl of what moves them.
  /// Called before any add(); `now` holds what terms before this one did. Never throws or
  /// allocates.
  virtual void stir(const Model&, const Kinematics&, const Moment& now, std::span<const double> p,
                    Stirring& water) const {
    static_cast<void>(now), static_cast<void>(p), static_cast<void>(water);
  }
  /// Whether transform() does anything.
  virtual bool transforms() const { return false; }
  /// Changes the sum of all terms' wrenches, once all have added theirs: what a body makes of a
  /// force. Never throws or allocates.
  virtual void transform(const Model&, const Kinematics&, const Moment& now,
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
  const ForceTerm* term = nullptr;
  std::vector<double> p;
};

/// Every term there is, in the order in which they are added.
std::span<const ForceTerm* const> force_library();
/// The term of that name, or null.
const ForceTerm* find_force(std::string_view name);
/// The term with its parameters at their defaults.
ActiveForce with_defaults(const ForceTerm& term);

}  // namespace lilytank
