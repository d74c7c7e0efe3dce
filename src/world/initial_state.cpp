// Where bodies lie at the start.
#include <cmath>

#include "lilytank/random.hpp"
#include "lilytank/state.hpp"

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

void place(const Model& model, std::uint64_t seed, State& state) {
  const int n = model.bodies();
  if (model.start.layout == Layout::poses) {
    if (static_cast<int>(model.start.poses.size()) != n)
      throw InputError("start.file holds " + std::to_string(model.start.poses.size()) +
                       " poses for " + std::to_string(n) + " bodies");
    for (int i = 0; i < n; ++i) {
      const Pose& pose = model.start.poses[i];
      state.x[i] = pose.x, state.y[i] = pose.y, state.c[i] = pose.r.c, state.s[i] = pose.r.s;
    }
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

}  // namespace

State initial_state(const Model& model, std::uint64_t seed) {
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
  place(model, seed, state);
  for (int i = 0; i < n; ++i) {
    const double r = std::sqrt(state.x[i] * state.x[i] + state.y[i] * state.y[i]);
    if (!(r + reach_of(model, i) <= model.tank.radius + 1e-9))
      throw InputError("body " + std::to_string(i) + " would start outside the tank");
  }
  for (int i = 0; i < model.module.count; ++i) {
    const double u = uniform({seed, Stream::first_face, 0, static_cast<std::uint32_t>(i), 0});
    state.firmware[i].next_face = static_cast<std::uint8_t>(4 * u);
  }
  return state;
}

}  // namespace lilytank
