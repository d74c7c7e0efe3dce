// Samples of the water's velocity along tracks, sorted into cells, and which of them are
// independent of each other.
#pragma once
#include <cstdint>
#include <vector>

namespace lilytank {

/// Samples of all tracks, track by track, frame by frame.
struct FlowSamples {
  std::vector<int> track, frame, cell;
  std::vector<float> x, y;  ///< m/s
  int tracks = 0;
  double rate = 0;  ///< frames per second
  void add(int number, int at, int where, double vx, double vy) {
    track.push_back(number), frame.push_back(at), cell.push_back(where);
    x.push_back(static_cast<float>(vx)), y.push_back(static_cast<float>(vy));
  }
};

/// A cell's samples in order, and to which stay each belongs. Samples of one track less than the
/// thinning time apart belong to one stay.
struct CellSamples {
  std::vector<std::uint32_t> sample;
  std::vector<int> stay;  ///< 0, 1, ..., rising
  int stays = 0;
};

/// Sorts samples into cells. `thinning` (s) becomes the lag at which the autocorrelation of the
/// samples' differences from their cells' means, along tracks, first falls below 0.1; at most 3 s.
std::vector<CellSamples> by_cell(const FlowSamples& samples, int cells, double& thinning);

}  // namespace lilytank
