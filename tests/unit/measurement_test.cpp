// Recordings that are at fault are told as such, before any force is looked for.
#include <gtest/gtest.h>

#include <cmath>

#include "lilytank/diagnosis.hpp"
#include "lilytank/emulator.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

// Two Lilies, which are both unseen for a second of every two: tracks end and begin there.
Experiment with_holes() {
  Experiment e;
  e.name = "holes";
  e.base = load_scenario({LILYTANK_SOURCE_DIR "/scenarios/tank_lilies.toml"}, {});
  RecordingShape shape;
  shape.bodies = 2, shape.frames = 300, shape.name = "lily";
  e.recordings = Emulator(e.base.model, {}, {shape}).record({}, 1).value();
  std::vector<Track> pieces;
  for (const Track& t : e.recordings[0].tracks) {
    for (int first = 0; first + 30 <= 300; first += 60) {
      Track piece = t;
      piece.first = first;
      for (auto* of : {&piece.x, &piece.y, &piece.theta}) {
        of->erase(of->begin(), of->begin() + first);
        of->resize(30);
      }
      pieces.push_back(piece);
    }
  }
  e.recordings[0].tracks = pieces;
  e.recordings[0].latches = false;
  return e;
}

TEST(Measurement, bodiesThatAreUnseenForLongAreTold) {
  const Diagnosis d = diagnose(with_holes(), {});
  EXPECT_EQ(d.verdict, Verdict::measurement);
  ASSERT_EQ(d.findings.size(), 1u);
  EXPECT_EQ(d.findings[0].effect, "lost_frames");
  EXPECT_EQ(d.findings[0].text, "bodies are unseen in 50 % of the frames");
  const std::string text = diagnosis_text(d);
  EXPECT_NE(text.find("1 recording of up to 2 Lilies"), std::string::npos) << text;
  EXPECT_NE(text.find("lost_frames  (depends on time)"), std::string::npos) << text;
}

// Balls may come and go, but within a track they must be seen.
TEST(Measurement, ballsThatFlickerAreTold) {
  Experiment e = with_holes();
  Recording balls = e.recordings[0];
  balls.body = BodyKind::ball;
  for (Track& t : balls.tracks) {
    for (std::size_t k = 1; k + 1 < t.x.size(); k += 2) t.x[k] = t.y[k] = std::nan("");
  }
  for (Track& t : e.recordings[0].tracks) t.first = 0;
  e.recordings[0].frames = 30;
  e.recordings.push_back(balls);
  const Diagnosis d = diagnose(e, {});
  EXPECT_EQ(d.verdict, Verdict::measurement);
  EXPECT_EQ(d.findings.at(0).text, "bodies are unseen in 47 % of the frames");
}

TEST(Measurement, replacesNoOtherDiagnosis) {
  const TemporaryDirectory here;
  DiagnosisOptions options;
  options.out = here.path("out");
  here.write("out/work/identity", "lilytank diagnosis of something else\n");
  here.write("out/missing.toml", "another's");
  const Experiment e = with_holes();
  EXPECT_THROW(diagnose(e, options), InputError);
  EXPECT_EQ(here.read("out/missing.toml"), "another's");
  options.force = true;
  EXPECT_EQ(diagnose(e, options).verdict, Verdict::measurement);
  EXPECT_FALSE(here.has("out/missing.toml"));
}

}  // namespace
}  // namespace lilytank
