// Lines in the spectra of innovations: pumps that pulsate, wakes that swing.
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnose/scatter.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kFastest = 6;        // Hz, of pulsation
constexpr double kOversampled = 1.5;  // frequencies in a line's width
constexpr int kPiece = 512;           // frames of a piece of a module's series

// |sum of series e^(-i w t)|^2 by a turning phasor.
double power_at(const std::vector<double>& series, double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  double pc = 1, ps = 0, re = 0, im = 0;
  for (const double v : series) {
    re += v * pc, im -= v * ps;
    const double next = pc * c - ps * s;
    ps = pc * s + ps * c, pc = next;
  }
  return re * re + im * im;
}

class Spectrum final : public ScatterPart {
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
  void tell(std::vector<double>& values, ScoreDetails* details) const override {
    values.push_back(line(details));
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

  // Series of one module across its slip, a piece at a time.
  void swing(const Seen& one) {
    std::vector<double>& piece = pieces_[one.module];
    const double slip = std::hypot(one.slip_x, one.slip_y);
    const double across =
        one.usable && slip > 0 ? (one.zy * one.slip_x - one.zx * one.slip_y) / slip : 0;
    piece.push_back(std::clamp(across, -8.0, 8.0));
    if (static_cast<int>(piece.size()) < kPiece) return;
    for (int k = 0; k < kSwings; ++k) {
      swing_[static_cast<std::size_t>(k)] += power_at(piece, 2 * kPi * frequency(k) / rate_);
    }
    piece.clear();
  }

  // The strongest line of the flow's gain over the mean.
  double line(ScoreDetails* details) const {
    std::size_t longest = 1;
    for (const auto& series : series_) longest = std::max(longest, series.size());
    const double step = rate_ / (kOversampled * static_cast<double>(longest));
    const int count = static_cast<int>(kFastest / step);
    double most = 0, all = 0;
    for (int k = 1; k <= count; ++k) {
      double power = 0;
      for (const auto& series : series_) power += power_at(series, 2 * kPi * k * step / rate_);
      all += power / count;
      if (power <= most) continue;
      most = power;
      if (details != nullptr) details->pulsation = k * step;
    }
    return std::log(std::max(most, 1e-300) / std::max(all, 1e-300));
  }

  double rate_;
  int recording_ = -1;
  std::vector<std::vector<double>> series_, pieces_;
  std::vector<double> swing_;
};

}  // namespace

std::unique_ptr<ScatterPart> spectrum_part(const ScorePlan& plan) {
  return std::make_unique<Spectrum>(plan);
}

}  // namespace lilytank
