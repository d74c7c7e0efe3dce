// Experiment files: a scenario and what was recorded in it.
#include "lilytank/experiment.hpp"

#include <gtest/gtest.h>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

class Experiments : public testing::Test {
 protected:
  Experiments() {
    write_recording(circling(3, 60, 30, false), here_.path("balls.csv.gz"));
    write_recording(circling(2, 60), here_.path("lilies.csv"));
  }
  std::string write(const std::string& text, const std::string& name = "experiment.toml") {
    return here_.write(name, text);
  }
  std::string complaint(const std::string& text) {
    try {
      load_experiment({write(text)});
    } catch (const InputError& e) {
      const std::string what = e.what();
      return what.substr(what.find("experiment.toml"));
    }
    return "";
  }
  TemporaryDirectory here_;
  const std::string whole_ =
      "[experiment]\nname = \"two runs\"\n[tank]\nradius = 0.31\n[module]\nside = 0.036\n"
      "[ball]\nradius = \"14 mm\"\n"
      "[[recording]]\nfile = \"balls.csv.gz\"\nbody = \"ball\"\n"
      "[[recording]]\nfile = \"lilies.csv\"\nlatches = \"off\"\nheld_out = true\n";
};

TEST_F(Experiments, sayWhatWasRecorded) {
  const Experiment e = load_experiment({write(whole_)});
  EXPECT_EQ(e.name, "two runs");
  EXPECT_DOUBLE_EQ(e.base.model.tank.radius, 0.31);
  ASSERT_EQ(e.recordings.size(), 2u);
  EXPECT_EQ(e.recordings[0].body, BodyKind::ball);
  EXPECT_EQ(e.recordings[0].name, "balls");
  EXPECT_TRUE(e.recordings[0].latches);
  EXPECT_FALSE(e.recordings[0].held_out);
  EXPECT_EQ(e.recordings[0].tracks.size(), 3u);
  EXPECT_EQ(e.recordings[1].body, BodyKind::lily);
  EXPECT_FALSE(e.recordings[1].latches);
  EXPECT_TRUE(e.recordings[1].held_out);
  EXPECT_TRUE(e.recordings[1].has_heading());
  EXPECT_DOUBLE_EQ(e.sources[0].options.tank_radius, 0.31);
  EXPECT_DOUBLE_EQ(e.sources[0].options.body_radius, 0.014);
  EXPECT_DOUBLE_EQ(e.sources[1].options.body_radius, 0.018);
}

TEST_F(Experiments, onlyWhatIsWantedIsRead) {
  here_.write("lilies.csv", "damaged");
  const Experiment e = load_experiment({write(whole_)}, {}, [](const RecordingSource& s) {
    return s.options.body == BodyKind::ball;
  });
  EXPECT_EQ(e.sources.size(), 2u);
  EXPECT_EQ(e.recordings.size(), 1u);
  EXPECT_THROW(load_experiment({write(whole_)}), InputError);
}

TEST_F(Experiments, layersAndSetsAreThoseOfScenarios) {
  write(whole_);
  const std::string over =
      here_.write("more/over.toml",
                  "base = \"../experiment.toml\"\n[forces.damping]\nD_linear = 0.3\n"
                  "[[recording]]\nfile = \"../lilies.csv\"\n");
  const Experiment e = load_experiment({over}, {"tank.radius=0.32"});
  EXPECT_EQ(e.name, "two runs");
  EXPECT_DOUBLE_EQ(e.base.model.tank.radius, 0.32);
  ASSERT_EQ(e.sources.size(), 1u);  // recordings of a later file replace those before
  EXPECT_EQ(e.recordings[0].tracks.size(), 2u);
  // A scenario laid over an experiment leaves its recordings.
  const std::string scenario = here_.write("s.toml", "[module]\nmass = 0.04\n");
  EXPECT_EQ(load_experiment({over, scenario}).recordings.size(), 1u);
}

// In front: where none is marked as held out, the last recordings are, and these stay the same.
TEST_F(Experiments, furtherRecordingsAreAddedInFront) {
  write_recording(circling(1, 90), here_.path("alone.csv"));
  const std::string more = write(
      "[experiment]\nname = \"three runs\"\nfurther = true\n[[recording]]\nfile = \"alone.csv\"\n",
      "more.toml");
  const Experiment e = load_experiment({write(whole_), more});
  EXPECT_EQ(e.name, "three runs");
  ASSERT_EQ(e.recordings.size(), 3u);
  EXPECT_EQ(e.recordings[0].tracks.size(), 1u);
  EXPECT_EQ(e.recordings[1].body, BodyKind::ball);
  EXPECT_EQ(load_experiment({more}).recordings.size(), 1u);
  EXPECT_EQ(complaint("[experiment]\nfurther = 1\n[[recording]]\nfile = \"alone.csv\"\n"),
            "experiment.toml:2:11: experiment.further is \"on\" or \"off\", or true or false");
}

TEST_F(Experiments, areScenarios) {
  const Scenario s = load_scenario({write(whole_)}, {});
  EXPECT_DOUBLE_EQ(s.model.tank.radius, 0.31);
}

TEST_F(Experiments, defaultsForAllRecordings) {
  const Experiment e = load_experiment(
      {write("[experiment]\nrate = 30\nchecks.gap = \"split\"\nchecks.longest_gap = \"0.5 s\"\n"
             "[[recording]]\nfile = \"balls.csv.gz\"\nbody = \"ball\"\ntank_circle = [0, 0, 0.3]\n"
             "checks = {gap = \"keep\", fastest = \"3 m/s\"}\n"
             "[[recording]]\nfile = \"lilies.csv\"\norigin = [0.0, 0.001]\nname = \"second\"\n")});
  EXPECT_EQ(e.name, "experiment");  // the file's
  EXPECT_EQ(e.sources[0].options.rules[Check::gap], Treatment::keep);
  EXPECT_DOUBLE_EQ(e.sources[0].options.rules.fastest, 3);
  EXPECT_DOUBLE_EQ(e.sources[0].options.rules.longest_gap, 0.5);
  EXPECT_EQ(e.sources[1].options.rules[Check::gap], Treatment::split);
  EXPECT_DOUBLE_EQ(e.sources[1].options.rate, 30);
  EXPECT_EQ(e.recordings[1].name, "second");
}

TEST_F(Experiments, mistakesAreNamedWithTheirPlace) {
  EXPECT_TRUE(complaint("[tank]\nradius = 0.3\n").find("there is no [[recording]] in it") !=
              std::string::npos);
  EXPECT_EQ(complaint("[[recording]]\nbody = \"ball\"\n"),
            "experiment.toml:1:1: recording.file is missing: the file of the tracks");
  EXPECT_EQ(complaint("[[recording]]\nfile = \"balls.csv.gz\"\nbodi = \"ball\"\n"),
            "experiment.toml:3:1: unknown key 'recording.bodi' - did you mean 'body'?");
  EXPECT_EQ(complaint("[[recording]]\nfile = \"balls.csv.gz\"\nbody = \"bal\"\n"),
            "experiment.toml:3:8: recording.body = \"bal\" is none of lily, ball, point - did you "
            "mean 'ball'?");
  EXPECT_EQ(complaint("[[recording]]\nfile = \"a.csv\"\nlatches = \"open\"\n"),
            "experiment.toml:3:11: recording.latches is \"on\" or \"off\", or true or false");
  EXPECT_EQ(complaint("[[recording]]\nfile = \"a.csv\"\ntank_circle = [1, 2]\n"),
            "experiment.toml:3:15: recording.tank_circle is [x, y, radius] of the tank in the "
            "file's units");
  EXPECT_EQ(complaint("[[recording]]\nfile = \"a.csv\"\nchecks.jump = \"mend\"\n"),
            "experiment.toml:3:15: recording.checks.jump = \"mend\" is none of keep, mark, split, "
            "refuse");
  EXPECT_EQ(complaint("[recording]\nfile = \"a.csv\"\n"),
            "experiment.toml:1:1: recording is a list of tables, each under its own line "
            "[[recording]]");
  EXPECT_EQ(complaint("experiment = 1\n"),
            "experiment.toml:1:14: experiment is a table, under the line [experiment]");
  EXPECT_TRUE(complaint("[tank]\nradius = 300\n[[recording]]\nfile = \"balls.csv.gz\"\n")
                  .starts_with("experiment.toml:2:10: tank.radius = 300 m is outside 0.05 .. 5 m - "
                               "if this is in mm, write \"300 mm\""));
  EXPECT_THROW(load_experiment({write(whole_)}, {"experiment.name=x"}), InputError);
}

TEST_F(Experiments, aMissingFileIsNamedWhereItIsAskedFor) {
  const std::string what = complaint("[[recording]]\nfile = \"none.csv\"\n");
  EXPECT_TRUE(what.starts_with("experiment.toml:2:8: cannot read")) << what;
}

TEST_F(Experiments, aRefusedRecordingIsNotRead) {
  std::string text = here_.read("lilies.csv");
  here_.write("lilies.csv", text + text.substr(text.rfind('\n', text.size() - 2) + 1));
  EXPECT_THROW(load_experiment({write(whole_)}), InputError);
  const Experiment e = load_experiment({write(whole_ + "checks.duplicate = \"keep\"\n")});
  EXPECT_EQ(e.findings.size(), 1u);
}

TEST(Experiment, examplesCanBeRead) {
  const std::string folder = LILYTANK_SOURCE_DIR "/scenarios/experiments/";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename());
    ++count;
    const Experiment e = load_experiment({entry.path().string()});
    EXPECT_FALSE(e.recordings.empty());
    for (const Finding& f : e.findings) EXPECT_EQ(f.check, Check::gap) << f.text();
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace lilytank
