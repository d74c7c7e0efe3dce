// A swarm as text and back.
#include <limits>

#include "search/records.hpp"
#include "search/space.hpp"
#include "search/swarm.hpp"
#include "search/swarm_options.hpp"

namespace lilytank {
namespace {

constexpr auto kMostWhole = std::numeric_limits<std::int64_t>::max();

}  // namespace

std::string Swarm::save() const {
  StateWriter out(kSwarmKind);
  save_space(out, space_);
  save_swarm_options(out, options_);
  out.whole("seed", static_cast<std::int64_t>(seed_));
  out.whole("iteration", iteration_);
  out.whole("spent", spent_);
  out.whole("stage", stage_);
  out.whole("told", evaluations_);
  for (const Particle& p : particles_) {
    out.numbers("x", p.x);
    out.numbers("v", p.v);
    out.numbers("best", p.best_x);
    save_tally(out, p.now);
    save_tally(out, p.best);
  }
  std::vector<std::int64_t> wanted;
  for (const Slot& slot : wanted_) wanted.push_back(2 * slot.particle + (slot.of_best ? 1 : 0));
  out.wholes("wanted", wanted);
  selection_.save(out);
  save_history(out, history_);
  return out.finish();
}

Swarm::Swarm(StateReader& in)
    : space_(load_space(in)), options_(load_swarm_options(in, space_)), seed_(0) {
  seed_ = static_cast<std::uint64_t>(in.whole("seed", -kMostWhole - 1, kMostWhole));
  iteration_ = static_cast<int>(in.whole("iteration", 0, options_.iterations));
  spent_ = static_cast<int>(in.whole("spent", 0, iteration_budget()));
  stage_ = static_cast<int>(in.whole("stage", 0, kMostWhole >> 32));
  evaluations_ = in.whole("told", 0, budget());
  particles_.resize(static_cast<std::size_t>(options_.particles));
  for (Particle& p : particles_) {
    p.x = in.numbers("x", space_.size());
    p.v = in.numbers("v", space_.size());
    p.best_x = in.numbers("best", space_.size());
    p.now = load_tally(in), p.best = load_tally(in);
  }
  for (const std::int64_t slot : in.wholes("wanted")) {
    if (slot < 0 || slot / 2 >= options_.particles) in.refuse("there is no such particle");
    wanted_.push_back({static_cast<int>(slot / 2), slot % 2 == 1});
  }
  selection_ = Selection(in, space_.size());
  history_ = load_history(in, space_.size());
  in.end();
}

}  // namespace lilytank
