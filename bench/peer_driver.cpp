// lilytank_peer_driver: one timed run of a simpler tank as other engines are timed in, for rounds
// with drivers from elsewhere. Prints one line of JSON. The tank: squares of 30 mm and 30 g, a
// swirl of 0.1 m/s with seven streams, gusts of 0.05 m/s drawn once a module and step.
#include <hwy/highway.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "heap.hpp"
#include "measures.hpp"
#include "scenes.hpp"
#include "text/number.hpp"

namespace lilytank::bench {
namespace {

struct Options {
  int modules = 15, substeps = 1, worlds = 1;
  double seconds = 600, warmup = 30;
  std::uint64_t seed = 1;
  bool latch = false;
  std::string variant;
};

// Restricts the vector instructions to those of an older processor.
void take_vectors(const std::string& text) {
  if (text != "best" && text != "avx2") {
    throw InputError("--vectors = '" + text + "' is neither best nor avx2");
  }
  if (text == "avx2") hwy::DisableTargets(HWY_AVX2 - 1);
}

Options read(const std::vector<std::string>& words) {
  Options options;
  const auto number = [](const std::string& name, const std::string& text, double low) {
    const std::optional<double> value = parse_number(text);
    if (!value || *value < low)
      throw InputError(name + " = '" + text + "' is not a number from " + shortest(low) + " up");
    return *value;
  };
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string& name = words[i];
    if (i + 1 == words.size()) throw InputError(name + " needs a value");
    const std::string& text = words[i + 1];
    if (name == "--modules") {
      options.modules = static_cast<int>(number(name, text, 1));
    } else if (name == "--substeps") {
      options.substeps = static_cast<int>(number(name, text, 1));
    } else if (name == "--worlds") {
      options.worlds = static_cast<int>(number(name, text, 1));
    } else if (name == "--vectors") {
      take_vectors(text);
    } else if (name == "--seconds") {
      options.seconds = number(name, text, kTick);
    } else if (name == "--warmup") {
      options.warmup = number(name, text, 0);
    } else if (name == "--seed") {
      options.seed = static_cast<std::uint64_t>(number(name, text, 0));
    } else if (name == "--latch") {
      options.latch = number(name, text, 0) != 0;
    } else if (name == "--drag") {
      // The other reading, |w| w on every segment, is not a force of this library.
      if (text != "facing") throw InputError("--drag = '" + text + "': only facing is known");
    } else if (name == "--variant") {
      if (text != "" && text != "per_point" && text != "per_module" && text != "moment_matched")
        throw InputError("--variant = '" + text +
                         "' is not per_module, per_point or moment_matched");
      options.variant = text;
    } else {
      throw InputError("unknown option " + name);
    }
  }
  return options;
}

// A swirl that is full from 0.6 of the radius, and seven streams bent by a quarter radian; cells of
// 12 mm.
FlowField swirl(double radius) {
  constexpr double kCell = 0.012, kSpeed = 0.10, kGust = 0.05;
  const int cells = static_cast<int>(std::ceil(2 * radius / kCell - 1e-9));
  const double extent = cells * kCell / 2, drift = 0.3 * TankParameters{}.radius / radius;
  std::vector<FlowSample> samples;
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const double x = (ix + 0.5) * kCell - extent, y = (iy + 0.5) * kCell - extent;
      const double r = std::max(std::hypot(x, y), 1e-9), q = std::min(1.0, r / radius);
      const double streams = std::cos(7 * (std::atan2(y, x) + 0.26 * q));
      const double in = kSpeed * q * q * (drift + streams);
      const double around = kSpeed * std::min(1.0, q / 0.6);
      samples.push_back({-(in * x + around * y) / r, (around * x - in * y) / r, kGust, kGust});
    }
  }
  return {cells, extent, samples, std::vector<bool>(samples.size(), true), Interpolation::nearest};
}

// Dimers that form whenever two modules meet and part at random.
Ruleset dimers(double part) {
  return parse_ruleset(
      "lilytank ruleset 1\nname dimers\nhops counter-clockwise\n"
      "join: (0,0) (0,0) -> (1,1)-(1,1) p=1\n"
      "part: (1,1)-(1,1) -> (0,0) (0,0) p=" +
          shortest(part) + "\n",
      "dimers");
}

Model driver_model(const Options& options) {
  Model model = standard_model();
  model.tank.radius = tank_radius(options.modules);
  model.module = {.count = options.modules, .side = 0.030, .mass = 0.030, .draught = 0.025};
  model.dt = kTick / options.substeps;
  model.steps_per_tick = options.substeps;
  model.flow.gusts = options.variant == "per_point"        ? Gusts::per_point
                     : options.variant == "moment_matched" ? Gusts::moment_matched
                                                           : Gusts::per_module;
  model.flow.at = FlowAt::centre;
  model.field = std::make_shared<const FlowField>(swirl(model.tank.radius));
  model.control.latches = options.latch;
  model.start.radius = model.tank.radius - 0.025;
  model.start.distance = 0.045;
  for (ActiveForce& force : model.forces) {
    if (force.term->name() == "stochastic") force.p[0] = 1e-3;
  }
  if (options.latch) model.rulesets = {dimers(0.1)};
  return model;
}

double share_joined(const State& state) {
  int joined = 0;
  for (std::size_t i = 0; i < state.firmware.size(); ++i) {
    bool any = false;
    for (int f = 0; f < 4; ++f) any = any || state.faces[4 * i + f].partner >= 0;
    joined += any;
  }
  return static_cast<double>(joined) / static_cast<double>(state.firmware.size());
}

// Steps through the warm-up; with latches also chooses how often dimers part, so that about half
// of the modules are joined, as in the drivers this one is compared with.
State warm_up(Model& model, const Options& options) {
  State state = initial_state(model, options.seed);
  if (!options.latch) return advanced(World(model, std::move(state)), options.warmup).state();
  constexpr double kBlock = 20;  // s
  double part = 0.1;
  for (double time = 0; time < options.warmup; time += kBlock) {
    World world(model, std::move(state));
    double share = 0;
    for (int second = 0; second < kBlock; ++second) {
      world = advanced(std::move(world), 1);
      share += share_joined(world.state()) / kBlock;
    }
    state = world.state();
    part = std::clamp(part * exp_portable(share - 0.5), 1e-3, 1.0);
    model.rulesets = {dimers(part)};
  }
  return state;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Timing {
  double wall = 0;             ///< s, of all worlds
  std::vector<double> forces;  ///< s, of all terms for one step, repeated on the poses at hand
  std::int64_t ticks = 0, heap = 0;
  bool ok = true;
};

void time_forces(const World& world, std::vector<Wrench>& out, Timing& timing) {
  const Model& model = world.model();
  const StepContext moment{world.time(), world.state().step,
                           world.state().step / model.steps_per_tick, world.state().seed};
  const double start = now();
  for (const ActiveForce& force : model.forces)
    force.term->add(model, world.kinematics(), moment, force.p, out);
  timing.forces.push_back(now() - start);
}

Timing measure(const Model& model, const Options& options, State state, Measures& look) {
  Timing timing;
  std::vector<Wrench> scratch(model.bodies());
  const std::int64_t before = heap_bytes();
  std::vector<World> worlds;
  for (int k = 0; k < options.worlds; ++k) {
    worlds.emplace_back(model, state);
    state.seed += 1;
  }
  std::vector<World*> all;
  for (World& one : worlds) all.push_back(&one);
  const World& world = worlds.front();
  Batch batch;
  const auto ticks = std::max<std::int64_t>(1, std::llround(options.seconds / kTick));
  for (std::int64_t tick = 0; tick < ticks && timing.ok;) {
    const std::int64_t part = std::min<std::int64_t>(20, ticks - tick) * options.substeps;
    const double start = now();
    for (std::int64_t k = 0; k < part; ++k) batch.step(all);
    for (const World& one : worlds) timing.ok = timing.ok && one.status() == RunStatus::ok;
    timing.wall += now() - start;
    tick += part / options.substeps;
    timing.ticks = tick;
    if (timing.heap == 0) timing.heap = (heap_bytes() - before) / options.worlds;
    time_forces(world, scratch, timing);
    look.sample(world.kinematics(), world.state().faces);
  }
  return timing;
}

// The fields that drivers of other engines print. Latching is part of a step: ns_latch is 0.
void print(const Options& options, const Timing& timing, const Measures& look) {
  const double per = 1e9 / (static_cast<double>(timing.ticks) * options.modules * options.worlds);
  const double total = per * timing.wall;
  const double forces = 1e9 * quantile(timing.forces, 0.5) * options.substeps / options.modules;
  const double mean_depth = [&] {
    double sum = 0;
    for (const double depth : look.depths()) sum += depth;
    return look.depths().empty() ? 0 : sum / static_cast<double>(look.depths().size());
  }();
  const double simulated = static_cast<double>(timing.ticks) * kTick * options.worlds;
  const std::vector<std::pair<const char*, double>> fields = {
      {"modules", options.modules},
      {"latch", options.latch},
      {"substeps", options.substeps},
      {"worlds", options.worlds},
      {"sim_seconds", simulated},
      {"wall_s", timing.wall},
      {"ns_per_module_step", total},
      {"ns_engine", total - forces},
      {"ns_forces", forces},
      {"ns_latch", 0},
      {"sim_per_wall", simulated / timing.wall},
      {"heap_bytes", static_cast<double>(timing.heap)},
      {"mean_speed", look.speed()},
      {"mean_spin", look.spin()},
      {"mean_radius", look.radius() / tank_radius(options.modules)},
      {"near_pairs", look.near()},
      {"touching_pairs", look.touching()},
      {"overlapping_pairs", look.overlapping()},
      {"at_wall", look.at_wall()},
      {"depth_mean_mm", 1e3 * mean_depth},
      {"depth_p99_mm", 1e3 * quantile(look.depths(), 0.99)},
      {"depth_max_mm", 1e3 * quantile(look.depths(), 1)},
      {"deep_share", look.deep_share(1e-3)},
      {"wall_max_mm", 1e3 * look.beyond_wall()},
      {"joined", look.joined()},
      {"joints_per_module", look.joints()},
      {"joint_error_mm", 1e3 * quantile(look.joint_errors(), 0.5)},
      {"joint_error_p99_mm", 1e3 * quantile(look.joint_errors(), 0.99)}};
  std::printf("{\"engine\": \"lilytank%s\", \"drag\": \"facing\"",
              options.variant == "per_point" ? " (per point)" : "");
  for (const auto& [name, value] : fields) std::printf(", \"%s\": %.8g", name, value);
  std::printf(", \"ok\": %s}\n", timing.ok ? "true" : "false");
}

int drive(const Options& options) {
  Model model = driver_model(options);
  State state = warm_up(model, options);
  Measures look(model);
  const Timing timing = measure(model, options, std::move(state), look);
  print(options, timing, look);
  return timing.ok ? 0 : 1;
}

}  // namespace
}  // namespace lilytank::bench

int main(int argc, char** argv) {
  try {
    return lilytank::bench::drive(lilytank::bench::read({argv + 1, argv + argc}));
  } catch (const std::exception& e) {
    std::cerr << "lilytank_peer_driver: " << e.what() << "\n";
    return 2;
  }
}
