// A study's directory as one table.
#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "statistics/csv_cells.hpp"
#include "study/row_text.hpp"
#include "study/run_table.hpp"
#include "study/study_directory.hpp"
#include "study/study_record.hpp"
#include "study/study_rows.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::size_t most_copies(const StudyTable& table) {
  std::size_t most = 0;
  for (const RunRow& row : table.rows) {
    most = std::max({most, static_cast<std::size_t>(row.possible), row.completion.size()});
  }
  return most;
}

std::string table_line(const RunRow& row, const StudyPlan& plan, std::size_t times) {
  const Setting& setting = plan.settings[static_cast<std::size_t>(row.setting)];
  std::string out = std::to_string(row.setting) + "," + std::to_string(row.replicate) + "," +
                    row.id + "," + std::to_string(row.seed) + "," + status_word(row.status);
  for (const std::string& text : setting.texts) out += "," + cell(text);
  out += "," + without_rounding(row.duration) + "," + std::to_string(row.possible) + "," +
         std::to_string(row.copies) + (reached_all(row) ? ",1," : ",0,") +
         std::to_string(row.illegal);
  for (std::size_t k = 0; k < times; ++k) {
    out += "," + (k < row.completion.size() ? without_rounding(row.completion[k]) : "");
  }
  return out + "," + cell(row.note) + "\n";
}

}  // namespace

StoredStudy load_study(const std::string& dir) {
  const std::string file = (std::filesystem::path(dir) / study_file::plan).string();
  if (!exists(file)) {
    throw InputError("'" + dir + "' is not the directory of a study: it has no study.toml");
  }
  return load_study(dir, read_plan(file));
}

StoredStudy load_study(const std::string& dir, const StudyPlan& plan) {
  StoredStudy out;
  out.plan = plan;
  RunTable run_table(out.plan);
  std::string foreign;
  for (RunRow& row : read_rows(dir, out.plan, foreign)) run_table.add(std::move(row));
  if (!foreign.empty()) throw InputError("'" + foreign + "' holds rows of another study");
  out.table = {out.plan.name, out.plan.axes, {}, out.plan.horizon(), {}};
  for (std::size_t s = 0; s < out.plan.settings.size(); ++s) {
    const RequiredRuns required = run_table.required(static_cast<int>(s));
    out.table.labels.push_back(out.plan.settings[s].label);
    out.counts.push_back({0, 0, required.replicates, required.decided});
  }
  for (const RunRow* row : run_table.required_rows()) {
    StoredStudy::Count& count = out.counts[static_cast<std::size_t>(row->setting)];
    ++count.done;
    if (row->status == RunStatus::diverged) ++count.failed;
    out.table.rows.push_back(*row);
  }
  out.complete = run_table.complete();
  return out;
}

std::string table_text(const StoredStudy& study) {
  const std::size_t times = most_copies(study.table);
  std::string out = "setting,replicate,id,seed,status";
  for (const std::string& axis : study.table.axes) out += "," + cell(axis);
  out += ",duration_s,possible,copies,full_yield,illegal";
  for (std::size_t k = 1; k <= times; ++k) out += ",time_" + std::to_string(k) + "_s";
  out += ",note\n";
  for (const RunRow& row : study.table.rows) out += table_line(row, study.plan, times);
  return out;
}

void write_table(const StoredStudy& study, const std::string& dir) {
  const std::string file = (std::filesystem::path(dir) / study_file::table).string();
  write_atomically(file, table_text(study));
}

}  // namespace lilytank
