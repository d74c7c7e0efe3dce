// Box2D 2.4, lengths in centimetres: its fixed tolerances suit bodies of a few units.
#include <box2d/box2d.h>
#include <sys/time.h>

#include <cmath>

#include "engine.hpp"

// Box2D asks for the time around every island, for a profile that nobody reads here; that costs a
// quarter of its time. In this program the clock it asks stands still. (Speeds are measured by
// another clock.)
extern "C" int gettimeofday(struct timeval* now, void*) noexcept {
  *now = {};
  return 0;
}

namespace lilytank::bench {
namespace {

constexpr double kScale = 100;                           // units a metre
constexpr int kVelocityRounds = 8, kPositionRounds = 3;  // the library's advice

b2Vec2 scaled(double x, double y) {
  return {static_cast<float>(kScale * x), static_cast<float>(kScale * y)};
}

class Box2d final : public Engine {
 public:
  explicit Box2d(const EngineSetup& setup)
      : world_({0, 0}), step_(static_cast<float>(setup.step())), substeps_(setup.substeps) {
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(false);  // slower, and only walls would need it
    world_.SetAutoClearForces(false);
    b2FixtureDef surface;
    surface.friction = static_cast<float>(setup.model.contact.friction);
    surface.restitution = static_cast<float>(setup.model.contact.restitution);
    surface.restitutionThreshold =
        static_cast<float>(kScale * setup.model.contact.restitution_speed);
    add_wall(setup.model.tank.radius, surface);
    for (int i = 0; i < setup.model.module.count; ++i) add(setup, i, surface);
  }

  void read(Bodies& out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const b2Transform& t = bodies_[i]->GetTransform();
      const b2Vec2& v = bodies_[i]->GetLinearVelocity();
      out.x[i] = t.p.x / kScale, out.y[i] = t.p.y / kScale, out.c[i] = t.q.c, out.s[i] = t.q.s;
      out.vx[i] = v.x / kScale, out.vy[i] = v.y / kScale;
      out.omega[i] = bodies_[i]->GetAngularVelocity();
    }
  }

  void step(std::span<const Wrench> wrenches) override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i]->ApplyForceToCenter(scaled(wrenches[i].fx, wrenches[i].fy), true);
      bodies_[i]->ApplyTorque(static_cast<float>(kScale * kScale * wrenches[i].torque), true);
    }
    for (int k = 0; k < substeps_; ++k) world_.Step(step_, kVelocityRounds, kPositionRounds);
    world_.ClearForces();
  }

 private:
  void add_wall(double radius, b2FixtureDef surface) {
    const int corners = wall_corners(radius);
    std::vector<b2Vec2> ring;
    for (int k = 0; k < corners; ++k) {  // clockwise: what is solid lies outside
      const Rot way = rotation(-2 * kPi * k / corners);
      const double r = radius + b2_polygonRadius / kScale;
      ring.push_back(scaled(r * way.c, r * way.s));
    }
    b2ChainShape shape;
    shape.CreateLoop(ring.data(), corners);
    surface.shape = &shape;
    const b2BodyDef still;
    world_.CreateBody(&still)->CreateFixture(&surface);
  }

  void add(const EngineSetup& setup, int i, b2FixtureDef surface) {
    const ModuleParameters& module = setup.model.module;
    const Decay decay = setup.decay();
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = scaled(setup.start.x[i], setup.start.y[i]);
    def.angle = static_cast<float>(angle_of({setup.start.c[i], setup.start.s[i]}));
    // The engine divides by 1 + step * damping.
    def.linearDamping = static_cast<float>((1 / decay.linear - 1) / setup.step());
    def.angularDamping = static_cast<float>((1 / decay.angular - 1) / setup.step());
    b2Body* body = world_.CreateBody(&def);
    b2PolygonShape square;
    // Polygons are kept a skin apart; without it they are as wide as they should be.
    const float half = static_cast<float>(kScale * module.side / 2) - b2_polygonRadius;
    square.SetAsBox(half, half);
    surface.shape = &square;
    surface.density = 1;
    body->CreateFixture(&surface);
    b2MassData mass;
    mass.mass = static_cast<float>(module.mass);
    mass.center.SetZero();
    mass.I = static_cast<float>(kScale * kScale * module.inertia());
    body->SetMassData(&mass);
    bodies_.push_back(body);
  }

  b2World world_;
  float step_;
  int substeps_;
  std::vector<b2Body*> bodies_;
};

}  // namespace

std::unique_ptr<Engine> make_box2d(const EngineSetup& setup) {
  return std::make_unique<Box2d>(setup);
}

}  // namespace lilytank::bench
