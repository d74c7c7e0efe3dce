// Lines of a text file, plain or compressed, read in blocks: memory does not grow with the file.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/error.hpp"

namespace lilytank {

class LineSource {
 public:
  /// Opens a file; gzip is told by its first bytes. Throws InputError with the system's reason.
  explicit LineSource(const std::string& file);
  /// Lines of a text in memory, named `file` in messages. The text must outlive this.
  LineSource(std::string_view text, std::string file);
  ~LineSource();
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;

  /// The next line without its end, valid until the next call; false at the end of the file. Throws
  /// InputError if the file cannot be read on, is cut within its compression, or has a line of
  /// more than a megabyte.
  bool next(std::string_view& line);
  /// Makes the next call of next() give the present line again.
  void again() { again_ = true; }
  /// Of the line given last, from 1.
  int line() const { return line_; }
  const std::string& file() const { return file_; }
  SourcePlace place(int column = 0) const { return {file_, line_, column}; }

 private:
  struct Stream;
  /// Moves what is left of the buffer to its front and reads on; false at the end of the file.
  bool fill();
  std::string file_;
  std::unique_ptr<Stream> stream_;
  std::vector<char> buffer_;
  std::string_view rest_;  ///< read and not yet given
  std::string_view present_;
  int line_ = 0;
  bool again_ = false, ended_ = false;
};

}  // namespace lilytank
