#include <gtest/gtest.h>

#include "lilytank/render.hpp"
#include "picture.hpp"

using namespace lilytank;
using lilytank::sample::bytes_of;
using lilytank::sample::Folder;
using lilytank::sample::png_size;

namespace {

TEST(Stages, EveryShapeFitsItsPage) {
  const Folder folder;
  for (const char* drawing :
       {"##", "#####", ".#.\n###\n.#.", "..#..\n..#..\n#####", "###################"}) {
    const Target target = parse_target(drawing, "target.txt");
    for (const Algorithm algorithm : {Algorithm::singleton, Algorithm::linchpin}) {
      const auto stages = stages_of(target, make_plan(target, algorithm));
      const std::string file = folder.file("stages.png");
      draw_stages(target, stages, "target", file);
      const auto size = png_size(file);
      EXPECT_GT(size.width, 500);
      EXPECT_GT(size.height, 150);
      EXPECT_LT(size.width, 3200);
    }
  }
}

TEST(Stages, SameInputSamePictureInEveryFormat) {
  const Folder folder;
  const Target target = parse_target("#.\n#.\n##", "l4.txt");
  const auto stages = stages_of(target, make_plan(target, Algorithm::singleton));
  for (const char* ending : {"png", "svg"}) {
    const std::string a = folder.file(std::string("a.") + ending);
    const std::string b = folder.file(std::string("b.") + ending);
    draw_stages(target, stages, "l4", a);
    draw_stages(target, stages, "l4", b);
    EXPECT_EQ(bytes_of(a), bytes_of(b));
    EXPECT_GT(bytes_of(a).size(), 3000u);
  }
  EXPECT_NO_THROW(draw_stages(target, stages, "", folder.file("c.pdf")));
  EXPECT_THROW(draw_stages(target, stages, "", folder.file("c.jpg")), InputError);
}

}  // namespace
