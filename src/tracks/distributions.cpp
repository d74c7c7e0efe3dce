#include "lilytank/distributions.hpp"
#include "statistics/undefined.hpp"

#include <algorithm>
#include <cmath>

#include "tracks/frames_view.hpp"

namespace lilytank {
namespace {

double value_of(const SmoothTrack& t, std::size_t f, Quantity quantity) {
  const double r = std::sqrt(t.x[f] * t.x[f] + t.y[f] * t.y[f]);
  switch (quantity) {
    case Quantity::speed:
      return std::sqrt(t.vx[f] * t.vx[f] + t.vy[f] * t.vy[f]);
    case Quantity::velocity_x:
      return t.vx[f];
    case Quantity::velocity_y:
      return t.vy[f];
    case Quantity::velocity_out:
      return r > 0 ? (t.x[f] * t.vx[f] + t.y[f] * t.vy[f]) / r : 0;
    case Quantity::velocity_around:
      return r > 0 ? (t.x[f] * t.vy[f] - t.y[f] * t.vx[f]) / r : 0;
    case Quantity::spin:
      break;
  }
  return t.spin[f];
}

// Calls act(unit, track, frame) for every sighting that has a velocity (for spins, a spin).
template <class Act>
void for_each_seen(const SmoothRecording& recording, Quantity quantity, const Act& act) {
  const UnitNumbers numbers(recording);
  for (const SmoothTrack& t : recording.tracks) {
    const std::size_t unit = numbers.of(t);
    const auto& values = quantity == Quantity::spin ? t.spin : t.vx;
    for (std::size_t f = 0; f < values.size(); ++f) {
      if (t.seen[f] && !std::isnan(values[f])) act(unit, t, f);
    }
  }
}

BodySums sums_for(const SmoothRecording& recording, int bins, Quantity quantity) {
  BodySums sums;
  std::size_t units = UnitNumbers(recording).count();
  std::int64_t tracks = 0;
  for (const SmoothTrack& t : recording.tracks) {
    tracks += quantity == Quantity::spin ? !t.spin.empty() : !t.vx.empty();
  }
  if (tracks == 0) units = 0;
  sums.bins = bins;
  sums.sum.assign(units * static_cast<std::size_t>(bins), 0.0);
  sums.weight = sums.sum;
  sums.tracks.assign(bins, tracks);
  return sums;
}

// What one body or assembly did in one cell.
struct Passage {
  std::size_t cell = 0;
  double n = 0, vx = 0, vy = 0;
};

void add_passages(const SmoothRecording& recording, const Bins& bins,
                  std::vector<Passage>& passages) {
  const auto count = static_cast<std::size_t>(bins.count) * static_cast<std::size_t>(bins.count);
  std::vector<Passage> own(UnitNumbers(recording).count() * count);
  for_each_seen(recording, Quantity::speed,
                [&](std::size_t unit, const SmoothTrack& t, std::size_t f) {
                  const int ix = bins.of(t.x[f]), iy = bins.of(t.y[f]);
                  if (ix < 0 || iy < 0) return;
                  const auto cell = static_cast<std::size_t>(iy * bins.count + ix);
                  Passage& p = own[unit * count + cell];
                  p.cell = cell;
                  ++p.n, p.vx += t.vx[f], p.vy += t.vy[f];
                });
  for (const Passage& p : own) {
    if (p.n > 0) passages.push_back(p);
  }
}

}  // namespace

int Bins::of(double value) const {
  if (!(value >= low) || value > high) return -1;
  return std::min(count - 1, static_cast<int>((value - low) / width()));
}

BodySums distribution(const SmoothRecording& recording, Quantity quantity, const Bins& bins) {
  BodySums sums = sums_for(recording, bins.count, quantity);
  std::vector<double> samples(UnitNumbers(recording).count(), 0.0);
  for_each_seen(recording, quantity, [&](std::size_t unit, const SmoothTrack& t, std::size_t f) {
    ++samples[unit];
    const int bin = bins.of(value_of(t, f, quantity));
    if (bin >= 0) sums.sum[unit * bins.count + bin] += 1 / bins.width();
  });
  for (std::size_t i = 0; i < sums.weight.size(); ++i) sums.weight[i] = samples[i / bins.count];
  return sums;
}

double quantile_of_size(const SmoothRecording& recording, Quantity quantity, double share) {
  std::vector<double> sizes;
  for_each_seen(recording, quantity, [&](std::size_t, const SmoothTrack& t, std::size_t f) {
    sizes.push_back(std::fabs(value_of(t, f, quantity)));
  });
  if (sizes.empty()) return 0;
  const auto at =
      sizes.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

BodySums mean_power(const SmoothRecording& recording, Quantity quantity, int power) {
  BodySums sums = sums_for(recording, 1, quantity);
  for_each_seen(recording, quantity, [&](std::size_t unit, const SmoothTrack& t, std::size_t f) {
    const double v = value_of(t, f, quantity);
    sums.sum[unit] += power == 2 ? v * v : v;
    ++sums.weight[unit];
  });
  return sums;
}

BodySums circulation(const SmoothRecording& recording) {
  BodySums sums = sums_for(recording, 1, Quantity::speed);
  for_each_seen(recording, Quantity::speed,
                [&](std::size_t unit, const SmoothTrack& t, std::size_t f) {
                  sums.sum[unit] += t.x[f] * t.vy[f] - t.y[f] * t.vx[f];
                  sums.weight[unit] += t.x[f] * t.x[f] + t.y[f] * t.y[f];
                });
  return sums;
}

BodySums radial_density(const SmoothRecording& recording, double tank_radius, const Bins& bins) {
  BodySums sums = sums_for(recording, bins.count, Quantity::speed);
  std::vector<double> samples(UnitNumbers(recording).count(), 0.0);
  const auto edge = [&](int i) { return bins.low + i * bins.width(); };
  std::vector<double> share(bins.count);  // of the tank's area
  for (int i = 0; i < bins.count; ++i) {
    share[i] = (edge(i + 1) * edge(i + 1) - edge(i) * edge(i)) / (tank_radius * tank_radius);
  }
  for_each_seen(recording, Quantity::speed,
                [&](std::size_t unit, const SmoothTrack& t, std::size_t f) {
                  ++samples[unit];
                  const int bin = bins.of(std::sqrt(t.x[f] * t.x[f] + t.y[f] * t.y[f]));
                  if (bin < 0) return;
                  sums.sum[unit * bins.count + bin] += 1 / share[bin];
                });
  for (std::size_t i = 0; i < sums.weight.size(); ++i) sums.weight[i] = samples[i / bins.count];
  return sums;
}

VelocityMap velocity_map(const std::vector<SmoothRecording>& recordings, int cells, double extent) {
  const auto count = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
  std::vector<Passage> passages, totals(count);
  for (const SmoothRecording& r : recordings) add_passages(r, {-extent, extent, cells}, passages);
  for (const Passage& p : passages) {
    Passage& total = totals[p.cell];
    total.n += p.n, total.vx += p.vx, total.vy += p.vy;
  }
  VelocityMap map;
  map.cells = cells, map.extent = extent;
  map.bodies.assign(count, 0), map.se_x.assign(count, 0), map.se_y.assign(count, 0);
  for (const Passage& total : totals) {
    map.samples.push_back(std::llround(total.n));
    map.vx.push_back(total.n > 0 ? total.vx / total.n : kUndefined);
    map.vy.push_back(total.n > 0 ? total.vy / total.n : kUndefined);
  }
  // The error of a ratio of sums over independent units, to first order.
  for (const Passage& p : passages) {
    ++map.bodies[p.cell];
    const double dx = p.vx - p.n * map.vx[p.cell], dy = p.vy - p.n * map.vy[p.cell];
    map.se_x[p.cell] += dx * dx, map.se_y[p.cell] += dy * dy;
  }
  for (std::size_t c = 0; c < count; ++c) {
    const double m = map.bodies[c], n = totals[c].n;
    const double k = m > 1 ? m / (m - 1) / (n * n) : kUndefined;
    map.se_x[c] = std::sqrt(k * map.se_x[c]), map.se_y[c] = std::sqrt(k * map.se_y[c]);
  }
  return map;
}

}  // namespace lilytank
