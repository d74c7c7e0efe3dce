// From worlds to rows, from rows to a table, whatever happens in between.
#include <gtest/gtest.h>

#include <algorithm>

#include "io/file_digest.hpp"
#include "lilytank/run.hpp"
#include "study/row_text.hpp"
#include "study/run_table.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

const std::string kStudy =
    "[study]\nscenario = \"pair.toml\"\nreplicates = 4\n"
    "[[axis]]\nname = \"rules\"\noverlays = [\"sticky.toml\", \"loose.toml\"]\n";

class StudyTableTest : public testing::Test, public test::StudyRig {
 protected:
  std::string out(const std::string& name = "out") const { return here.path(name); }
  StudyResult run(const Study& study, const std::string& dir = "out", bool force = false) const {
    StudyOptions options;
    options.out = out(dir);
    options.threads = 1;
    options.force = force;
    return run_study(study, options);
  }
  std::string table(const std::string& dir = "out") const {
    return table_text(load_study(out(dir)));
  }
};

TEST_F(StudyTableTest, RowsAreThoseOfSingleRuns) {
  const Study study = this->study(kStudy);
  const StudyResult result = run(study);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.runs, 8);
  EXPECT_EQ(result.failed, 0);
  const StudyTable table = load_study(out()).table;
  ASSERT_EQ(table.rows.size(), 8u);
  EXPECT_EQ(table.labels, (std::vector<std::string>{"rules=sticky", "rules=loose"}));
  bool any = false;
  for (int s = 0; s < 2; ++s) {
    for (int r = 0; r < 4; ++r) {
      const RunRow& row = table.rows[static_cast<std::size_t>(4 * s + r)];
      EXPECT_EQ(row.setting, s);
      EXPECT_EQ(row.replicate, r);
      EXPECT_EQ(row.id, study.plan().id_of(s, r));
      EXPECT_EQ(row.values, std::vector<double>{static_cast<double>(s)});
      // As a user would repeat it.
      const Scenario scenario =
          load_scenario({here.path("pair.toml"), here.path(s == 0 ? "sticky.toml" : "loose.toml")},
                        {"run.seed=" + std::to_string(row.seed)});
      const RunResult single = lilytank::run(scenario, {});
      EXPECT_EQ(row.copies, single.copies);
      EXPECT_EQ(row.possible, single.possible);
      EXPECT_EQ(row.duration, single.time);
      ASSERT_EQ(row.completion.size(), single.completion_times.size());
      for (std::size_t k = 0; k < row.completion.size(); ++k) {
        EXPECT_NEAR(row.completion[k], single.completion_times[k], 1e-12);
      }
      any = any || row.copies > 0;
    }
  }
  EXPECT_TRUE(any);
}

TEST_F(StudyTableTest, OnlyWhatIsMissingIsDone) {
  const Study study = this->study(kStudy);
  run(study);
  const std::string whole = table();
  EXPECT_EQ(run(study).runs, 0);
  EXPECT_FALSE(here.has("out/rows-0002.csv"));  // nothing to write
  std::string rows = here.read("out/rows-0001.csv");
  rows.resize(rows.size() - 3);  // as by a kill: the last line is dropped
  here.write("out/rows-0001.csv", rows);
  EXPECT_EQ(load_study(out()).table.rows.size(), 7u);
  EXPECT_EQ(run(study).runs, 1);
  EXPECT_EQ(here.read("out/rows-0001.csv"), rows);  // another process' file stays as it is
  EXPECT_EQ(table(), whole);
  here.write("out/rows-0001.csv", "study,id,sett");
  EXPECT_EQ(run(study).runs, 7);
  EXPECT_EQ(table(), whole);
  // More replicates are another number of the same runs.
  std::string more = kStudy;
  more.replace(more.find("replicates = 4"), 14, "replicates = 6");
  EXPECT_EQ(run(this->study(more)).runs, 4);
  EXPECT_EQ(run(study).runs, 0);
  EXPECT_EQ(table(), whole);
}

TEST_F(StudyTableTest, RowsGoThroughText) {
  const StudyPlan plan = study(kStudy).plan();
  RunRow row;
  row.setting = 1, row.replicate = 2;
  row.id = plan.id_of(1, 2), row.seed = plan.seed_of(2);
  row.values = {1};
  row.status = RunStatus::diverged;
  row.duration = 3.475, row.possible = 3, row.copies = 1, row.illegal = 7;
  row.completion = {0.1, 2.225};
  row.note = "step 139: module 3, force";
  bool foreign = false;
  const std::string line = with_checksum(row_line(row, plan.identity())) + "\n";
  const auto back = rows_from(row_header() + line, "f", plan, foreign);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_FALSE(foreign);
  EXPECT_EQ(back[0].status, RunStatus::diverged);
  EXPECT_EQ(back[0].completion, row.completion);
  EXPECT_EQ(back[0].values, row.values);
  EXPECT_EQ(back[0].note, "step 139: module 3; force");
  EXPECT_EQ(row_line(back[0], plan.identity()), row_line(row, plan.identity()));
  std::string damaged = row_header() + line;
  damaged.replace(damaged.find(",1,2,"), 5, ",1,3,");  // the id belongs to another replicate
  EXPECT_THROW(rows_from(damaged, "f", plan, foreign), InputError);
  StudyPlan other = plan;
  other.seed = 77;
  EXPECT_TRUE(rows_from(row_header() + line, "f", other, foreign).empty());
  EXPECT_TRUE(foreign);
}

TEST_F(StudyTableTest, AnotherStudyIsRefusedUnlessForced) {
  run(study(kStudy));
  const Study other = study(kStudy, {"run.duration=2"});
  EXPECT_THROW(run(other), InputError);
  EXPECT_EQ(load_study(out()).table.rows.size(), 8u);
  EXPECT_EQ(run(other, "out", true).runs, 8);
  EXPECT_EQ(load_study(out()).table.horizon, 2);
  EXPECT_EQ(run(other, "out", true).runs, 0);  // its own rows are spared
}

TEST_F(StudyTableTest, TwoResultsOfOneRunAreNoticed) {
  const Study study = this->study(kStudy);
  run(study);
  const std::string rows = here.read("out/rows-0001.csv");
  here.write("out/rows-0002.csv", rows);  // the same twice does no harm
  EXPECT_EQ(load_study(out()).table.rows.size(), 8u);
  std::string wrong = rows;
  const auto at = wrong.find(",ok,8,");
  wrong.replace(at, 6, ",ok,9,");
  here.write("out/rows-0002.csv", wrong);
  EXPECT_THROW(load_study(out()), InputError);
}

TEST_F(StudyTableTest, ChangedFilesAreNoticed) {
  const Study study = this->study(kStudy);
  here.write("loose.toml", "[rules]\npart.p = 0.75\n");
  EXPECT_NO_THROW(study.scenario(0));
  EXPECT_THROW(study.scenario(1), InputError);
}

TEST_F(StudyTableTest, TheTableIsTidy) {
  run(study(kStudy));
  const std::string text = table();
  EXPECT_TRUE(
      text.starts_with("setting,replicate,id,seed,status,rules,duration_s,possible,copies,"
                       "full_yield,illegal,time_1_s,time_2_s,time_3_s,note\n0,0,"))
      << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9);
  EXPECT_NE(text.find(",ok,sticky,8,3,"), std::string::npos) << text;
}

TEST_F(StudyTableTest, ADivergedWorldIsARow) {
  const Study study = this->study(kStudy, {"module.mass=0.1 g", "forces.body_force.force_x=1"});
  const StudyResult result = run(study);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.failed, 8);
  const StoredStudy stored = load_study(out());
  EXPECT_EQ(stored.counts[0].failed, 4);
  EXPECT_EQ(stored.table.rows[0].status, RunStatus::diverged);
  EXPECT_NE(stored.table.rows[0].note.find("body_force"), std::string::npos);
  EXPECT_EQ(run(study).runs, 0);
}

TEST_F(StudyTableTest, AStopAbandonsWhatRuns) {
  const Study study = this->study(kStudy, {"run.duration=1e6"});  // hours of wall time
  std::atomic<bool> stop{false};
  StudyOptions options;
  options.out = out();
  options.threads = 2;
  options.stop = &stop;
  options.progress = [&](double, const std::string& note) {
    EXPECT_TRUE(note.starts_with("0 runs, 8 left, ")) << note;
    stop = true;
  };
  EXPECT_THROW(run_study(study, options), Stopped);
  EXPECT_TRUE(load_study(out()).table.rows.empty());
}

/// Rows of made-up runs with so many copies each.
std::vector<RunRow> rows_of(const StudyPlan& plan, const std::vector<int>& copies) {
  std::vector<RunRow> rows;
  for (std::size_t r = 0; r < copies.size(); ++r) {
    RunRow row;
    row.replicate = static_cast<int>(r);
    row.id = plan.id_of(0, row.replicate);
    row.possible = 3, row.copies = copies[r], row.duration = 8;
    rows.push_back(row);
  }
  return rows;
}

TEST_F(StudyTableTest, TheStoppingRuleLooksAtItsRoundsOnly) {
  const StudyPlan plan =
      study(
          "[study]\nscenario = \"pair.toml\"\n[stop]\nmetric = \"copies\"\nhalf_width = 1\n"
          "min = 3\nmax = 9\nround = 2\n")
          .plan();
  const auto required = [&](const std::vector<int>& copies, int missing = -1) {
    RunTable run_table(plan);
    std::vector<RunRow> rows = rows_of(plan, copies);
    std::reverse(rows.begin(), rows.end());  // the order does not matter
    for (RunRow& row : rows) {
      if (row.replicate != missing) run_table.add(row);
    }
    const RequiredRuns w = run_table.required(0);
    return std::pair(w.replicates, w.decided);
  };
  EXPECT_EQ(required({}), std::pair(3, false));
  EXPECT_EQ(required({1, 1}), std::pair(3, false));
  EXPECT_EQ(required({1, 1, 1}), std::pair(5, false));  // others may have other numbers: 1.06
  EXPECT_EQ(required({1, 1, 1, 1, 1}), std::pair(5, true));
  EXPECT_EQ(required({0, 3, 1}), std::pair(5, false));  // too wide at 3: half width 3.8
  EXPECT_EQ(required({0, 3, 1, 1}), std::pair(5, false));
  // With five, 1.36; with seven, 0.85.
  EXPECT_EQ(required({0, 3, 1, 1, 1, 1, 1}), std::pair(7, true));
  EXPECT_EQ(required({0, 3, 1, 1, 1, 1, 1, 0, 3}), std::pair(7, true));  // later rows do not count
  EXPECT_EQ(required({0, 3, 1, 1, 1, 1, 1, 0, 3}, 2), std::pair(3, false));
  EXPECT_EQ(required({0, 3, 0, 3, 0, 3, 0}), std::pair(9, true));  // the most there may be
}

TEST_F(StudyTableTest, RunsBeyondTheStoppingRuleAreLeftOut) {
  const std::string text =
      "[study]\nscenario = \"pair.toml\"\n[stop]\nmetric = \"copies\"\nhalf_width = 3\nmin = 3\n"
      "max = 9\nround = 2\n";
  const std::string fixed = "[study]\nscenario = \"pair.toml\"\nreplicates = 9\n";
  run(study(text));
  const std::string table = this->table();
  const std::size_t n = load_study(out()).table.rows.size();
  EXPECT_GE(n, 3u);
  EXPECT_LT(n, 9u);
  run(study(fixed));
  EXPECT_EQ(load_study(out()).table.rows.size(), 9u);
  EXPECT_EQ(run(study(text)).runs, 0);
  EXPECT_EQ(this->table(), table);
}

TEST(StudyMetric, AreThoseOfTheSummary) {
  EXPECT_TRUE(is_metric("time_12"));
  for (const char* no : {"time_0", "time_", "time_x", "time_1.5", "time_01", "yield", ""}) {
    EXPECT_FALSE(is_metric(no)) << no;
  }
  EXPECT_EQ(metric_unit("time_2"), "s");
  EXPECT_EQ(metric_unit("assembly_rate"), "1/s");
  EXPECT_EQ(metric_unit("full_yield"), "1");
  RunRow full, half, bad;
  full.possible = half.possible = bad.possible = 2;
  full.duration = half.duration = 100, bad.duration = 1;
  full.copies = 2, full.completion = {10, 50};
  half.copies = 1, half.completion = {30};
  bad.status = RunStatus::diverged;
  const std::vector<const RunRow*> runs{&full, &half, &bad};
  EXPECT_EQ(metric_estimate("copies", runs, 100).value, 1.5);
  EXPECT_EQ(metric_estimate("full_yield", runs, 100).value, wilson(1, 2).value);
  EXPECT_EQ(metric_estimate("assembly_rate", runs, 100).value, 3.0 / 150);
  EXPECT_EQ(metric_estimate("time_1", runs, 100).value, 20);
  EXPECT_EQ(metric_estimate("time_2", runs, 100).value, 75);
  RunRow few;  // too few modules for a copy
  few.duration = 100;
  EXPECT_EQ(metric_estimate("full_yield", {&full, &half, &few}, 100).value, wilson(1, 2).value);
}

}  // namespace
}  // namespace lilytank
