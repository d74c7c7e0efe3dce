// Squared displacements and autocorrelations of a recording's tracks.
#include <algorithm>
#include <cmath>
#include <map>

#include "lilytank/metrics.hpp"
#include "statistics/undefined.hpp"
#include "tracks/lagged_sums.hpp"

namespace lilytank {
namespace {

using Signal = std::vector<std::complex<double>>;

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

// Collects tracks' sums at all lags into bodies' sums at the wanted ones.
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
  void add(std::int64_t id, const LaggedSums& track) {
    const auto [found, fresh] = body_of_.try_emplace(id, body_of_.size());
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
  std::map<std::int64_t, std::size_t> body_of_;
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
      collector.add(track.id, summer(z, collector.most(), LaggedKind::square));
    } else if (track.first <= recording.rate) {
      collector.add(track.id, from_first(z, collector.most()));
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
    collector.add(track.id, summer(z, collector.most(), LaggedKind::product));
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
