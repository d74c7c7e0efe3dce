#include "cli/check_kinetics.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/progress.hpp"
#include "cli/results.hpp"
#include "io/atomic_file.hpp"
#include "io/scenario_layers.hpp"
#include "lilytank/random.hpp"
#include "lilytank/statistics.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

// Worlds that were run, or what was counted elsewhere.
struct Counted {
  RateTable table;
  std::vector<std::vector<double>> completion;  // of each world
  double duration = 0;                          // s, 0: unknown
  int diverged = 0;                             // worlds, left out of the above
};

// What a check decides about its worlds, whatever a scenario says.
void refuse_overruled(const CheckJob& job) {
  const VerbOptions& options = job.options;
  const struct {
    std::string path, why;
    bool overruled;
  } ours[] = {
      {"ruleset.file", "the rules are those that are checked", true},
      {"control.latches", "latches are on", true},
      {"run.seed", "--seed decides", true},
      {"module.count", "--modules decides", options.has("modules")},
      {"run.duration", "--duration decides", options.has("duration")},
  };
  for (const Assignment& set : read_assignments(job.sets, "--set"))
    for (const auto& value : ours)
      if (value.overruled && set.path() == value.path)
        options.refuse("--set " + value.path + " would have no effect: " + value.why);
}

Scenario scenario_for(const CheckJob& job) {
  const VerbOptions& options = job.options;
  std::vector<std::string> sets = job.sets;
  if (options.has("modules")) sets.push_back("module.count=" + std::to_string(job.check.modules));
  sets.push_back("control.latches=true");
  sets.push_back("run.seed=0");
  if (job.duration > 0) sets.push_back("run.duration=" + shortest(job.duration));
  Scenario scenario = load_scenario(job.scenarios, sets);
  const Model& model = scenario.model;
  if (!model.commands.empty() || !model.feedback.empty()) {
    options.refuse(
        "the scenario's [[command]] tables would have no effect: rates are of one ruleset and one "
        "flow; an overlay with the line 'command = []' takes them out");
  }
  if (model.module.count < 1 || model.module.count > kMostModules) {
    options.refuse("the scenario's module.count " + std::to_string(model.module.count) +
                   " is outside 1 .. " + std::to_string(kMostModules) + ": give --modules");
  }
  return scenario;
}

bool same_but_for_p(const Ruleset& a, const Ruleset& b) {
  const auto same = [](const Rule& x, const Rule& y) {
    return x.name == y.name && x.kind == y.kind && x.before == y.before && x.after == y.after;
  };
  return std::equal(a.rules.begin(), a.rules.end(), b.rules.begin(), b.rules.end(), same);
}

// Takes over the p that the scenario sets, where its rules are these; a line about what that
// changes. Rules of one name in two rulesets are not one rule: a last join is not to be undone.
std::string take_p(const Scenario& scenario, Ruleset& rules) {
  std::string note;
  for (const ScenarioEntry& entry : scenario.entries) {
    if (entry.is_default || !entry.path.starts_with("rules.")) continue;
    const Ruleset& theirs = scenario.model.rulesets.front();
    if (!same_but_for_p(rules, theirs)) {
      throw InputError(entry.where, entry.path + " would have no effect: it is of the rules of " +
                                        theirs.name + ", and those of " + rules.name +
                                        " are others; measure in a scenario that sets no such p");
    }
    for (std::size_t k = 0; k < rules.rules.size(); ++k) {
      Rule& ours = rules.rules[k];
      const double p = theirs.rules[k].p;
      if ("rules." + ours.name + ".p" != entry.path || p == ours.p) continue;
      note += (note.empty() ? "p as the scenario sets it: " : ", ") + ours.name + " " +
              shortest(p) + " (ruleset: " + shortest(ours.p) + ")";
      ours.p = p, ours.where = entry.where;
    }
  }
  check_probabilities(rules);
  return note.empty() ? note : note + "\n";
}

// Of all that decides a world: the scenario, and the rules that stand in for its own.
std::uint64_t identity_of(const Scenario& scenario, const Ruleset& rules) {
  return fnv_bytes(to_text(rules), scenario.identity);
}

// Of a directory's results: more worlds are added to those of the same rules and scenario.
std::string identity_of(const CheckInput& input) {
  if (input.scenario) return hex(identity_of(*input.scenario, input.rules));
  Fnv hash;
  hash.add(to_text(input.rules)), hash.add(to_csv(*input.rates));
  return hex(hash.value());
}

Counted measure(const CheckJob& of, const CheckInput& input, const std::string& dir,
                const Host& host) {
  const Scenario& scenario = *input.scenario;
  MeasureOptions job = of.measured;
  job.duration = scenario.duration;
  job.out = dir;
  job.identity = identity_of(scenario, input.rules);
  Progress progress(of.quiet, host);
  progress.watch(job);
  const std::vector<MeasuredWorld> worlds = measure_worlds(scenario.model, job);
  progress.clear();
  Counted counted;
  counted.duration = scenario.duration;
  for (const MeasuredWorld& world : worlds) {
    counted.diverged += world.diverged ? 1 : 0;
    if (world.diverged) continue;
    counted.table.add(world.rates);
    counted.completion.push_back(world.completion);
  }
  return counted;
}

// A line on worlds that diverged, if any did.
std::string diverged_text(const Counted& counted) {
  const std::string diverged = std::to_string(counted.diverged);
  const std::string all =
      std::to_string(counted.completion.size() + static_cast<std::size_t>(counted.diverged));
  if (counted.diverged == 0) return "";
  if (counted.completion.empty())
    return (all == "1" ? "the simulation" : "all " + all + " simulations") +
           " diverged: no rates\n";
  return diverged + " of " + all + " simulations diverged and are excluded below\n";
}

RateTable stored_rates(const std::string& where) {
  if (fs::is_directory(where)) {
    check_stored_run(where);
    return rates_of_run(where);
  }
  return rate_table_from(read_whole(where), where);
}

std::string curve_csv(const CurveBand& worlds, const CurveBand& model) {
  std::string out = "time_s,worlds_mean,worlds_low,worlds_high,model_mean,model_low,model_high\n";
  const auto cell = [](const std::vector<double>& values, std::size_t k) {
    const bool known = k < values.size() && std::isfinite(values[k]);
    return "," + (known ? shortest(values[k]) : std::string());
  };
  for (std::size_t k = 0; k < model.time.size(); ++k)
    out += shortest(model.time[k]) + cell(worlds.mean, k) + cell(worlds.low, k) +
           cell(worlds.high, k) + cell(model.mean, k) + cell(model.low, k) + cell(model.high, k) +
           "\n";
  return out;
}

void draw(const CurveBand& worlds, const CurveBand& model, std::size_t number, int possible,
          const CheckJob& job, const std::string& dir) {
  Plot plot;
  plot.x_label = "time (h)";
  plot.y_label = "mean copies of the target";
  plot.y_high = possible;
  const auto add = [&](const CurveBand& band, const std::string& name) {
    if (band.mean.empty()) return;
    Curve curve{name, band.time, band.mean, band.low, band.high};
    for (double& time : curve.x) time /= 3600;
    plot.curves.push_back(std::move(curve));
  };
  add(worlds, std::to_string(number) + " simulations");
  add(model, "well-mixed model");
  Figure figure{
      "yield",
      "Mean completed copies over time, in simulations and in the well-mixed model on rates "
      "measured in them.",
      {{plot}}};
  figure.n = counted(static_cast<std::int64_t>(number), "simulation") + ", " +
             std::to_string(job.gillespie) + " runs of the model";
  figure.band = "95 % of the mean, bootstrap over runs";
  if constexpr (kDraws) draw_figures({figure}, job.origin, dir, job.style);
}

std::string digits(double value) {
  return significant(value, 3);
}

// " (1.2 .. 1.9)"; of one run there is no band.
std::string band_text(const CurveBand& band, std::size_t k) {
  if (!std::isfinite(band.low[k]) || !std::isfinite(band.high[k])) return " (-)";
  return " (" + digits(band.low[k]) + " .. " + digits(band.high[k]) + ")";
}

// Both curves at quarters of the time, and where they are furthest apart.
std::string comparison(const CurveBand& worlds, const CurveBand& model) {
  std::string out;
  const std::size_t n = model.time.size();
  std::size_t furthest = 0;
  for (std::size_t k = 0; k < n && !worlds.mean.empty(); ++k) {
    const auto apart = [&](std::size_t i) { return std::abs(worlds.mean[i] - model.mean[i]); };
    if (apart(k) > apart(furthest)) furthest = k;
  }
  for (std::size_t quarter = 1; quarter <= 4; ++quarter) {
    const std::size_t k = quarter * (n - 1) / 4;
    out += "  after " + digits(model.time[k] / 3600) + " h: model " + digits(model.mean[k]) +
           band_text(model, k) + " copies";
    if (!worlds.mean.empty()) {
      out += ", simulations " + digits(worlds.mean[k]) + band_text(worlds, k);
    }
    out += "\n";
  }
  if (!worlds.mean.empty())
    out += "  furthest apart after " + digits(model.time[furthest] / 3600) + " h: model " +
           digits(model.mean[furthest]) + ", simulations " + digits(worlds.mean[furthest]) + "\n";
  return out;
}

std::string run_model(const CheckJob& job, const CheckInput& input, const Kinetics& kinetics,
                      const Counted& counted, const std::string& dir) {
  const auto runs = static_cast<std::size_t>(job.gillespie);
  if (runs == 0) return "";
  GillespieOptions one;
  one.modules = input.modules;
  if (job.duration > 0) one.duration = job.duration;
  if (counted.duration > 0) one.duration = counted.duration;
  const std::uint64_t seed = job.measured.seed;
  std::vector<std::vector<double>> completion(runs);
  std::int64_t reactions = 0;
  for (std::size_t k = 0; k < runs; ++k) {
    one.seed = derived_seed(seed, k);
    GillespieResult result = run_gillespie(kinetics, one);
    reactions += result.reactions;
    completion[k] = std::move(result.completion);
  }
  std::vector<double> times;
  constexpr int kPoints = 240;
  for (int k = 0; k <= kPoints; ++k) times.push_back(one.duration * k / kPoints);
  const CurveBand model = yield_band(completion, times, seed);
  CurveBand worlds;
  if (!counted.completion.empty()) worlds = yield_band(counted.completion, times, seed);
  if (!dir.empty()) {
    write_atomically((fs::path(dir) / "yield.csv").string(), curve_csv(worlds, model));
    const int possible =
        input.rules.target.empty() ? 1 : possible_copies(input.rules, input.modules);
    draw(worlds, model, counted.completion.size(), possible, job, dir);
  }
  return "well-mixed model, " + std::to_string(runs) + " runs of " + digits(one.duration / 3600) +
         " h, " + std::to_string(reactions) + " reactions; mean copies completed:\n" +
         comparison(worlds, model);
}

std::string table_text(const RateTable& table) {
  std::int64_t dockings = 0;
  for (const auto& [pair, meeting] : table.meetings) dockings += meeting.dockings;
  std::string out = "rates from " + counted(table.worlds, "simulation") + ", " +
                    digits(table.seconds / 3600) + " h: " + std::to_string(dockings) +
                    " dockings of two assemblies";
  if (table.contacts > 0)
    out += "; a new contact lasts " +
           digits(table.contact_seconds / static_cast<double>(table.contacts)) +
           " s until it is decided";
  return out + "\n";
}

// The directory of rates and curves; "": none.
std::string out_of(const CheckJob& job, const CheckInput& input) {
  return job.options.text("out", input.scenario ? "out/check-" + input.rules.name : "");
}

DirectoryJob directory_job(const CheckInput& input) {
  return {"check", identity_of(input),
          with_figures({"check.txt", "check.json", "report.html", "rates.csv", "yield.csv"},
                       {"yield"})};
}

}  // namespace

void add_kinetics_options(CheckJob& job) {
  VerbOptions& options = job.options;
  options.add(
      {"measure", "measure rates in simulations of a scenario (repeat for overlays)", "SCENARIO"},
      &job.scenarios);
  options.add({"set", "a value over the scenario's", "PATH=VALUE"}, &job.sets);
  options.add({"worlds", "simulations to run (20)", "N"}, &job.measured.worlds, 1, 100000);
  options.add({"duration", "of each (the scenario's; model: 4 h)", "TIME"}, &job.duration, 1,
              kLongest, "s");
  options.add({"threads", "simulations at a time (one a core)", "N"}, &job.measured.threads, 0,
              4096);
  options.add({"rates", "a run's directory or a rates.csv instead", "RUN|FILE"});
  options.add({"gillespie", "runs of the well-mixed model on the rates (1000)", "N"},
              &job.gillespie, 0, 1000000);
  options.add({"out", "directory of simulations, rates and curves (out/check-<name>)", "DIR"});
  add_figure_options(options, job.style);
  options.add({"kappa", "the rules for KaSim", "FILE.ka"});
  options.add({"bngl", "the rules for BioNetGen", "FILE.bngl"});
}

void check_kinetics_options(const CheckJob& job) {
  const VerbOptions& options = job.options;
  const bool measures = options.has("measure"), reads = options.has("rates");
  if (measures && reads) options.refuse("--measure or --rates, not both");
  if (!measures) options.refuse_given({"worlds", "set", "threads"}, "belongs to --measure");
  refuse_overruled(job);
  if (!measures && !reads) {
    options.refuse_given({"gillespie", "duration", "out"},
                         "needs rates: --measure SCENARIO or --rates RUN");
  }
  std::vector<std::string> inputs = options.positional();
  inputs.insert(inputs.end(), job.scenarios.begin(), job.scenarios.end());
  inputs.push_back(options.text("rates"));
  for (const char* name : {"kappa", "bngl"}) {
    options.spare_inputs(name, options.text(name), inputs);
  }
  options.spare_each_other({"kappa", "bngl"});
}

CheckInput check_input(const CheckJob& job) {
  const VerbOptions& options = job.options;
  CheckInput input;
  const std::string& file = options.positional().front();
  input.rules = parse_ruleset(read_whole(file), file);
  input.modules = job.check.modules;
  if (options.has("measure")) {
    input.scenario = scenario_for(job);
    input.note = take_p(*input.scenario, input.rules);
    input.scenario->model.rulesets = {input.rules};
    input.modules = input.scenario->model.module.count;
  }
  if (options.has("rates")) input.rates = stored_rates(options.text("rates"));
  return input;
}

std::string kinetics_plan(const CheckJob& job, const CheckInput& input) {
  const VerbOptions& options = job.options;
  std::string plan;
  if (input.rates) static_cast<void>(kinetics_of(input.rules, *input.rates, input.modules));
  if (input.scenario) {
    const Scenario& scenario = *input.scenario;
    plan += "would measure rates in " + counted(job.measured.worlds, "simulation") + " of " +
            shortest(scenario.duration) + " s of " + counted(input.modules, "module") + "\n";
  }
  const std::string dir = out_of(job, input);
  if (!dir.empty()) {
    check_directory_can_be(dir);
    check_directory(dir, job.force, directory_job(input));
    plan += "would write to " + dir + "\n";
  }
  for (const char* name : {"kappa", "bngl"})
    if (options.has(name)) plan += "would write " + options.text(name) + "\n";
  return plan;
}

KineticsReport run_kinetics(const CheckJob& job, const CheckInput& input, const Host& host) {
  const VerbOptions& options = job.options;
  // Where nothing was counted: see docs/synthesis.md.
  double face_rate = kStandardFaceRate, evaluation_rate = kStandardEvaluationRate;
  KineticsReport report;
  if (input.scenario || input.rates) {
    const std::string dir = out_of(job, input);
    std::optional<Kinetics> kinetics;
    // Rates that do not suit the rules are refused before a directory is made.
    if (input.rates) kinetics = kinetics_of(input.rules, *input.rates, input.modules);
    report.lock = claim_directory(dir, job.force, directory_job(input));
    const Counted counted =
        input.scenario ? measure(job, input, dir, host) : Counted{*input.rates, {}, 0, 0};
    report.dir = dir;
    report.diverged = counted.diverged, report.text = diverged_text(counted);
    if (report.diverged > 0 && counted.completion.empty()) return report;
    if (!kinetics) kinetics = kinetics_of(input.rules, counted.table, input.modules);
    if (!dir.empty())
      write_atomically((fs::path(dir) / "rates.csv").string(), to_csv(counted.table));
    face_rate = kinetics->face_rate, evaluation_rate = kinetics->evaluation_rate;
    report.text += table_text(counted.table) + kinetics_text(input.rules, *kinetics) +
                   run_model(job, input, *kinetics, counted, dir);
  }
  NamedContents exports;
  for (const auto& [name, text] : {std::pair("kappa", &to_kappa), std::pair("bngl", &to_bngl)})
    if (options.has(name))
      exports.emplace_back(options.text(name),
                           text(input.rules, face_rate, evaluation_rate, input.modules));
  write_results(exports, job.force);
  return report;
}

}  // namespace lilytank::cli
