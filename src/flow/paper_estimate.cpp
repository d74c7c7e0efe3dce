// Eq. 3: v_flow = v + m a / sqrt(1/2 rho A C m |a|), frame by frame, and its statistics in cells.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "flow/grid.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Samples of all tracks, track by track, frame by frame.
struct FlowSamples {
  std::vector<int> track, frame, cell;
  std::vector<float> x, y;  // m/s
  int tracks = 0;
  double rate = 0;  // frames per second
  void add(int number, int at, int where, double vx, double vy) {
    track.push_back(number), frame.push_back(at), cell.push_back(where);
    x.push_back(static_cast<float>(vx)), y.push_back(static_cast<float>(vy));
  }
};

// A cell's samples in order, and to which stay each belongs. Samples of one track less than the
// thinning time apart belong to one stay.
struct CellSamples {
  std::vector<std::uint32_t> sample;
  std::vector<int> stay;  // 0, 1, ..., rising
  int stays = 0;
};

constexpr double kLongestInterval = 3;  // s
constexpr double kUnrelated = 0.1;      // autocorrelation

// The samples' differences from their cells' means.
void centre(const FlowSamples& s, const std::vector<CellSamples>& cells, std::vector<float>& x,
            std::vector<float>& y) {
  x = s.x, y = s.y;
  for (const CellSamples& cell : cells) {
    double mx = 0, my = 0;
    for (const std::uint32_t i : cell.sample)
      mx += static_cast<double>(s.x[i]), my += static_cast<double>(s.y[i]);
    const double n = static_cast<double>(cell.sample.size());
    for (const std::uint32_t i : cell.sample) {
      x[i] -= static_cast<float>(mx / n);
      y[i] -= static_cast<float>(my / n);
    }
  }
}

double thinning_time(const FlowSamples& s, const std::vector<CellSamples>& cells) {
  std::vector<float> x, y;
  centre(s, cells, x, y);
  const auto longest = static_cast<std::size_t>(kLongestInterval * s.rate);
  const auto product = [&](std::size_t lag) {
    double sum = 0;
    std::int64_t pairs = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) {
      const std::size_t j = i + lag;
      // Frames between may be missing: only pairs that are exactly `lag` apart count.
      if (s.track[i] != s.track[j] || s.frame[j] - s.frame[i] != static_cast<int>(lag)) continue;
      sum += static_cast<double>(x[i] * x[j] + y[i] * y[j]);
      ++pairs;
    }
    return pairs > 0 ? sum / static_cast<double>(pairs) : 0;
  };
  const double variance = product(0);
  for (std::size_t lag = 1; lag < longest; ++lag) {
    if (product(lag) < kUnrelated * variance) return static_cast<double>(lag) / s.rate;
  }
  return kLongestInterval;
}

void find_stays(const FlowSamples& s, double thinning, CellSamples& cell) {
  const double apart = thinning * s.rate;
  for (std::size_t k = 0; k < cell.sample.size(); ++k) {
    const std::uint32_t i = cell.sample[k];
    bool same = false;
    if (k > 0) {
      const std::uint32_t before = cell.sample[k - 1];
      same = s.track[before] == s.track[i] && s.frame[i] - s.frame[before] < apart;
    }
    if (!same) ++cell.stays;
    cell.stay.push_back(cell.stays - 1);
  }
}

// Sorts samples into cells. `thinning` (s) becomes the lag at which the autocorrelation of the
// samples' differences from their cells' means, along tracks, first falls below 0.1; at most 3 s.
std::vector<CellSamples> by_cell(const FlowSamples& samples, int cells, double& thinning) {
  std::vector<CellSamples> out(static_cast<std::size_t>(cells));
  for (std::size_t i = 0; i < samples.cell.size(); ++i) {
    out[samples.cell[i]].sample.push_back(static_cast<std::uint32_t>(i));
  }
  thinning = thinning_time(samples, out);
  for (CellSamples& cell : out) find_stays(samples, thinning, cell);
  return out;
}

// The water's velocity in every frame of a track in which it can be computed.
void add_track(const SmoothTrack& track, double drag_rate, const FlowGrid& grid, int number,
               FlowSamples& out) {
  for (std::size_t f = 0; f < track.x.size(); ++f) {
    if (!track.seen[f] || std::isnan(track.vx[f]) || std::isnan(track.ax[f])) continue;
    const int cell = grid.cell_at(track.x[f], track.y[f]);
    if (cell < 0) continue;
    const double ax = track.ax[f], ay = track.ay[f], a = std::sqrt(ax * ax + ay * ay);
    const double k = a > 0 ? 1 / std::sqrt(drag_rate * a) : 0;
    out.add(number, track.first + static_cast<int>(f), cell, track.vx[f] + k * ax,
            track.vy[f] + k * ay);
  }
}

// Sums over one cell whose samples come in stays; stays are independent, frames of one are not.
struct Moments {
  double mean = 0, deviation = 0, mean_error = 0, deviation_error = 0;
};

Moments moments(const std::vector<double>& value, const std::vector<int>& stay, int stays) {
  Moments m;
  const double n = static_cast<double>(value.size());
  for (const double v : value) m.mean += v / n;
  double squares = 0;
  for (const double v : value) squares += (v - m.mean) * (v - m.mean);
  const double variance = n > 1 ? squares / (n - 1) : 0;
  m.deviation = std::sqrt(variance);
  m.mean_error = m.deviation_error = std::numeric_limits<double>::quiet_NaN();
  if (stays < 2 || !(variance > 0)) return m;
  std::vector<double> first(static_cast<std::size_t>(stays)), second(first.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double d = value[i] - m.mean;
    first[stay[i]] += d;
    second[stay[i]] += d * d - variance;
  }
  double mean_sum = 0, variance_sum = 0;
  for (std::size_t s = 0; s < first.size(); ++s) {
    mean_sum += first[s] * first[s];
    variance_sum += second[s] * second[s];
  }
  const double g = stays, k = g / (g - 1);
  m.mean_error = std::sqrt(k * mean_sum) / n;
  m.deviation_error = std::sqrt(k * variance_sum) / n / (2 * m.deviation);
  return m;
}

// One sample of each stay, that of its middle frame.
std::vector<double> thinned(const std::vector<double>& value, const std::vector<int>& stay) {
  std::vector<double> out;
  for (std::size_t i = 0; i < value.size();) {
    std::size_t end = i;
    while (end < value.size() && stay[end] == stay[i]) ++end;
    out.push_back(value[(i + end) / 2]);
    i = end;
  }
  return out;
}

void fill_cell(const FlowSamples& all, const CellSamples& at, const FlowOptions& options,
               FlowCell& cell) {
  std::vector<double> x, y;
  for (const std::uint32_t i : at.sample) {
    x.push_back(all.x[i]);
    y.push_back(all.y[i]);
  }
  cell.samples = static_cast<int>(x.size());
  cell.stays = at.stays;
  cell.measured = cell.samples >= options.least_samples;
  const Moments mx = moments(x, at.stay, at.stays), my = moments(y, at.stay, at.stays);
  cell.error = {mx.mean_error, my.mean_error, mx.deviation_error, my.deviation_error};
  if (!cell.measured) return;
  cell.flow = {mx.mean, my.mean, mx.deviation, my.deviation};
  cell.all_x = test_normality(x), cell.all_y = test_normality(y);
  cell.normal_x = test_normality(thinned(x, at.stay));
  cell.normal_y = test_normality(thinned(y, at.stay));
}

std::string filter_text(const SmoothingOptions& smoothing, double rate) {
  const TransferFunction t = transfer_function(smoothing, {}, rate);
  const auto hertz = [](double f) { return shortest(std::round(f * 100) / 100) + " Hz"; };
  return "polynomials of degree " + std::to_string(smoothing.degree) + " over " +
         shortest(smoothing.window) + " s: velocities to " + hertz(t.velocity_cutoff) +
         ", accelerations to " + hertz(t.acceleration_cutoff) + " (-3 dB)";
}

}  // namespace

FlowEstimate estimate_paper(std::span<const Recording> recordings, const BallPhysics& ball,
                            const FlowOptions& options) {
  FlowEstimate out = empty_estimate(recordings, ball, options, "paper");
  const FlowGrid grid{out.cells, out.extent};
  FlowSamples all;
  for (const Recording& recording : recordings) {
    if (recording.body != BodyKind::ball) continue;
    const SmoothRecording smoothed = smooth(recording, options.smoothing);
    for (const SmoothTrack& track : smoothed.tracks) {
      add_track(track, ball.drag_rate(), grid, all.tracks++, all);
    }
    all.rate = std::max(all.rate, recording.rate);
    out.filter = options.smoothing.method == SmoothingMethod::polynomial
                     ? filter_text(options.smoothing, recording.rate)
                     : "Kalman smoother with the recording's own measurement and process noise";
  }
  out.samples = static_cast<std::int64_t>(all.x.size());
  const std::vector<CellSamples> cells = by_cell(all, grid.size(), out.thinning);
  for (std::size_t i = 0; i < cells.size(); ++i) fill_cell(all, cells[i], options, out.cell[i]);
  fill_cells(out);
  return out;
}

}  // namespace lilytank
