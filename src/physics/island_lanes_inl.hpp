// One vector of islands on their way through a span of time: included after shapes_inl.hpp.

constexpr float kStride = 2e-3f;       // m, most that a pair moves relatively in a substep
constexpr float kTurnError = 4e-5f;    // m, most that an arc strays from its tangent in a substep
constexpr float kWallShare = 0.3f;     // the round wall is smooth: sliding along it costs less
constexpr float kPushRange = 2e-3f;    // m, pairs farther apart are not pushed together
constexpr float kLongestPush = 2e-3f;  // m, per contact and sweep
constexpr float kUndoLimit = 4.5e-4f;  // m, below kOverlapLimit by more than rounding
constexpr int kPushRounds = 40;        // sweeps that push overlaps apart after a substep
constexpr float kTiny = 1e-12f;        // keeps quotients finite in lanes that do not use them

constexpr int kLanes = LILYTANK_LANES;
using Row = RowOf<kLanes>;
using WholeRow = WholeRowOf<kLanes>;
using MoverRows = MoverRowsOf<kLanes>;
using PairRows = PairRowsOf<kLanes>;
using PointRows = PointRowsOf<kLanes>;
using Block = IslandBlock<kLanes>;

/// Reads and writes a row of a block.
HWY_INLINE F load(const Row& row, std::size_t first) {
  return load(row.v + first);
}
HWY_INLINE void store(F value, Row& row, std::size_t first) {
  store(value, row.v + first);
}
HWY_INLINE Mask load_mask(const Row& row, std::size_t first) {
  return mask_of(load(row.v + first));
}
HWY_INLINE void store(Mask value, Row& row, std::size_t first) {
  store(float_of(value), row.v + first);
}
HWY_INLINE Whole load_whole(const WholeRow& row, std::size_t first) {
  return load(row.v + first);
}

/// One side of a pair: a mover of each island.
struct Side {
  bool uniform;
  MoverRows* row;  ///< where uniform
  Whole index;
};

/// The movers of one vector of islands and the pairs among them: poses, and what they may do.
class IslandLanes {
 public:
  IslandLanes(Block& block, std::size_t first)
      : b(block),
        o(first),
        half(load(b.half, o)),
        radius(load(b.radius, o)),
        tank(load(b.tank, o)) {
    alignas(64) float in_use[kLanes];
    for (int k = 0; k < kLanes; ++k) in_use[k] = k < b.count ? 1.0f : 0.0f;
    used = load(in_use + o) > 0.0f;
    own_pairs = load_whole(b.own_pairs, o);
    work = undone = Whole(0);
  }

  HWY_INLINE Side side_a(const PairRows& p) const { return side(p.uniform, p.a, p.at_a); }
  HWY_INLINE Side side_b(const PairRows& p) const { return side(p.uniform, p.b, p.at_b); }
  HWY_INLINE F get(const Side& s, Row MoverRows::*field) const {
    return s.uniform ? load(s.row->*field, o) : gather((b.mover[0].*field).v, s.index);
  }
  HWY_INLINE Mask get_mask(const Side& s, Row MoverRows::*field) const {
    return mask_of(get(s, field));
  }
  HWY_INLINE void put(const Side& s, Row MoverRows::*field, F value) {
    if (s.uniform)
      store(value, s.row->*field, o);
    else
      scatter(value, (b.mover[0].*field).v, s.index);
  }
  HWY_INLINE void put(const Side& s, Row MoverRows::*field, Mask value) {
    put(s, field, float_of(value));
  }

  /// Measures the separations of all pairs; returns the deepest overlaps (m, 0 if there is none).
  HWY_NOINLINE F survey() {
    F deepest = 0.0f;
    for (int k = 0; k < b.pairs; ++k) {
      PairRows& p = b.pair[k];
      const LaneGap g = gap(p);
      store(g.size, p.gap, o), store(g.nx, p.nx, o), store(g.ny, p.ny, o);
      deepest = greater(deepest, -g.size);
    }
    return deepest;
  }

  F push_apart(int rounds, Mask which);
  F keep_good(F deepest, F before, Mask which);
  void begin();
  void mark_touched(Mask which);
  void accept(Mask which);
  void move(F h, Mask which);

  /// How fast the pairs move.
  struct Limits {
    F free_time;  // s in which nothing can touch if twists stay
    F fastest;    // m/s, no two bodies close faster
    F longest;    // s, longest substep that keeps contact points accurate
  };
  Limits limits(F left) const;

  HWY_NOINLINE void touches(const PairRows& p, F margin, LaneTouches& out) const {
    const Outline second = shape(side_b(p), p.bx, p.by, p.inner_b, p.offset);
    if (p.kinds == 1) {  // squares only: nearly always
      touch_squares(first_shape(p), second, half, margin, p.offset, out);
      return;
    }
    const Whole kind = load_whole(p.kind, o);
    out.count = 0;
    const auto take = [&](PairKind k, auto&& touch) {
      if (!p.has(k)) return;
      LaneTouches some;
      touch(some);
      const Mask of_kind = kind == Whole(static_cast<std::int32_t>(k));
      for (int q = 0; q < some.count; ++q) {
        if (q >= out.count) {
          out.nx[q] = some.nx[q], out.ny[q] = some.ny[q], out.x[q] = some.x[q];
          out.y[q] = some.y[q], out.gap[q] = some.gap[q], out.on[q] = some.on[q] & of_kind;
          out.count = q + 1;
          continue;
        }
        out.nx[q] = choose(of_kind, some.nx[q], out.nx[q]);
        out.ny[q] = choose(of_kind, some.ny[q], out.ny[q]);
        out.x[q] = choose(of_kind, some.x[q], out.x[q]);
        out.y[q] = choose(of_kind, some.y[q], out.y[q]);
        out.gap[q] = choose(of_kind, some.gap[q], out.gap[q]);
        out.on[q] = choose(of_kind, some.on[q], out.on[q]);
      }
    };
    take(PairKind::squares,
         [&](LaneTouches& t) { touch_squares(first_shape(p), second, half, margin, p.offset, t); });
    take(PairKind::square_disc, [&](LaneTouches& t) {
      touch_square_and_disc(first_shape(p), second, half, radius, margin, t);
    });
    take(PairKind::discs,
         [&](LaneTouches& t) { touch_discs(first_shape(p), second, radius, margin, t); });
    take(PairKind::wall_square,
         [&](LaneTouches& t) { touch_square_and_wall(second, half, tank, margin, t); });
    take(PairKind::wall_disc,
         [&](LaneTouches& t) { touch_disc_and_wall(second, radius, tank, margin, t); });
  }

  Block& b;
  const std::size_t o;  // the first lane
  Mask used;
  Whole own_pairs, work, undone;

 private:
  HWY_INLINE Side side(bool uniform, int mover, const WholeRow& at) const {
    return {uniform, &b.mover[static_cast<std::size_t>(mover)],
            uniform ? Whole(0) : load_whole(at, o)};
  }
  // A body of a mover.
  HWY_INLINE Outline shape(const Side& s, const Row& ox, const Row& oy, const WholeRow& inner,
                           bool offset) const {
    Outline out{get(s, &MoverRows::x), get(s, &MoverRows::y), get(s, &MoverRows::c),
                get(s, &MoverRows::s), 0};
    if (!offset) return out;
    const F px = load(ox, o), py = load(oy, o);
    out.x += out.c * px - out.s * py, out.y += out.s * px + out.c * py;
    out.inner = load_whole(inner, o);
    return out;
  }
  HWY_INLINE Outline first_shape(const PairRows& p) const {
    return shape(side_a(p), p.ax, p.ay, p.inner_a, p.offset);
  }

  HWY_INLINE LaneGap gap(const PairRows& p) const {
    const Outline second = shape(side_b(p), p.bx, p.by, p.inner_b, p.offset);
    const Mask on = load_mask(p.on, o);
    LaneGap g;
    if (p.kinds == 1) {
      g = gap_of_squares(first_shape(p), second, half);
    } else {
      g = mixed_gap(p, second);
    }
    g.size = choose(on, g.size, 1.0f);
    return g;
  }
  HWY_NOINLINE LaneGap mixed_gap(const PairRows& p, const Outline& second) const {
    const Whole kind = load_whole(p.kind, o);
    LaneGap g{1.0f, 0.0f, 0.0f};
    const auto take = [&](PairKind k, const LaneGap& some) {
      const Mask of_kind = kind == Whole(static_cast<std::int32_t>(k));
      g.size = choose(of_kind, some.size, g.size);
      g.nx = choose(of_kind, some.nx, g.nx), g.ny = choose(of_kind, some.ny, g.ny);
    };
    if (p.has(PairKind::squares))
      take(PairKind::squares, gap_of_squares(first_shape(p), second, half));
    if (p.has(PairKind::square_disc))
      take(PairKind::square_disc, gap_of_square_and_disc(first_shape(p), second, half, radius));
    if (p.has(PairKind::discs)) take(PairKind::discs, gap_of_discs(first_shape(p), second, radius));
    if (p.has(PairKind::wall_square))
      take(PairKind::wall_square, {gap_of_square_and_wall(second, half, tank), 0.0f, 0.0f});
    if (p.has(PairKind::wall_disc))
      take(PairKind::wall_disc, {tank - radius - length(second.x, second.y), 0.0f, 0.0f});
    return g;
  }

  void push(const PairRows& p, F nx, F ny, F x, F y, F gap, Mask which);
  void hold_spin(const Side& a, const Side& c, F moved, F nx, F ny, Mask which);
  void undo(const Side& mover, Mask which);
  void put_back(F limit, Mask which);

  F half, radius, tank;
};

HWY_NOINLINE IslandLanes::Limits IslandLanes::limits(F left) const {
  Limits l{left, 0.0f, left};
  const F corner = load(b.corner, o);
  for (int k = 0; k < b.pairs; ++k) {
    const PairRows& p = b.pair[k];
    const Side sa = side_a(p), sb = side_b(p);
    const Mask on = load_mask(p.on, o), wall = load_mask(p.wall, o);
    const F omega_a = get(sa, &MoverRows::omega), omega_b = get(sb, &MoverRows::omega);
    const F vax = get(sa, &MoverRows::vx), vay = get(sa, &MoverRows::vy);
    const F vbx = get(sb, &MoverRows::vx), vby = get(sb, &MoverRows::vy);
    F vx = vbx - vax, vy = vby - vay;
    if (p.offset) {  // velocities of the bodies
      const F ca = get(sa, &MoverRows::c), na = get(sa, &MoverRows::s);
      const F cb = get(sb, &MoverRows::c), nb = get(sb, &MoverRows::s);
      const F pax = load(p.ax, o), pay = load(p.ay, o), pbx = load(p.bx, o), pby = load(p.by, o);
      vx += omega_a * (na * pax + ca * pay) - omega_b * (nb * pbx + cb * pby);
      vy += omega_b * (cb * pbx - nb * pby) - omega_a * (ca * pax - na * pay);
    }
    const F wa = abs(omega_a), wb = abs(omega_b), speed = length(vx, vy);
    l.fastest = greater(l.fastest, keep(on, speed + corner * (wa + wb)));
    // A square's extent in a direction changes by no more than half its side per radian, its
    // distance from the tank's centre by half its diagonal; members of a chain move on arcs.
    F turning = choose(wall, corner, half) * (wa + wb);
    if (p.offset)
      turning += 0.5f * left * (wa * wa * load(p.arm_a, o) + wb * wb * load(p.arm_b, o));
    // Along the normal of the gap, fixed in the tank, nothing closes faster than this.
    const F along = choose(wall, -speed, load(p.nx, o) * vx + load(p.ny, o) * vy);
    const F closing = turning - along, size = load(p.gap, o);
    const Mask hit = on & (closing > 0.0f) & (size <= closing * left);
    if (!any(hit)) continue;
    const F time = greater(size, 0.0f) / greater(closing, kTiny);
    l.free_time = choose(hit, lesser(l.free_time, time), l.free_time);
    // How fast the two move relative to axes that turn with the pair: what changes where they
    // touch.
    const F mean = 0.5f * (omega_a + omega_b);
    const F dx = get(sb, &MoverRows::x) - get(sa, &MoverRows::x);
    const F dy = get(sb, &MoverRows::y) - get(sa, &MoverRows::y);
    const F reach_a = get(sa, &MoverRows::reach), reach_b = get(sb, &MoverRows::reach);
    F pace = length(vbx - vax + mean * dy, vby - vay - mean * dx) +
             0.5f * abs(omega_b - omega_a) * (reach_a + reach_b);
    pace = choose(wall, kWallShare * closing, pace);
    const Mask quick = hit & (pace * l.longest > kStride);
    l.longest = choose(quick, kStride / greater(pace, kTiny), l.longest);
    // The arc of no point may stray far from its tangent.
    const auto limit_turn = [&](F turn, F reach) {
      const Mask sharp = hit & (turn * turn * l.longest * l.longest * reach > 2 * kTurnError);
      if (!any(sharp)) return;
      const F least = root(2 * kTurnError / greater(reach, kTiny)) / greater(turn, kTiny);
      l.longest = choose(sharp, least, l.longest);
    };
    limit_turn(wa, reach_a), limit_turn(wb, reach_b);
  }
  return l;
}

// `h` is 0 in lanes that rest.
HWY_NOINLINE void IslandLanes::move(F h, Mask which) {
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    store(load(m.x, o) + h * load(m.vx, o), m.x, o);
    store(load(m.y, o) + h * load(m.vy, o), m.y, o);
    F c = load(m.c, o), s = load(m.s, o);
    turn(c, s, h * load(m.omega, o), which);
    store(c, m.c, o), store(s, m.s, o);
  }
}

// Notes twists and poses at the start.
HWY_NOINLINE void IslandLanes::begin() {
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    store(load(m.vx, o), m.course_x, o), store(load(m.vy, o), m.course_y, o);
    store(load(m.omega, o), m.course_omega, o);
    for (Row* flag : {&m.touched, &m.undone, &m.dull}) store(none(), *flag, o);
    store(load(m.x, o), m.good_x, o), store(load(m.y, o), m.good_y, o);
    store(load(m.c, o), m.good_c, o), store(load(m.s, o), m.good_s, o);
  }
}

// Marks what no longer has the twist of the start.
HWY_NOINLINE void IslandLanes::mark_touched(Mask which) {
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    const Mask off = (load(m.vx, o) != load(m.course_x, o)) |
                     (load(m.vy, o) != load(m.course_y, o)) |
                     (load(m.omega, o) != load(m.course_omega, o));
    store(load_mask(m.touched, o) | (which & off), m.touched, o);
  }
}

// Poses as they are now count as good.
HWY_NOINLINE void IslandLanes::accept(Mask which) {
  for (int k = 1; k < b.movers; ++k) {
    MoverRows& m = b.mover[k];
    store(load(m.x, o), m.good_x, o), store(load(m.y, o), m.good_y, o);
    store(load(m.c, o), m.good_c, o), store(load(m.s, o), m.good_s, o);
  }
  mark_touched(which);
}
