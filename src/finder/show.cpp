#include "finder/show.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "lilytank/model_parameter.hpp"
#include "lilytank/predictor.hpp"
#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "scores/flow_uncertainty.hpp"
#include "scores/scores.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

using Vector2 = Eigen::Vector2d;

constexpr double kBlock = 10;         // s
constexpr double kFarInnovation = 6;  // deviations at which an innovation stops to count more
constexpr double kContactPushed = 0.03;
constexpr int kPhases = 8, kFinePhases = 360;

struct Moments {
  double count = 0, sum = 0, square = 0;
  void add(double v) { count += 1, sum += v, square += v * v; }
  double mean() const { return count > 0 ? sum / count : 0; }
  double variance() const {
    return count > 1 ? std::max(0.0, (square - sum * sum / count) / (count - 1)) : 0;
  }
};

// Whether most simulations have the same value, as for a ring that modules rarely visit.
bool hardly_varies(const std::vector<std::vector<double>>& simulated, std::size_t k) {
  std::vector<double> values;
  for (const auto& row : simulated) values.push_back(row[k]);
  std::sort(values.begin(), values.end());
  return values[values.size() / 4] == values[(3 * values.size()) / 4];
}

// Mean squared z of observed statistics against simulated ones, by group.
std::map<std::string, double> misfit_by_group(const std::vector<SummaryEntry>& entries,
                                              const std::vector<double>& observed,
                                              const std::vector<std::vector<double>>& simulated,
                                              const std::vector<std::vector<double>>& scatter) {
  std::map<std::string, Moments> groups;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    Moments of, width;
    for (const auto& row : simulated) of.add(row[k]);
    for (const auto& row : scatter) width.add(row[k]);
    const double variance = width.variance() * (1 + 1 / std::max(1.0, of.count));
    if (!(variance > 0) || hardly_varies(scatter, k)) continue;
    const double off = observed[k] - of.mean();
    groups[entries[k].group].add(off * off / variance);
  }
  std::map<std::string, double> out;
  for (const auto& [group, m] : groups) out[group] = m.mean();
  return out;
}

std::vector<double> mean_curve(const std::vector<std::vector<double>>& curves,
                               const std::vector<std::size_t>& which) {
  std::vector<double> out(curves.front().size(), 0.0);
  for (const std::size_t i : which) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] += curves[i][k] / static_cast<double>(which.size());
    }
  }
  return out;
}

// Innovations of one model in a recording, by module and frame.
using Key = std::pair<int, int>;
using Innovations = std::map<Key, std::array<double, 3>>;
Innovations innovations(const Model& model, const Recording& recording,
                        const PredictorOptions& predictor) {
  Innovations out;
  predict(model, {recording}, predictor, [&](const PredictedFrame& f) {
    for (std::size_t i = 0; i < f.dx.size(); ++i) {
      if (f.usable[i] == 0 || std::isnan(f.dx[i]) || f.contact[i] > kContactPushed) continue;
      out[{f.module[i], f.frame}] = {
          std::clamp(f.dx[i] / f.sd_x[i], -kFarInnovation, kFarInnovation),
          std::clamp(f.dy[i] / f.sd_x[i], -kFarInnovation, kFarInnovation),
          std::clamp(f.dtheta[i] / f.sd_theta[i], -kFarInnovation, kFarInnovation)};
    }
  });
  return out;
}

// The model with the pumps' phase that predicts a recording best: every recording starts at a
// random phase. The squared innovations have two harmonics in the phase.
Model in_phase(const Model& model, const Recording& recording, const PredictorOptions& predictor) {
  const auto pumps =
      std::find_if(model.forces.begin(), model.forces.end(), [](const ActiveForce& f) {
        const auto own = f.term->effects();
        return !own.empty() && own[0].estimated == Estimated::gain_and_frequency;
      });
  if (pumps == model.forces.end()) return model;
  const ParameterRef pumps_phase = *parameter_of(*pumps->term, ParameterKind::phase);
  Model out = model;
  std::array<Vector2, 2> harmonics{Vector2::Zero(), Vector2::Zero()};
  for (int k = 0; k < kPhases; ++k) {
    const double phase = 2 * kPi * k / kPhases;
    pumps_phase.in(out) = phase;
    const auto found = innovations(out, recording, predictor);
    double sum = 0;
    for (const auto& [key, z] : found) sum += z[0] * z[0] + z[1] * z[1] + z[2] * z[2];
    for (int h = 0; h < 2; ++h) {
      const Rot turn = rotation((h + 1) * phase);
      harmonics[static_cast<std::size_t>(h)] += sum * Vector2(turn.c, turn.s);
    }
  }
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kFinePhases; ++k) {
    const double phase = 2 * kPi * k / kFinePhases;
    const Rot one = rotation(phase), two = rotation(2 * phase);
    const double sum =
        harmonics[0].dot(Vector2(one.c, one.s)) + harmonics[1].dot(Vector2(two.c, two.s));
    if (sum < least) least = sum, best = phase;
  }
  pumps_phase.in(out) = best;
  return out;
}

}  // namespace

std::vector<std::vector<Recording>> repeat(const Stages& stages, const FlowMaps& maps,
                                           const Emulator& emulator,
                                           const std::vector<double>& values, int count,
                                           std::uint64_t seed) {
  std::vector<std::optional<std::vector<Recording>>> made(static_cast<std::size_t>(count));
  const CalibrationOptions& o = stages.setup().options;
  const auto simulate = [&](int i) {
    const auto field = perturbed_flow(maps, derived_seed(seed, 7), seed, i);
    made[static_cast<std::size_t>(i)] =
        emulator.record(values, derived_seed(seed, 16 + static_cast<std::uint64_t>(i)), field);
  };
  for_each_world(count, o.threads, simulate, o);
  std::vector<std::vector<Recording>> out;
  for (auto& one : made) {
    if (one) out.push_back(std::move(*one));
  }
  if (2 * out.size() < made.size()) throw InputError("most simulations at the estimate diverge");
  return out;
}

std::vector<GroupFit> group_fits(const CalibrationSetup& setup, const ScorePlan& plan,
                                 const std::vector<Recording>& recordings,
                                 const std::vector<std::vector<Recording>>& before,
                                 const std::vector<std::vector<Recording>>& after) {
  std::vector<SummaryEntry> entries = setup.entries();
  ScorePlan scatter_only = plan;
  scatter_only.effects.clear(), scatter_only.shapes.clear();
  for (const ScoreEntry& e : scatter_only.entries()) entries.push_back({e.group, e.name});
  const auto numbers = [&](const std::vector<Recording>& of) {
    std::vector<double> out = setup.numbers(of);
    const std::vector<double> more = score(scatter_only, of);
    out.insert(out.end(), more.begin(), more.end());
    return out;
  };
  std::vector<std::vector<double>> b, a;
  for (const auto& one : before) b.push_back(numbers(one));
  for (const auto& one : after) a.push_back(numbers(one));
  const std::vector<double> observed = numbers(recordings);
  const auto was = misfit_by_group(entries, observed, b, a);
  const auto is = misfit_by_group(entries, observed, a, a);
  // Values by chance: each experiment against the others.
  std::map<std::string, Moments> chance;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<std::vector<double>> others = a;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    for (const auto& [group, v] : misfit_by_group(entries, a[i], others, others)) {
      chance[group].add(v);
    }
  }
  std::vector<GroupFit> out;
  for (const auto& [group, value] : was) {
    const auto found = is.find(group);
    GroupFit fit{group, value, found == is.end() ? 0 : found->second};
    if (const Moments& of = chance[group]; of.count > 1) {
      fit.chance = of.mean(), fit.deviation = std::sqrt(of.variance());
    }
    out.push_back(fit);
  }
  return out;
}

void msd_share(const std::vector<Recording>& recordings,
               const std::vector<std::vector<Recording>>& before,
               const std::vector<std::vector<Recording>>& after, double longest, Diagnosis& out) {
  Eq9 rule;
  rule.seconds = longest;
  const std::vector<double> data = eq9_curve(recordings, rule);
  std::vector<std::vector<double>> b, a;
  for (const auto& one : before) b.push_back(eq9_curve(one, rule));
  for (const auto& one : after) a.push_back(eq9_curve(one, rule));
  std::vector<std::size_t> all_b(b.size()), all_a(a.size());
  for (std::size_t i = 0; i < b.size(); ++i) all_b[i] = i;
  for (std::size_t i = 0; i < a.size(); ++i) all_a[i] = i;
  const std::vector<double> middle = mean_curve(a, all_a);
  Moments floor;
  for (const auto& curve : a) floor.add(eq9(curve, middle));
  out.msd_before = eq9(data, mean_curve(b, all_b)), out.msd_after = eq9(data, middle);
  out.msd_floor = floor.mean();
  const auto share = [&](double was, double is) {
    const double excess = was - out.msd_floor;
    if (excess <= 0) return 0.0;
    return std::clamp(1 - std::max(0.0, is - out.msd_floor) / excess, -1.0, 1.0);
  };
  out.msd_removed = share(out.msd_before, out.msd_after);
  std::vector<double> shares;
  for (int k = 0; k < 200; ++k) {
    const auto pick = [&](std::size_t n, std::uint32_t salt) {
      std::vector<std::size_t> which(n);
      for (std::size_t i = 0; i < n; ++i) {
        const double u = uniform({1, Stream::calibrate, k, static_cast<std::uint32_t>(i), salt});
        which[i] = std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)));
      }
      return which;
    };
    shares.push_back(share(eq9(data, mean_curve(b, pick(b.size(), 11))),
                           eq9(data, mean_curve(a, pick(a.size(), 12)))));
  }
  std::sort(shares.begin(), shares.end());
  out.msd_low = shares[5], out.msd_high = shares[194];
}

StepGain step_gain(const Model& before, const Model& after, const PredictorOptions& predictor,
                   const std::vector<Recording>& recordings) {
  std::vector<Innovations> was, is;
  std::array<Moments, 3> width;
  for (const Recording& one : recordings) {
    was.push_back(innovations(before, one, predictor));
    is.push_back(innovations(in_phase(after, one, predictor), one, predictor));
    for (const auto& [key, z] : is.back()) {
      for (std::size_t k = 0; k < 3; ++k) width[k].add(z[k]);
    }
  }
  std::map<std::pair<std::size_t, int>, double> blocks;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (const auto& [key, z] : was[r]) {
      const auto other = is[r].find(key);
      if (other == is[r].end()) continue;
      double gain = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double v = std::max(width[k].variance(), 1e-9), now = other->second[k];
        gain += 0.5 * (z[k] * z[k] - now * now) / v;
      }
      blocks[{r, static_cast<int>(key.second / (kBlock * recordings[r].rate))}] += gain;
    }
  }
  Moments of;
  for (const auto& [block, gain] : blocks) of.add(gain);
  // The scatter of fewer than three blocks is unknown.
  const double width_of = of.count < 3 ? std::numeric_limits<double>::infinity()
                                       : normal_half_width() * std::sqrt(of.variance() * of.count);
  return {of.sum, of.sum - width_of, of.sum + width_of};
}

bool likelier_but_for_errors(const ScorePlan& plan, const Model& after,
                             const std::vector<Recording>& recordings) {
  double fallen = 0;
  ScorePlan before = plan;
  before.held = 0;  // with forces that are held, errors of parameters take less than they can
  for (const Recording& one : recordings) {
    ScorePlan with = before;
    with.model = in_phase(after, one, plan.predictor);
    fallen += deviance_of(before, {one}) - deviance_of(with, {one});
  }
  return fallen > 0;
}

}  // namespace lilytank
