#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "smoothing/motion_model.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

// Answer of place, velocity and acceleration, after s, to a unit acceleration that fades.
MotionState answer(double memory, double s) {
  const double u = s / memory, e = std::exp(-u);
  // For small u the difference would cancel.
  const double place = u < 1e-3 ? u * u * (0.5 - u / 6 + u * u / 24) : u - 1 + e;
  return {memory * memory * place, -memory * std::expm1(-u), e};
}

MotionMatrix state_matrix(double memory, double s) {
  MotionMatrix F = MotionMatrix::Identity();
  F(0, 1) = s;
  F.col(2) = answer(memory, s);
  return F;
}

// What the filter knows of a frame: all coordinates share it.
struct Stage {
  MotionMatrix filtered;  // covariance with this frame's measurement
  MotionMatrix back;      // gain of the backward pass from the next frame
};

// Kalman's recursion of covariances. After some frames without a gap they no longer change; then
// nothing is computed any more.
class Covariance {
 public:
  Covariance(const MotionModel& model, double interval)
      : step_(transition(model, interval)), noise_(model.noise * model.noise) {
    // Place and velocity are unknown at first: far more than noise and acceleration explain.
    const double a = model.acceleration * model.acceleration;
    const double speed =
        noise_ / (interval * interval) + a * model.memory * model.memory + a * interval * interval;
    predicted_.setZero();
    predicted_.diagonal() << 1e6 * (noise_ + speed * interval * interval), 1e6 * speed, a;
  }
  // Takes in a frame: gain and innovation variance are then valid.
  void update(bool seen) {
    if (!seen) {
      filtered_ = predicted_;
      settled_ = false;
    } else if (!settled_) {
      variance_ = predicted_(0, 0) + noise_;
      gain_ = predicted_.col(0) / variance_;
      // Joseph's form, which stays symmetric and positive.
      MotionMatrix keep = MotionMatrix::Identity();
      keep.col(0) -= gain_;
      filtered_ = keep * predicted_ * keep.transpose() + noise_ * gain_ * gain_.transpose();
    }
  }
  // Goes to the next frame; true if what it then knows is new.
  bool predict(bool seen) {
    if (settled_) return false;
    const MotionMatrix next = step_.F * filtered_ * step_.F.transpose() + step_.Q;
    settled_ = seen && ((next - predicted_).array().abs() <= 1e-10 * next.array().abs()).all();
    predicted_ = next;
    return true;
  }
  const Transition& step() const { return step_; }
  const MotionMatrix& filtered() const { return filtered_; }
  const MotionMatrix& predicted() const { return predicted_; }
  const MotionState& gain() const { return gain_; }
  double variance() const { return variance_; }

 private:
  Transition step_;
  double noise_;
  bool settled_ = false;
  MotionMatrix predicted_, filtered_ = MotionMatrix::Zero();
  MotionState gain_ = MotionState::Zero();
  double variance_ = 1;
};

void store(AxisEstimate& axis, std::size_t f, const MotionState& s) {
  axis.value[f] = s[0], axis.velocity[f] = s[1], axis.acceleration[f] = s[2];
}

MotionState loaded(const AxisEstimate& axis, std::size_t f) {
  return {axis.value[f], axis.velocity[f], axis.acceleration[f]};
}

double root(double variance) {
  return std::sqrt(std::max(0.0, variance));
}

// The pass forward: filtered states into `out`; stages, and which one each frame has.
std::vector<Stage> filter(const Axes& axes, Covariance& covariance, AxesEstimate& out,
                          std::vector<std::size_t>& stage_of) {
  std::vector<Stage> stages;
  const MotionMatrix F = covariance.step().F;
  MotionState state[2] = {{axes.first[0], 0, 0}, {axes.count() > 1 ? axes.second[0] : 0, 0, 0}};
  for (std::size_t f = 0; f < axes.frames(); ++f) {
    const bool seen = axes.seen(f);
    covariance.update(seen);
    for (int k = 0; k < axes.count(); ++k) {
      const double z = (k == 0 ? axes.first : axes.second)[f];
      if (seen) state[k] += covariance.gain() * (z - state[k][0]);
      store(out.axis[k], f, state[k]);
      state[k] = F * state[k];
    }
    if (covariance.predict(seen)) {
      const MotionMatrix& P = covariance.filtered();
      const MotionMatrix& next = covariance.predicted();
      stages.push_back({P, P * F.transpose() * next.inverse()});
    }
    stage_of[f] = stages.size() - 1;
  }
  return stages;
}

// The pass back. What is known of a frame given all measurements is P; of the frame after, P1.
class BackwardPass {
 public:
  BackwardPass(const Axes& axes, const Transition& step, double interval, AxesEstimate& out)
      : axes_(axes), step_(step), interval_(interval), out_(out) {}

  void begin(std::size_t f, const Stage& stage) {
    P_ = stage.filtered;
    for (int k = 0; k < axes_.count(); ++k) later_[k] = loaded(out_.axis[k], f);
    store_deviations(f);
  }
  void step(std::size_t f, const Stage& stage) {
    const MotionMatrix& C = stage.back;
    for (int k = 0; k < axes_.count(); ++k) {
      const MotionState filtered = loaded(out_.axis[k], f);
      later_[k] = filtered + C * (later_[k] - step_.F * filtered);
      store(out_.axis[k], f, later_[k]);
    }
    const MotionMatrix P2 = P1_;
    P1_ = P_;
    // A sum of squares, unlike the shorter P + C (P1 - predicted) C', which can fall below zero.
    const MotionMatrix keep = MotionMatrix::Identity() - C * step_.F;
    P_ = keep * stage.filtered * keep.transpose() + C * (P1_ + step_.Q) * C.transpose();
    store_deviations(f);
    const MotionMatrix shared1 = C * P1_;  // of this frame and the next
    if (f + 2 == axes_.frames()) {
      accelerate(f + 1, f, f + 1, P_(1, 1) + P1_(1, 1) - 2 * shared1(1, 1));
    } else {
      const MotionMatrix shared2 = C * (back_ * P2);
      accelerate(f + 1, f, f + 2, P_(1, 1) + P2(1, 1) - 2 * shared2(1, 1));
    }
    if (f == 0) accelerate(0, 0, 1, P_(1, 1) + P1_(1, 1) - 2 * shared1(1, 1));
    back_ = C;
  }

 private:
  void store_deviations(std::size_t f) {
    out_.sd_value[f] = root(P_(0, 0));
    out_.sd_velocity[f] = root(P_(1, 1));
    out_.sd_acceleration[f] = root(P_(2, 2));
  }
  void accelerate(std::size_t f, std::size_t from, std::size_t to, double variance) {
    const double time = static_cast<double>(to - from) * interval_;
    for (int k = 0; k < axes_.count(); ++k) {
      AxisEstimate& axis = out_.axis[k];
      axis.acceleration[f] = (axis.velocity[to] - axis.velocity[from]) / time;
    }
    out_.sd_acceleration[f] = root(variance) / time;
  }
  const Axes& axes_;
  const Transition& step_;
  double interval_;
  AxesEstimate& out_;
  MotionState later_[2];
  MotionMatrix P_, P1_ = MotionMatrix::Zero(), back_ = MotionMatrix::Zero();
};

}  // namespace

AxesEstimate::AxesEstimate(const Axes& axes) {
  const std::vector<double> unknown(axes.frames(), kUndefined);
  sd_value = sd_velocity = sd_acceleration = unknown;
  for (int k = 0; k < axes.count(); ++k) axis[k] = {unknown, unknown, unknown};
}

Transition transition(const MotionModel& model, double interval) {
  const double memory = model.memory;
  // Gauss-Legendre over a part of the interval that is short against the memory, then doubling.
  int doublings = 0;
  double s = interval;
  for (; s > 0.25 * memory; s /= 2) ++doublings;
  constexpr double kNode[2] = {0.8611363115940526, 0.3399810435848563};
  constexpr double kWeight[2] = {0.3478548451374538, 0.6521451548625461};
  Transition t{state_matrix(memory, s), MotionMatrix::Zero()};
  for (int n = 0; n < 4; ++n) {
    const double node = n % 2 == 0 ? kNode[n / 2] : -kNode[n / 2];
    const MotionState g = answer(memory, s * (1 + node) / 2);
    t.Q += kWeight[n / 2] * s / 2 * g * g.transpose();
  }
  t.Q *= 2 * model.acceleration * model.acceleration / memory;
  for (; doublings > 0; --doublings) {
    t.Q += (t.F * t.Q * t.F.transpose()).eval();
    s *= 2;
    t.F = state_matrix(memory, s);
  }
  const double q = model.jolts * model.jolts * interval;
  t.Q(0, 0) += q * interval * interval / 3;
  t.Q(0, 1) += q * interval / 2, t.Q(1, 0) += q * interval / 2;
  t.Q(1, 1) += q;
  return t;
}

AxesEstimate smooth_kalman(const Axes& axes, const MotionModel& model, double interval) {
  AxesEstimate out(axes);
  if (axes.frames() == 0) return out;
  Covariance covariance(model, interval);
  std::vector<std::size_t> stage_of(axes.frames());
  const std::vector<Stage> stages = filter(axes, covariance, out, stage_of);
  std::size_t f = axes.frames() - 1;
  BackwardPass pass(axes, covariance.step(), interval, out);
  pass.begin(f, stages[stage_of[f]]);
  while (f-- > 0) pass.step(f, stages[stage_of[f]]);
  return out;
}

void add_innovations(const Axes& axes, const MotionModel& model, double interval,
                     Innovations& sums) {
  Covariance covariance(model, interval);
  const MotionMatrix F = covariance.step().F;
  MotionState state[2] = {{axes.first[0], 0, 0}, {axes.count() > 1 ? axes.second[0] : 0, 0, 0}};
  int started = 0;
  double variance = 0, log_variance = 0;
  for (std::size_t f = 0; f < axes.frames(); ++f) {
    const bool seen = axes.seen(f);
    covariance.update(seen);
    if (seen) ++started;
    if (seen && covariance.variance() != variance) {
      variance = covariance.variance();
      log_variance = std::log(variance);
    }
    for (int k = 0; k < axes.count(); ++k) {
      const double off = (k == 0 ? axes.first : axes.second)[f] - state[k][0];
      if (seen) state[k] += covariance.gain() * off;
      if (seen && started > 2) {
        sums.squares += off * off / variance;
        sums.log_variance += log_variance;
        ++sums.count;
      }
      state[k] = F * state[k];
    }
    covariance.predict(seen);
  }
}

}  // namespace lilytank
