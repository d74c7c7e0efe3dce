// Reads damaged files with every reader: fuzz_readers [SECONDS [SEED [READER | FILE READER]]].
//
// Inputs are mutations of good files, and of some that could be read. READER restricts the test to
// one reader; with FILE that one file is read. A failure is a report of the sanitizers, an
// exception other than InputError, a read of more than 10 s or 2 GB, or a broken promise; the input
// is then in the file named on the first line. With clang the same readers are libFuzzer targets:
// libfuzzer.sh.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/readers.hpp"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

namespace {

/// The input at hand, for whoever has to write it down when all is lost.
std::string present, kept_in;

void keep_input() {
  if (std::FILE* file = std::fopen(kept_in.c_str(), "wb")) {
    std::fwrite(present.data(), 1, present.size(), file);
    std::fclose(file);
  }
}

constexpr unsigned kLongest = 10;  // s of one read

using lilytank::fuzz::Reader;

/// A sequence of numbers from a seed (SplitMix64).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t bound) {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return bound == 0 ? 0 : static_cast<std::size_t>((z ^ (z >> 31)) % bound);
  }

 private:
  std::uint64_t state_;
};

/// Cells that have broken readers of tables before.
const std::vector<std::string> kCells{"",
                                      "nan",
                                      "inf",
                                      "-inf",
                                      "1e308",
                                      "-1e308",
                                      "1e-320",
                                      "9223372036854775807",
                                      "-1",
                                      "0",
                                      "1e12",
                                      "0x10",
                                      "1.5",
                                      "\"",
                                      "\"\"",
                                      "a",
                                      "-9223372036854775808",
                                      "1000000",
                                      "1e11",
                                      "3.0",
                                      "-0",
                                      "NA",
                                      "+1",
                                      "--1",
                                      "1e",
                                      "2009-11-01T12:00:00",
                                      "\xff",
                                      "1,5",
                                      "99999",
                                      "2147483648"};

/// Values of TOML that have broken readers of scenarios and studies, or might.
const std::vector<std::string> kValues{"true",
                                       "\"\"",
                                       "\"5 cm\"",
                                       "\"5 kg\"",
                                       "\"nan\"",
                                       "nan",
                                       "-inf",
                                       "[]",
                                       "[[1], 2]",
                                       "{}",
                                       "{a = {b = 1}}",
                                       "1979-05-27",
                                       "1e9",
                                       "-1",
                                       "0",
                                       "9223372036854775807",
                                       "[1, \"a\", nan]",
                                       "\"\\u001b[2J\\n\"",
                                       "\".\"",
                                       "[0, 0, 0]",
                                       "\"*\""};

std::size_t line_start(const std::string& text, std::size_t at) {
  const auto before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

void mutate(std::string& text, const std::string& other, Dice& dice) {
  const std::size_t at = dice.below(text.size() + 1);
  const std::size_t length = dice.below(std::min<std::size_t>(40, text.size() - at + 1));
  // Mostly what leaves a table a table.
  constexpr std::size_t kKinds[] = {7, 7, 7, 7, 7, 4, 4, 4, 5, 5, 5, 0, 1, 2, 3, 6, 8, 9, 10, 10};
  switch (kKinds[dice.below(std::size(kKinds))]) {
    case 0:  // another byte
      if (at < text.size()) text[at] = static_cast<char>(dice.below(256));
      break;
    case 1:
      text.insert(at, 1, static_cast<char>(dice.below(256)));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(dice.below(text.size() + 1), length));
      break;
    case 4: {  // another cell
      const auto begin = text.find_last_of(",;\t\n", at == 0 ? 0 : at - 1);
      const auto from = begin == std::string::npos ? 0 : begin + 1;
      const auto to = std::min(text.find_first_of(",;\t\n", from), text.size());
      text.replace(from, to - from, kCells[dice.below(kCells.size())]);
      break;
    }
    case 5: {  // a line twice, or at another place
      const auto from = line_start(text, at);
      const auto to = std::min(text.find('\n', from), text.size());
      const std::string line = text.substr(from, to - from) + "\n";
      if (dice.below(2) == 0 && to < text.size()) text.erase(from, line.size());
      text.insert(line_start(text, dice.below(text.size() + 1)), line);
      break;
    }
    case 6:
      text.resize(at);
      break;
    case 7: {  // a digit
      const auto digit = text.find_first_of("0123456789", at);
      if (digit != std::string::npos) text[digit] = static_cast<char>('0' + dice.below(10));
      break;
    }
    case 10: {  // another value of a key
      const auto equals = text.find('=', at);
      if (equals == std::string::npos) break;
      const auto to = std::min(text.find('\n', equals), text.size());
      text.replace(equals + 1, to - equals - 1, " " + kValues[dice.below(kValues.size())]);
      break;
    }
    case 8:
      text.insert(at, other.substr(0, dice.below(other.size() + 1)));
      break;
    default: {  // columns exchanged
      const auto comma = text.find_first_of(",;\t", at);
      if (comma != std::string::npos) text[comma] = ",;\t \n"[dice.below(5)];
      break;
    }
  }
  if (text.size() > 20000) text.resize(20000);
}

/// The inputs of one reader: its seed, and damaged files that could be read.
struct Target {
  const Reader* reader;
  std::vector<std::string> pool;
  std::uint64_t count = 0, taken = 0;
  double seconds = 0;
};

double now() {
  const auto time = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(time).count();
}

void read_one(Target& target, Dice& dice) {
  const auto all = lilytank::fuzz::readers();
  std::vector<std::string>& pool = target.pool;
  present = pool[dice.below(pool.size())];
  const std::string& other = all[dice.below(all.size())].seed;
  for (std::size_t n = 1 + dice.below(5); n > 0; --n) mutate(present, other, dice);
  const double begin = now();
  ::alarm(kLongest);
  const bool read = target.reader->read(present);
  ::alarm(0);
  target.seconds += now() - begin;
  ++target.count;
  target.taken += read ? 1 : 0;
  if (!read || dice.below(20) != 0) return;
  if (pool.size() < 200) {
    pool.push_back(present);
  } else {
    pool[1 + dice.below(pool.size() - 1)] = present;
  }
}

void watch_failures() {
  const char* folder = std::getenv("TMPDIR");
  kept_in = std::string(folder == nullptr ? "/tmp" : folder) + "/lilytank-fuzz-input-" +
            std::to_string(::getpid());
  std::signal(SIGABRT, [](int) { keep_input(); });
  std::signal(SIGALRM, [](int) {
    static const char text[] = "the read takes too long\n";
    if (::write(STDERR_FILENO, text, sizeof text - 1) > 0) std::abort();
    std::abort();
  });
#ifdef __SANITIZE_ADDRESS__
  __sanitizer_set_death_callback(keep_input);
#endif
}

/// Targets by name, or all. Every seed must be read, or the test would test nothing.
std::vector<Target> targets_named(const char* name) {
  std::vector<Target> out;
  for (const Reader& reader : lilytank::fuzz::readers()) {
    if (name != nullptr && std::strcmp(name, reader.name) != 0) continue;
    present = reader.seed;
    const bool read = reader.read(present);
    lilytank::fuzz::demand(read, std::string("the seed of ") + reader.name +
                                     " can be read: " + lilytank::fuzz::last_refusal());
    out.push_back({&reader, {reader.seed}});
  }
  lilytank::fuzz::demand(!out.empty(), "there is a reader of that name");
  return out;
}

}  // namespace

#ifdef __SANITIZE_ADDRESS__
extern "C" const char* __asan_default_options() {
  return "hard_rss_limit_mb=2000:max_allocation_size_mb=1500:detect_leaks=0";
}
#endif

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  watch_failures();
  std::vector<Target> targets = targets_named(argc > 3 ? argv[argc - 1] : nullptr);
  if (argc > 4) {
    std::ifstream in(argv[3], std::ios::binary);
    present.assign(std::istreambuf_iterator<char>(in), {});
    const bool read = targets[0].reader->read(present);
    std::puts(read ? "read" : lilytank::fuzz::last_refusal().c_str());
    return 0;
  }
  std::printf("seed %llu; a failing input will be in %s\n", static_cast<unsigned long long>(seed),
              kept_in.c_str());
  std::fflush(stdout);
  Dice dice(seed);
  const double begin = now();
  // Equal times for all targets, whatever a read takes.
  while (now() - begin < seconds) {
    Target& target =
        *std::min_element(targets.begin(), targets.end(),
                          [](const Target& a, const Target& b) { return a.seconds < b.seconds; });
    read_one(target, dice);
  }
  std::printf("%-20s %10s %8s\n", "reader", "files", "read");
  for (const Target& t : targets) {
    std::printf("%-20s %10llu %6.0f %%\n", t.reader->name, static_cast<unsigned long long>(t.count),
                100.0 * static_cast<double>(t.taken) /
                    static_cast<double>(std::max<std::uint64_t>(t.count, 1)));
  }
  return 0;
}
