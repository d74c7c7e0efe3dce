// The bodies of a model in Box2D 2.4: squares and discs within a round wall. Lengths are in
// centimetres there: the library's fixed tolerances suit bodies of a few units.
#pragma once
#include <box2d/box2d.h>

#include <span>
#include <vector>

#include "lilytank/force.hpp"
#include "lilytank/model.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// Units are SI outside.
class Box2dBodies {
 public:
  /// Rates at which velocities and spins are lost, 1/s: the library divides by 1 + step * rate.
  struct Damping {
    double linear = 0, angular = 0;
  };
  /// Bodies at the poses of `start`, at rest. `wall`: radius of the polygon that stands for the
  /// wall, m.
  Box2dBodies(const Model& model, const State& start, double wall, int corners,
              const Damping& damping)
      : world_({0, 0}) {
    world_.SetAllowSleeping(false);
    b2FixtureDef surface;
    surface.friction = static_cast<float>(model.contact.friction);
    surface.restitution = static_cast<float>(model.contact.restitution);
    surface.restitutionThreshold = kUnits * static_cast<float>(model.contact.restitution_speed);
    add_wall(wall, corners, surface);
    for (int i = 0; i < model.bodies(); ++i) add(model, start, i, damping, surface);
  }

  b2World& world() { return world_; }

  /// Wrenches of the next steps, until the world's forces are cleared.
  void push(std::span<const Wrench> wrenches) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i]->ApplyForceToCenter(in_units(wrenches[i].fx, wrenches[i].fy), true);
      bodies_[i]->ApplyTorque(kUnits * kUnits * static_cast<float>(wrenches[i].torque), true);
    }
  }
  void step(double seconds) {
    constexpr int kVelocityRounds = 8, kPositionRounds = 3;  // the library's advice
    world_.Step(static_cast<float>(seconds), kVelocityRounds, kPositionRounds);
  }

  /// Sets arrays x, y, c, s, vx, vy and omega of `out`.
  template <class Arrays>
  void read(Arrays& out) const {
    const auto metres = [](float value) { return static_cast<double>(value / kUnits); };
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const b2Transform& t = bodies_[i]->GetTransform();
      const b2Vec2& v = bodies_[i]->GetLinearVelocity();
      out.x[i] = metres(t.p.x), out.y[i] = metres(t.p.y);
      out.c[i] = static_cast<double>(t.q.c), out.s[i] = static_cast<double>(t.q.s);
      out.vx[i] = metres(v.x), out.vy[i] = metres(v.y);
      out.omega[i] = static_cast<double>(bodies_[i]->GetAngularVelocity());
    }
  }

  /// What polygons are kept apart, m.
  static constexpr double kSkin = static_cast<double>(b2_polygonRadius) / 100;

  /// Balls are full discs, kg m^2.
  static double inertia(const Model& model, int body) {
    if (body < model.module.count) return model.module.inertia();
    return 0.5 * model.ball.mass * model.ball.radius * model.ball.radius;
  }

 private:
  static constexpr float kUnits = 100;  // a metre

  static b2Vec2 in_units(double x, double y) {
    return {kUnits * static_cast<float>(x), kUnits * static_cast<float>(y)};
  }

  void add_wall(double radius, int corners, b2FixtureDef surface) {
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

  void add(const Model& model, const State& start, int number, const Damping& damping,
           b2FixtureDef surface) {
    const auto i = static_cast<std::size_t>(number);
    const bool square = number < model.module.count;
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = in_units(start.x[i], start.y[i]);
    def.angle = static_cast<float>(angle_of({start.c[i], start.s[i]}));
    def.linearDamping = static_cast<float>(damping.linear);
    def.angularDamping = static_cast<float>(damping.angular);
    b2Body* body = world_.CreateBody(&def);
    b2PolygonShape box;
    b2CircleShape disc;
    // Without their skin polygons are as wide as they should be.
    const float half = kUnits * static_cast<float>(0.5 * model.module.side) - b2_polygonRadius;
    box.SetAsBox(half, half);
    disc.m_radius = kUnits * static_cast<float>(model.ball.radius);
    surface.shape = square ? static_cast<const b2Shape*>(&box) : &disc;
    surface.density = 1;
    body->CreateFixture(&surface);
    b2MassData weight;
    weight.mass = static_cast<float>(square ? model.module.mass : model.ball.mass);
    weight.center.SetZero();
    weight.I = kUnits * kUnits * static_cast<float>(inertia(model, number));
    body->SetMassData(&weight);
    bodies_.push_back(body);
  }

  b2World world_;
  std::vector<b2Body*> bodies_;
};

}  // namespace lilytank
