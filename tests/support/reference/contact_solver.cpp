#include "contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank::reference {
namespace {

constexpr int kSweeps = 100;
// m/s: done when a sweep changes no velocity by more than this; after some sweeps, by more than the
// second or a share of what the first one changed.
constexpr double kExact = 1e-8, kClose = 1e-6, kShare = 1e-3;
constexpr int kQuick = 8;            // sweeps in which a few contacts become exact
constexpr double kUnchanged = 1e-6;  // m/s, targets nearer than this need no second solution

double energy(const std::vector<Mover>& movers) {
  double sum = 0;
  for (const Mover& m : movers) {
    const Twist& t = m.twist;
    sum += m.mass * (t.vx * t.vx + t.vy * t.vy) + m.inertia * t.omega * t.omega;
  }
  return 0.5 * sum;
}

// Velocity of b against a at the contact, along the normal and the tangent.
struct Slip {
  double n, t;
};

Slip slip(const ContactPoint& c, const Mover& a, const Mover& b) {
  const double vx = b.twist.vx - a.twist.vx, vy = b.twist.vy - a.twist.vy;
  return {c.nx * vx + c.ny * vy + c.bn * b.twist.omega - c.an * a.twist.omega,
          c.nx * vy - c.ny * vx + c.bt * b.twist.omega - c.at * a.twist.omega};
}

void kick(const ContactPoint& c, Mover& a, Mover& b, double n, double t) {
  const double jx = n * c.nx - t * c.ny, jy = n * c.ny + t * c.nx;
  a.twist.vx -= a.inv_mass * jx, a.twist.vy -= a.inv_mass * jy;
  b.twist.vx += b.inv_mass * jx, b.twist.vy += b.inv_mass * jy;
  a.twist.omega -= a.inv_inertia * (c.an * n + c.at * t);
  b.twist.omega += b.inv_inertia * (c.bn * n + c.bt * t);
}

// The impulses that one contact needs in the end if nothing else changes, by Coulomb's law: none,
// sticking, or sliding. `v` is the velocity with the impulses so far.
void resolve(ContactPoint& c, double friction, const Slip& v) {
  const double bare_n = v.n - c.nn * c.impulse_n - c.nt * c.impulse_t;
  const double bare_t = v.t - c.nt * c.impulse_n - c.tt * c.impulse_t;
  const double need = c.target - bare_n;
  c.impulse_n = c.impulse_t = 0;
  if (need <= 0) return;
  const double n = (c.tt * need + c.nt * bare_t) * c.stick;
  const double t = (-c.nn * bare_t - c.nt * need) * c.stick;
  if (n > 0 && std::fabs(t) <= friction * n) {
    c.impulse_n = n, c.impulse_t = t;
    return;
  }
  // Friction at its bound, on the side of what sticking would take.
  const int side = t > 0 ? 1 : 0;
  c.impulse_n = need * c.slide[side], c.impulse_t = c.share[side] * c.impulse_n;
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
  before_.reserve(static_cast<std::size_t>(model.bodies()) + 1);
}

// Arms and effective masses for the point at which the contact lies.
void ContactSolver::prepare(ContactPoint& c, const Mover& a, const Mover& b) const {
  const double ax = c.x - a.pose.x, ay = c.y - a.pose.y;
  const double bx = c.x - b.pose.x, by = c.y - b.pose.y;
  c.an = ax * c.ny - ay * c.nx, c.at = ax * c.nx + ay * c.ny;
  c.bn = bx * c.ny - by * c.nx, c.bt = bx * c.nx + by * c.ny;
  const double k = a.inv_mass + b.inv_mass;
  c.nn = k + a.inv_inertia * c.an * c.an + b.inv_inertia * c.bn * c.bn;
  c.nt = a.inv_inertia * c.an * c.at + b.inv_inertia * c.bn * c.bt;
  c.tt = k + a.inv_inertia * c.at * c.at + b.inv_inertia * c.bt * c.bt;
  c.stick = 1 / (c.nn * c.tt - c.nt * c.nt);
  for (const int side : {0, 1}) {
    const double share = side == 1 ? friction_ : -friction_;
    const double effective = c.nn + share * c.nt;
    const bool slides = effective > 0.1 * c.nn;  // or it would jam
    c.slide[side] = 1 / (slides ? effective : c.nn), c.share[side] = slides ? share : 0;
  }
}

// One pass over all contacts.
void ContactSolver::sweep(std::vector<Mover>& movers) {
  for (ContactPoint& c : contacts_) {
    Mover &a = movers[c.a], &b = movers[c.b];
    const Slip v = slip(c, a, b);
    if (c.impulse_n == 0 && v.n >= c.target) continue;
    const double old_n = c.impulse_n, old_t = c.impulse_t;
    resolve(c, friction_, v);
    kick(c, a, b, c.impulse_n - old_n, c.impulse_t - old_t);
  }
}

// The largest change of a velocity since the last call (m/s, turning at the farthest point).
double ContactSolver::moved(const std::vector<Mover>& movers) {
  double most = 0;
  for (std::size_t k = 1; k < movers.size(); ++k) {
    const Twist now = movers[k].twist, was = before_[k];
    before_[k] = now;
    most = std::max({most, std::fabs(now.vx - was.vx), std::fabs(now.vy - was.vy),
                     std::fabs(now.omega - was.omega) * movers[k].reach});
  }
  return most;
}

// Until the movers no longer change. Impulses may go on for long: several points of two faces that
// stick share one force in many ways.
void ContactSolver::iterate(Island& island) {
  std::vector<Mover>& movers = island.movers();
  if (contacts_.size() == 1) return sweep(movers);
  before_.clear();
  for (const Mover& m : movers) before_.push_back(m.twist);
  double close = 0;
  for (int k = 0; k < kSweeps; ++k) {
    sweep(movers);
    island.work += static_cast<std::int64_t>(contacts_.size());
    const double change = moved(movers);
    if (k == 0) close = std::max(kClose, kShare * change);
    if (change < (k < kQuick ? kExact : close)) return;
  }
}

bool ContactSolver::approach(Island& island, double margin, double h) {
  contacts_.clear();
  bool needed = false;
  std::vector<Mover>& movers = island.movers();
  for (const ContactPair& pair : island.pairs()) {
    if (pair.gap.size > margin) continue;
    const Mover &a = movers[pair.a], &b = movers[pair.b];
    island.touches(pair, margin, [&](double nx, double ny, const Touch& touch) {
      ContactPoint& c = contacts_.emplace_back();
      c.a = pair.a, c.b = pair.b;
      c.nx = nx, c.ny = ny;
      c.x = touch.x, c.y = touch.y, c.gap = touch.gap;
      prepare(c, a, b);
      c.approach = slip(c, a, b).n;
      c.target = c.gap > 0 ? -c.gap / h : 0;
      needed = needed || c.approach < c.target;
    });
  }
  if (!needed) return false;
  energy_ = energy(movers);
  iterate(island);
  return true;
}

// Which contacts go on after the motion, and the velocities that they ask for. A contact that did
// not act and is not closed is left for a later substep. True if they ask for something new.
bool ContactSolver::retarget(const std::vector<Mover>& movers) {
  std::erase_if(contacts_, [](const ContactPoint& c) { return c.impulse_n == 0 && c.gap > 0; });
  bool again = false;
  for (ContactPoint& c : contacts_) {
    const bool bounces =
        c.impulse_n > 0 && c.approach < -threshold_ && !movers[c.a].dull && !movers[c.b].dull;
    const double target = bounces ? -restitution_ * c.approach : 0;
    again = again || std::fabs(target - c.target) > kUnchanged;
    c.target = target;
  }
  return again;
}

void ContactSolver::rebound(Island& island, double h) {
  std::vector<Mover>& movers = island.movers();
  bool wall = false;
  const bool again = retarget(movers);
  for (ContactPoint& c : contacts_) {
    wall = wall || c.a == 0;
    if (!again) continue;
    // The point moved with both bodies (on the wall: with the corner). Where it lies now, the
    // impulses have no net torque.
    const Twist &p = movers[c.a].twist, &q = movers[c.b].twist;
    const double share = c.a == 0 ? h : 0.5 * h;
    const double along_n =
        c.nx * (p.vx + q.vx) + c.ny * (p.vy + q.vy) + c.an * p.omega + c.bn * q.omega;
    const double along_t =
        c.nx * (p.vy + q.vy) - c.ny * (p.vx + q.vx) + c.at * p.omega + c.bt * q.omega;
    c.x += share * (c.nx * along_n - c.ny * along_t),
        c.y += share * (c.ny * along_n + c.nx * along_t);
    prepare(c, movers[c.a], movers[c.b]);
  }
  if (again) iterate(island);
  const double now = energy(movers);
  if (now > energy_) calm(movers, wall ? Drift{} : drift_of(movers), now, energy_);
}

}  // namespace lilytank::reference
