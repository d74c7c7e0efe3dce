#include "lilytank/recording_io.hpp"

namespace lilytank {

CheckRules::CheckRules() {
  using enum Treatment;
  treatments.fill(split);
  (*this)[Check::gap] = mark;
  (*this)[Check::spike] = mark;
  (*this)[Check::outside] = mark;
  (*this)[Check::duplicate] = refuse;
  (*this)[Check::clock] = refuse;
  (*this)[Check::units] = refuse;
}

std::string Finding::text() const {
  std::string out = place.text() + ": ";
  if (frame >= 0) out += "frame " + std::to_string(frame) + ", ";
  if (id >= 0) out += "id " + std::to_string(id) + ", ";
  return out + check_word(check) + ": " + what;
}

}  // namespace lilytank
