#include "island.hpp"

#include <algorithm>
#include <cmath>

#include "physics/small_turn.hpp"

namespace lilytank::reference {
namespace {

constexpr double kStride = 2e-3;       // m, most that a pair moves relatively in a substep
constexpr double kTurnError = 4e-5;    // m, most that an arc strays from its tangent in a substep
constexpr double kWallShare = 0.3;     // the round wall is smooth: sliding along it costs less
constexpr double kPushRange = 2e-3;    // m, pairs farther apart are not pushed together
constexpr double kLongestPush = 2e-3;  // m, per contact and sweep

// Whether a point of a mover is farther from its start than its motion bound.
bool is_beyond_bound(const Mover& m) {
  const double dx = m.pose.x - m.start.x, dy = m.pose.y - m.start.y;
  const double dc = m.pose.r.c - m.start.r.c, ds = m.pose.r.s - m.start.r.s;
  const double longer = std::fabs(dx) + std::fabs(dy) + m.reach * (std::fabs(dc) + std::fabs(ds));
  return longer > m.motion_bound && length(dx, dy) + m.reach * length(dc, ds) > m.motion_bound;
}

// Velocity of a point (ox, oy in the mover's frame).
Vec2 velocity_at(const Mover& m, double ox, double oy) {
  const double rx = m.pose.r.c * ox - m.pose.r.s * oy, ry = m.pose.r.s * ox + m.pose.r.c * oy;
  return {m.twist.vx - m.twist.omega * ry, m.twist.vy + m.twist.omega * rx};
}

// How far any point is from where it would be without contacts, m.
double off_course(const Mover& m, double time) {
  const Rot r = turned_by(m.start.r, time * m.course.omega);
  return length(m.pose.x - m.start.x - time * m.course.vx,
                m.pose.y - m.start.y - time * m.course.vy) +
         m.reach * length(m.pose.r.c - r.c, m.pose.r.s - r.s);
}

// How fast two movers move relative to axes that turn with the pair: what changes where they touch.
double relative_pace(const Mover& a, const Mover& b) {
  const double mean = 0.5 * (a.twist.omega + b.twist.omega);
  const double dx = b.pose.x - a.pose.x, dy = b.pose.y - a.pose.y;
  return length(b.twist.vx - a.twist.vx + mean * dy, b.twist.vy - a.twist.vy - mean * dx) +
         0.5 * std::fabs(b.twist.omega - a.twist.omega) * (a.reach + b.reach);
}

// Shortens a substep so that the arc of no point strays far from its tangent.
void limit_turn(const Mover& m, double& longest) {
  const double turn2 = m.twist.omega * m.twist.omega * longest * longest;
  if (turn2 * m.reach > 2 * kTurnError)
    longest = std::sqrt(2 * kTurnError / m.reach) / std::fabs(m.twist.omega);
}

// Pushing a and b apart by `moved` (kg m) along n, at unchanged velocities, gains angular momentum.
// Takes it back by equal and opposite impulses across the line of centres, and, if that gained
// energy, slows the motion within the pair; momentum and angular momentum stay. Not for balls:
// they cannot take up spin, so contacts with them do not keep it.
void hold_spin(Mover& a, Mover& b, double moved, double nx, double ny) {
  if (a.inv_inertia == 0 || b.inv_inertia == 0) return;
  const double dx = b.pose.x - a.pose.x, dy = b.pose.y - a.pose.y, d2 = dx * dx + dy * dy;
  const double reduced = a.mass * b.mass / (a.mass + b.mass);
  const double ux = b.twist.vx - a.twist.vx, uy = b.twist.vy - a.twist.vy;
  const auto energy = [&](double x, double y) {
    return reduced * (x * x + y * y) + a.inertia * a.twist.omega * a.twist.omega +
           b.inertia * b.twist.omega * b.twist.omega;
  };
  const double back = -moved * (nx * uy - ny * ux) / (reduced * d2);
  double vx = ux - back * dy, vy = uy + back * dx;
  const double allowed = energy(ux, uy), now = energy(vx, vy);
  if (now > allowed) {
    const double inertia = reduced * d2 + a.inertia + b.inertia;
    const double spin =
        reduced * (dx * vy - dy * vx) + a.inertia * a.twist.omega + b.inertia * b.twist.omega;
    const double omega = spin / inertia, least = spin * omega;  // of the pair as one rigid body
    // A pair that moves as one already has nothing to give but rounding.
    const double above = now - least, may = std::max(allowed - least, 0.0);
    const double share = above > may ? std::sqrt(may / above) : 0;
    vx = share * vx - (1 - share) * omega * dy, vy = share * vy + (1 - share) * omega * dx;
    a.twist.omega = share * a.twist.omega + (1 - share) * omega;
    b.twist.omega = share * b.twist.omega + (1 - share) * omega;
  }
  const double jx = reduced * (vx - ux), jy = reduced * (vy - uy);
  a.twist.vx -= a.inv_mass * jx, a.twist.vy -= a.inv_mass * jy;
  b.twist.vx += b.inv_mass * jx, b.twist.vy += b.inv_mass * jy;
}

}  // namespace

Island::Island(const Model& model)
    : half_(0.5 * model.module.side),
      corner_(model.module.side * std::sqrt(0.5)),
      radius_(model.ball.radius),
      tank_(model.tank.radius) {
  const auto n = static_cast<std::size_t>(model.bodies());
  movers_.reserve(n + 1);
  pairs_.reserve(std::min(n * (n + 1) / 2, 24 * n));
  clear();
}

void Island::clear() {
  movers_.clear();
  movers_.emplace_back();
  pairs_.clear();
}

Mover& Island::add() {
  return movers_.emplace_back();
}

void Island::add(const ContactPair& pair) {
  pairs_.push_back(pair);
}

void Island::sort_pairs() {
  const auto before = [](const ContactPair& p, const ContactPair& q) {
    return p.order_a != q.order_a ? p.order_a < q.order_a : p.order_b < q.order_b;
  };
  if (!std::is_sorted(pairs_.begin(), pairs_.end(), before))
    std::sort(pairs_.begin(), pairs_.end(), before);
}

Gap Island::separation(const ContactPair& pair) const {
  const Mover &a = movers_[pair.a], &b = movers_[pair.b];
  switch (pair.kind) {
    case PairKind::squares:
      return reference::separation(square_of(a, pair.ax, pair.ay, half_, 0),
                                   square_of(b, pair.bx, pair.by, half_, 0));
    case PairKind::square_disc:
      return reference::separation(square_of(a, pair.ax, pair.ay, half_, 0), disc_of(b, radius_));
    case PairKind::discs:
      return reference::separation(disc_of(a, radius_), disc_of(b, radius_));
    case PairKind::wall_square:
      return {wall_separation(square_of(b, pair.bx, pair.by, half_, 0), tank_), 0, 0};
    default:
      return {wall_separation(disc_of(b, radius_), tank_), 0, 0};
  }
}

double Island::survey() {
  double deepest = 0;
  for (ContactPair& pair : pairs_) {
    pair.gap = separation(pair);
    deepest = std::max(deepest, -pair.gap.size);
  }
  return deepest;
}

StepLimits Island::step_limits(double left) const {
  StepLimits p{left, 0, left};
  for (const ContactPair& pair : pairs_) {
    const Mover &a = movers_[pair.a], &b = movers_[pair.b];
    const Vec2 v = velocity_at(b, pair.bx, pair.by) - velocity_at(a, pair.ax, pair.ay);
    const double wa = std::fabs(a.twist.omega), wb = std::fabs(b.twist.omega);
    const double speed = length(v.x(), v.y());
    p.fastest = std::max(p.fastest, speed + corner_ * (wa + wb));
    // A square's extent in a direction changes by no more than half its side per radian, its
    // distance from the tank's centre by half its diagonal; members of a chain move on arcs.
    const double turning = (pair.a == 0 ? corner_ : half_) * (wa + wb) +
                           0.5 * left * (wa * wa * pair.arm_a + wb * wb * pair.arm_b);
    // Along the normal of the gap, fixed in the tank, nothing closes faster than this.
    const double along = pair.a == 0 ? -speed : pair.gap.nx * v.x() + pair.gap.ny * v.y();
    const double closing = turning - along;
    if (closing <= 0 || pair.gap.size > closing * left) continue;
    p.free_time = std::min(p.free_time, std::max(pair.gap.size, 0.0) / closing);
    const double pace = pair.a == 0 ? kWallShare * closing : relative_pace(a, b);
    if (pace * p.longest > kStride) p.longest = kStride / pace;
    limit_turn(a, p.longest);
    limit_turn(b, p.longest);
  }
  return p;
}

void Island::move(double h) {
  for (std::size_t k = 1; k < movers_.size(); ++k) {
    Mover& m = movers_[k];
    m.pose.x += h * m.twist.vx;
    m.pose.y += h * m.twist.vy;
    if (m.twist.omega != 0) m.pose.r = turned_by(m.pose.r, h * m.twist.omega);
  }
}

// Moves two bodies apart at a point by masses and inertias, as an impulse would.
void Island::push(Mover& a, Mover& b, double nx, double ny, const Touch& touch) {
  const double ax = touch.x - a.pose.x, ay = touch.y - a.pose.y;
  const double bx = touch.x - b.pose.x, by = touch.y - b.pose.y;
  const double arm_a = ax * ny - ay * nx, arm_b = bx * ny - by * nx;
  const double k =
      a.inv_mass + b.inv_mass + a.inv_inertia * arm_a * arm_a + b.inv_inertia * arm_b * arm_b;
  a.touched = b.touched = true;
  const double j = std::min(-touch.gap - kPushTo, kLongestPush) / k;
  a.pose.x -= j * a.inv_mass * nx, a.pose.y -= j * a.inv_mass * ny;
  b.pose.x += j * b.inv_mass * nx, b.pose.y += j * b.inv_mass * ny;
  if (a.inv_inertia > 0) a.pose.r = turned_by(a.pose.r, -j * a.inv_inertia * arm_a);
  if (b.inv_inertia > 0) b.pose.r = turned_by(b.pose.r, j * b.inv_inertia * arm_b);
  hold_spin(a, b, j, nx, ny);
}

double Island::push_apart(int rounds) {
  double deepest = 0;
  for (int round = 0; round < rounds; ++round) {
    deepest = 0;
    work += static_cast<std::int64_t>(pairs_.size());
    for (const ContactPair& pair : pairs_) {
      if (pair.gap.size > kPushRange) continue;
      const double depth = -separation(pair).size;
      if (depth <= kPushTo) continue;
      deepest = std::max(deepest, depth);
      // The deeper point first; the other is looked at afresh in the next round.
      double nx = 0, ny = 0;
      Touch worst;
      touches(pair, 0, [&](double x, double y, const Touch& t) {
        if (t.gap < worst.gap) nx = x, ny = y, worst = t;
      });
      if (-worst.gap > kPushTo) push(movers_[pair.a], movers_[pair.b], nx, ny, worst);
    }
    if (deepest <= kSlop) return deepest;
  }
  return deepest;
}

bool Island::any_beyond_bound() const {
  return std::any_of(movers_.begin() + 1, movers_.end(),
                     [](const Mover& m) { return is_beyond_bound(m); });
}

void Island::undo(Mover& mover, int& count) {
  if (mover.slot < 0 || mover.undone) return;
  mover.pose = mover.good;
  mover.undone = mover.dull = mover.touched = true;
  ++count;
}

int Island::put_back(double limit) {
  int count = 0;
  for (Mover& m : movers_) m.undone = false;
  for (Mover& m : movers_) {
    if (m.slot >= 0 && is_beyond_bound(m)) undo(m, count);
  }
  // Ends: a mover is put back once, and good poses overlap no more than they may.
  for (bool again = true; again;) {
    again = false;
    for (const ContactPair& pair : pairs_) {
      Mover &a = movers_[pair.a], &b = movers_[pair.b];
      if ((a.undone || pair.a == 0) && b.undone) continue;
      if (-separation(pair).size <= limit) continue;
      undo(a, count), undo(b, count);
      again = true;
    }
  }
  return count;
}

void Island::accept(double time) {
  for (std::size_t k = 1; k < movers_.size(); ++k) {
    Mover& m = movers_[k];
    m.good = m.pose;
    m.touched = m.touched || m.twist.vx != m.course.vx || m.twist.vy != m.course.vy ||
                m.twist.omega != m.course.omega;
    if (m.touched) m.strayed = std::max(m.strayed, off_course(m, time));
  }
}

}  // namespace lilytank::reference
