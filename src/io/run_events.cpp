#include "lilytank/run_events.hpp"

#include <algorithm>

#include "io/csv.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr int kPairKinds = 5;  // latch .. update: of two modules and their faces
constexpr int kLargestLabel = 255;

int kind_in(const CsvReader& rows) {
  const auto& words = event_words();
  const auto found = std::find(words.begin(), words.end(), rows.text(2));
  if (found == words.end()) rows.refuse(2, "is none of " + joined(words, ", "));
  return static_cast<int>(found - words.begin());
}

}  // namespace

const std::vector<std::string>& event_words() {
  static const std::vector<std::string> words{"latch",  "unlatch", "link",    "unlink",
                                              "update", "report",  "command", "copy"};
  return words;
}

std::vector<StoredEvent> read_events(const std::string& text, const std::string& file,
                                     int modules) {
  std::vector<StoredEvent> out;
  CsvReader rows(whole_lines(text), file, {kEventColumns});
  while (rows.next()) {
    StoredEvent& e = out.emplace_back();
    e.time = rows.number(0), e.kind = kind_in(rows);
    const auto whole = [&](std::size_t column, int high, bool needed = false) {
      const bool absent = rows.empty(column) && !needed;
      return absent ? -1 : static_cast<int>(rows.whole(column, 0, high));
    };
    const bool pair = e.kind < kPairKinds;
    e.a = whole(3, modules - 1, pair), e.face_a = whole(4, 3, pair);
    e.b = whole(5, modules - 1, pair), e.face_b = whole(6, 3, pair);
    e.rule = rows.text(7);
    e.label_a = whole(8, kLargestLabel), e.last_a = whole(9, 3);
    e.label_b = whole(10, kLargestLabel), e.last_b = whole(11, 3);
    e.copies = whole(12, modules, e.kind == kCopyEvent);
  }
  return out;
}

}  // namespace lilytank
