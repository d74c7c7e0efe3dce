#include "search/tally.hpp"

namespace lilytank {

void save_tally(StateWriter& out, const Tally& tally) {
  out.whole("count", tally.count);
  const double values[] = {tally.mean, tally.squares};
  out.numbers("tally", values);
}

Tally load_tally(StateReader& in) {
  Tally tally;
  tally.count = static_cast<int>(in.whole("count", 0, std::numeric_limits<int>::max()));
  const auto values = in.numbers("tally", 2);
  tally.mean = values[0], tally.squares = values[1];
  return tally;
}

}  // namespace lilytank
