#include <algorithm>

#include "lilytank/random.hpp"
#include "lilytank/study.hpp"
#include "text/fnv.hpp"

namespace lilytank {

double StudyPlan::horizon() const {
  double longest = 0;
  for (const Setting& setting : settings) longest = std::max(longest, setting.duration);
  return longest;
}

std::uint64_t StudyPlan::identity() const {
  Fnv hash;
  hash.add("lilytank study 1");
  hash.add(std::to_string(seed));
  for (const std::string& axis : axes) hash.add(axis);
  for (const Setting& setting : settings) {
    for (const std::string& text : setting.texts) hash.add(text);
    hash.add(hex(setting.identity));
  }
  return hash.value();
}

std::uint64_t StudyPlan::seed_of(int replicate) const {
  return derived_seed(seed, static_cast<std::uint64_t>(replicate)) >> 5;
}

std::string StudyPlan::id_of(int setting, int replicate) const {
  // Philox as a hash: ids spread evenly over any number of shards.
  const std::uint64_t scenario = settings[static_cast<std::size_t>(setting)].identity;
  return hex(derived_seed(scenario, seed_of(replicate)));
}

}  // namespace lilytank
