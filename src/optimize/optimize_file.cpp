#include "optimize/optimize_file.hpp"

#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
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
  explicit Reader(const std::string& file)
      : file_(file),
        directory_(fs::path(file).parent_path().string()),
        root_(parse_toml(read_whole(file), file)) {}

  OptimizeFile read() {
    const TomlFields top(root_, "", file_,
                         {"optimize", "parameter", "agitation", "race", "compare"});
    if (!top.has("optimize")) throw InputError({file_, 1, 1}, "there is no [optimize] table");
    optimize(top.table("optimize"));
    for (const toml::table* one : top.tables("parameter")) parameter(*one);
    if (top.has("agitation")) agitation(top.table("agitation"));
    if (top.has("race")) race(top.table("race"));
    if (top.has("compare")) compare(top.table("compare"));
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

  void optimize(const toml::table& from) {
    const TomlFields fields(
        from, "optimize", file_,
        {"name", "scenario", "seed", "fitness", "rate_weight", "yield_weight", "hybrid", "method",
         "preset", "evaluations", "population", "sigma", "particles", "iterations", "repeats",
         "noise", "neighbourhood", "final_evaluations", "common_random_numbers"});
    out_.name = fields.has("name") ? fields.text("name") : fs::path(file_).stem().string();
    check_name(out_.name, "optimize.name", fields.place("name"));
    fields.need("scenario", "a scenario file, or a list with its overlays");
    out_.scenarios = paths(fields, "scenario");
    if (fields.has("seed")) {
      out_.seed = static_cast<std::uint64_t>(fields.whole("seed", 0, kLargestSeed));
    }
    fitness(fields);
    if (fields.has("hybrid")) out_.hybrid = fields.flag("hybrid");
    out_.hybrid_place = fields.place("hybrid");
    method(fields);
  }

  void fitness(const TomlFields& fields) {
    if (fields.has("fitness")) {
      out_.fitness.fitness = static_cast<Fitness>(word_of(fields, "fitness", fitness_names()));
    }
    const auto weight = [&](const char* name, const char* unit, double& value) {
      if (!fields.has(name)) return;
      if (out_.fitness.fitness != Fitness::rate_and_yield) {
        fields.refuse(name, fields.path(name) + " goes with fitness = \"rate_and_yield\" only");
      }
      value = fields.number(name, unit);
      if (!(value >= 0)) {
        fields.refuse(name, fields.path(name) + " = " + shortest(value) + " is below 0");
      }
    };
    weight("rate_weight", "s", out_.fitness.rate_weight);
    weight("yield_weight", "1", out_.fitness.yield_weight);
  }

  void method(const TomlFields& fields) {
    if (fields.has("method")) {
      out_.method = static_cast<SearchMethod>(word_of(fields, "method", {"cma_es", "swarm"}));
    }
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

  static int whole(const TomlFields& fields, const char* name, int otherwise, std::int64_t low,
                   std::int64_t high) {
    return fields.has(name) ? static_cast<int>(fields.whole(name, low, high)) : otherwise;
  }

  void take_swarm(const TomlFields& fields) {
    SwarmOptions& o = out_.swarm;
    o.particles = 15, o.iterations = 20;
    if (fields.has("preset")) {
      const auto names = swarm_presets();
      o = swarm_preset(names[word_of(fields, "preset", names)]);
      out_.start_anywhere = true;
    }
    o.particles = whole(fields, "particles", o.particles, 2, 100000);
    o.iterations = whole(fields, "iterations", o.iterations, 1, 1000000);
    o.evaluations = whole(fields, "repeats", o.evaluations, 1, 10000);
    o.final_evaluations =
        whole(fields, "final_evaluations", o.final_evaluations, 0, kMostEvaluations);
    if (fields.has("noise")) {
      o.noise = static_cast<NoiseRule>(word_of(fields, "noise", {"none", "reevaluate", "ocba"}));
    }
    if (fields.has("neighbourhood")) {
      o.neighbourhood = static_cast<Neighbourhood>(
          word_of(fields, "neighbourhood", {"global", "ring", "von-neumann"}));
    }
  }

  void take_cma_es(const TomlFields& fields) {
    CmaEsOptions& o = out_.cma_es;
    o.budget = 300, o.final_evaluations = 60;
    if (fields.has("evaluations")) o.budget = fields.whole("evaluations", 1, kMostEvaluations);
    o.final_evaluations =
        whole(fields, "final_evaluations", static_cast<int>(o.budget / 5), 0, kMostEvaluations);
    if (!fields.has("final_evaluations") && o.final_evaluations < 4) o.final_evaluations = 0;
    o.population = whole(fields, "population", 0, 0, 100000);
    if (fields.has("sigma")) o.sigma = fields.number("sigma", "1");
  }

  void parameter(const toml::table& from) {
    const TomlFields fields(from, "parameter", file_, {"path", "low", "high", "scale", "start"});
    OptimizeParameter out;
    out.place = fields.place();
    fields.need("path", "what is searched, as rules.r1_reverse.p");
    out.path = path_of(fields);
    const KeyFacts facts = facts_of(out.path);
    fields.need("low", "the least value"), fields.need("high", "the largest value");
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

  void agitation(const toml::table& from) {
    const TomlFields fields(from, "agitation", file_, {"kind", "low", "high", "pieces"});
    AgitationTable& out = out_.agitation;
    out.place = fields.place();
    fields.need("kind", "\"schedule\" or \"feedback\"");
    out.kind = static_cast<Agitation>(1 + word_of(fields, "kind", {"schedule", "feedback"}));
    fields.need("low", "the least pump power, as \"50 %\"");
    fields.need("high", "the largest pump power");
    out.low = fields.number("low", "%"), out.high = fields.number("high", "%");
    if (out.low < 0 || out.high > 100 || !(out.low < out.high)) {
      fields.refuse("high", "agitation.low = " + shortest(out.low) + " % and agitation.high = " +
                                shortest(out.high) + " % are not in order within 0 .. 100 %");
    }
    if (fields.has("pieces") && out.kind == Agitation::feedback) {
      fields.refuse("pieces", "agitation.pieces goes with kind = \"schedule\" only");
    }
    out.pieces = whole(fields, "pieces", out.pieces, 1, 20);
  }

  void race(const toml::table& from) {
    const TomlFields fields(from, "race", file_, {"target", "rulesets", "evaluations"});
    RaceTable out;
    out.place = fields.place();
    if (fields.has("target")) out.target = paths(fields, "target").front();
    out.rulesets = whole(fields, "rulesets", out.rulesets, 2, 100000);
    out.evaluations = whole(fields, "evaluations", out.evaluations, 2, 1000000);
    if (out_.method != SearchMethod::cma_es) {
      throw InputError(out.place, "a race is run with method = \"cma_es\"");
    }
    out_.race = out;
  }

  void compare(const toml::table& from) {
    const TomlFields fields(from, "compare", file_, {"overlays", "labels", "replicates", "seed"});
    CompareTable& out = out_.compare;
    fields.need("replicates", "how many simulations of the optimum and of each overlay");
    out.replicates = whole(fields, "replicates", 0, 1, 10'000'000);
    out.seed = fields.has("seed")
                   ? static_cast<std::uint64_t>(fields.whole("seed", 0, kLargestSeed))
                   : out_.seed + 1;
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

  std::string file_, directory_;
  toml::table root_;
  OptimizeFile out_;
};

}  // namespace

OptimizeFile read_optimize_file(const std::string& file) {
  return Reader(file).read();
}

}  // namespace lilytank
