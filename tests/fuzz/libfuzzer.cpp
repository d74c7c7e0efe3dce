// A libFuzzer target for one reader, for clang:
//   clang++ -std=c++20 -fsanitize=fuzzer,address,undefined -DREADER=1 tests/fuzz/libfuzzer.cpp ...
// READER counts the readers of readers.cpp from 0. Not built by CMake, which knows GCC only.
#include <cstddef>
#include <cstdint>

#include "fuzz/readers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lilytank::fuzz::readers()[READER].read({reinterpret_cast<const char*>(data), size});
  return 0;
}
