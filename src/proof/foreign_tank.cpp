#include "proof/foreign_tank.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#ifdef LILYTANK_HAS_BOX2D
#include <box2d/box2d.h>

#include "forces/force_sum.hpp"
#include "lilytank/start.hpp"
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

constexpr float kUnits = 100;  // lengths in centimetres: the library's tolerances suit such bodies
constexpr int kVelocityRounds = 8, kPositionRounds = 3;  // the library's advice
constexpr double kCornerEvery = 0.015;  // m: the wall departs from the circle by 0.1 mm
constexpr double kFastest = 20;         // m/s; beyond it a tank counts as diverged
constexpr int kFiner = 4;               // cells for each one of the field

b2Vec2 in_units(double x, double y) {
  return {kUnits * static_cast<float>(x), kUnits * static_cast<float>(y)};
}

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

class ForeignTank {
 public:
  ForeignTank(Model model, std::uint64_t seed)
      : model_(std::move(model)),
        seed_(seed),
        forces_(model_),
        now_(model_.bodies()),
        middle_(model_.bodies()),
        wrenches_(static_cast<std::size_t>(model_.bodies())),
        world_({0, 0}) {
    world_.SetAllowSleeping(false);
    const State start = initial_state(model_, seed);
    b2FixtureDef surface;
    surface.friction = static_cast<float>(model_.contact.friction);
    surface.restitution = static_cast<float>(model_.contact.restitution);
    surface.restitutionThreshold = kUnits * static_cast<float>(model_.contact.restitution_speed);
    add_wall(surface);
    for (int i = 0; i < model_.bodies(); ++i) add_body(start, i, surface);
    read();
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
      middle_.omega[i] = now_.omega[i] + h * w.torque / inertia(i);
    }
    add_forces(middle_, h);
    for (std::size_t i = 0; i < wrenches_.size(); ++i) {
      bodies_[i]->ApplyForceToCenter(in_units(wrenches_[i].fx, wrenches_[i].fy), true);
      bodies_[i]->ApplyTorque(kUnits * kUnits * static_cast<float>(wrenches_[i].torque), true);
    }
    world_.Step(static_cast<float>(model_.dt), kVelocityRounds, kPositionRounds);
    ++step_;
    return read();
  }

  void append_to(Trajectory& out, double since) const {
    out.bodies = model_.bodies(), out.modules = model_.module.count;
    out.time.push_back(time() - since);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      out.x.push_back(static_cast<float>(now_.x[i])),
          out.y.push_back(static_cast<float>(now_.y[i]));
      out.theta.push_back(static_cast<float>(angle_of({now_.c[i], now_.s[i]})));
    }
  }
  double time() const { return static_cast<double>(step_) * model_.dt; }

 private:
  bool square(std::size_t i) const { return static_cast<int>(i) < model_.module.count; }
  double mass(std::size_t i) const { return square(i) ? model_.module.mass : model_.ball.mass; }
  double inertia(std::size_t i) const {
    return square(i) ? model_.module.inertia()
                     : 0.5 * model_.ball.mass * model_.ball.radius * model_.ball.radius;
  }

  void add_forces(const Moving& at, double later) {
    const StepContext now{.time = time() + later,
                          .step = step_,
                          .gust = step_ / model_.steps_per_tick,
                          .seed = seed_,
                          .field = model_.field.get()};
    forces_(at.view(model_.module.count), now, wrenches_);
  }

  void add_wall(b2FixtureDef surface) {
    const double radius = model_.tank.radius;
    const int corners = static_cast<int>(std::ceil(2 * kPi * radius / kCornerEvery));
    std::vector<b2Vec2> ring;
    for (int k = 0; k < corners; ++k) {  // clockwise: what is solid lies outside
      const Rot way = rotation(-2 * kPi * k / corners);
      ring.push_back(in_units(radius * way.c, radius * way.s));
    }
    b2ChainShape shape;
    shape.CreateLoop(ring.data(), corners);
    surface.shape = &shape;
    const b2BodyDef still;
    world_.CreateBody(&still)->CreateFixture(&surface);
  }

  void add_body(const State& start, int number, b2FixtureDef surface) {
    const auto i = static_cast<std::size_t>(number);
    Decay decay;  // of a step, as rates: the library divides by 1 + step * rate
    for (const ActiveForce& force : model_.forces) {
      const Decay d = force.term->decay(force.p, model_.dt);
      decay.linear *= d.linear, decay.angular *= d.angular;
    }
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = in_units(start.x[i], start.y[i]);
    def.angle = static_cast<float>(angle_of({start.c[i], start.s[i]}));
    def.linearDamping = static_cast<float>(-log_portable(decay.linear) / model_.dt);
    def.angularDamping = static_cast<float>(-log_portable(decay.angular) / model_.dt);
    b2Body* body = world_.CreateBody(&def);
    b2PolygonShape box;
    b2CircleShape disc;
    // Polygons are kept a skin apart; without it they are as wide as they should be.
    const float half = kUnits * static_cast<float>(0.5 * model_.module.side) - b2_polygonRadius;
    box.SetAsBox(half, half);
    disc.m_radius = kUnits * static_cast<float>(model_.ball.radius);
    surface.shape = square(i) ? static_cast<const b2Shape*>(&box) : &disc;
    surface.density = 1;
    body->CreateFixture(&surface);
    b2MassData weight;
    weight.mass = static_cast<float>(mass(i));
    weight.center.SetZero();
    weight.I = kUnits * kUnits * static_cast<float>(inertia(i));
    body->SetMassData(&weight);
    bodies_.push_back(body);
  }

  bool read() {
    bool good = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const b2Transform& t = bodies_[i]->GetTransform();
      const b2Vec2& v = bodies_[i]->GetLinearVelocity();
      const auto metres = [](float value) { return static_cast<double>(value / kUnits); };
      now_.x[i] = metres(t.p.x), now_.y[i] = metres(t.p.y);
      now_.c[i] = static_cast<double>(t.q.c), now_.s[i] = static_cast<double>(t.q.s);
      now_.vx[i] = metres(v.x), now_.vy[i] = metres(v.y);
      now_.omega[i] = static_cast<double>(bodies_[i]->GetAngularVelocity());
      good = good && std::hypot(now_.vx[i], now_.vy[i]) <= kFastest &&
             std::hypot(now_.x[i], now_.y[i]) <= model_.tank.radius;
    }
    return good;
  }

  Model model_;
  std::uint64_t seed_;
  ForceSum forces_;
  Moving now_, middle_;
  std::vector<Wrench> wrenches_;
  b2World world_;
  std::vector<b2Body*> bodies_;
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
