// Gaps and points of contact of squares, discs and the round wall, a pair in each lane: included
// after lanes_inl.hpp.
/// A body: centre (m) and heading; `inner` as in Square.
struct Outline {
  F x, y, c, s;
  Whole inner = 0;
};

/// As Gap: how far two shapes are apart along a unit normal from the first to the second, m.
struct LaneGap {
  F size, nx, ny;
};

/// As Touch, each with its own normal; not where `on` is not set.
struct LaneTouches {
  int count = 0;
  F nx[4], ny[4], x[4], y[4], gap[4];
  Mask on[4];
};

constexpr float kTouchingCorners = 1e-5f;  // m; nearer corners are treated as faces that meet
constexpr float kPrefer = 1e-7f;           // m; by so much must b's side be better to be taken

/// The largest gap of two squares along the directions of their sides.
HWY_INLINE LaneGap gap_of_squares(const Outline& a, const Outline& b, F half) {
  const F dx = b.x - a.x, dy = b.y - a.y;
  const F a1 = a.c * dx + a.s * dy, a2 = a.c * dy - a.s * dx;
  const F b1 = b.c * dx + b.s * dy, b2 = b.c * dy - b.s * dx;
  const F qc = a.c * b.c + a.s * b.s, qs = a.c * b.s - a.s * b.c;
  const F reach = half + half * (abs(qc) + abs(qs));
  const Mask first_a = abs(a1) >= abs(a2), first_b = abs(b1) >= abs(b2);
  const F ua = choose(first_a, a1, a2), ub = choose(first_b, b1, b2);
  const Mask of_a = abs(ua) >= abs(ub), along = choose(of_a, first_a, first_b);
  const F u = choose(of_a, ua, ub), way = sign(u);
  const F c = choose(of_a, a.c, b.c), s = choose(of_a, a.s, b.s);
  return {abs(u) - reach, way * choose(along, c, -s), way * choose(along, s, c)};
}

HWY_INLINE LaneGap gap_of_square_and_disc(const Outline& a, const Outline& b, F half, F radius) {
  const F dx = b.x - a.x, dy = b.y - a.y;
  const F u = a.c * dx + a.s * dy, v = a.c * dy - a.s * dx;
  const F past_u = abs(u) - half, past_v = abs(v) - half;
  const Mask corner = (past_u > 0.0f) & (past_v > 0.0f), of_u = past_u >= past_v;
  const F to_corner = length(past_u, past_v);
  const F inverse = 1.0f / choose(corner, to_corner, 1.0f);
  const F nu = sign(u) * choose(corner, past_u * inverse, keep(of_u, 1.0f));
  const F nv = sign(v) * choose(corner, past_v * inverse, keep(~of_u, 1.0f));
  const F distance = choose(corner, to_corner, greater(past_u, past_v));
  return {distance - radius, a.c * nu - a.s * nv, a.s * nu + a.c * nv};
}

HWY_INLINE LaneGap gap_of_discs(const Outline& a, const Outline& b, F radius) {
  const F dx = b.x - a.x, dy = b.y - a.y, distance = length(dx, dy);
  const Mask apart = distance > 0.0f;
  const F inverse = 1.0f / choose(apart, distance, 1.0f);
  return {distance - radius - radius, choose(apart, dx * inverse, 1.0f), keep(apart, dy * inverse)};
}

/// Distance of a square's outermost corner from the wall, m; its centre relative to the tank's.
HWY_INLINE F gap_of_square_and_wall(const Outline& a, F half, F tank) {
  const F u = abs(a.c * a.x + a.s * a.y) + half, v = abs(a.c * a.y - a.s * a.x) + half;
  return tank - length(u, v);
}

// The face along which two squares are apart most, as seen from its square.
struct LaneFace {
  F best;      // m, largest gap over all four directions
  Mask first;  // the face is a's
  F nx, ny;    // its outward normal
  F way;       // 1, or -1 where the normal looks from b to a
  Whole side;  // which side of its square
};

// `inner` sides are left out where `offset` says that there may be some.
HWY_INLINE LaneFace face_between(const Outline& a, const Outline& b, F half, bool offset) {
  const F dx = b.x - a.x, dy = b.y - a.y;
  const F qc = a.c * b.c + a.s * b.s, qs = a.c * b.s - a.s * b.c;
  const F reach = half + half * (abs(qc) + abs(qs));
  const F u[4] = {a.c * dx + a.s * dy, a.c * dy - a.s * dx, b.c * dx + b.s * dy,
                  b.c * dy - b.s * dx};
  Whole widest = 0, chosen = 0;
  F wide = u[0], taken = u[0];
  for (int k = 1; k < 4; ++k) {
    const Mask wider = abs(u[k]) > abs(wide) + kPrefer;
    widest = choose(wider, Whole(k), widest), wide = choose(wider, u[k], wide);
  }
  chosen = widest, taken = wide;
  if (offset) {
    const Mask straight = abs(qc) >= abs(qs);
    const Whole quarter = choose(straight, choose(qc >= 0.0f, Whole(0), Whole(2)),
                                 choose(qs >= 0.0f, Whole(1), Whole(3)));
    Mask found = none();
    for (int k = 0; k < 4; ++k) {
      const Whole along = choose(u[k] < 0.0f, Whole((k & 1) + 2), Whole(k & 1));
      const Whole side_a = (k < 2 ? along : along + quarter) & 3;
      const Whole side_b = (k < 2 ? along - quarter + 2 : along + 2) & 3;
      const Mask open = ~(has_bit(a.inner, side_a) | has_bit(b.inner, side_b));
      const Mask take = open & (~found | (abs(u[k]) > abs(taken) + kPrefer));
      chosen = choose(take, Whole(k), chosen), taken = choose(take, u[k], taken);
      found |= open;
    }
    // Without an open side the widest stays: `taken` changes only where one was found.
  }
  LaneFace f;
  f.best = abs(wide) - reach;
  const Mask odd = has_bit(chosen, 0);
  f.first = ~has_bit(chosen, 1);
  const Mask back = taken < 0.0f;
  f.side = choose(odd, Whole(1), Whole(0)) + choose(back, Whole(2), Whole(0));
  f.side = choose(f.first, f.side, (f.side + 2) & 3);
  f.way = choose(f.first, 1.0f, -1.0f);
  const F c = choose(f.first, a.c, b.c), s = choose(f.first, a.s, b.s);
  const F out = sign(taken) * f.way;
  f.nx = out * choose(odd, -s, c), f.ny = out * choose(odd, c, s);
  return f;
}

/// Where two squares touch or are nearer than `margin`: the ends of the edge that lies most against
/// the face between them, clipped to it, or two corners that face each other.
HWY_INLINE void touch_squares(const Outline& a, const Outline& b, F half, F margin, bool offset,
                              LaneTouches& out) {
  const LaneFace f = face_between(a, b, half, offset);
  const F px = choose(f.first, a.x, b.x), py = choose(f.first, a.y, b.y);
  const F dx = choose(f.first, b.x, a.x) - px, dy = choose(f.first, b.y, a.y) - py;
  const F oc = choose(f.first, b.c, a.c), os = choose(f.first, b.s, a.s);
  // In the face's frame: n along its normal, t along the face. The other square's half axes that
  // point away from the face.
  const F centre_n = f.nx * dx + f.ny * dy, centre_t = f.nx * dy - f.ny * dx;
  const F qc = f.nx * oc + f.ny * os, qs = f.nx * os - f.ny * oc;
  const F s1 = sign(qc), s2 = sign(-qs);
  const F e1n = half * s1 * qc, e1t = half * s1 * qs;
  const F e2n = -(half * s2 * qs), e2t = half * s2 * qc;
  const F near_n = centre_n - e1n - e2n, near_t = centre_t - e1t - e2t;
  const Mask flat2 = e1n >= e2n;  // axis 1 is the steeper one
  const F far_n = near_n + 2.0f * choose(flat2, e2n, e1n);
  const F far_t = near_t + 2.0f * choose(flat2, e2t, e1t);
  const F third_n = near_n + 2.0f * choose(flat2, e1n, e2n);
  const F third_t = near_t + 2.0f * choose(flat2, e1t, e2t);
  // Two corners that face each other.
  const F corner_t = sign(near_t) * half, to_n = half - near_n, to_t = corner_t - near_t;
  const Mask corner = (abs(near_t) > half) &
                      (to_n * (far_n - near_n) + to_t * (far_t - near_t) <= 0.0f) &
                      (to_n * (third_n - near_n) + to_t * (third_t - near_t) <= 0.0f);
  const F distance = length(to_n, to_t), corner_gap = near_n - half;
  const Mask flush = corner_gap < kTouchingCorners;
  Mask corner_on = corner & (distance <= margin);
  if (offset) {  // beyond a side that the assembly covers, the corner is the neighbour's
    const Whole inner = choose(f.first, a.inner, b.inner),
                other = choose(f.first, b.inner, a.inner);
    const Whole beside = (f.side + choose(near_t > 0.0f, Whole(1), Whole(3))) & 3;
    const Whole side1 = choose(s1 > 0.0f, Whole(2), Whole(0));
    const Whole side2 = choose(s2 > 0.0f, Whole(3), Whole(1));
    corner_on &= ~(has_bit(inner, beside) | has_bit(other, side1) | has_bit(other, side2));
  }
  // The incident edge, cut off at the ends of the face.
  const Mask swap = near_t > far_t;
  F low_n = choose(swap, far_n, near_n), low_t = choose(swap, far_t, near_t);
  F high_n = choose(swap, near_n, far_n), high_t = choose(swap, near_t, far_t);
  const Mask beside = (low_t <= half) & (high_t >= -half);
  const F extent = high_t - low_t;
  const F slope = (high_n - low_n) / choose(extent > 0.0f, extent, 1.0f);
  const Mask cut_high = high_t > half, cut_low = low_t < -half;
  const F end_n = choose(cut_high, low_n + slope * (half - low_t), high_n);
  const F end_t = choose(cut_high, half, high_t);
  low_n = choose(cut_low, low_n + slope * (-half - low_t), low_n);
  low_t = choose(cut_low, -half, low_t);
  const Mask near = f.best <= margin;
  const F inverse = 1.0f / choose(distance > 0.0f, distance, 1.0f);
  const Mask pointed = corner & ~flush;
  const F local_n = choose(pointed, -(to_n * inverse), 1.0f),
          local_t = keep(pointed, -(to_t * inverse));
  const F nx = f.way * (f.nx * local_n - f.ny * local_t);
  const F ny = f.way * (f.ny * local_n + f.nx * local_t);
  const F gap0 = choose(corner, choose(flush, corner_gap, distance), low_n - half);
  const F gap1 = end_n - half;
  const F n0 = choose(pointed, 0.5f * (half + near_n), half + 0.5f * gap0);
  const F t0 = choose(corner, choose(flush, corner_t, 0.5f * (corner_t + near_t)), low_t);
  const F n1 = half + 0.5f * gap1;
  out.count = 2;
  out.nx[0] = out.nx[1] = nx, out.ny[0] = out.ny[1] = ny;
  out.gap[0] = gap0, out.gap[1] = gap1;
  out.x[0] = px + f.nx * n0 - f.ny * t0, out.y[0] = py + f.ny * n0 + f.nx * t0;
  out.x[1] = px + f.nx * n1 - f.ny * end_t, out.y[1] = py + f.ny * n1 + f.nx * end_t;
  out.on[0] = near & choose(corner, corner_on, beside & (gap0 <= margin));
  out.on[1] = near & ~corner & beside & (gap1 <= margin);
}

HWY_INLINE void touch_square_and_disc(const Outline& a, const Outline& b, F half, F radius,
                                      F margin, LaneTouches& out) {
  const F dx = b.x - a.x, dy = b.y - a.y;
  const F u = a.c * dx + a.s * dy, v = a.c * dy - a.s * dx;
  const F past_u = abs(u) - half, past_v = abs(v) - half;
  const Mask out_u = past_u > 0.0f, out_v = past_v > 0.0f;
  const Mask inner_u = has_bit(a.inner, choose(u < 0.0f, Whole(2), Whole(0)));
  const Mask inner_v = has_bit(a.inner, choose(v < 0.0f, Whole(3), Whole(1)));
  const Mask corner = out_u & out_v;
  const F to_corner = length(past_u, past_v);
  const F inverse = 1.0f / choose(corner, to_corner, 1.0f);
  const Mask of_u = ((past_u >= past_v) & ~inner_u) | inner_v;
  const F nu = sign(u) * choose(corner, past_u * inverse, keep(of_u, 1.0f));
  const F nv = sign(v) * choose(corner, past_v * inverse, keep(~of_u, 1.0f));
  const F distance = choose(corner, to_corner, choose(of_u, past_u, past_v));
  const F gap = distance - radius, back = radius + 0.5f * gap;
  out.count = 1;
  out.nx[0] = a.c * nu - a.s * nv, out.ny[0] = a.s * nu + a.c * nv;
  out.x[0] = b.x - out.nx[0] * back, out.y[0] = b.y - out.ny[0] * back;
  out.gap[0] = gap;
  out.on[0] = (gap <= margin) & ~((out_u & inner_u) | (out_v & inner_v));
}

HWY_INLINE void touch_discs(const Outline& a, const Outline& b, F radius, F margin,
                            LaneTouches& out) {
  const LaneGap g = gap_of_discs(a, b, radius);
  const F reach = radius + 0.5f * g.size;
  out.count = 1;
  out.nx[0] = g.nx, out.ny[0] = g.ny, out.gap[0] = g.size;
  out.x[0] = a.x + g.nx * reach, out.y[0] = a.y + g.ny * reach;
  out.on[0] = g.size <= margin;
}

/// The corners of a square near the wall, each with the normal towards the tank's centre. The
/// places are relative to that centre, too.
HWY_INLINE void touch_square_and_wall(const Outline& a, F half, F tank, F margin,
                                      LaneTouches& out) {
  out.count = 4;
  for (int k = 0; k < 4; ++k) {
    const F u = k == 0 || k == 3 ? half : -half, v = k < 2 ? half : -half;
    const F x = a.x + a.c * u - a.s * v, y = a.y + a.s * u + a.c * v;
    const F distance = length(x, y), gap = tank - distance;
    const F inverse = 1.0f / choose(distance > 0.0f, distance, 1.0f);
    out.nx[k] = -(x * inverse), out.ny[k] = -(y * inverse);
    out.x[k] = x, out.y[k] = y, out.gap[k] = gap;
    out.on[k] = (gap <= margin) & (distance > 0.0f);
  }
}

HWY_INLINE void touch_disc_and_wall(const Outline& a, F radius, F tank, F margin,
                                    LaneTouches& out) {
  const F distance = length(a.x, a.y), gap = tank - radius - distance;
  const F inverse = 1.0f / choose(distance > 0.0f, distance, 1.0f);
  out.count = 1;
  out.nx[0] = -(a.x * inverse), out.ny[0] = -(a.y * inverse);
  out.x[0] = a.x - out.nx[0] * radius, out.y[0] = a.y - out.ny[0] * radius;
  out.gap[0] = gap;
  out.on[0] = (gap <= margin) & (distance > 0.0f);
}
