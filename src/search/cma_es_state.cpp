// CMA-ES's options checked, and its state as text and back.
#include <cmath>
#include <limits>

#include "search/cma_es.hpp"
#include "search/records.hpp"
#include "search/space.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr int kMostPopulation = 100'000, kMostEvaluationsEach = 10'000;
constexpr std::int64_t kMostBudget = 1'000'000'000;
constexpr auto kMostWholeNumber = std::numeric_limits<std::int64_t>::max();
constexpr int kMostElites = 10;

void check_whole(const std::string& name, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value >= low && value <= high) return;
  throw InputError("the " + name + " of CMA-ES must be from " + std::to_string(low) + " to " +
                   std::to_string(high) + ", not " + std::to_string(value));
}

}  // namespace

void check_cma_es_options(const CmaEsOptions& o, const SearchSpace& space) {
  check_whole("budget", o.budget, 1, kMostBudget);
  if (o.population != 0) check_whole("population", o.population, 4, kMostPopulation);
  check_whole("evaluations", o.evaluations, 1, kMostEvaluationsEach);
  check_whole("most evaluations", o.most_evaluations, o.evaluations, kMostEvaluationsEach);
  if (o.final_evaluations != 0) {
    check_whole("final evaluations", o.final_evaluations, 4, o.budget);
  }
  if (!(o.sigma > 0 && o.sigma <= 1)) {
    throw InputError("the first sigma of CMA-ES must be above 0 and at most 1, not " +
                     shortest(o.sigma));
  }
  if (!o.start.empty()) check_point(space, o.start, "the start");
}

void save_cma_es_options(StateWriter& out, const CmaEsOptions& o) {
  out.whole("budget", o.budget);
  out.whole("population", o.population);
  out.number("first_sigma", o.sigma);
  out.numbers("start", o.start);
  out.whole("evaluations", o.evaluations);
  out.whole("uncertainty", o.handle_uncertainty ? 1 : 0);
  out.whole("most", o.most_evaluations);
  out.whole("final", o.final_evaluations);
  out.whole("common", o.common_random_numbers ? 1 : 0);
}

CmaEsOptions load_cma_es_options(StateReader& in, const SearchSpace& space) {
  CmaEsOptions o;
  o.budget = in.whole("budget", 1, kMostBudget);
  o.population = static_cast<int>(in.whole("population", 0, kMostPopulation));
  o.sigma = in.number("first_sigma");
  o.start = in.numbers("start");
  o.evaluations = static_cast<int>(in.whole("evaluations", 1, kMostEvaluationsEach));
  o.handle_uncertainty = in.whole("uncertainty", 0, 1) == 1;
  o.most_evaluations = static_cast<int>(in.whole("most", 1, kMostEvaluationsEach));
  o.final_evaluations = static_cast<int>(in.whole("final", 0, o.budget));
  o.common_random_numbers = in.whole("common", 0, 1) == 1;
  check_cma_es_options(o, space);
  return o;
}

std::string CmaEs::save() const {
  StateWriter out(kCmaEsKind);
  save_space(out, space_);
  save_cma_es_options(out, options_);
  out.whole("seed", static_cast<std::int64_t>(seed_));
  distribution_.save(out);
  out.whole("generation", generation_);
  out.number("each", each_);
  out.whole("told", told_);
  out.whole("asked", asked_ ? 1 : 0);
  out.numbers("lows", lows_);
  out.whole("elites", static_cast<std::int64_t>(elites_.size()));
  for (const Elite& elite : elites_) {
    out.numbers("elite", elite.point);
    save_tally(out, elite.tally);
  }
  selection_.save(out);
  save_history(out, history_);
  return out.finish();
}

CmaEs::CmaEs(StateReader& in)
    : space_(load_space(in)), options_(load_cma_es_options(in, space_)), seed_(0) {
  seed_ = static_cast<std::uint64_t>(in.whole("seed", -kMostWholeNumber - 1, kMostWholeNumber));
  distribution_ = CmaDistribution(in, static_cast<int>(space_.size()), kMostPopulation);
  generation_ = in.whole("generation", 0, kMostWholeNumber);
  each_ = in.number("each");
  if (!(each_ >= 1 && each_ <= kMostEvaluationsEach)) in.refuse("no number of evaluations");
  told_ = in.whole("told", 0, options_.budget);
  asked_ = in.whole("asked", 0, 1) == 1;
  lows_ = in.numbers("lows");
  elites_.resize(static_cast<std::size_t>(in.whole("elites", 0, kMostElites)));
  for (Elite& elite : elites_) {
    elite.point = in.numbers("elite", space_.size());
    elite.tally = load_tally(in);
  }
  selection_ = Selection(in, space_.size());
  history_ = load_history(in, space_.size());
  in.end();
}

}  // namespace lilytank
