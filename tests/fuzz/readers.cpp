#include "fuzz/readers.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "lilytank/error.hpp"

namespace lilytank::fuzz {
namespace {

/// In memory where there is such a place: most of the time would go to the disk.
std::filesystem::path place_of_scratch() {
  constexpr const char* kMemory = "/dev/shm";
  return ::access(kMemory, W_OK) == 0 ? kMemory : std::filesystem::temp_directory_path();
}

struct Scratch {
  std::string path =
      (place_of_scratch() / ("lilytank-fuzz-" + std::to_string(::getpid()))).string();
  Scratch() { std::filesystem::create_directories(path); }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

void demand(bool right, const std::string& promise) {
  if (right) return;
  std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
  std::abort();
}

const std::string& scratch() {
  static const Scratch directory;
  return directory.path;
}

std::string write_scratch(const std::string& name, std::string_view bytes) {
  const std::string file = scratch() + "/" + name;
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::string stored(const std::string& name) {
  std::string out;
  std::FILE* file = std::fopen((scratch() + "/" + name).c_str(), "rb");
  demand(file != nullptr, "the run left " + name);
  for (int c; (c = std::fgetc(file)) != EOF;) out += static_cast<char>(c);
  std::fclose(file);
  return out;
}

std::string& last_refusal() {
  static std::string message;
  return message;
}

bool accepts(const std::string& named, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const InputError& e) {
    const std::string what = last_refusal() = e.what();
    demand(what.find(named) != std::string::npos, "a refusal names '" + named + "': " + what);
    return false;
  }
}

std::span<const Reader> readers() {
  static const std::vector<Reader> all = [] {
    std::vector<Reader> out = recording_readers();
    for (Reader& reader : file_readers()) out.push_back(std::move(reader));
    for (Reader& reader : search_readers()) out.push_back(std::move(reader));
    return out;
  }();
  return all;
}

}  // namespace lilytank::fuzz
