#include "optimize/optimize_file.hpp"

#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "io/standard_input.hpp"
#include "io/toml_fields.hpp"
#include "study/study_axis.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000'000;
constexpr std::int64_t kMostEvaluations = 100'000'000;

class Reader {
 public:
  Reader(const std::string& file, std::optional<std::uint64_t> seed)
      : seed_(seed),
        file_(file),
        directory_(fs::path(file).parent_path().string()),
        root_(parse_toml(read_whole(file), file)) {}

  OptimizeFile read() {
    const TomlFields top(root_, "", file_, optimize_file_keys());
    if (!top.has("optimize")) throw InputError({file_, 1, 1}, "there is no [optimize] table");
    optimize(top.fields("optimize"));
    for (const TomlFields& one : top.list_of_fields("parameter")) parameter(one);
    if (top.has("agitation")) agitation(top.fields("agitation"));
    if (top.has("race")) race(top.fields("race"));
    if (top.has("compare")) compare(top.fields("compare"));
    if (out_.parameters.empty() && out_.agitation.kind == Agitation::none) {
      throw InputError(top.place("optimize"),
                       "nothing is to be searched: there is no [[parameter]] and no [agitation]");
    }
    return std::move(out_);
  }

 private:
  /// Files named beside this one; each must be readable.
  std::vector<std::string> paths(const TomlFields& fields, const std::string& name) const {
    std::vector<std::string> out;
    for (const auto& [text, place] : fields.texts(name)) {
      out.push_back((fs::path(directory_) / text).string());
      static_cast<void>(read_whole(out.back(), place));  // the message should point here
    }
    return out;
  }

  void optimize(const TomlFields& fields) {
    out_.name = fields.has("name") ? fields.text("name") : stem_of(file_);
    check_name(out_.name, "optimize.name", fields.place("name"));
    out_.scenarios = paths(fields, "scenario");
    if (fields.has("seed")) out_.seed = static_cast<std::uint64_t>(fields.whole("seed"));
    out_.seed = seed_.value_or(out_.seed);
    fitness(fields);
    if (fields.has("hybrid")) out_.hybrid = fields.flag("hybrid");
    out_.hybrid_place = fields.place("hybrid");
    method(fields);
  }

  void fitness(const TomlFields& fields) {
    if (fields.has("fitness")) out_.fitness.fitness = static_cast<Fitness>(fields.word("fitness"));
    const auto weight = [&](const char* name, double& value) {
      if (!fields.has(name)) return;
      if (out_.fitness.fitness != Fitness::rate_and_yield) {
        fields.refuse(name, fields.path(name) + " goes with fitness = \"rate_and_yield\" only");
      }
      value = fields.number(name);
    };
    weight("rate_weight", out_.fitness.rate_weight);
    weight("yield_weight", out_.fitness.yield_weight);
  }

  void method(const TomlFields& fields) {
    if (fields.has("method")) out_.method = static_cast<SearchMethod>(fields.word("method"));
    const bool swarm = out_.method == SearchMethod::swarm;
    const auto goes_with = [&](const std::vector<const char*>& names, const char* word) {
      for (const char* name : names) {
        if (!fields.has(name)) continue;
        fields.refuse(name, fields.path(name) + " goes with method = \"" + word + "\" only");
      }
    };
    if (swarm) {
      goes_with({"evaluations", "population", "sigma"}, "cma_es");
      take_swarm(fields);
    } else {
      goes_with({"preset", "particles", "iterations", "repeats", "noise", "neighbourhood"},
                "swarm");
      take_cma_es(fields);
    }
    if (fields.has("common_random_numbers")) {
      const bool common = fields.flag("common_random_numbers");
      out_.swarm.common_random_numbers = out_.cma_es.common_random_numbers = common;
    }
  }

  static int whole(const TomlFields& fields, const char* name, int otherwise) {
    return fields.has(name) ? static_cast<int>(fields.whole(name)) : otherwise;
  }

  void take_swarm(const TomlFields& fields) {
    SwarmOptions& o = out_.swarm;
    o.particles = 15, o.iterations = 20;
    if (fields.has("preset")) {
      o = swarm_preset(swarm_presets()[fields.word("preset")]);
      out_.start_anywhere = true;
    }
    o.particles = whole(fields, "particles", o.particles);
    o.iterations = whole(fields, "iterations", o.iterations);
    o.evaluations = whole(fields, "repeats", o.evaluations);
    o.final_evaluations = whole(fields, "final_evaluations", o.final_evaluations);
    if (fields.has("noise")) o.noise = static_cast<NoiseRule>(fields.word("noise"));
    if (fields.has("neighbourhood")) {
      o.neighbourhood = static_cast<Neighbourhood>(fields.word("neighbourhood"));
    }
  }

  void take_cma_es(const TomlFields& fields) {
    CmaEsOptions& o = out_.cma_es;
    o.budget = 300, o.final_evaluations = 60;
    if (fields.has("evaluations")) o.budget = fields.whole("evaluations");
    o.final_evaluations = whole(fields, "final_evaluations", static_cast<int>(o.budget / 5));
    if (!fields.has("final_evaluations") && o.final_evaluations < 4) o.final_evaluations = 0;
    o.population = whole(fields, "population", 0);
    if (fields.has("sigma")) o.sigma = fields.number("sigma");
  }

  void parameter(const TomlFields& fields) {
    OptimizeParameter out;
    out.place = fields.place();
    out.path = path_of(fields);
    const KeyFacts facts = facts_of(out.path);
    out.low = fields.number("low", facts.unit), out.high = fields.number("high", facts.unit);
    out.whole = facts.whole;
    out.logarithmic = log_scale(fields);
    if (!(out.low < out.high)) fields.refuse("high", "parameter.high is not above parameter.low");
    if (out.logarithmic && out.low <= 0) {
      fields.refuse("low", "scale = \"log\" needs a parameter.low above 0");
    }
    if (fields.has("start")) {
      out.start = fields.number("start", facts.unit);
      if (*out.start < out.low || *out.start > out.high) {
        fields.refuse("start", "parameter.start = " + shortest(*out.start) + " is outside " +
                                   shortest(out.low) + " .. " + shortest(out.high));
      }
    }
    out_.parameters.push_back(std::move(out));
  }

  void agitation(const TomlFields& fields) {
    AgitationTable& out = out_.agitation;
    out.place = fields.place();
    out.kind = static_cast<Agitation>(1 + fields.word("kind"));
    out.low = fields.number("low", "%"), out.high = fields.number("high", "%");
    if (out.low < 0 || out.high > 100 || !(out.low < out.high)) {
      fields.refuse("high", "agitation.low = " + shortest(out.low) + " % and agitation.high = " +
                                shortest(out.high) + " % are not in order within 0 .. 100 %");
    }
    if (fields.has("pieces") && out.kind == Agitation::feedback) {
      fields.refuse("pieces", "agitation.pieces goes with kind = \"schedule\" only");
    }
    out.pieces = whole(fields, "pieces", out.pieces);
  }

  void race(const TomlFields& fields) {
    RaceTable out;
    out.place = fields.place();
    if (fields.has("target")) out.target = paths(fields, "target").front();
    out.rulesets = whole(fields, "rulesets", out.rulesets);
    out.evaluations = whole(fields, "evaluations", out.evaluations);
    if (out_.method != SearchMethod::cma_es) {
      throw InputError(out.place, "a race is run with method = \"cma_es\"");
    }
    out_.race = out;
  }

  void compare(const TomlFields& fields) {
    CompareTable& out = out_.compare;
    out.replicates = whole(fields, "replicates", 0);
    out.seed =
        fields.has("seed") ? static_cast<std::uint64_t>(fields.whole("seed")) : out_.seed + 1;
    if (fields.has("overlays")) out.overlays = paths(fields, "overlays");
    if (fields.has("labels")) {
      for (const auto& [text, place] : fields.texts("labels")) out.labels.push_back(text);
    } else {
      for (const std::string& path : out.overlays) {
        out.labels.push_back(fs::path(path).stem().string());
      }
    }
    if (out.labels.size() == out.overlays.size()) return;
    fields.refuse("labels", "compare.labels has " + std::to_string(out.labels.size()) +
                                " texts for " + std::to_string(out.overlays.size()) + " overlays");
  }

  std::optional<std::uint64_t> seed_;
  std::string file_, directory_;
  toml::table root_;
  OptimizeFile out_;
};

TomlKeys optimize_keys() {
  using namespace toml_key;
  return {
      text("name", "names files and the report (default: the file's name)"),
      needed(texts("scenario", "a scenario file, or a list with its overlays")),
      whole("seed", 0, kLargestSeed, "where the seeds of the simulations come from (1)"),
      word("fitness", fitness_names(), "what is minimised"),
      number("rate_weight", "s", 0, 1e12, "of the assembly rate, of \"rate_and_yield\""),
      number("yield_weight", "1", 0, 1e12, "of the full yield, of \"rate_and_yield\""),
      flag("hybrid", "a second set of probabilities after some completed copies"),
      word("method", {"cma_es", "swarm"}, "of the search (cma_es)"),
      word("preset", swarm_presets(), "a published swarm, for method = \"swarm\""),
      whole("evaluations", 1, kMostEvaluations, "simulations in all, of cma_es (300)"),
      whole("population", 0, 100000, "points of a generation, of cma_es; 0: by dimension"),
      number("sigma", "1", -1e9, 1e9, "first step as a fraction of the bounds, of cma_es"),
      whole("particles", 2, 100000, "of the swarm (15)"),
      whole("iterations", 1, 1000000, "of the swarm (20)"),
      whole("repeats", 1, 10000, "simulations of a particle and iteration, of the swarm"),
      word("noise", {"none", "reevaluate", "ocba"}, "how the swarm treats noise"),
      word("neighbourhood", {"global", "ring", "von-neumann"}, "of the swarm"),
      whole("final_evaluations", 0, kMostEvaluations,
            "of the candidates at the end, which the optimum is chosen from"),
      flag("common_random_numbers", "candidates are compared with the same seeds"),
  };
}

}  // namespace

TomlKeys optimize_file_keys() {
  using namespace toml_key;
  const TomlKeys parameter{needed(text("path", "what is searched, as rules.r1_reverse.p")),
                           needed(quantity("low", "the least value")),
                           needed(quantity("high", "the largest value")), scale_key(),
                           quantity("start", "where the search begins (the scenario's value)")};
  const TomlKeys agitation{
      needed(word("kind", {"schedule", "feedback"}, "\"schedule\" or \"feedback\"")),
      needed(number("low", "%", -1e9, 1e9, "the least pump power, as \"50 %\"")),
      needed(number("high", "%", -1e9, 1e9, "the largest pump power")),
      whole("pieces", 1, 20, "of the schedule")};
  const TomlKeys race{text("target", "drawing of the target; rulesets are made from it"),
                      whole("rulesets", 2, 100000, "that race"),
                      whole("evaluations", 2, 1000000, "of each ruleset in the first round")};
  const TomlKeys compare{
      texts("overlays", "files that the optimum is compared with"),
      texts("labels", "one for each overlay"),
      needed(whole("replicates", 1, 10'000'000,
                   "how many simulations of the optimum and of each overlay")),
      whole("seed", 0, kLargestSeed, "of the comparison (one above the search's)")};
  return {table("optimize", optimize_keys(), "what is minimised, and how"),
          tables("parameter", parameter, "what is searched"),
          table("agitation", agitation, "pump power over time or copies"),
          table("race", race, "rulesets for one target against each other"),
          table("compare", compare, "the optimum against other settings")};
}

OptimizeFile read_optimize_file(const std::string& file, std::optional<std::uint64_t> seed) {
  return Reader(file, seed).read();
}

}  // namespace lilytank
