// Readers of a search: its state, and the log of its values.
#include <atomic>

#include "fuzz/readers.hpp"
#include "fuzz/repaired.hpp"
#include "lilytank/error.hpp"
#include "lilytank/search_run.hpp"

namespace lilytank::fuzz {
namespace {

bool read_search(std::string_view bytes) {
  std::string text(bytes);
  const auto read = [&] {
    return accepts("search.state", [&] {
      const auto search = restore_search(text, "search.state");
      const auto trials = search->ask();
      if (!trials.empty()) search->tell(std::vector<double>(trials.size(), 1.0));
      restore_search(search->save(), "search.state");
    });
  };
  if (read()) return true;
  const auto end = text.rfind("hash ");
  if (end == std::string::npos) return false;
  text.resize(end);
  std::string digits = hash_of(text);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  text += "hash " + digits + "\n";
  return read();
}

/// The log of a search of 6 trials; what it lacks is evaluated.
SearchRunOptions search_options() {
  SearchRunOptions options;
  options.dir = scratch() + "/search", options.identity = "fuzz", options.threads = 1;
  return options;
}
std::unique_ptr<Search> small_search() {
  SwarmOptions options;
  options.particles = 3, options.iterations = 1;
  return make_swarm({{"a", 0, 1}}, options, 5);
}
void search_small(const std::atomic<bool>* stop) {
  SearchRunOptions options = search_options();
  options.stop = stop;
  run_search(
      small_search(), [](const Trial& t) { return t.point[0]; }, options);
}
/// The checkpoint before the first evaluation: what follows comes from the log.
const std::string& first_state() {
  static const std::string state = [] {
    const std::atomic<bool> stop{true};
    try {
      search_small(&stop);
    } catch (const Stopped&) {
    }
    return stored("search/search.state");
  }();
  return state;
}
std::string search_log() {
  first_state();
  search_small(nullptr);
  return stored("search/evaluations.csv");
}
bool read_search_log(std::string_view bytes) {
  write_scratch("search/search.state", first_state());
  return with_repair(bytes, with_right_rows, [](std::string_view text) {
    write_scratch("search/evaluations.csv", text);
    return accepts(scratch(), [] { search_small(nullptr); });
  });
}

std::string search_state() {
  SwarmOptions options;
  options.particles = 3, options.iterations = 2;
  const auto swarm = make_swarm({{"a", 0, 1}, {"b", 1, 10, true}}, options, 5);
  swarm->tell(std::vector<double>(swarm->ask().size(), 2.0));
  return swarm->save();
}

}  // namespace

std::vector<Reader> search_readers() {
  return {{"search", read_search, search_state()}, {"search-log", read_search_log, search_log()}};
}

}  // namespace lilytank::fuzz
