#include "cli/printable_stream.hpp"

#include <algorithm>

#include "text/printable.hpp"

namespace lilytank::cli {

bool PrintableStream::passes(char c) const {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= 0x20 && byte != 0x7f) || c == '\n' || c == '\t' ||
         (c == '\r' && carriage_return_);
}

PrintableStream::int_type PrintableStream::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize PrintableStream::xsputn(const char* text, std::streamsize size) {
  const char* const end = text + size;
  for (const char* at = text; at != end;) {
    const char* const stop = std::find_if(at, end, [&](char c) { return !passes(c); });
    if (next_->sputn(at, stop - at) != stop - at) return at - text;
    at = stop;
    if (at == end) break;
    const std::string escaped = printable({at, 1});
    const auto length = static_cast<std::streamsize>(escaped.size());
    if (next_->sputn(escaped.data(), length) != length) return at - text;
    ++at;
  }
  return size;
}

}  // namespace lilytank::cli
