#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "smoothing/motion_model.hpp"

namespace lilytank {
namespace {

constexpr int kMostDegree = 5;
using MomentMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostDegree + 1, kMostDegree + 1>;
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostDegree + 1, 1>;

// The weights that give the polynomial's value, slope and curvature in the middle of a window, for
// the offsets (in half windows) at which something was seen.
class Window {
 public:
  Window(int half, int degree) : half_(half), degree_(degree) {}

  // Fits frames [f - half, f + half] of `axes`; false if too few of them were seen.
  bool prepare(const Axes& axes, std::size_t f) {
    const auto n = static_cast<std::ptrdiff_t>(axes.frames());
    const auto middle = static_cast<std::ptrdiff_t>(f);
    from_ = std::max<std::ptrdiff_t>(0, middle - half_);
    to_ = std::min(n - 1, middle + half_);
    const bool whole = to_ - from_ == 2 * half_ && all_seen(axes);
    if (whole && ready_whole_) return true;
    ready_whole_ = false;
    rows_.clear(), frames_.clear();
    for (auto g = from_; g <= to_; ++g) {
      if (!axes.seen(static_cast<std::size_t>(g))) continue;
      frames_.push_back(g - middle);
      rows_.push_back(powers(static_cast<double>(g - middle) / half_));
    }
    if (static_cast<int>(rows_.size()) < degree_ + 2) return false;
    MomentMatrix m = MomentMatrix::Zero(degree_ + 1, degree_ + 1);
    for (const Coefficients& row : rows_) m += row * row.transpose();
    const Eigen::LDLT<MomentMatrix> solver(m);
    inverse_ = solver.solve(MomentMatrix::Identity(degree_ + 1, degree_ + 1));
    weights_.clear();
    for (const Coefficients& row : rows_) weights_.push_back(inverse_ * row);
    ready_whole_ = whole;
    return true;
  }
  // Value, slope, curvature in units of the half window.
  MotionState estimate(std::span<const double> z, std::size_t f) const {
    MotionState sum = MotionState::Zero();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const double v = z[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(f) + frames_[i])];
      sum += v * weights_[i].head<3>();
    }
    sum[2] *= 2;
    return sum;
  }
  // Their deviations where each measurement has deviation 1.
  MotionState deviation() const {
    return {std::sqrt(inverse_(0, 0)), std::sqrt(inverse_(1, 1)), 2 * std::sqrt(inverse_(2, 2))};
  }

 private:
  bool all_seen(const Axes& axes) const {
    for (auto g = from_; g <= to_; ++g) {
      if (!axes.seen(static_cast<std::size_t>(g))) return false;
    }
    return true;
  }
  Coefficients powers(double u) const {
    Coefficients p(degree_ + 1);
    double power = 1;
    for (int k = 0; k <= degree_; ++k, power *= u) p[k] = power;
    return p;
  }
  std::ptrdiff_t half_, from_ = 0, to_ = 0;
  int degree_;
  bool ready_whole_ = false;  // the weights are those of a window without gaps
  std::vector<std::ptrdiff_t> frames_;
  std::vector<Coefficients> rows_, weights_;
  MomentMatrix inverse_;
};

}  // namespace

int half_window(const SmoothingOptions& options, double interval) {
  const int wanted = static_cast<int>(std::lround((options.window / interval - 1) / 2));
  return std::max(wanted, (options.degree + 2) / 2);
}

AxesEstimate smooth_polynomial(const Axes& axes, const SmoothingOptions& options, double noise,
                               double interval) {
  const int half = half_window(options, interval);
  const double unit = half * interval;  // s
  Window window(half, options.degree);
  AxesEstimate out(axes);
  for (std::size_t f = 0; f < axes.frames(); ++f) {
    if (!window.prepare(axes, f)) continue;
    for (int k = 0; k < axes.count(); ++k) {
      const MotionState s = window.estimate(k == 0 ? axes.first : axes.second, f);
      out.axis[k].value[f] = s[0];
      out.axis[k].velocity[f] = s[1] / unit;
      out.axis[k].acceleration[f] = s[2] / (unit * unit);
    }
    const MotionState d = noise * window.deviation();
    out.sd_value[f] = d[0];
    out.sd_velocity[f] = d[1] / unit;
    out.sd_acceleration[f] = d[2] / (unit * unit);
  }
  return out;
}

}  // namespace lilytank
