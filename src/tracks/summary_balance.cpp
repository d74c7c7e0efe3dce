// Process noise, the balance of momentum and spin, turning and neighbours of a motion summary.
//
// The balance correlates changes of velocity with the water's velocity relative to the body,
// its own velocity, their squares. Its terms are those that drag, damping and random force differ
// in, and they know a parameter from seconds of motion, where displacements need minutes.
#include <algorithm>
#include <array>
#include <cmath>

#include "text/number.hpp"
#include "tracks/summary_parts.hpp"

namespace lilytank {
namespace {

// Second differences over a few frames: noise, and forces that change from tick to tick.
class Kicks final : public SummaryPart {
 public:
  explicit Kicks(bool turning) : turning_(turning) {}
  void add(const Track& track) override {
    if (turning_) {
      add(track.theta);
    } else {
      add(track.x), add(track.y);
    }
  }
  void report(SummaryValues& out) const override {
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      const std::string lag = std::to_string(kLags[k]) + " frames";
      out.push_back({"kicks", (turning_ ? "turning noise " : "process noise ") + lag,
                     log_of(sums_[k].mean())});
    }
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

class Balance final : public SummaryPart {
 public:
  explicit Balance(const MotionSummary& s)
      : span_(frames_of(0.1, s.rate)), rate_(s.rate), field_(s.field), turns_(s.headings) {}
  void add(const Track& track) override {
    const int n = static_cast<int>(track.x.size());
    for (int i = span_; i + 2 * span_ < n; i += span_) add(track, static_cast<std::size_t>(i));
  }
  void report(SummaryValues& out) const override {
    // By the mean squares of what they go with: then they are rates, whatever the speeds.
    const double w2 = square(0), v2 = square(1), u2 = square(2), w4 = square(3);
    out.insert(out.end(),
               {{"balance", "along slip", along_[0].mean() / w2},
                {"balance", "along slip, quadratic", along_[1].mean() / std::sqrt(w4 * w2)},
                {"balance", "along velocity", along_[2].mean() / v2},
                {"balance", "along water", along_[3].mean() / u2},
                {"balance", "across water", along_[4].mean() / u2},
                {"balance", "velocity and water", along_[5].mean() / std::sqrt(u2 * v2)},
                {"balance", "process noise in slow water", log_of(kicks_[0].mean())},
                {"balance", "process noise in fast water", log_of(kicks_[1].mean())}});
    if (!turns_) return;
    const double s2 = std::max(spin_square_.mean(), 1e-12);
    out.insert(out.end(), {{"balance", "spin lost", spin_[0].mean() / s2},
                           {"balance", "spin lost by slip", spin_[1].mean() / (s2 * std::sqrt(w2))},
                           {"balance", "spin and water", spin_[2].mean() / std::sqrt(s2 * u2)}});
  }

 private:
  void add(const Track& track, std::size_t i) {
    const auto d = static_cast<std::size_t>(span_);
    const double scale = rate_ / span_;
    const auto& x = track.x;
    const auto& y = track.y;
    const double vx = scale * (x[i] - x[i - d]), vy = scale * (y[i] - y[i - d]);
    const double ax = scale * (x[i + 2 * d] - x[i + d]) - vx;
    const double ay = scale * (y[i + 2 * d] - y[i + d]) - vy;
    const double sum = vx + vy + ax + ay;
    if (sum - sum != 0) return;
    const FlowSample u = field_->at(x[i], y[i]);
    const double wx = u.mu_x - vx, wy = u.mu_y - vy, w = std::sqrt(wx * wx + wy * wy);
    along_[0].add(ax * wx + ay * wy);
    along_[1].add(w * (ax * wx + ay * wy));
    along_[2].add(ax * vx + ay * vy);
    along_[3].add(ax * u.mu_x + ay * u.mu_y);
    along_[4].add(ay * u.mu_x - ax * u.mu_y);
    along_[5].add(vx * u.mu_x + vy * u.mu_y);
    squares_[0].add(w * w), squares_[1].add(vx * vx + vy * vy);
    squares_[2].add(u.mu_x * u.mu_x + u.mu_y * u.mu_y), squares_[3].add(w * w * w * w);
    kicks_[w < kSlow ? 0 : 1].add(ax * ax + ay * ay);
    if (!turns_) return;
    const auto& t = track.theta;
    const double s = scale * (t[i] - t[i - d]);
    const double change = scale * (t[i + 2 * d] - t[i + d]) - s;
    spin_[0].add(change * s), spin_[1].add(change * s * w);
    spin_[2].add(s * w), spin_square_.add(s * s);
  }
  double square(std::size_t i) const { return std::max(squares_[i].mean(), 1e-12); }

  static constexpr double kSlow = 0.1;  // m/s of slip
  int span_;
  double rate_;
  std::shared_ptr<const FlowField> field_;
  bool turns_;
  std::array<MeanSum, 6> along_;
  std::array<MeanSum, 4> squares_;
  std::array<MeanSum, 2> kicks_;
  std::array<MeanSum, 3> spin_;
  MeanSum spin_square_;
};

class Turning final : public SummaryPart {
 public:
  explicit Turning(const MotionSummary& s)
      : half_(frames_of(0.05, s.rate)), stride_(frames_of(0.1, s.rate)), rate_(s.rate) {}
  void add(const Track& track) override {
    const auto& t = track.theta;
    const auto n = static_cast<int>(t.size());
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      const int lag = frames_of(kLags[k], rate_);
      for (int i = 0; i + lag < n; i += stride_) {
        const double d = t[i + lag] - t[i];
        turns_[k].add(d * d);
      }
    }
    std::vector<double> spin;
    for (int i = half_; i + half_ < n; i += stride_) {
      spin.push_back(rate_ / (2 * half_) * (t[i + half_] - t[i - half_]));
      square_.add(spin.back() * spin.back());
      size_.add(std::fabs(spin.back())), mean_.add(spin.back());
    }
    for (std::size_t k = 0; k < kMemory.size(); ++k) {
      const auto lag = static_cast<std::size_t>(frames_of(kMemory[k], rate_ / stride_));
      for (std::size_t i = 0; i + lag < spin.size(); ++i) products_[k].add(spin[i] * spin[i + lag]);
    }
  }
  void report(SummaryValues& out) const override {
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      out.push_back({"turning", "turns " + shortest(kLags[k]) + " s", log_of(turns_[k].mean())});
    }
    const double s2 = std::max(square_.mean(), 1e-12);
    for (std::size_t k = 0; k < kMemory.size(); ++k) {
      const std::string lag = shortest(kMemory[k]) + " s";
      out.push_back({"turning", "memory of spin " + lag, products_[k].mean() / s2});
    }
    out.insert(out.end(), {{"turning", "mean square spin", log_of(square_.mean())},
                           {"turning", "mean size of spin", log_of(size_.mean())},
                           {"turning", "mean spin", mean_.mean()}});
  }

 private:
  static constexpr std::array<double, 8> kLags{0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8};
  static constexpr std::array<double, 5> kMemory{0.2, 0.4, 0.8, 1.6, 3.2};
  int half_, stride_;
  double rate_;
  std::array<MeanSum, 8> turns_;
  std::array<MeanSum, 5> products_;
  MeanSum square_, size_, mean_;
};

// How often another body is near, five times a second.
class Neighbours final : public SummaryPart {
 public:
  explicit Neighbours(const MotionSummary& s)
      : stride_(frames_of(0.2, s.rate)), size_(s.body_size) {}
  void add(const Track&) override {}
  void add(const Recording& recording) override {
    for (int f = 0; f < recording.frames; f += stride_) {
      x_.clear(), y_.clear();
      for (const Track& track : recording.tracks) {
        const int k = f - track.first;
        if (k < 0 || k >= static_cast<int>(track.x.size())) continue;
        if (!std::isnan(track.x[k])) x_.push_back(track.x[k]), y_.push_back(track.y[k]);
      }
      count();
    }
  }
  void report(SummaryValues& out) const override {
    for (std::size_t k = 0; k < kDistances.size(); ++k) {
      out.push_back({"neighbours", "nearer than " + shortest(kDistances[k]) + " sizes",
                     std::sqrt(near_[k] / std::max(all_, 1.0))});
    }
  }

 private:
  static constexpr std::array<double, 4> kDistances{1.1, 1.3, 1.7, 2.5};
  void count() {
    for (std::size_t a = 0; a < x_.size(); ++a) {
      double least = 1e9;
      for (std::size_t b = 0; b < x_.size(); ++b) {
        const double dx = x_[a] - x_[b], dy = y_[a] - y_[b];
        if (b != a) least = std::min(least, dx * dx + dy * dy);
      }
      all_ += 1;
      for (std::size_t k = 0; k < kDistances.size(); ++k) {
        const double d = kDistances[k] * size_;
        if (least < d * d) near_[k] += 1;
      }
    }
  }
  int stride_;
  double size_, all_ = 0;
  std::array<double, 4> near_{};
  std::vector<double> x_, y_;
};

}  // namespace

void add_balance_parts(const MotionSummary& summary, SummaryParts& out) {
  out.push_back(std::make_unique<Kicks>(false));
  if (summary.field) out.push_back(std::make_unique<Balance>(summary));
  if (summary.headings) {
    out.push_back(std::make_unique<Turning>(summary));
    out.push_back(std::make_unique<Kicks>(true));
  }
  out.push_back(std::make_unique<Neighbours>(summary));
}

}  // namespace lilytank
