// A tank without water and walls near, in which tests put modules where they want them and run
// their firmware; nothing moves but what a latch pulls together.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "control/controller.hpp"
#include "lilytank/math.hpp"
#include "lilytank/ruleset.hpp"

namespace lilytank::test {

inline std::string ruleset_file(const std::string& name) {
  return std::string(LILYTANK_SOURCE_DIR) + "/scenarios/rulesets/" + name + ".rules";
}

inline const std::vector<std::string>& shipped_rulesets() {
  static const std::vector<std::string> names = {"chain5", "cross5", "i4", "l4", "j4",
                                                 "t4",     "s4",     "o4", "p5"};
  return names;
}

/// A ruleset from rule lines.
inline Ruleset rules_of(const std::string& lines) {
  return parse_ruleset("lilytank ruleset 1\nhops counter-clockwise\n" + lines, "test.rules");
}

/// The probabilities of all rules of a kind set to p.
inline Ruleset with_p(Ruleset rules, RuleKind kind, double p) {
  for (Rule& rule : rules.rules)
    if (rule.kind == kind) rule.p = p;
  return rules;
}

inline Model quiet_model(int modules, std::vector<Ruleset> rulesets) {
  Model model;
  model.module.count = modules;
  model.tank.radius = 10;
  model.forces.clear();
  model.rulesets = std::move(rulesets);
  return model;
}

/// The chain of five modules, as shipped.
inline Ruleset chain() {
  return read_ruleset(ruleset_file("chain5"));
}

/// A model whose bonds are evaluated in every tick: short tests.
inline Model hasty(int modules, std::vector<Ruleset> rulesets) {
  Model model = quiet_model(modules, std::move(rulesets));
  model.control.clock = Clock::events;
  model.control.evaluation_rate = 40;
  return model;
}

/// All modules apart from each other, as they are at the start.
inline State apart(const Model& model, std::uint64_t seed) {
  State s;
  s.seed = seed;
  const auto n = static_cast<std::size_t>(model.module.count);
  for (auto* v : {&s.x, &s.y, &s.s, &s.vx, &s.vy, &s.omega}) v->assign(n, 0.0);
  s.c.assign(n, 1.0);
  for (auto* v : {&s.assembly, &s.cell_x, &s.cell_y, &s.turn}) v->assign(n, 0);
  s.firmware.assign(n, Firmware{});
  s.faces.assign(4 * n, Face{});
  for (std::size_t i = 0; i < n; ++i) {
    s.assembly[i] = static_cast<std::int32_t>(i);
    s.x[i] = 2 + 0.1 * static_cast<double>(i % 8);
    s.y[i] = 0.1 * static_cast<double>(i / 8);
    s.firmware[i].next_face = static_cast<std::uint8_t>((i + seed) & 3);
  }
  return s;
}

class Rig {
 public:
  Rig(Model m, std::uint64_t seed)
      : model(std::move(m)),
        state(apart(model, seed)),
        hot(model),
        motion_(model),
        controller_(model) {
    bodies.resize(model);
    derive(model, state, bodies);
  }
  Rig(int modules, std::vector<Ruleset> rulesets, std::uint64_t seed = 1)
      : Rig(quiet_model(modules, std::move(rulesets)), seed) {}
  Rig(const Rig&) = delete;

  /// Puts a module that is alone somewhere, turned by an angle in radians.
  void place(int i, double x, double y, double angle = 0) {
    const Rot r = rotation(angle);
    state.x[i] = x, state.y[i] = y, state.c[i] = r.c, state.s[i] = r.s;
    derive(model, state, bodies);
  }
  /// Puts module i, alone, exactly before face f of module `at`, `gap` metres off, so that its own
  /// face `own` meets it.
  void place_at(int i, int own, int at, int f, double gap = 0) {
    const Rot out = compose({bodies.c[at], bodies.s[at]}, quarter(f));
    const double d = model.module.side + gap;
    const Rot r = compose(out, quarter(2 - own));
    state.x[i] = bodies.x[at] + d * out.c, state.y[i] = bodies.y[at] + d * out.s;
    state.c[i] = r.c, state.s[i] = r.s;
    derive(model, state, bodies);
  }
  void tick() {
    events.clear();
    hot.load(state, bodies);
    controller_.tick(state, bodies, hot, motion_, movers_, events, tallies);
    hot.save(state, bodies);
    log.insert(log.end(), events.begin(), events.end());
    state.step += model.steps_per_tick;
  }
  /// Poses as the engine has them, in float32.
  void round() { hot.load(state, bodies), hot.save(state, bodies); }
  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) tick();
  }
  /// Ticks until an event of a kind; false if it does not come.
  bool until(EventKind kind, int most = 8000) {
    for (int k = 0; k < most; ++k) {
      tick();
      for (const Event& event : events)
        if (event.kind == kind) return true;
    }
    return false;
  }
  Face& face(int module, int f) { return state.faces[4 * module + f]; }
  int count(EventKind kind) const {
    int n = 0;
    for (const Event& event : log) n += event.kind == kind ? 1 : 0;
    return n;
  }
  /// Labels and l_n of a module as text, "3@1".
  std::string firmware(int i) const {
    return std::to_string(state.firmware[i].label) + "@" + std::to_string(state.firmware[i].last);
  }
  /// The lattice cells of a module's assembly.
  std::vector<Cell> cells(int module) const {
    std::vector<Cell> out;
    for (int i = 0; i < model.module.count; ++i)
      if (state.assembly[i] == state.assembly[module])
        out.push_back({state.cell_x[i], state.cell_y[i]});
    return out;
  }
  /// Puts module i, turned by `own` quarters, where the forward rule's first label (s,h) waits for
  /// it on the assembly of module 0.
  void offer(int i, const Label& left, int own) {
    for (int k = 0; k < i; ++k) {
      for (int f = 0; f < 4; ++f) {
        const bool waits =
            state.firmware[k].label == left.state && hop_of(state.firmware[k].last, f) == left.hop;
        if (!waits) continue;
        place_at(i, own, k, f);
        return;
      }
    }
  }

  Model model;
  State state;
  Assemblies bodies;
  lilytank::Bodies hot;       ///< as the engine has them
  std::vector<Event> events;  ///< of the last tick
  std::vector<Event> log;     ///< of all ticks
  Tallies tallies;

 private:
  Motion motion_;
  Movers movers_;
  Controller controller_;
};

}  // namespace lilytank::test
