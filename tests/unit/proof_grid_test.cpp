// Axes, cells and tables of a grid of null experiments, and its directory.
#include <gtest/gtest.h>

#include "lilytank/error.hpp"
#include "lilytank/proof_grid.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

std::string axis_refusal(const std::string& text) {
  GridAxes axes;
  try {
    set_axis(axes, text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "(none)";
}

TEST(GridAxes, RunInTheOrderThatIsWritten) {
  GridAxes axes;
  EXPECT_EQ(axes.cells(false).size(), 72u);
  EXPECT_EQ(axes.cells(true).size(), 18u);
  set_axis(axes, "balls=4,20s");
  set_axis(axes, "lilies=4min");
  set_axis(axes, "modules=15,5");
  set_axis(axes, "budget=10,1");
  std::string names;
  for (const GridCell& cell : axes.cells(false)) names += cell.name() + "\n";
  EXPECT_EQ(names,
            "balls-4min_lilies-4min_modules-15_budget-10\n"
            "balls-20s_lilies-4min_modules-15_budget-10\n"
            "balls-4min_lilies-4min_modules-5_budget-10\n"
            "balls-20s_lilies-4min_modules-5_budget-10\n"
            "balls-4min_lilies-4min_modules-15_budget-1\n"
            "balls-20s_lilies-4min_modules-15_budget-1\n"
            "balls-4min_lilies-4min_modules-5_budget-1\n"
            "balls-20s_lilies-4min_modules-5_budget-1\n");
  EXPECT_EQ(axes.cells(true).front().name(), "known-flow_lilies-4min_modules-15_budget-10");
}

TEST(GridAxes, RefuseWhatIsNoAxisOrNoValue) {
  const struct {
    std::string text, message;
  } cases[] = {
      {"lillies=4min",
       "'lillies' is none of balls, lilies, modules, budget - did you mean 'lilies'?"},
      {"lilies", "'lilies' has no values: write lilies="},
      {"lilies=", "lilies"},
      {"lilies=4min,", "lilies"},
      {"lilies=4mn", "'mn' is not a unit known here"},
      {"lilies=1s", "lilies: 1s is outside 12 .. 36000 s"},
      {"modules=5.5", "modules: '5.5' is not a whole number"},
      {"modules=five", "modules: 'five' is not a whole number"},
      {"modules=101", "modules: 101 is outside 2 .. 100"},
      {"budget=0", "budget: 0 is outside 1 .. 10000 min"},
      {"balls=60s,1", "balls: 1 is there twice"},
  };
  for (const auto& c : cases) {
    EXPECT_NE(axis_refusal(c.text).find(c.message), std::string::npos)
        << c.text << ": " << axis_refusal(c.text);
  }
}

// Budgets share a cell's experiments; other amounts of data have others, whatever else is on the
// grid.
TEST(GridCells, HaveSeedsOfTheirOwn) {
  GridOptions options;
  options.proof.diagnosis.seed = 23, options.proof.diagnosis.out = "g";
  const GridCell cell{60, 240, 15, 1};
  const auto seed = [&](const GridCell& of) { return proof_of(options, of).diagnosis.seed; };
  EXPECT_EQ(seed(cell), seed({60, 240, 15, 10}));
  EXPECT_NE(seed(cell), seed({240, 60, 15, 1}));
  EXPECT_NE(seed(cell), seed({60, 240, 30, 1}));
  const std::uint64_t first = seed(cell);
  options.proof.diagnosis.seed = 24;
  EXPECT_NE(seed(cell), first);
  const ProofOptions p = proof_of(options, cell);
  EXPECT_EQ(p.diagnosis.out, "g/balls-1min_lilies-4min_modules-15_budget-1");
  EXPECT_EQ(p.worlds, 40);
  EXPECT_EQ(p.only, "null");
}

ProofWorld judged(Verdict verdict, const std::vector<std::string>& effects = {}) {
  ProofWorld w;
  w.kind = "null", w.verdict = verdict;
  for (const std::string& effect : effects) w.findings.push_back({effect, {}, "", 5});
  return w;
}

TEST(GridReport, CountsInsufficientExperimentsByThemselves) {
  Proof proof, none;
  proof.worlds = {judged(Verdict::complete),  judged(Verdict::complete),
                  judged(Verdict::undecided), judged(Verdict::missing, {"coriolis", "wake"}),
                  judged(Verdict::undecided), judged(Verdict::insufficient)};
  proof.worlds.back().shortfalls = {Requirement::gusts};
  none.worlds = {judged(Verdict::insufficient), judged(Verdict::insufficient)};
  none.worlds[0].shortfalls = none.worlds[1].shortfalls = {Requirement::lily_time};
  none.worlds[0].shortfalls.push_back(Requirement::gusts);
  ProofGrid grid{72, {grid_row({20, 20, 5, 1}, 7, none), grid_row({240, 240, 15, 1}, 8, proof)}};
  const std::string csv = grid_csv(grid);
  EXPECT_NE(csv.find("\n20,20,5,1,7,2,2,0,0,,,,,time of the Lilies; gusts x 1,"), std::string::npos)
      << csv;
  EXPECT_NE(csv.find("\n240,240,15,1,8,6,1,2,3,0.6,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",coriolis + wake; undecided x 2,gusts,"), std::string::npos) << csv;
  const std::string text = report_text(grid_report(grid));
  EXPECT_TRUE(text.starts_with("False positives by the amount of data: 2 of 72 cells finished\n"))
      << text;
  EXPECT_NE(text.find("3 of 5 (95 %: 23.1 to 88.2 %)"), std::string::npos) << text;
  EXPECT_NE(text.find("3 of 8"), std::string::npos) << text;  // insufficient
}

// A cell that too few balls make insufficient: killed and resumed, with the same bytes.
TEST(ProofGrid, ResumesAndReportsInsufficientCells) {
  const TemporaryDirectory here;
  GridOptions options;
  options.axes = {{1, 10}, {2}, {12}, {6}};
  options.experiments = 2;
  DiagnosisOptions& d = options.proof.diagnosis;
  d.out = here.path("g"), d.threads = 2;
  std::atomic<bool> stop = false;
  d.stop = &stop;
  d.progress = [&](double, const std::string&) { stop = true; };
  EXPECT_THROW(prove_grid(options), Stopped);
  stop = false, d.progress = nullptr;
  int finished = 0;
  options.finished = [&](const ProofGrid&) { finished += 1; };
  const ProofGrid grid = prove_grid(options);
  EXPECT_EQ(finished, 2);
  ASSERT_EQ(grid.rows.size(), 2u);
  for (const GridRow& row : grid.rows) {
    EXPECT_EQ(row.insufficient, 2);
    EXPECT_EQ(row.unmet.at(Requirement::measured_cells), 2);
    EXPECT_EQ(row.unmet.at(Requirement::lily_time), 2);
  }
  d.out = here.path("other");
  EXPECT_EQ(grid_csv(prove_grid(options)), grid_csv(grid));
  d.out = here.path("g"), options.finished = nullptr;
  EXPECT_EQ(grid_csv(prove_grid(options)), grid_csv(grid));
  d.stop = nullptr, d.seed = 2;
  EXPECT_THROW(prove_grid(options), InputError);
}

}  // namespace
}  // namespace lilytank
