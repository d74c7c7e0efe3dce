#include "scores/score_plan.hpp"

#include <set>

#include "scores/bond_numbers.hpp"
#include "scores/nuisances.hpp"
#include "scores/residual_statistics.hpp"
#include "text/words.hpp"

namespace lilytank {

int identities_in(const std::vector<Recording>& recordings) {
  std::set<std::int64_t> ids;
  for (const Recording& one : recordings) {
    for (const Track& track : one.tracks) ids.insert(track.id);
  }
  return static_cast<int>(ids.size());
}

Eigen::MatrixXd ScorePlan::nuisances_known() const {
  return nuisances ? nuisances->known() : Eigen::MatrixXd();
}

std::vector<ScoreEntry> ScorePlan::entries() const {
  std::vector<ScoreEntry> out;
  for (const Effect& effect : effects) {
    for (std::size_t c = 0; effect.scored && c < effect.paths.size(); ++c) {
      std::string name = effect.name;
      for (const auto& [of, value] : effect.held) {
        name += " " + std::string(of->name) + " " + std::to_string(value);
      }
      if (effect.paths.size() > 1) name += " " + own_name(effect.paths[c]);
      out.push_back({"score", name});
    }
  }
  for (const auto& part : residual_statistics(*this)) {
    for (ScoreEntry& entry : part->entries()) out.push_back(std::move(entry));
  }
  if (latched()) {
    for (ScoreEntry& entry : bond_entries(*this)) out.push_back(std::move(entry));
  }
  for (const Shape& shape : shapes) {
    for (int k = 1; k <= kKnots; ++k) {
      out.push_back({"shape", shape.variable + " " + shape.direction + " " + std::to_string(k)});
    }
  }
  return out;
}

std::size_t ScorePlan::first_of_effect(std::size_t index) const {
  std::size_t first = 0;
  for (std::size_t e = 0; e < index; ++e) {
    first += effects[e].scored ? effects[e].paths.size() : 0;
  }
  return first;
}

std::size_t ScorePlan::first_of_shape(std::size_t index) const {
  return entries().size() - (shapes.size() - index) * kKnots;
}

}  // namespace lilytank
