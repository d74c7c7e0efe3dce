#include "bodies/model.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/driver_history.hpp"

namespace lilytank::bodies {
namespace {

// A number of the model itself, fitted as its logarithm, with its bounds.
struct OwnNumber {
  double BodyModel::*of;
  double least, most;
  const char *name, *unit;
};

std::vector<OwnNumber> own_of(const BodyModel& m) {
  std::vector<OwnNumber> out;
  const bool axes = m.noise_y > 0;
  if (m.noise_fitted) {
    out.push_back({&BodyModel::noise, m.least_noise, 1e300,
                   axes ? "tracking noise of x" : "tracking noise", "m"});
  }
  if (m.noise_fitted && axes) {
    out.push_back({&BodyModel::noise_y, m.least_noise, 1e300, "tracking noise of y", "m"});
  }
  out.push_back({&BodyModel::push, m.least_push, m.most_push, "process noise", "m/s^2"});
  out.push_back({&BodyModel::memory, m.least_memory, m.most_memory,
                 "correlation time of process noise", "s"});
  if (m.bias > 0) {
    out.push_back({&BodyModel::bias, m.least_push, m.most_push, "bias of a run", "m/s^2"});
  }
  return out;
}

}  // namespace

void BodyModel::scale_noise(double by) {
  if (!noise_fitted) return;
  noise = std::max(by * noise, least_noise);
  if (noise_y > 0) noise_y = std::max(by * noise_y, least_noise);
}

std::vector<OwnValue> own_values(const BodyModel& model) {
  std::vector<OwnValue> out;
  for (const OwnNumber& own : own_of(model)) {
    out.push_back({own.name, own.unit, model.*own.of, own.least, own.most});
  }
  return out;
}

std::size_t own_numbers(const BodyModel& model) {
  return own_of(model).size();
}

std::vector<TermParameter> fitted_parameters(const BodyModel& model) {
  std::vector<TermParameter> out;
  for (std::size_t k = 0; k < model.terms.size(); ++k) {
    for (std::size_t i = 0; i < model.terms[k].value.size(); ++i) {
      if (model.terms[k].fitted[i]) out.push_back({k, i});
    }
  }
  return out;
}

std::optional<std::size_t> number_of(const BodyModel& model, const TermParameter& of) {
  const std::vector<TermParameter> all = fitted_parameters(model);
  const auto at = std::find(all.begin(), all.end(), of);
  if (at == all.end()) return std::nullopt;
  return own_numbers(model) + static_cast<std::size_t>(at - all.begin());
}

std::vector<double> packed(const BodyModel& m) {
  std::vector<double> out;
  for (const OwnNumber& own : own_of(m)) out.push_back(std::log(m.*own.of));
  for (const auto& [k, i] : fitted_parameters(m)) {
    const Term& t = m.terms[k];
    out.push_back(t.parameters[i].kind == Kind::positive ? std::log(t.value[i])
                                                         : t.value[i] / t.scale[i]);
  }
  return out;
}

BodyModel unpacked(const BodyModel& model, const std::vector<double>& numbers) {
  BodyModel m = model;
  auto number = numbers.begin();
  for (const OwnNumber& own : own_of(model)) {
    m.*own.of = std::clamp(std::exp(std::clamp(*number++, -100.0, 100.0)), own.least, own.most);
  }
  for (const auto& [k, i] : fitted_parameters(model)) {
    Term& t = m.terms[k];
    t.value[i] = t.parameters[i].kind == Kind::positive ? std::exp(std::clamp(*number, -60.0, 60.0))
                                                        : *number * t.scale[i];
    ++number;
  }
  return m;
}

Scene scene_of(const BodyRun& run, int dimensions, std::size_t sample, double time, const double* x,
               const double* v) {
  return {static_cast<int>(run.bodies.size()),
          dimensions,
          run.mass.data(),
          run.radius.data(),
          run.drivers_at(sample),
          time,
          x,
          v,
          &run};
}

void accelerate(const BodyModel& model, const Scene& s, double* out) {
  const int n = s.bodies * s.dimensions;
  std::fill(out, out + n, 0.0);
  for (const Term& t : model.terms) t.law->add(s, t.value, out);
  for (int i = 0; i < n; ++i) out[i] /= s.mass[i / s.dimensions];
}

namespace {

// Speed over a few samples, against noise; NaN where there are too few.
double speed_at(const BodyRun& run, std::size_t k, std::size_t body, int dimensions,
                double* velocity) {
  const std::size_t to = std::min(k + 3, run.samples() - 1),
                    nd = static_cast<std::size_t>(dimensions);
  const std::size_t row = run.bodies.size() * nd;
  double square = 0;
  for (std::size_t d = 0; d < nd; ++d) {
    const std::size_t i = body * nd + d;
    velocity[d] =
        (run.position[to * row + i] - run.position[k * row + i]) / (run.time[to] - run.time[k]);
    square += velocity[d] * velocity[d];
  }
  return std::sqrt(square);
}

// rms over the samples of the acceleration that a law with one amplitude at 1 gives.
double unit_size(const Term& term, std::size_t which, const std::vector<const BodyRun*>& runs,
                 int dimensions) {
  Term only = term;
  for (std::size_t i = 0; i < only.value.size(); ++i) {
    if (only.parameters[i].kind == Kind::amplitude) only.value[i] = i == which ? 1 : 0;
  }
  double sum = 0;
  std::size_t count = 0;
  std::vector<double> v, force;
  for (const BodyRun* run : runs) {
    const std::size_t row = run->coordinates();
    const std::size_t step = std::max<std::size_t>(1, run->samples() / 400);
    v.assign(row, 0), force.assign(row, 0);
    for (std::size_t k = 0; k + 4 < run->samples(); k += step) {
      for (std::size_t b = 0; b < run->bodies.size(); ++b) {
        speed_at(*run, k, b, dimensions, &v[b * static_cast<std::size_t>(dimensions)]);
      }
      const Scene s =
          scene_of(*run, dimensions, k, run->time[k], &run->position[k * row], v.data());
      std::fill(force.begin(), force.end(), 0.0);
      only.law->add(s, only.value, force.data());
      for (std::size_t i = 0; i < row; ++i) {
        const double a = force[i] / run->mass[i / static_cast<std::size_t>(dimensions)];
        if (std::isfinite(a)) sum += a * a, ++count;
      }
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace

Term term_of(const Law& law, const Typical& typical, const std::vector<double>& start,
             const std::vector<const BodyRun*>& runs, double push, double size) {
  Term t{&law, law.parameters(typical), start, {}, {}};
  t.scale.assign(start.size(), 1), t.fitted.assign(start.size(), true);
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Kind kind = t.parameters[i].kind;
    t.fitted[i] = kind != Kind::fixed && kind != Kind::driver;
    const double scale = t.parameters[i].scale;
    if (kind == Kind::place) {
      t.scale[i] = std::isnan(scale) ? std::max(1e-9, typical.high - typical.low) : scale;
    }
    if (kind != Kind::amplitude) continue;
    const double unit = unit_size(t, i, runs, typical.dimensions);
    t.scale[i] = unit > 0 ? push / unit : 1;
  }
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (t.parameters[i].kind == Kind::amplitude && std::isnan(start[i]))
      t.value[i] = size * t.scale[i];
  }
  return t;
}

namespace {

void take_gaps(const BodyRun& run, int dimensions, std::vector<double>& gaps) {
  const auto nd = static_cast<std::size_t>(dimensions);
  const std::size_t row = run.bodies.size() * nd;
  for (std::size_t k = 0; k < run.samples(); ++k) {
    for (std::size_t a = 0; a < run.bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < run.bodies.size(); ++b) {
        double square = 0;
        for (std::size_t d = 0; d < nd; ++d) {
          const double u = run.position[k * row + b * nd + d] - run.position[k * row + a * nd + d];
          square += u * u;
        }
        const double gap = std::sqrt(square) - run.radius[a] - run.radius[b];
        if (std::isfinite(gap)) gaps.push_back(gap);
      }
    }
  }
}

// Centre of the positions along each axis, and the largest distance from it.
void take_place(const std::vector<const BodyRun*>& runs, Typical& t) {
  const auto nd = static_cast<std::size_t>(t.dimensions);
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const BodyRun* run : runs) {
    for (std::size_t i = 0; i < run->position.size(); ++i) {
      const double x = run->position[i];
      if (std::isfinite(x))
        low[i % nd] = std::min(low[i % nd], x), high[i % nd] = std::max(high[i % nd], x);
    }
  }
  for (std::size_t d = 0; d < nd; ++d) t.centre[d] = (low[d] + high[d]) / 2;
  double farthest = 0;
  for (const BodyRun* run : runs) {
    for (std::size_t i = 0; i < run->position.size(); i += nd) {
      double square = 0;
      for (std::size_t d = 0; d < nd; ++d)
        square += std::pow(run->position[i + d] - t.centre[d], 2);
      if (std::isfinite(square)) farthest = std::max(farthest, square);
    }
  }
  t.farthest = farthest > 0 ? std::sqrt(farthest) : 1;
}

void take_motion(const BodyRun& run, Typical& t, std::vector<double>& speeds) {
  const auto nd = static_cast<std::size_t>(t.dimensions);
  double v[2];
  for (std::size_t k = 0; k + 4 < run.samples(); ++k) {
    for (std::size_t b = 0; b < run.bodies.size(); ++b) {
      const double speed = speed_at(run, k, b, t.dimensions, v);
      if (std::isfinite(speed)) speeds.push_back(speed);
      for (std::size_t d = 0; d < nd; ++d) {
        const double x = run.position[(k * run.bodies.size() + b) * nd + d];
        if (std::isfinite(x)) t.low = std::min(t.low, x), t.high = std::max(t.high, x);
      }
    }
  }
}

}  // namespace

Typical typical_of(const BodyExperiment& e, const std::vector<const BodyRun*>& runs) {
  Typical t;
  t.dimensions = e.dimensions, t.drivers = static_cast<int>(e.drivers.size());
  t.turning = e.turning, t.latitude = e.latitude;
  t.of_a_run = e.coefficients == Coefficients::each_run;
  std::copy_n(e.current, 2, t.current), std::copy_n(e.wind, 2, t.wind);
  t.low = 1e300, t.high = -1e300, t.duration = 0;
  std::vector<double> speeds, gaps;
  for (const BodyRun* run : runs) {
    t.bodies = std::max(t.bodies, static_cast<int>(run->bodies.size()));
    t.duration = std::max(t.duration, run->time.back() - run->time.front());
    take_motion(*run, t, speeds), take_gaps(*run, e.dimensions, gaps);
  }
  double sum = 0;
  for (const double v : speeds) sum += v * v;
  std::sort(speeds.begin(), speeds.end()), std::sort(gaps.begin(), gaps.end());
  t.speed =
      speeds.empty() ? 1 : std::max(1e-12, std::sqrt(sum / static_cast<double>(speeds.size())));
  t.fastest = speeds.empty() ? 1 : std::max(1e-12, speeds[speeds.size() * 99 / 100]);
  if (!gaps.empty()) t.nearest = gaps.front(), t.middle = gaps[gaps.size() / 2];
  take_place(runs, t);
  t.rate = strongest_rate(runs, e.dimensions);
  t.mass = runs.front()->mass.front();
  for (int i = 0; i < std::min(t.drivers, kSingleDrivers); ++i) {
    t.period[static_cast<std::size_t>(i)] = period_of(runs, i);
  }
  return t;
}

}  // namespace lilytank::bodies
