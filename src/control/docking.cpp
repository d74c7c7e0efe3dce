#include "control/docking.hpp"

#include <algorithm>
#include <limits>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"

namespace lilytank {

namespace {

bool hold_each_other(const State& state, int i, int j) {
  const Face* faces = &state.faces[4 * i];
  return faces[0].partner == j || faces[1].partner == j || faces[2].partner == j ||
         faces[3].partner == j;
}

}  // namespace

Docking::Docking(const Model& model)
    : model_(&model),
      half_side_(model.module.side / 2),
      reach_(model.control.capture_distance),
      reach2_(reach_ * reach_),
      least_cosine_(rotation(model.control.capture_angle).c),
      peer_(4 * static_cast<std::size_t>(model.module.count), 0) {
  const auto modules = static_cast<std::size_t>(model.module.count);
  candidates_.reserve(4 * modules);
  saved_slots_.reserve(2);
  saved_members_.reserve(modules);
}

// Whether the faces that look most at each other are in reach: centres within the capture distance,
// normals anti-parallel within the capture angle. With reaches well below the side no other two
// faces of the two modules can be.
bool Docking::meet(const Bodies& b, int i, int j, Candidate& found) const {
  const auto wide = [](float v) { return static_cast<double>(v); };
  const double dx = wide(b.x[j]) - wide(b.x[i]), dy = wide(b.y[j]) - wide(b.y[i]);
  const auto looking = [](double x, double y) {
    if (std::fabs(x) >= std::fabs(y)) return x >= 0 ? 0 : 2;
    return y >= 0 ? 1 : 3;
  };
  const Rot ri{wide(b.c[i]), wide(b.s[i])}, rj{wide(b.c[j]), wide(b.s[j])};
  const Vec2 to_j = unrotate(ri, {dx, dy}), to_i = unrotate(rj, {-dx, -dy});
  const int fi = looking(to_j.x(), to_j.y()), fj = looking(to_i.x(), to_i.y());
  const Rot ni = compose(ri, quarter(fi)), nj = compose(rj, quarter(fj));
  if (-(ni.c * nj.c + ni.s * nj.s) < least_cosine_) return false;
  const double gap_x = dx + half_side_ * (nj.c - ni.c), gap_y = dy + half_side_ * (nj.s - ni.s);
  const double distance2 = gap_x * gap_x + gap_y * gap_y;
  if (!(distance2 <= reach2_)) return false;
  found = {distance2, {i, fi}, {j, fj}};
  return true;
}

// Nearest first; equal distances stay in the order of modules.
void Docking::add_candidate(const Candidate& candidate) {
  if (candidates_.size() == candidates_.capacity()) return;  // cannot be: a module has 4 faces
  candidates_.push_back(candidate);
  for (std::size_t k = candidates_.size() - 1;
       k > 0 && candidates_[k].distance2 < candidates_[k - 1].distance2; --k)
    std::swap(candidates_[k], candidates_[k - 1]);
}

void Docking::look_around(Tick& tick) {
  std::fill(peer_.begin(), peer_.end(), std::uint8_t{0});
  candidates_.clear();
  const double near = 2 * half_side_ + reach_;
  for (const auto& [i, j] : tick.motion.near_pairs(tick.bodies, near)) {
    if (hold_each_other(tick.state, i, j)) continue;  // their other faces cannot meet
    Candidate pair;
    if (!meet(tick.bodies, i, j, pair)) continue;
    const Face& a = face_of(tick.state, pair.a);
    const Face& b = face_of(tick.state, pair.b);
    peer_[4 * i + pair.a.face] = peer_[4 * j + pair.b.face] = 1;
    const bool ready = a.status == FaceStatus::enabled && b.status == FaceStatus::enabled &&
                       a.off_ticks == 0 && b.off_ticks == 0 && tick.on(i) && tick.on(j);
    if (ready) add_candidate(pair);
  }
}

// The hazard of an off face grows by 1 / off_scale every tick, whether or not its neighbour is
// still there; it comes on only once the neighbour has gone [authors' firmware: mean 0.49 s].
void Docking::come_on(Tick& tick) {
  for (int i = 0; i < model_->module.count; ++i) {
    if (tick.assemblies.resting[i] == 0 || !tick.on(i)) continue;
    Face* faces = &tick.state.faces[4 * i];
    const auto bits = random_bits(
        {tick.state.seed, Stream::reenable, tick.number, static_cast<std::uint32_t>(i), 0});
    for (int f = 0; f < 4; ++f) {
      Face& face = faces[f];
      if (face.status == FaceStatus::enabled && face.off_ticks > 0) --face.off_ticks;
      if (face.status != FaceStatus::off) continue;
      if (face.off_ticks < std::numeric_limits<std::uint16_t>::max()) ++face.off_ticks;
      const double u = (bits[f] + 0.5) * 0x1p-32;
      if (peer_[4 * i + f] || u * model_->control.off_scale >= face.off_ticks) continue;
      face.status = FaceStatus::enabled;
      face.off_ticks = 0;
    }
    tick.assemblies.resting[i] = resting_faces(tick.state, i);
  }
}

void Docking::save(const Tick& tick, int slot) {
  const State& s = tick.state;
  saved_slots_.push_back(
      {slot, s.x[slot], s.y[slot], s.c[slot], s.s[slot], s.vx[slot], s.vy[slot], s.omega[slot]});
  for (int k = tick.assemblies.first[slot]; k >= 0; k = tick.assemblies.next[k])
    saved_members_.push_back({k, s.assembly[k], s.cell_x[k], s.cell_y[k], s.turn[k]});
}

void Docking::restore(Tick& tick) {
  State& s = tick.state;
  for (const SavedSlot& old : saved_slots_) {
    s.x[old.slot] = old.x, s.y[old.slot] = old.y, s.c[old.slot] = old.c, s.s[old.slot] = old.s;
    s.vx[old.slot] = old.vx, s.vy[old.slot] = old.vy, s.omega[old.slot] = old.omega;
  }
  for (const SavedMember& old : saved_members_) {
    s.assembly[old.body] = old.assembly, s.turn[old.body] = old.turn;
    s.cell_x[old.body] = old.cell_x, s.cell_y[old.body] = old.cell_y;
  }
}

// Pulls two assemblies onto one lattice; false, with everything as it was, if there is no room.
bool Docking::join(Tick& tick, Connector a, Connector b) {
  const int slot_a = tick.state.assembly[a.module], slot_b = tick.state.assembly[b.module];
  saved_slots_.clear();
  saved_members_.clear();
  tick.fetch();
  if (slot_a != slot_b) save(tick, slot_a), save(tick, slot_b);
  hold(tick.state, a, b);
  if (merge(tick.model, tick.state, tick.assemblies, a.module, a.face, b.module, b.face)) {
    tick.commit();
    if (slot_a == slot_b) return true;
    if (tick.movers.settle(tick.motion, tick.bodies, tick.assemblies, std::min(slot_a, slot_b),
                           tick.tallies))
      return true;
  }
  restore(tick);
  for (const Connector& at : {a, b}) {
    clear_face(tick.state, at);
    face_of(tick.state, at).off_ticks = kRetryTicks;
  }
  derive(tick.model, tick.state, tick.assemblies);
  tick.commit();
  return false;
}

void Docking::latch(Tick& tick, Connector a, Connector b) {
  const auto free = [&](Connector at) {
    const Face& face = face_of(tick.state, at);
    return face.status == FaceStatus::enabled && face.off_ticks == 0;
  };
  // A latch made a moment ago may have moved them or taken a face.
  Candidate now;
  if (!free(a) || !free(b) || !meet(tick.bodies, a.module, b.module, now)) return;
  if (now.a.face != a.face || now.b.face != b.face) return;
  if (fails(tick, a, Fault::latch)) {
    for (const Connector& at : {a, b}) {
      clear_face(tick.state, at);
      face_of(tick.state, at).status = FaceStatus::off;
      tick.assemblies.resting[at.module] = resting_faces(tick.state, at.module);
    }
    return;
  }
  if (join(tick, a, b))
    report(tick, EventKind::latch, a, b);
  else
    ++tick.tallies.snaps_refused;
}

void Docking::run(Tick& tick) {
  look_around(tick);
  come_on(tick);
  for (const Candidate& candidate : candidates_) latch(tick, candidate.a, candidate.b);
}

}  // namespace lilytank
