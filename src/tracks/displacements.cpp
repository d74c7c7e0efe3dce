// Squared displacements and autocorrelations of a recording's tracks.
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <unsupported/Eigen/FFT>

#include "lilytank/metrics.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

using Complex = std::complex<double>;
using Signal = std::vector<Complex>;

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

// What to sum of a signal z, over pairs of frames that both were seen.
enum class LaggedKind {
  product,  // Re(z(f + lag) conj z(f))
  square,   // |z(f + lag) - z(f)|^2
};

// Sums at lags 0 .. most, and the number of pairs in each.
struct LaggedSums {
  std::vector<double> sum, count;
};

// By fast Fourier transforms. Keeps tables and memory, so that many tracks of one length cost
// little.
class LaggedSummer {
 public:
  // The signal has NaN (real part) where nothing was seen. Lags of its length or more get 0.
  LaggedSums operator()(const std::vector<Complex>& signal, std::size_t most, LaggedKind kind) {
    LaggedSums out{std::vector<double>(most + 1, 0.0), std::vector<double>(most + 1, 0.0)};
    if (signal.empty()) return out;
    const std::size_t reach = std::min(most, signal.size() - 1);
    const std::size_t n = fast_length(signal.size() + reach);  // no lag wraps around into another
    // Squares do not change with the origin; near it they lose least to rounding.
    const Complex origin = kind == LaggedKind::square ? mean_of(signal) : 0;
    z_.assign(n, 0), w_.assign(n, 0);
    for (std::size_t f = 0; f < signal.size(); ++f) {
      if (std::isnan(signal[f].real())) continue;
      z_[f] = signal[f] - origin;
      w_[f] = {1, std::norm(z_[f])};
    }
    fft_.fwd(Z_, z_);
    fft_.fwd(W_, w_);
    // Of a pair of real signals in one complex transform, the spectra of both: M of what was seen,
    // S of the squares. The sum of |z' - z|^2 is that of S' M + M' S - 2 z' z.
    z_[0] = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t mirror = k == 0 ? 0 : n - k;
      const Complex M = 0.5 * (W_[k] + std::conj(W_[mirror]));
      const Complex S = Complex(0, -0.5) * (W_[k] - std::conj(W_[mirror]));
      const double product = 0.5 * (std::norm(Z_[k]) + std::norm(Z_[mirror]));
      const double square = 2 * (S * std::conj(M)).real() - 2 * product;
      z_[k] = {std::norm(M), kind == LaggedKind::square ? square : product};
    }
    fft_.inv(Z_, z_);
    for (std::size_t lag = 0; lag <= reach; ++lag) {
      out.count[lag] = std::round(Z_[lag].real());
      if (out.count[lag] > 0) out.sum[lag] = Z_[lag].imag();
      if (kind == LaggedKind::square) out.sum[lag] = std::max(0.0, out.sum[lag]);
    }
    if (kind == LaggedKind::square) out.sum[0] = 0;
    return out;
  }

 private:
  Eigen::FFT<double> fft_;
  std::vector<Complex> z_, w_, Z_, W_;
};

// A lag in frames, or three neighbouring ones with the weights of the parabola through them.
struct LagPlace {
  std::size_t frame[3] = {0, 0, 0};
  double share[3] = {1, 0, 0};
};

LagPlace place_of(double lag, double rate) {
  const double frames = lag * rate;
  const double nearest = std::round(frames);
  LagPlace place;
  place.frame[0] = place.frame[1] = place.frame[2] = static_cast<std::size_t>(nearest);
  if (std::fabs(frames - nearest) <= 1e-6 * std::max(1.0, frames)) return place;
  // Frame 0 is excluded: noise does not show there.
  const double middle = std::max(2.0, nearest), u = frames - middle;
  for (int i = 0; i < 3; ++i) place.frame[i] = static_cast<std::size_t>(middle) + i - 1;
  place.share[0] = u * (u - 1) / 2, place.share[1] = 1 - u * u, place.share[2] = u * (u + 1) / 2;
  return place;
}

// Collects tracks' sums at all lags into those of bodies and assemblies at the wanted ones.
class LagCollector {
 public:
  LagCollector(const std::vector<double>& lags, double rate) {
    for (const double lag : lags) {
      places_.push_back(place_of(lag, rate));
      most_ = std::max(most_, places_.back().frame[2]);
    }
    sums_.bins = static_cast<int>(lags.size());
    sums_.tracks.assign(lags.size(), 0);
  }
  std::size_t most() const { return most_; }
  void add(std::int64_t unit, const LaggedSums& track) {
    const auto [found, fresh] = unit_of_.try_emplace(unit, unit_of_.size());
    const std::size_t bins = places_.size(), at = found->second * bins;
    if (fresh) sums_.sum.resize(at + bins, 0.0), sums_.weight.resize(at + bins, 0.0);
    for (std::size_t i = 0; i < bins; ++i) {
      const LagPlace& p = places_[i];
      double mean = 0, count = 0;
      bool known = true;
      for (int k = 0; k < 3; ++k) {
        const double pairs = track.count[p.frame[k]];
        known = known && pairs > 0;
        mean += p.share[k] * track.sum[p.frame[k]] / std::max(1.0, pairs);
        count += p.share[k] * pairs;
      }
      if (!known || !(count > 0)) continue;
      sums_.sum[at + i] += mean * count, sums_.weight[at + i] += count;
      ++sums_.tracks[i];
    }
  }
  BodySums take() { return std::move(sums_); }

 private:
  std::vector<LagPlace> places_;
  std::size_t most_ = 0;
  std::map<std::int64_t, std::size_t> unit_of_;
  BodySums sums_;
};

// From the track's first frame only.
LaggedSums from_first(const Signal& z, std::size_t most) {
  LaggedSums out{std::vector<double>(most + 1, 0.0), std::vector<double>(most + 1, 0.0)};
  for (std::size_t f = 0; f < z.size() && f <= most; ++f) {
    if (std::isnan(z[f].real())) continue;
    out.sum[f] = std::norm(z[f] - z[0]);
    out.count[f] = 1;
  }
  return out;
}

template <class SignalOf>
BodySums squares(const Recording& recording, const std::vector<double>& lags, Origins origins,
                 SignalOf signal_of) {
  LagCollector collector(lags, recording.rate);
  LaggedSummer summer;
  Signal z;
  for (const Track& track : recording.tracks) {
    signal_of(track, z);
    if (z.empty()) continue;
    if (origins == Origins::all) {
      collector.add(track.unit(), summer(z, collector.most(), LaggedKind::square));
    } else if (track.first <= recording.rate) {
      collector.add(track.unit(), from_first(z, collector.most()));
    }
  }
  return collector.take();
}

template <class SignalOf>
BodySums products(const SmoothRecording& recording, const std::vector<double>& lags,
                  SignalOf signal_of) {
  LagCollector collector(lags, recording.rate);
  LaggedSummer summer;
  Signal z;
  for (const SmoothTrack& track : recording.tracks) {
    signal_of(track, z);
    if (z.empty()) continue;
    collector.add(track.unit(), summer(z, collector.most(), LaggedKind::product));
  }
  return collector.take();
}

}  // namespace

BodySums squared_displacements(const Recording& recording, const std::vector<double>& lags,
                               Origins origins) {
  return squares(recording, lags, origins, [](const Track& track, Signal& z) {
    z.resize(track.x.size());
    for (std::size_t f = 0; f < z.size(); ++f) z[f] = {track.x[f], track.y[f]};
  });
}

BodySums squared_turns(const Recording& recording, const std::vector<double>& lags,
                       Origins origins) {
  return squares(recording, lags, origins, [](const Track& track, Signal& z) {
    z.resize(track.theta.size());
    for (std::size_t f = 0; f < z.size(); ++f) z[f] = track.theta[f];
  });
}

BodySums velocity_products(const SmoothRecording& recording, const std::vector<double>& lags) {
  return products(recording, lags, [](const SmoothTrack& track, Signal& z) {
    z.resize(track.vx.size());
    for (std::size_t f = 0; f < z.size(); ++f) {
      z[f] = {track.seen[f] ? track.vx[f] : kUndefined, track.vy[f]};
    }
  });
}

BodySums spin_products(const SmoothRecording& recording, const std::vector<double>& lags) {
  return products(recording, lags, [](const SmoothTrack& track, Signal& z) {
    z.resize(track.spin.size());
    for (std::size_t f = 0; f < z.size(); ++f) z[f] = track.seen[f] ? track.spin[f] : kUndefined;
  });
}

}  // namespace lilytank
