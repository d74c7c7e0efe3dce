#include "io/scenario_keys.hpp"

#include "io/scenario_commands.hpp"
#include "io/scenario_values.hpp"

namespace lilytank {
namespace {

constexpr double kLargestSeed = 1e18;  // TOML's integers hold a little more

/// A word choice bound to an enum whose values are 0, 1, ... in the order of `words`.
template <class Enum>
WordChoice choice(Enum& target, std::vector<std::string> words) {
  return {std::move(words), [&target] { return static_cast<std::size_t>(target); },
          [&target](std::size_t i) { target = static_cast<Enum>(i); }};
}

using Keys = std::vector<ScenarioKey>;

/// The key of a number that may differ among simulations of one tank.
ScenarioKey varied(ScenarioDraft& d, const char* path, const ModelNumber& number, const char* unit,
                   double low, double high, const char* meaning) {
  return {path, &number.in(d.scenario.model), unit, low, high, meaning, false, number};
}

void run_keys(ScenarioDraft& d, Keys& keys) {
  Scenario& s = d.scenario;
  keys.push_back({"title", &s.title, "", 0, 0, "name of the scenario, used for the output folder"});
  keys.push_back({"run.duration", &s.duration, "s", 0, 1e8, "simulated time"});
  keys.push_back({"run.until",
                  choice(s.end.until, {"end", "all_copies"}),
                  "",
                  0,
                  0,
                  "all_copies: the run ends once all possible copies have been completed",
                  false,
                  {},
                  "\"end\""});
  keys.push_back({"run.until_copies",
                  &s.end.copies,
                  "1",
                  0,
                  10000,
                  "the run ends once so many copies have been completed; 0: off",
                  false,
                  {},
                  "0"});
  keys.push_back({"run.quiet_time",
                  &s.end.quiet_time,
                  "s",
                  0,
                  1e8,
                  "the run ends after so long without an event; 0: off",
                  false,
                  {},
                  "0"});
  keys.push_back(
      {"run.until_metric",
       &s.end.metric_text,
       "",
       0,
       0,
       "the run ends once this holds: copies, most_copies, singles, size_2, size_3, ..., "
       "largest or illegal, then >= or <=, then a number; \"\": off",
       false,
       {},
       "\"\""});
  keys.push_back({"run.dt", &s.model.dt, "s", kTick / 256, kTick,
                  "time step: 25 ms divided by a whole number"});
  keys.push_back({"run.seed", &s.seed, "1", 0, kLargestSeed, "where all random numbers come from"});
}

void body_keys(ScenarioDraft& d, Keys& keys) {
  Model& m = d.scenario.model;
  keys.push_back({"tank.radius", &m.tank.radius, "m", 0.05, 5, "inner radius of the round tank"});
  keys.push_back({"module.count", &m.module.count, "1", 0, 10000, "number of Lily modules"});
  keys.push_back(varied(d, "module.side", {&Model::module, &ModuleParameters::side}, "m", 0.005,
                        0.5, "side of the square module"));
  keys.push_back(varied(d, "module.mass", {&Model::module, &ModuleParameters::mass}, "kg", 1e-4, 10,
                        "mass of a module"));
  keys.push_back(varied(d, "module.draught", {&Model::module, &ModuleParameters::draught}, "m",
                        1e-4, 0.5, "immersion depth: height of a face that feels drag"));
  keys.push_back({"module.shadowing", &m.module.shadowing, "", 0, 0,
                  "a face covered by a latched neighbour feels no drag"});
  keys.push_back({"ball.count", &m.ball.count, "1", 0, 10000, "number of balls"});
  keys.push_back(varied(d, "ball.radius", {&Model::ball, &BallParameters::radius}, "m", 0.001, 0.2,
                        "radius of a ball"));
  keys.push_back(varied(d, "ball.mass", {&Model::ball, &BallParameters::mass}, "kg", 1e-5, 10,
                        "mass of a ball"));
  keys.push_back(varied(d, "ball.drag_area", {&Model::ball, &BallParameters::drag_area}, "m^2",
                        1e-7, 0.1, "area of a ball that the water pushes on"));
  keys.push_back(varied(d, "contact.friction", {&Model::contact, &ContactParameters::friction}, "1",
                        0, 2, "Coulomb's coefficient"));
  keys.push_back(varied(d, "contact.restitution",
                        {&Model::contact, &ContactParameters::restitution}, "1", 0, 1,
                        "share of the approach speed that is given back"));
  keys.push_back(varied(d, "contact.restitution_speed",
                        {&Model::contact, &ContactParameters::restitution_speed}, "m/s", 0, 1,
                        "approach speed below which nothing is given back"));
}

void flow_keys(ScenarioDraft& d, Keys& keys) {
  FlowParameters& f = d.scenario.model.flow;
  keys.push_back({"flow.source", choice(d.source, {"tank", "file", "still"}), "", 0, 0,
                  "built-in tank, a measured field, or still water"});
  keys.push_back({"flow.file", FileName{&d.flow_file}, "", 0, 0,
                  "CSV file of the field; naming one sets flow.source = \"file\""});
  keys.push_back({"flow.interpolation", choice(d.interpolation, {"bilinear", "nearest"}), "", 0, 0,
                  "how the field is read between cell centres; the paper takes the nearest"});
  keys.push_back(
      {"flow.gusts", choice(f.gusts, {"per_point", "per_module", "moment_matched"}), "", 0, 0,
       "gusts of each drag point, of each module, or a wrench with the points' moments"});
  keys.push_back(
      {"flow.at", choice(f.at, {"points", "centre"}), "", 0, 0,
       "where the water is read for the drag: at each drag point, or the module's centre"});
  keys.push_back(varied(d, "flow.K_v", {&Model::flow, &FlowParameters::K_v}, "1", 0, 10,
                        "factor on mean and standard deviation of the flow, Eq. 4"));
  keys.push_back(varied(d, "flow.rho", {&Model::flow, &FlowParameters::rho}, "kg/m^3", 1, 20000,
                        "density of the water"));
  keys.push_back({"flow.pump_power", &d.tank.pump_power, "%", 0, 100,
                  "share of a pump's full flow of 9 l/min, of the built-in tank"});
  keys.push_back({"flow.water_level", &d.tank.water_level, "m", -0.5, 0,
                  "from the tank's upper border, of the built-in tank"});
}

void force_keys(ScenarioDraft& d, Keys& keys) {
  for (ForceDraft& force : d.forces) {
    const std::string base = "forces." + std::string(force.term->name()) + ".";
    keys.push_back({base + "on", &force.on, "", 0, 0, std::string(force.term->summary())});
    std::size_t i = 0;
    for (const Parameter& p : force.term->parameters()) {
      keys.push_back({base + std::string(p.name), &force.p[i], std::string(p.unit), p.low, p.high,
                      std::string(p.meaning), p.whole, ParameterRef{force.term, i}});
      ++i;
    }
  }
}

void control_keys(ScenarioDraft& d, Keys& keys) {
  using C = ControlParameters;
  C& c = d.scenario.model.control;
  keys.push_back(
      {"control.latches", &c.latches, "", 0, 0, "off: the magnets are off and nothing latches"});
  keys.push_back({"control.clock", choice(c.clock, {"firmware", "events"}), "", 0, 0,
                  "modules as state machines run every 25 ms, or bonds evaluated at random times"});
  keys.push_back({"control.handshake", choice(c.handshake, {"plain", "confirmed"}), "", 0, 0,
                  "the responder's answer decides, or both sides act once it is confirmed"});
  keys.push_back(varied(d, "control.capture_distance", {&Model::control, &C::capture_distance}, "m",
                        0, 0.05, "distance of two face centres within which they latch"));
  keys.push_back({"control.capture_angle", &c.capture_angle, "rad", 0, 0.75,
                  "turn from face to face within which they latch"});
  keys.push_back(varied(d, "control.initiative", {&Model::control, &C::initiative}, "1", 0, 1,
                        "probability per 25 ms that a module begins an exchange"));
  keys.push_back({"control.reply_ticks", &c.reply_ticks, "1", 1, kMostReplyTicks,
                  "intervals of 25 ms that an initiator waits for its answer"});
  keys.push_back(varied(d, "control.evaluation_rate", {&Model::control, &C::evaluation_rate}, "1/s",
                        1e-6, 40, "evaluations of a bond per second, of the clock \"events\""));
  keys.push_back({"control.off_scale", &c.off_scale, "1", 1, 65535,
                  "an off face returns with probability (25 ms intervals off) / this"});
  keys.push_back(varied(d, "control.message_loss", {&Model::control, &C::message_loss}, "1", 0, 1,
                        "probability that a message to a neighbour is lost"));
  keys.push_back(varied(d, "control.answer_loss", {&Model::control, &C::answer_loss}, "1", 0, 1,
                        "probability that a message from responder to initiator is lost"));
  keys.push_back(varied(d, "control.latch_failure", {&Model::control, &C::latch_failure}, "1", 0, 1,
                        "probability that two faces that meet fail to hold each other"));
  keys.push_back(varied(d, "control.release_failure", {&Model::control, &C::release_failure}, "1",
                        0, 1, "probability that a latch fails to release when commanded"));
}

void start_keys(ScenarioDraft& d, Keys& keys) {
  StartParameters& start = d.scenario.model.start;
  keys.push_back({"start.layout", choice(start.layout, {"random", "lattice", "poses"}), "", 0, 0,
                  "how bodies lie at the start"});
  keys.push_back({"start.radius", &start.radius, "m", 0, 5, "centres start within it"});
  keys.push_back({"start.distance", &start.distance, "m", 0, 1,
                  "least distance of two centres at the start; the pitch of the lattice"});
  keys.push_back({"start.file", FileName{&d.start_file}, "", 0, 0,
                  "CSV file of poses; naming one sets start.layout = \"poses\""});
}

void output_keys(ScenarioDraft& d, Keys& keys) {
  OutputParameters& o = d.scenario.output;
  keys.push_back({"output.trajectory", choice(o.trajectory, {"none", "csv", "binary"}), "", 0, 0,
                  "format of the stored poses"});
  keys.push_back(
      {"output.rate", &o.rate, "1/s", 1e-4, 1 / kTick, "stored frames per simulated second"});
  keys.push_back({"output.metrics_interval", &o.metrics_interval, "s", kTick, 1e6,
                  "time between rows of metrics.csv"});
}

constexpr const char* kRuleP = "probability per evaluation that the rule fires";

/// The kind of a key by its target.
TomlKey described(const ScenarioKey& key) {
  using Kind = TomlKey::Kind;
  TomlKey out{key.path, Kind::text, key.meaning, key.unit, key.low, key.high};
  if (const auto* choice = std::get_if<WordChoice>(&key.target)) {
    out.kind = Kind::word, out.words = choice->words;
  } else if (std::holds_alternative<bool*>(key.target)) {
    out.kind = Kind::flag;
  } else if (std::holds_alternative<double*>(key.target) && !key.whole) {
    out.kind = Kind::number;
  } else if (!std::holds_alternative<std::string*>(key.target) &&
             !std::holds_alternative<FileName>(key.target)) {
    out.kind = Kind::whole;
  }
  out.standard = value_text(key);
  return out;
}

}  // namespace

ScenarioDraft::ScenarioDraft() {
  for (const ForceTerm* term : force_library()) {
    forces.push_back({term, term->baseline(), with_defaults(*term).p});
  }
}

std::vector<ScenarioKey> scenario_keys(ScenarioDraft& draft) {
  Keys keys;
  run_keys(draft, keys);
  body_keys(draft, keys);
  flow_keys(draft, keys);
  force_keys(draft, keys);
  control_keys(draft, keys);
  keys.push_back({"ruleset.file", FileName{&draft.ruleset_file}, "", 0, 0,
                  "the rules that modules follow; without one, latches never end"});
  start_keys(draft, keys);
  output_keys(draft, keys);
  return keys;
}

TomlKeys scenario_file_keys() {
  using namespace toml_key;
  ScenarioDraft draft;
  TomlKeys paths{texts("base", "scenario files that this one overrides")};
  for (const ScenarioKey& key : scenario_keys(draft)) paths.push_back(described(key));
  paths.push_back(
      by_name("rules", {number("p", "1", 0, 1, kRuleP)}, "rules of the ruleset's file"));
  paths.push_back(tables("command", command_keys(), "what the base station does during the run"));
  return nested(paths);
}

std::vector<ScenarioKey> rule_keys(ScenarioDraft& draft) {
  Keys keys;
  for (Rule& rule : draft.rules.rules) {
    keys.push_back({"rules." + rule.name + ".p", &rule.p, "1", 0, 1, kRuleP});
  }
  return keys;
}

}  // namespace lilytank
