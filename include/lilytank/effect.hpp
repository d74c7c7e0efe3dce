// How the search for omitted physics tries a force term. Plain data, beside the term's parameters
// in the file of the force.
#pragma once
#include <cstdint>
#include <string_view>

namespace lilytank {

class ForceTerm;

/// What a routine measures directly in recordings, besides amplitudes. All but the
/// place serve one term.
enum class Estimated : std::uint8_t {
  none,
  place,               ///< where in the tank, and how wide: held are x, y and the width
  gain_and_frequency,  ///< the strongest line in the flow's gain
  slip_and_frequency,  ///< the clearest line in the force across the slip
  module,              ///< the one module that differs
};

/// Experiments that distinguish effects of one kind.
namespace split_by {
inline constexpr std::string_view kLatches = "latches off, or their times logged";
inline constexpr std::string_view kEventLog = "the modules' events, logged by radio";
inline constexpr std::string_view kLoneModule = "a recording of one module alone";
inline constexpr std::string_view kOtherBodies = "a recording of bodies of another shape or mass";
inline constexpr std::string_view kTurnedCamera =
    "a recording with the camera turned by half a turn";
inline constexpr std::string_view kGrid = "a picture of a square grid on the water";
inline constexpr std::string_view kPumpPower = "a recording at another pump power";
}  // namespace split_by

/// One candidate of the search: a term with some of its parameters fitted and some held. A term has
/// several where an effect is tried at different ranges or frequencies.
struct EffectDescription {
  /// A parameter that is fitted, 0 where the effect is absent.
  struct Amplitude {
    /// Of the term; empty: there is no second one.
    std::string_view parameter;
    /// Its value in simulations, SI: some minutes of recordings show it by about ten standard
    /// errors.
    double size = 0;
  };
  /// A parameter that is held while the effect is sought.
  struct Held {
    /// Of the term; empty: no more.
    std::string_view parameter;
    /// Its value, SI. Of coordinates in the tank the search chooses it, and the bounds.
    double value = 0;
    /// Bounds between which it is fitted once the effect is found; both 0: it is not.
    double low = 0, high = 0;
    /// Where a search over the values in recordings begins; 0: at `low`.
    double scanned_from = 0;
  };
  /// Rank of those that say none.
  static constexpr int kLast = 1000;

  /// Place in the catalogue, ascending. The search's random draws depend on it: a new effect that
  /// leaves it out comes last and keeps the draws of the others.
  int order = kLast;
  /// What the effect is a function of: position, radius, pair, slip, heading, spin, time, module or
  /// lag. Reports group by it.
  std::string_view variable;
  Amplitude amplitudes[2];
  Held held[3];
  /// Amplitudes may be negative.
  bool two_sided = false;
  /// The term of the same law with the opposite sign, which is measured for both.
  const ForceTerm& (*negative_of)() = nullptr;
  /// The cheapest experiment that distinguishes it from effects of the same variable; "": none.
  std::string_view split;
  /// The term's force is compared with the innovations of a filter.
  bool scored = true;
  /// It displaces modules on the average; false: it changes only how they scatter.
  bool mean_force = true;
  /// Power of the amplitude with which it begins to show: 2 if the amplitude is a standard
  /// deviation, or if a calibration absorbs what is in proportion to it.
  double growth = 1;
  Estimated estimated = Estimated::none;
};

}  // namespace lilytank
