#include <gtest/gtest.h>

#include <atomic>

#include "render/picture.hpp"
#include "render/sample_run.hpp"

namespace lilytank {
namespace {

using sample::Folder;

FilmOptions one_second() {
  FilmOptions options;
  options.from = 5;
  options.to = 15;
  options.speed = 10;
  options.fps = 20;
  options.style.size = 180;
  return options;
}

std::string probe(const std::string& file) {
  return sample::output_of(
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,width,height,pix_fmt,nb_read_frames -of csv=p=0 '" +
      file + "'");
}

// PATH as another program would see it, put back at the end of a test.
class Path {
 public:
  explicit Path(const std::string& value) : before_(std::getenv("PATH")) {
    ::setenv("PATH", value.c_str(), 1);
  }
  ~Path() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

// A program that stands in for ffmpeg.
void write_script(const std::string& file, const std::string& text) {
  std::ofstream(file) << "#!/bin/sh\n" << text << "\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

TEST(Film, Mp4HasTheRightFramesAndSize) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "films need ffmpeg";
  const Folder folder;
  FilmOptions options = one_second();
  double last = 0;
  bool rising = true;
  options.progress = [&](double done, const std::string&) {
    rising = rising && done > last, last = done;
  };
  draw_film(sample::run(20), options, folder.file("a.mp4"));
  EXPECT_EQ(probe(folder.file("a.mp4")), "h264,320,180,yuv420p,20\n");
  EXPECT_TRUE(rising);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.mp4"}) << "no temporary file is left";
}

TEST(Film, OddHeightsAreMadeEven) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "films need ffmpeg";
  const Folder folder;
  FilmOptions options = one_second();
  options.style.size = 181;
  draw_film(sample::run(20), options, folder.file("a.mp4"));
  EXPECT_EQ(probe(folder.file("a.mp4")), "h264,320,180,yuv420p,20\n");
}

TEST(Film, GifHasTheRightFramesAndSize) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "films need ffmpeg";
  const Folder folder;
  draw_film(sample::run(20), one_second(), folder.file("a.gif"));
  const std::string found = probe(folder.file("a.gif"));
  EXPECT_EQ(found.substr(0, 12), "gif,320,180,") << found;
  EXPECT_EQ(found.substr(found.size() - 4), ",20\n") << found;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.gif"});
}

TEST(Film, ASingleMomentIsAFilmOfOneFrame) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "films need ffmpeg";
  const Folder folder;
  FilmOptions options = one_second();
  options.to = options.from;
  for (const char* name : {"a.mp4", "a.gif"}) {
    draw_film(sample::run(20), options, folder.file(name));
    const std::string found = probe(folder.file(name));
    EXPECT_EQ(found.substr(found.size() - 3), ",1\n") << found;
  }
}

TEST(Film, SaysWhenFfmpegIsMissing) {
  const Folder folder;
  const StoredRun run = sample::run(20);
  const Path nowhere(folder.file("no_programs_here"));
  try {
    draw_film(run, one_second(), folder.file("a.mp4"));
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("ffmpeg is not in PATH"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Film, SurvivesAnFfmpegThatStopsReading) {
  const Folder folder, programs;
  write_script(programs.file("ffmpeg"), "echo 'the disk is full' >&2; exit 1");
  const Path path(programs.path());
  FilmOptions options = one_second();
  options.fps = 100;  // more than any buffer between us and it holds
  try {
    draw_film(sample::run(20), options, folder.file("a.mp4"));
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("the disk is full"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Film, AFailureAtTheEndLeavesNoFile) {
  const Folder folder, programs;
  write_script(programs.file("ffmpeg"), "/bin/cat > /dev/null; echo late >&2; exit 3");
  const Path path(programs.path());
  EXPECT_THROW(draw_film(sample::run(20), one_second(), folder.file("a.mp4")), InputError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Film, ManyMessagesDoNotBlockIt) {
  const Folder folder, programs;
  write_script(programs.file("ffmpeg"),
               "i=0; while [ $i -lt 4000 ]; do echo 'a long and winding message, again and again'"
               " >&2; i=$((i+1)); done; /bin/cat > /dev/null; exit 3");
  const Path path(programs.path());
  EXPECT_THROW(draw_film(sample::run(20), one_second(), folder.file("a.mp4")), InputError);
}

TEST(Film, KeepsAnOldFileWhereItFails) {
  const Folder folder, programs;
  std::ofstream(folder.file("a.mp4")) << "old";
  write_script(programs.file("ffmpeg"), "exit 1");
  const Path path(programs.path());
  EXPECT_THROW(draw_film(sample::run(20), one_second(), folder.file("a.mp4")), InputError);
  EXPECT_EQ(sample::bytes_of(folder.file("a.mp4")), "old");
}

TEST(Film, StopsWhenAskedAndLeavesNothing) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "films need ffmpeg";
  const Folder folder;
  FilmOptions options = one_second();
  std::atomic<bool> stop = false;
  options.stop = &stop;
  int frames = 0;
  options.progress = [&](double, const std::string&) { stop = ++frames == 3; };
  EXPECT_THROW(draw_film(sample::run(20), options, folder.file("a.mp4")), Stopped);
  EXPECT_EQ(frames, 3);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Film, RefusesWhatMakesNoFilm) {
  const Folder folder;
  const StoredRun run = sample::run(20);
  const auto refused = [&](auto change, const std::string& name) {
    FilmOptions options = one_second();
    change(options);
    EXPECT_THROW(draw_film(run, options, folder.file(name)), InputError) << name;
  };
  refused([](FilmOptions&) {}, "a.avi");
  refused([](FilmOptions&) {}, "no/such/a.mp4");
  refused([](FilmOptions& o) { o.fps = 0; }, "a.mp4");
  refused([](FilmOptions& o) { o.speed = -1; }, "a.mp4");
  refused([](FilmOptions& o) { o.to = 1000; }, "a.mp4");
  refused([](FilmOptions& o) { o.from = 16; }, "a.mp4");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Stills, AreTheFilmsFramesAsNumberedFiles) {
  const Folder folder;
  FilmOptions options = one_second();
  options.fps = 5;
  draw_stills(sample::run(20), options, folder.file("new/stills"));
  for (int k = 0; k < 5; ++k) {
    const std::string name = "new/stills/frame_00000" + std::to_string(k) + ".png";
    EXPECT_EQ(sample::png_size(folder.file(name)), (sample::Size{320, 180}));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("new/stills/frame_000005.png")));
}

}  // namespace
}  // namespace lilytank
