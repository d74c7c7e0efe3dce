#include "study/row_text.hpp"

#include <algorithm>
#include <limits>

#include "io/csv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr const char* kHeader =
    "study,id,setting,replicate,seed,status,duration,possible,copies,illegal,completion,note,"
    "checksum";
enum Column : std::size_t {
  study,
  id,
  setting,
  replicate,
  seed,
  status,
  duration,
  possible,
  copies,
  illegal,
  completion,
  note
};

std::vector<double> times_of(const CsvReader& csv) {
  std::vector<double> times;
  std::string_view rest = csv.text(completion);
  while (!rest.empty()) {
    const auto end = std::min(rest.find(';'), rest.size());
    const auto time = parse_number(rest.substr(0, end));
    if (!time) csv.refuse(completion, "completion is not a list of times");
    times.push_back(*time);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return times;
}

RunRow row_of(const CsvReader& csv, const StudyPlan& plan) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  RunRow row;
  row.id = csv.text(id);
  row.setting =
      static_cast<int>(csv.whole(setting, 0, static_cast<std::int64_t>(plan.settings.size()) - 1));
  row.replicate =
      static_cast<int>(csv.whole(replicate, 0, std::numeric_limits<std::int32_t>::max() - 1));
  row.seed = static_cast<std::uint64_t>(csv.whole(seed, 0, most));
  if (row.id != plan.id_of(row.setting, row.replicate)) {
    csv.refuse(id, "id '" + row.id + "' is not that of the setting and the replicate");
  }
  const std::string_view word = csv.text(status);
  if (word != "ok" && word != "diverged") csv.refuse(status, "status is neither ok nor diverged");
  row.status = word == "ok" ? RunStatus::ok : RunStatus::diverged;
  row.duration = csv.number(duration);
  row.possible = static_cast<int>(csv.whole(possible, 0, 1'000'000));
  row.copies = static_cast<int>(csv.whole(copies, 0, 1'000'000));
  row.illegal = csv.whole(illegal, 0, most);
  row.completion = times_of(csv);
  row.note = csv.text(note);
  row.values = plan.settings[static_cast<std::size_t>(row.setting)].values;
  return row;
}

}  // namespace

std::string status_word(RunStatus status) {
  return status == RunStatus::diverged ? "diverged" : "ok";
}

std::string row_header() {
  return std::string(kHeader) + "\n";
}

std::string row_line(const RunRow& row, std::uint64_t of_study) {
  std::string times, text = row.note;
  for (const double t : row.completion) times += (times.empty() ? "" : ";") + without_rounding(t);
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return hex(of_study) + "," + row.id + "," + std::to_string(row.setting) + "," +
         std::to_string(row.replicate) + "," + std::to_string(row.seed) + "," +
         status_word(row.status) + "," + without_rounding(row.duration) + "," +
         std::to_string(row.possible) + "," + std::to_string(row.copies) + "," +
         std::to_string(row.illegal) + "," + times + "," + text;
}

std::vector<RunRow> rows_from(std::string_view text, const std::string& file, const StudyPlan& plan,
                              bool& foreign) {
  std::vector<RunRow> rows;
  text = whole_lines(text);
  if (text.empty()) return rows;
  CsvReader csv(text, file, {kHeader});
  const std::string ours = hex(plan.identity());
  while (csv.next()) {
    if (csv.text(study) == ours) {
      rows.push_back(row_of(csv, plan));
    } else {
      foreign = true;
    }
  }
  return rows;
}

}  // namespace lilytank
