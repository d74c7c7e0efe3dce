// A random flow as a sum of waves, at sixteen bodies at once.
#pragma once
#include "math/bulk_random.hpp"

namespace lilytank {

constexpr int kWaves = 32;

/// Waves u = a cos(2 pi (k . x + offset)).
struct EddyWaves {
  alignas(64) float kx[kWaves], ky[kWaves];  ///< turns/m
  alignas(64) float offset[kWaves];          ///< turns, within half of one
  alignas(64) float ax[kWaves], ay[kWaves];  ///< velocity, 1
  /// 1/m, of the differences across a side: a_y sin(2 pi k_x h) / h and a_x sin(2 pi k_y h) / h.
  alignas(64) float bx[kWaves], by[kWaves];
};

/// Sets bx and by from the others; `half_side`: h, m.
void find_differences(float half_side, EddyWaves& waves);

/// Places of bodies (m), and the flow there: velocity, and how it differs across a module, u_y
/// along x and u_x along y (1/m).
struct EddyBlock {
  alignas(64) float x[kBulkBodies], y[kBulkBodies];
  alignas(64) float ux[kBulkBodies], uy[kBulkBodies], y_by_x[kBulkBodies], x_by_y[kBulkBodies];
};

/// Fills in the flow at a block's places. Errors are under 3e-6 of the amplitudes' sum, and 2e-6
/// more for each turn of phase k . x (single precision).
void sum_eddies(const EddyWaves& waves, EddyBlock& block);

}  // namespace lilytank
