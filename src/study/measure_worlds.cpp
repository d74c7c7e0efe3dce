#include <filesystem>
#include <mutex>

#include "io/atomic_file.hpp"
#include "lilytank/measure.hpp"
#include "lilytank/random.hpp"
#include "lilytank/study.hpp"

namespace lilytank {

std::vector<MeasuredWorld> measure_worlds(const Model& model, const MeasureOptions& options) {
  namespace fs = std::filesystem;
  if (!options.out.empty()) {
    std::error_code error;
    fs::create_directories(options.out, error);
    if (error) throw InputError("cannot make " + options.out + ": " + error.message());
  }
  std::vector<MeasuredWorld> worlds(static_cast<std::size_t>(options.worlds));
  std::mutex talk;
  int done = 0;
  const auto one = [&](int k) {
    MeasuredWorld& world = worlds[static_cast<std::size_t>(k)];
    const std::string name =
        "world-" + std::to_string(options.seed) + "-" + std::to_string(k + 1) + ".csv";
    const std::string file = options.out.empty() ? "" : (fs::path(options.out) / name).string();
    if (!file.empty() && fs::exists(file)) {
      world = measured_world_from(read_whole(file), file, options.identity);
    } else {
      const std::uint64_t seed = derived_seed(options.seed, static_cast<std::uint64_t>(k));
      world = measure_world(model, seed, options.duration, options);
      if (!file.empty()) write_atomically(file, to_csv(world, options.identity));
    }
    const std::lock_guard lock(talk);
    ++done;
    options.report(static_cast<double>(done) / options.worlds, "of the simulations");
  };
  for_each_world(options.worlds, options.threads, one, options);
  return worlds;
}

}  // namespace lilytank
