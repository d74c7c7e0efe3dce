// A made-up run for pictures: 15 modules in a swirl build chains of five. No physics.
#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "lilytank/render.hpp"

namespace lilytank::sample {

/// A swirl with seven streams, made here so that these tests need no other part of the library.
inline std::shared_ptr<const FlowField> swirl(double radius) {
  constexpr int kCells = 50;
  std::vector<FlowSample> samples;
  for (int iy = 0; iy < kCells; ++iy) {
    for (int ix = 0; ix < kCells; ++ix) {
      const double x = ((ix + 0.5) / kCells * 2 - 1) * radius;
      const double y = ((iy + 0.5) / kCells * 2 - 1) * radius;
      const double r = std::hypot(x, y) + 1e-9, q = r / 0.13;
      const double around = 0.2 * q * q * std::exp(2 - 2 * q), inward = 0.35 * around;
      FlowSample f{(-around * y - inward * x) / r, (around * x - inward * y) / r, 0.1, 0.1};
      for (int k = 0; k < 7; ++k) {
        const double a = 2 * kPi * k / 7, way = a + kPi - kPi / 12;
        const double dx = x - radius * std::cos(a), dy = y - radius * std::sin(a);
        const double along = dx * std::cos(way) + dy * std::sin(way);
        const double aside = dy * std::cos(way) - dx * std::sin(way);
        if (along < 0) continue;
        const double v = 0.15 * std::exp(-along / 0.08 - aside * aside / 5e-4);
        f.mu_x += v * std::cos(way), f.mu_y += v * std::sin(way);
      }
      samples.push_back(f);
    }
  }
  const std::vector<bool> measured(samples.size(), true);
  return std::make_shared<FlowField>(kCells, radius, samples, measured, Interpolation::bilinear);
}

/// The ruleset of the five-chain, as far as pictures use it: its states and its target.
inline Ruleset chain() {
  Ruleset rules;
  rules.name = "chain5";
  const int before[4] = {0, 1, 4, 6};
  for (int k = 0; k < 4; ++k) {
    Rule rule;
    rule.before = {Label{before[k], before[k] == 0 ? 0 : 3}, Label{0, 0}};
    rule.after = {Label{2 * k + 1, 1}, Label{2 * k + 2, 1}};
    rules.rules.push_back(rule);
  }
  for (int x = 0; x < 5; ++x) rules.target.push_back({x, 0});
  return rules;
}

/// Time (s) at which member `place` joins chain `group`; members 0 and 1 join each other.
inline double join_time(int group, int place) {
  constexpr double kStart[3] = {20, 50, 90}, kGap[3] = {60, 130, 400};
  return kStart[group] + kGap[group] * (place == 0 ? 0 : place - 1);
}

struct Drift {
  double x, y, theta;
};

/// Where a chain's middle is.
inline Drift chain_pose(int group, double t) {
  const double a = 2.1 * group + 0.55 * t, r = 0.15 + 0.02 * std::sin(0.13 * t + group);
  return {r * std::cos(a), r * std::sin(a), a + kPi / 2 + 0.25 * std::sin(0.2 * t + 2 * group)};
}

/// Where an unbound module is.
inline Drift free_pose(int module, double t) {
  const bool outer = module % 2 == 0;
  const double a = 2.4 * module + (outer ? 0.35 : 1.0) * t;
  const double r = outer ? 0.255 + 0.012 * std::sin(0.7 * t + module)
                         : 0.045 + 0.015 * std::sin(0.9 * t + module);
  return {r * std::cos(a), r * std::sin(a), 0.9 * t + module};
}

/// What member `place` of a chain of `members` shows.
inline Markings marks(int place, int members, bool just_joined) {
  static constexpr int kLabels[6][5] = {{0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {2, 1, 0, 0, 0},
                                        {2, 3, 4, 0, 0}, {2, 3, 5, 6, 0}, {2, 3, 5, 7, 8}};
  Markings m;
  if (members < 2 || place >= members) return m;
  m.label = static_cast<std::int16_t>(kLabels[members][place]);
  m.last = static_cast<std::int8_t>(place + 1 < members ? 0 : 2);
  if (place > 0) m.latched |= 4;
  if (place + 1 < members) m.latched |= 1;
  m.bonded = m.latched;
  // For a second after it came the newest member is held but not yet bonded.
  if (just_joined && place + 1 == members) m.bonded = static_cast<std::uint8_t>(m.bonded & ~4);
  if (just_joined && place + 2 == members) m.bonded = static_cast<std::uint8_t>(m.bonded & ~1);
  m.complete = members == 5 && !just_joined;
  return m;
}

inline void append_frame(StoredRun& run, double t) {
  const double side = run.scenario.model.module.side;
  Trajectory& out = run.trajectory;
  out.time.push_back(t);
  for (int i = 0; i < 15; ++i) {
    const int group = i / 5, place = i % 5;
    int members = 0;
    for (int k = 0; k < 5; ++k) members += t >= join_time(group, k);
    const bool in = t >= join_time(group, place);
    const bool recent = members >= 2 && t - join_time(group, members - 1) < 1;
    Drift p = free_pose(i, t);
    const Drift c = chain_pose(group, t);
    const double along = (place - 2) * side;
    const Drift slot{c.x + along * std::cos(c.theta), c.y + along * std::sin(c.theta), c.theta};
    // The last three seconds bring a module to its place.
    const double w = in ? 1 : std::max(0.0, 1 - (join_time(group, place) - t) / 3);
    const double s = w * w * (3 - 2 * w);
    p.x += s * (slot.x - p.x), p.y += s * (slot.y - p.y);
    p.theta += s * std::remainder(slot.theta - p.theta, 2 * kPi);
    out.x.push_back(static_cast<float>(p.x));
    out.y.push_back(static_cast<float>(p.y));
    out.theta.push_back(static_cast<float>(std::remainder(p.theta, 2 * kPi)));
    out.markings.push_back(in ? marks(place, members, recent) : Markings{});
  }
}

/// The whole run: `duration` s at `rate` frames per second.
inline StoredRun run(double duration = 600, double rate = 5) {
  StoredRun r;
  r.scenario.title = "Self-assembly of chains of five";
  r.scenario.duration = duration;
  Model& model = r.scenario.model;
  model.field = swirl(model.tank.radius);
  model.rulesets.push_back(chain());
  r.trajectory.bodies = r.trajectory.modules = model.module.count;
  const int frames = static_cast<int>(std::lround(duration * rate)) + 1;
  for (int f = 0; f < frames; ++f) append_frame(r, f / rate);
  for (int k = 0; 10 * k <= duration; ++k) {
    const auto frame = static_cast<std::size_t>(std::lround(10 * k * rate));
    int complete = 0;
    for (std::size_t i = 0; i < 15; ++i) complete += r.trajectory.markings[frame * 15 + i].complete;
    r.metrics_time.push_back(10 * k);
    r.metrics_copies.push_back(complete / 5);
  }
  return r;
}

}  // namespace lilytank::sample
