#include <gtest/gtest.h>

#include "io/atomic_file.hpp"
#include "lilytank/render.hpp"
#include "picture.hpp"

using namespace lilytank;
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
    write_atomically(file, stages_picture(target, stages, "target", file));
    const auto size = png_size(file);
    EXPECT_GT(size.width, 500);
    EXPECT_GT(size.height, 150);
    EXPECT_LT(size.width, 2700);
  }
}

TEST(Stages, SameInputSamePictureAndEveryFormat) {
  const Target target = parse_target("#.\n#.\n##", "l4.txt");
  const auto stages = stages_of(target, make_plan(target, Algorithm::singleton));
  const auto picture = [&](const std::string& file) {
    return stages_picture(target, stages, "l4", file);
  };
  EXPECT_TRUE(picture("a.png") == picture("b.png"));
  for (const char* name : {"a.png", "c.svg", "d.pdf"})
    EXPECT_GT(picture(name).size(), 3000u) << name;
  EXPECT_THROW(picture("e.jpg"), InputError);
}

}  // namespace
