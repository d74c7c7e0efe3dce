// Lines in the spectra of innovations: pulsating pumps, vortex shedding.
#include <algorithm>
#include <array>
#include <cmath>

#include "scores/residual_statistics.hpp"
#include "statistics/median.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kFastest = 6;        // Hz, of pulsation
constexpr double kOversampled = 1.5;  // frequencies in a line's width
constexpr int kPiece = 512;           // frames of a piece of a module's series
constexpr int kLinesAside = 6;        // lines on either side that a line is compared with
constexpr double kClearLine = 8;      // deviations, of a line that is no chance

constexpr std::size_t kBank = 16;

// Adds |sum of series e^(-i w t)|^2 to the power at each of a bank of frequencies (rad a frame), by
// phasors in parallel.
void add_powers(const std::vector<double>& series, const std::array<double, kBank>& radians,
                std::array<double, kBank>& power) {
  std::array<double, kBank> c{}, s{}, pc{}, ps{}, re{}, im{};
  for (std::size_t k = 0; k < kBank; ++k) {
    const Rot turn = rotation(radians[k]);
    c[k] = turn.c, s[k] = turn.s, pc[k] = 1;
  }
  for (const double v : series) {
    for (std::size_t k = 0; k < kBank; ++k) {
      re[k] += v * pc[k], im[k] -= v * ps[k];
      const double next = pc[k] * c[k] - ps[k] * s[k];
      ps[k] = pc[k] * s[k] + ps[k] * c[k], pc[k] = next;
    }
  }
  for (std::size_t k = 0; k < kBank; ++k) power[k] += re[k] * re[k] + im[k] * im[k];
}

class Spectrum final : public ResidualStatistic {
 public:
  explicit Spectrum(const ScorePlan& plan)
      : rate_(plan.rate), pieces_(static_cast<std::size_t>(plan.modules)) {
    for (auto& piece : pieces_) piece.reserve(kPiece);
    swing_.assign(kSwings, 0.0);
  }
  std::vector<ScoreEntry> entries() const override {
    std::vector<ScoreEntry> out{{"spectrum", "line in the flow's gain"},
                                {"spectrum", "line across the slip"}};
    for (const char* band : {"0.1 to 0.5", "0.5 to 1", "1 to 2"}) {
      out.push_back({"spectrum", std::string("across the slip, ") + band + " Hz"});
    }
    return out;
  }
  void add(const PredictedFrame& frame, const std::vector<Seen>& seen) override {
    if (series_.empty() || frame.recording != recording_) {
      series_.emplace_back();
      recording_ = frame.recording;
      for (auto& piece : pieces_) piece.clear();
    }
    double along = 0, square = 0;
    for (const Seen& one : seen) {
      if (one.usable) {
        along += one.zx * one.drag_x + one.zy * one.drag_y;
        square += one.drag_x * one.drag_x + one.drag_y * one.drag_y;
      }
      swing(one);
    }
    std::vector<double>& series = series_.back();
    series.resize(static_cast<std::size_t>(frame.frame), 0.0);
    series.push_back(square > 0 ? along / square : 0);
  }
  void append_to(std::vector<double>& values, ScoreDetails* details) const override {
    values.push_back(line(details));
    if (details != nullptr) details->swinging = swinging();
    double all = 1e-300, most = 0;
    for (const double p : swing_) all += p / kSwings, most = std::max(most, p);
    values.push_back(std::log(std::max(most, 1e-300) / all));
    for (const auto& [low, high] : {std::pair{0.1, 0.5}, {0.5, 1.0}, {1.0, 2.0}}) {
      double sum = 0, count = 0;
      for (int k = 0; k < kSwings; ++k) {
        const double f = frequency(k);
        if (f >= low && f < high) sum += swing_[static_cast<std::size_t>(k)], count += 1;
      }
      values.push_back(std::log(std::max(sum / std::max(count, 1.0), 1e-300) / all));
    }
  }

 private:
  static constexpr int kSwings = 48;
  double frequency(int k) const { return 0.0625 * (k + 1); }  // Hz, to 3

  // Innovations of one module across its slip, by segment.
  void swing(const Seen& one) {
    std::vector<double>& piece = pieces_[one.module];
    const double slip = std::hypot(one.slip_x, one.slip_y);
    const double across =
        one.usable && slip > 0 ? (one.zy * one.slip_x - one.zx * one.slip_y) / slip : 0;
    piece.push_back(std::clamp(across, -8.0, 8.0));
    if (static_cast<int>(piece.size()) < kPiece) return;
    for (std::size_t first = 0; first < kSwings; first += kBank) {
      std::array<double, kBank> radians{}, power{};
      for (std::size_t k = 0; k < kBank; ++k) {
        radians[k] = 2 * kPi * frequency(static_cast<int>(first + k)) / rate_;
      }
      add_powers(piece, radians, power);
      for (std::size_t k = 0; k < kBank; ++k) swing_[first + k] += power[k];
    }
    piece.clear(), whole_ += 1;
  }

  // Relative excess of every line over its neighbours.
  std::vector<double> beyond() const {
    std::vector<double> out;
    for (int k = 0; k < kSwings; ++k) {
      std::vector<double> about;
      for (int j = std::max(0, k - kLinesAside); j <= std::min(kSwings - 1, k + kLinesAside); ++j) {
        if (std::abs(j - k) > 1) about.push_back(swing_[static_cast<std::size_t>(j)]);
      }
      const double usual = std::max(median(std::move(about)), 1e-300);
      out.push_back(swing_[static_cast<std::size_t>(k)] / usual - 1);
    }
    return out;
  }

  // The most significant line, interpolated with its neighbours. The power averaged over n segments
  // has a relative error of 1 / sqrt(n).
  double swinging() const {
    const std::vector<double> more = beyond();
    const auto most = std::max_element(more.begin(), more.end());
    if (!(*most * std::sqrt(whole_) > kClearLine)) return 0;
    const auto best = static_cast<int>(most - more.begin());
    double sum = 0, place = 0;
    for (int k = std::max(0, best - 1); k <= std::min(kSwings - 1, best + 1); ++k) {
      const double own = std::max(0.0, more[static_cast<std::size_t>(k)]);
      sum += own, place += own * frequency(k);
    }
    return place / sum;
  }

  using Bank = std::array<double, kBank>;
  // Powers of the recordings' gains at frequencies from `first` on, `step` (Hz) apart.
  Bank powers(double first, double step) const {
    Bank radians{}, power{};
    for (std::size_t k = 0; k < kBank; ++k) {
      radians[k] = 2 * kPi * (first + static_cast<double>(k) * step) / rate_;
    }
    for (const auto& series : series_) add_powers(series, radians, power);
    return power;
  }

  // A line's frequency (Hz), refined within +- `step`: the phase must hold over a whole recording.
  double refined(double line, double step) const {
    const double fine = 2 * step / (kBank - 1);
    const Bank power = powers(line - step, fine);
    const auto best = static_cast<std::size_t>(
        std::max_element(power.begin() + 1, power.end() - 1) - power.begin());
    const double bend = power[best - 1] - 2 * power[best] + power[best + 1];
    const double off = bend < 0 ? 0.5 * (power[best - 1] - power[best + 1]) / bend : 0;
    return line - step + (static_cast<double>(best) + std::clamp(off, -1.0, 1.0)) * fine;
  }

  // The strongest line of the flow's gain, relative to the mean power.
  double line(ScoreDetails* details) const {
    std::size_t longest = 1;
    for (const auto& series : series_) longest = std::max(longest, series.size());
    const double step = rate_ / (kOversampled * static_cast<double>(longest));
    const int count = static_cast<int>(kFastest / step);
    double most = 0, all = 0, at = step;
    for (int first = 1; first <= count; first += static_cast<int>(kBank)) {
      const Bank power = powers(first * step, step);
      for (int k = first; k < first + static_cast<int>(kBank) && k <= count; ++k) {
        const double one = power[static_cast<std::size_t>(k - first)];
        all += one / count;
        if (one <= most) continue;
        most = one, at = k * step;
      }
    }
    if (details != nullptr) details->pulsation = refined(at, step);
    return std::log(std::max(most, 1e-300) / std::max(all, 1e-300));
  }

  double rate_;
  int recording_ = -1;
  std::vector<std::vector<double>> series_, pieces_;
  std::vector<double> swing_;
  double whole_ = 0;  // pieces that swing_ is the sum of
};

}  // namespace

std::unique_ptr<ResidualStatistic> spectrum_statistic(const ScorePlan& plan) {
  return std::make_unique<Spectrum>(plan);
}

}  // namespace lilytank
