#include "tracks/source_summary.hpp"
#include "statistics/undefined.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

constexpr Estimate kUnknown{kUndefined, kUndefined, kUndefined};
using Values = std::vector<double>;

// The first maximum that the curve then falls from by a twentieth; its index, or -1.
int first_maximum(const Values& curve) {
  std::size_t peak = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (std::isnan(curve[i])) continue;
    if (!(curve[i] <= curve[peak])) peak = i;
    if (peak > 0 && curve[i] < 0.95 * curve[peak]) return static_cast<int>(peak);
  }
  return -1;
}

// Its place and height between bins: those of the parabola through three.
struct Peak {
  double lag = kUndefined, height = kUndefined;
};
Peak first_peak(const Values& lags, const Values& curve) {
  const int at = first_maximum(curve);
  if (at < 0) return {};
  const double h = lags[at] - lags[at - 1], bend = curve[at - 1] - 2 * curve[at] + curve[at + 1];
  const bool even = std::fabs(lags[at + 1] - lags[at] - h) < 1e-6 * h;
  if (!even || !(bend < 0)) return {lags[at], curve[at]};
  const double slope = (curve[at + 1] - curve[at - 1]) / 2, shift = -slope / bend;
  return {lags[at] + shift * h, curve[at] + 0.5 * slope * shift};
}

// Mean over the second half of the lags.
double plateau(const Values& lags, const Values& curve) {
  double sum = 0, width = 0;
  for (std::size_t i = 1; i < lags.size(); ++i) {
    if (lags[i - 1] < 0.5 * lags.back() || std::isnan(curve[i]) || std::isnan(curve[i - 1])) {
      continue;
    }
    const double w = lags[i] - lags[i - 1];
    sum += w * 0.5 * (curve[i] + curve[i - 1]), width += w;
  }
  return width > 0 ? sum / width : kUndefined;
}

int distinct(std::vector<std::int64_t>& ids) {
  std::sort(ids.begin(), ids.end());
  return static_cast<int>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

void add_counts(const AnalysisSource& source, SourceSummary& s) {
  s.name = source.name, s.panel = source.panel, s.key = source.key, s.exact = source.exact;
  s.recordings = static_cast<int>(source.recordings.size());
  std::int64_t frames = 0;
  for (const Recording& recording : source.recordings) {
    s.body = recording.body, s.rate = recording.rate;
    std::vector<std::int64_t> ids, units;
    int last = 0;
    for (const Track& t : recording.tracks) {
      ids.push_back(t.id), units.push_back(t.unit());
      last = std::max(last, t.last());
      frames += static_cast<std::int64_t>(t.x.size());
      for (const double x : t.x) s.sightings += !std::isnan(x);
    }
    s.bodies += distinct(ids), s.units += distinct(units);
    s.tracks += static_cast<int>(recording.tracks.size());
    s.duration = std::max(s.duration, last / recording.rate);
  }
  s.missing = frames > 0 ? 1 - static_cast<double>(s.sightings) / static_cast<double>(frames) : 0;
}

void add_displacements(const BodySums& msd, const BodySums& turns, const Values& lags,
                       const AnalysisOptions& options, SourceSummary& s) {
  const Bootstrap& b = options.bootstrap;
  s.first_maximum_lag = ratio_functional(
      msd, [&](const Values& c) { return first_peak(lags, c).lag; }, b);
  s.first_maximum = ratio_functional(
      msd, [&](const Values& c) { return first_peak(lags, c).height; }, b);
  s.plateau = ratio_functional(
      msd, [&](const Values& c) { return plateau(lags, c); }, b);
  s.diffusion = diffusion(msd, lags, 2, options.diffusion_from, options.diffusion_to, b);
  s.rotation = {kUnknown, 0, 0};
  if (turns.bodies() > 0) {
    s.rotation = diffusion(turns, lags, 1, options.diffusion_from, options.diffusion_to, b);
  }
}

Estimate mean(const SmoothSource& source, Quantity quantity, int power, const Bootstrap& b) {
  const BodySums sums = together(
      source.recordings, [&](const SmoothRecording& r) { return mean_power(r, quantity, power); });
  if (sums.bodies() == 0) return kUnknown;
  return ratio_functional(
      sums, [&](const Values& v) { return power == 2 ? std::sqrt(v[0]) : v[0]; }, b);
}

void add_velocities(const SmoothSource& source, const Values& lags, const Bootstrap& b,
                    SourceSummary& s) {
  s.speed = mean(source, Quantity::speed, 1, b);
  s.rms_speed = mean(source, Quantity::speed, 2, b);
  s.rms_spin = mean(source, Quantity::spin, 2, b);
  s.circulation = ratio_functional(
      together(source.recordings, [](const SmoothRecording& r) { return circulation(r); }),
      [](const Values& v) { return v[0]; }, b);
  const Values acf =
      ratio_values(together(source.recordings,
                            [&](const SmoothRecording& r) { return velocity_products(r, lags); }),
                   true);
  std::size_t last = 0;  // of holes between sightings there is no product: the last one counts
  for (std::size_t i = 1; i < acf.size(); ++i) {
    if (std::isnan(acf[i])) continue;
    if (!(acf[i] > 0)) break;
    s.velocity_memory += 0.5 * (acf[i] + acf[last]) * (lags[i] - lags[last]);
    last = i;
  }
  double seen = 0;  // s
  for (const SmoothRecording& r : source.recordings) {
    for (const SmoothTrack& t : r.tracks) {
      seen += static_cast<double>(std::count(t.seen.begin(), t.seen.end(), 1)) / r.rate;
    }
  }
  s.independent_samples = s.velocity_memory > 0 ? seen / (2 * s.velocity_memory) : kUndefined;
}

void add_contacts(const SmoothSource& source, const Bootstrap& b, SourceSummary& s) {
  s.contact_rate = s.contact_share = s.contacts.mean = kUnknown;
  if (source.contacts.empty()) return;
  std::vector<Duration> durations;
  double longest = 0;
  for (const Contacts& c : source.contacts) {
    durations.insert(durations.end(), c.durations.begin(), c.durations.end());
  }
  for (const Duration& d : durations) longest = std::max(longest, d.time);
  const auto only = [](const Values& v) { return v[0]; };
  s.contact_rate = ratio_functional(
      together(source.contacts, [](const Contacts& c) { return c.begun; }), only, b);
  s.contact_share = ratio_functional(
      together(source.contacts, [](const Contacts& c) { return c.touching; }), only, b);
  s.contacts.contacts = static_cast<std::int64_t>(durations.size());
  if (s.contact_rate.value == 0) {  // resamples of nothing are nothing
    double seconds = 0;
    for (const Contacts& c : source.contacts) {
      for (const double weight : c.begun.weight) seconds += weight;
    }
    s.contact_rate = poisson_rate(0, seconds, b.level);
  }
  if (s.contact_share.value == 0) s.contact_share = {0, -HUGE_VAL, HUGE_VAL};
  if (durations.empty()) return;
  s.contacts.survival = kaplan_meier(durations, b.level);
  s.contacts.mean = restricted_mean(s.contacts.survival, longest, b.level);
}

}  // namespace

SourceSummary summarise_source(const SmoothSource& source, const BodySums& msd,
                               const BodySums& turns, const Values& lags,
                               const AnalysisOptions& options) {
  SourceSummary s;
  add_counts(*source.source, s);
  add_displacements(msd, turns, lags, options, s);
  s.speed = s.rms_speed = s.rms_spin = s.circulation = s.nearest = kUnknown;
  add_contacts(source, options.bootstrap, s);
  if (source.recordings.empty()) return s;
  for (const SmoothRecording& r : source.recordings) {
    s.motion.push_back(r.position), s.turning.push_back(r.heading);
  }
  s.transfer = transfer_function(options.smoothing, s.motion[0], source.recordings[0].rate);
  Values from_zero = lags;
  from_zero.insert(from_zero.begin(), 0.0);
  add_velocities(source, from_zero, options.bootstrap, s);
  const BodySums nearest =
      together(source.recordings, [](const SmoothRecording& r) { return nearest_distance(r); });
  if (nearest.bodies() > 0) {
    s.nearest = ratio_functional(
        nearest, [](const Values& v) { return v[0]; }, options.bootstrap);
  }
  return s;
}

std::string shared_key(const Analysis& analysis) {
  const std::string& key = analysis.sources[0].key;
  const auto same = [&](const SourceSummary& s) { return s.key == key; };
  return std::all_of(analysis.sources.begin(), analysis.sources.end(), same) ? key : "";
}

bool frames_too_far_apart(const SourceSummary& source) {
  const bool moves = !source.motion.empty() && source.rms_speed.value > 0;
  return moves && source.velocity_memory * source.rate < 4;
}

SourceComparison compare_sources(const Analysis& analysis) {
  SourceComparison c;
  if (const AnalysisCurves* msd = analysis.find("msd_all"); msd && msd->sources.size() == 2) {
    double sum = 0, level = 0, n = 0, outside = 0;
    for (std::size_t i = 0; i < msd->x.size(); ++i) {
      const double d = msd->difference.value[i];
      if (std::isnan(d)) continue;
      // By lag, not by bin: short lags are closer together.
      const double w = i > 0 ? msd->x[i] - msd->x[i - 1] : msd->x[i];
      sum += w * std::fabs(d), level += w * msd->sources[0].curve.value[i], n += w;
      outside += w * (msd->difference.low[i] > 0 || msd->difference.high[i] < 0);
    }
    c.msd_difference = sum / n, c.msd_relative = sum / level, c.msd_outside = outside / n;
  }
  if (analysis.maps.size() < 2) return c;
  const VelocityMap &a = analysis.maps[0], &b = analysis.maps[1];
  Values ax, ay, bx, by;
  double square = 0, expected = 0;
  for (std::size_t i = 0; i < a.vx.size(); ++i) {
    if (std::min(a.bodies[i], b.bodies[i]) < 2) continue;
    ax.push_back(a.vx[i]), ay.push_back(a.vy[i]), bx.push_back(b.vx[i]), by.push_back(b.vy[i]);
    const double dx = b.vx[i] - a.vx[i], dy = b.vy[i] - a.vy[i];
    square += 0.5 * (dx * dx + dy * dy);
    expected += 0.5 * (a.se_x[i] * a.se_x[i] + b.se_x[i] * b.se_x[i] + a.se_y[i] * a.se_y[i] +
                       b.se_y[i] * b.se_y[i]);
  }
  c.map_cells = static_cast<int>(ax.size());
  const auto correlation = [](const Values& p, const Values& q) {
    double sp = 0, sq = 0, spp = 0, sqq = 0, spq = 0;
    const auto n = static_cast<double>(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
      sp += p[i], sq += q[i], spp += p[i] * p[i], sqq += q[i] * q[i], spq += p[i] * q[i];
    }
    return (n * spq - sp * sq) / std::sqrt((n * spp - sp * sp) * (n * sqq - sq * sq));
  };
  c.map_correlation_x = correlation(ax, bx), c.map_correlation_y = correlation(ay, by);
  c.map_difference = std::sqrt(square / c.map_cells);
  c.map_expected = std::sqrt(expected / c.map_cells);
  return c;
}

}  // namespace lilytank
