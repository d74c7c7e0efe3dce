// Differences between runs: signs of faults of the measurement.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodies/compare.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank::bodies {

double Repeats::factor() const {
  return free > 0 ? std::max(1.0, std::sqrt(square / free)) : 1;
}

double Repeats::z() const {
  return free > 0 ? chi_squared_z(square, free) : 0;
}

namespace {

// The numbers of the last term's amplitudes; no other parameter remains fitted.
std::vector<std::size_t> hold_all_but_amplitudes(BodyModel& m) {
  std::vector<std::size_t> out;
  for (const TermParameter& of : fitted_parameters(m)) {
    Term& t = m.terms[of.term];
    t.fitted[of.parameter] =
        &t == &m.terms.back() && t.parameters[of.parameter].kind == Kind::amplitude;
    if (t.fitted[of.parameter]) out.push_back(own_numbers(m) + out.size());
  }
  return out;
}

}  // namespace

Repeats repeats_of(const BodyExperiment& e, const std::vector<Group>& groups,
                   const LawTrial& outcome) {
  Repeats out;
  double worst = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Group& g = groups[i];
    if (g.runs.size() < 2) continue;
    // Only the coefficients are refitted; noise is shared by all runs.
    BodyModel joint = outcome.fits[i].model;
    const std::vector<std::size_t> at = hold_all_but_amplitudes(joint);
    std::vector<double> weight(at.size(), 0), mean(at.size(), 0), square(at.size(), 0);
    for (const BodyRun* run : g.runs) {
      Group one = make_group(e, g.name, {run});
      one.typical = g.typical, one.penalty_at = packed(joint);
      one.penalty_at.resize(own_numbers(joint));
      const Fitted f = fit_group(one, joint, true);
      for (std::size_t k = 0; k < at.size(); ++k) {
        const double w = 1 / std::pow(std::max(f.deviation[at[k]], 1e-12), 2);
        const double value = f.numbers[at[k]];
        weight[k] += w, mean[k] += w * value, square[k] += w * value * value;
      }
    }
    double here = 0;
    for (std::size_t k = 0; k < at.size(); ++k) here += square[k] - mean[k] * mean[k] / weight[k];
    const int free = static_cast<int>(at.size() * (g.runs.size() - 1));
    out.square += here, out.free += free;
    if (free > 0 && here / free > worst) worst = here / free, out.worst = g.name;
  }
  return out;
}

void fit_run_bias(const std::vector<Group>& groups, LawTrial& outcome) {
  outcome.shaken.clear();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Group g = groups[i];
    BodyModel m = outcome.fits[i].model;
    const std::size_t before = own_numbers(m);
    m.bias = m.push;
    g.penalty_at.insert(g.penalty_at.begin() + static_cast<std::ptrdiff_t>(before),
                        std::log(m.push));
    Fitted f = fit_group(g, m, false, 6);
    leave_folds_out(g, f);
    outcome.shaken.insert(outcome.shaken.end(), f.held_out.begin(), f.held_out.end());
  }
}

double acceleration_difference(const std::vector<Group>& groups, const LawTrial& a,
                               const LawTrial& b) {
  double apart = 0, pushes = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const BodyModel &ma = a.fits[i].model, &mb = b.fits[i].model;
    const Typical& t = groups[i].typical;
    for (const BodyRun* run : groups[i].runs) {
      const Believed at = believed(ma, t, *run);
      const std::size_t row = run->coordinates();
      std::vector<double> fa(row), fb(row);
      for (std::size_t k = 0; k < run->samples(); ++k) {
        const Scene s =
            scene_of(*run, t.dimensions, k, run->time[k], &at.x[k * row], &at.v[k * row]);
        accelerate(ma, s, fa.data()), accelerate(mb, s, fb.data());
        for (std::size_t c = 0; c < row; ++c) {
          apart += (fa[c] - fb[c]) * (fa[c] - fb[c]), pushes += ma.push * ma.push;
        }
      }
    }
  }
  return std::sqrt(apart / std::max(pushes, 1e-300));
}

std::vector<double> far_errors(const std::vector<Group>& groups, const LawTrial& outcome) {
  std::vector<double> out;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    double sum = 0;
    int count = 0;
    for (const BodyRun* run : groups[i].runs) {
      const Believed b = believed(outcome.fits[i].model, groups[i].typical, *run);
      const std::size_t n = run->samples(), row = run->coordinates(),
                        far = std::max<std::size_t>(1, n / 4);
      for (std::size_t k = far; k + far < n; k += std::max<std::size_t>(1, far / 4)) {
        const auto there = predicted(outcome.fits[i].model, groups[i].typical, *run, b, k, k + far);
        for (std::size_t c = 0; c < row; ++c) {
          const double error = there[c] - run->position[(k + far) * row + c];
          if (std::isfinite(error)) sum += error * error, ++count;
        }
      }
    }
    out.push_back(count > 0 ? sum / count : 0);
  }
  return out;
}

std::vector<double> largest_far_errors(const std::vector<Group>& groups, const LawTrial& outcome) {
  constexpr std::uint32_t kSimulations = 9;
  std::vector<double> out;
  double largest = -1;
  for (std::uint32_t s = 0; s < kSimulations; ++s) {
    std::vector<Group> drawn = groups;
    std::vector<std::vector<BodyRun>> runs(groups.size());
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t r = 0; r < groups[i].runs.size(); ++r) {
        runs[i].push_back(simulated(outcome.fits[i].model, groups[i].typical, *groups[i].runs[r], s,
                                    static_cast<std::uint32_t>(100 * i + r)));
      }
      for (std::size_t r = 0; r < runs[i].size(); ++r) drawn[i].runs[r] = &runs[i][r];
    }
    std::vector<double> far = far_errors(drawn, outcome);
    const double sum = std::accumulate(far.begin(), far.end(), 0.0);
    if (sum > largest) largest = sum, out = std::move(far);
  }
  return out;
}

}  // namespace lilytank::bodies
