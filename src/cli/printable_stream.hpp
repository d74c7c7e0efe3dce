// Standard output and error without control characters: titles, names and paths come from files.
#pragma once
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace lilytank::cli {

/// Stands between a stream and its buffer, and escapes control characters other than line ends and
/// tabs. Data that a verb prints are text: nothing else of them changes.
class PrintableStream final : public std::streambuf {
 public:
  /// `terminal`: "\r" passes, as lines of progress need it, and what a user must not miss has a
  /// colour, unless NO_COLOR is set or the terminal is dumb [no-color.org].
  PrintableStream(std::ostream& stream, bool terminal);
  ~PrintableStream() override { stream_->rdbuf(next_); }
  PrintableStream(const PrintableStream&) = delete;
  PrintableStream& operator=(const PrintableStream&) = delete;

  /// Prints a line in red.
  void print_refusal(const std::string& line);

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override { return next_->pubsync(); }

 private:
  bool passes(char c) const;
  bool put(std::string_view text);
  std::ostream* stream_;
  std::streambuf* next_;
  bool terminal_, colours_;
  bool line_begins_ = true;
};

}  // namespace lilytank::cli
