#include "lilytank/trajectory.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "io/file_digest.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

/// Three modules, two of them bonded, and a ball.
Model small_model() {
  Model model = standard_model();
  model.module.count = 3;
  model.ball.count = 1;
  model.control.latches = false;
  model.start.radius = 0.15;
  return model;
}

State bonded_state(const Model& model) {
  State state = initial_state(model, 7);
  state.firmware[0].label = 5, state.firmware[0].last = 2;
  state.firmware[1].label = 300, state.firmware[1].last = 0;
  state.faces[0].status = FaceStatus::latched;
  state.faces[2].status = FaceStatus::bonded;
  state.faces[4].status = FaceStatus::bonded;
  return state;
}

/// Writes `frames` frames, one every four steps, going on in an existing file where `keep` is
/// given.
FileDigest write(const std::string& file, TrajectoryFormat format, int from, int frames,
                 const FileDigest* keep = nullptr) {
  const Model model = small_model();
  World world(model, model.module.count);
  auto writer = open_trajectory(file, format, model, keep);
  for (int f = 0; f < from + frames; ++f) {
    if (f >= from) writer->write(world, {0, 1, 0});
    for (int i = 0; i < 4; ++i) world.step();
  }
  return writer->flush();
}

std::string trajectory_refusal(const std::string& file) {
  try {
    read_trajectory(file);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.rfind('/') + 1);
  }
  return "(accepted)";
}

constexpr TrajectoryFormat kFormats[] = {TrajectoryFormat::csv, TrajectoryFormat::binary};

TEST(Trajectory, BothFormatsHoldTheWorld) {
  const TemporaryDirectory dir;
  const Model model = small_model();
  const World world(model, bonded_state(model));
  for (const TrajectoryFormat format : kFormats) {
    const std::string file = dir.path("t");
    const auto writer = open_trajectory(file, format, model);
    writer->write(world, {0, 1, 0});
    const FileDigest digest = writer->flush();
    EXPECT_EQ(digest.length, static_cast<std::int64_t>(dir.read("t").size()));
    const Trajectory t = read_trajectory(file);
    ASSERT_EQ(t.frames(), 1);
    EXPECT_EQ(t.bodies, 4);
    EXPECT_EQ(t.modules, 3);
    EXPECT_EQ(t.time[0], 0);
    const Kinematics& k = world.kinematics();
    for (std::size_t b = 0; b < 4; ++b) {
      EXPECT_EQ(t.x[b], static_cast<float>(k.x[b]));
      EXPECT_EQ(t.y[b], static_cast<float>(k.y[b]));
      EXPECT_EQ(t.theta[b], static_cast<float>(angle_of({k.c[b], k.s[b]})));
    }
    ASSERT_EQ(t.markings.size(), 4u);
    EXPECT_EQ(t.markings[0].label, 5);
    EXPECT_EQ(t.markings[0].last, 2);
    EXPECT_EQ(t.markings[0].latched, 0b0101);
    EXPECT_EQ(t.markings[0].bonded, 0b0100);
    EXPECT_EQ(t.markings[1].label, 300);
    EXPECT_EQ(t.markings[1].complete, 1);
    EXPECT_EQ(t.markings[2].last, -1);
    EXPECT_EQ(t.markings[3].label, 0);
  }
}

TEST(Trajectory, FormatsAgreeAndNoneWritesNothing) {
  const TemporaryDirectory dir;
  write(dir.path("t.csv"), TrajectoryFormat::csv, 0, 5);
  write(dir.path("t.bin"), TrajectoryFormat::binary, 0, 5);
  const Trajectory a = read_trajectory(dir.path("t.csv")), b = read_trajectory(dir.path("t.bin"));
  ASSERT_EQ(a.frames(), 5);
  for (std::size_t f = 0; f < 5; ++f) EXPECT_NEAR(a.time[f], b.time[f], 1e-12);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_LT(2 * dir.read("t.bin").size(), dir.read("t.csv").size());
  EXPECT_EQ(write(dir.path("none"), TrajectoryFormat::none, 0, 5), FileDigest{});
  EXPECT_FALSE(dir.has("none"));
}

TEST(Trajectory, GoesOnInAFileCutToACheckpoint) {
  for (const TrajectoryFormat format : kFormats) {
    const TemporaryDirectory dir;
    write(dir.path("whole"), format, 0, 6);
    const FileDigest digest = write(dir.path("parts"), format, 0, 2);
    write(dir.path("ahead"), format, 0, 5);  // written further than its checkpoint says
    write(dir.path("parts"), format, 2, 4, &digest);
    write(dir.path("ahead"), format, 2, 4, &digest);
    EXPECT_EQ(dir.read("parts"), dir.read("whole"));
    EXPECT_EQ(dir.read("ahead"), dir.read("whole"));
    FileDigest longer = digest;
    longer.length = 1 << 20;
    EXPECT_THROW(write(dir.path("parts"), format, 0, 1, &longer), InputError);
    std::string changed = dir.read("parts");
    changed[40] = static_cast<char>(changed[40] ^ 4);
    dir.write("parts", changed);
    EXPECT_THROW(write(dir.path("parts"), format, 2, 4, &digest), InputError);
  }
}

// A kill may cut a file anywhere: what is whole is read, the rest is dropped, nothing is made up.
TEST(Trajectory, ACutLastFrameIsDropped) {
  for (const TrajectoryFormat format : kFormats) {
    const TemporaryDirectory dir;
    write(dir.path("whole"), format, 0, 3);
    const std::string bytes = dir.read("whole");
    const Trajectory whole = read_trajectory(dir.path("whole"));
    const std::size_t first = static_cast<std::size_t>(write(dir.path("one"), format, 0, 1).length);
    for (std::size_t size = first; size < bytes.size(); ++size) {
      const Trajectory t = read_trajectory(dir.write("cut", bytes.substr(0, size)));
      ASSERT_GE(t.frames(), 1);
      ASSERT_LT(t.frames(), 3);
      ASSERT_EQ(t.bodies, 4);
      const auto poses = static_cast<std::size_t>(4 * t.frames());
      ASSERT_EQ(t.x.size(), poses);
      ASSERT_EQ(t.markings.size(), poses);
      ASSERT_TRUE(std::equal(t.x.begin(), t.x.end(), whole.x.begin()));
    }
  }
}

TEST(Trajectory, ReadsPosesWithoutMarkings) {
  const TemporaryDirectory dir;
  const Trajectory t = read_trajectory(
      dir.write("r.csv", "frame,time,id,x,y,theta\r\n0,0,0,0.1,0.2,3\r\n1,0.5,0,0.2,0.2,-3\r\n"));
  EXPECT_EQ(t.frames(), 2);
  EXPECT_EQ(t.modules, 1);
  EXPECT_TRUE(t.markings.empty());
  EXPECT_EQ(t.x[1], 0.2f);
}

TEST(Trajectory, RefusesDamagedTables) {
  const TemporaryDirectory dir;
  const std::string head = "frame,time,id,x,y,theta\n";
  const std::string two = "0,0,0,1,1,0\n0,0,1,1,1,0\n";
  const std::vector<std::pair<std::string, std::string>> all{
      {"x,y\n",
       "t.csv:1:1: the first line is not "
       "\"frame,time,id,x,y,theta,label,last,latched,bonded,complete\""},
      {head + "0,0,0,1,nan,0\n", "t.csv:2:9: y 'nan' is not a finite number"},
      {head + "0,inf,0,1,1,0\n", "t.csv:2:3: time 'inf' is not a finite number"},
      {head + "0,0,0,1,1,1e99\n", "t.csv:2:11: theta '1e99' is not a finite number"},
      {head + "0,0,0,1,1\n", "t.csv:2:1: 5 columns instead of 6"},
      {head + "0,0,0,1,1,0,0\n", "t.csv:2:1: 7 columns instead of 6"},
      {head + "\n", "t.csv:2:1: 1 columns instead of 6"},
      {head + "0.5,0,0,1,1,0\n", "t.csv:2:1: frame '0.5' is not a whole number"},
      {head + "-1,0,0,1,1,0\n", "t.csv:2:1: frame '-1' is outside 0 .. 2147483647"},
      {head + "1,0,0,1,1,0\n",
       "t.csv:2:1: frame '1' instead of 0: rows are sorted by frame and id, each once"},
      {head + "0,0,1,1,1,0\n",
       "t.csv:2:5: id '1' instead of 0: rows are sorted by frame and id, each once"},
      {head + "0,0,0,1,1,0\n0,0,0,1,1,0\n",
       "t.csv:3:5: id '0' instead of 1: rows are sorted by frame and id, each once"},
      {head + two + "1,1,0,1,1,0\n1,1,1,1,1,0\n1,1,2,1,1,0\n",
       "t.csv:6:5: id '2' in a file of 2 bodies"},
      {head + two + "1,1,0,1,1,0\n2,2,0,1,1,0\n", "t.csv:5:1: the frame before has 1 of 2 bodies"},
      {head + two + "1,0,0,1,1,0\n", "t.csv:4:3: times do not rise"},
      {head + "0,0,0,1,1,0\n0,1,1,1,1,0\n", "t.csv:3:3: the time changes within a frame"},
      {"frame,time,id,x,y,theta,label,last,latched,bonded,complete\n0,0,0,1,1,0,,,,,\n"
       "0,0,1,1,1,0,1,-1,0,0,0\n",
       "t.csv:3:13: modules come before balls"},
      {"frame,time,id,x,y,theta,label,last,latched,bonded,complete\n0,0,0,1,1,0,1,4,0,0,0\n",
       "t.csv:2:15: last '4' is outside -1 .. 3"},
  };
  for (const auto& [content, message] : all) {
    EXPECT_EQ(trajectory_refusal(dir.write("t.csv", content)), message) << content;
  }
  EXPECT_EQ(trajectory_refusal(dir.path("none.csv")), "none.csv': No such file or directory");
}

TEST(Trajectory, RefusesDamagedBinaries) {
  const TemporaryDirectory dir;
  write(dir.path("whole"), TrajectoryFormat::binary, 0, 2);
  const std::string bytes = dir.read("whole");
  const auto damaged = [&](std::size_t at, const std::string& with) {
    std::string copy = bytes;
    copy.replace(at, with.size(), with);
    return trajectory_refusal(dir.write("t", copy));
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string not_a_number(reinterpret_cast<const char*>(&nan), sizeof nan);
  EXPECT_EQ(trajectory_refusal(dir.write("t", bytes.substr(0, 20))),
            "t: the trajectory's header is cut");
  EXPECT_EQ(damaged(8, "\x09"), "t: trajectory version 9 instead of 2");
  EXPECT_EQ(damaged(15, "\x7f"),
            "t: the trajectory's header is damaged: 2130706436 bodies, 3 modules");
  EXPECT_EQ(damaged(16, "\x09"), "t: the trajectory's header is damaged: 4 bodies, 9 modules");
  EXPECT_EQ(
      damaged(24 + 9, "\x09"),
      "t: frame 0 (from byte 24) was changed since it was written; --force runs the run again");
  // Frames with the checksum of what they hold, as a faulty writer would leave them.
  const std::size_t content = 8 + 4 * 18, frame = content + 4;
  const auto written = [&](std::size_t number, std::size_t at, const std::string& with) {
    std::string copy = bytes;
    const std::size_t begin = 24 + number * frame;
    copy.replace(begin + at, with.size(), with);
    const std::uint32_t sum = checksum_bits(std::string_view(copy).substr(begin, content));
    copy.replace(begin + content, 4, std::string(reinterpret_cast<const char*>(&sum), 4));
    return trajectory_refusal(dir.write("t", copy));
  };
  EXPECT_EQ(written(0, 8, not_a_number), "t: frame 0: the pose of body 0 is not finite");
  EXPECT_EQ(written(1, 0, std::string(8, '\0')), "t: frame 1: times do not rise");
}

}  // namespace
}  // namespace lilytank
