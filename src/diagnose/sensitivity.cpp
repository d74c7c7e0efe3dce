#include "diagnose/sensitivity.hpp"

#include <algorithm>

#include "analysis/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Products are summed in one frame of so many: sums of a hundred thousand are known well enough.
constexpr int kEvery = 3;
constexpr std::size_t kFlush = 512;  // passings whose products are summed in single precision
constexpr double kLeastLeft = 1e-3;  // share of an information that nuisances leave at least

}  // namespace

// One coordinate of all features over one frame. `found`: the innovation by its variance, 0 if it
// does not count; `weight`: one over the variance, likewise.
struct Sensitivities::Axis {
  float dt, keep, gain_x, gain_v, found, weight;
  bool taken;  // its products are summed
};

Sensitivities::Sensitivities(std::size_t features, std::size_t modules,
                             std::size_t partners)
    : features_(features),
      partners_(partners),
      score_(features),
      information_(features),
      at_(features),
      recent_(features * partners),
      shared_(features * partners) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) of->assign(features * modules, 0.0f);
}

void Sensitivities::forget(std::size_t module) {
  for (auto* of : {&x_, &vx_, &y_, &vy_, &t_, &w_}) {
    const auto begin = of->begin() + static_cast<std::ptrdiff_t>(module * features_);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(features_), 0.0f);
  }
}

void Sensitivities::pass_axis(const Axis& a, const float* __restrict push, float* __restrict x,
                              float* __restrict v) {
  const float half = 0.5f * a.dt;
  float* __restrict now = at_.data();
  double* __restrict score = score_.data();
  double* __restrict information = information_.data();
  for (std::size_t f = 0; f < features_; ++f) {
    const float at = x[f] + a.dt * (v[f] + half * push[f]);
    const float speed = a.keep * v[f] + a.dt * push[f];
    now[f] = at;
    score[f] += static_cast<double>(a.found * at);
    information[f] += static_cast<double>(a.weight * at * at);
    x[f] = at - a.gain_x * at, v[f] = speed - a.gain_v * at;
  }
  if (a.weight > 0 && partners_ > 0) {
    passed_ += 1;
    if (a.taken) take_up(a);
  }
}

void Sensitivities::take_up(const Axis& a) {
  const float* __restrict now = at_.data();
  for (std::size_t n = 0; n < partners_; ++n) {
    const float weight = a.weight * now[features_ - partners_ + n];
    if (weight == 0) continue;
    float* __restrict sum = &recent_[n * features_];
    for (std::size_t f = 0; f < features_; ++f) sum[f] += weight * now[f];
  }
  if (++taken_ % kFlush == 0) flush();
}

void Sensitivities::flush() {
  for (std::size_t k = 0; k < shared_.size(); ++k) {
    shared_[k] += static_cast<double>(recent_[k]);
    recent_[k] = 0;
  }
}

void Sensitivities::pass(std::size_t module, const Pushes& pushes, const PredictedFrame& frame,
                         std::size_t i, double loss, bool told) {
  const std::size_t at = module * features_;
  const auto dt = static_cast<float>(frame.interval);
  const auto axis = [&](double innovation, double sd, double gain_x, double gain_v) {
    const double weight = told ? 1 / (sd * sd) : 0;
    return Axis{dt,
                static_cast<float>(1 - loss * frame.interval),
                static_cast<float>(gain_x),
                static_cast<float>(gain_v),
                told ? static_cast<float>(weight * innovation) : 0.0f,
                static_cast<float>(weight),
                frame.frame % kEvery == 0};
  };
  const auto place = [&](double innovation) {
    return axis(innovation, frame.sd_x[i], frame.gain_x[i], frame.gain_v[i]);
  };
  pass_axis(place(frame.dx[i]), pushes.x.data(), &x_[at], &vx_[at]);
  pass_axis(place(frame.dy[i]), pushes.y.data(), &y_[at], &vy_[at]);
  pass_axis(axis(frame.dtheta[i], frame.sd_theta[i], frame.gain_theta[i], frame.gain_omega[i]),
            pushes.turn.data(), &t_[at], &w_[at]);
}

Matrix Sensitivities::products(Eigen::Index count) const {
  const auto features = static_cast<Eigen::Index>(features_);
  const double all = taken_ > 0 ? static_cast<double>(passed_) / static_cast<double>(taken_) : 0;
  Matrix out(features, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto partner = partners_ - static_cast<std::size_t>(count - k);
    for (Eigen::Index f = 0; f < features; ++f) {
      const std::size_t at = partner * features_ + static_cast<std::size_t>(f);
      out(f, k) = all * (shared_[at] + static_cast<double>(recent_[at]));
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
    const Matrix own = shared.bottomRows(n);
    const Matrix normal = 0.5 * (own + own.transpose()) + known;
    const Eigen::Map<const Vector> scores(score_.data() + features - n, n);
    const Matrix solved = solve_symmetric(normal, Matrix(shared.transpose()));
    blamed = solved.transpose() * scores;
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

Matrix Sensitivities::correlations(const Matrix& known) const {
  const Eigen::Index n = known.rows(), told = static_cast<Eigen::Index>(features_) - n;
  const Matrix all = products(static_cast<Eigen::Index>(features_));
  const Matrix shared = all.topRightCorner(told, n);
  const Matrix normal = all.bottomRightCorner(n, n) + known;
  const Matrix left = all.topLeftCorner(told, told) -
                      shared * solve_symmetric(normal, Matrix(shared.transpose()));
  const Vector size = left.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Matrix out = size.cwiseInverse().asDiagonal() * (0.5 * (left + left.transpose())) *
               size.cwiseInverse().asDiagonal();
  for (Eigen::Index k = 0; k < told; ++k) {
    if (left(k, k) > kLeastLeft * all(k, k)) continue;
    out.row(k).setZero(), out.col(k).setZero();
  }
  out.diagonal().setOnes();
  return out;
}

}  // namespace lilytank
