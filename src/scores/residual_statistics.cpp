#include "scores/residual_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "forces/pairs.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

struct Mean {
  double sum = 0, count = 0;
  void add(double value) { sum += value, count += 1; }
  double value() const { return count > 0 ? sum / count : 0; }
};

// Innovations saturate at this many deviations, so that one identity swap does not dominate.
constexpr double kFarScore = 8;
double clipped(double z) {
  return std::clamp(z, -kFarScore, kFarScore);
}

class Memory final : public ResidualStatistic {
 public:
  explicit Memory(const ScorePlan& plan) : past_(static_cast<std::size_t>(plan.modules)) {}
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out;
    for (const int lag : kLags) out.push_back({"noise", "memory over " + std::to_string(lag)});
    for (const int lag : kTurnLags) {
      out.push_back({"noise", "memory of turning over " + std::to_string(lag)});
    }
    return out;
  }
  void add(const PredictedFrame& frame, const std::vector<Seen>& seen) override {
    for (const Seen& one : seen) {
      Ring& ring = past_[one.module];
      if (ring.frame + 1 != frame.frame || ring.recording != frame.recording) ring.length = 0;
      ring.frame = frame.frame, ring.recording = frame.recording;
      if (!one.usable) {
        ring.length = 0;
        continue;
      }
      const std::array<double, 3> z{clipped(one.zx), clipped(one.zy), clipped(one.zt)};
      for (std::size_t k = 0; k < kLags.size(); ++k) {
        if (ring.length < kLags[k]) continue;
        const auto& old = ring.at(kLags[k]);
        place_[k].add(z[0] * old[0] + z[1] * old[1]);
      }
      for (std::size_t k = 0; k < kTurnLags.size(); ++k) {
        if (ring.length >= kTurnLags[k]) turn_[k].add(z[2] * ring.at(kTurnLags[k])[2]);
      }
      squares_.add(z[0] * z[0] + z[1] * z[1]), turn_squares_.add(z[2] * z[2]);
      ring.push(z);
    }
  }
  void append_to(std::vector<double>& values, ScoreDetails*) const override {
    for (const Mean& m : place_) values.push_back(m.value() / std::max(squares_.value(), 1e-9));
    for (const Mean& m : turn_) values.push_back(m.value() / std::max(turn_squares_.value(), 1e-9));
  }

 private:
  static constexpr std::array<int, 9> kLags{1, 2, 3, 5, 8, 12, 18, 27, 40};
  static constexpr std::array<int, 5> kTurnLags{1, 2, 4, 8, 16};
  struct Ring {
    std::array<std::array<double, 3>, 64> z{};
    int length = 0, next = 0, frame = -9, recording = -1;
    void push(const std::array<double, 3>& value) {
      z[static_cast<std::size_t>(next)] = value, next = (next + 1) % 64;
      length = std::min(length + 1, 64);
    }
    const std::array<double, 3>& at(int lag) const {
      return z[static_cast<std::size_t>((next - lag + 64) % 64)];
    }
  };
  std::vector<Ring> past_;
  std::array<Mean, 9> place_;
  std::array<Mean, 5> turn_;
  Mean squares_, turn_squares_;
};

class Variance final : public ResidualStatistic {
 public:
  explicit Variance(const ScorePlan& plan) : radius_(plan.model.tank.radius) {}
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out{{"noise", "variance"}, {"noise", "variance of turning"}};
    for (int k = 0; k < kBins; ++k) {
      out.push_back({"noise", "variance at slip " + std::to_string(k + 1), 1});
    }
    for (int k = 0; k < kBins; ++k) {
      out.push_back({"noise", "variance at radius " + std::to_string(k + 1), 1});
    }
    for (const char* name :
         {"along the slip over across", "fourth moment", "far ones", "fourth moment of turning",
          "variance in the first third", "variance in the last third"}) {
      out.push_back({"noise", name});
    }
    return out;
  }
  void add(const PredictedFrame& frame, const std::vector<Seen>& seen) override {
    times_ = std::max(times_, frame.time);
    for (const Seen& one : seen) {
      if (!one.usable) continue;
      const double zx = clipped(one.zx), zy = clipped(one.zy), zt = clipped(one.zt);
      const double square = 0.5 * (zx * zx + zy * zy);
      all_.add(square), turn_.add(zt * zt);
      fourth_.add(0.5 * (zx * zx * zx * zx + zy * zy * zy * zy)),
          turn_fourth_.add(zt * zt * zt * zt);
      far_.add(square > kFarSquare ? 1 : 0);
      const double slip2 = one.slip_x * one.slip_x + one.slip_y * one.slip_y;
      const double slip = std::sqrt(slip2);
      by_slip_[bin(slip / kSlip)].add(square);
      const double x = frame.now.x[one.index], y = frame.now.y[one.index];
      by_radius_[bin(std::sqrt(x * x + y * y) / radius_)].add(square);
      if (slip > 0.02) {
        const double along = (zx * one.slip_x + zy * one.slip_y) / slip;
        along_.add(along * along), across_.add(2 * square - along * along);
      }
      by_time_.emplace_back(static_cast<float>(frame.time), static_cast<float>(square));
    }
  }
  void append_to(std::vector<double>& values, ScoreDetails*) const override {
    const double all = std::max(all_.value(), 1e-9);
    values.push_back(std::log(all)), values.push_back(std::log(std::max(turn_.value(), 1e-9)));
    // In standard errors of a mean of normal squares: slips and places may be rare, and a single
    // frame is then no evidence.
    const auto excess = [all](const Mean& m) {
      return (m.sum / all - m.count) / std::sqrt(std::max(m.count, 1.0));
    };
    for (const Mean& m : by_slip_) values.push_back(excess(m));
    for (const Mean& m : by_radius_) values.push_back(excess(m));
    values.push_back(along_.value() / std::max(across_.value(), 1e-9));
    values.push_back(fourth_.value() / (all * all)), values.push_back(std::sqrt(far_.value()));
    const double turn = std::max(turn_.value(), 1e-9);
    values.push_back(turn_fourth_.value() / (turn * turn));
    Mean first, last;
    for (const auto& [time, square] : by_time_) {
      if (time < times_ / 3) first.add(static_cast<double>(square));
      if (time > times_ * 2 / 3) last.add(static_cast<double>(square));
    }
    values.push_back(first.value() / all), values.push_back(last.value() / all);
  }

 private:
  static constexpr int kBins = 4;
  static constexpr double kSlip = 0.32, kFarSquare = 8;
  static std::size_t bin(double share) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(share * kBins), 0, kBins - 1));
  }
  double radius_, times_ = 0;
  Mean all_, turn_, fourth_, turn_fourth_, far_, along_, across_;
  std::array<Mean, kBins> by_slip_, by_radius_;
  std::vector<std::pair<float, float>> by_time_;
};

// Correlation of the innovations of neighbouring modules.
class Sharing final : public ResidualStatistic {
 public:
  explicit Sharing(const ScorePlan&) {}
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out;
    for (const double d : kEdges) {
      out.push_back({"noise", "shared by modules nearer than " + shortest(d) + " m"});
    }
    return out;
  }
  void add(const PredictedFrame& frame, const std::vector<Seen>& seen) override {
    for (std::size_t a = 0; a < seen.size(); ++a) {
      if (!seen[a].usable) continue;
      for (std::size_t b = a + 1; b < seen.size(); ++b) {
        if (!seen[b].usable) continue;
        const double dx = frame.now.x[a] - frame.now.x[b], dy = frame.now.y[a] - frame.now.y[b];
        const double d = std::sqrt(dx * dx + dy * dy);
        const auto k = static_cast<std::size_t>(std::lower_bound(kEdges.begin(), kEdges.end(), d) -
                                                kEdges.begin());
        if (k == kEdges.size()) continue;
        shared_[k].add(0.5 * (clipped(seen[a].zx) * clipped(seen[b].zx) +
                              clipped(seen[a].zy) * clipped(seen[b].zy)));
      }
    }
  }
  void append_to(std::vector<double>& values, ScoreDetails*) const override {
    for (const Mean& m : shared_) values.push_back(m.value());
  }

 private:
  static constexpr std::array<double, 6> kEdges{0.045, 0.06, 0.08, 0.12, 0.18, 0.30};
  std::array<Mean, 6> shared_;
};

// Differences between modules: response to drag, scatter, rotation. Modules that latch are
// predicted for times of very different length, seconds or minutes: each difference counts in
// standard errors, in units of those of a module with the mean length. Without weights a module of
// some frames had differences of up to 22 standard deviations.
class ModuleDifferences final : public ResidualStatistic {
 public:
  explicit ModuleDifferences(const ScorePlan& plan)
      : latched_(plan.latched()), each_(static_cast<std::size_t>(plan.modules)) {}
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out;
    for (const char* what : {"scatter", "turning scatter", "answer to drag", "bias of turning"}) {
      for (const char* which : {"most", "least", "spread"}) {
        out.push_back({"module", std::string(what) + ", " + which});
      }
    }
    return out;
  }
  void add(const PredictedFrame&, const std::vector<Seen>& seen) override {
    for (const Seen& one : seen) {
      if (!one.usable) continue;
      Each& m = each_[one.module];
      const double zx = clipped(one.zx), zy = clipped(one.zy), zt = clipped(one.zt);
      m.square.add(0.5 * (zx * zx + zy * zy)), m.turn.add(zt * zt), m.bias.add(zt);
      m.drag.add(zx * one.drag_x + zy * one.drag_y);
      m.drag_square.add(one.drag_x * one.drag_x + one.drag_y * one.drag_y);
    }
  }
  void append_to(std::vector<double>& values, ScoreDetails* details) const override {
    std::array<std::vector<double>, 4> of;
    std::vector<double> weights;
    std::vector<int> modules;
    for (std::size_t k = 0; k < each_.size(); ++k) {
      const Each& m = each_[k];
      if (m.square.count == 0) continue;  // nothing but contacts: no statistic
      of[0].push_back(std::log(std::max(m.square.value(), 1e-9)));
      of[1].push_back(std::log(std::max(m.turn.value(), 1e-9)));
      of[2].push_back(m.drag.value() / std::max(m.drag_square.value(), 1e-12));
      of[3].push_back(m.bias.value());
      weights.push_back(latched_ ? m.square.count : 1), modules.push_back(static_cast<int>(k));
    }
    for (std::vector<double>& list : of) {
      make_differences(weights, list);
      double square = 0;
      for (const double d : list) square += d * d / static_cast<double>(list.size());
      const auto ends = std::minmax_element(list.begin(), list.end());
      values.push_back(list.empty() ? 0 : *ends.second);
      values.push_back(list.empty() ? 0 : *ends.first);
      values.push_back(std::sqrt(square));
    }
    if (details == nullptr || modules.empty()) return;
    const auto least = std::min_element(of[0].begin(), of[0].end()) - of[0].begin();
    details->heaviest = modules[static_cast<std::size_t>(least)];
  }

 private:
  struct Each {
    Mean square, turn, bias, drag, drag_square;
  };
  // Values less their mean, in standard errors of a module with the mean weight.
  static void make_differences(const std::vector<double>& weights, std::vector<double>& values) {
    double mean = 0, weight = 0;
    for (const double w : weights) weight += w;
    for (std::size_t k = 0; k < values.size(); ++k) mean += weights[k] / weight * values[k];
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] =
          (values[k] - mean) * std::sqrt(weights[k] * static_cast<double>(values.size()) / weight);
    }
  }
  bool latched_;
  std::vector<Each> each_;
};

// Contacts: place, duration, and overlap of recorded squares by region.
class Touches final : public ResidualStatistic {
 public:
  explicit Touches(const ScorePlan& plan)
      : side_(plan.model.module.side),
        radius_(plan.model.tank.radius),
        modules_(static_cast<std::size_t>(plan.modules)),
        begun_(modules_ * modules_, kNever) {}
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out;
    for (const char* name :
         {"time together", "meetings", "share of the time near", "fast partings"}) {
      out.push_back({"contact", name});
    }
    for (const char* name :
         {"gap at contact, outwards", "gap at contact, along the radius", "gap at contact, right",
          "gap at contact, top", "gap at contact along x"}) {
      out.push_back({"camera", name});
    }
    return out;
  }
  void add(const PredictedFrame& frame, const std::vector<Seen>& seen) override {
    if (frame.recording != recording_) {
      recording_ = frame.recording;
      std::fill(begun_.begin(), begun_.end(), kNever);
    }
    pairs_ += 0.5 * static_cast<double>(seen.size() * (seen.size() - 1));
    for_near_pairs(frame.now, side_ * 1.6, [&](const NearPair& pair) {
      const SquareGap at = square_gap(frame.now, pair, side_);
      if (at.gap > kPartedGap) return;
      near_ += 1;
      const auto a = static_cast<std::size_t>(pair.i), b = static_cast<std::size_t>(pair.j);
      Touch& touch = touching_[key(seen[a], seen[b])];
      int& begun = begun_[key(seen[a], seen[b])];
      if (at.gap < kTouch && begun == kNever) begun = frame.frame, meetings_ += 1;
      touch.last = frame.frame, touch.interval = frame.interval;
      if (at.gap < kTouch) {
        const double x = 0.5 * (frame.now.x[a] + frame.now.x[b]);
        const double y = 0.5 * (frame.now.y[a] + frame.now.y[b]);
        const double gap = std::clamp(at.gap, -2e-3, kTouch);
        const double rr = (x * x + y * y) / (radius_ * radius_);
        place_.add(rr), place_square_.add(rr * rr), gap_.add(gap), both_.add(gap * rr);
        const double radial = std::fabs(at.nx * x + at.ny * y) / std::max(std::hypot(x, y), 1e-6);
        if (radial > 0.8) along_radius_.add(gap);
        if (radial < 0.6) across_radius_.add(gap);
        (x > 0 ? right_ : left_).add(gap), (y > 0 ? top_ : bottom_).add(gap);
        (std::fabs(at.nx) > 0.7 ? along_x_ : along_y_).add(gap);
      }
    });
    close(frame, seen);
  }
  void append_to(std::vector<double>& values, ScoreDetails*) const override {
    values.push_back(std::log(std::max(together_.value(), 1e-3)));
    values.push_back(std::log((meetings_ + 1) / std::max(pairs_, 1.0)));
    values.push_back(std::log((near_ + 1) / std::max(pairs_, 1.0)));
    values.push_back(short_.value());
    // Differences only: the mean overlap depends on details of the contact model.
    const double spread = place_square_.value() - place_.value() * place_.value();
    const double slope = both_.value() - gap_.value() * place_.value();
    values.push_back(1e3 * slope / std::max(spread, 1e-6));
    values.push_back(1e3 * (along_radius_.value() - across_radius_.value()));
    values.push_back(1e3 * (right_.value() - left_.value()));
    values.push_back(1e3 * (top_.value() - bottom_.value()));
    values.push_back(1e3 * (along_x_.value() - along_y_.value()));
  }

 private:
  static constexpr int kNever = -1;
  static constexpr double kTouch = 1e-3, kPartedGap = 4e-3;  // m: they meet; they have parted
  struct Touch {
    int last = -9;
    double interval = 0;
  };
  std::size_t key(const Seen& a, const Seen& b) const {
    return std::min(a.module, b.module) * modules_ + std::max(a.module, b.module);
  }
  // An encounter ends once the gap exceeds kPartedGap.
  void close(const PredictedFrame& frame, const std::vector<Seen>& seen) {
    for (std::size_t a = 0; a < seen.size(); ++a) {
      for (std::size_t b = a + 1; b < seen.size(); ++b) {
        const std::size_t at = key(seen[a], seen[b]);
        if (begun_[at] == kNever) continue;
        const Touch& touch = touching_[at];
        if (touch.last == frame.frame) continue;
        const double time = (frame.frame - begun_[at]) * touch.interval;
        together_.add(time), short_.add(time < 0.3 ? 1 : 0);
        begun_[at] = kNever;
      }
    }
  }
  double side_, radius_;
  std::size_t modules_;
  std::vector<int> begun_;
  std::vector<Touch> touching_ = std::vector<Touch>(modules_ * modules_);
  int recording_ = -1;
  double pairs_ = 0, near_ = 0, meetings_ = 0;
  Mean together_, short_, place_, place_square_, gap_, both_, along_radius_, across_radius_;
  Mean right_, left_, top_, bottom_, along_x_, along_y_;
};

}  // namespace

std::vector<std::unique_ptr<ResidualStatistic>> residual_statistics(const ScorePlan& plan) {
  std::vector<std::unique_ptr<ResidualStatistic>> out;
  out.push_back(std::make_unique<Memory>(plan)), out.push_back(std::make_unique<Variance>(plan));
  out.push_back(std::make_unique<Sharing>(plan));
  if (plan.identities) out.push_back(std::make_unique<ModuleDifferences>(plan));
  out.push_back(spectrum_statistic(plan)), out.push_back(std::make_unique<Touches>(plan));
  return out;
}

}  // namespace lilytank
