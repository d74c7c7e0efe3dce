// The layouts of trackers: as they write them, and there and back.
#include <gtest/gtest.h>

#include "lilytank/recording_io.hpp"
#include "support/recordings.hpp"

namespace lilytank {
namespace {

RecordingOptions in_pixels() {
  RecordingOptions options;
  options.calibration.has_origin = true;
  options.calibration.origin_x = 320, options.calibration.origin_y = 240;
  options.calibration.circle_radius = 200;  // 1.5 mm a pixel
  return options;
}

CheckedRecording tracks_of(const std::string& content, const RecordingOptions& options = {},
                           const std::string& name = "tracks.csv") {
  const TemporaryDirectory here;
  return check_recording(here.write(name, content), options);
}

class RoundTrip : public testing::TestWithParam<RecordingFormat> {};

TEST_P(RoundTrip, bringsEverySightingBack) {
  const TemporaryDirectory here;
  const bool particles = GetParam() == RecordingFormat::swistrack_particles;
  Recording truth = circling(5, 400);
  for (const int hole : {50, 51, 200}) truth.tracks[2].x[hole] = truth.tracks[2].y[hole] = NAN;
  if (particles) truth = circling(5, 400);  // ids are by first appearance, so all from frame 0
  RecordingOptions reading;
  reading.format = GetParam();
  reading.rate = 30;
  Calibration writing;
  const bool pixels =
      GetParam() == RecordingFormat::trackpy || GetParam() == RecordingFormat::fasttrack ||
      GetParam() == RecordingFormat::idtracker || GetParam() == RecordingFormat::idtracker_wide;
  if (pixels) {
    reading.calibration = in_pixels().calibration;
    writing = reading.calibration, writing.pixel = 0.0015;
  }
  write_recording(truth, here.path("file"), GetParam(), writing);
  const CheckedRecording back = check_recording(here.path("file"), reading);
  expect_same_tracks(truth, back.recording);
  for (const Finding& finding : back.findings) EXPECT_EQ(finding.check, Check::gap);
  // What is found without being told is the same.
  reading.format = RecordingFormat::automatic;
  EXPECT_EQ(check_recording(here.path("file"), reading).format, GetParam());
}

INSTANTIATE_TEST_SUITE_P(allFormats, RoundTrip,
                         testing::Values(RecordingFormat::tidy, RecordingFormat::swistrack_tracks,
                                         RecordingFormat::swistrack_particles,
                                         RecordingFormat::trackpy, RecordingFormat::idtracker,
                                         RecordingFormat::idtracker_wide, RecordingFormat::trex,
                                         RecordingFormat::fasttrack),
                         [](const auto& format) {
                           std::string name = format_word(format.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(RecordingFormats, headingsComeBackWhereTheFormatHasThem) {
  const TemporaryDirectory here;
  const Recording truth = circling(3, 300);
  for (const auto format : {RecordingFormat::tidy, RecordingFormat::trex}) {
    write_recording(truth, here.path(format_word(format)), format);
    const Recording back = read_recording(here.path(format_word(format)));
    ASSERT_TRUE(back.has_heading());
    // Continuous, and the same up to the whole turns of the first one.
    for (std::size_t i = 0; i < 300; ++i) {
      EXPECT_NEAR(back.tracks[1].theta[i] - back.tracks[1].theta[0],
                  truth.tracks[1].theta[i] - truth.tracks[1].theta[0], 3e-6);
    }
  }
}

TEST(RecordingFormats, compressedFilesAreTheSame) {
  const TemporaryDirectory here;
  const Recording truth = circling(3, 500);
  write_recording(truth, here.path("a.csv"));
  write_recording(truth, here.path("a.csv.gz"));
  EXPECT_LT(here.read("a.csv.gz").size(), here.read("a.csv").size() / 2);
  expect_same_tracks(read_recording(here.path("a.csv")), read_recording(here.path("a.csv.gz")), 0,
                     0);
}

TEST(RecordingFormats, theWayTextIsWrittenDoesNotMatter) {
  const std::string plain = "frame,time,id,x,y\n0,0,0,0.1,0\n1,0.04,0,0.11,0\n";
  const Recording truth = tracks_of(plain).recording;
  for (const std::string other :
       {"\xef\xbb\xbf"
        "frame,time,id,x,y\r\n0,0,0,0.1,0\r\n1,0.04,0,0.11,0",
        "# a comment\n\nframe;time;id;x;y\n0;0;0;1e-1;0\n\n1;0.04;0;+0.11;0\n",
        "id\ty\tx\tnote\ttime\tframe\n0\t0\t0.1\tgood one\t0\t0\n0.0\t0\t0.11\t\t0.04\t1\n",
        " frame , time , id , x , y \n 0 , 0 , 0 , 0.1 , 0 \n 1 , 0.04 , 0 , 0.11 , 0 \n",
        "\"frame\",\"time\",\"id\",\"x\",\"y\"\n0,0,0,\"0.1\",0\n1,0.04,0,0.11,0\n",
        "frame time id x y\n0 0 0 0.1 0\n1  0.04  0  0.11  0\n"}) {
    SCOPED_TRACE(other);
    expect_same_tracks(truth, tracks_of(other).recording, 0);
  }
}

TEST(RecordingFormats, swistrackTracksAreFilesWithTabsAndNumbersInTheirNames) {
  const TemporaryDirectory here;
  here.write("tracks/track00000003.csv", "% Frame number  x  y\n10\t0.1\t0.05\n11\t0.11\t0.05\n");
  here.write("tracks/track00000012.csv", "% Frame number  x  y\n11\t-0.1\t0\n12\t-0.1\t0.01\n");
  RecordingOptions options;
  EXPECT_THROW(read_recording(here.path("tracks"), options), InputError);  // no times, no rate
  options.rate = 25;
  for (const std::string& name : {here.path("tracks"), here.path("tracks/track*.csv")}) {
    const Recording r = read_recording(name, options);
    ASSERT_EQ(r.tracks.size(), 2u);
    EXPECT_EQ(r.tracks[0].id, 3);
    EXPECT_EQ(r.tracks[1].id, 12);
    EXPECT_EQ(r.tracks[1].first, 1);
    EXPECT_EQ(r.frames, 3);
    EXPECT_DOUBLE_EQ(r.rate, 25);
    EXPECT_DOUBLE_EQ(r.start, 10 / 25.0);
  }
}

TEST(RecordingFormats, swistrackParticlesHaveDatesAndNoIdentities) {
  const std::string head =
      "% Frame number\tTime\tX (image)\tY (image)\tX (world)\tY (world)\tArea\tOrientation\t"
      "Compactness\t\n";
  std::string rows;
  for (int f = 0; f < 50; ++f) {
    char text[200];
    for (int b = 0; b < 2; ++b) {
      // The second particle comes first in every other frame.
      const int body = (b + f) % 2;
      std::snprintf(text, sizeof text,
                    "%d\t2009-11-01T23:59:%02d.%03d\t0\t0\t%.4f\t%.4f\t100\t0.3\t0.9\t\n", f,
                    58 + f / 25, 40 * (f % 25), 0.003 * f, body == 0 ? 0.05 : -0.05);
      rows += text;
    }
  }
  const CheckedRecording c = tracks_of(head + rows);
  EXPECT_EQ(c.format, RecordingFormat::swistrack_particles);
  EXPECT_EQ(all_texts(c), "");
  ASSERT_EQ(c.recording.tracks.size(), 2u);
  EXPECT_DOUBLE_EQ(c.recording.rate, 25);
  EXPECT_DOUBLE_EQ(c.recording.start, 0);
  for (const Track& track : c.recording.tracks) {
    ASSERT_EQ(track.x.size(), 50u);
    for (const double y : track.y) EXPECT_DOUBLE_EQ(y, track.y.front());
  }
}

TEST(RecordingFormats, particlesThatCompeteEndTheirTracks) {
  // Two bodies merge to one blob for a frame and part again.
  std::string text = "frame,time,x,y\n";
  for (int f = 0; f < 40; ++f) {
    const double apart = 0.0012 * std::abs(f - 20);
    const std::string begin = std::to_string(f) + "," + std::to_string(f / 30.0) + ",";
    const std::string x = std::to_string(0.002 * f);
    if (f != 20) text += begin + x + "," + std::to_string(-apart) + "\n";
    text += begin + x + "," + std::to_string(apart) + "\n";
  }
  RecordingOptions options;
  options.format = RecordingFormat::table;
  const CheckedRecording c = tracks_of(text, options);
  EXPECT_FALSE(of_kind(c, Check::link).empty());
  EXPECT_TRUE(of_kind(c, Check::swap).empty()) << "nobody has another's identity";
  EXPECT_GE(c.recording.tracks.size(), 4u);
  options.rules[Check::link] = Treatment::keep;
  const CheckedRecording kept = tracks_of(text, options);
  EXPECT_FALSE(of_kind(kept, Check::link).empty());
  EXPECT_LT(kept.recording.tracks.size(), c.recording.tracks.size());
  options.rules[Check::link] = Treatment::refuse;
  EXPECT_TRUE(tracks_of(text, options).refused());
}

TEST(RecordingFormats, trackpyIsInPixelsWithTheYAxisDown) {
  const std::string table =
      ",y,x,mass,size,ecc,signal,raw_mass,ep,frame,particle\n"
      "0,240.0,420.0,1,2,3,4,5,6,0,0.0\n1,140.0,320.0,1,2,3,4,5,6,0,1.0\n"
      "2,240.0,421.0,1,2,3,4,5,6,1,0.0\n3,141.0,320.0,1,2,3,4,5,6,1,1.0\n";
  EXPECT_NE(complaint(table).find("positions are in pixels"), std::string::npos);
  RecordingOptions options = in_pixels();
  EXPECT_NE(complaint(table, options).find("give rate"), std::string::npos);
  options.rate = 30;
  const Recording r = tracks_of(table, options).recording;
  ASSERT_EQ(r.tracks.size(), 2u);
  EXPECT_NEAR(r.tracks[0].x[0], 0.15, 1e-12);
  EXPECT_NEAR(r.tracks[0].y[0], 0, 1e-12);
  EXPECT_NEAR(r.tracks[1].y[0], 0.15, 1e-12);  // higher in the picture
  EXPECT_NEAR(r.tracks[1].y[1], 0.1485, 1e-12);
  EXPECT_FALSE(r.has_heading());
}

TEST(RecordingFormats, idtrackerWritesWideAndTidyTables) {
  RecordingOptions options = in_pixels();
  const Recording wide =
      tracks_of(
          "time,x1,y1,x2,y2\n0.0,420,240,320,340\n0.04,421,240,nan,nan\n0.08,422,240,320,342\n",
          options)
          .recording;
  const Recording tidy =
      tracks_of(
          "frame,time,individual,x,y,probability\n0,0.0,1,420,240,1.0\n0,0.0,2,320,340,0.98\n"
          "1,0.04,1,421,240,1.0\n2,0.08,1,422,240,1.0\n2,0.08,2,320,342,0.9\n",
          options)
          .recording;
  expect_same_tracks(wide, tidy, 0);
  EXPECT_DOUBLE_EQ(wide.rate, 25);
  EXPECT_NEAR(wide.tracks[1].y[2], -0.153, 1e-12);
  EXPECT_TRUE(std::isnan(wide.tracks[1].x[1]));
}

TEST(RecordingFormats, trexHasOneFileAnIndividualInfinitiesAndCentimetres) {
  const TemporaryDirectory here;
  const std::string head =
      "frame,SPEED#wcentroid (cm/s),X#wcentroid (cm),Y#wcentroid (cm),ANGLE,missing,time\n";
  here.write("video_id0.csv",
             head + "0,1,10,5,0.5,0,0\n1,1,10.5,5,0.5,0,0.04\n2,1,11,5,0.5,0,0.08\n");
  here.write("video_id1.csv",
             head + "0,inf,inf,inf,inf,1,0\n1,1,-10,5,0,0,0.04\n2,1,-9.5,5,0,0,0.08\n");
  const Recording r = read_recording(here.path("video_id*.csv"));
  ASSERT_EQ(r.tracks.size(), 2u);
  EXPECT_NEAR(r.tracks[0].x[1], 0.105, 1e-12);
  EXPECT_NEAR(r.tracks[0].y[1], -0.05, 1e-12);
  EXPECT_NEAR(r.tracks[0].theta[1], -0.5, 1e-12);
  EXPECT_EQ(r.tracks[1].first, 1);
}

TEST(RecordingFormats, fasttrackAnglesAreSeenCounterClockwise) {
  // A row of FastTrack's own example: the head lies right of the tail and lower in the picture.
  const std::string table =
      "xHead\tyHead\ttHead\txTail\tyTail\ttTail\txBody\tyBody\ttBody\timageNumber\tid\n"
      "514.327\t333.12\t5.81619\t499.96\t327.727\t6.10226\t508.345\t330.876\t5.94395\t0\t0\n"
      "515.327\t333.12\t5.81619\t500.96\t327.727\t6.10226\t509.345\t330.876\t5.94395\t1\t0\n";
  RecordingOptions options;
  options.rate = 30;
  options.calibration.has_origin = true;
  options.calibration.origin_x = 480, options.calibration.origin_y = 320;
  options.calibration.pixel = 0.001;
  const Recording r = tracks_of(table, options, "tracking.txt").recording;
  const double along_x = 514.327 - 499.96, along_y = -(333.12 - 327.727);
  const double body = std::atan2(along_y, along_x);
  EXPECT_NEAR(std::remainder(r.tracks[0].theta[0] - body, 2 * kPi), 0, 0.03);
  EXPECT_LT(r.tracks[0].y[0], 0);
}

TEST(RecordingFormats, anyTableByItsColumns) {
  RecordingOptions options;
  options.format = RecordingFormat::table;
  options.columns = {"", "t_ms", "bee", "px", "py", "deg"};
  options.time_unit = 0.001;
  options.calibration.pixel = 0.001;
  options.calibration.angles = AngleUnit::degrees;
  const CheckedRecording c = tracks_of(
      "t_ms;bee;px;py;deg\n0;queen;100;50;350\n0;drone;-100;50;0\n"
      "40;queen;101;50;359\n40;drone;-100;51;3\n"
      "80;queen;102;50;8\n80;drone;-100;52;6\n",
      options);
  const Recording& r = c.recording;
  EXPECT_EQ(c.names, (std::vector<std::string>{"queen", "drone"}));
  ASSERT_EQ(r.tracks.size(), 2u);
  EXPECT_DOUBLE_EQ(r.rate, 25);
  EXPECT_NEAR(r.tracks[0].x[2], 0.102, 1e-12);
  EXPECT_NEAR(r.tracks[0].theta[2] - r.tracks[0].theta[0], 18 * kPi / 180, 1e-9);
}

TEST(RecordingFormats, tablesWithoutNamesHaveNumberedColumns) {
  RecordingOptions options;
  options.format = RecordingFormat::table;
  options.columns = {"1", "", "", "3", "4", ""};
  options.rate = 10;
  const Recording r = tracks_of("0 7 0.10 0.2\n1 7 0.11 0.2\n2 7 0.12 0.2\n", options).recording;
  ASSERT_EQ(r.tracks.size(), 1u);  // no ids, one sighting a frame: one body
  EXPECT_DOUBLE_EQ(r.tracks[0].x[2], 0.12);
}

TEST(RecordingFormats, ourOwnTrajectoryTableIsARecording) {
  const CheckedRecording c = tracks_of(
      "frame,time,id,x,y,theta,label,last,latched,bonded,complete\n"
      "0,0,0,0.1,0.1,3.1,0,-1,0,0,0\n1,0.2,0,0.11,0.1,-3.1,0,-1,0,0,0\n2,0.4,0,0.12,0.1,-3,0,-1,0,"
      "0,0\n");
  EXPECT_DOUBLE_EQ(c.recording.rate, 5);
  EXPECT_NEAR(c.recording.tracks[0].theta[1], 2 * kPi - 3.1, 1e-12);
}

TEST(RecordingFormats, ballsHaveNoHeading) {
  RecordingOptions options;
  options.body = BodyKind::ball;
  EXPECT_FALSE(tracks_of("frame,time,id,x,y,theta\n0,0,0,0.1,0,1\n1,0.04,0,0.1,0,9\n", options)
                   .recording.has_heading());
}

// Tracks of another recording would be read along with those that are written.
TEST(WriteRecording, doesNotMixTracksOfTwoRecordings) {
  for (const auto& [format, left] : {std::pair{RecordingFormat::trex, "circling_id3.csv"},
                                     {RecordingFormat::swistrack_tracks, "track00000003.csv"}}) {
    const TemporaryDirectory here;
    write_recording(circling(5, 20), here.path("d"), format);
    write_recording(circling(5, 30), here.path("d"), format);  // all are replaced
    here.write("d/.notes", "");
    here.write("d/aside/old.csv", "");
    const std::string before = here.read("d/" + std::string(left));
    try {
      write_recording(circling(3, 20), here.path("d"), format);
      ADD_FAILURE() << left;
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()), "'" + here.path("d") + "' holds '" + left +
                                           "', which would be read as one of the new tracks: "
                                           "choose a directory without other files, or remove "
                                           "them");
    }
    EXPECT_EQ(here.read("d/" + std::string(left)), before);
    write_recording(circling(6, 20), here.path("d"), format);
    RecordingOptions options;
    options.rate = 30;
    EXPECT_EQ(read_recording(here.path("d"), options).tracks.size(), 6u);
  }
}

}  // namespace
}  // namespace lilytank
