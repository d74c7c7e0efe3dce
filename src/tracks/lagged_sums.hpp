// Sums over all pairs of frames at every lag, by fast Fourier transforms.
#pragma once
#include <complex>
#include <memory>
#include <vector>

namespace lilytank {

/// What to sum of a signal z, over pairs of frames that both were seen.
enum class LaggedKind {
  product,  ///< Re(z(f + lag) conj z(f))
  square,   ///< |z(f + lag) - z(f)|^2
};

/// Sums at lags 0 .. most, and the number of pairs in each.
struct LaggedSums {
  std::vector<double> sum, count;
};

/// Keeps its tables and memory, so that many tracks of one length cost little.
class LaggedSummer {
 public:
  LaggedSummer();
  ~LaggedSummer();
  /// z has NaN (real part) where nothing was seen. `most` < z.size() is enough; longer lags get 0.
  LaggedSums operator()(const std::vector<std::complex<double>>& z, std::size_t most,
                        LaggedKind kind);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace lilytank
