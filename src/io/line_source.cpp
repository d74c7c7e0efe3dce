#include "io/line_source.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "io/atomic_file.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kBlock = 1 << 18;
constexpr std::size_t kLongestLine = 1 << 20;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace

/// zlib reads files that are not compressed as they are.
struct LineSource::Stream {
  explicit Stream(const std::string& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
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
    : file_(file), stream_(std::make_unique<Stream>(file)), buffer_(kBlock) {
  fill();
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

LineSource::LineSource(std::string_view text, std::string file)
    : file_(std::move(file)), rest_(text), ended_(true) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

LineSource::~LineSource() = default;

bool LineSource::fill() {
  if (ended_) return false;
  const std::size_t kept = rest_.size();
  if (kept > kLongestLine) {
    throw InputError({file_, line_ + 1, 1}, "a line of more than a megabyte: this is no table");
  }
  if (kept > 0) std::memmove(buffer_.data(), rest_.data(), kept);
  if (buffer_.size() < kept + kBlock) buffer_.resize(kept + kBlock);
  const int n = ::gzread(stream_->in, buffer_.data() + kept, static_cast<unsigned>(kBlock));
  int problem = Z_OK;
  const char* reason = ::gzerror(stream_->in, &problem);
  if (problem == Z_ERRNO) throw InputError(system_problem("cannot read", file_, errno));
  if (problem == Z_BUF_ERROR) {
    throw InputError({file_, line_ + 1, 0}, "the compressed file is cut here");
  }
  if (n < 0 || problem < 0) {
    throw InputError({file_, line_ + 1, 0}, "the compression is damaged: " + std::string(reason));
  }
  ended_ = n == 0;
  rest_ = {buffer_.data(), kept + static_cast<std::size_t>(n)};
  return n > 0;
}

bool LineSource::next(std::string_view& line) {
  if (again_) {
    again_ = false;
    line = present_;
    return line_ > 0;
  }
  std::size_t searched = 0;
  const char* end = nullptr;
  for (;;) {
    const void* found = rest_.size() > searched
                            ? std::memchr(rest_.data() + searched, '\n', rest_.size() - searched)
                            : nullptr;
    end = static_cast<const char*>(found);
    searched = rest_.size();
    if (end != nullptr || !fill()) break;
  }
  if (end == nullptr && rest_.empty()) return false;
  const std::size_t length =
      end == nullptr ? rest_.size() : static_cast<std::size_t>(end - rest_.data());
  line = rest_.substr(0, length);
  rest_.remove_prefix(length + (end == nullptr ? 0 : 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  present_ = line;
  ++line_;
  return true;
}

}  // namespace lilytank
