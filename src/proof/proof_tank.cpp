#include "proof/proof_tank.hpp"

#include <algorithm>

#include "lilytank/random.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr int kBalls = 24;
constexpr std::uint64_t kTankSeed = 1, kDrawnSeed = 5;

DrawnTank drawn_for(const ProofOptions& options) {
  return drawn_tank(derived_seed(options.diagnosis.seed, kDrawnSeed));
}

// So many modules, which latch if there are rules.
Model with_modules(Model tank, const ProofOptions& options) {
  tank.module.count = options.modules;
  if (options.latches.empty()) return tank;
  tank.control.latches = true, tank.rulesets = {read_ruleset(options.latches)};
  return tank;
}

void refuse_unknown(const std::vector<std::string>& names, const std::vector<Effect>& effects) {
  std::vector<std::string> known;
  for (const Effect& e : effects) known.push_back(e.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    throw InputError("'" + name + "' is no effect of this tank" + did_you_mean(name, known));
  }
}

}  // namespace

Model tank_of(const ProofOptions& options) {
  return with_modules(options.drawn_tank ? tank_model(drawn_for(options)) : tank_model(), options);
}

Experiment open_tank(const ProofOptions& options, const Model& tank) {
  Experiment e;
  e.name = "proof";
  // What a drawn tank is like is for the diagnosis to find.
  e.base.model = with_steps(with_modules(tank_model(), options), 5);
  if (options.known_flow) e.base.model.field = tank.field;
  const double seconds = 60 * options.minutes;
  const double of_balls = options.ball_minutes > 0 ? 60 * options.ball_minutes : seconds;
  std::vector<RecordingShape> shapes(kSealedRecordings,
                                     shape_named("balls", BodyKind::ball, kBalls, of_balls));
  const std::uint64_t seed = derived_seed(options.diagnosis.seed, kTankSeed);
  auto balls = film_tank(with_steps(tank, kSealedSteps), {}, {}, shapes, seed, options.foreign);
  Sealed nothing;
  nothing.factors.assign(5, 1.0), nothing.foreign = options.foreign;
  nothing.logged = options.event_log;
  auto lilies = film_sealed(tank, nothing, seconds, derived_seed(seed, 1));
  if (!balls || !lilies) throw InputError("the proof's tank diverges");
  if (options.known_flow) balls->clear();
  for (auto* of : {&*balls, &*lilies}) {
    for (Recording& r : *of) e.recordings.push_back(std::move(r));
  }
  return e;
}

std::string words_for_latches(const ProofOptions& options) {
  if (options.latches.empty()) return "";
  return "latches on with the rules " + read_ruleset(options.latches).name +
         (options.event_log ? ", events logged" : "");
}

std::string key_of_tank(const ProofOptions& options) {
  std::string out = options.foreign ? "engine Box2D\n" : "";
  if (!options.latches.empty()) out += words_for_latches(options) + "\n";
  if (options.drawn_tank) out += key_text(drawn_for(options));
  return out;
}

std::string words_for_tank(const ProofOptions& options) {
  return std::string(options.drawn_tank ? "a drawn tank" : "the built-in tank") + " of seed " +
         std::to_string(options.diagnosis.seed) + ", recordings of " +
         significant(options.minutes, 6) + " min, " +
         (options.modules == ProofOptions{}.modules ? ""
                                                    : counted(options.modules, "module") + ", ") +
         (options.known_flow ? "known flow"
          : options.ball_minutes > 0
              ? "flow from balls of " + significant(options.ball_minutes, 6) + " min"
              : "flow from balls") +
         (options.foreign ? ", recorded with Box2D" : "") +
         (options.latches.empty() ? "" : ", " + words_for_latches(options)) +
         (options.diagnosis.uncertified ? ", insufficient recordings diagnosed" : "");
}

std::vector<Sealed> requested(const ProofOptions& options, const Model& tank,
                              const std::vector<Shape>& shapes, std::uint64_t seed) {
  const std::vector<Effect> catalogue = effect_catalogue(tank);
  refuse_unknown(options.effects, catalogue);
  std::vector<Effect> effects;
  std::vector<int> places;  // of these in the catalogue
  for (const Effect& e : catalogue) {
    const auto& names = options.effects;
    if (!names.empty() && std::ranges::find(names, e.name) == names.end()) continue;
    effects.push_back(e), places.push_back(static_cast<int>(&e - catalogue.data()));
  }
  std::vector<Sealed> out;
  for (int w = 0; w < options.worlds; ++w) {
    Sealed one = seal(tank, effects, shapes, seed, w);
    for (SealedEffect& e : one.effects) {
      if (e.like >= 0) e.like = places[static_cast<std::size_t>(e.like)];
      for (double& a : e.amplitudes) a *= options.sizes;
    }
    one.foreign = options.foreign, one.logged = options.event_log;
    if (options.only.empty() || one.kind == options.only) out.push_back(std::move(one));
  }
  if (out.empty()) {
    throw InputError("none of the first " + std::to_string(options.worlds) +
                     " synthetic experiments is \"" + options.only + "\"");
  }
  return out;
}

}  // namespace lilytank
