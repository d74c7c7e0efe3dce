// Standard output and error without control characters: titles, names and paths come from files.
#pragma once
#include <ostream>
#include <streambuf>
#include <string_view>

namespace lilytank::cli {

/// Stands between a stream and its buffer, and escapes control characters other than line ends and
/// tabs. Data that a verb prints are text: nothing else of them changes.
class PrintableStream final : public std::streambuf {
 public:
  /// `carriage_return`: whether "\r" passes, as lines of progress on a terminal need it.
  PrintableStream(std::ostream& stream, bool carriage_return)
      : stream_(&stream), next_(stream.rdbuf(this)), carriage_return_(carriage_return) {}
  ~PrintableStream() override { stream_->rdbuf(next_); }
  PrintableStream(const PrintableStream&) = delete;
  PrintableStream& operator=(const PrintableStream&) = delete;

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override { return next_->pubsync(); }

 private:
  bool passes(char c) const;
  std::ostream* stream_;
  std::streambuf* next_;
  bool carriage_return_;
};

}  // namespace lilytank::cli
