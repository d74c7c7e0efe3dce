// The readers as a libFuzzer target, for clang: see libfuzzer.sh. LILYTANK_READER names one of
// them, whose seed goes into the directory LILYTANK_CORPUS. Not built by CMake, which knows GCC
// only.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "fuzz/readers.hpp"

namespace {

const lilytank::fuzz::Reader* reader = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("LILYTANK_READER");
  for (const auto& one : lilytank::fuzz::readers()) {
    if (name != nullptr && std::string_view(one.name) == name) reader = &one;
  }
  lilytank::fuzz::demand(reader != nullptr, "LILYTANK_READER names a reader");
  if (const char* corpus = std::getenv("LILYTANK_CORPUS")) {
    std::ofstream(std::string(corpus) + "/seed", std::ios::binary) << reader->seed;
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  reader->read({reinterpret_cast<const char*>(data), size});
  return 0;
}
