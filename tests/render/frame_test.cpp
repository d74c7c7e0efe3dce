#include <gtest/gtest.h>

#include "../../render/layout.hpp"
#include "render/picture.hpp"
#include "render/sample_run.hpp"

namespace lilytank {
namespace {

using sample::Folder;

// A tank with still water and one or more modules at rest; the second frame equals the first.
StoredRun still_run(const std::vector<sample::Drift>& poses) {
  StoredRun run;
  run.scenario.title = "still";
  run.scenario.model.module.count = static_cast<int>(poses.size());
  run.scenario.model.rulesets.push_back(sample::chain());
  run.trajectory.bodies = run.trajectory.modules = static_cast<int>(poses.size());
  for (int f = 0; f < 2; ++f) {
    run.trajectory.time.push_back(10.0 * f);
    for (const auto& p : poses) {
      run.trajectory.x.push_back(static_cast<float>(p.x));
      run.trajectory.y.push_back(static_cast<float>(p.y));
      run.trajectory.theta.push_back(static_cast<float>(p.theta));
      run.trajectory.markings.push_back({});
    }
  }
  return run;
}

FrameStyle plain(int size) {
  FrameStyle style;
  style.size = size;
  style.flow = FlowStyle::none;
  style.labels = false;
  style.trail = 0;
  return style;
}

sample::Pixel pixel_at(const sample::Pixels& pixels, double x, double y, int size) {
  const View view = view_of_tank(0.30);
  const double k = size / kPageHeight;
  return pixels.at(k * view.x(x), k * view.y(y));
}

TEST(Frame, PngHasTheSizeThatWasAskedFor) {
  const Folder folder;
  const StoredRun run = sample::run(20);
  for (const auto& [height, width] : {std::pair{360, 640}, {720, 1280}, {1080, 1920}}) {
    FrameStyle style;
    style.size = height;
    draw_frame(run, 10, style, folder.file("a.png"));
    EXPECT_EQ(sample::png_size(folder.file("a.png")), (sample::Size{width, height}));
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"}) << "nothing else is left";
}

TEST(Frame, SvgIsVectorsOfTheSameSize) {
  const Folder folder;
  FrameStyle style;
  style.size = 720;
  draw_frame(sample::run(20), 10, style, folder.file("a.svg"));
  const std::string svg = sample::bytes_of(folder.file("a.svg"));
  EXPECT_NE(svg.find("width=\"1280"), std::string::npos);
  EXPECT_NE(svg.find("height=\"720"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_EQ(svg.find("<image"), std::string::npos) << "no pixels inside";
}

TEST(Frame, AModuleLiesWhereItsPoseSays) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  const double x = 0.08, y = -0.05, theta = 0.4, side = 0.035;
  draw_frame(still_run({{x, y, theta}}), 3, plain(1080), folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  const sample::Pixel body = pixel_at(pixels, x, y, 1080);
  EXPECT_GT(difference(body, pixel_at(pixels, x - 0.06, y, 1080)), 30) << "not the water's colour";
  for (int face = 0; face < 4; ++face) {
    // Beside the face's middle, where its sign is; 0.45 of a side out is the body, 0.55 is not.
    const double a = theta + face * kPi / 2;
    const auto at = [&](double out, double aside) {
      return pixel_at(pixels, x + side * (out * std::cos(a) - aside * std::sin(a)),
                      y + side * (out * std::sin(a) + aside * std::cos(a)), 1080);
    };
    EXPECT_LT(difference(body, at(0.45, 0.25)), 12) << "face " << face;
    EXPECT_GT(difference(body, at(0.56, 0.25)), 12) << "face " << face;
  }
}

TEST(Frame, PosesBetweenStoredFramesLieOnTheLine) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  StoredRun run = still_run({{-0.1, 0.1, 0}});
  run.trajectory.x[1] = 0.1F;
  draw_frame(run, 7.5, plain(720), folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  const sample::Pixel moved = pixel_at(pixels, 0.05, 0.1, 720);
  EXPECT_GT(difference(moved, pixel_at(pixels, -0.1, 0.1, 720)), 30);
  EXPECT_GT(difference(moved, pixel_at(pixels, 0.1, 0.1, 720)), 30);
}

TEST(Frame, AFinishedCopyStandsOut) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  const double side = 0.035;
  // Two equal chains; only the upper one is finished.
  std::vector<sample::Drift> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({(i % 5 - 2) * side, i < 5 ? 0.1 : -0.1, 0});
  StoredRun run = still_run(poses);
  for (std::size_t i = 0; i < run.trajectory.markings.size(); ++i) {
    run.trajectory.markings[i] = sample::marks(static_cast<int>(i % 5), 5, false);
    run.trajectory.markings[i].complete = i % 10 < 5;
  }
  draw_frame(run, 5, plain(1080), folder.file("a.png"));
  const sample::Pixels pixels(folder.file("a.png"));
  ASSERT_TRUE(pixels.read());
  const double beside = 0.5 * side + 0.0018;
  EXPECT_GT(
      difference(pixel_at(pixels, 0, 0.1 + beside, 1080), pixel_at(pixels, 0, -0.1 + beside, 1080)),
      100)
      << "it has a halo";
  EXPECT_GT(difference(pixel_at(pixels, 0, 0.1, 1080), pixel_at(pixels, 0, -0.1, 1080)), 40)
      << "and stronger colours";
}

TEST(Frame, FacesLookDifferent) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  const double side = 0.035;
  std::vector<sample::Pixel> seen;
  for (int look = 0; look < 3; ++look) {
    StoredRun run = still_run({{-side / 2, 0, 0}, {side / 2, 0, 0}});
    for (std::size_t i = 0; i < 4; ++i) {
      const auto bit = static_cast<std::uint8_t>(i % 2 == 0 ? 1 : 4);
      if (look > 0) run.trajectory.markings[i].latched = bit;
      if (look > 1) run.trajectory.markings[i].bonded = bit;
    }
    draw_frame(run, 5, plain(1080), folder.file("a.png"));
    const sample::Pixels pixels(folder.file("a.png"));
    ASSERT_TRUE(pixels.read());
    // On the bridge, just off the line where the two squares meet.
    seen.push_back(pixel_at(pixels, 0.06 * side, 0.0, 1080));
  }
  EXPECT_GT(difference(seen[0], seen[1]), 40);
  EXPECT_GT(difference(seen[0], seen[2]), 40);
  EXPECT_GT(difference(seen[1], seen[2]), 40);
}

TEST(Frame, RecordingsWithoutMarkingsAndBallsCanBeDrawn) {
  const Folder folder;
  StoredRun run = still_run({{0, 0, 0}, {0.1, 0, 0}});
  run.trajectory.markings.clear();
  run.trajectory.modules = 1;
  run.scenario.model.rulesets.clear();
  run.scenario.title.clear();
  for (const FlowStyle flow : {FlowStyle::none, FlowStyle::arrows, FlowStyle::streamlines}) {
    FrameStyle style;
    style.size = 240;
    style.flow = flow;
    run.scenario.model.field = sample::swirl(0.3);
    EXPECT_NO_THROW(draw_frame(run, 5, style, folder.file("a.png")));
  }
}

TEST(Frame, RefusesWhatCannotBeDrawn) {
  const Folder folder;
  const StoredRun run = still_run({{0, 0, 0}});
  const FrameStyle style = plain(240);
  EXPECT_THROW(draw_frame(run, -1, style, folder.file("a.png")), InputError);
  EXPECT_THROW(draw_frame(run, 10.5, style, folder.file("a.png")), InputError);
  EXPECT_THROW(draw_frame(run, std::nan(""), style, folder.file("a.png")), InputError);
  EXPECT_THROW(draw_frame(run, 5, style, folder.file("a.jpg")), InputError);
  EXPECT_THROW(draw_frame(run, 5, style, folder.file("png")), InputError);
  EXPECT_THROW(draw_frame(run, 5, style, folder.file("no/such/a.png")), InputError);
  EXPECT_THROW(draw_frame(run, 5, plain(0), folder.file("a.png")), InputError);
  EXPECT_THROW(draw_frame(StoredRun{}, 0, style, folder.file("a.png")), InputError);
  EXPECT_TRUE(folder.names().empty());
  try {
    draw_frame(run, 5, style, folder.file("a.jpg"));
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(".png, .svg or .pdf"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace lilytank
