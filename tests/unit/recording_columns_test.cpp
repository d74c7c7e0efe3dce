// What the columns of a table mean: every one is used, named as unused, or a reason to refuse.
#include <gtest/gtest.h>

#include "support/recordings.hpp"

namespace lilytank {
namespace {

RecordingOptions centred_pixels() {
  RecordingOptions options;
  options.rate = 25;
  options.calibration.has_origin = true;
  options.calibration.origin_x = 200, options.calibration.origin_y = 200;
  options.calibration.circle_radius = 150;  // 2 mm a pixel
  return options;
}

CheckedRecording columns_of(const std::string& content,
                            const RecordingOptions& options = centred_pixels()) {
  const TemporaryDirectory here;
  return check_recording(here.write("tracks.csv", content), options);
}

/// A wide table of two bodies on circles, at every `step`-th frame from 3 on but for those in
/// `lost`.
std::string wide_table(const std::string& head, int step, const std::vector<int>& lost = {}) {
  std::string out = head + "\n";
  for (int i = 0; i < 60; ++i) {
    if (std::find(lost.begin(), lost.end(), i) != lost.end()) continue;
    char row[120];
    const double a = 0.03 * i * step, b = 1 - 0.04 * i * step;
    std::snprintf(row, sizeof row, "%d,%.2f,%.2f,%.2f,%.2f\n", 3 + step * i, 200 + 60 * std::cos(a),
                  200 + 60 * std::sin(a), 200 + 30 * std::cos(b), 200 + 30 * std::sin(b));
    out += row;
  }
  return out;
}

TEST(WideTables, framesAreThoseOfTheirColumn) {
  for (const char* name : {"frame", "Frame", "frame_idx"}) {
    const CheckedRecording c =
        columns_of(wide_table(std::string(name) + ",x1,y1,x2,y2", 1, {20, 21, 22}));
    EXPECT_EQ(c.format, RecordingFormat::idtracker_wide);
    EXPECT_EQ(c.recording.frames, 60) << name;
    EXPECT_DOUBLE_EQ(c.recording.start, 3 / 25.0);
    EXPECT_TRUE(c.unused_columns.empty());
    EXPECT_TRUE(of_kind(c, Check::jump).empty()) << all_texts(c);
  }
  RecordingOptions options = centred_pixels();
  options.columns.frame = "picture";
  EXPECT_EQ(columns_of(wide_table("picture,x1,y1,x2,y2", 1, {20}), options).recording.frames, 60);
  options.columns.frame = "-";
  EXPECT_EQ(columns_of(wide_table("frame,x1,y1,x2,y2", 1, {20}), options).recording.frames, 59);
}

TEST(WideTables, unusedColumnsAreNamed) {
  const CheckedRecording c =
      columns_of("time,x1,y1,note\n0,200,200,a\n0.04,201,200,b\n0.08,202,200,c\n");
  EXPECT_EQ(c.unused_columns, std::vector<std::string>{"note"});
  EXPECT_NE(complaint("time,x1,y1,y2\n0,1,1,1\n", centred_pixels())
                .find("there is a column 'y2' but no 'x2'"),
            std::string::npos);
}

TEST(WideTables, identitiesBesideThemAreAContradiction) {
  RecordingOptions options = centred_pixels();
  options.format = RecordingFormat::idtracker_wide;
  const std::string boxes = "frame,id,x1,y1,x2,y2\n0,1,200,200,210,210\n1,1,201,200,211,210\n";
  EXPECT_NE(complaint(boxes, options).find("'id' looks like a column of identities"),
            std::string::npos);
  options.columns.id = "-";
  EXPECT_EQ(columns_of(boxes, options).recording.tracks.size(), 2u);
  EXPECT_NE(complaint("frame,id,x1,y1,x2,y2,x3,y3\n0,1,1,1,2,2,3,3\n", centred_pixels())
                .find("'id' looks like a column of identities"),
            std::string::npos);
}

TEST(WideTables, cornersOfABoxAreNoTwoBodies) {
  std::string table = "frame,x1,y1,x2,y2\n";
  for (int f = 0; f < 30; ++f) {
    const std::string x = std::to_string(150 + 3 * f), y = std::to_string(160 + f);
    const std::string right = std::to_string(171 + 3 * f), low = std::to_string(180 + f);
    table += std::to_string(f) + "," + x + "," + y + "," + right + "," + low + "\n";
  }
  EXPECT_NE(complaint(table, centred_pixels()).find("corners of a bounding box"),
            std::string::npos);
  RecordingOptions options = centred_pixels();
  options.format = RecordingFormat::boxes;
  const CheckedRecording box = columns_of(table, options);
  ASSERT_EQ(box.recording.tracks.size(), 1u);
  EXPECT_NEAR(box.recording.tracks[0].x[0], 0.002 * (160.5 - 200), 1e-12);
  EXPECT_NEAR(box.recording.tracks[0].y[0], -0.002 * (170 - 200), 1e-12);
  options.format = RecordingFormat::idtracker_wide;
  EXPECT_EQ(columns_of(table, options).recording.tracks.size(), 2u);
}

struct BoxLayout {
  const char* name;
  std::string head, first, second;  ///< two rows of a body; its middle is at (210, 190), (212, 190)
};

class Boxes : public testing::TestWithParam<BoxLayout> {};

TEST_P(Boxes, areReadAsTheirMiddle) {
  const CheckedRecording c =
      columns_of(GetParam().head + "\n" + GetParam().first + "\n" + GetParam().second + "\n");
  EXPECT_EQ(c.format, RecordingFormat::boxes);
  ASSERT_EQ(c.recording.tracks.size(), 1u);
  EXPECT_EQ(c.recording.tracks[0].id, 7);
  EXPECT_NEAR(c.recording.tracks[0].x[0], 0.02, 1e-12);
  EXPECT_NEAR(c.recording.tracks[0].x[1], 0.024, 1e-12);
  EXPECT_NEAR(c.recording.tracks[0].y[0], 0.02, 1e-12);  // pictures count down
}

INSTANTIATE_TEST_SUITE_P(
    layouts, Boxes,
    testing::Values(BoxLayout{"corners", "frame,id,x1,y1,x2,y2,conf", "4,7,200,185,220,195,0.9",
                              "5,7,202,185,222,195,0.9"},
                    BoxLayout{"fromZero", "frame,track_id,x0,y0,x1,y1", "4,7,200,185,220,195",
                              "5,7,202,185,222,195"},
                    BoxLayout{"leastAndMost", "frame_id,track_id,xmin,ymin,xmax,ymax,class",
                              "4,7,200,185,220,195,ball", "5,7,202,185,222,195,ball"},
                    BoxLayout{"size", "frame,id,bb_left,bb_top,bb_width,bb_height,conf",
                              "4,7,200,185,20,10,1", "5,7,202,185,20,10,1"},
                    BoxLayout{"middle", "frame,track,x_center,y_center,width,height",
                              "4,7,210,190,20,10", "5,7,212,190,20,10"}),
    [](const auto& layout) { return layout.param.name; });

TEST(BoundingBoxes, ofMotChallengeHaveNoNames) {
  const std::string table = "4,7,200,185,20,10,1,-1,-1,-1\n5,7,202,185,20,10,1,-1,-1,-1\n";
  EXPECT_NE(complaint(table, centred_pixels()).find("format = \"boxes\" reads frame, id, left"),
            std::string::npos);
  RecordingOptions options = centred_pixels();
  options.format = RecordingFormat::boxes;
  const CheckedRecording c = columns_of(table, options);
  ASSERT_EQ(c.recording.tracks.size(), 1u);
  EXPECT_NEAR(c.recording.tracks[0].x[1], 0.024, 1e-12);
}

TEST(BoundingBoxes, thatMayBeReadInTwoWaysAreRefused) {
  const std::string table = "frame,id,x,y,w,h\n4,7,200,185,20,10\n5,7,202,185,20,10\n";
  EXPECT_NE(complaint(table, centred_pixels()).find("middle of a box or a corner"),
            std::string::npos);
  RecordingOptions options = centred_pixels();
  options.format = RecordingFormat::boxes;
  EXPECT_NEAR(columns_of(table, options).recording.tracks[0].x[0], 0.02, 1e-12);
  options.format = RecordingFormat::table;
  EXPECT_NEAR(columns_of(table, options).recording.tracks[0].x[0], 0, 1e-12);
  EXPECT_NE(complaint("frame,id,x1,y1,x2,y2\n0,1,200,200,190,210\n", centred_pixels())
                .find("tracks.csv:2:13: x2 '190' is before the box's other corner, x1 '200'"),
            std::string::npos);
}

TEST(Identities, columnsThatLookLikeThemAreNotIgnored) {
  RecordingOptions options = centred_pixels();
  options.format = RecordingFormat::table;
  const std::string table = "frame,track,x,y\n0,1,200,200\n0,2,230,200\n1,1,201,200\n1,2,231,200\n";
  EXPECT_NE(complaint(table, options).find("columns.id = \"track\" reads it"), std::string::npos);
  EXPECT_NE(complaint(table, centred_pixels()).find("perhaps columns.id = \"track\""),
            std::string::npos);
  options.columns.id = "track";
  EXPECT_EQ(columns_of(table, options).recording.tracks.size(), 2u);
  options.columns.id = "-";
  EXPECT_EQ(columns_of(table, options).recording.tracks.size(), 2u);
  const CheckedRecording both =
      columns_of("frame,id,track_id,x,y\n0,1,5,200,200\n1,1,5,201,200\n2,1,5,202,200\n");
  ASSERT_EQ(both.findings.size(), 1u) << all_texts(both);
  EXPECT_EQ(both.findings[0].check, Check::columns);
  EXPECT_EQ(both.findings[0].treatment, Treatment::keep);
  EXPECT_NE(both.findings[0].what.find("'track_id' may be identities"), std::string::npos);
}

TEST(Identities, thatNumberRowsAreAFinding) {
  std::string table = "frame,id,x,y\n";
  for (int f = 0; f < 10; ++f) {
    table += std::to_string(f) + "," + std::to_string(f) + ",20" + std::to_string(f) + ",200\n";
  }
  const CheckedRecording c = columns_of(table);
  ASSERT_EQ(of_kind(c, Check::columns).size(), 1u) << all_texts(c);
  EXPECT_NE(of_kind(c, Check::columns)[0].what.find("every row has an identity of its own"),
            std::string::npos);
}

TEST(Identities, rowsWithoutOneAreLeftOutAndCounted) {
  for (const char* nobody : {"", "None", "nan", "NaN"}) {
    const std::string lost = std::string("1,") + nobody + ",100,100\n";
    const CheckedRecording c =
        columns_of("frame,particle,x,y\n0,1.0,200,200\n" + lost + "1,1.0,201,200\n2,1.0,202,200\n");
    EXPECT_EQ(c.recording.tracks.size(), 1u);
    EXPECT_EQ(c.counts.without_identity, 1) << nobody;
    EXPECT_EQ(c.counts.read, 4);
    EXPECT_EQ(c.rows, 3);
  }
  EXPECT_NE(complaint("frame,particle,x,y\n0,,200,200\n1,nan,201,200\n", centred_pixels())
                .find("no row has an identity in column 'particle': columns.id = \"-\""),
            std::string::npos);
}

TEST(Identities, areWordsIfOneIsAWord) {
  const CheckedRecording c = columns_of(
      "frame,id,x,y\n0,3,200,200\n0,#2,230,200\n0,anna,260,200\n1,3.0,201,200\n1,#2,231,200\n"
      "1,anna,261,200\n");
  EXPECT_EQ(c.names, (std::vector<std::string>{"3", "#2", "anna"}));
  ASSERT_EQ(c.recording.tracks.size(), 3u);
  EXPECT_EQ(c.recording.tracks[0].x.size(), 2u);
  const CheckedRecording twice =
      columns_of("frame,id,x,y\n0,anna,200,200\n1,anna,201,200\n1,anna,220,200\n");
  EXPECT_NE(all_texts(twice).find("id anna, duplicate"), std::string::npos) << all_texts(twice);
}

}  // namespace
}  // namespace lilytank
