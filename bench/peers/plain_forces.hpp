// The forces of the paper's world as a plug-in of a general simulator would compute them: plain
// scalar code in double precision, nothing shared between modules.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "engine.hpp"

namespace lilytank::bench {

/// Standard normals, fast: xoshiro256++ [Blackman and Vigna] and a ziggurat of 128 layers
/// [Marsaglia and Tsang].
class FastNormal {
 public:
  explicit FastNormal(std::uint64_t seed);
  double operator()();

 private:
  std::uint64_t bits();
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  std::uint64_t state_[4];
  std::array<double, 129> edge_, height_;
};

/// For each module one flow sample at its centre, one gust, 4 x N segments of drag, and one random
/// force: 4 normals a module and step.
class PlainForces {
 public:
  PlainForces(const Model& model, std::uint64_t seed);
  void compute(const Bodies& bodies, std::span<Wrench> out);

 private:
  Wrench drag(double c, double s, double wx, double wy, double omega) const;
  const Model& model_;
  FastNormal normal_;
  double K_F_, sigma_;
  int segments_;
};

}  // namespace lilytank::bench
