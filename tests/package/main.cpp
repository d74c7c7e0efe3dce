// The smallest program that uses the library: a hundred steps of the paper's tank.
#include <iostream>
#include <lilytank/scenario.hpp>
#include <lilytank/study.hpp>
#include <lilytank/world.hpp>

int main() {
  const lilytank::Model model = lilytank::standard_model();
  lilytank::for_each_world(1, 1, [&](int) {
    lilytank::World world(model, 1);
    for (int step = 0; step < 100; ++step) world.step();
    std::cout << lilytank::hex(lilytank::fingerprint(world.state())) << '\n';
  });
  // The TOML reader must link, too: a nonsense key is refused.
  try {
    lilytank::load_scenario({}, {"no.such.key=1"});
    return 1;
  } catch (const lilytank::InputError&) {
    return 0;
  }
}
