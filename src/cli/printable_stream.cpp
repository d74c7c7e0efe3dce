#include "cli/printable_stream.hpp"

#include <algorithm>
#include <cstdlib>

#include "text/printable.hpp"

namespace lilytank::cli {

namespace {

constexpr std::string_view kRed = "\033[31m", kYellow = "\033[33m", kPlain = "\033[0m";
constexpr std::string_view kWarning = "warning:";

bool wants_colours() {
  const char* none = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (none == nullptr || *none == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

}  // namespace

PrintableStream::PrintableStream(std::ostream& stream, bool terminal)
    : stream_(&stream),
      next_(stream.rdbuf(this)),
      terminal_(terminal),
      colours_(terminal && wants_colours()) {}

void PrintableStream::print_refusal(const std::string& line) {
  if (colours_) put(kRed);
  xsputn(line.data(), static_cast<std::streamsize>(line.size()));
  if (colours_) put(kPlain);
  put("\n");
  next_->pubsync();
}

bool PrintableStream::put(std::string_view text) {
  const auto size = static_cast<std::streamsize>(text.size());
  return next_->sputn(text.data(), size) == size;
}

bool PrintableStream::passes(char c) const {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= 0x20 && byte != 0x7f) || c == '\n' || c == '\t' || (c == '\r' && terminal_);
}

PrintableStream::int_type PrintableStream::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize PrintableStream::xsputn(const char* text, std::streamsize size) {
  const char* const end = text + size;
  const char* at = text;
  if (colours_ && line_begins_ &&
      std::string_view(text, static_cast<std::size_t>(size)).starts_with(kWarning)) {
    if (!put(kYellow) || !put(kWarning) || !put(kPlain)) return 0;
    at += kWarning.size();
  }
  if (size > 0) line_begins_ = end[-1] == '\n';
  while (at != end) {
    const char* const stop = std::find_if(at, end, [&](char c) { return !passes(c); });
    if (next_->sputn(at, stop - at) != stop - at) return at - text;
    at = stop;
    if (at == end) break;
    const std::string escaped = printable({at, 1});
    if (!put(escaped)) return at - text;
    ++at;
  }
  return size;
}

}  // namespace lilytank::cli
