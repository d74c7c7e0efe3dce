// Random numbers as a function: value = f(seed, stream, step, body, index). Nothing is stored, so
// the order of calls, the number of threads and a restart cannot change a result.
//
// The function is Philox4x32-10 [Salmon et al., SC 2011], from Random123. Every use of randomness
// in the library has its own entry in Stream, so no two uses ever share a number.
#pragma once
#include <array>
#include <cstdint>

namespace lilytank {

/// What a random number is for. Add new uses at the end: the values are part of every result.
enum class Stream : std::uint32_t {
  start_pose = 1,  ///< where bodies start
  /// xi of the flow, per drag point or per module.
  gust = 2,
  stochastic = 3,  ///< the stochastic force
  /// Does a module begin an exchange in this tick.
  initiative = 4,
  /// The random number that an initiator sends.
  message = 5,
  /// Which queued message a module answers.
  answer = 6,
  /// When an unlatched face comes on again.
  reenable = 7,
  /// The event-driven clock's waiting times.
  evaluation = 8,
  /// Where a module's round of its faces begins.
  first_face = 9,
  /// Which runs a resample draws (statistics only, never a world).
  bootstrap = 10,
  /// Where the samples of a latin hypercube lie (studies only).
  latin = 11,
  /// Noise, dropped frames and exchanged bodies of a simulated camera.
  camera = 12,
  /// Where particles start and are drawn to, samples of a search (never a world).
  search = 13,
  /// Messages that are lost, latches that fail.
  fault = 14,
  /// Meetings and evaluations of the lattice model (never a world).
  lattice = 15,
  /// Reactions of the well-mixed model (never a world).
  gillespie = 16,
  /// Where a calibration's simulations lie and begin.
  calibrate = 17,
  /// Waves of the correlated gusts.
  eddies = 18,
  /// Of a module's vortex shedding.
  phase = 19,
  /// The random force that depends on the state.
  state_noise = 20,
  /// When and how hard a module is knocked.
  kick = 21,
  /// Pushes and noise of simulated recordings of point bodies.
  bodies = 22,
};

/// The place of one draw. `step` counts whatever the stream counts by (steps, gusts, ticks; below
/// 2^56); `body` and `index` are free for the stream's use.
struct Draw {
  /// Of the simulation, study or search: the key.
  std::uint64_t seed = 0;
  Stream stream = Stream::start_pose;
  std::int64_t step = 0;
  std::uint32_t body = 0;
  std::uint32_t index = 0;
};

/// 128 random bits.
std::array<std::uint32_t, 4> random_bits(const Draw& draw);
/// Uniform in (0, 1) on 2^52 values; never 0 or 1.
double uniform(const Draw& draw);
/// Two independent standard normals (Box and Muller).
std::array<double, 2> normal_pair(const Draw& draw);

/// Philox's counter and key for a draw: shared by the scalar and the vector code.
std::array<std::uint32_t, 4> counter_of(const Draw& draw);
/// The seed's low and high half.
std::array<std::uint32_t, 2> key_of(std::uint64_t seed);

/// A seed for run number `run` of a study with this seed.
std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t run);

}  // namespace lilytank
