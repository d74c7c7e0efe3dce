#include "filter/sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// s between frames in which products are summed: sensitivities hardly change meanwhile.
constexpr double kApart = 0.3;
constexpr std::size_t kFlush = 768;  // passings whose sums are in single precision
constexpr double kLeastLeft = 1e-3;  // share of an information that nuisances leave at least

// Precision of the nuisances' amplitudes, by their products and what is known before.
Matrix precision(const Matrix& products, const Matrix& known) {
  const Matrix own = products.bottomRows(known.rows());
  return 0.5 * (own + own.transpose()) + known;
}

}  // namespace

void Pushes::of_members(const PredictedFrame& frame, const PredictedAssembly& assembly,
                        const std::vector<Pushes>& each) {
  for (auto* of : {&x, &y, &turn}) std::fill(of->begin(), of->end(), 0.0f);
  const double mass = frame.model->module.mass, inertia = frame.model->module.inertia();
  const auto share = static_cast<float>(mass / assembly.mass);
  const auto own = static_cast<float>(inertia / assembly.inertia);
  for (const int member : assembly.members) {
    const auto i = static_cast<std::size_t>(member);
    const Pushes& push = each[i];
    const auto by_y = static_cast<float>(mass / assembly.inertia * (frame.now.x[i] - assembly.x));
    const auto by_x = static_cast<float>(mass / assembly.inertia * (frame.now.y[i] - assembly.y));
    for (std::size_t f = 0; f < x.size(); ++f) {
      x[f] += share * push.x[f], y[f] += share * push.y[f];
      turn[f] += own * push.turn[f] + by_y * push.y[f] - by_x * push.x[f];
    }
  }
}

Sensitivities::Sensitivities(std::size_t features, std::size_t bodies, std::size_t partners)
    : features_(features),
      partners_(partners),
      wide_(Pushes::in_lanes(features)),
      score_(wide_),
      information_(wide_),
      shared_(partners * wide_),
      recent_score_(wide_),
      recent_information_(wide_),
      recent_shared_(partners * wide_),
      rows_(kRowsAtOnce * wide_),
      now_(wide_) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) of->assign(wide_ * bodies, 0.0f);
}

void Sensitivities::forget(std::size_t body) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) {
    const auto begin = of->begin() + static_cast<std::ptrdiff_t>(body * wide_);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(wide_), 0.0f);
  }
}

void Sensitivities::pass_axis(const FeatureAxis& axis, bool summed, const float* push, float* x,
                              float* v) {
  const bool usable = axis.weight > 0;
  float* now = usable && summed ? &rows_[kept_ * wide_] : now_.data();
  pass_features(axis, wide_, push, x, v, now, recent_score_.data(), recent_information_.data());
  if (!usable) return;
  if (summed) {
    taken_ += 1;
    if (++kept_ == kRowsAtOnce) add_rows();
  }
  if (++passed_ % kFlush == 0) flush();
}

void Sensitivities::add_rows() {
  std::fill(rows_.begin() + static_cast<std::ptrdiff_t>(kept_ * wide_), rows_.end(), 0.0f);
  add_products(rows_.data(), wide_, features_ - partners_, partners_, recent_shared_.data());
  kept_ = 0;
}

void Sensitivities::flush() {
  move_sums(recent_score_.data(), wide_, score_.data());
  move_sums(recent_information_.data(), wide_, information_.data());
  move_sums(recent_shared_.data(), recent_shared_.size(), shared_.data());
}

void Sensitivities::pass(std::size_t body, const Pushes& pushes, const PredictedFrame& frame,
                         const Innovation& seen, double loss, bool usable) {
  const std::size_t at = body * wide_;
  const auto dt = static_cast<float>(frame.interval);
  const auto axis = [&](double innovation, double sd, double gain_x, double gain_v) {
    const double weight = usable ? 1 / (sd * sd) : 0;
    return FeatureAxis{dt,
                       static_cast<float>(1 - loss * frame.interval),
                       static_cast<float>(gain_x),
                       static_cast<float>(gain_v),
                       usable ? static_cast<float>(weight * innovation) : 0.0f,
                       static_cast<float>(weight)};
  };
  const auto place = [&](double innovation) {
    return axis(innovation, seen.sd_x, seen.gain_x, seen.gain_v);
  };
  const int every = std::max(1, static_cast<int>(std::lround(kApart / frame.interval)));
  const bool summed = partners_ > 0 && frame.frame % every == 0;
  pass_axis(place(seen.dx), summed, pushes.x.data(), &x_[at], &vx_[at]);
  pass_axis(place(seen.dy), summed, pushes.y.data(), &y_[at], &vy_[at]);
  pass_axis(axis(seen.dtheta, seen.sd_theta, seen.gain_theta, seen.gain_omega), summed,
            pushes.turn.data(), &t_[at], &w_[at]);
}

void Sensitivities::finish() {
  if (kept_ > 0) add_rows();
  flush();
}

Matrix Sensitivities::products(Eigen::Index count) const {
  const auto features = static_cast<Eigen::Index>(features_);
  const double all = taken_ > 0 ? static_cast<double>(passed_) / static_cast<double>(taken_) : 0;
  const std::size_t first = features_ - partners_;
  Matrix out(features, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t partner = features_ - static_cast<std::size_t>(count - k);
    for (Eigen::Index f = 0; f < features; ++f) {
      const auto [early, late] = std::minmax({partner, static_cast<std::size_t>(f)});
      out(f, k) = all * shared_[(late - first) * wide_ + early];
    }
  }
  return out;
}

std::vector<Sensitivities::Amplitude> Sensitivities::amplitudes(const Matrix& known) const {
  const auto features = static_cast<Eigen::Index>(features_);
  const Eigen::Index n = known.rows();
  std::vector<Amplitude> out(static_cast<std::size_t>(features - n));
  Vector blamed = Vector::Zero(features), taken = blamed;
  if (n > 0) {
    const Matrix shared = products(n);
    const Matrix solved = solve_symmetric(precision(shared, known), Matrix(shared.transpose()));
    blamed = solved.transpose() * last_scores(n);
    taken = (shared.transpose().array() * solved.array()).colwise().sum().transpose().matrix();
  }
  for (std::size_t f = 0; f < out.size(); ++f) {
    if (!(information_[f] > 0)) continue;
    const auto k = static_cast<Eigen::Index>(f);
    const double left = std::max(information_[f] - taken(k), kLeastLeft * information_[f]);
    out[f] = {(score_[f] - blamed(k)) / left, left};
  }
  return out;
}

double Sensitivities::absorbed(const Matrix& known) const {
  const Eigen::Index n = known.rows();
  if (n == 0) return 0;
  const Vector scores = last_scores(n);
  return scores.dot(solve_symmetric(precision(products(n), known), scores));
}

Eigen::Map<const Vector> Sensitivities::last_scores(Eigen::Index count) const {
  return {score_.data() + static_cast<Eigen::Index>(features_) - count, count};
}

Matrix Sensitivities::informations(const Matrix& known) const {
  const Eigen::Index n = known.rows(), scored = static_cast<Eigen::Index>(features_) - n;
  const Matrix all = products(static_cast<Eigen::Index>(features_));
  const Matrix shared = all.topRightCorner(scored, n);
  const Matrix normal = all.bottomRightCorner(n, n) + known;
  const Matrix left = all.topLeftCorner(scored, scored) -
                      shared * solve_symmetric(normal, Matrix(shared.transpose()));
  Matrix out = 0.5 * (left + left.transpose());
  for (Eigen::Index k = 0; k < scored; ++k) {
    if (out(k, k) > kLeastLeft * all(k, k)) continue;
    out.row(k).setZero(), out.col(k).setZero();
  }
  return out;
}

}  // namespace lilytank
