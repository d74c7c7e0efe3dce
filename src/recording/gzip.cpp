#include "recording/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

namespace lilytank {

std::string gzipped(std::string_view text) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16, kMemory = 8;
  if (::deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::string out;
  char buffer[1 << 16];
  int state = Z_OK;
  do {
    constexpr std::size_t kPiece = std::numeric_limits<uInt>::max() / 2;
    const std::size_t piece = std::min(text.size(), kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(piece);
    text.remove_prefix(piece);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(buffer), stream.avail_out = sizeof buffer;
      state = ::deflate(&stream, text.empty() ? Z_FINISH : Z_NO_FLUSH);
      out.append(buffer, sizeof buffer - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (state != Z_STREAM_END);
  ::deflateEnd(&stream);
  return out;
}

}  // namespace lilytank
