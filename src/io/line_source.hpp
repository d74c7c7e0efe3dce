// Lines of a text file, plain or compressed, read in blocks: memory does not grow with the file.
// Text is UTF-8, or UTF-16 which is decoded; byte order marks are dropped. Lines end with \n, \r\n,
// \r\r\n or \r alone.
#pragma once
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "io/encoding.hpp"
#include "lilytank/error.hpp"

namespace lilytank {

class LineSource {
 public:
  /// Opens a file, compressed by gzip or not. Throws InputError: the system's reason, or what the
  /// file is if it is no text.
  explicit LineSource(const std::string& file);
  /// Lines of a text in memory, named `file` in messages. The text must outlive this.
  LineSource(std::string_view text, std::string file);
  ~LineSource();
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;

  /// The next line without its end, valid until the next call; false at the end of the file. Throws
  /// InputError if the file cannot be read on, is cut within its compression, or has a line of
  /// more than a megabyte or with a zero byte.
  bool next(std::string_view& line);
  /// Of the line given last, from 1.
  int line() const { return line_; }
  const std::string& file() const { return file_; }
  SourcePlace place(int column = 0) const { return {file_, line_, column}; }

 private:
  struct Stream;
  /// Drops what was given from the buffer and reads on; false at the end of the file.
  bool fill();
  /// Bytes of the file as they are, `kBlock` at most, at the end of `out`; false at its end.
  bool read_block(std::string& out);
  /// Looks at the first bytes: encoding, byte order mark. Throws InputError: no text.
  void begin(std::string_view bytes);
  /// The length of the next line and of its end; reads on as far as needed.
  std::pair<std::size_t, std::size_t> find_end();
  std::string file_;
  std::unique_ptr<Stream> stream_;
  std::optional<Utf16Decoder> decoder_;
  std::string buffer_, block_;
  std::string_view rest_;       ///< read and not yet given
  std::size_t no_newline_ = 0;  ///< bytes at the front of rest_ that are known to hold no '\n'
  int line_ = 0;
  bool ended_ = false;
};

/// What `read` returns. Where there is not enough memory for it, throws InputError with the file.
template <class Read>
auto with_enough_memory(const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw InputError({file, 0, 0}, "there is not enough memory for what is in it");
}

}  // namespace lilytank
