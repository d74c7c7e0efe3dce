#include "plain_forces.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/error.hpp"

namespace lilytank::bench {
namespace {

constexpr int kLayers = 128;
constexpr double kTail = 3.442619855899;       // where the lowest layer's rectangle ends
constexpr double kArea = 9.91256303526217e-3;  // of each layer

double parameter(const Model& model, std::string_view term, std::size_t index) {
  for (const ActiveForce& force : model.forces) {
    if (force.term->name() == term) return force.p[index];
  }
  return 0;
}

}  // namespace

FastNormal::FastNormal(std::uint64_t seed) {
  for (std::uint64_t& word : state_) {  // splitmix64 [Steele, Lea and Flood]
    std::uint64_t z = seed += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    word = z ^ (z >> 31);
  }
  const auto density = [](double x) { return std::exp(-x * x / 2); };
  edge_[0] = kArea / density(kTail), edge_[1] = kTail;
  for (int i = 2; i < kLayers; ++i)
    edge_[i] = std::sqrt(-2 * std::log(kArea / edge_[i - 1] + density(edge_[i - 1])));
  edge_[kLayers] = 0;
  for (int i = 0; i <= kLayers; ++i) height_[i] = density(edge_[i]);
}

std::uint64_t FastNormal::bits() {
  const auto turn = [](std::uint64_t x, int k) { return x << k | x >> (64 - k); };
  const std::uint64_t out = turn(state_[0] + state_[3], 23) + state_[0], t = state_[1] << 17;
  state_[2] ^= state_[0], state_[3] ^= state_[1];
  state_[1] ^= state_[2], state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = turn(state_[3], 45);
  return out;
}

double FastNormal::operator()() {
  for (;;) {
    const std::uint64_t word = bits();
    const auto layer = static_cast<int>(word % kLayers);
    const double sign = word & kLayers ? 1 : -1;
    const double x = static_cast<double>(word >> 11) * 0x1p-53 * edge_[layer];
    if (x < edge_[layer + 1]) return sign * x;
    if (layer == 0) {  // beyond the tail's start, by an exponential
      double beyond = 0, other = 0;
      do {
        beyond = -std::log(1 - uniform()) / kTail;
        other = -std::log(1 - uniform());
      } while (2 * other < beyond * beyond);
      return sign * (kTail + beyond);
    }
    const double y = height_[layer] + uniform() * (height_[layer + 1] - height_[layer]);
    if (y < std::exp(-x * x / 2)) return sign * x;
  }
}

PlainForces::PlainForces(const Model& model, std::uint64_t seed)
    : model_(model),
      normal_(seed),
      K_F_(parameter(model, "face_drag", 0)),
      sigma_(parameter(model, "stochastic", 0)),
      segments_(static_cast<int>(parameter(model, "face_drag", 1))) {}

// In the module's frame; w is the water's velocity relative to the centre.
Wrench PlainForces::drag(double c, double s, double wx, double wy, double omega) const {
  static constexpr double nx[4] = {1, 0, -1, 0}, ny[4] = {0, 1, 0, -1};
  const double side = model_.module.side, pitch = side / segments_;
  const double k = 0.5 * K_F_ * model_.flow.rho * model_.module.draught * pitch;
  const double bx = c * wx + s * wy, by = c * wy - s * wx;
  double fx = 0, fy = 0, torque = 0;
  for (int face = 0; face < 4; ++face) {
    for (int q = 0; q < segments_; ++q) {
      const double along = (q + 0.5) * pitch - side / 2;
      const double px = nx[face] * side / 2 - ny[face] * along;
      const double py = ny[face] * side / 2 + nx[face] * along;
      const double ux = bx + omega * py, uy = by - omega * px;
      const double f = k * std::max(0.0, -(ux * nx[face] + uy * ny[face]));
      fx += f * ux, fy += f * uy;
      torque += f * (px * uy - py * ux);
    }
  }
  return {c * fx - s * fy, s * fx + c * fy, torque};
}

void PlainForces::compute(const Bodies& bodies, std::span<Wrench> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const FlowSample flow = model_.field->at(bodies.x[i], bodies.y[i]);
    const double wx = model_.flow.K_v * (flow.mu_x + flow.sigma_x * normal_()) - bodies.vx[i];
    const double wy = model_.flow.K_v * (flow.mu_y + flow.sigma_y * normal_()) - bodies.vy[i];
    out[i] = drag(bodies.c[i], bodies.s[i], wx, wy, bodies.omega[i]);
    out[i].fx += sigma_ * normal_();
    out[i].fy += sigma_ * normal_();
  }
}

}  // namespace lilytank::bench
