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
       {"##", "#####", ".#.\n###\n.#.", "..#..\n..#..\n#####", "##########"}) {
    const Target target = parse_target(drawing, "target.txt");
    const auto stages = stages_of(target, make_plan(target, Algorithm::linchpin));
    const std::string file = folder.file("stages.png");
    draw_stages(target, stages, "target", file);
    const auto size = png_size(file);
    EXPECT_GT(size.width, 500);
    EXPECT_GT(size.height, 150);
    EXPECT_LT(size.width, 2700);
  }
}

TEST(Stages, SameInputSamePictureAndEveryFormat) {
  const Folder folder;
  const Target target = parse_target("#.\n#.\n##", "l4.txt");
  const auto stages = stages_of(target, make_plan(target, Algorithm::singleton));
  for (const char* name : {"a.png", "b.png", "c.svg", "d.pdf"})
    draw_stages(target, stages, "l4", folder.file(name));
  EXPECT_TRUE(bytes_of(folder.file("a.png")) == bytes_of(folder.file("b.png")));
  for (const char* name : {"a.png", "c.svg", "d.pdf"})
    EXPECT_GT(bytes_of(folder.file(name)).size(), 3000u) << name;
  EXPECT_THROW(draw_stages(target, stages, "", folder.file("e.jpg")), InputError);
}

}  // namespace
