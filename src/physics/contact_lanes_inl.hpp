// Velocities after contact, in lanes: sequential impulses with Coulomb friction and Newton's
// restitution: included after island_lanes_inl.hpp.

constexpr int kSweeps = 100;
// m/s: done when a sweep changes no velocity by more than this, a few roundings of float32; after
// some sweeps, by more than the second or a share of what the first one changed.
constexpr float kExact = 3e-7f, kClose = 1e-6f, kShare = 1e-3f;
constexpr int kQuick = 8;            // sweeps in which a few contacts become exact
constexpr float kUnchanged = 1e-6f;  // m/s, targets nearer than this need no second solution
constexpr float kRounding = 1e-6f;   // share of an energy that rounding may add

/// Solves the contacts of one vector of islands for one substep in two parts. Before the bodies
/// move: a gap may close, not more (so bodies meet in the substep, without overlap and without
/// tunnelling). After they moved: those that met no longer near each other, and rebound. Impulses
/// act on both bodies at one point, so momentum and angular momentum are kept in both parts.
class ContactLanes {
 public:
  explicit ContactLanes(IslandLanes& islands)
      : l_(islands),
        b(islands.b),
        o(islands.o),
        friction_(load(b.friction, o)),
        restitution_(load(b.restitution, o)),
        threshold_(load(b.threshold, o)),
        frame_x_(0.0f),
        frame_y_(0.0f),
        energy_(0.0f) {}

  /// Finds the contacts within `margin` (m) from the last survey and changes twists so that no gap
  /// closes by more than itself in h seconds. Returns where anything had to be changed.
  Mask approach(F margin, F h, Mask which);
  /// After the islands moved by h: removes what is left of the approach, adds restitution, and
  /// makes sure that no energy was gained.
  void rebound(F h, Mask which);

 private:
  struct Slip {
    F n, t;
  };
  // Velocity of b against a at the contact, along the normal and the tangent.
  HWY_INLINE Slip slip(const PointRows& c, const Side& sa, const Side& sb) const {
    const F nx = load(c.nx, o), ny = load(c.ny, o);
    const F wa = l_.get(sa, &MoverRows::omega), wb = l_.get(sb, &MoverRows::omega);
    const F vx = l_.get(sb, &MoverRows::vx) - l_.get(sa, &MoverRows::vx);
    const F vy = l_.get(sb, &MoverRows::vy) - l_.get(sa, &MoverRows::vy);
    return {nx * vx + ny * vy + load(c.bn, o) * wb - load(c.an, o) * wa,
            nx * vy - ny * vx + load(c.bt, o) * wb - load(c.at, o) * wa};
  }
  void prepare(PointRows& c, const Side& sa, const Side& sb) const;
  void sweep(Mask which);
  F moved() const;
  void iterate(Mask which);
  Mask retarget(Mask which);
  F energy() const;
  void calm(F now, Mask which);

  IslandLanes& l_;
  Block& b;
  const std::size_t o;
  F friction_, restitution_, threshold_;
  F frame_x_, frame_y_;  // m/s, of the frame in which energies are measured
  F energy_;             // J, before contacts were solved
  int points_ = 0;
};

// Arms and effective masses for the point at which the contact lies.
HWY_NOINLINE void ContactLanes::prepare(PointRows& c, const Side& sa, const Side& sb) const {
  const F nx = load(c.nx, o), ny = load(c.ny, o), x = load(c.x, o), y = load(c.y, o);
  const F ax = x - l_.get(sa, &MoverRows::x), ay = y - l_.get(sa, &MoverRows::y);
  const F bx = x - l_.get(sb, &MoverRows::x), by = y - l_.get(sb, &MoverRows::y);
  const F an = ax * ny - ay * nx, at = ax * nx + ay * ny;
  const F bn = bx * ny - by * nx, bt = bx * nx + by * ny;
  const F iia = l_.get(sa, &MoverRows::inv_inertia), iib = l_.get(sb, &MoverRows::inv_inertia);
  const F ima = l_.get(sa, &MoverRows::inv_mass), imb = l_.get(sb, &MoverRows::inv_mass);
  store(ima, c.im_a, o), store(iia, c.ii_a, o), store(imb, c.im_b, o), store(iib, c.ii_b, o);
  const F k = ima + imb;
  const F nn = k + iia * an * an + iib * bn * bn, nt = iia * an * at + iib * bn * bt;
  const F tt = k + iia * at * at + iib * bt * bt;
  store(an, c.an, o), store(at, c.at, o), store(bn, c.bn, o), store(bt, c.bt, o);
  store(nn, c.nn, o), store(nt, c.nt, o), store(tt, c.tt, o);
  store(1.0f / greater(nn * tt - nt * nt, kTiny), c.stick, o);
  // Sliding in which friction presses the bodies together ever more would jam.
  const F minus = nn - friction_ * nt, plus = nn + friction_ * nt, least = 0.1f * nn;
  const Mask slides0 = minus > least, slides1 = plus > least;
  store(1.0f / greater(choose(slides0, minus, nn), kTiny), c.slide0, o);
  store(1.0f / greater(choose(slides1, plus, nn), kTiny), c.slide1, o);
  store(keep(slides0, -friction_), c.share0, o), store(keep(slides1, friction_), c.share1, o);
}

// One pass over all contacts. The impulses of each become those that it needs in the end if nothing
// else changes, by Coulomb's law: none, sticking, or sliding with friction at its bound, on the
// side of what sticking would take.
HWY_NOINLINE void ContactLanes::sweep(Mask which) {
  for (int k = 0; k < points_; ++k) {
    PointRows& c = b.point[k];
    const Mask on = which & load_mask(c.on, o);
    const Side sa = l_.side_a(*c.pair), sb = l_.side_b(*c.pair);
    const F nx = load(c.nx, o), ny = load(c.ny, o);
    const F an = load(c.an, o), at = load(c.at, o), bn = load(c.bn, o), bt = load(c.bt, o);
    const F wa = l_.get(sa, &MoverRows::omega), wb = l_.get(sb, &MoverRows::omega);
    const F vax = l_.get(sa, &MoverRows::vx), vay = l_.get(sa, &MoverRows::vy);
    const F vbx = l_.get(sb, &MoverRows::vx), vby = l_.get(sb, &MoverRows::vy);
    const F vx = vbx - vax, vy = vby - vay;
    const F slip_n = nx * vx + ny * vy + bn * wb - an * wa;
    const F slip_t = nx * vy - ny * vx + bt * wb - at * wa;
    const F old_n = load(c.impulse_n, o), old_t = load(c.impulse_t, o), target = load(c.target, o);
    if (!any(on & ((old_n != 0.0f) | (slip_n < target)))) continue;
    const F nn = load(c.nn, o), nt = load(c.nt, o), tt = load(c.tt, o), stick = load(c.stick, o);
    const F bare_n = slip_n - nn * old_n - nt * old_t, bare_t = slip_t - nt * old_n - tt * old_t;
    const F need = target - bare_n;
    const F stick_n = (tt * need + nt * bare_t) * stick;
    const F stick_t = (-(nn * bare_t) - nt * need) * stick;
    const Mask sticks = (stick_n > 0.0f) & (abs(stick_t) <= friction_ * stick_n);
    const Mask forward = stick_t > 0.0f;
    const F slide_n = need * choose(forward, load(c.slide1, o), load(c.slide0, o));
    const F slide_t = slide_n * choose(forward, load(c.share1, o), load(c.share0, o));
    const Mask acts = need > 0.0f;
    const F n = keep(on, keep(acts, choose(sticks, stick_n, slide_n)) - old_n);
    const F t = keep(on, keep(acts, choose(sticks, stick_t, slide_t)) - old_t);
    store(old_n + n, c.impulse_n, o), store(old_t + t, c.impulse_t, o);
    const F jx = n * nx - t * ny, jy = n * ny + t * nx;
    const F im_a = load(c.im_a, o), im_b = load(c.im_b, o);
    l_.put(sa, &MoverRows::vx, vax - im_a * jx), l_.put(sa, &MoverRows::vy, vay - im_a * jy);
    l_.put(sa, &MoverRows::omega, wa - load(c.ii_a, o) * (an * n + at * t));
    l_.put(sb, &MoverRows::vx, vbx + im_b * jx), l_.put(sb, &MoverRows::vy, vby + im_b * jy);
    l_.put(sb, &MoverRows::omega, wb + load(c.ii_b, o) * (bn * n + bt * t));
  }
}

// The largest change of a velocity since the last call (m/s, turning at the farthest point).
HWY_NOINLINE F ContactLanes::moved() const {
  F most = 0.0f;
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    const F vx = load(m.vx, o), vy = load(m.vy, o), omega = load(m.omega, o);
    most = greater(most, abs(vx - load(m.before_x, o)));
    most = greater(most, abs(vy - load(m.before_y, o)));
    most = greater(most, abs(omega - load(m.before_omega, o)) * load(m.reach, o));
    store(vx, m.before_x, o), store(vy, m.before_y, o), store(omega, m.before_omega, o);
  }
  return most;
}

// Until the movers no longer change. Impulses may go on for long: several points of two faces that
// stick share one force in many ways.
HWY_NOINLINE void ContactLanes::iterate(Mask which) {
  F count = 0.0f;
  for (int k = 0; k < points_; ++k) count += keep(load_mask(b.point[k].on, o), 1.0f);
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    store(load(m.vx, o), m.before_x, o), store(load(m.vy, o), m.before_y, o);
    store(load(m.omega, o), m.before_omega, o);
  }
  F close = kClose;
  for (int k = 0; k < kSweeps; ++k) {
    sweep(which);
    if (k == 0) which &= count > 1.0f;  // one contact is exact at once
    if (!any(which)) return;
    const Whole visits = whole_of(count);
    l_.work = l_.work + choose(which, visits, Whole(0));
    const F change = moved();
    if (k == 0) close = greater(kShare * change, kClose);
    which &= change >= (k < kQuick ? F(kExact) : close);
    if (!any(which)) return;
  }
}

// In a frame that moves with the island, in which rounding is small; with a wall, in the tank.
HWY_NOINLINE F ContactLanes::energy() const {
  F sum = 0.0f;
  for (int k = 1; k < b.movers; ++k) {
    const MoverRows& m = b.mover[k];
    const F vx = load(m.vx, o) - frame_x_, vy = load(m.vy, o) - frame_y_, omega = load(m.omega, o);
    sum += load(m.mass, o) * (vx * vx + vy * vy) + load(m.inertia, o) * omega * omega;
  }
  return 0.5f * sum;
}

HWY_NOINLINE Mask ContactLanes::approach(F margin, F h, Mask which) {
  points_ = 0;
  Mask needed = none(), wall = none();
  for (int k = 0; k < b.pairs; ++k) {
    const PairRows& p = b.pair[k];
    const Mask near = which & (load(p.gap, o) <= margin);
    if (!any(near)) continue;
    const Side sa = l_.side_a(p), sb = l_.side_b(p);
    const Mask at_wall = load_mask(p.wall, o);
    LaneTouches touches;
    l_.touches(p, margin, touches);
    for (int q = 0; q < touches.count; ++q) {
      const Mask on = near & touches.on[q];
      if (!any(on)) continue;
      PointRows& c = b.point[points_++];
      c.pair = &p;
      store(on, c.on, o);
      store(touches.nx[q], c.nx, o), store(touches.ny[q], c.ny, o);
      store(touches.x[q], c.x, o), store(touches.y[q], c.y, o);
      store(touches.gap[q], c.gap, o);
      store(F(0.0f), c.impulse_n, o), store(F(0.0f), c.impulse_t, o);
      prepare(c, sa, sb);
      const F approach = slip(c, sa, sb).n, gap = touches.gap[q];
      const F target = keep(gap > 0.0f, -(gap / greater(h, kTiny)));
      store(approach, c.approach, o), store(target, c.target, o);
      needed |= on & (approach < target);
      wall |= on & at_wall;
    }
  }
  if (!any(needed)) return needed;
  frame_x_ = choose(wall, 0.0f, load(b.mover[1].vx, o));
  frame_y_ = choose(wall, 0.0f, load(b.mover[1].vy, o));
  energy_ = energy();
  iterate(needed);
  return needed;
}

// Which contacts go on after the motion, and the velocities that they ask for. A contact that did
// not act and is not closed is left for a later substep. True where they ask for something new.
HWY_NOINLINE Mask ContactLanes::retarget(Mask which) {
  Mask again = none();
  for (int k = 0; k < points_; ++k) {
    PointRows& c = b.point[k];
    const F impulse = load(c.impulse_n, o), approach = load(c.approach, o);
    const Mask idle = (impulse == 0.0f) & (load(c.gap, o) > 0.0f);
    const Mask on = load_mask(c.on, o) & which & ~idle;
    const Mask dull = l_.get_mask(l_.side_a(*c.pair), &MoverRows::dull) |
                      l_.get_mask(l_.side_b(*c.pair), &MoverRows::dull);
    const Mask bounces = (impulse > 0.0f) & (approach < -threshold_) & ~dull;
    const F target = keep(bounces, -(restitution_ * approach));
    again |= on & (abs(target - load(c.target, o)) > kUnchanged);
    store(on, c.on, o), store(target, c.target, o);
  }
  return again;
}

// Newton's restitution with friction can gain energy where several points meet at once. Slows the
// motion relative to the rigid motion with an island's momenta, which no contact among its members
// can change (with balls, which do not spin, the common velocity; with a wall, rest), so that
// the energy falls from `now` to what it was.
HWY_NOINLINE void ContactLanes::calm(F now, Mask which) {
  Mask wall = none(), turns = {(F(0.0f) == F(0.0f))};
  for (int k = 0; k < points_; ++k)
    wall |= load_mask(b.point[k].on, o) & load_mask(b.point[k].pair->wall, o);
  F mass = 0.0f, x = 0.0f, y = 0.0f, vx = 0.0f, vy = 0.0f;
  for (int k = 1; k < b.movers; ++k) {
    const MoverRows& m = b.mover[k];
    const F weight = load(m.mass, o);
    mass += weight;
    x += weight * load(m.x, o), y += weight * load(m.y, o);
    vx += weight * (load(m.vx, o) - frame_x_), vy += weight * (load(m.vy, o) - frame_y_);
    turns &= (load(m.inv_inertia, o) > 0.0f) | (weight <= 0.0f);
  }
  const F share_of = 1.0f / greater(mass, kTiny);
  x *= share_of, y *= share_of, vx *= share_of, vy *= share_of;
  F inertia = 0.0f, spin = 0.0f;
  for (int k = 1; k < b.movers; ++k) {
    const MoverRows& m = b.mover[k];
    const F weight = load(m.mass, o), own = load(m.inertia, o);
    const F dx = load(m.x, o) - x, dy = load(m.y, o) - y;
    const F ux = load(m.vx, o) - frame_x_ - vx, uy = load(m.vy, o) - frame_y_ - vy;
    inertia += own + weight * (dx * dx + dy * dy);
    spin += own * load(m.omega, o) + weight * (dx * uy - dy * ux);
  }
  F omega = keep(turns & ~wall, spin / greater(inertia, 1e-30f));
  vx = keep(~wall, vx), vy = keep(~wall, vy);
  F least = 0.0f;
  const auto drift = [&](const MoverRows& m, F& ux, F& uy, F& turning) {
    ux = vx - omega * (load(m.y, o) - y), uy = vy + omega * (load(m.x, o) - x);
    turning = keep(load(m.inv_inertia, o) > 0.0f, omega);
  };
  for (int k = 1; k < b.movers; ++k) {
    const MoverRows& m = b.mover[k];
    F ux, uy, turning;
    drift(m, ux, uy, turning);
    least +=
        0.5f * (load(m.mass, o) * (ux * ux + uy * uy) + load(m.inertia, o) * turning * turning);
  }
  which &= now > least;
  const F share = root(greater(energy_ - least, 0.0f) / greater(now - least, 1e-30f));
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    F ux, uy, turning;
    drift(m, ux, uy, turning);
    ux += frame_x_, uy += frame_y_;
    const F old_x = load(m.vx, o), old_y = load(m.vy, o), old = load(m.omega, o);
    store(choose(which, ux + share * (old_x - ux), old_x), m.vx, o);
    store(choose(which, uy + share * (old_y - uy), old_y), m.vy, o);
    store(choose(which, turning + share * (old - turning), old), m.omega, o);
  }
}

HWY_NOINLINE void ContactLanes::rebound(F h, Mask which) {
  const Mask again = retarget(which);
  if (any(again)) {
    for (int k = 0; k < points_; ++k) {
      PointRows& c = b.point[k];
      // The point moved with both bodies (on the wall: with the corner). Where it lies now, the
      // impulses have no net torque.
      const Side sa = l_.side_a(*c.pair), sb = l_.side_b(*c.pair);
      const F nx = load(c.nx, o), ny = load(c.ny, o);
      const F sx = l_.get(sa, &MoverRows::vx) + l_.get(sb, &MoverRows::vx);
      const F sy = l_.get(sa, &MoverRows::vy) + l_.get(sb, &MoverRows::vy);
      const F wa = l_.get(sa, &MoverRows::omega), wb = l_.get(sb, &MoverRows::omega);
      const F share = choose(load_mask(c.pair->wall, o), h, 0.5f * h);
      const F along_n = nx * sx + ny * sy + load(c.an, o) * wa + load(c.bn, o) * wb;
      const F along_t = nx * sy - ny * sx + load(c.at, o) * wa + load(c.bt, o) * wb;
      store(load(c.x, o) + share * (nx * along_n - ny * along_t), c.x, o);
      store(load(c.y, o) + share * (ny * along_n + nx * along_t), c.y, o);
      prepare(c, sa, sb);
    }
    iterate(again);
  }
  const F now = energy();
  const Mask gained = which & (now > energy_ + kRounding * energy_);
  if (any(gained)) calm(now, gained);
}
