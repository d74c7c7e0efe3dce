// FNV-1a, 64 bits: short names for long texts. Not meant against forgery.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace lilytank {

/// The hash of bytes, going on from that of bytes before them [Fowler, Noll and Vo].
inline std::uint64_t fnv_bytes(std::string_view bytes, std::uint64_t before = 0xcbf29ce484222325) {
  for (const char c : bytes) before = (before ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return before;
}

/// A running hash of texts and numbers.
class Fnv {
 public:
  /// Adds a text and its end, so that ("ab", "c") and ("a", "bc") differ.
  void add(std::string_view text) {
    for (const char c : text) byte(static_cast<unsigned char>(c));
    for (std::uint64_t n = text.size(); n != 0; n >>= 8) byte(static_cast<unsigned char>(n));
    byte(0);
  }
  /// Adds the bytes of numbers.
  void add(std::span<const double> numbers) {
    add(std::string_view(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()));
  }
  std::uint64_t value() const { return value_; }

 private:
  void byte(unsigned char b) { value_ = (value_ ^ b) * 0x100000001b3; }
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace lilytank
