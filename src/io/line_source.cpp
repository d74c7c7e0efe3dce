#include "io/line_source.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>

#include "io/atomic_file.hpp"
#include "io/standard_input.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kBlock = 1 << 18;
constexpr std::size_t kLongestLine = 1 << 20;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace

/// zlib reads files that are not compressed as they are.
struct LineSource::Stream {
  explicit Stream(const std::string& file) {
    const int descriptor = ::open(openable(file).c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw InputError(system_problem("cannot read", file, errno));
    in = ::gzdopen(descriptor, "rb");
    if (in == nullptr) {
      ::close(descriptor);
      throw std::bad_alloc();
    }
    ::gzbuffer(in, kBlock);
  }
  ~Stream() { ::gzclose(in); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  gzFile in = nullptr;
};

LineSource::LineSource(const std::string& file)
    : file_(file), stream_(std::make_unique<Stream>(file)) {
  ended_ = !read_block(block_);
  begin(block_);
  if (decoder_) {
    decoder_->decode(block_, ended_, buffer_);
  } else {
    buffer_.swap(block_);
  }
  rest_ = buffer_;
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

LineSource::LineSource(std::string_view text, std::string file)
    : file_(std::move(file)), rest_(text), ended_(true) {
  begin(text);
  if (decoder_) {
    decoder_->decode(text, true, buffer_);
    rest_ = buffer_;
  }
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

LineSource::~LineSource() = default;

void LineSource::begin(std::string_view bytes) {
  const std::string binary = binary_kind(bytes);
  if (!binary.empty()) throw InputError({file_, 1, 1}, binary);
  const TextEncoding encoding = encoding_of(bytes);
  if (encoding != TextEncoding::utf8) decoder_.emplace(encoding == TextEncoding::utf16_big);
}

bool LineSource::read_block(std::string& out) {
  const std::size_t before = out.size();
  out.resize(before + kBlock);
  const int n = ::gzread(stream_->in, out.data() + before, static_cast<unsigned>(kBlock));
  int problem = Z_OK;
  const char* reason = ::gzerror(stream_->in, &problem);
  if (problem == Z_ERRNO) throw InputError(system_problem("cannot read", file_, errno));
  if (problem == Z_BUF_ERROR) {
    throw InputError({file_, line_ + 1, 0}, "the compressed file is cut here");
  }
  if (n < 0 || problem < 0) {
    throw InputError({file_, line_ + 1, 0}, "the compression is damaged: " + std::string(reason));
  }
  out.resize(before + static_cast<std::size_t>(n));
  return n > 0;
}

bool LineSource::fill() {
  if (ended_) return false;
  if (rest_.size() > kLongestLine) {
    throw InputError({file_, line_ + 1, 1}, "a line of more than a megabyte: this is no table");
  }
  buffer_.erase(0, buffer_.size() - rest_.size());
  rest_ = buffer_;
  if (decoder_) {
    block_.clear();
    ended_ = !read_block(block_);
    decoder_->decode(block_, ended_, buffer_);
  } else {
    ended_ = !read_block(buffer_);
  }
  const bool more = buffer_.size() > rest_.size();
  rest_ = buffer_;
  return more || !ended_;
}

// A file may end its lines with '\r' alone, so that its '\n' are far off or none: they are looked
// for once.
std::pair<std::size_t, std::size_t> LineSource::find_end() {
  std::size_t searched = 0;
  for (;;) {
    const auto newline = rest_.find('\n', std::max(searched, no_newline_));
    const std::size_t end = std::min(newline, rest_.size());
    no_newline_ = end;
    const auto back = rest_.substr(0, end).find('\r', searched);
    if (back != std::string_view::npos) {
      const std::size_t behind = std::min(rest_.find_first_not_of('\r', back), rest_.size());
      // What follows a '\r' at the end of what was read is not known yet.
      if (behind == rest_.size() && !ended_ && fill()) continue;
      if (behind < rest_.size() && rest_[behind] == '\n') return {back, behind + 1 - back};
      return {back, behind == rest_.size() ? behind - back : 1};
    }
    if (newline != std::string_view::npos) return {newline, 1};
    searched = rest_.size();
    if (!fill()) return {rest_.size(), 0};
  }
}

bool LineSource::next(std::string_view& line) {
  const auto [length, end] = find_end();
  if (length + end == 0) return false;
  line = rest_.substr(0, length);
  rest_.remove_prefix(length + end);
  no_newline_ -= std::min(no_newline_, length + end);
  ++line_;
  if (line.find('\0') != std::string_view::npos) {
    throw InputError(place(static_cast<int>(line.find('\0')) + 1),
                     "there is a zero byte in this line: the file is damaged, or no text table");
  }
  return true;
}

}  // namespace lilytank
