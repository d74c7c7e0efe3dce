#include "proof/baseline_method.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "effects/features.hpp"
#include "lilytank/math.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kStride = 2;               // frames from one triple to the next
constexpr double kSignificant = 4;       // t of a term that is kept
constexpr double kJerk = 6, kSpin = 60;  // m/s^2, rad/s^2: beyond them something was hit

// One module in three frames in a row.
struct Triple {
  double x, y, theta, vx, vy, omega, ax, ay, alpha;
};

bool triple_at(const Track& track, int frame, double h, Triple& out) {
  const int i = frame - track.first;
  if (i < 1 || i + 1 >= static_cast<int>(track.x.size())) return false;
  const auto k = static_cast<std::size_t>(i);
  const auto differences = [&](const std::vector<double>& of, double& value, double& rate,
                               double& second) {
    value = of[k], rate = (of[k + 1] - of[k - 1]) / (2 * h);
    second = (of[k + 1] - 2 * of[k] + of[k - 1]) / (h * h);
    return std::isfinite(second);
  };
  return differences(track.x, out.x, out.vx, out.ax) &&
         differences(track.y, out.y, out.vy, out.ay) &&
         differences(track.theta, out.theta, out.omega, out.alpha);
}

// Sums of a regression of all modules' accelerations.
class Regression {
 public:
  explicit Regression(const ScorePlan& plan) : plan_(plan) {}

  void add(const Recording& recording) {
    Model model = plan_.model;
    model.module.count = static_cast<int>(recording.tracks.size());
    Features features(plan_.effects, plan_.beside, model);
    if (normal_.size() == 0) {
      const auto n = static_cast<Eigen::Index>(features.size());
      normal_ = Matrix::Zero(n, n), right_ = Vector::Zero(n);
    }
    const double h = 1 / recording.rate;
    std::vector<Triple> all(recording.tracks.size());
    for (int f = 1; f + 1 < recording.frames; f += kStride) {
      bool seen = true;
      for (std::size_t i = 0; i < all.size() && seen; ++i) {
        seen = triple_at(recording.tracks[i], f, h, all[i]);
      }
      if (seen) add(model, features, all, recording.time(f));
    }
  }
  const Matrix& normal() const { return normal_; }
  const Vector& right() const { return right_; }
  double variance() const { return square_ / std::max(1.0, count_); }

 private:
  void add(const Model& model, Features& features, const std::vector<Triple>& all, double time) {
    features.find(kinematics_of(all), {.time = time, .gusts = false, .expected = true});
    const double m = model.module.mass, inertia = model.module.inertia();
    Vector row(right_.size());
    // Turning counts by the length that makes its variance like that of places.
    const double arm = 0.3 * model.module.side;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Wrench& base = features.baseline(i);
      const double left[3] = {all[i].ax - base.fx / m, all[i].ay - base.fy / m,
                              arm * (all[i].alpha - base.torque / inertia)};
      if (std::max(std::fabs(left[0]), std::fabs(left[1])) > kJerk ||
          std::fabs(left[2]) > arm * kSpin) {
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t f = 0; f < features.size(); ++f) {
          const Wrench& w = features.at(f, i);
          row(static_cast<Eigen::Index>(f)) = axis == 0   ? w.fx / m
                                              : axis == 1 ? w.fy / m
                                                          : arm * w.torque / inertia;
        }
        normal_.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right_ += left[axis] * row, square_ += left[axis] * left[axis], count_ += 1;
      }
    }
  }
  Kinematics kinematics_of(const std::vector<Triple>& all) {
    const std::size_t n = all.size();
    for (auto* of : {&x_, &y_, &c_, &s_, &vx_, &vy_, &omega_}) of->resize(n);
    covered_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const Rot r = rotation(all[i].theta);
      x_[i] = all[i].x, y_[i] = all[i].y, c_[i] = r.c, s_[i] = r.s;
      vx_[i] = all[i].vx, vy_[i] = all[i].vy, omega_[i] = all[i].omega;
    }
    return {x_, y_, c_, s_, vx_, vy_, omega_, covered_, static_cast<int>(n)};
  }

  const ScorePlan& plan_;
  std::vector<double> x_, y_, c_, s_, vx_, vy_, omega_;
  std::vector<std::uint8_t> covered_;
  Matrix normal_;
  Vector right_;
  double square_ = 0, count_ = 0;
};

}  // namespace

KeptTerm sparse_regression(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  Regression sums(plan);
  for (const Recording& one : recordings) sums.add(one);
  const Matrix normal = sums.normal().selfadjointView<Eigen::Lower>();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index f = 0; f < normal.rows(); ++f) {
    if (normal(f, f) > 0) kept.push_back(f);
  }
  Vector t;
  while (!kept.empty()) {
    Matrix part = normal(kept, kept);
    part.diagonal() *= 1 + 1e-9;
    const Matrix inverse = symmetric_inverse(part);
    const Vector coefficient = inverse * sums.right()(kept);
    t = coefficient.cwiseQuotient(
        (sums.variance() * inverse.diagonal()).cwiseMax(1e-300).cwiseSqrt());
    Eigen::Index weakest = 0;
    if (t.cwiseAbs().minCoeff(&weakest) > kSignificant) break;
    kept.erase(kept.begin() + weakest);
  }
  KeptTerm out;
  if (kept.empty()) return out;
  Eigen::Index strongest = 0;
  out.t = t.cwiseAbs().maxCoeff(&strongest);
  // Components count as their effects do.
  Eigen::Index at = 0;
  for (std::size_t e = 0; e < plan.effects.size(); ++e) {
    const Effect& effect = plan.effects[e];
    for (std::size_t c = 0; effect.scored && c < effect.paths.size(); ++c, ++at) {
      if (at == kept[static_cast<std::size_t>(strongest)]) out.effect = static_cast<int>(e);
    }
  }
  return out;
}

}  // namespace lilytank
