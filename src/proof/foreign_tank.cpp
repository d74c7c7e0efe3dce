#include "proof/foreign_tank.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#ifdef LILYTANK_HAS_BOX2D
#include "forces/force_sum.hpp"
#include "lilytank/start.hpp"
#include "proof/box2d_bodies.hpp"
#endif

namespace lilytank {

void round_to_pixels(std::vector<Recording>& recordings) {
  constexpr double kPixel = 5e-4, kAngle = 0.01;
  const auto round_all = [](std::vector<double>& values, double to) {
    for (double& v : values) v = to * std::round(v / to);  // what is not a number stays so
  };
  for (Recording& recording : recordings) {
    for (Track& track : recording.tracks) {
      round_all(track.x, kPixel), round_all(track.y, kPixel), round_all(track.theta, kAngle);
    }
  }
}

#ifdef LILYTANK_HAS_BOX2D
namespace {

constexpr double kCornerEvery = 0.015;  // m: the wall departs from the circle by 0.1 mm
constexpr double kFastest = 20;         // m/s; beyond it a tank counts as diverged
constexpr int kFiner = 4;               // cells for each one of the field

// Weights of four neighbours by Catmull and Rom's cubic polynomial.
std::array<double, 4> cubic(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3), 0.5 * (t + 4 * t2 - 3 * t3),
          0.5 * (t3 - t2)};
}

// The field through the same cell centres, by cubic polynomials along either axis.
FlowField by_cubics(const FlowField& coarse) {
  const int n = coarse.cells(), fine = kFiner * n;
  std::vector<FlowSample> out;
  const auto clamped = [&](int i) { return std::clamp(i, 0, n - 1); };
  for (int k = 0; k < fine * fine; ++k) {
    const double gx = (k % fine + 0.5) / kFiner - 0.5, gy = (k / fine + 0.5) / kFiner - 0.5;
    const int ix = static_cast<int>(std::floor(gx)), iy = static_cast<int>(std::floor(gy));
    const auto wx = cubic(gx - ix), wy = cubic(gy - iy);
    FlowSample sum;
    for (int b = 0; b < 4; ++b) {
      for (int a = 0; a < 4; ++a) {
        const FlowSample& s =
            coarse
                .samples()[static_cast<std::size_t>(clamped(iy + b - 1) * n + clamped(ix + a - 1))];
        const double w = wx[static_cast<std::size_t>(a)] * wy[static_cast<std::size_t>(b)];
        sum.mu_x += w * s.mu_x, sum.mu_y += w * s.mu_y;
        sum.sigma_x += w * s.sigma_x, sum.sigma_y += w * s.sigma_y;
      }
    }
    sum.sigma_x = std::max(sum.sigma_x, 0.0), sum.sigma_y = std::max(sum.sigma_y, 0.0);
    out.push_back(sum);
  }
  const std::vector<bool> all(out.size(), true);
  return FlowField(fine, coarse.extent(), std::move(out), all, Interpolation::bilinear);
}

// Poses and twists of all bodies, as forces read them.
struct Moving {
  explicit Moving(int count) : covered(static_cast<std::size_t>(count), 0) {
    for (auto* of : {&x, &y, &c, &s, &vx, &vy, &omega}) of->resize(covered.size());
  }
  Kinematics view(int modules) const { return {x, y, c, s, vx, vy, omega, covered, modules}; }
  std::vector<double> x, y, c, s, vx, vy, omega;
  std::vector<std::uint8_t> covered;
};

Box2dBodies::Damping damping_of(const Model& model) {
  const Decay decay = total_decay(model.forces, model.dt);
  return {-log_portable(decay.linear) / model.dt, -log_portable(decay.angular) / model.dt};
}

int wall_corners(const Model& model) {
  return static_cast<int>(std::ceil(2 * kPi * model.tank.radius / kCornerEvery));
}

class ForeignTank {
 public:
  ForeignTank(Model model, std::uint64_t seed)
      : model_(std::move(model)),
        seed_(seed),
        forces_(model_),
        now_(model_.bodies()),
        middle_(model_.bodies()),
        wrenches_(static_cast<std::size_t>(model_.bodies())),
        bodies_(model_, initial_state(model_, seed), model_.tank.radius, wall_corners(model_),
                damping_of(model_)) {
    bodies_.read(now_);
  }

  /// False if it diverged.
  bool step() {
    const double h = 0.5 * model_.dt;
    add_forces(now_, 0);
    for (std::size_t i = 0; i < wrenches_.size(); ++i) {
      const Wrench& w = wrenches_[i];
      const double m = mass(i), turn = h * now_.omega[i];
      middle_.x[i] = now_.x[i] + h * now_.vx[i], middle_.y[i] = now_.y[i] + h * now_.vy[i];
      middle_.c[i] = now_.c[i] - turn * now_.s[i], middle_.s[i] = now_.s[i] + turn * now_.c[i];
      const double length = std::hypot(middle_.c[i], middle_.s[i]);
      middle_.c[i] /= length, middle_.s[i] /= length;
      middle_.vx[i] = now_.vx[i] + h * w.fx / m, middle_.vy[i] = now_.vy[i] + h * w.fy / m;
      middle_.omega[i] =
          now_.omega[i] + h * w.torque / Box2dBodies::inertia(model_, static_cast<int>(i));
    }
    add_forces(middle_, h);
    bodies_.push(wrenches_);
    bodies_.step(model_.dt);
    ++step_;
    bodies_.read(now_);
    return good();
  }

  void append_to(Trajectory& out, double since) const {
    out.bodies = model_.bodies(), out.modules = model_.module.count;
    out.time.push_back(time() - since);
    for (std::size_t i = 0; i < now_.x.size(); ++i) {
      out.x.push_back(static_cast<float>(now_.x[i])),
          out.y.push_back(static_cast<float>(now_.y[i]));
      out.theta.push_back(static_cast<float>(angle_of({now_.c[i], now_.s[i]})));
    }
  }
  double time() const { return static_cast<double>(step_) * model_.dt; }

 private:
  double mass(std::size_t i) const {
    return static_cast<int>(i) < model_.module.count ? model_.module.mass : model_.ball.mass;
  }

  void add_forces(const Moving& at, double later) {
    const StepContext now{.time = time() + later,
                          .step = step_,
                          .gust = step_ / model_.steps_per_tick,
                          .seed = seed_,
                          .field = model_.field.get()};
    forces_(at.view(model_.module.count), now, wrenches_);
  }

  bool good() const {
    for (std::size_t i = 0; i < now_.x.size(); ++i) {
      const bool slow = std::hypot(now_.vx[i], now_.vy[i]) <= kFastest;
      if (!slow || !(std::hypot(now_.x[i], now_.y[i]) <= model_.tank.radius)) return false;
    }
    return true;
  }

  Model model_;
  std::uint64_t seed_;
  ForceSum forces_;
  Moving now_, middle_;
  std::vector<Wrench> wrenches_;
  Box2dBodies bodies_;
  std::int64_t step_ = 0;
};

}  // namespace

OtherEngine foreign_engine() {
  return [](const Model& model, double settle, double seconds,
            std::uint64_t seed) -> std::optional<Trajectory> {
    Model own = model;
    own.field = std::make_shared<const FlowField>(by_cubics(*model.field));
    ForeignTank tank(std::move(own), seed);
    Trajectory out;
    while (tank.time() < settle - 1e-9) {
      if (!tank.step()) return std::nullopt;
    }
    const double since = tank.time();
    tank.append_to(out, since);
    while (tank.time() < since + seconds - 1e-9) {
      if (!tank.step()) return std::nullopt;
      tank.append_to(out, since);
    }
    return out;
  };
}
#else
OtherEngine foreign_engine() {
  throw InputError("this program was built without Box2D, which --foreign needs");
}
#endif

}  // namespace lilytank
