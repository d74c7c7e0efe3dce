// ODE 0.16 with its direct solver: cubes that never leave the plane, because no force and no
// contact points out of it. The wall is exact; its contacts are made here.
#include <ode/ode.h>

#include <cmath>

#include "engine.hpp"

namespace lilytank::bench {
namespace {

class Ode final : public Engine {
 public:
  explicit Ode(const EngineSetup& setup)
      : contact_(setup.model.contact),
        tank_(setup.model.tank.radius),
        half_(setup.model.module.side / 2),
        step_(setup.step()),
        substeps_(setup.substeps) {
    world_ = dWorldCreate();
    dWorldSetAutoDisableFlag(world_, 0);
    contacts_ = dJointGroupCreate(0);
    const int count = setup.model.module.count;
    // Testing all pairs is faster than any tree for few bodies.
    space_ = count <= 64 ? dSimpleSpaceCreate(nullptr)
                         : dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    const Decay decay = setup.decay();
    for (int i = 0; i < count; ++i) add(setup, i, decay);
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void read(Bodies& out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const dReal *p = dBodyGetPosition(bodies_[i]), *r = dBodyGetRotation(bodies_[i]);
      const dReal *v = dBodyGetLinearVel(bodies_[i]), *w = dBodyGetAngularVel(bodies_[i]);
      out.x[i] = p[0], out.y[i] = p[1], out.c[i] = r[0], out.s[i] = r[4];
      out.vx[i] = v[0], out.vy[i] = v[1], out.omega[i] = w[2];
    }
  }

  void step(std::span<const Wrench> wrenches) override {
    for (int k = 0; k < substeps_; ++k) {
      dSpaceCollide(space_, this,
                    [](void* self, dGeomID a, dGeomID b) { static_cast<Ode*>(self)->meet(a, b); });
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        meet_wall(bodies_[i]);
        dBodyAddForce(bodies_[i], wrenches[i].fx, wrenches[i].fy, 0);
        dBodyAddTorque(bodies_[i], 0, 0, wrenches[i].torque);
      }
      dWorldStep(world_, step_);
      dJointGroupEmpty(contacts_);
    }
  }

 private:
  void add(const EngineSetup& setup, int i, const Decay& decay) {
    const ModuleParameters& module = setup.model.module;
    const dBodyID body = dBodyCreate(world_);
    dMass mass;
    dMassSetBoxTotal(&mass, module.mass, module.side, module.side, module.side);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, setup.start.x[i], setup.start.y[i], 0);
    dMatrix3 turn;
    dRFromAxisAndAngle(turn, 0, 0, 1, angle_of({setup.start.c[i], setup.start.s[i]}));
    dBodySetRotation(body, turn);
    dBodySetLinearDampingThreshold(body, 0);
    dBodySetAngularDampingThreshold(body, 0);
    dBodySetLinearDamping(body, 1 - decay.linear);
    dBodySetAngularDamping(body, 1 - decay.angular);
    dGeomSetBody(dCreateBox(space_, module.side, module.side, module.side), body);
    bodies_.push_back(body);
  }

  // Friction acts in the plane only.
  void touch(dBodyID a, dBodyID b, const dContactGeom& geom) {
    dContact contact{};
    contact.geom = geom;
    contact.geom.pos[2] = 0;
    contact.geom.normal[2] = 0;
    contact.fdir1[0] = -geom.normal[1];
    contact.fdir1[1] = geom.normal[0];
    contact.surface.mode = dContactBounce | dContactApprox1 | dContactFDir1 | dContactMu2;
    contact.surface.mu = contact_.friction;
    contact.surface.mu2 = 0;
    contact.surface.bounce = contact_.restitution;
    contact.surface.bounce_vel = contact_.restitution_speed;
    dJointAttach(dJointCreateContact(world_, contacts_, &contact), a, b);
  }

  void meet(dGeomID first, dGeomID second) {
    const dBodyID a = dGeomGetBody(first), b = dGeomGetBody(second);
    const dReal *p = dBodyGetPosition(a), *q = dBodyGetPosition(b);
    const double dx = q[0] - p[0], dy = q[1] - p[1];
    if (dx * dx + dy * dy > 8 * half_ * half_) return;  // their circles are apart
    dContactGeom found[8];
    const int count = dCollide(first, second, 8, found, sizeof found[0]);
    // Two cubes touch at their upper and lower edges alike: one of each is enough.
    for (int k = 0; k < count; ++k) {
      if (found[k].pos[2] > 0) touch(a, b, found[k]);
    }
  }

  void meet_wall(dBodyID body) {
    const dReal *p = dBodyGetPosition(body), *r = dBodyGetRotation(body);
    const double inside = tank_ - half_ * std::sqrt(2.0);
    if (p[0] * p[0] + p[1] * p[1] < inside * inside) return;
    for (const double u : {-half_, half_}) {
      for (const double v : {-half_, half_}) {
        const double x = p[0] + r[0] * u + r[1] * v, y = p[1] + r[4] * u + r[5] * v;
        const double reach = std::sqrt(x * x + y * y);
        if (reach <= tank_) continue;
        dContactGeom geom{};
        geom.pos[0] = x, geom.pos[1] = y;
        geom.normal[0] = -x / reach, geom.normal[1] = -y / reach;
        geom.depth = reach - tank_;
        touch(body, nullptr, geom);
      }
    }
  }

  ContactParameters contact_;
  double tank_, half_, step_;
  int substeps_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

std::unique_ptr<Engine> make_ode(const EngineSetup& setup) {
  static const int ready = dInitODE2(0) && dAllocateODEDataForThread(dAllocateMaskAll);
  return ready ? std::make_unique<Ode>(setup) : nullptr;
}

}  // namespace lilytank::bench
