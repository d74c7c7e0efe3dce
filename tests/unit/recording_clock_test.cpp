// Frame numbers with a common step, and times that tell nothing about frames.
#include <gtest/gtest.h>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

/// Rows of two bodies; the number of frame f is first + step f.
std::string numbered(int step, int first, const std::vector<int>& lost = {}, bool times = true) {
  std::string out = times ? "frame,time,id,x,y\n" : "frame,id,x,y\n";
  for (int f = 0; f < 80; ++f) {
    if (std::find(lost.begin(), lost.end(), f) != lost.end()) continue;
    for (int b = 0; b < 2; ++b) {
      char row[120];
      const double angle = 0.05 * f + 2 * b;
      std::snprintf(row, sizeof row, "%d,%s%d,%.5f,%.5f\n", first + step * f,
                    times ? (std::to_string(f / 6.0) + ",").c_str() : "", b, 0.1 * std::cos(angle),
                    0.1 * std::sin(angle) + 0.0001 * f);
      out += row;
    }
  }
  return out;
}

CheckedRecording read(const std::string& content, const RecordingOptions& options = {}) {
  const TemporaryDirectory here;
  return check_recording(here.write("tracks.csv", content), options);
}

void expect_equal(const Recording& a, const Recording& b) {
  EXPECT_DOUBLE_EQ(a.rate, b.rate);
  EXPECT_DOUBLE_EQ(a.start, b.start);
  EXPECT_EQ(a.frames, b.frames);
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  for (std::size_t t = 0; t < a.tracks.size(); ++t) {
    ASSERT_EQ(a.tracks[t].x.size(), b.tracks[t].x.size());
    for (std::size_t i = 0; i < a.tracks[t].x.size(); ++i) {
      const double p = a.tracks[t].x[i], q = b.tracks[t].x[i];
      EXPECT_TRUE(p == q || (std::isnan(p) && std::isnan(q)));
    }
  }
}

TEST(FrameNumbers, aCommonStepIsTakenIntoTheClock) {
  const CheckedRecording plain = read(numbered(1, 0, {31, 50, 51}));
  EXPECT_EQ(plain.frame_step, 1);
  for (const int step : {2, 5, 10}) {
    const CheckedRecording stepped = read(numbered(step, 40, {31, 50, 51}));
    EXPECT_EQ(stepped.frame_step, step);
    expect_equal(plain.recording, stepped.recording);
    // Findings have the file's numbers.
    EXPECT_EQ(of_kind(stepped, Check::gap).at(0).frame, 40 + 31 * step) << all_texts(stepped);
  }
}

TEST(FrameNumbers, areCountedAtTheRateThatIsGiven) {
  RecordingOptions options;
  options.rate = 30;
  const CheckedRecording c = read(numbered(5, 15, {}, false), options);
  EXPECT_DOUBLE_EQ(c.recording.rate, 6);
  EXPECT_DOUBLE_EQ(c.recording.start, 0.5);
  EXPECT_EQ(c.recording.frames, 80);
}

TEST(FrameNumbers, oneBetweenTheOthersIsNamed) {
  RecordingOptions options;
  options.rate = 30;
  const CheckedRecording c = read(numbered(5, 0, {}, false) + "402,0,0.1,0.0\n", options);
  EXPECT_EQ(c.frame_step, 1);
  const auto found = of_kind(c, Check::gap);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].treatment, Treatment::keep);
  EXPECT_NE(found[0].what.find("are 5 frames after the last one of their body"), std::string::npos);
  EXPECT_TRUE(of_kind(read(numbered(1, 0)), Check::gap).empty());
}

TEST(Times, thatAreWholeSecondsAreRefusedWithTheKey) {
  std::string framed = "frame,time,id,x,y\n", bare = "time,id,x,y\n";
  for (int f = 0; f < 60; ++f) {
    const std::string rest = std::to_string(f / 30) + ",0,0.1," + std::to_string(0.002 * f) + "\n";
    framed += std::to_string(f) + "," + rest, bare += rest;
  }
  EXPECT_NE(complaint(framed).find("times are whole seconds, and 30 frames share one: say "
                                   "columns.time = \"-\" and rate"),
            std::string::npos);
  EXPECT_NE(complaint(bare).find("a body is seen 30 times in one: the table needs a column of "
                                 "frame numbers"),
            std::string::npos);
  RecordingOptions options;
  options.columns.time = "-", options.rate = 30;
  EXPECT_EQ(complaint(framed, options), "");
}

TEST(Times, thatAreMinutesOrDaysAreRefusedWithTheKey) {
  for (const auto& [seconds, name] : {std::pair{60.0, "min"}, {3600.0, "h"}, {86400.0, "d"}}) {
    std::string table = "time,id,x,y\n";
    for (int f = 0; f < 50; ++f) {
      char row[80];
      std::snprintf(row, sizeof row, "%.12f,0,0.1,%.4f\n", f / 30.0 / seconds, 0.002 * f);
      table += row;
    }
    EXPECT_NE(complaint(table).find("say time_unit = \"1 " + std::string(name) + "\""),
              std::string::npos)
        << complaint(table);
  }
}

TEST(Times, thatAllLieWithinOneFrameAreRefused) {
  RecordingOptions options;
  options.rate = 30;
  for (const int bodies : {2, 3, 40}) {
    std::string table = "time,id,x,y\n";
    for (int b = 0; b < bodies; ++b) {
      table += std::to_string(2e-4 * b) + "," + std::to_string(b) + "," +
               std::to_string(0.005 * b) + ",0\n";
    }
    EXPECT_NE(complaint(table, options)
                  .find("its " + std::to_string(bodies) +
                        " times lie within one frame at 30 frames/s: check rate and time_unit"),
              std::string::npos)
        << complaint(table, options);
  }
}

TEST(Times, thatCountFrom1970CountFromTheFirstRow) {
  for (const auto& [first, seconds] :
       {std::pair{1700000000000, 1e-3}, {1700000000000000, 1e-6}, {1700000000000000000, 1e-9}}) {
    std::string table = "time,id,x,y\n";
    for (int f = 0; f < 50; ++f) {
      const auto count = static_cast<std::int64_t>(0.04 * f / seconds + 0.5);  // 25 frames/s
      table += std::to_string(first + count) + ",0,0.1," + std::to_string(0.002 * f) + "\n";
    }
    for (const bool given : {false, true}) {
      RecordingOptions options;
      if (given) options.time_unit = seconds;
      const CheckedRecording c = read(table, options);
      EXPECT_FALSE(c.refused()) << all_texts(c);
      EXPECT_DOUBLE_EQ(c.recording.rate, 25);
      EXPECT_DOUBLE_EQ(c.recording.start, 0);
      EXPECT_EQ(c.recording.frames, 50);
      EXPECT_EQ(c.times.find("(by their size)") == std::string::npos, given) << c.times;
    }
  }
}

}  // namespace
}  // namespace lilytank
