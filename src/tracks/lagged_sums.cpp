#include "tracks/lagged_sums.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

namespace lilytank {
namespace {

using Complex = std::complex<double>;

// The least number of 2, 3 and 5 alone that is at least n: transforms of such lengths are fast.
std::size_t fast_length(std::size_t n) {
  for (std::size_t m = std::max<std::size_t>(n, 2);; ++m) {
    std::size_t rest = m;
    for (const std::size_t factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return m;
  }
}

Complex mean_of(const std::vector<Complex>& z) {
  Complex sum = 0;
  double n = 0;
  for (const Complex& v : z) {
    if (!std::isnan(v.real())) sum += v, ++n;
  }
  return n > 0 ? sum / n : 0;
}

}  // namespace

struct LaggedSummer::Memory {
  Eigen::FFT<double> fft;
  std::vector<Complex> z, w, Z, W;
};

LaggedSummer::LaggedSummer() : memory_(std::make_unique<Memory>()) {}
LaggedSummer::~LaggedSummer() = default;

LaggedSums LaggedSummer::operator()(const std::vector<Complex>& signal, std::size_t most,
                                    LaggedKind kind) {
  LaggedSums out{std::vector<double>(most + 1, 0.0), std::vector<double>(most + 1, 0.0)};
  if (signal.empty()) return out;
  Memory& m = *memory_;
  const std::size_t reach = std::min(most, signal.size() - 1);
  const std::size_t n = fast_length(signal.size() + reach);  // no lag wraps around into another
  // Squares do not change with the origin; near it they lose least to rounding.
  const Complex origin = kind == LaggedKind::square ? mean_of(signal) : 0;
  m.z.assign(n, 0), m.w.assign(n, 0);
  for (std::size_t f = 0; f < signal.size(); ++f) {
    if (std::isnan(signal[f].real())) continue;
    m.z[f] = signal[f] - origin;
    m.w[f] = {1, std::norm(m.z[f])};
  }
  m.fft.fwd(m.Z, m.z);
  m.fft.fwd(m.W, m.w);
  // Of a pair of real signals in one complex transform, the spectra of both: M of what was seen, S
  // of the squares. The sum of |z' - z|^2 is that of S' M + M' S - 2 z' z.
  m.z[0] = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t mirror = k == 0 ? 0 : n - k;
    const Complex M = 0.5 * (m.W[k] + std::conj(m.W[mirror]));
    const Complex S = Complex(0, -0.5) * (m.W[k] - std::conj(m.W[mirror]));
    const double product = 0.5 * (std::norm(m.Z[k]) + std::norm(m.Z[mirror]));
    const double square = 2 * (S * std::conj(M)).real() - 2 * product;
    m.z[k] = {std::norm(M), kind == LaggedKind::square ? square : product};
  }
  m.fft.inv(m.Z, m.z);
  for (std::size_t lag = 0; lag <= reach; ++lag) {
    out.count[lag] = std::round(m.Z[lag].real());
    if (out.count[lag] > 0) out.sum[lag] = m.Z[lag].imag();
    if (kind == LaggedKind::square) out.sum[lag] = std::max(0.0, out.sum[lag]);
  }
  if (kind == LaggedKind::square) out.sum[0] = 0;
  return out;
}

}  // namespace lilytank
