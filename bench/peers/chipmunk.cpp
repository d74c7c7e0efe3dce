// Chipmunk 7, lengths in centimetres: its fixed tolerances suit bodies of a few units.
#include <chipmunk/chipmunk.h>

#include <cmath>

#include "engine.hpp"

namespace lilytank::bench {
namespace {

constexpr double kScale = 100;   // units a metre
constexpr double kSlop = 0.005;  // units: overlap that is left alone, 0.05 mm

class Chipmunk final : public Engine {
 public:
  explicit Chipmunk(const EngineSetup& setup)
      : space_(cpSpaceNew()),
        contact_(setup.model.contact),
        decay_(setup.decay()),
        step_(setup.step()),
        substeps_(setup.substeps) {
    cpSpaceSetCollisionSlop(space_, kSlop);
    // No restitution in slow contacts.
    cpCollisionHandler* handler = cpSpaceAddDefaultCollisionHandler(space_);
    handler->preSolveFunc = [](cpArbiter* arbiter, cpSpace*, cpDataPointer self) -> cpBool {
      static_cast<Chipmunk*>(self)->choose_restitution(arbiter);
      return cpTrue;
    };
    handler->userData = this;
    add_wall(setup.model.tank.radius);
    for (int i = 0; i < setup.model.module.count; ++i) add(setup, i);
  }
  ~Chipmunk() override {
    for (cpShape* shape : shapes_) cpSpaceRemoveShape(space_, shape), cpShapeFree(shape);
    for (cpBody* body : bodies_) cpSpaceRemoveBody(space_, body), cpBodyFree(body);
    cpSpaceFree(space_);
  }

  void read(Bodies& out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const cpVect p = cpBodyGetPosition(bodies_[i]), v = cpBodyGetVelocity(bodies_[i]);
      const cpVect r = cpBodyGetRotation(bodies_[i]);
      out.x[i] = p.x / kScale, out.y[i] = p.y / kScale, out.c[i] = r.x, out.s[i] = r.y;
      out.vx[i] = v.x / kScale, out.vy[i] = v.y / kScale;
      out.omega[i] = cpBodyGetAngularVelocity(bodies_[i]);
    }
  }

  void step(std::span<const Wrench> wrenches) override {
    for (int k = 0; k < substeps_; ++k) {
      for (std::size_t i = 0; i < bodies_.size(); ++i) {  // each step uses them up
        cpBodySetForce(bodies_[i], cpv(kScale * wrenches[i].fx, kScale * wrenches[i].fy));
        cpBodySetTorque(bodies_[i], kScale * kScale * wrenches[i].torque);
      }
      cpSpaceStep(space_, step_);
    }
  }

 private:
  void choose_restitution(cpArbiter* arbiter) const {
    cpBody *a = nullptr, *b = nullptr;
    cpArbiterGetBodies(arbiter, &a, &b);
    const cpVect at = cpArbiterGetPointA(arbiter, 0);
    const cpVect relative =
        cpvsub(cpBodyGetVelocityAtWorldPoint(b, at), cpBodyGetVelocityAtWorldPoint(a, at));
    const double approach = -cpvdot(relative, cpArbiterGetNormal(arbiter));
    const bool fast = approach > kScale * contact_.restitution_speed;
    cpArbiterSetRestitution(arbiter, fast ? contact_.restitution : 0);
  }

  void add_surface(cpShape* shape) {
    // The engine multiplies the two surfaces' coefficients.
    cpShapeSetFriction(shape, std::sqrt(contact_.friction));
    cpShapeSetElasticity(shape, std::sqrt(contact_.restitution));
    shapes_.push_back(cpSpaceAddShape(space_, shape));
  }

  void add_wall(double radius) {
    const int corners = wall_corners(radius);
    const auto corner = [&](int k) {
      const Rot way = rotation(2 * kPi * k / corners);
      return cpv(kScale * radius * way.c, kScale * radius * way.s);
    };
    for (int k = 0; k < corners; ++k) {
      cpShape* wall = cpSegmentShapeNew(cpSpaceGetStaticBody(space_), corner(k), corner(k + 1), 0);
      cpSegmentShapeSetNeighbors(wall, corner(k - 1), corner(k + 2));
      add_surface(wall);
    }
  }

  void add(const EngineSetup& setup, int i) {
    const ModuleParameters& module = setup.model.module;
    cpBody* body = cpBodyNew(module.mass, kScale * kScale * module.inertia());
    cpBodySetPosition(body, cpv(kScale * setup.start.x[i], kScale * setup.start.y[i]));
    cpBodySetAngle(body, angle_of({setup.start.c[i], setup.start.s[i]}));
    cpBodySetUserData(body, this);
    cpBodySetVelocityUpdateFunc(body, [](cpBody* it, cpVect gravity, cpFloat, cpFloat dt) {
      const Decay& decay = static_cast<Chipmunk*>(cpBodyGetUserData(it))->decay_;
      cpBodyUpdateVelocity(it, gravity, decay.linear, dt);
      // The engine has damped the spin like the speed.
      cpBodySetAngularVelocity(it, cpBodyGetAngularVelocity(it) * decay.angular / decay.linear);
    });
    bodies_.push_back(cpSpaceAddBody(space_, body));
    add_surface(cpBoxShapeNew(body, kScale * module.side, kScale * module.side, 0));
  }

  cpSpace* space_;
  ContactParameters contact_;
  Decay decay_;
  double step_;
  int substeps_;
  std::vector<cpBody*> bodies_;
  std::vector<cpShape*> shapes_;
};

}  // namespace

std::unique_ptr<Engine> make_chipmunk(const EngineSetup& setup) {
  return std::make_unique<Chipmunk>(setup);
}

}  // namespace lilytank::bench
