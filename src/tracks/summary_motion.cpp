// Displacements, velocities, places and kicks of a motion summary.
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
  std::vector<SummaryEntry> entries() const override {
    std::vector<SummaryEntry> out;
    for (const double s : seconds_) out.push_back({"displacement", "msd " + shortest(s) + " s"});
    return out;
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
  void tell(std::vector<double>& values) const override {
    for (const MeanSum& sum : sums_) values.push_back(log_of(sum.mean()));
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
  std::vector<SummaryEntry> entries() const override {
    std::vector<SummaryEntry> out{{"velocity", "mean square"}};
    for (const double s : kLags) out.push_back({"velocity", "memory " + shortest(s) + " s"});
    for (const double q : kQuantiles) out.push_back({"velocity", "speed " + shortest(q)});
    return out;
  }
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
  void tell(std::vector<double>& values) const override {
    values.push_back(log_of(square_.mean()));
    for (const MeanSum& p : products_) {
      values.push_back(p.mean() / std::max(square_.mean(), 1e-12));
    }
    for (const double q : kQuantiles) values.push_back(log_of(quantile(q)));
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
      const double here = histogram_[static_cast<std::size_t>(i)];
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

// How often bodies are in each ring about the centre, and how they move there.
class Place final : public SummaryPart {
 public:
  explicit Place(const MotionSummary& s)
      : half_(frames_of(0.05, s.rate)),
        stride_(frames_of(0.1, s.rate)),
        rate_(s.rate),
        width_(s.tank_radius / kRings) {}
  std::vector<SummaryEntry> entries() const override {
    std::vector<SummaryEntry> out;
    for (const char* what : {"share", "around", "outwards"}) {
      for (int r = 0; r < kRings; ++r) {
        out.push_back({"place", std::string(what) + " ring " + std::to_string(r + 1)});
      }
    }
    return out;
  }
  void add(const Track& track) override {
    const double scale = rate_ / (2 * half_);
    for (int i = half_; i + half_ < static_cast<int>(track.x.size()); i += stride_) {
      const auto a = static_cast<std::size_t>(i - half_), b = static_cast<std::size_t>(i + half_);
      const auto m = static_cast<std::size_t>(i);
      const double x = track.x[m], y = track.y[m], r = std::sqrt(x * x + y * y);
      const double vx = scale * (track.x[b] - track.x[a]), vy = scale * (track.y[b] - track.y[a]);
      const double out = (x * vx + y * vy) / r, around = (x * vy - y * vx) / r;
      if (out - out != 0 || around - around != 0) continue;
      const auto ring = static_cast<std::size_t>(std::min(r / width_, kRings - 1.0));
      share_[ring] += 1, around_[ring] += around, out_[ring] += out, all_ += 1;
    }
  }
  void tell(std::vector<double>& values) const override {
    const double all = std::max(all_, 1.0);
    // Products with the share: defined also where no body came.
    for (const double v : share_) values.push_back(std::sqrt(v / all));
    for (const double v : around_) values.push_back(v / all);
    for (const double v : out_) values.push_back(v / all);
  }

 private:
  int half_, stride_;
  double rate_, width_, all_ = 0;
  std::array<double, kRings> share_{}, around_{}, out_{};
};

// Second differences over a few frames: noise, and forces that change from tick to tick.
class Kicks final : public SummaryPart {
 public:
  Kicks(const MotionSummary& s, bool turning) : turning_(turning) { static_cast<void>(s); }
  std::vector<SummaryEntry> entries() const override {
    std::vector<SummaryEntry> out;
    for (const int lag : kLags) {
      out.push_back(
          {turning_ ? "turning" : "kicks",
           (turning_ ? "turning noise " : "process noise ") + std::to_string(lag) + " frames"});
    }
    return out;
  }
  void add(const Track& track) override {
    if (turning_) {
      add(track.theta);
    } else {
      add(track.x), add(track.y);
    }
  }
  void tell(std::vector<double>& values) const override {
    for (const MeanSum& sum : sums_) values.push_back(log_of(sum.mean()));
  }

 private:
  static constexpr std::array<int, 6> kLags{1, 2, 3, 4, 6, 9};
  void add(const std::vector<double>& of) {
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      const auto lag = static_cast<std::size_t>(kLags[k]);
      MeanSum sum = sums_[k];  // a copy, as memory would be slower
      for (std::size_t i = lag; i + lag < of.size(); ++i) {
        const double d = of[i + lag] - 2 * of[i] + of[i - lag];
        sum.add(d * d);
      }
      sums_[k] = sum;
    }
  }
  bool turning_;
  std::array<MeanSum, 6> sums_;
};

}  // namespace

std::unique_ptr<SummaryPart> displacement_part(const MotionSummary& summary) {
  return std::make_unique<Displacement>(summary);
}
std::unique_ptr<SummaryPart> velocity_part(const MotionSummary& summary) {
  return std::make_unique<Velocity>(summary);
}
std::unique_ptr<SummaryPart> place_part(const MotionSummary& summary) {
  return std::make_unique<Place>(summary);
}
std::unique_ptr<SummaryPart> kicks_part(const MotionSummary& summary) {
  return std::make_unique<Kicks>(summary, false);
}
std::unique_ptr<SummaryPart> turning_kicks_part(const MotionSummary& summary) {
  return std::make_unique<Kicks>(summary, true);
}

}  // namespace lilytank
