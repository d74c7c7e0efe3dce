#include "io/table_lines.hpp"

#include <cstring>

#include "io/cells.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kLongestRecord = 1 << 16;

}  // namespace

bool TableLines::fetch(std::string_view& line) {
  if (!lines_->next(line)) return false;
  line_ = lines_->line();
  if (line.empty() || std::memchr(line.data(), '"', line.size()) == nullptr) return true;
  if (comments_ && (trimmed(line).starts_with('#') || trimmed(line).starts_with('%'))) return true;
  if (!ends_in_quotes(line, separator_)) return true;
  joined_ = line;
  std::string_view more;
  while (ends_in_quotes(joined_, separator_)) {
    if (joined_.size() > kLongestRecord || !lines_->next(more)) {
      throw InputError({file(), line_, 1}, "a quote (\") that begins a cell here is never closed");
    }
    joined_.append("\n").append(more);
  }
  line = joined_;
  return true;
}

bool TableLines::next(std::string_view& line) {
  if (ahead_.empty()) return fetch(line);
  current_ = std::move(ahead_.front().text);
  line_ = ahead_.front().number;
  ahead_.pop_front();
  line = current_;
  return true;
}

const TableLines::Line* TableLines::ahead(std::size_t i) {
  const int present = line_;
  std::string_view line;
  while (ahead_.size() <= i && fetch(line)) ahead_.push_back({std::string(line), line_});
  line_ = present;
  return i < ahead_.size() ? &ahead_[i] : nullptr;
}

}  // namespace lilytank
