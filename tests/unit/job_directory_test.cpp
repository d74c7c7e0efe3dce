// Directories of results are one job's: nothing of another one is mixed with it or lost unasked.
#include "jobs/job_directory.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lilytank/calibration.hpp"
#include "lilytank/diagnosis.hpp"
#include "lilytank/error.hpp"
#include "lilytank/proof.hpp"
#include "lilytank/run.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

DirectoryJob job(const std::string& identity) {
  return {"diagnosis", identity, {"diagnosis.txt", "missing.toml"}};
}

// What claiming `out` is refused for, without the directory's name; "" if it is not.
std::string refusal(const TemporaryDirectory& here, const DirectoryJob& of, bool force = false) {
  try {
    const auto lock = claim_directory(here.path("out"), force, of);
    return "";
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find("out'") + 4);
  }
}

TEST(JobDirectory, isKeptForTheSameJobAndRefusedToOthers) {
  const TemporaryDirectory here;
  EXPECT_EQ(refusal(here, job("1")), "");
  here.write("out/work/nulls.rows", "kept");
  here.write("out/diagnosis.txt", "complete");
  EXPECT_EQ(refusal(here, job("1")), "");
  EXPECT_EQ(refusal(here, job("2")),
            " holds another diagnosis (other data, options or program)" + kChooseAnother);
  DirectoryJob other = job("1");
  other.kind = "proof";
  EXPECT_EQ(refusal(here, other), " holds a diagnosis" + kChooseAnother);
  EXPECT_EQ(here.read("out/work/nulls.rows"), "kept");
  EXPECT_EQ(here.read("out/diagnosis.txt"), "complete");
}

TEST(JobDirectory, forceRemovesAllThatTheOtherJobLeftAndNothingElse) {
  const TemporaryDirectory here;
  EXPECT_EQ(refusal(here, job("1")), "");
  for (const char* name : {"work/nulls.rows", "diagnosis.txt", "missing.toml", "notes.md"}) {
    here.write(std::string("out/") + name, "of 1");
  }
  EXPECT_EQ(refusal(here, job("2"), true), "");
  EXPECT_FALSE(here.has("out/work/nulls.rows"));
  EXPECT_FALSE(here.has("out/diagnosis.txt"));
  EXPECT_FALSE(here.has("out/missing.toml"));
  EXPECT_TRUE(here.has("out/notes.md"));
  EXPECT_EQ(refusal(here, job("2")), "");
}

TEST(JobDirectory, filesThatAreNobodysAreNotOverwritten) {
  const TemporaryDirectory here;
  here.write("out/missing.toml", "mine");
  here.write("out/work/thesis.tex", "mine");
  EXPECT_EQ(refusal(here, job("1")),
            " holds a file 'missing.toml' that is not of a diagnosis" + kChooseAnother);
  EXPECT_EQ(refusal(here, job("1"), true), "");
  EXPECT_TRUE(here.has("out/work/thesis.tex"));
}

TEST(JobDirectory, isOneProcessAtATime) {
  const TemporaryDirectory here;
  const auto lock = claim_directory(here.path("out"), false, job("1"));
  EXPECT_THROW(claim_directory(here.path("out"), false, job("1")), InputError);
  EXPECT_THROW(claim_directory(here.path("out"), true, job("1")), InputError);
}

// A caller who writes reports beside the results of a run keeps others out until they are written.
TEST(JobDirectory, aRunHandsOverItsLock) {
  const TemporaryDirectory here;
  here.write("still.toml", "run.duration = 0.1\nmodule.count = 2\nflow.source = \"still\"\n");
  const Scenario scenario = load_scenario({here.path("still.toml")}, {});
  RunOptions options;
  options.out = here.path("out");
  std::shared_ptr<const DirectoryLock> lock;
  options.lock = &lock;
  run(scenario, options);
  EXPECT_THROW(run(scenario, options), InputError);
  lock.reset();
  EXPECT_TRUE(run(scenario, options).already_complete);
}

// The lists are not derived from what is written: a file that was forgotten would survive --force.
TEST(JobDirectory, everyFileThatIsWrittenIsKnown) {
  const auto all_in = [](const std::vector<std::string>& written,
                         const std::vector<std::string>& known) {
    for (const std::string& name : written) {
      EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
    }
  };
  const TemporaryDirectory here;
  Diagnosis d;
  d.overlay = d.flow_csv = "x";
  d.maps.emplace_back(), d.ranking.emplace_back(), d.held_out.emplace_back();
  all_in(write_diagnosis(d, diagnosis_report(d), here.path("d")), diagnosis_files());
  CalibrationResult c;
  c.flow_csv = "x", c.msd.emplace_back();
  all_in(write_calibration(c, calibration_report(c), here.path("c")), calibration_files());
}

}  // namespace
}  // namespace lilytank
