// Throws damaged files at every reader: fuzz_readers [SECONDS [SEED]].
//
// Inputs are mutations of good files, and of some that could be read. A failure is a report of
// the sanitizers, an exception other than InputError, or a broken promise; the input is then in the
// file named on the first line. With clang the same readers are libFuzzer targets: libfuzzer.cpp.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
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

std::size_t line_start(const std::string& text, std::size_t at) {
  const auto before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

void mutate(std::string& text, const std::string& other, Dice& dice) {
  const std::size_t at = dice.below(text.size() + 1);
  const std::size_t length = dice.below(std::min<std::size_t>(40, text.size() - at + 1));
  // Mostly what leaves a table a table.
  constexpr std::size_t kKinds[] = {7, 7, 7, 7, 7, 4, 4, 4, 5, 5, 5, 0, 1, 2, 3, 6, 8, 9};
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

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const auto readers = lilytank::fuzz::readers();
  const char* folder = std::getenv("TMPDIR");
  kept_in = std::string(folder == nullptr ? "/tmp" : folder) + "/lilytank-fuzz-input";
  std::signal(SIGABRT, [](int) { keep_input(); });
#ifdef __SANITIZE_ADDRESS__
  __sanitizer_set_death_callback(keep_input);
#endif
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::printf("seed %llu; a failing input will be in %s\n", static_cast<unsigned long long>(seed),
              kept_in.c_str());
  std::fflush(stdout);
  std::vector<std::vector<std::string>> pools;
  for (const Reader& reader : readers) pools.push_back({reader.seed});
  std::uint64_t count = 0, taken = 0;
  Dice dice(seed);
  for (; elapsed() < seconds; ++count) {
    const std::size_t r = count % readers.size();
    std::vector<std::string>& pool = pools[r];
    present = pool[dice.below(pool.size())];
    const std::string& other = readers[dice.below(readers.size())].seed;
    for (std::size_t n = 1 + dice.below(5); n > 0; --n) mutate(present, other, dice);
    const bool read = readers[r].read(present);
    taken += read ? 1 : 0;
    if (!read || dice.below(20) != 0) continue;
    if (pool.size() < 200) {
      pool.push_back(present);
    } else {
      pool[1 + dice.below(pool.size() - 1)] = present;
    }
  }
  std::printf(
      "%llu damaged files in %.0f s for %zu readers: %.0f %% were read, the others refused\n",
      static_cast<unsigned long long>(count), elapsed(), readers.size(),
      100.0 * static_cast<double>(taken) / static_cast<double>(std::max<std::uint64_t>(count, 1)));
  return 0;
}
