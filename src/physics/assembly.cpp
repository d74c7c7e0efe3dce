#include "assembly.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lilytank {
namespace {

constexpr int kStepX[4] = {1, 0, -1, 0}, kStepY[4] = {0, 1, 0, -1};

Cell turned(Cell c, int quarters) {
  switch (quarters & 3) {
    case 0:
      return c;
    case 1:
      return {-c.y, c.x};
    case 2:
      return {-c.x, -c.y};
    default:
      return {c.y, -c.x};
  }
}

bool holds(const Face& face) {
  return face.status == FaceStatus::latched || face.status == FaceStatus::bonded;
}

void derive_body_pose(const State& state, int slot, int body, Assemblies& out) {
  const Rot r{state.c[slot], state.s[slot]};
  if (body == slot && out.next[slot] < 0 && state.turn[slot] == 0) {  // alone: nothing to turn
    out.x[slot] = state.x[slot], out.y[slot] = state.y[slot];
    out.c[slot] = r.c, out.s[slot] = r.s;
    out.vx[slot] = state.vx[slot], out.vy[slot] = state.vy[slot],
    out.omega[slot] = state.omega[slot];
    return;
  }
  const double ox = out.offset_x[body], oy = out.offset_y[body];
  const double rx = r.c * ox - r.s * oy, ry = r.s * ox + r.c * oy;
  const Rot heading = compose(r, quarter(state.turn[body]));
  out.x[body] = state.x[slot] + rx;
  out.y[body] = state.y[slot] + ry;
  out.c[body] = heading.c;
  out.s[body] = heading.s;
  out.vx[body] = state.vx[slot] - state.omega[slot] * ry;
  out.vy[body] = state.vy[slot] + state.omega[slot] * rx;
  out.omega[body] = state.omega[slot];
}

void clear_slot(int slot, Assemblies& out) {
  out.mass[slot] = out.inertia[slot] = out.own_inertia[slot] = out.reach[slot] = 0;
  out.inverse_mass[slot] = out.inverse_inertia[slot] = 0;
  out.centre_x[slot] = out.centre_y[slot] = 0;
  out.first[slot] = -1;
}

void derive_ball(const Model& model, int slot, Assemblies& out) {
  clear_slot(slot, out);
  out.mass[slot] = model.ball.mass;
  out.inverse_mass[slot] = 1 / model.ball.mass;
  out.reach[slot] = model.ball.radius;
  out.first[slot] = slot;
}

// Sums over the member list, which must be right.
void derive_properties(const Model& model, const State& state, int slot, Assemblies& out) {
  const double side = model.module.side;
  double n = 0, sum_x = 0, sum_y = 0;
  for (int i = out.first[slot]; i >= 0; i = out.next[i])
    n += 1, sum_x += state.cell_x[i], sum_y += state.cell_y[i];
  const double centre_x = sum_x / n * side, centre_y = sum_y / n * side;
  double spread = 0, reach2 = 0;
  for (int i = out.first[slot]; i >= 0; i = out.next[i]) {
    out.offset_x[i] = state.cell_x[i] * side - centre_x;
    out.offset_y[i] = state.cell_y[i] * side - centre_y;
    const double dx = std::fabs(out.offset_x[i]), dy = std::fabs(out.offset_y[i]);
    const double far_x = dx + side / 2, far_y = dy + side / 2;
    spread += dx * dx + dy * dy;
    reach2 = std::fmax(reach2, far_x * far_x + far_y * far_y);
  }
  out.mass[slot] = n * model.module.mass;
  out.own_inertia[slot] = n * model.module.inertia();
  out.inertia[slot] = out.own_inertia[slot] + model.module.mass * spread;
  out.inverse_mass[slot] = 1 / out.mass[slot];
  out.inverse_inertia[slot] = 1 / out.inertia[slot];
  out.reach[slot] = std::sqrt(reach2);
  out.centre_x[slot] = centre_x;
  out.centre_y[slot] = centre_y;
}

// Sets `inner` of the members of a slot in one pass over them in order of cells, so that a raft of
// thousands of modules costs little more per member than a chain.
void derive_inner(const State& state, int slot, Assemblies& out) {
  std::vector<int>& members = out.by_cell;
  members.clear();
  for (int i = out.first[slot]; i >= 0; i = out.next[i]) members.push_back(i), out.inner[i] = 0;
  const auto before = [&](int i, const Cell& c) {
    return state.cell_x[i] != c.x ? state.cell_x[i] < c.x : state.cell_y[i] < c.y;
  };
  std::sort(members.begin(), members.end(), [&](int i, int j) {
    return before(i, {state.cell_x[j], state.cell_y[j]});
  });
  auto above = members.begin(), right = members.begin();
  for (const int i : members) {
    const auto link = [&](auto& other, int k) {
      const Cell cell{state.cell_x[i] + kStepX[k], state.cell_y[i] + kStepY[k]};
      while (other != members.end() && before(*other, cell)) ++other;
      if (other == members.end()) return;
      if (state.cell_x[*other] != cell.x || state.cell_y[*other] != cell.y) return;
      out.inner[i] = static_cast<std::uint8_t>(out.inner[i] | 1u << k);
      out.inner[*other] = static_cast<std::uint8_t>(out.inner[*other] | 1u << (k + 2));
    };
    link(right, 0), link(above, 1);
  }
}

void derive_sides(const State& state, int slot, Assemblies& out) {
  for (int i = out.first[slot]; i >= 0; i = out.next[i]) {
    unsigned covered = 0;
    for (int f = 0; f < 4; ++f) covered |= holds(state.faces[4 * i + f]) ? 1u << f : 0u;
    out.covered[i] = static_cast<std::uint8_t>(covered);
    out.resting[i] = resting_faces(state, i);
  }
  derive_inner(state, slot, out);
}

// Puts a slot into a sorted list, or takes it out.
void set_listed(int slot, bool listed, std::vector<int>& list) {
  const auto at = std::lower_bound(list.begin(), list.end(), slot);
  const bool found = at != list.end() && *at == slot;
  if (listed && !found) list.insert(at, slot);
  if (!listed && found) list.erase(at);
}

}  // namespace

std::uint8_t resting_faces(const State& state, int module) {
  unsigned bits = 0;
  for (int f = 0; f < 4; ++f) {
    const Face& face = state.faces[4 * module + f];
    bits |= face.status == FaceStatus::off || face.off_ticks > 0 ? 1u << f : 0u;
  }
  return static_cast<std::uint8_t>(bits);
}

void Assemblies::resize(const Model& model) {
  const auto n = static_cast<std::size_t>(model.bodies());
  for (auto* a : {&live, &groups}) a->clear(), a->reserve(n);
  for (auto* a : {&mass, &inertia, &inverse_mass, &inverse_inertia, &own_inertia, &reach, &centre_x,
                  &centre_y, &x, &y, &c, &s, &vx, &vy, &omega, &offset_x, &offset_y})
    a->assign(n, 0.0);
  for (auto* a : {&first, &next}) a->assign(n, -1);
  work.assign(2 * n, 0);
  by_cell.reserve(n);
  covered.assign(n, 0);
  resting.assign(n, 0);
  inner.assign(n, 0);
}

void derive(const Model& model, const State& state, Assemblies& out) {
  const int n = model.bodies();
  out.live.clear(), out.groups.clear();
  for (int slot = 0; slot < n; ++slot) clear_slot(slot, out);
  for (int i = n - 1; i >= 0; --i) {  // backwards, so that lists ascend
    const int slot = state.assembly[i];
    out.next[i] = out.first[slot];
    out.first[slot] = i;
  }
  for (int slot = 0; slot < n; ++slot) {
    if (state.assembly[slot] != slot) continue;
    out.live.push_back(slot);
    if (out.next[slot] >= 0) out.groups.push_back(slot);
    if (slot >= model.module.count) {
      derive_ball(model, slot, out);
    } else {
      derive_properties(model, state, slot, out);
      derive_sides(state, slot, out);
    }
  }
  derive_poses(model, state, out);
}

void derive_poses(const Model& model, const State& state, Assemblies& out) {
  for (const int slot : out.live) derive_poses(model, state, slot, out);
}

void derive_poses(const Model&, const State& state, int slot, Assemblies& out) {
  for (int i = out.first[slot]; i >= 0; i = out.next[i]) derive_body_pose(state, slot, i, out);
}

void derive_slot(const Model& model, const State& state, int slot, Assemblies& out) {
  const bool live = state.assembly[slot] == slot;
  set_listed(slot, live, out.live);
  set_listed(slot, false, out.groups);
  clear_slot(slot, out);
  if (!live) return;
  if (slot >= model.module.count) {
    derive_ball(model, slot, out);
  } else {
    for (int i = model.module.count - 1; i >= slot; --i) {
      if (state.assembly[i] != slot) continue;
      out.next[i] = out.first[slot];
      out.first[slot] = i;
    }
    set_listed(slot, out.next[slot] >= 0, out.groups);
    derive_properties(model, state, slot, out);
    derive_sides(state, slot, out);
  }
  derive_poses(model, state, slot, out);
}

namespace {

// How assembly b's lattice comes to lie on assembly a's: cell' = at + turned(cell - from, turn).
struct Fit {
  Cell from, at;
  int turn = 0;
  Cell operator()(Cell c) const {
    const Cell d = turned({c.x - from.x, c.y - from.y}, turn);
    return {at.x + d.x, at.y + d.y};
  }
};

Fit fit_of(const State& state, int i, int fi, int j, int fj) {
  const int out_of_i = (fi + state.turn[i]) & 3;  // lattice direction from i to j
  Fit fit;
  fit.from = {state.cell_x[j], state.cell_y[j]};
  fit.at = {state.cell_x[i] + kStepX[out_of_i], state.cell_y[i] + kStepY[out_of_i]};
  fit.turn = (out_of_i + 2 - fj - state.turn[j]) & 3;
  return fit;
}

bool fits(const State& state, const Assemblies& assemblies, int a, int b, const Fit& fit) {
  for (int m = assemblies.first[b]; m >= 0; m = assemblies.next[m]) {
    const Cell c = fit({state.cell_x[m], state.cell_y[m]});
    for (int k = assemblies.first[a]; k >= 0; k = assemblies.next[k]) {
      if (state.cell_x[k] == c.x && state.cell_y[k] == c.y) return false;
    }
  }
  return true;
}

// Centre, heading and twist of what assemblies a and b become; needs their old properties.
struct Joined {
  double x, y, vx, vy, spin;  // spin: angular momentum about (x, y), kg m^2/s
  Rot r;
};

Joined join(const State& state, const Assemblies& assemblies, int a, int b, int turn) {
  const double ma = assemblies.mass[a], mb = assemblies.mass[b], m = ma + mb;
  const double ia = assemblies.inertia[a], ib = assemblies.inertia[b];
  const Rot ra{state.c[a], state.s[a]}, rb{state.c[b], state.s[b]};
  const double tilt = angle_of(between(compose(ra, quarter(turn)), rb));
  Joined j{};
  j.r = renormalised(compose(ra, rotation(tilt * ib / (ia + ib))));
  j.x = (ma * state.x[a] + mb * state.x[b]) / m;
  j.y = (ma * state.y[a] + mb * state.y[b]) / m;
  j.vx = (ma * state.vx[a] + mb * state.vx[b]) / m;
  j.vy = (ma * state.vy[a] + mb * state.vy[b]) / m;
  // Two bodies about their common centre: the reduced mass times relative arm x relative velocity.
  const double dx = state.x[b] - state.x[a], dy = state.y[b] - state.y[a];
  const double dvx = state.vx[b] - state.vx[a], dvy = state.vy[b] - state.vy[a];
  j.spin = ia * state.omega[a] + ib * state.omega[b] + ma * mb / m * (dx * dvy - dy * dvx);
  return j;
}

void empty_slot(State& state, int slot) {
  state.x[slot] = state.y[slot] = state.s[slot] = 0;
  state.vx[slot] = state.vy[slot] = state.omega[slot] = 0;
  state.c[slot] = 1;
}

}  // namespace

bool merge(const Model& model, State& state, Assemblies& assemblies, int i, int fi, int j, int fj) {
  assert(i < model.module.count && j < model.module.count);
  if (state.assembly[i] > state.assembly[j]) std::swap(i, j), std::swap(fi, fj);
  const int a = state.assembly[i], b = state.assembly[j];
  if (a == b) {
    derive_slot(model, state, a, assemblies);
    return true;
  }
  const Fit fit = fit_of(state, i, fi, j, fj);
  if (!fits(state, assemblies, a, b, fit)) return false;
  const Joined joined = join(state, assemblies, a, b, fit.turn);
  for (int m = assemblies.first[b]; m >= 0; m = assemblies.next[m]) {
    const Cell c = fit({state.cell_x[m], state.cell_y[m]});
    state.cell_x[m] = c.x, state.cell_y[m] = c.y;
    state.turn[m] = (state.turn[m] + fit.turn) & 3;
    state.assembly[m] = a;
  }
  state.x[a] = joined.x, state.y[a] = joined.y;
  state.c[a] = joined.r.c, state.s[a] = joined.r.s;
  state.vx[a] = joined.vx, state.vy[a] = joined.vy, state.omega[a] = 0;
  empty_slot(state, b);
  derive_slot(model, state, b, assemblies);
  derive_slot(model, state, a, assemblies);
  state.omega[a] = joined.spin / assemblies.inertia[a];
  derive_poses(model, state, a, assemblies);
  return true;
}

namespace {

// Marks every member with the lowest member of its connected part; returns the number of parts.
int find_parts(const State& state, int slot, Assemblies& assemblies) {
  int* part = assemblies.work.data();
  int* stack = part + assemblies.first.size();
  for (int i = assemblies.first[slot]; i >= 0; i = assemblies.next[i]) part[i] = -1;
  int parts = 0;
  for (int i = assemblies.first[slot]; i >= 0; i = assemblies.next[i]) {
    if (part[i] >= 0) continue;
    ++parts;
    int size = 0;
    part[i] = i, stack[size++] = i;
    while (size > 0) {
      const int m = stack[--size];
      for (int f = 0; f < 4; ++f) {
        const Face& face = state.faces[4 * m + f];
        if (!holds(face) || face.partner < 0 || part[face.partner] >= 0) continue;
        part[face.partner] = i, stack[size++] = face.partner;
      }
    }
  }
  return parts;
}

// Gives part `slot` of an assembly its own slot, lattice and twist. `whole` is the state of the
// assembly that it leaves, (ox, oy) the part's centre in that assembly's lattice frame.
void leave(State& state, int slot, const Pose& whole, const Twist& twist, double ox, double oy) {
  const double rx = whole.r.c * ox - whole.r.s * oy, ry = whole.r.s * ox + whole.r.c * oy;
  const Rot r = compose(whole.r, quarter(state.turn[slot]));
  state.x[slot] = whole.x + rx, state.y[slot] = whole.y + ry;
  state.c[slot] = r.c, state.s[slot] = r.s;
  state.vx[slot] = twist.vx - twist.omega * ry;
  state.vy[slot] = twist.vy + twist.omega * rx;
  state.omega[slot] = twist.omega;
}

}  // namespace

void split(const Model& model, State& state, Assemblies& assemblies, int i) {
  const int slot = state.assembly[i];
  if (find_parts(state, slot, assemblies) == 1) {
    derive_slot(model, state, slot, assemblies);
    return;
  }
  const Pose whole{state.x[slot], state.y[slot], {state.c[slot], state.s[slot]}};
  const Twist twist{state.vx[slot], state.vy[slot], state.omega[slot]};
  const double centre_x = assemblies.centre_x[slot], centre_y = assemblies.centre_y[slot];
  const int* part = assemblies.work.data();
  int* members = assemblies.work.data() + assemblies.first.size();
  int count = 0;  // a copy: derive_slot rebuilds the list that we walk on
  for (int m = assemblies.first[slot]; m >= 0; m = assemblies.next[m]) members[count++] = m;
  for (int k = 0; k < count; ++k) state.assembly[members[k]] = part[members[k]];
  for (int k = 0; k < count; ++k) {
    const int low = members[k];
    if (part[low] != low) continue;
    const Cell origin{state.cell_x[low], state.cell_y[low]};
    const int turn = state.turn[low];
    derive_slot(model, state, low, assemblies);  // the part's centre in the old frame
    leave(state, low, whole, twist, assemblies.centre_x[low] - centre_x,
          assemblies.centre_y[low] - centre_y);
    for (int m = assemblies.first[low]; m >= 0; m = assemblies.next[m]) {
      const Cell c = turned({state.cell_x[m] - origin.x, state.cell_y[m] - origin.y}, -turn);
      state.cell_x[m] = c.x, state.cell_y[m] = c.y;
      state.turn[m] = (state.turn[m] - turn) & 3;
    }
    derive_slot(model, state, low, assemblies);
  }
}

}  // namespace lilytank
