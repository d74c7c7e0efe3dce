// Displacements, velocities and places of a motion summary.
#include <algorithm>
#include <array>
#include <cmath>

#include "text/number.hpp"
#include "tracks/summary_parts.hpp"

namespace lilytank {
namespace {

constexpr int kRings = 6;

class Displacement final : public SummaryPart {
 public:
  explicit Displacement(const MotionSummary& s) : stride_(frames_of(0.1, s.rate)) {
    for (const double lag :
         {0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 20.0, 40.0}) {
      if (lag <= s.longest) seconds_.push_back(lag), lags_.push_back(frames_of(lag, s.rate));
    }
    sums_.resize(lags_.size());
  }
  void add(const Track& track) override {
    const auto n = static_cast<int>(track.x.size());
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      MeanSum sum = sums_[k];  // a copy, as memory would be slower
      for (int i = 0; i + lags_[k] < n; i += stride_) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(i + lags_[k]);
        const double dx = track.x[b] - track.x[a], dy = track.y[b] - track.y[a];
        sum.add(dx * dx + dy * dy);
      }
      sums_[k] = sum;
    }
  }
  void report(SummaryValues& out) const override {
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      out.push_back(
          {"displacement", "msd " + shortest(seconds_[k]) + " s", log_of(sums_[k].mean())});
    }
  }

 private:
  int stride_;
  std::vector<double> seconds_;
  std::vector<int> lags_;
  std::vector<MeanSum> sums_;
};

// Velocities by central differences, one every 0.1 s.
class Velocity final : public SummaryPart {
 public:
  explicit Velocity(const MotionSummary& s)
      : half_(frames_of(0.05, s.rate)), stride_(frames_of(0.1, s.rate)), rate_(s.rate) {}
  void add(const Track& track) override {
    std::vector<double> vx, vy;
    const double scale = rate_ / (2 * half_);
    for (int i = half_; i + half_ < static_cast<int>(track.x.size()); i += stride_) {
      const auto a = static_cast<std::size_t>(i - half_), b = static_cast<std::size_t>(i + half_);
      vx.push_back(scale * (track.x[b] - track.x[a]));
      vy.push_back(scale * (track.y[b] - track.y[a]));
      const double v2 = vx.back() * vx.back() + vy.back() * vy.back();
      square_.add(v2);
      if (v2 - v2 == 0) ++histogram_[bin_of(std::sqrt(v2))];
    }
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      const auto lag = static_cast<std::size_t>(frames_of(kLags[k], rate_ / stride_));
      for (std::size_t i = 0; i + lag < vx.size(); ++i) {
        products_[k].add(vx[i] * vx[i + lag] + vy[i] * vy[i + lag]);
      }
    }
  }
  void report(SummaryValues& out) const override {
    out.push_back({"velocity", "mean square", log_of(square_.mean())});
    const double v2 = std::max(square_.mean(), 1e-12);
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      out.push_back({"velocity", "memory " + shortest(kLags[k]) + " s", products_[k].mean() / v2});
    }
    for (const double q : kQuantiles) {
      out.push_back({"velocity", "speed " + shortest(q), log_of(quantile(q))});
    }
  }

 private:
  static constexpr std::array<double, 6> kLags{0.2, 0.4, 0.8, 1.6, 3.2, 6.4};
  static constexpr std::array<double, 5> kQuantiles{0.1, 0.25, 0.5, 0.75, 0.9};
  static constexpr int kBins = 1000;  // of 1 mm/s
  static constexpr double kWidth = 0.001;
  static std::size_t bin_of(double speed) {
    return static_cast<std::size_t>(std::min(speed / kWidth, kBins - 1.0));
  }
  // Linear within its bin.
  double quantile(double share) const {
    const double wanted = share * square_.weight;
    double below = 0;
    for (int i = 0; i < kBins; ++i) {
      const double here = histogram_[i];
      if (below + here >= wanted && here > 0) return kWidth * (i + (wanted - below) / here);
      below += here;
    }
    return kWidth * kBins;
  }
  int half_, stride_;
  double rate_;
  MeanSum square_;
  std::array<MeanSum, 6> products_;
  std::array<double, kBins> histogram_{};
};

// How often bodies are in each ring about the centre, and how fast they go around there. Not
// outwards: a body leaves a ring as often as it comes, so that the sum shows only missing frames.
class Place final : public SummaryPart {
 public:
  explicit Place(const MotionSummary& s)
      : half_(frames_of(0.05, s.rate)),
        stride_(frames_of(0.1, s.rate)),
        rate_(s.rate),
        width_(s.tank_radius / kRings) {}
  void add(const Track& track) override {
    const double scale = rate_ / (2 * half_);
    for (int i = half_; i + half_ < static_cast<int>(track.x.size()); i += stride_) {
      const auto a = static_cast<std::size_t>(i - half_), b = static_cast<std::size_t>(i + half_);
      const double x = track.x[i], y = track.y[i], r = std::sqrt(x * x + y * y);
      const double vx = scale * (track.x[b] - track.x[a]), vy = scale * (track.y[b] - track.y[a]);
      const double around = (x * vy - y * vx) / r;
      if (around - around != 0) continue;
      const auto ring = static_cast<std::size_t>(std::min(r / width_, kRings - 1.0));
      share_[ring] += 1, around_[ring] += around, all_ += 1;
    }
  }
  void report(SummaryValues& out) const override {
    const double all = std::max(all_, 1.0);
    const auto rings = [&](const std::string& what, auto value_of) {
      for (std::size_t r = 0; r < kRings; ++r) {
        out.push_back({"place", what + " ring " + std::to_string(r + 1), value_of(r)});
      }
    };
    // Products with the share: defined also where no body came.
    rings("share", [&](std::size_t r) { return std::sqrt(share_[r] / all); });
    rings("around", [&](std::size_t r) { return around_[r] / all; });
  }

 private:
  int half_, stride_;
  double rate_, width_, all_ = 0;
  std::array<double, kRings> share_{}, around_{};
};

}  // namespace

void add_motion_parts(const MotionSummary& summary, SummaryParts& out) {
  out.push_back(std::make_unique<Displacement>(summary));
  out.push_back(std::make_unique<Velocity>(summary));
  out.push_back(std::make_unique<Place>(summary));
}

}  // namespace lilytank
