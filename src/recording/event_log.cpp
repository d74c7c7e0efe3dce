#include "recording/event_log.hpp"

#include <algorithm>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "lilytank/run_events.hpp"
#include "text/words.hpp"

namespace lilytank {

std::vector<LoggedEvent> read_event_log(const std::string& file) {
  constexpr std::int64_t kMostModules = 1'000'000'000;
  const std::string text = read_whole(file);
  CsvReader rows(whole_lines(text), file, {kLogColumns, kEventColumns});
  const bool of_run = rows.header() == 1;
  const std::size_t kind = of_run ? 2 : 1, a = of_run ? 3 : 2, b = of_run ? 5 : 3;
  const std::vector<std::string>& words = event_words();
  std::vector<LoggedEvent> out;
  while (rows.next()) {
    const auto word = std::find(words.begin(), words.end(), rows.text(kind));
    if (word == words.end()) rows.refuse(kind, "is none of " + joined(words, ", "));
    const auto of = static_cast<EventKind>(word - words.begin());
    if (of > EventKind::update) continue;
    const LoggedEvent e{rows.number(0), of, rows.whole(a, 0, kMostModules),
                        rows.whole(b, 0, kMostModules)};
    if (e.a == e.b) rows.refuse(b, "is module_a itself");
    if (!out.empty() && e.time < out.back().time) rows.refuse(0, "is before the line above");
    out.push_back(e);
  }
  return out;
}

}  // namespace lilytank
