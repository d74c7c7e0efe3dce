#include "search/swarm.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lilytank/random.hpp"
#include "search/candidates.hpp"
#include "search/records.hpp"
#include "search/space.hpp"
#include "search/swarm_options.hpp"

namespace lilytank {
namespace {

/// Uniform in (0, 1): draw `index` of a particle in an iteration.
double draw(std::uint64_t seed, int iteration, int particle, std::size_t index) {
  return uniform({seed, Stream::search, iteration, static_cast<std::uint32_t>(particle),
                  static_cast<std::uint32_t>(index)});
}

}  // namespace

Swarm::Swarm(SearchSpace space, SwarmOptions options, std::uint64_t seed)
    : space_(std::move(space)), options_(std::move(options)), seed_(seed) {
  check_space(space_);
  check_swarm_options(options_, space_);
  place();
}

/// Positions uniform in the box or as given, velocities uniform within their limit.
void Swarm::place() {
  const std::size_t n = space_.size();
  particles_.resize(static_cast<std::size_t>(options_.particles));
  const double limit = std::min(options_.velocity_limit, 1.0);
  for (int i = 0; i < options_.particles; ++i) {
    Particle& p = particles_[static_cast<std::size_t>(i)];
    p.x.resize(n), p.v.resize(n);
    for (std::size_t a = 0; a < n; ++a) {
      p.x[a] = draw(seed_, 0, i, 2 * a);
      p.v[a] = limit * (2 * draw(seed_, 0, i, 2 * a + 1) - 1);
    }
    if (static_cast<std::size_t>(i) < options_.starts.size()) {
      p.x = to_unit(space_, options_.starts[static_cast<std::size_t>(i)]);
    }
    p.best_x = p.x;
  }
}

std::int64_t Swarm::budget() const {
  return std::int64_t{options_.iterations} * iteration_budget() + options_.final_evaluations;
}

std::vector<Trial> Swarm::ask() {
  if (iteration_ == options_.iterations) {
    if (options_.final_evaluations > 0 && !selection_.begun()) begin_selection();
    return selection_.ask(space_, evaluations_, options_.common_random_numbers);
  }
  if (wanted_.empty()) plan();
  std::vector<Trial> trials;
  for (std::size_t s = 0; s < wanted_.size(); ++s) {
    const Particle& p = particles_[static_cast<std::size_t>(wanted_[s].particle)];
    trials.push_back({from_unit(space_, wanted_[s].of_best ? p.best_x : p.x), replicate_of(s)});
  }
  return trials;
}

/// Of the leading personal bests.
void Swarm::begin_selection() {
  std::vector<int> order(particles_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto best_of = [&](int i) -> const Particle& {
    return particles_[static_cast<std::size_t>(i)];
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return best_of(a).best.mean < best_of(b).best.mean; });
  std::vector<UnitPoint> points;
  int most = 0;
  for (const int i : order) {
    if (static_cast<int>(points.size()) == selection_size(options_.final_evaluations)) break;
    if (std::find(points.begin(), points.end(), best_of(i).best_x) != points.end()) continue;
    points.push_back(best_of(i).best_x);
    most = std::max(most, best_of(i).best.count);
  }
  selection_ = Selection(std::move(points), options_.final_evaluations, most);
}

std::int64_t Swarm::replicate_of(std::size_t slot) const {
  if (!options_.common_random_numbers) return evaluations_ + static_cast<std::int64_t>(slot);
  const Slot& wanted = wanted_[slot];
  const Particle& p = particles_[static_cast<std::size_t>(wanted.particle)];
  std::int64_t replicate = wanted.of_best ? p.best.count : p.now.count;
  for (std::size_t s = slot; s-- > 0;) {
    if (wanted_[s].particle != wanted.particle || wanted_[s].of_best != wanted.of_best) break;
    ++replicate;
  }
  return replicate;
}

void Swarm::plan() {
  if (options_.noise == NoiseRule::ocba) {
    plan_shared();
  } else {
    plan_fixed();
  }
}

/// All of an iteration at once. In the first one a position is its particle's best.
void Swarm::plan_fixed() {
  const bool again = options_.noise == NoiseRule::reevaluate && iteration_ > 0;
  const int old = again ? options_.evaluations / 2 : 0;
  for (int i = 0; i < options_.particles; ++i) {
    want(i, false, options_.evaluations - old);
    want(i, true, old);
  }
}

/// First each new position once, then what is left of the iteration's budget in equal stages.
void Swarm::plan_shared() {
  const int n = options_.particles;
  if (stage_ == 0) {
    for (int i = 0; i < n; ++i) want(i, false, 1);
    return;
  }
  const int left = iteration_budget() - spent_;
  const int stages = std::max(1, options_.ocba_stages - (stage_ - 1));
  std::vector<const Tally*> tallies;
  for (const Particle& p : particles_) tallies.push_back(&p.now);
  if (iteration_ > 0) {
    for (const Particle& p : particles_) tallies.push_back(&p.best);
  }
  const std::vector<int> shares = ocba_shares(candidates_of(tallies), (left + stages - 1) / stages);
  for (std::size_t c = 0; c < shares.size(); ++c) {
    const int i = static_cast<int>(c);
    want(i % n, i >= n, shares[c]);
  }
}

void Swarm::want(int particle, bool of_best, int times) {
  wanted_.insert(wanted_.end(), static_cast<std::size_t>(times), Slot{particle, of_best});
}

Tally& Swarm::tally_of(const Slot& slot) {
  Particle& p = particles_[static_cast<std::size_t>(slot.particle)];
  return slot.of_best ? p.best : p.now;
}

void Swarm::tell(std::span<const double> values) {
  check_count(values.size(), wanted_.size() + selection_.asked());
  if (selection_.begun()) {
    selection_.tell(values);
    evaluations_ += static_cast<std::int64_t>(values.size());
    if (selection_.over()) record(selection_.means());
    return;
  }
  for (std::size_t s = 0; s < values.size(); ++s) tally_of(wanted_[s]).add(values[s]);
  evaluations_ += static_cast<std::int64_t>(values.size());
  spent_ += static_cast<int>(values.size());
  ++stage_;
  wanted_.clear();
  if (spent_ >= iteration_budget()) finish_iteration();
}

void Swarm::finish_iteration() {
  for (Particle& p : particles_) {
    if (iteration_ > 0 && !(p.now.mean < p.best.mean)) continue;
    p.best_x = p.x, p.best = p.now;
  }
  ++iteration_;
  std::vector<double> means;
  for (const Particle& p : particles_) means.push_back(p.now.mean);
  record(std::move(means));
  if (iteration_ < options_.iterations) move();
  for (Particle& p : particles_) p.now = {};
  spent_ = 0, stage_ = 0;
}

void Swarm::record(std::vector<double> means) {
  history_.push_back(record_of(std::move(means), evaluations_, best(), spread()));
  history_.back().iteration = static_cast<int>(history_.size());
}

double Swarm::spread() const {
  const double n = static_cast<double>(particles_.size());
  double squares = 0;
  for (std::size_t a = 0; a < space_.size(); ++a) {
    double centre = 0;
    for (const Particle& p : particles_) centre += p.x[a] / n;
    for (const Particle& p : particles_) squares += (p.x[a] - centre) * (p.x[a] - centre) / n;
  }
  return std::sqrt(squares);
}

Incumbent Swarm::best() const {
  if (iteration_ == 0) return {};
  if (selection_.known()) {
    const int leader = selection_.leader();
    return incumbent_of(space_, selection_.point(leader), selection_.tally(leader));
  }
  const Particle& p = particles_[static_cast<std::size_t>(leader_of(-1))];
  return incumbent_of(space_, p.best_x, p.best);
}

/// Of particle i's neighbourhood, or of all with i = -1.
int Swarm::leader_of(int i) const {
  const auto whole = i < 0 ? Neighbourhood::global : options_.neighbourhood;
  return leader_among(neighbours_of(whole, options_.particles, std::max(i, 0)));
}

int Swarm::leader_among(const std::vector<int>& particles) const {
  int leader = particles.front();
  for (const int j : particles) {
    const Particle& p = particles_[static_cast<std::size_t>(j)];
    if (p.best.mean < particles_[static_cast<std::size_t>(leader)].best.mean) leader = j;
  }
  return leader;
}

void Swarm::move() {
  for (int i = 0; i < options_.particles; ++i) {
    Particle& p = particles_[static_cast<std::size_t>(i)];
    const Particle& leader = particles_[static_cast<std::size_t>(leader_of(i))];
    for (std::size_t a = 0; a < space_.size(); ++a) move_axis(p, i, leader, a);
  }
}

void Swarm::move_axis(Particle& p, int i, const Particle& leader, std::size_t a) const {
  const double r1 = draw(seed_, iteration_, i, 2 * a), r2 = draw(seed_, iteration_, i, 2 * a + 1);
  const double pull = options_.personal * r1 * (p.best_x[a] - p.x[a]) +
                      options_.neighbour * r2 * (leader.best_x[a] - p.x[a]);
  const double limit = options_.velocity_limit;
  p.v[a] = std::clamp(options_.inertia * p.v[a] + pull, -limit, limit);
  const double x = p.x[a] + p.v[a];
  p.x[a] = std::clamp(x, 0.0, 1.0);
  if (x == p.x[a] || options_.at_bound == AtBound::keep) return;
  if (options_.at_bound == AtBound::stop) {
    p.v[a] = 0;
  } else {
    p.v[a] = -p.v[a];
    p.x[a] = std::clamp(2 * p.x[a] - x, 0.0, 1.0);
  }
}

}  // namespace lilytank
