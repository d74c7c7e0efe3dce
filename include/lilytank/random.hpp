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
  gust = 2,        ///< xi of the flow, per drag point or per module
  stochastic = 3,  ///< the stochastic force
  initiative = 4,  ///< does a module begin an exchange in this tick
  message = 5,     ///< the random number that an initiator sends
  answer = 6,      ///< which queued message a module answers
  reenable = 7,    ///< when an unlatched face comes on again
  evaluation = 8,  ///< the event-driven clock's waiting times
  first_face = 9,  ///< where a module's round of its faces begins
  bootstrap = 10,  ///< which runs a resample draws (statistics only, never a world)
  latin = 11,      ///< where the samples of a latin hypercube lie (studies only)
  camera = 12,     ///< noise, dropped frames and exchanged bodies of a simulated camera
  search = 13,     ///< where particles start and are drawn to, samples of a search (never a world)
  fault = 14,      ///< messages that are lost, latches that fail
  lattice = 15,    ///< meetings and evaluations of the lattice model (never a world)
  gillespie = 16,  ///< reactions of the well-mixed model (never a world)
  calibrate = 17,  ///< where a calibration's simulations lie and begin
  eddies = 18,     ///< waves of the correlated gusts
  phase = 19,      ///< of a module's vortex shedding
  state_noise = 20,  ///< the random force that depends on the state
  kick = 21,         ///< when and how hard a module is knocked
  bodies = 22,       ///< pushes and noise of simulated recordings of point bodies
};

/// The place of one draw. `step` counts whatever the stream counts by (steps, gusts, ticks; below
/// 2^56); `body` and `index` are free for the stream's use.
struct Draw {
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
std::array<std::uint32_t, 2> key_of(std::uint64_t seed);

/// A seed for run number `run` of a study with this seed.
std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t run);

}  // namespace lilytank
