// lilytank_bench: how fast worlds step, what they hold, and how other engines fare with the same
// tank. Each iteration of a benchmark is one round; figures are medians over the rounds.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "heap.hpp"
#include "measures.hpp"
#include "peers/tank.hpp"
#include "scenes.hpp"
#include "table.hpp"

namespace lilytank::bench {
namespace {

constexpr double kWarmUp = 60;  // s, simulated before anything is measured

struct Rounds {
  int count = 9;
  int module_steps = 300000;  ///< about, in each round
  int steps(int modules) const { return std::max(1, module_steps / modules); }
};

// This thread's processor time: on an idle machine the same as wall time, on a busy one steadier.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double seconds(Work&& work) {
  const double start = processor_seconds();
  work();
  return processor_seconds() - start;
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

// Worlds after the warm-up, made once each.
const State& warmed(const std::string& name, const Model& model) {
  static std::map<std::string, State> all;
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  return all[name] = advanced(World(model, 1), kWarmUp).state();
}

void world_bench(benchmark::State& state, const Scene& scene, const Rounds& rounds) {
  const State& start = warmed(scene.name, scene.model);
  const int modules = scene.model.module.count, steps = rounds.steps(modules);
  const std::int64_t bytes_before = heap_bytes();
  World world(scene.model, start);
  world.step();
  const std::int64_t bytes = heap_bytes() - bytes_before;
  std::vector<double> ns;
  ns.reserve(rounds.count);
  std::int64_t calls = 0;
  for (auto _ : state) {
    const std::int64_t before = heap_calls();
    const double wall = seconds([&] {
      for (int k = 0; k < steps; ++k) world.step();
    });
    calls += heap_calls() - before;
    state.SetIterationTime(wall);
    ns.push_back(1e9 * wall / steps / modules);
  }
  state.counters["modules"] = modules;
  state.counters["ns"] = median(ns);
  state.counters["least_ns"] = quantile(ns, 0);
  state.counters["x_real_time"] = scene.model.dt / (1e-9 * median(ns) * modules);
  state.counters["heap_bytes"] = static_cast<double>(bytes);
  state.counters["allocations"] = static_cast<double>(calls);
  state.SetLabel(hex(fingerprint(world.state())));
  if (calls != 0) state.SkipWithError("a step took memory");
}

struct Contest {
  std::string name;
  Model model;
  EngineKind kind;
  Forces forces;
  int substeps;
};

// A round is ours and then theirs, so that both see the same moods of the machine.
void contest_bench(benchmark::State& state, const Contest& contest, const Rounds& rounds) {
  const Model& model = contest.model;
  const std::string gusts = model.flow.gusts == Gusts::per_point ? "point" : "module";
  const State& start = warmed("loose " + gusts + std::to_string(model.module.count), model);
  World ours(model, start);
  const std::int64_t bytes_before = heap_bytes();
  PeerTank theirs(model, contest.kind, start, contest.forces, contest.substeps);
  for (int k = 0; k < kWarmUp / kTick; ++k) theirs.step();
  const std::int64_t bytes = heap_bytes() - bytes_before;

  const int steps = rounds.steps(model.module.count);
  std::vector<double> own_ns, peer_ns, ratio;
  Measures own_look(model), peer_look(model);
  for (auto _ : state) {
    double own = 0, peer = 0;
    for (int part = 0; part < 20; ++part) {
      const int share = std::max(1, steps / 20);
      own += seconds([&] {
        for (int k = 0; k < share; ++k) ours.step();
      });
      peer += seconds([&] {
        for (int k = 0; k < share; ++k) theirs.step();
      });
      own_look.sample(ours.kinematics());
      peer_look.sample(theirs.bodies().kinematics());
    }
    const double per = 1e9 / (20.0 * std::max(1, steps / 20) * model.module.count);
    state.SetIterationTime(own + peer);
    own_ns.push_back(per * own), peer_ns.push_back(per * peer), ratio.push_back(peer / own);
  }
  state.counters["modules"] = model.module.count;
  state.counters["substeps"] = contest.substeps;
  state.counters["ns"] = median(own_ns);
  state.counters["peer_ns"] = median(peer_ns);
  state.counters["ratio"] = median(ratio);
  state.counters["peer_heap_bytes"] = static_cast<double>(bytes);
  state.counters["mm_per_s"] = 1e3 * own_look.speed();
  state.counters["peer_mm_per_s"] = 1e3 * peer_look.speed();
  state.counters["touching"] = own_look.touching();
  state.counters["peer_touching"] = peer_look.touching();
  state.counters["overlap_um"] = 1e6 * quantile(own_look.depths(), 1);
  state.counters["peer_overlap_um"] = 1e6 * quantile(peer_look.depths(), 1);
}

std::vector<Contest> contests() {
  std::vector<Contest> all;
  for (const EngineKind& kind : engine_kinds()) {
    // As theirs do, ours reads the water once a module.
    const auto plain = [](int modules) {
      Model model = loose_world(modules, Gusts::per_module);
      model.flow.at = FlowAt::centre;
      return model;
    };
    for (const int modules : {15, 60, 240, 1000})
      all.push_back({"plain forces", plain(modules), kind, Forces::plain, 1});
    const Model points = loose_world(15, Gusts::per_point);
    all.push_back({"plain forces", plain(15), kind, Forces::plain, 2});
    all.push_back({"our forces", points, kind, Forces::library, 1});
    all.push_back({"our forces", points, kind, Forces::library, 2});
  }
  return all;
}

void register_all(const Rounds& rounds) {
  const auto add = [&](const std::string& name, auto body) {
    benchmark::RegisterBenchmark(name.c_str(), body)->Iterations(rounds.count)->UseManualTime();
  };
  for (const Scene& scene : scenes())
    add("world/" + scene.name, [=](benchmark::State& state) { world_bench(state, scene, rounds); });
  for (const Contest& contest : contests()) {
    add("against " + contest.kind.name + "/" + contest.name + "/" +
            std::to_string(contest.model.module.count) + "x" + std::to_string(contest.substeps),
        [=](benchmark::State& state) { contest_bench(state, contest, rounds); });
  }
}

// Takes "--<name>=<whole number>" out of the arguments.
int take_number(std::vector<char*>& arguments, const std::string& name, int otherwise) {
  const std::string begin = "--" + name + "=";
  for (auto it = arguments.begin(); it != arguments.end(); ++it) {
    if (std::string(*it).rfind(begin, 0) != 0) continue;
    const int value = std::stoi(std::string(*it).substr(begin.size()));
    arguments.erase(it);
    return std::max(1, value);
  }
  return otherwise;
}

bool asks_for_format(const std::vector<char*>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [](const char* word) {
    return std::string(word).rfind("--benchmark_format", 0) == 0;
  });
}

}  // namespace
}  // namespace lilytank::bench

int main(int argc, char** argv) {
  using namespace lilytank::bench;
  std::vector<char*> arguments(argv, argv + argc);
  Rounds rounds;
  rounds.count = take_number(arguments, "rounds", rounds.count);
  rounds.module_steps = take_number(arguments, "module_steps", rounds.module_steps);
  const bool own_table = !asks_for_format(arguments);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  register_all(rounds);
  TableReporter table;
  benchmark::RunSpecifiedBenchmarks(own_table ? &table : nullptr);
  benchmark::Shutdown();
}
