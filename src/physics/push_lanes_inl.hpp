// Overlaps of one vector of islands pushed apart, and what that does not help put back: included
// after island_lanes_inl.hpp.

// Pushing two apart by `moved` (kg m) along n, at unchanged velocities, gains angular momentum.
// Takes it back by equal and opposite impulses across the line of centres, and, if that gained
// energy, slows the motion within the pair; momentum and angular momentum stay. Not for balls:
// they cannot take up spin, so contacts with them do not keep it.
HWY_NOINLINE void IslandLanes::hold_spin(const Side& sa, const Side& sb, F moved, F nx, F ny,
                                         Mask which) {
  const F ia = get(sa, &MoverRows::inertia), ib = get(sb, &MoverRows::inertia);
  which &= (ia > 0.0f) & (ib > 0.0f);
  if (!any(which)) return;
  const F dx = get(sb, &MoverRows::x) - get(sa, &MoverRows::x);
  const F dy = get(sb, &MoverRows::y) - get(sa, &MoverRows::y);
  const F d2 = dx * dx + dy * dy;
  const F mass_a = get(sa, &MoverRows::mass), mass_b = get(sb, &MoverRows::mass);
  const F reduced = mass_a * mass_b / greater(mass_a + mass_b, kTiny);
  const F ax = get(sa, &MoverRows::vx), ay = get(sa, &MoverRows::vy);
  const F bx = get(sb, &MoverRows::vx), by = get(sb, &MoverRows::vy);
  const F wa = get(sa, &MoverRows::omega), wb = get(sb, &MoverRows::omega);
  const F ux = bx - ax, uy = by - ay, turning = ia * wa * wa + ib * wb * wb;
  const F back = -(moved * (nx * uy - ny * ux)) / greater(reduced * d2, 1e-30f);
  F vx = ux - back * dy, vy = uy + back * dx;
  const F allowed = reduced * (ux * ux + uy * uy) + turning;
  const F now = reduced * (vx * vx + vy * vy) + turning;
  const F inertia = greater(reduced * d2 + ia + ib, 1e-30f);
  const F spin = reduced * (dx * vy - dy * vx) + ia * wa + ib * wb;
  const F omega = spin / inertia, least = spin * omega;  // of the pair as one rigid body
  // A pair that moves as one already has nothing to give but rounding.
  const F above = now - least, may = greater(allowed - least, 0.0f);
  const F share = keep(above > may, root(may / greater(above, 1e-30f)));
  const Mask gained = now > allowed;
  vx = choose(gained, share * vx - (1.0f - share) * omega * dy, vx);
  vy = choose(gained, share * vy + (1.0f - share) * omega * dx, vy);
  const Mask slowed = gained & which;
  put(sa, &MoverRows::omega, choose(slowed, share * wa + (1.0f - share) * omega, wa));
  put(sb, &MoverRows::omega, choose(slowed, share * wb + (1.0f - share) * omega, wb));
  const F jx = keep(which, reduced * (vx - ux)), jy = keep(which, reduced * (vy - uy));
  const F ima = get(sa, &MoverRows::inv_mass), imb = get(sb, &MoverRows::inv_mass);
  put(sa, &MoverRows::vx, ax - ima * jx), put(sa, &MoverRows::vy, ay - ima * jy);
  put(sb, &MoverRows::vx, bx + imb * jx), put(sb, &MoverRows::vy, by + imb * jy);
}

// Moves two bodies apart at a point by masses and inertias, as an impulse would.
HWY_NOINLINE void IslandLanes::push(const PairRows& p, F nx, F ny, F x, F y, F gap, Mask which) {
  const Side sa = side_a(p), sb = side_b(p);
  const F ima = get(sa, &MoverRows::inv_mass), imb = get(sb, &MoverRows::inv_mass);
  const F iia = get(sa, &MoverRows::inv_inertia), iib = get(sb, &MoverRows::inv_inertia);
  const F ax = get(sa, &MoverRows::x), ay = get(sa, &MoverRows::y);
  const F bx = get(sb, &MoverRows::x), by = get(sb, &MoverRows::y);
  const F arm_a = (x - ax) * ny - (y - ay) * nx, arm_b = (x - bx) * ny - (y - by) * nx;
  const F k = ima + imb + iia * arm_a * arm_a + iib * arm_b * arm_b;
  const F j = keep(which, lesser(-gap - kPushTo, kLongestPush) / greater(k, kTiny));
  put(sa, &MoverRows::x, ax - j * ima * nx), put(sa, &MoverRows::y, ay - j * ima * ny);
  put(sb, &MoverRows::x, bx + j * imb * nx), put(sb, &MoverRows::y, by + j * imb * ny);
  const auto turn_side = [&](const Side& s, F angle, Mask on) {
    F c = get(s, &MoverRows::c), n = get(s, &MoverRows::s);
    turn(c, n, angle, on);
    put(s, &MoverRows::c, c), put(s, &MoverRows::s, n);
  };
  turn_side(sa, -(j * iia * arm_a), which & (iia > 0.0f));
  turn_side(sb, j * iib * arm_b, which & (iib > 0.0f));
  put(sa, &MoverRows::touched, get_mask(sa, &MoverRows::touched) | which);
  put(sb, &MoverRows::touched, get_mask(sb, &MoverRows::touched) | which);
  hold_spin(sa, sb, j, nx, ny, which);
}

// Pushes overlapping bodies apart, without giving them speed, in at most `rounds` sweeps over the
// pairs; returns what is left of the deepest overlaps (m), 0 if nothing overlapped by more than the
// slop.
HWY_NOINLINE F IslandLanes::push_apart(int rounds, Mask which) {
  F left = 0.0f;
  for (int round = 0; round < rounds && any(which); ++round) {
    work = work + choose(which, own_pairs, Whole(0));
    F deepest = 0.0f;
    for (int k = 0; k < b.pairs; ++k) {
      const PairRows& p = b.pair[k];
      const Mask near = which & (load(p.gap, o) <= kPushRange);
      if (!any(near)) continue;
      const F depth = -gap(p).size;
      const Mask deep = near & (depth > kPushTo);
      if (!any(deep)) continue;
      deepest = choose(deep, greater(deepest, depth), deepest);
      // The deeper point first; the other is looked at afresh in the next round.
      LaneTouches t;
      touches(p, 0.0f, t);
      F nx = 0.0f, ny = 0.0f, x = 0.0f, y = 0.0f, worst = 0.0f;
      for (int q = 0; q < t.count; ++q) {
        const Mask deeper = t.on[q] & (t.gap[q] < worst);
        nx = choose(deeper, t.nx[q], nx), ny = choose(deeper, t.ny[q], ny);
        x = choose(deeper, t.x[q], x), y = choose(deeper, t.y[q], y);
        worst = choose(deeper, t.gap[q], worst);
      }
      const Mask apart = deep & (-worst > kPushTo);
      if (any(apart)) push(p, nx, ny, x, y, worst, apart);
    }
    left = choose(which, deepest, left);
    which &= deepest > kSlop;
  }
  return left;
}

HWY_NOINLINE void IslandLanes::undo(const Side& m, Mask which) {
  which &= ~get_mask(m, &MoverRows::undone) & (get(m, &MoverRows::mass) > 0.0f);
  if (!any(which)) return;
  const auto back = [&](Row MoverRows::*good, Row MoverRows::*now) {
    put(m, now, choose(which, get(m, good), get(m, now)));
  };
  back(&MoverRows::good_x, &MoverRows::x), back(&MoverRows::good_y, &MoverRows::y);
  back(&MoverRows::good_c, &MoverRows::c), back(&MoverRows::good_s, &MoverRows::s);
  for (auto flag : {&MoverRows::undone, &MoverRows::dull, &MoverRows::touched})
    put(m, flag, get_mask(m, flag) | which);
  undone = undone + choose(which, Whole(1), Whole(0));
}

// Puts back to their last good pose those that overlap by more than `limit` (m), and what then
// overlaps with those.
HWY_NOINLINE void IslandLanes::put_back(F limit, Mask which) {
  for (int k = 1; k < b.movers; ++k) store(none(), b.mover[k].undone, o);
  // Ends: a mover is put back once, and good poses overlap no more than they may.
  for (bool again = true; again;) {
    again = false;
    for (int k = 0; k < b.pairs; ++k) {
      const PairRows& p = b.pair[k];
      const Side sa = side_a(p), sb = side_b(p);
      const Mask fixed_a = get_mask(sa, &MoverRows::undone) | (get(sa, &MoverRows::mass) <= 0.0f);
      const Mask candidates = which & ~(fixed_a & get_mask(sb, &MoverRows::undone));
      if (!any(candidates)) continue;
      const Mask deep = candidates & (-gap(p).size > limit);
      if (!any(deep)) continue;
      undo(sa, deep), undo(sb, deep);
      again = true;
    }
  }
}

// Pushes overlaps apart and puts back what that does not help. A start that was worse than the
// limit (poses given by a user) may only get better. Returns the deepest overlaps, m.
HWY_NOINLINE F IslandLanes::keep_good(F deepest, F before, Mask which) {
  const Mask deep = which & (deepest > kSlop);
  if (!any(deep)) return deepest;
  push_apart(kPushRounds, deep);
  deepest = choose(deep, survey(), deepest);
  const F limit = greater(before, kUndoLimit);
  const Mask lost = which & (deepest > limit);
  if (any(lost)) {
    put_back(limit, lost);
    deepest = choose(lost, survey(), deepest);
  }
  return deepest;
}
