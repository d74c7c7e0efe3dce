#include "collide.hpp"

namespace lilytank::reference {
namespace {

constexpr double kTouching = 1e-5;  // m; nearer corners are treated as faces that meet
constexpr double kPrefer = 1e-7;    // m; by so much must b's side be better to be taken

double sign(double v) {
  return v < 0 ? -1.0 : 1.0;
}

// A point in the frame of the reference face: n along its normal, t along the face.
struct Local {
  double n = 0, t = 0;
};

double dot(Local a, Local b) {
  return a.n * b.n + a.t * b.t;
}
Local minus(Local a, Local b) {
  return {a.n - b.n, a.t - b.t};
}

// The reference square, its face (normal at angle of `out`), and the other square.
struct Reference {
  const Square* square = nullptr;
  const Square* other = nullptr;
  Rot out;            // the face's outward normal in the tank
  int side = 0;       // which side of `square` it is
  bool first = true;  // the reference square is a
};

// The quarter turn nearest to a rotation.
int nearest_quarter(Rot r) {
  if (std::fabs(r.c) >= std::fabs(r.s)) return r.c >= 0 ? 0 : 2;
  return r.s >= 0 ? 1 : 3;
}

struct Choice {
  double best = 0;  // largest separation over all four directions
  Reference face;   // the face to use
};

// Directions 0, 1 are a's x and y, 2, 3 are b's. `u` are the components of b's centre from a's.
Choice choose_face(const Square& a, const Square& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const Rot q = between(a.r, b.r);
  const double reach = a.half + b.half * (std::fabs(q.c) + std::fabs(q.s));
  const double u[4] = {a.r.c * dx + a.r.s * dy, a.r.c * dy - a.r.s * dx, b.r.c * dx + b.r.s * dy,
                       b.r.c * dy - b.r.s * dx};
  const int turn = nearest_quarter(q);
  int chosen = -1, widest = 0;
  for (int k = 0; k < 4; ++k) {
    if (std::fabs(u[k]) > std::fabs(u[widest]) + kPrefer) widest = k;
    // The side of a that looks along this direction to b, and the side of b that looks back.
    const int along = (k & 1) + (u[k] < 0 ? 2 : 0);
    const int side_a = (k < 2 ? along : along + turn) & 3;
    const int side_b = (k < 2 ? along - turn + 2 : along + 2) & 3;
    if ((a.inner >> side_a & 1) || (b.inner >> side_b & 1)) continue;
    if (chosen < 0 || std::fabs(u[k]) > std::fabs(u[chosen]) + kPrefer) chosen = k;
  }
  if (chosen < 0) chosen = widest;
  Choice choice;
  choice.best = std::fabs(u[widest]) - reach;
  const bool first = chosen < 2;
  const int along = (chosen & 1) + (u[chosen] < 0 ? 2 : 0);
  const int side = first ? along : (along + 2) & 3;  // b's face looks back to a
  choice.face = {first ? &a : &b, first ? &b : &a, compose(first ? a.r : b.r, quarter(side)), side,
                 first};
  return choice;
}

// The corner of the other square nearest to the face's plane and its two neighbours; `far` ends
// the edge that lies most against the face.
struct Incident {
  Local near, far, third;
  int side_far = 0, side_third = 0;  // sides of the other square beyond the two edges at `near`
};

Incident incident_of(const Reference& ref) {
  const Square &p = *ref.square, &o = *ref.other;
  const double dx = o.x - p.x, dy = o.y - p.y;
  const Local centre{ref.out.c * dx + ref.out.s * dy, ref.out.c * dy - ref.out.s * dx};
  const Rot q = between(ref.out, o.r);
  // The other's half axes that point away from the face.
  const double s1 = sign(q.c), s2 = sign(-q.s);
  const Local e1{o.half * s1 * q.c, o.half * s1 * q.s}, e2{-o.half * s2 * q.s, o.half * s2 * q.c};
  Incident in;
  in.near = {centre.n - e1.n - e2.n, centre.t - e1.t - e2.t};
  const int side1 = s1 > 0 ? 2 : 0, side2 = s2 > 0 ? 3 : 1;  // sides that look to the face
  const Local along1{in.near.n + 2 * e1.n, in.near.t + 2 * e1.t};
  const Local along2{in.near.n + 2 * e2.n, in.near.t + 2 * e2.t};
  const bool flat2 = e1.n >= e2.n;  // axis 1 is the steeper one: its side is the edge along axis 2
  in.far = flat2 ? along2 : along1, in.third = flat2 ? along1 : along2;
  in.side_far = flat2 ? side1 : side2, in.side_third = flat2 ? side2 : side1;
  return in;
}

// Back to the tank: a point, and the unit normal from a to b.
void put(const Reference& ref, Local at, double gap, Manifold& m) {
  const Square& p = *ref.square;
  m.touch[m.count++] = {p.x + ref.out.c * at.n - ref.out.s * at.t,
                        p.y + ref.out.s * at.n + ref.out.c * at.t, gap};
}

void set_normal(const Reference& ref, Local n, Manifold& m) {
  const double way = ref.first ? 1 : -1;
  m.nx = way * (ref.out.c * n.n - ref.out.s * n.t);
  m.ny = way * (ref.out.s * n.n + ref.out.c * n.t);
}

// Two corners face each other: true if that is so, with the point in `m` if it is near enough.
bool corners(const Reference& ref, const Incident& in, double margin, Manifold& m) {
  const double h = ref.square->half;
  if (std::fabs(in.near.t) <= h) return false;
  const Local corner{h, sign(in.near.t) * h};
  const Local to_corner = minus(corner, in.near);
  if (dot(to_corner, minus(in.far, in.near)) > 0) return false;
  if (dot(to_corner, minus(in.third, in.near)) > 0) return false;
  // Beyond a side that the assembly covers, the corner belongs to the neighbour there.
  const int side = (ref.side + (in.near.t > 0 ? 1 : 3)) & 3;
  if (ref.square->inner >> side & 1) return true;
  if ((ref.other->inner >> in.side_far & 1) || (ref.other->inner >> in.side_third & 1)) return true;
  const double distance = std::sqrt(dot(to_corner, to_corner));
  if (distance > margin) return true;
  const double gap = in.near.n - h;
  if (gap < kTouching) {
    set_normal(ref, {1, 0}, m);
    put(ref, {h + 0.5 * gap, corner.t}, gap, m);
  } else {
    set_normal(ref, {-to_corner.n / distance, -to_corner.t / distance}, m);
    put(ref, {0.5 * (corner.n + in.near.n), 0.5 * (corner.t + in.near.t)}, distance, m);
  }
  return true;
}

// The incident edge, cut off at the ends of the reference face.
void clip(const Reference& ref, const Incident& in, double margin, Manifold& m) {
  const double h = ref.square->half;
  Local low = in.near, high = in.far;
  if (low.t > high.t) std::swap(low, high);
  if (low.t > h || high.t < -h) return;
  const double slope = (high.n - low.n) / (high.t - low.t);
  if (high.t > h) high = {low.n + slope * (h - low.t), h};
  if (low.t < -h) low = {low.n + slope * (-h - low.t), -h};
  set_normal(ref, {1, 0}, m);
  for (const Local& end : {low, high}) {
    const double gap = end.n - h;
    if (gap <= margin) put(ref, {h + 0.5 * gap, end.t}, gap, m);
  }
}

}  // namespace

Manifold collide(const Square& a, const Square& b, double margin) {
  Manifold m;
  const Choice choice = choose_face(a, b);
  if (choice.best > margin) return m;
  const Incident in = incident_of(choice.face);
  if (!corners(choice.face, in, margin, m)) clip(choice.face, in, margin, m);
  return m;
}

Manifold collide(const Square& a, const Disc& b, double margin) {
  Manifold m;
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double u = a.r.c * dx + a.r.s * dy, v = a.r.c * dy - a.r.s * dx;
  const double past_u = std::fabs(u) - a.half, past_v = std::fabs(v) - a.half;
  const int side_u = u < 0 ? 2 : 0, side_v = v < 0 ? 3 : 1;
  const bool inner_u = a.inner >> side_u & 1, inner_v = a.inner >> side_v & 1;
  if ((past_u > 0 && inner_u) || (past_v > 0 && inner_v)) return m;  // the neighbour's
  double nu = 0, nv = 0, distance = 0;  // normal in a's frame, from the surface to the centre
  if (past_u > 0 && past_v > 0) {
    distance = std::sqrt(past_u * past_u + past_v * past_v);
    nu = sign(u) * past_u / distance, nv = sign(v) * past_v / distance;
  } else if ((past_u >= past_v && !inner_u) || inner_v) {
    distance = past_u, nu = sign(u);
  } else {
    distance = past_v, nv = sign(v);
  }
  const double gap = distance - b.radius;
  if (gap > margin) return m;
  m.nx = a.r.c * nu - a.r.s * nv, m.ny = a.r.s * nu + a.r.c * nv;
  const double back = b.radius + 0.5 * gap;
  m.count = 1;
  m.touch[0] = {b.x - m.nx * back, b.y - m.ny * back, gap};
  return m;
}

Manifold collide(const Disc& a, const Disc& b, double margin) {
  Manifold m;
  const double dx = b.x - a.x, dy = b.y - a.y, distance = std::sqrt(dx * dx + dy * dy);
  const double gap = distance - a.radius - b.radius;
  if (gap > margin) return m;
  m.nx = distance > 0 ? dx / distance : 1, m.ny = distance > 0 ? dy / distance : 0;
  const double out = a.radius + 0.5 * gap;
  m.count = 1;
  m.touch[0] = {a.x + m.nx * out, a.y + m.ny * out, gap};
  return m;
}

WallManifold collide_wall(const Square& a, double tank, double margin) {
  WallManifold m;
  for (int k = 0; k < 4; ++k) {
    const double u = k == 0 || k == 3 ? a.half : -a.half, v = k < 2 ? a.half : -a.half;
    const double x = a.x + a.r.c * u - a.r.s * v, y = a.y + a.r.s * u + a.r.c * v;
    const double distance2 = x * x + y * y;
    if (margin < tank && distance2 < (tank - margin) * (tank - margin)) continue;
    const double distance = std::sqrt(distance2);
    if (!(distance > 0)) continue;
    m.nx[m.count] = -x / distance, m.ny[m.count] = -y / distance;
    m.touch[m.count++] = {x, y, tank - distance};
  }
  return m;
}

Manifold collide_wall(const Disc& a, double tank, double margin) {
  Manifold m;
  const double distance = std::sqrt(a.x * a.x + a.y * a.y), gap = tank - a.radius - distance;
  if (gap > margin || !(distance > 0)) return m;
  m.nx = -a.x / distance, m.ny = -a.y / distance;
  m.count = 1;
  m.touch[0] = {a.x - m.nx * a.radius, a.y - m.ny * a.radius, gap};
  return m;
}

}  // namespace lilytank::reference
