// lilytank recording: what users see of trackers' files.
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "lilytank/recording_io.hpp"

namespace lilytank {
namespace {

const std::string kSmall =
    "frame,time,id,x,y\n0,0,0,0.1,0.1\n0,0,1,-0.1,0\n1,0.04,0,0.101,0.1\n1,0.04,1,-0.1,0.001\n"
    "2,0.08,0,0.102,0.1\n2,0.08,1,-0.1,0.002\n";
const std::string kDuplicate = kSmall + "2,0.08,1,-0.1,0.05\n";

class RecordingVerb : public testing::Test {
 protected:
  RecordingVerb() {
    lilytank_.here.write("small.csv", kSmall);
    lilytank_.here.write("duplicate.csv", kDuplicate);
  }
  Program lilytank_;
};

TEST_F(RecordingVerb, infoTellsWhatIsThere) {
  const Answer a = lilytank_("recording info small.csv");
  EXPECT_EQ(a.code, 0) << a.err;
  for (const char* text : {"small.csv\n", "tidy, 1 file, 6 rows", "3 frames at 25 /s",
                           "2 in 2 tracks, seen 100 % of the time", "findings  none"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
}

TEST_F(RecordingVerb, infoIsJsonForPrograms) {
  const Answer a = lilytank_("recording info small.csv duplicate.csv --json");
  EXPECT_EQ(a.code, 2);
  for (const char* text :
       {"[\n  {\n    \"name\": \"small.csv\",\n    \"format\": \"tidy\",", "\"rows\": 6,",
        "\"findings\": {},\n    \"frames\": 3,\n    \"rate\": 25.0,", "\"refused\": true,",
        "\"duplicate\": 1"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
}

TEST_F(RecordingVerb, whatIsNotReadIsAccountedFor) {
  lilytank_.here.write("steps.csv",
                       "frame,particle,x,y,mass\n0,1,0,0,5\n2,1,1,0,5\n2,,40,40,5\n"
                       "4,1,nan,nan,5\n6,1,3,0,5\n8,1,4,0,5\n");
  const std::string reading = "--read rate=30 --read pixel=1mm";
  Answer a = lilytank_("recording info steps.csv " + reading);
  EXPECT_EQ(a.code, 0) << a.err;
  for (const char* text :
       {"trackpy, 1 file, 4 rows", "not used  mass\n",
        "left out  1 row without identity, 1 sighting without a position, of 6 rows read\n",
        "5 frames at 15 /s, from 0 s to 0.266667 s; frame numbers have a common step of 2\n"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
  a = lilytank_("recording check steps.csv " + reading);
  EXPECT_NE(a.out.find("left out: 1 row without identity"), std::string::npos) << a.out;
}

TEST_F(RecordingVerb, checkNamesWhatIsWrongAndGoesOn) {
  const Answer a = lilytank_("recording check duplicate.csv none.csv small.csv --csv found.csv");
  EXPECT_EQ(a.code, 2);
  EXPECT_NE(a.out.find("duplicate.csv:8: frame 2, id 1, duplicate: seen before in this frame, in "
                       "line 7, 48 mm away (refused)"),
            std::string::npos)
      << a.out;
  EXPECT_NE(a.out.find("small.csv: 6 rows, findings: none; 2 tracks"), std::string::npos) << a.out;
  EXPECT_EQ(a.err, "cannot read 'none.csv': No such file or directory\n");
  EXPECT_EQ(lilytank_.here.read("found.csv"),
            "file,line,frame,id,check,treatment,what\nduplicate.csv,8,2,1,duplicate,refuse,seen "
            "before in this frame; in line 7; 48 mm away\n");
  EXPECT_EQ(lilytank_("recording check duplicate.csv --read checks.duplicate=mark").code, 0);
}

TEST_F(RecordingVerb, checkIsJsonForPrograms) {
  const Answer a = lilytank_("recording check duplicate.csv small.csv --json");
  EXPECT_EQ(a.code, 2);
  for (const char* text :
       {"\"name\": \"duplicate.csv\"", "\"line\": 8", "\"frame\": 2", "\"id\": \"1\"",
        "\"check\": \"duplicate\"", "\"treatment\": \"refuse\"", "\"refused\": true",
        "\"tracks\": 2,\n    \"refused\": false,\n    \"findings\": []"}) {
    EXPECT_NE(a.out.find(text), std::string::npos) << text << "\n" << a.out;
  }
}

TEST_F(RecordingVerb, convertGoesThereAndBack) {
  const std::string scale = "tank_circle=[300,200,150]";
  Answer a = lilytank_("recording convert small.csv --to trackpy --out p.csv --write " + scale);
  EXPECT_EQ(a.code, 0) << a.err;
  a = lilytank_("recording convert p.csv --out back.csv.gz --read " + scale + " --read rate=25");
  EXPECT_EQ(a.code, 0) << a.err;
  a = lilytank_("recording convert back.csv.gz --out back.csv");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(lilytank_.here.read("back.csv"),
            "frame,time,id,x,y\n0,0.0000,0,0.1000000,0.1000000\n0,0.0000,1,-0.1000000,0.0000000\n"
            "1,0.0400,0,0.1010000,0.1000000\n1,0.0400,1,-0.1000000,0.0010000\n"
            "2,0.0800,0,0.1020000,0.1000000\n2,0.0800,1,-0.1000000,0.0020000\n");
}

TEST_F(RecordingVerb, filesOfOneTrackEachAreOneRecording) {
  ASSERT_EQ(lilytank_("recording convert small.csv --to trex --out trex").code, 0);
  const Answer a = lilytank_("recording info trex/*.csv small.csv");
  EXPECT_NE(a.out.find("trex/small_id0.csv and 1 more\n  format    trex, 2 files"),
            std::string::npos)
      << a.out << a.err;
  EXPECT_NE(a.out.find("small.csv\n  format    tidy"), std::string::npos) << a.out;
}

TEST_F(RecordingVerb, experimentsAreTheirRecordings) {
  lilytank_.here.write("e/experiment.toml",
                       "[tank]\nradius = 0.4\n[[recording]]\nfile = \"../small.csv\"\n"
                       "[[recording]]\nfile = \"../duplicate.csv\"\nbody = \"ball\"\n"
                       "checks.duplicate = \"keep\"\n");
  const Answer a = lilytank_("recording info e/experiment.toml");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_NE(a.out.find("body ball"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("of a tank of radius 0.4 m"), std::string::npos) << a.out;
  EXPECT_NE(a.out.find("findings  1 duplicate"), std::string::npos) << a.out;
}

TEST_F(RecordingVerb, convertDoesNotWriteWhatIsRefused) {
  const Answer a = lilytank_("recording convert duplicate.csv --out out.csv");
  EXPECT_EQ(a.code, 2);
  EXPECT_EQ(a.err,
            "duplicate.csv:8: frame 2, id 1, duplicate: seen before in this frame, in line 7, 48 "
            "mm away (refused); checks.duplicate says what is done about it\n");
  EXPECT_FALSE(lilytank_.here.has("out.csv"));
}

TEST_F(RecordingVerb, aRunIsFilmed) {
  lilytank_.here.write("tiny.toml", kTiny);
  ASSERT_EQ(lilytank_("run tiny.toml --out run --set output.rate=40 --quiet").code, 0);
  const std::string command =
      "recording convert run --camera rate=20 --camera position_noise='0.5 mm' --camera seed=7 ";
  Answer a = lilytank_(command + "--out film.csv.gz");
  EXPECT_EQ(a.code, 0) << a.err;
  EXPECT_EQ(a.err.find("poses were stored"), std::string::npos) << a.err;
  ASSERT_EQ(lilytank_(command + "--out again.csv.gz").code, 0);
  EXPECT_EQ(lilytank_.here.read("film.csv.gz"), lilytank_.here.read("again.csv.gz"));
  const Recording film = read_recording(lilytank_.here.path("film.csv.gz"));
  EXPECT_DOUBLE_EQ(film.rate, 20);
  EXPECT_EQ(film.frames, 101);
  EXPECT_EQ(film.tracks.size(), 4u);
  EXPECT_TRUE(film.has_heading());
  a = lilytank_("recording convert run --camera rate=50 --out fast.csv");
  EXPECT_NE(a.err.find("poses were stored 40 times a second"), std::string::npos) << a.err;
  a = lilytank_("recording convert run --camera rate=30 --out between.csv");
  EXPECT_TRUE(a.err.ends_with("(film with --camera rate=40)\n")) << a.err;
  const Answer free = lilytank_(
      "run tiny.toml --out free --set output.rate=40 --quiet --set control.latches=false");
  ASSERT_EQ(free.code, 0) << free.err;
  a = lilytank_("recording convert free --camera rate=30 --out 30.csv");
  EXPECT_EQ(a.err.find("film with"), std::string::npos) << a.err;
  a = lilytank_("recording convert run --camera lag=1 --out x.csv");
  EXPECT_EQ(a.code, 2);
  EXPECT_EQ(a.err, "--camera lag=1: unknown key 'camera.lag'\n");
  EXPECT_EQ(lilytank_("recording convert run --read body=ball --out x.csv").code, 2);
}

TEST_F(RecordingVerb, mistakesAreOneLineAndTheNearestRightWord) {
  for (const auto& [arguments, complaint] : std::vector<std::pair<std::string, std::string>>{
           {"recording", "lilytank recording: say info, check or convert\n"},
           {"recording chek a.csv",
            "lilytank recording: say info, check or convert, not 'chek' - did you mean 'check'?\n"},
           {"recording info",
            "lilytank recording info: which recording? write a file or an experiment file\n"},
           {"recording convert small.csv",
            "lilytank recording convert: where to? give --out FILE\n"},
           {"recording info small.csv --read rat=25",
            "--read rat=25: unknown key 'recording.rat' - did you mean 'rate'?\n"},
           {"recording info small.csv --read body=bal",
            "--read body=bal: recording.body = \"bal\" is none of lily, ball, point - did you mean "
            "'ball'?\n"},
           {"recording convert small.csv --camera rate=3 --out a.csv",
            "lilytank recording convert: --camera goes with the directory of one run\n"},
       }) {
    const Answer a = lilytank_(arguments);
    EXPECT_EQ(a.code, 2) << arguments;
    EXPECT_EQ(a.err, complaint);
    EXPECT_EQ(a.out, "");
  }
  const Answer a = lilytank_("recording convert small.csv --to trackpi --out a.csv");
  EXPECT_EQ(a.err,
            "--to: format = \"trackpi\" is none of tidy, swistrack-tracks, swistrack-particles, "
            "trackpy, idtracker, idtracker-wide, trex, fasttrack - did you mean 'trackpy'?\n");
  EXPECT_EQ(lilytank_("recording convert small.csv --to table --out a.csv").code, 2);
  const Answer scale = lilytank_("recording convert small.csv --to trackpy --out a.csv");
  EXPECT_EQ(scale.code, 2);
  EXPECT_NE(scale.err.find("--write pixel='0.66 mm'"), std::string::npos) << scale.err;
}

}  // namespace
}  // namespace lilytank
