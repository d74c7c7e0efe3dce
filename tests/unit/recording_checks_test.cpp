// What the checks find, where they say it is, and what is done about it.
#include <gtest/gtest.h>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

/// Changes to a file of circling bodies before it is read.
class Checks : public testing::Test {
 protected:
  CheckedRecording check(const std::string& text = "") {
    if (text.empty()) {
      write_recording(truth_, here_.path("tracks.csv"));
    } else {
      here_.write("tracks.csv", text);
    }
    return check_recording(here_.path("tracks.csv"), options_);
  }
  std::string text() {
    write_recording(truth_, here_.path("tracks.csv"));
    return here_.read("tracks.csv");
  }
  void unsee(std::size_t track, int from, int to) {
    for (int f = from; f <= to; ++f) truth_.tracks[track].x[static_cast<std::size_t>(f)] = NAN;
  }
  /// The line of a frame's row of a body, if all bodies are in all frames.
  int line(int frame, int body) const {
    return 2 + frame * static_cast<int>(truth_.tracks.size()) + body;
  }
  /// Exactly one finding, of this kind and place.
  static void expect_one(const CheckedRecording& c, Check check, std::int64_t frame,
                         std::int64_t id, Treatment treatment) {
    ASSERT_EQ(c.findings.size(), 1u) << all_texts(c);
    const Finding& f = c.findings[0];
    EXPECT_EQ(f.check, check) << f.text();
    EXPECT_EQ(f.frame, frame) << f.text();
    EXPECT_EQ(f.id, id) << f.text();
    EXPECT_EQ(f.treatment, treatment) << f.text();
  }

  Recording truth_ = circling(5, 300);
  RecordingOptions options_;
  TemporaryDirectory here_;
};

TEST_F(Checks, nothingIsFoundInWhatIsRight) {
  const CheckedRecording c = check();
  EXPECT_EQ(all_texts(c), "");
  expect_same_tracks(truth_, c.recording);
}

TEST_F(Checks, shortGapsAreHolesLongOnesCut) {
  unsee(1, 100, 103);
  unsee(3, 50, 60);
  const CheckedRecording c = check();
  ASSERT_EQ(c.findings.size(), 2u) << all_texts(c);
  EXPECT_EQ(c.findings[0].frame, 50);
  EXPECT_EQ(c.findings[0].id, 3);
  EXPECT_EQ(c.findings[0].treatment, Treatment::split);
  EXPECT_EQ(c.findings[0].what, "not seen in 11 frames, 0.367 s");
  EXPECT_EQ(c.findings[1].frame, 100);
  EXPECT_EQ(c.findings[1].treatment, Treatment::mark);
  ASSERT_EQ(c.recording.tracks.size(), 6u);
  EXPECT_EQ(c.recording.tracks[3].last(), 49);
  EXPECT_EQ(c.recording.tracks[4].first, 61);
  EXPECT_EQ(c.recording.tracks[4].id, 3);
  EXPECT_TRUE(std::isnan(c.recording.tracks[1].x[101]));
  EXPECT_TRUE(std::isnan(c.recording.tracks[1].theta[101]));
}

TEST_F(Checks, gapsAreTreatedAsAsked) {
  unsee(3, 50, 60);
  options_.rules[Check::gap] = Treatment::keep;
  EXPECT_EQ(check().recording.tracks.size(), 5u);
  options_.rules[Check::gap] = Treatment::split;
  EXPECT_EQ(check().recording.tracks.size(), 6u);
  options_.rules[Check::gap] = Treatment::refuse;
  const CheckedRecording refused = check();
  EXPECT_TRUE(refused.refused());
  EXPECT_TRUE(refused.recording.tracks.empty());
  EXPECT_THROW(refused.throw_if_refused(), InputError);
}

TEST_F(Checks, aFrameThatHoldsNothingIsNamedOnce) {
  for (std::size_t t = 0; t < 5; ++t) unsee(t, 120, 121);
  expect_one(check(), Check::gap, 120, -1, Treatment::mark);
}

TEST_F(Checks, duplicatesRefuse) {
  const CheckedRecording c = check(text() + "200,6.6667,2,0.1,0.1,0\n");
  expect_one(c, Check::duplicate, 200, 2, Treatment::refuse);
  EXPECT_EQ(c.findings[0].place.line, 2 + 5 * 300);
  EXPECT_NE(c.findings[0].what.find("in line " + std::to_string(line(200, 2))), std::string::npos);
  options_.rules[Check::duplicate] = Treatment::mark;
  EXPECT_TRUE(std::isnan(check(text() + "200,6.6667,2,0.1,0.1,0\n").recording.tracks[2].x[200]));
}

TEST_F(Checks, aSingleSightingFarOffIsMarked) {
  truth_.tracks[2].x[80] += 0.05;
  const CheckedRecording c = check();
  expect_one(c, Check::spike, 80, 2, Treatment::mark);
  EXPECT_EQ(c.findings[0].place.line, line(80, 2));
  EXPECT_TRUE(std::isnan(c.recording.tracks[2].x[80]));
  EXPECT_FALSE(std::isnan(c.recording.tracks[2].x[79]));
  EXPECT_FALSE(std::isnan(c.recording.tracks[2].x[81]));
}

TEST_F(Checks, aTrackThatGoesOnElsewhereIsCut) {
  for (std::size_t f = 150; f < 300; ++f) truth_.tracks[0].x[f] += 0.06;
  const CheckedRecording c = check();
  expect_one(c, Check::jump, 150, 0, Treatment::split);
  ASSERT_EQ(c.recording.tracks.size(), 6u);
  EXPECT_EQ(c.recording.tracks[0].last(), 149);
  EXPECT_EQ(c.recording.tracks[1].first, 150);
}

TEST_F(Checks, exchangedBodiesAreNamedAndCutNotExchangedBack) {
  for (std::size_t f = 222; f < 300; ++f) {
    std::swap(truth_.tracks[1].x[f], truth_.tracks[2].x[f]);
    std::swap(truth_.tracks[1].y[f], truth_.tracks[2].y[f]);
    std::swap(truth_.tracks[1].theta[f], truth_.tracks[2].theta[f]);
  }
  const CheckedRecording c = check();
  ASSERT_EQ(c.findings.size(), 2u) << all_texts(c);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(c.findings[i].check, Check::swap);
    EXPECT_EQ(c.findings[i].frame, 222);
    EXPECT_EQ(c.findings[i].id, static_cast<int>(i) + 1);
  }
  EXPECT_NE(c.findings[0].what.find("in the place of id 2"), std::string::npos);
  ASSERT_EQ(c.recording.tracks.size(), 7u);
  EXPECT_EQ(c.recording.tracks[2].id, 1);
  EXPECT_DOUBLE_EQ(c.recording.tracks[2].x[0], std::round(1e7 * truth_.tracks[1].x[222]) / 1e7);
}

TEST_F(Checks, aSwapAcrossAGapIsFound) {
  for (std::size_t f = 200; f < 300; ++f) {
    std::swap(truth_.tracks[3].x[f], truth_.tracks[4].x[f]);
    std::swap(truth_.tracks[3].y[f], truth_.tracks[4].y[f]);
  }
  unsee(3, 199, 201);
  unsee(4, 200, 200);
  options_.rules.least_turn = 4;  // headings were not exchanged
  EXPECT_EQ(of_kind(check(), Check::swap).size(), 2u);
}

TEST_F(Checks, speedsThatNoBodyHas) {
  // Evenly fast, so no step stands out from the others: round a circle of 10 cm at 3 m/s.
  for (std::size_t f = 0; f < 300; ++f) {
    truth_.tracks[4].x[f] = 0.1 * std::cos(1.0 * static_cast<double>(f));
    truth_.tracks[4].y[f] = 0.1 * std::sin(1.0 * static_cast<double>(f));
  }
  options_.rules.least_jump = 1;
  const CheckedRecording c = check();
  EXPECT_EQ(of_kind(c, Check::speed).size(), 299u);
  EXPECT_EQ(c.findings.size(), 299u);
  EXPECT_EQ(c.recording.tracks.size(), 4u + 300u);
}

TEST_F(Checks, bodiesOutsideTheTank) {
  options_.tank_radius = 0.224, options_.body_radius = 0.0175;
  options_.rules.beyond_tank = 0.005;
  // The outermost circle, of 21 cm, is 3.5 mm beyond where a centre may be, and allowed.
  EXPECT_EQ(all_texts(check()), "");
  for (std::size_t f = 30; f < 40; ++f)
    truth_.tracks[4].x[f] *= 1.05, truth_.tracks[4].y[f] *= 1.05;
  const CheckedRecording c = check();
  const auto outside = of_kind(c, Check::outside);
  ASSERT_EQ(outside.size(), 1u) << all_texts(c);
  EXPECT_EQ(outside[0].frame, 30);
  EXPECT_EQ(outside[0].id, 4);
  EXPECT_NE(outside[0].what.find("up to frame 39"), std::string::npos) << outside[0].what;
  options_.in_tank = false;
  EXPECT_TRUE(of_kind(check(), Check::outside).empty());
}

TEST_F(Checks, unevenClocks) {
  // The camera missed a frame after number 200 without counting it.
  std::string table = "frame,time,id,x,y\n";
  for (int f = 0; f < 301; ++f) {
    const double time = (f > 200 ? f + 1 : f) / 25.0;
    table += std::to_string(f) + "," + std::to_string(time) + ",0,0.1,0\n";
  }
  CheckedRecording c = check(table);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_TRUE(c.refused());
  EXPECT_EQ(c.findings[0].check, Check::clock);
  EXPECT_EQ(c.findings[0].frame, 201) << all_texts(c);
  EXPECT_NE(c.findings[0].what.find("40 ms) late on a clock of 25 frames/s"), std::string::npos)
      << all_texts(c);
  options_.rules[Check::clock] = Treatment::split;
  c = check(table);
  ASSERT_EQ(c.recording.tracks.size(), 2u);
  EXPECT_EQ(c.recording.tracks[1].first, 201);
  // Or the times count, and the frame is missing.
  options_.rules[Check::clock] = Treatment::refuse;
  options_.columns.frame = "-";
  c = check(table);
  expect_one(c, Check::gap, 201, -1, Treatment::mark);
  EXPECT_EQ(c.recording.frames, 302);
}

TEST_F(Checks, oneWrongTime) {
  std::string table = text();
  const auto at = table.find("\n77,") + 4;
  table.replace(at, table.find(',', at) - at, "2.6");
  options_.rules[Check::clock] = Treatment::mark;
  const CheckedRecording c = check(table);
  const auto found = of_kind(c, Check::clock);
  ASSERT_EQ(found.size(), 1u) << all_texts(c);
  EXPECT_EQ(found[0].frame, 77);
  EXPECT_EQ(found[0].place.line, line(77, 0));
}

TEST_F(Checks, roundedTimesAreNoUnevenClock) {
  // Milliseconds at 29.97 frames/s.
  std::string table = "frame,time,id,x,y\n";
  for (int f = 0; f < 3000; ++f) {
    char row[80];
    std::snprintf(row, sizeof row, "%d,%.3f,0,0.1,0\n", f, f * 1001 / 30000.0);
    table += row;
  }
  const CheckedRecording c = check(table);
  EXPECT_EQ(all_texts(c), "");
  EXPECT_NEAR(c.recording.rate, 30000 / 1001.0, 1e-4);
  // And without frame numbers, where 33 and 34 ms alternate.
  options_.columns.frame = "-";
  const CheckedRecording by_time = check(table);
  EXPECT_EQ(all_texts(by_time), "");
  EXPECT_EQ(by_time.recording.frames, 3000);
}

TEST_F(Checks, wrongUnitsOfLength) {
  for (const auto& [scale, hint] : {std::pair{1000.0, "if lengths are in mm, say pixel = \"1 mm\""},
                                    {100.0, "if lengths are in cm, say pixel = \"1 cm\""}}) {
    truth_ = circling(5, 300);
    for (Track& t : truth_.tracks) {
      for (std::size_t i = 0; i < t.x.size(); ++i) t.x[i] *= scale, t.y[i] *= scale;
    }
    const CheckedRecording c = check();
    expect_one(c, Check::units, -1, -1, Treatment::refuse);
    EXPECT_NE(c.findings[0].what.find(hint), std::string::npos) << c.findings[0].what;
  }
}

// A body every half minute would be anywhere in the tank: the times count something else.
TEST_F(Checks, wrongUnitsOfTime) {
  for (const auto& [scale, hint] :
       {std::pair{1e-3, "say time_unit = \"1 ms\""}, {1e-6, "say time_unit = \"1 us\""}}) {
    options_ = {};
    truth_ = circling(5, 300);
    truth_.rate *= scale;
    const CheckedRecording c = check();
    expect_one(c, Check::units, -1, -1, Treatment::refuse);
    EXPECT_NE(c.findings[0].what.find(hint), std::string::npos) << c.findings[0].what;
    options_.time_unit = scale;
    const CheckedRecording told = check();
    EXPECT_EQ(of_kind(told, Check::units).size(), 0u) << all_texts(told);
    EXPECT_NEAR(told.recording.rate, 30, 1e-3);
  }
  options_ = {};
  truth_.rate = 0.1;
  const CheckedRecording slow = check();
  EXPECT_EQ(of_kind(slow, Check::units).at(0).what,
            "frames are 10 s apart; if times are in ms, say time_unit = \"1 ms\"; if that is so, "
            "say time_unit = \"1 s\"");
  options_.time_unit = 1;
  EXPECT_EQ(of_kind(check(), Check::units).size(), 0u);
  options_.time_unit.reset();
  options_.rate = 0.1;  // the user knows
  EXPECT_EQ(of_kind(check(), Check::units).size(), 0u);
  options_.rate = 0, options_.rules[Check::units] = Treatment::keep;
  EXPECT_NEAR(check().recording.rate, 0.1, 1e-6);
  options_.rules = {}, options_.in_tank = false;
  EXPECT_EQ(of_kind(check(), Check::units).size(), 0u);
}

TEST_F(Checks, wrongOrigin) {
  for (Track& t : truth_.tracks) {
    for (std::size_t i = 0; i < t.x.size(); ++i) t.x[i] += 0.31, t.y[i] += 0.29;
  }
  const CheckedRecording c = check();
  expect_one(c, Check::units, -1, -1, Treatment::refuse);
  EXPECT_NE(c.findings[0].what.find("the tank's centre seems to be near [0.3"), std::string::npos)
      << c.findings[0].what;
}

TEST_F(Checks, degrees) {
  for (Track& t : truth_.tracks) {
    for (double& theta : t.theta) theta = std::fmod(theta * 180 / kPi, 360);
  }
  // Written as if radians, they would be wrapped.
  std::string table = "frame,time,id,x,y,theta\n";
  for (int f = 0; f < 300; ++f) {
    for (int b = 0; b < 5; ++b) {
      const Track& t = truth_.tracks[static_cast<std::size_t>(b)];
      const auto i = static_cast<std::size_t>(f);
      table += std::to_string(f) + "," + std::to_string(f / 30.0) + "," + std::to_string(b) + "," +
               std::to_string(t.x[i]) + "," + std::to_string(t.y[i]) + "," +
               std::to_string(t.theta[i]) + "\n";
    }
  }
  const CheckedRecording c = check(table);
  ASSERT_EQ(of_kind(c, Check::units).size(), 1u) << all_texts(c);
  EXPECT_NE(c.findings[0].what.find("say angle_unit = \"deg\""), std::string::npos);
  options_.calibration.angles = AngleUnit::degrees;
  EXPECT_EQ(all_texts(check(table)), "");
}

TEST_F(Checks, wholeTurnsAreContinuedOthersCut) {
  // Wrapping at another place is no finding.
  for (Track& t : truth_.tracks) {
    for (double& theta : t.theta) theta -= 2 * kPi * std::floor(theta / (2 * kPi) - 0.3);
  }
  EXPECT_EQ(all_texts(check()), "");
  // Head taken for tail from frame 60 on.
  for (std::size_t f = 60; f < 300; ++f) truth_.tracks[1].theta[f] += kPi;
  CheckedRecording c = check();
  expect_one(c, Check::heading, 60, 1, Treatment::split);
  EXPECT_NE(c.findings[0].what.find("half a turn"), std::string::npos);
  // And for a single frame.
  truth_ = circling(5, 300);
  truth_.tracks[1].theta[60] += kPi / 2;
  c = check();
  expect_one(c, Check::spike, 60, 1, Treatment::mark);
}

TEST_F(Checks, sightingsWithoutTheHeadingThatOthersHave) {
  const std::string head = "frame,time,id,x,y,theta\n";
  const CheckedRecording c = check(head +
                                   "0,0,4,0.1,0,1\n1,0.04,4,0.1,0,\n2,0.08,4,0.1,0,nan\n"
                                   "3,0.12,4,0.1,0,1\n");
  expect_one(c, Check::heading, 1, 4, Treatment::mark);
  EXPECT_TRUE(std::isnan(c.recording.tracks[0].x[2]));
  // If none has one, there is no column of headings.
  EXPECT_EQ(all_texts(check(head + "0,0,4,0.1,0,\n1,0.04,4,0.1,0,\n")), "");
}

TEST_F(Checks, findingsSayWhereAndWhat) {
  truth_.tracks[2].x[80] += 0.05;
  const CheckedRecording c = check();
  const std::string text = c.findings.at(0).text();
  EXPECT_TRUE(
      text.ends_with("tracks.csv:404: frame 80, id 2, spike: 50.2 mm from the line between "
                     "the sightings around it (marked)"))
      << text;
}

TEST_F(Checks, manyFindingsOfAKindAreCounted) {
  for (const std::size_t frame : {20, 40, 60, 80}) truth_.tracks[2].x[frame] += 0.05;
  const CheckedRecording c = check();
  const std::vector<std::string> texts = finding_texts(c.findings, 3);
  ASSERT_EQ(texts.size(), 4u);
  EXPECT_EQ(texts[2], c.findings[2].text());
  EXPECT_TRUE(texts[3].ends_with("tracks.csv: spike: 1 more findings")) << texts[3];
  EXPECT_EQ(finding_texts(c.findings, 4).size(), 4u);
}

TEST_F(Checks, framesAreCalledByTheirNumbersInTheFile) {
  std::string table = "frame,time,id,x,y\n";
  for (int f = 1000; f < 1100; ++f) {
    table += std::to_string(f) + "," + std::to_string(f / 30.0) + ",7," +
             (f == 1050 ? "0.2" : "0.1") + ",0\n";
  }
  const CheckedRecording c = check(table);
  expect_one(c, Check::spike, 1050, 7, Treatment::mark);
  EXPECT_EQ(c.recording.tracks[0].first, 0);
  EXPECT_NEAR(c.recording.start, 1000 / 30.0, 1e-3);
}

TEST(PracticeRecordings, haveNoFindings) {
  const std::string folder = LILYTANK_SOURCE_DIR "/../shared/recordings/practice/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no practice recordings beside the tree";
  for (const char* world : {"tank", "world_b", "world_c", "world_d", "world_e", "world_f"}) {
    RecordingOptions options;
    options.body_radius = 0.0175;
    const CheckedRecording c = check_recording(folder + world + "/lily_1.csv.gz", options);
    EXPECT_EQ(all_texts(c), "");
    EXPECT_EQ(c.recording.tracks.size(), 15u);
    EXPECT_DOUBLE_EQ(c.recording.rate, 30);
  }
}

}  // namespace
}  // namespace lilytank
