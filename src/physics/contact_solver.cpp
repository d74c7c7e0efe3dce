#include "contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

constexpr int kSweeps = 40;
constexpr double kConverged = 1e-9;  // m/s, change of velocity in a sweep
constexpr double kUnchanged = 1e-7;  // m/s, targets nearer than this need no second solution

double energy(const std::vector<Mover>& movers) {
  double sum = 0;
  for (const Mover& m : movers) {
    const Twist& t = m.twist;
    sum += m.mass * (t.vx * t.vx + t.vy * t.vy) + m.inertia * t.omega * t.omega;
  }
  return 0.5 * sum;
}

// Velocity of b against a at the contact.
struct Slip {
  double n, t;
};

Slip slip(const Contact& c, const Mover& a, const Mover& b) {
  const double vx = b.twist.vx - b.twist.omega * c.by - a.twist.vx + a.twist.omega * c.ay;
  const double vy = b.twist.vy + b.twist.omega * c.bx - a.twist.vy - a.twist.omega * c.ax;
  return {c.nx * vx + c.ny * vy, c.nx * vy - c.ny * vx};
}

void kick(const Contact& c, Mover& a, Mover& b, double jx, double jy) {
  a.twist.vx -= a.inv_mass * jx, a.twist.vy -= a.inv_mass * jy;
  b.twist.vx += b.inv_mass * jx, b.twist.vy += b.inv_mass * jy;
  a.twist.omega -= a.inv_inertia * (c.ax * jy - c.ay * jx);
  b.twist.omega += b.inv_inertia * (c.bx * jy - c.by * jx);
}

// The rigid motion with an island's momenta, which no contact among its members can change; with
// balls, whose spin is not free, only the common velocity.
struct Drift {
  double x = 0, y = 0, vx = 0, vy = 0, omega = 0;
};

Drift drift_of(const std::vector<Mover>& movers) {
  Drift d;
  double mass = 0, inertia = 0, spin = 0;
  bool turns = true;
  for (std::size_t k = 1; k < movers.size(); ++k) {
    const Mover& m = movers[k];
    mass += m.mass;
    d.x += m.mass * m.pose.x, d.y += m.mass * m.pose.y;
    d.vx += m.mass * m.twist.vx, d.vy += m.mass * m.twist.vy;
    turns = turns && m.inv_inertia > 0;
  }
  d.x /= mass, d.y /= mass, d.vx /= mass, d.vy /= mass;
  for (std::size_t k = 1; k < movers.size() && turns; ++k) {
    const Mover& m = movers[k];
    const double x = m.pose.x - d.x, y = m.pose.y - d.y;
    inertia += m.inertia + m.mass * (x * x + y * y);
    spin +=
        m.inertia * m.twist.omega + m.mass * (x * (m.twist.vy - d.vy) - y * (m.twist.vx - d.vx));
  }
  if (turns) d.omega = spin / inertia;
  return d;
}

// Newton's restitution with friction can gain energy where several points meet at once. Slows the
// motion relative to `d` so that the island's energy falls from `now` to `allowed`.
void calm(std::vector<Mover>& movers, const Drift& d, double now, double allowed) {
  const auto drift_at = [&](const Mover& m) {
    return Twist{d.vx - d.omega * (m.pose.y - d.y), d.vy + d.omega * (m.pose.x - d.x),
                 m.inv_inertia > 0 ? d.omega : 0};
  };
  double least = 0;
  for (const Mover& m : movers) {
    const Twist t = drift_at(m);
    least += 0.5 * (m.mass * (t.vx * t.vx + t.vy * t.vy) + m.inertia * t.omega * t.omega);
  }
  if (!(now > least)) return;
  const double share = std::sqrt(std::max(allowed - least, 0.0) / (now - least));
  for (std::size_t k = 1; k < movers.size(); ++k) {
    Twist& t = movers[k].twist;
    const Twist base = drift_at(movers[k]);
    t.vx = base.vx + share * (t.vx - base.vx);
    t.vy = base.vy + share * (t.vy - base.vy);
    t.omega = base.omega + share * (t.omega - base.omega);
  }
}

}  // namespace

ContactSolver::ContactSolver(const Model& model)
    : friction_(model.contact.friction),
      restitution_(model.contact.restitution),
      threshold_(model.contact.restitution_speed) {
  contacts_.reserve(8 * static_cast<std::size_t>(model.bodies()) + 16);
}

void ContactSolver::prepare(Contact& c, const std::vector<Mover>& movers) const {
  const Mover &a = movers[c.a], &b = movers[c.b];
  const double an = c.ax * c.ny - c.ay * c.nx, bn = c.bx * c.ny - c.by * c.nx;
  const double at = c.ax * c.nx + c.ay * c.ny, bt = c.bx * c.nx + c.by * c.ny;
  const double k = a.inv_mass + b.inv_mass;
  c.mass_n = 1 / (k + a.inv_inertia * an * an + b.inv_inertia * bn * bn);
  c.mass_t = 1 / (k + a.inv_inertia * at * at + b.inv_inertia * bt * bt);
}

// One pass over all contacts; returns the largest change of velocity (m/s).
double ContactSolver::sweep(std::vector<Mover>& movers) {
  double change = 0;
  for (Contact& c : contacts_) {
    Mover &a = movers[c.a], &b = movers[c.b];
    Slip v = slip(c, a, b);
    const double normal = std::max(c.impulse_n + c.mass_n * (c.target - v.n), 0.0);
    const double dn = normal - c.impulse_n;
    if (normal == 0 && dn == 0 && c.impulse_t == 0) continue;
    c.impulse_n = normal;
    kick(c, a, b, dn * c.nx, dn * c.ny);
    v = slip(c, a, b);
    const double most = friction_ * normal;
    const double along = std::clamp(c.impulse_t - c.mass_t * v.t, -most, most);
    const double dt = along - c.impulse_t;
    c.impulse_t = along;
    kick(c, a, b, -dt * c.ny, dt * c.nx);
    change = std::max(change, std::max(std::fabs(dn), std::fabs(dt)) * (a.inv_mass + b.inv_mass));
  }
  return change;
}

void ContactSolver::iterate(std::vector<Mover>& movers) {
  for (int k = 0; k < kSweeps; ++k) {
    if (sweep(movers) < kConverged) return;
  }
}

void ContactSolver::approach(Island& island, double margin, double h) {
  contacts_.clear();
  std::vector<Mover>& movers = island.movers();
  for (const Near& near : island.nears()) {
    if (near.separation > margin) continue;
    island.touches(near, margin, [&](double nx, double ny, const Touch& touch) {
      Contact c;
      c.a = near.a, c.b = near.b;
      c.nx = nx, c.ny = ny;
      c.x = touch.x, c.y = touch.y, c.gap = touch.gap;
      const Mover &a = movers[c.a], &b = movers[c.b];
      c.ax = c.x - a.pose.x, c.ay = c.y - a.pose.y;
      c.bx = c.x - b.pose.x, c.by = c.y - b.pose.y;
      prepare(c, movers);
      c.approach = slip(c, a, b).n;
      c.target = c.gap > 0 ? -c.gap / h : 0;
      contacts_.push_back(c);
    });
  }
  energy_ = energy(movers);
  if (!contacts_.empty()) iterate(movers);
}

void ContactSolver::rebound(Island& island, double h) {
  // A contact that did not act and is not closed stays out: it is for a later substep.
  std::erase_if(contacts_, [](const Contact& c) { return c.impulse_n == 0 && c.gap > 0; });
  if (contacts_.empty()) return;
  std::vector<Mover>& movers = island.movers();
  bool again = false, wall = false;
  for (Contact& c : contacts_) {
    const bool bounces =
        c.impulse_n > 0 && c.approach < -threshold_ && !movers[c.a].dull && !movers[c.b].dull;
    const double target = bounces ? -restitution_ * c.approach : 0;
    again = again || std::fabs(target - c.target) > kUnchanged;
    wall = wall || c.a == 0;
    c.target = target;
  }
  if (again) {
    for (Contact& c : contacts_) {
      // The point moved with both bodies; where it lies now, the impulses have no net torque.
      const Mover &a = movers[c.a], &b = movers[c.b];
      const double va_x = a.twist.vx - a.twist.omega * c.ay,
                   va_y = a.twist.vy + a.twist.omega * c.ax;
      const double vb_x = b.twist.vx - b.twist.omega * c.by,
                   vb_y = b.twist.vy + b.twist.omega * c.bx;
      const double share = c.a == 0 ? h : 0.5 * h;  // a point on the wall goes with the corner
      c.x += share * (va_x + vb_x), c.y += share * (va_y + vb_y);
      c.ax = c.x - a.pose.x, c.ay = c.y - a.pose.y;
      c.bx = c.x - b.pose.x, c.by = c.y - b.pose.y;
      prepare(c, movers);
    }
    iterate(movers);
  }
  const double now = energy(movers);
  if (now > energy_) calm(movers, wall ? Drift{} : drift_of(movers), now, energy_);
}

}  // namespace lilytank
