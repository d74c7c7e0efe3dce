// Prints the effects that a diagnosis searches for, each with the bounds within which its
// amplitudes can be calibrated.
#include <cstdio>

#include "effects/effects.hpp"
#include "lilytank/model_parameter.hpp"

int main() {
  for (const lilytank::Effect& e : lilytank::effect_catalogue(lilytank::standard_model())) {
    std::printf("%s", e.name.c_str());
    for (const std::string& path : e.paths) {
      if (e.camera()) continue;
      const lilytank::ModelParameter of = lilytank::model_parameter(path);
      std::printf(" %s %g %g", path.c_str(), of.low, of.high);
    }
    std::puts("");
  }
}
