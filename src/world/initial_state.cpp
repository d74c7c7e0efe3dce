// Where bodies lie at the start.
#include <cmath>

#include "control/tick.hpp"
#include "lilytank/random.hpp"
#include "lilytank/start.hpp"
#include "physics/motion.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::uint32_t kMostTries = 20000;

double reach_of(const Model& model, int body) {
  return body < model.module.count ? model.module.side * std::sqrt(0.5) : model.ball.radius;
}

// Uniform in the start disc, no centre nearer to another than the least distance.
bool place_random(const Model& model, std::uint64_t seed, int body, State& state) {
  const auto id = static_cast<std::uint32_t>(body);
  for (std::uint32_t attempt = 0; attempt < kMostTries; ++attempt) {
    const double u = uniform({seed, Stream::start_pose, 0, id, 2 * attempt});
    const double turn = uniform({seed, Stream::start_pose, 0, id, 2 * attempt + 1});
    const double r = model.start.radius * std::sqrt(u);
    const Rot way = rotation(2 * kPi * turn);
    const double x = r * way.c, y = r * way.s;
    bool free = true;
    for (int j = 0; j < body && free; ++j) {
      const double dx = x - state.x[j], dy = y - state.y[j];
      const double least =
          std::fmax(model.start.distance, reach_of(model, body) + reach_of(model, j));
      free = dx * dx + dy * dy >= least * least;
    }
    if (!free) continue;
    state.x[body] = x, state.y[body] = y;
    return true;
  }
  return false;
}

// Square lattice points within the start disc, nearest to the centre first.
std::vector<Vec2> lattice_points(const Model& model) {
  const double pitch = model.start.distance;
  const int half = static_cast<int>(model.start.radius / pitch) + 1;
  std::vector<Vec2> points;
  for (int ring = 0; ring <= half; ++ring) {
    for (int iy = -ring; iy <= ring; ++iy) {
      for (int ix = -ring; ix <= ring; ++ix) {
        if (std::max(std::abs(ix), std::abs(iy)) != ring) continue;
        const Vec2 p(ix * pitch, iy * pitch);
        if (p.squaredNorm() <= model.start.radius * model.start.radius) points.push_back(p);
      }
    }
  }
  return points;
}

void put_at(const std::vector<Pose>& poses, State& state) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i];
    state.x[i] = pose.x, state.y[i] = pose.y, state.c[i] = pose.r.c, state.s[i] = pose.r.s;
  }
}

void place(const Model& model, std::uint64_t seed, State& state) {
  const int n = model.bodies();
  if (model.start.layout == Layout::poses) {
    if (static_cast<int>(model.start.poses.size()) != n)
      throw InputError("start.file holds " + std::to_string(model.start.poses.size()) +
                       " poses for " + std::to_string(n) + " bodies");
    put_at(model.start.poses, state);
    return;
  }
  std::vector<Vec2> points;
  if (model.start.layout == Layout::lattice) points = lattice_points(model);
  for (int i = 0; i < n; ++i) {
    if (model.start.layout == Layout::lattice) {
      if (i >= static_cast<int>(points.size())) {
        throw InputError(
            "only " + std::to_string(points.size()) + " of " + std::to_string(n) +
            " bodies fit on the start lattice: widen start.radius or narrow start.distance");
      }
      state.x[i] = points[i].x(), state.y[i] = points[i].y();
      continue;
    }
    if (!place_random(model, seed, i, state)) {
      throw InputError("only " + std::to_string(i) + " of " + std::to_string(n) +
                       " bodies found room at the start: widen start.radius, narrow start.distance "
                       "or use start.layout = \"lattice\"");
    }
    const Rot heading = rotation(
        2 * kPi * uniform({seed, Stream::start_pose, 1, static_cast<std::uint32_t>(i), 0}));
    state.c[i] = heading.c, state.s[i] = heading.s;
  }
}

// All bodies at the centre, and what a seed says of the firmware.
State blank_state(const Model& model, std::uint64_t seed) {
  State state;
  state.seed = seed;
  const int n = model.bodies();
  for (auto* field : {&state.x, &state.y, &state.s, &state.vx, &state.vy, &state.omega})
    field->assign(n, 0.0);
  state.c.assign(n, 1.0);
  for (auto* field : {&state.cell_x, &state.cell_y, &state.turn}) field->assign(n, 0);
  state.assembly.resize(n);
  for (int i = 0; i < n; ++i) state.assembly[i] = i;
  state.firmware.resize(model.module.count);
  state.faces.resize(4 * static_cast<std::size_t>(model.module.count));
  for (int i = 0; i < model.module.count; ++i) {
    const double u = uniform({seed, Stream::first_face, 0, static_cast<std::uint32_t>(i), 0});
    state.firmware[i].next_face = static_cast<std::uint8_t>(4 * u);
  }
  return state;
}

}  // namespace

State state_of_poses(const Model& model, const std::vector<Pose>& poses, std::uint64_t seed) {
  State state = blank_state(model, seed);
  put_at(poses, state);
  return state;
}

bool make_bonds(const Model& model, const std::vector<StartBond>& bonds, State& state) {
  Assemblies assemblies;
  assemblies.resize(model);
  derive(model, state, assemblies);
  for (const StartBond& bond : bonds) {
    const Connector a{bond.a, bond.face_a}, b{bond.b, bond.face_b};
    hold(state, a, b);
    if (!merge(model, state, assemblies, bond.a, bond.face_a, bond.b, bond.face_b)) {
      clear_face(state, a), clear_face(state, b);
      return false;
    }
    if (model.rulesets.empty()) continue;
    face_of(state, a).status = face_of(state, b).status = FaceStatus::bonded;
  }
  return true;
}

Overlap deepest_overlap(const Model& model, const State& state) {
  Assemblies assemblies;
  assemblies.resize(model);
  derive(model, state, assemblies);
  return deepest_pair(model, assemblies);
}

std::string body_name(const Model& model, int body) {
  const bool module = body < model.module.count;
  return (module ? "module " : "ball ") + std::to_string(module ? body : body - model.module.count);
}

std::string start_objection(const Model& model, const Overlap& overlap, const std::string& after_a,
                            const std::string& after_b) {
  if (overlap.depth <= kStartTolerance) return "";
  const std::string most = ", more than " + shortest(1e3 * kStartTolerance) + " mm",
                    by = " by " + significant(1e3 * overlap.depth, 3) + " mm at the start" + most;
  const std::string b = body_name(model, overlap.b) + after_b;
  if (overlap.a < 0) return b + " reaches beyond the wall of the tank" + by;
  return body_name(model, overlap.a) + after_a + " and " + b + " overlap" + by;
}

State initial_state(const Model& model, std::uint64_t seed) {
  State state = blank_state(model, seed);
  place(model, seed, state);
  const std::string objection = start_objection(model, deepest_overlap(model, state));
  if (!objection.empty()) throw InputError(objection);
  return state;
}

}  // namespace lilytank
