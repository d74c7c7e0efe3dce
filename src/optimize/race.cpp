#include "optimize/race.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/search_run.hpp"
#include "lilytank/synthesis.hpp"
#include "optimize/repeats.hpp"
#include "optimize/search_directory.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// "chain5-07", as `lilytank synthesize --all` numbers them.
std::string numbered(const std::string& name, std::size_t index, std::size_t count) {
  std::string number = std::to_string(index + 1);
  number.insert(0, std::to_string(count).size() - number.size(), '0');
  return name + "-" + number;
}

/// The scenario's own, then those of the target's other plans.
std::vector<Ruleset> rulesets_of(const Optimization::Source& source) {
  const RaceTable& race = *source.file.race;
  const Ruleset own = source.scenario(source.plan.start).model.rulesets.front();
  const Target target =
      race.target.empty() ? target_of(own.target, own.name) : read_target(race.target);
  if (canonical_shape(target.cells) != canonical_shape(own.target)) {
    throw InputError(race.place,
                     "'" + target.file + "' is not the target of the scenario's ruleset");
  }
  const PlanList list = all_plans(target);
  std::vector<Ruleset> out{own};
  out.front().name = own.name + "-own";
  const std::size_t n = list.plans.size();
  const auto most = static_cast<std::size_t>(race.rulesets);
  // All, or as many evenly through the list, which is ordered by tree and algorithm.
  for (std::size_t k = 0; k < std::min(most, n); ++k) {
    const std::size_t index = n <= most ? k : k * n / most;
    Ruleset rules = emit(target, list.plans[index]);
    rules.name = numbered(target.name, index, n);
    if (structure_of(rules) != structure_of(own) && out.size() < most) {
      out.push_back(std::move(rules));
    }
  }
  return out;
}

/// A ruleset of the race, and where it stands.
struct Contestant {
  const Optimization::Source* source = nullptr;
  RaceEntry entry;
  std::vector<double> point;
};

class Race {
 public:
  Race(const Optimization::Source& source, const OptimizationOptions& options)
      : source_(&source), options_(&options), dir_(fs::path(options.out)) {}

  RaceOutcome run() {
    claim();
    enter();
    const auto most = static_cast<std::int64_t>(contestants_.size());
    total_ = race_evaluations(static_cast<int>(most), source_->file.race->evaluations);
    std::vector<Contestant*> alive;
    for (Contestant& one : contestants_) alive.push_back(&one);
    std::int64_t each = source_->file.race->evaluations;
    for (int round = 1; alive.size() > 1; ++round, each *= 2) {
      for (Contestant* one : alive) {
        one->entry.round = round;
        judge(*one, round, each);
      }
      halve(alive);
    }
    write_table();
    RaceOutcome out;
    const auto all = static_cast<double>(total_ + source_->file.cma_es.budget);
    out.share = static_cast<double>(total_) / all;
    for (const Contestant& one : contestants_) out.entries.push_back(one.entry);
    out.start = alive.front()->point;
    out.winner = alive.front()->source;
    if (alive.front() != &contestants_.front()) out.own = contestants_.front().source;
    return out;
  }

 private:
  /// Another race's files were refused or removed before.
  void claim() const {
    make_directory((dir_ / "race").string());
    write_atomically(race_identity_file(options_->out), race_identity(*source_));
  }

  void enter() {
    make_directory((dir_ / "rulesets").string());
    for (const auto& source : source_->contestants) {
      Contestant one;
      one.source = source.get(), one.point = source->plan.start;
      one.entry.ruleset = source->ruleset->name;
      write_atomically(ruleset_file(options_->out, *source), to_text(*source->ruleset));
      contestants_.push_back(std::move(one));
    }
  }

  void judge(Contestant& one, int round, std::int64_t each) {
    // Two generations with their re-evaluations, and the final selection.
    const std::int64_t least = 2 * one.source->generation() + std::max<std::int64_t>(4, each / 4);
    const bool enough = each >= least;
    enough ? search(one, round, each) : repeat(one, round, each);
    one.entry.evaluations += each, spent_ += each;
    tell(one, round);
  }

  std::string place(const Contestant& one, int round) const {
    return (dir_ / "race" / ("round-" + std::to_string(round)) / one.entry.ruleset).string();
  }

  /// The mean at the point where it stands; replicates are the same for all.
  void repeat(Contestant& one, int round, std::int64_t each) const {
    const Incumbent mean = repeated(*one.source, one.point, 0, static_cast<int>(each),
                                    place(one, round) + ".csv", *options_);
    one.entry.best = mean.mean, one.entry.standard_error = mean.standard_error;
  }

  void search(Contestant& one, int round, std::int64_t each) const {
    SearchRunOptions run;
    run.dir = place(one, round), run.identity = one.source->identity();
    run.threads = options_->threads, run.stop = options_->stop, run.force = options_->force;
    const double sigma = source_->file.cma_es.sigma / 2;
    const SearchRunResult found = run_search(
        one.source->cma_es(each, one.point, sigma),
        [&](const Trial& trial) { return one.source->evaluate(trial, *options_); }, run);
    const Incumbent best = found.search->best();
    one.point = best.point;
    one.entry.best = best.mean, one.entry.standard_error = best.standard_error;
  }

  static void halve(std::vector<Contestant*>& alive) {
    std::stable_sort(alive.begin(), alive.end(), [](const Contestant* a, const Contestant* b) {
      return a->entry.best < b->entry.best;
    });
    const std::size_t kept = (alive.size() + 1) / 2;
    for (std::size_t i = 0; i < alive.size(); ++i) alive[i]->entry.kept = i < kept;
    alive.resize(kept);
  }

  void tell(const Contestant& one, int round) const {
    const auto all = static_cast<double>(total_ + source_->file.cma_es.budget);
    char text[64];
    std::snprintf(text, sizeof text, ", %.4g", one.entry.best);
    options_->report(static_cast<double>(spent_) / all,
                     "round " + std::to_string(round) + ": " + one.entry.ruleset + text);
  }

  void write_table() const {
    std::string text = "ruleset,round,kept,evaluations,mean,standard_error\n";
    for (const Contestant& one : contestants_) {
      const RaceEntry& e = one.entry;
      text += e.ruleset + "," + std::to_string(e.round) + "," + (e.kept ? "1" : "0") + "," +
              std::to_string(e.evaluations) + "," + shortest(e.best) + "," +
              shortest(e.standard_error) + "\n";
    }
    write_atomically((dir_ / "race.csv").string(), text);
  }

  const Optimization::Source* source_;
  const OptimizationOptions* options_;
  fs::path dir_;
  std::vector<Contestant> contestants_;
  std::int64_t spent_ = 0, total_ = 0;
};

}  // namespace

std::int64_t race_evaluations(int rulesets, std::int64_t each) {
  std::int64_t sum = 0;
  for (; rulesets > 1; rulesets = (rulesets + 1) / 2, each *= 2) sum += rulesets * each;
  return sum;
}

std::vector<std::unique_ptr<const Optimization::Source>> contestants_of(
    const Optimization::Source& source) {
  std::vector<std::unique_ptr<const Optimization::Source>> out;
  for (Ruleset& rules : rulesets_of(source)) {
    out.push_back(std::make_unique<const Optimization::Source>(source, std::move(rules)));
  }
  return out;
}

RaceOutcome run_race(const Optimization::Source& source, const OptimizationOptions& options) {
  if (!source.file.race) return {};
  return Race(source, options).run();
}

}  // namespace lilytank
