#include "view/pack.hpp"

#include <zlib.h>

#include <bit>
#include <new>

#include "io/base64.hpp"

namespace lilytank {
namespace {

constexpr int kMostOrder = 2;

// Differences of neighbours within each series, modulo 2^32; the first number stays.
std::vector<std::uint32_t> differences(std::vector<std::uint32_t> values, std::size_t length) {
  for (std::size_t i = values.size(); i-- > 1;) {
    if (i % length != 0) values[i] -= values[i - 1];
  }
  return values;
}

// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...: small numbers of either sign have zeros in their high
// bytes.
std::vector<std::uint32_t> zigzag(std::vector<std::uint32_t> values) {
  for (std::uint32_t& v : values) v = v << 1 ^ (v >> 31 != 0 ? ~std::uint32_t{0} : 0);
  return values;
}

// Bits that the numbers need one by one: what deflate makes of them grows with it.
std::int64_t bits_of(const std::vector<std::uint32_t>& values) {
  std::int64_t bits = 0;
  for (const std::uint32_t v : values) bits += std::bit_width(v);
  return bits;
}

}  // namespace

Json ViewPack::add(std::span<const std::int32_t> values, std::size_t length) {
  std::vector<std::uint32_t> raw(values.begin(), values.end()), best = zigzag(raw);
  int order = 0;
  for (int k = 1; k <= kMostOrder; ++k) {
    raw = differences(std::move(raw), length);
    std::vector<std::uint32_t> coded = zigzag(raw);
    if (bits_of(coded) < bits_of(best)) best = std::move(coded), order = k;
  }
  std::uint32_t all = 0;
  for (const std::uint32_t v : best) all |= v;
  const int planes = (std::bit_width(all) + 7) / 8;
  const Json out{{"at", bytes_.size()},
                 {"count", best.size()},
                 {"length", length},
                 {"order", order},
                 {"planes", planes}};
  for (int p = 0; p < planes; ++p) {
    for (const std::uint32_t v : best) bytes_ += static_cast<char>(v >> 8 * p & 255);
  }
  return out;
}

std::string ViewPack::text() const {
  uLongf size = compressBound(bytes_.size());
  std::string out(size, '\0');
  const int failed = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes_.data()), bytes_.size(),
                               Z_DEFAULT_COMPRESSION);
  if (failed != Z_OK) throw std::bad_alloc();  // with room for the bound, only memory can run out
  out.resize(size);
  return base64(out);
}

}  // namespace lilytank
