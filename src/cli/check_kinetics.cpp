#include "cli/check_kinetics.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/progress.hpp"
#include "cli/stop_signal.hpp"
#include "io/atomic_file.hpp"
#include "lilytank/measure.hpp"
#include "lilytank/random.hpp"
#include "lilytank/scenario.hpp"
#include "lilytank/statistics.hpp"
#include "text/number.hpp"
#ifdef LILYTANK_HAS_RENDER
#include "lilytank/render.hpp"
#endif

namespace lilytank::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 1e9;  // s

// Worlds that were run, or what was counted elsewhere.
struct Counted {
  RateTable table;
  std::vector<std::vector<double>> completion;  // of each world
  double duration = 0;                          // s, 0: unknown
};

Scenario scenario_for(const VerbOptions& options, const Ruleset& rules, int modules) {
  std::vector<std::string> sets = options.list("set");
  sets.push_back("module.count=" + std::to_string(modules));
  sets.push_back("control.latches=true");
  sets.push_back("run.seed=0");
  if (options.has("duration")) {
    sets.push_back("run.duration=" + shortest(options.number("duration", 0, 1, kLongest, "s")));
  }
  Scenario scenario = load_scenario(options.list("measure"), sets);
  scenario.model.rulesets = {rules};
  scenario.model.commands.clear();
  scenario.model.feedback.clear();
  return scenario;
}

// Of all that decides a world: the scenario, and the rules that stand in for its own.
std::uint64_t identity_of(const Scenario& scenario, const Ruleset& rules) {
  std::uint64_t hash = scenario.identity;
  for (const char c : to_text(rules)) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

// Nothing if it was stopped.
std::optional<Counted> measure(const VerbOptions& options, const Ruleset& rules, int modules,
                               const std::string& dir) {
  const Scenario scenario = scenario_for(options, rules, modules);
  MeasureOptions job;
  job.worlds = static_cast<int>(options.whole("worlds", job.worlds, 1, 100000));
  job.seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
  job.threads = static_cast<int>(options.whole("threads", 0, 0, 4096));
  job.duration = scenario.duration;
  job.out = dir;
  job.identity = identity_of(scenario, rules);
  job.stop = &stop_signal();
  Progress progress(options.has("quiet"));
  job.progress = [&](double done) { progress.tell(done, "of the worlds"); };
  const std::vector<MeasuredWorld> worlds = measure_worlds(scenario.model, job);
  progress.clear();
  if (stop_signal().load()) return std::nullopt;
  Counted counted;
  counted.duration = scenario.duration;
  for (const MeasuredWorld& world : worlds) {
    if (world.diverged) continue;
    counted.table.add(world.rates);
    counted.completion.push_back(world.completion);
  }
  return counted;
}

RateTable stored_rates(const std::string& where) {
  if (fs::is_directory(where)) return rates_of_run(where);
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
          const std::string& dir) {
#ifdef LILYTANK_HAS_RENDER
  Plot plot;
  plot.title = "Physical worlds and the well-mixed model on rates measured in them";
  plot.x_label = "time (h)";
  plot.y_label = "mean copies of the target";
  plot.y_high = possible;
  const auto add = [&](const CurveBand& band, const std::string& name) {
    if (band.mean.empty()) return;
    Curve curve{name, band.time, band.mean, band.low, band.high};
    for (double& time : curve.x) time /= 3600;
    plot.curves.push_back(std::move(curve));
  };
  add(worlds, std::to_string(number) + " physical worlds");
  add(model, "well-mixed model");
  for (const char* ending : {".png", ".svg"})
    draw_plot(plot, (fs::path(dir) / (std::string("yield") + ending)).string());
#else
  static_cast<void>(worlds), static_cast<void>(model), static_cast<void>(number),
      static_cast<void>(possible), static_cast<void>(dir);
#endif
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
      out += ", worlds " + digits(worlds.mean[k]) + band_text(worlds, k);
    }
    out += "\n";
  }
  if (!worlds.mean.empty())
    out += "  furthest apart after " + digits(model.time[furthest] / 3600) + " h: model " +
           digits(model.mean[furthest]) + ", worlds " + digits(worlds.mean[furthest]) + "\n";
  return out;
}

std::string run_model(const VerbOptions& options, const Ruleset& rules, const Kinetics& kinetics,
                      const Counted& counted, int modules, const std::string& dir) {
  const auto runs = static_cast<std::size_t>(options.whole("gillespie", 1000, 0, 1000000));
  if (runs == 0) return "";
  GillespieOptions one;
  one.modules = modules;
  one.duration =
      counted.duration > 0 ? counted.duration : options.number("duration", 14400, 1, kLongest, "s");
  const auto seed = static_cast<std::uint64_t>(options.whole("seed", 1, 0, INT64_MAX));
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
    const int n = static_cast<int>(rules.target.size());
    draw(worlds, model, counted.completion.size(), n > 0 ? modules / n : 1, dir);
  }
  return "well-mixed model, " + std::to_string(runs) + " runs of " + digits(one.duration / 3600) +
         " h, " + std::to_string(reactions) + " reactions; mean copies completed:\n" +
         comparison(worlds, model);
}

std::string table_text(const RateTable& table) {
  std::int64_t dockings = 0;
  for (const auto& [pair, meeting] : table.meetings) dockings += meeting.dockings;
  std::string out = "rates from " + std::to_string(table.worlds) +
                    (table.worlds == 1 ? " world" : " worlds") + ", " +
                    digits(table.seconds / 3600) + " h: " + std::to_string(dockings) +
                    " dockings of two assemblies";
  if (table.contacts > 0)
    out += "; a new contact lasts " +
           digits(table.contact_seconds / static_cast<double>(table.contacts)) +
           " s until it is decided";
  return out + "\n";
}

}  // namespace

void add_kinetics_options(VerbOptions& options) {
  const auto text = [] { return cxxopts::value<std::string>(); };
  const auto list = [] { return cxxopts::value<std::vector<std::string>>(); };
  options.add()("measure", "count rates in worlds of a scenario (repeat for overlays)", list(),
                "SCENARIO")("set", "a value over the scenario's", list(), "PATH=VALUE")(
      "worlds", "how many (20)", text(), "N")("duration", "of each (the scenario's; model: 4 h)",
                                              text(), "TIME")(
      "threads", "worlds at once (one a core)", text(), "N")(
      "rates", "a run's directory or a rates.csv instead", text(), "RUN|FILE")(
      "gillespie", "runs of the well-mixed model on the rates (1000)", text(), "N")(
      "out", "directory for worlds, rates and curves (out/check-<name>)", text(), "DIR")(
      "kappa", "the rules for KaSim", text(), "FILE.ka")("bngl", "the rules for BioNetGen", text(),
                                                         "FILE.bngl");
}

void check_kinetics_options(const VerbOptions& options) {
  const bool measures = options.has("measure"), reads = options.has("rates");
  if (measures && reads) options.refuse("--measure or --rates, not both");
  if (!measures) options.refuse_given({"worlds", "set", "threads"}, "belongs to --measure");
  if (!measures && !reads) {
    options.refuse_given({"gillespie", "duration", "out"},
                         "needs rates: --measure SCENARIO or --rates RUN");
  }
  static_cast<void>(options.number("duration", 0, 1, kLongest, "s"));
  std::vector<std::string> inputs = options.positional();
  for (const std::string& file : options.list("measure")) inputs.push_back(file);
  inputs.push_back(options.text("rates"));
  for (const char* name : {"kappa", "bngl"}) options.spare_inputs(name, options.text(name), inputs);
  options.spare_each_other({"kappa", "bngl"});
}

std::optional<RateTable> kinetics_input(const VerbOptions& options, const Ruleset& rules,
                                        int modules) {
  if (options.has("measure")) static_cast<void>(scenario_for(options, rules, modules));
  if (!options.has("rates")) return std::nullopt;
  return stored_rates(options.text("rates"));
}

std::optional<std::string> run_kinetics(const VerbOptions& options, const Ruleset& rules,
                                        int modules, std::optional<RateTable> rates) {
  const bool measures = options.has("measure");
  // Where nothing was counted: see docs/synthesis.md.
  double face_rate = kStandardFaceRate, evaluation_rate = kStandardEvaluationRate;
  std::string out;
  if (measures || rates) {
    const std::string dir = options.text("out", measures ? "out/check-" + rules.name : "");
    if (!dir.empty()) {
      std::error_code error;
      fs::create_directories(dir, error);
      if (error) options.refuse("--out " + dir + ": " + error.message());
    }
    Counted counted;
    if (measures) {
      auto found = measure(options, rules, modules, dir);
      if (!found) return std::nullopt;
      counted = std::move(*found);
    } else {
      counted.table = std::move(*rates);
    }
    if (!dir.empty())
      write_atomically((fs::path(dir) / "rates.csv").string(), to_csv(counted.table));
    const Kinetics kinetics = kinetics_of(rules, counted.table, modules);
    face_rate = kinetics.face_rate, evaluation_rate = kinetics.evaluation_rate;
    out += table_text(counted.table) + kinetics_text(rules, kinetics) +
           run_model(options, rules, kinetics, counted, modules, dir);
  }
  if (options.has("kappa"))
    write_atomically(options.text("kappa"), to_kappa(rules, face_rate, evaluation_rate, modules));
  if (options.has("bngl"))
    write_atomically(options.text("bngl"), to_bngl(rules, face_rate, evaluation_rate, modules));
  return out;
}

}  // namespace lilytank::cli
