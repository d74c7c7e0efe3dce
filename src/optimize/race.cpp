#include "optimize/race.hpp"

namespace lilytank {

RaceOutcome run_race(const Optimization::Source& source, const OptimizationOptions&) {
  if (!source.file.race) return {};
  throw InputError(source.file.race->place, "races are not available");
}

}  // namespace lilytank
