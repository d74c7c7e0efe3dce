// Eq. 3: v_flow = v + m a / sqrt(1/2 rho A C m |a|), frame by frame, and its statistics in cells.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "flow/grid.hpp"
#include "flow/thinning.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

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
