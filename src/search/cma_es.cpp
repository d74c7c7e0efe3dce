#include "search/cma_es.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "search/rank_change.hpp"
#include "search/records.hpp"
#include "search/space.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kElites = 10;
constexpr double kMoreEvaluations = 1.5;           // alpha_t of the uncertainty handling
constexpr double kLeastChange = 1e-12;             // of the lowest means, as a share of them
constexpr std::uint32_t kStartDraws = 0xffffffff;  // no sample has this number

/// The nearest point of the unit box.
UnitPoint boxed(UnitPoint point) {
  for (double& x : point) x = std::clamp(x, 0.0, 1.0);
  return point;
}

}  // namespace

CmaEs::CmaEs(SearchSpace space, CmaEsOptions options, std::uint64_t seed)
    : space_(std::move(space)), options_(std::move(options)), seed_(seed) {
  check_space(space_);
  check_cma_es_options(options_, space_);
  UnitPoint mean(space_.size(), 0.5);
  if (!options_.start.empty()) mean = to_unit(space_, options_.start);
  distribution_ = CmaDistribution(std::move(mean), options_.sigma, first_population());
  each_ = options_.evaluations;
  if (generation_cost() + options_.final_evaluations > options_.budget) {
    throw InputError("a budget of " + std::to_string(options_.budget) +
                     " evaluations does not hold one generation of CMA-ES (" +
                     std::to_string(generation_cost()) + ") and the final selection (" +
                     std::to_string(options_.final_evaluations) + ")");
  }
}

int CmaEs::first_population() const {
  if (options_.population > 0) return options_.population;
  return 4 + static_cast<int>(3 * log_portable(static_cast<double>(space_.size())));
}

std::vector<double> CmaEs::normals(int sample) const {
  std::vector<double> z(space_.size());
  for (std::size_t a = 0; a < z.size(); ++a) {
    const auto pair =
        normal_pair({seed_, Stream::search, generation_, static_cast<std::uint32_t>(sample),
                     static_cast<std::uint32_t>(a / 2)});
    z[a] = pair[a % 2];
  }
  return z;
}

UnitPoint CmaEs::point_of(int sample) const {
  return boxed(distribution_.sample(normals(sample)));
}

int CmaEs::evaluations_each() const {
  return static_cast<int>(each_);
}

/// lambda_reev: a tenth of the samples, at least two.
int CmaEs::looked_at_twice() const {
  if (!options_.handle_uncertainty) return 0;
  return std::max(2, (distribution_.constants().lambda + 5) / 10);
}

std::int64_t CmaEs::generation_cost() const {
  return std::int64_t{distribution_.constants().lambda + looked_at_twice()} * evaluations_each();
}

std::vector<Trial> CmaEs::ask() {
  if (!selection_.begun() && !asked_) {
    asked_ = told_ + generation_cost() + options_.final_evaluations <= options_.budget;
    if (!asked_ && options_.final_evaluations > 0) begin_selection();
  }
  return asked_ ? ask_generation() : selection_.ask(space_, told_, options_.common_random_numbers);
}

/// Sample by sample; those that are looked at twice have their further evaluations at once.
std::vector<Trial> CmaEs::ask_generation() const {
  std::vector<Trial> trials;
  for (int k = 0; k < distribution_.constants().lambda; ++k) {
    const std::vector<double> point = from_unit(space_, point_of(k));
    const int times = evaluations_each() * (k < looked_at_twice() ? 2 : 1);
    for (int t = 0; t < times; ++t) {
      const std::int64_t own = told_ + static_cast<std::int64_t>(trials.size());
      trials.push_back({point, options_.common_random_numbers ? t : own});
    }
  }
  return trials;
}

/// The final mean, which lies in the box, a start that somebody gave, and the best samples share
/// what is left of the budget.
void CmaEs::begin_selection() {
  const int left = static_cast<int>(options_.budget - told_);
  std::vector<UnitPoint> points{distribution_.mean()};
  if (!options_.start.empty() && selection_size(left) > 1) {
    points.push_back(to_unit(space_, options_.start));
  }
  int most = 0;
  for (const Elite& elite : elites_) {
    if (static_cast<int>(points.size()) == selection_size(left)) break;
    points.push_back(elite.point);
    most = std::max(most, elite.tally.count);
  }
  selection_ = Selection(std::move(points), left, most);
}

void CmaEs::tell(std::span<const double> values) {
  const auto generation = static_cast<std::size_t>(asked_ ? generation_cost() : 0);
  check_count(values.size(), generation + selection_.asked());
  if (asked_) {
    tell_generation(values);
    return;
  }
  selection_.tell(values);
  told_ += static_cast<std::int64_t>(values.size());
  if (selection_.over()) record(selection_.means());
}

void CmaEs::tell_generation(std::span<const double> values) {
  const auto lambda = static_cast<std::size_t>(distribution_.constants().lambda);
  const auto each = static_cast<std::size_t>(evaluations_each());
  const auto twice = static_cast<std::size_t>(looked_at_twice());
  std::vector<Tally> tallies(lambda), again(twice);
  std::size_t at = 0;
  for (std::size_t k = 0; k < lambda; ++k) {
    for (std::size_t t = 0; t < each; ++t) tallies[k].add(values[at++]);
    if (k >= twice) continue;
    for (std::size_t t = 0; t < each; ++t) again[k].add(values[at++]);
  }
  std::vector<double> first, second;
  for (const Tally& tally : tallies) first.push_back(tally.mean);
  for (const Tally& tally : again) second.push_back(tally.mean);
  // Every value counts in the ranking.
  at = 0;
  for (std::size_t k = 0; k < twice; ++k, at += each) {
    at += each;
    for (std::size_t t = 0; t < each; ++t) tallies[k].add(values[at + t]);
  }
  told_ += static_cast<std::int64_t>(values.size());
  asked_ = false;
  learn(tallies);
  if (twice > 0) handle_uncertainty(rank_change(first, second));
  if (distribution_.worn_out() || stagnant()) renew();
}

void CmaEs::learn(const std::vector<Tally>& tallies) {
  std::vector<int> order(tallies.size());
  std::iota(order.begin(), order.end(), 0);
  const auto mean_of = [&](int k) { return tallies[static_cast<std::size_t>(k)].mean; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return mean_of(a) < mean_of(b); });
  std::vector<std::vector<double>> ranked;
  std::vector<double> means;
  for (const int k : order) {
    ranked.push_back(normals(k));
    means.push_back(mean_of(k));
  }
  for (std::size_t k = 0; k < order.size() && k < kElites; ++k) {
    keep_elite(point_of(order[k]), tallies[static_cast<std::size_t>(order[k])]);
  }
  lows_.push_back(means.front());
  // Where nothing could be evaluated there is nothing to learn.
  if (std::isfinite(means.front())) distribution_.update(ranked);
  ++generation_;
  record(std::move(means));
}

void CmaEs::handle_uncertainty(double change) {
  if (change > 0) {
    if (each_ < options_.most_evaluations) {
      each_ = std::min(each_ * kMoreEvaluations, double(options_.most_evaluations));
    } else {
      distribution_.widen(1 + 2 / (static_cast<double>(space_.size()) + 10));
    }
  } else if (change < 0) {
    each_ = std::max(each_ / kMoreEvaluations, double(options_.evaluations));
  }
}

void CmaEs::keep_elite(const UnitPoint& point, const Tally& tally) {
  if (!tally.usable()) return;
  const auto place = std::find_if(elites_.begin(), elites_.end(), [&](const Elite& elite) {
    return tally.mean < elite.tally.mean;
  });
  elites_.insert(place, {point, tally});
  if (elites_.size() > kElites) elites_.pop_back();
}

/// Whether the last 10 + 30 n / lambda generations' lowest means are all the same.
bool CmaEs::stagnant() const {
  const int lambda = distribution_.constants().lambda;
  const auto last = static_cast<std::size_t>(10 + 30 * static_cast<int>(space_.size()) / lambda);
  if (lows_.size() < last) return false;
  const auto [least, most] =
      std::minmax_element(lows_.end() - static_cast<std::ptrdiff_t>(last), lows_.end());
  return !(*most - *least > kLeastChange * std::fabs(*least));
}

/// A new start at a random place with twice the samples, as far as the budget can bear that.
void CmaEs::renew() {
  const std::int64_t left = options_.budget - told_ - options_.final_evaluations;
  int lambda = 2 * distribution_.constants().lambda;
  if (lambda > left / 10) lambda = first_population();
  UnitPoint mean(space_.size());
  for (std::size_t a = 0; a < mean.size(); ++a) {
    mean[a] =
        uniform({seed_, Stream::search, generation_, kStartDraws, static_cast<std::uint32_t>(a)});
  }
  distribution_ = CmaDistribution(std::move(mean), options_.sigma, lambda);
  each_ = options_.evaluations;
  lows_.clear();
}

void CmaEs::record(std::vector<double> means) {
  history_.push_back(record_of(std::move(means), told_, best(), distribution_.spread()));
  history_.back().iteration = static_cast<int>(history_.size());
}

Incumbent CmaEs::best() const {
  if (selection_.known()) {
    const int leader = selection_.leader();
    return incumbent_of(space_, selection_.point(leader), selection_.tally(leader));
  }
  if (!elites_.empty()) return incumbent_of(space_, elites_[0].point, elites_[0].tally);
  if (generation_ == 0) return {};
  Tally none;  // nothing could be evaluated so far
  none.add(std::numeric_limits<double>::infinity());
  return incumbent_of(space_, UnitPoint(space_.size(), 0.5), none);
}

}  // namespace lilytank
