// Files that are no recordings: refused with the place and what is wrong.
#include <gtest/gtest.h>

#include "recording/gzip.hpp"
#include "support/recordings.hpp"

namespace lilytank {
namespace {

struct Case {
  const char* name;
  std::string content, complaint;
};

class Malformed : public testing::TestWithParam<Case> {};

TEST_P(Malformed, isRefusedWithItsPlace) {
  const std::string what = complaint(GetParam().content);
  EXPECT_TRUE(what.starts_with(GetParam().complaint)) << what;
}

const std::string kHead = "frame,time,id,x,y\n0,0,0,0.1,0\n";

INSTANTIATE_TEST_SUITE_P(
    files, Malformed,
    testing::Values(
        Case{"empty", "", "tracks.csv:1:1: there is no table in it"},
        Case{"blank", "\n\n  \n", "tracks.csv:1:1: there is no table in it"},
        Case{"headerOnly", "frame,time,id,x,y\n", "tracks.csv: there is no sighting in it"},
        Case{"unknownColumns", "a,b,c\n1,2,3\n",
             "tracks.csv:1:1: these columns are of no format that is known"},
        Case{"noX", "frame,time,id,y\n0,0,0,1\n",
             "tracks.csv:1:1: these columns are of no format that is known"},
        Case{"twice", "frame,time,id,x,y,x\n0,0,0,1,1,2\n",
             "tracks.csv:2: two columns are called 'x' (4 and 6), and differ: '1', '2'"},
        Case{"tooFew", kHead + "1,0.04,0,0.1\n", "tracks.csv:3:1: 4 columns instead of 5"},
        Case{"tooMany", kHead + "1,0.04,0,0.1,0,0\n", "tracks.csv:3:1: 6 columns instead of 5"},
        Case{"text", kHead + "1,0.04,0,far,0\n", "tracks.csv:3:10: x 'far' is not a number"},
        Case{"hexadecimal", kHead + "1,0.04,0,0x1,0\n", "tracks.csv:3:10: x '0x1' is not a number"},
        Case{"ambiguousComma", "frame;time;id;x;y\n0;0;0;1,234;0\n",
             "tracks.csv:2:7: x '1,234' is not a number: if the comma is a decimal comma, "
             "decimal_comma = true reads it"},
        Case{"halfFrame", kHead + "1.5,0.04,0,0.1,0\n",
             "tracks.csv:3:1: frame '1.5' is not a whole number"},
        Case{"hugeFrame", kHead + "99999999999999999999,0.04,0,0.1,0\n",
             "tracks.csv:3:1: frame '99999999999999999999' is not a whole number"},
        Case{"farFrame", kHead + "1,0.04,0,0.1,0\n1000000000,0.08,0,0.1,0\n",
             "tracks.csv: frames run from 0 to 1000000000, but only 3 of them hold anything"},
        Case{"noTime", kHead + "1,,0,0.1,0\n", "tracks.csv:3:3: time '' is not a time"},
        Case{"huge", kHead + "1,0.04,0,1e300,0\n", "tracks.csv:3:10: x '1e300' is too large"},
        Case{"oneFrame", kHead, "tracks.csv: there is a single frame in it: give rate"},
        Case{"timesFall", kHead + "1,-0.04,0,0.1,0\n2,-0.08,0,0.1,0\n",
             "tracks.csv: times do not rise with frames"},
        Case{"zeros", std::string(300, '\0'), "tracks.csv:1:1: "},
        Case{"picture", "\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "tracks.csv:1:1: "}),
    [](const auto& c) { return c.param.name; });

TEST(MalformedFiles, linesWithoutEndAreNoTable) {
  EXPECT_TRUE(complaint(std::string(5 << 20, 'x'))
                  .starts_with("tracks.csv:1:1: a line of more than a megabyte"));
}

TEST(MalformedFiles, cutAndDamagedCompression) {
  std::string text = "frame,time,id,x,y\n";
  for (int f = 0; f < 3000; ++f) {
    text +=
        std::to_string(f) + "," + std::to_string(f / 30.0) + ",0,0.1,0." + std::to_string(f) + "\n";
  }
  const std::string whole = gzipped(text);
  const std::string cut = complaint(whole.substr(0, whole.size() / 2), {}, "a.csv.gz");
  EXPECT_NE(cut.find("the compressed file is cut"), std::string::npos) << cut;
  std::string damaged = whole;
  for (std::size_t i = 2000; i < 2050; ++i) damaged[i] = static_cast<char>(damaged[i] ^ 0x5a);
  EXPECT_NE(complaint(damaged, {}, "a.csv.gz"), "");
  std::string wrong_sum = whole;
  wrong_sum[whole.size() - 6] ^= 1;  // of the checksum
  EXPECT_NE(complaint(wrong_sum, {}, "a.csv.gz").find("compression is damaged"), std::string::npos);
}

TEST(MalformedFiles, moreSightingsThanAllowed) {
  RecordingOptions options;
  options.most_rows = 1;
  EXPECT_EQ(complaint(kHead + "1,0.04,0,0.1,0\n", options),
            "tracks.csv:3: more than 1 sightings, of about 160 bytes of memory each: most_rows = N "
            "reads up to N of them");
}

TEST(MalformedFiles, missingFilesAndEmptyFolders) {
  const TemporaryDirectory here;
  here.write("folder/.hidden", "x");
  EXPECT_THROW(read_recording(here.path("none.csv")), InputError);
  EXPECT_THROW(read_recording(here.path("folder")), InputError);
  EXPECT_THROW(read_recording(here.path("track*.csv")), InputError);
}

TEST(MalformedFiles, columnsThatAreNotThereAreNamedWithTheNearest) {
  RecordingOptions options;
  options.columns.x = "X#wcentroid";
  EXPECT_TRUE(complaint("frame,time,id,x,y,X#wcentroids\n0,0,0,1,1,1\n", options)
                  .starts_with("tracks.csv:1:1: there is no column 'X#wcentroid' - did you mean "
                               "'X#wcentroids'?"));
}

// Names are told as they are looked for, and none is taken for itself.
TEST(MalformedFiles, namesInOtherLettersAreNotTheFormats) {
  const std::string row = "\n0,0,0,1,1,1\n";
  EXPECT_EQ(
      complaint("frame,time,id,X,y,theta" + row),
      "tracks.csv:1:1: these columns are of no format that is known: name the format, or say "
      "what the columns mean (format = \"table\"); with 'X' in small letters it would be tidy; "
      "perhaps columns.x = \"X\"; there are frame, time, id, X, y, theta");
  RecordingOptions options;
  options.format = RecordingFormat::trex;
  const std::string trex = complaint("frame,time,id,X,y,theta" + row, options, "track0.csv");
  EXPECT_EQ(trex,
            "track0.csv:1:1: there is no column 'Y#wcentroid (cm)' or 'Y#wcentroid' or 'Y (cm)' or "
            "'Y' or 'Y#pcentroid (cm)' or 'Y#centroid (cm)' - did you mean 'y'?; there are frame, "
            "time, id, X, y, theta");
  options.format = RecordingFormat::tidy;
  EXPECT_EQ(
      complaint("frame,time,id,X,y,theta" + row, options),
      "tracks.csv:1:1: there is no column 'x' - did you mean 'X'?; there are frame, time, id, "
      "X, y, theta");
}

// A wide table has no columns of ids, but its frames and times may be called anything.
TEST(MalformedFiles, columnsOfWideTables) {
  const std::string table = "time,x1,y1\n0,0,0\n0.04,0.01,0\n0.08,0.02,0\n";
  RecordingOptions options;
  options.calibration.pixel = 1;
  EXPECT_EQ(complaint(table, options), "");
  options.columns.time = "tme", options.rate = 25;
  EXPECT_EQ(complaint(table, options),
            "tracks.csv:1:1: there is no column 'tme' - did you mean 'time'?; there are time, x1, "
            "y1");
  options.columns.time = "-";
  EXPECT_EQ(complaint(table, options), "");
  options.columns.time = "", options.columns.id = "x1";
  EXPECT_EQ(complaint(table, options),
            "tracks.csv:1:1: columns.id = \"x1\": of a table of x1, y1, x2, y2, ... only "
            "columns.frame and columns.time can be named");
  options.columns.id = "-";
  EXPECT_EQ(complaint(table, options), "");
  EXPECT_EQ(complaint(table + ",0.03,0\n", options), "tracks.csv:5:1: time '' is not a time");
}

TEST(MalformedFiles, trackFilesNeedANumber) {
  RecordingOptions options;
  options.rate = 30;
  EXPECT_NE(complaint("% Frame number  x  y\n0\t0\t0\n", options).find("no number that identifies"),
            std::string::npos);
}

TEST(MalformedFiles, writingRefusesWhatItCannotDo) {
  const TemporaryDirectory here;
  const Recording r = circling(2, 10);
  EXPECT_THROW(write_recording(r, here.path("a"), RecordingFormat::trackpy), InputError);
  EXPECT_THROW(write_recording(r, here.path("no/folder/a.csv")), InputError);
}

}  // namespace
}  // namespace lilytank
