// What a start is refused for: bodies in one place, or beyond the wall.
#include "lilytank/start.hpp"

#include "support/scenario_files.hpp"
#include "support/worlds.hpp"

namespace lilytank {
namespace {

class Start : public test::ScenarioTest {
 protected:
  std::string with_poses(const std::string& rows, int modules, int balls = 0) const {
    dir_.write("p.csv", "id,x,y,theta\n" + rows);
    return refusal("[module]\ncount = " + std::to_string(modules) +
                   "\n[ball]\ncount = " + std::to_string(balls) + "\n[start]\nfile = \"p.csv\"\n");
  }
};

TEST_F(Start, NamesBothBodiesAndTheirLines) {
  EXPECT_EQ(with_poses("0,0,0,0\n1,0.1,0,0\n2,0.1,0,0\n", 3),
            "p.csv:4: module 1 (line 3) and module 2 overlap by 35 mm at the start, more than 0.5 "
            "mm");
  EXPECT_EQ(with_poses("0,0,0,0\n1,0.0344,0,0\n", 2),
            "p.csv:3: module 0 (line 2) and module 1 overlap by 0.6 mm at the start, more than 0.5 "
            "mm");
  EXPECT_EQ(with_poses("0,0,0,0\n1,0.03,0,0\n", 1, 1),
            "p.csv:3: module 0 (line 2) and ball 0 overlap by 2.5 mm at the start, more than 0.5 "
            "mm");
  EXPECT_EQ(with_poses("0,0,0,0\n1,0.02,0,0\n", 0, 2),
            "p.csv:3: ball 0 (line 2) and ball 1 overlap by 10 mm at the start, more than 0.5 mm");
}

TEST_F(Start, NamesABodyBeyondTheWall) {
  EXPECT_EQ(with_poses("0,0,0,0\n1,0,0.3,0\n", 1, 1),
            "p.csv:3: ball 0 reaches beyond the wall of the tank by 15 mm at the start, more than "
            "0.5 mm");
  EXPECT_NE(with_poses("0,0.9,0,0\n", 1).find("module 0 reaches beyond the wall"),
            std::string::npos);
}

TEST_F(Start, AcceptsTouchingBodiesRoundedToATenthOfAMillimetre) {
  EXPECT_EQ(with_poses("0,0,0,0\n1,0.0349,0,0.001\n", 2), "(accepted)");
  // A face flat on the wall: its corners touch it, though the circle about the module does not fit.
  EXPECT_EQ(with_poses("0,0.2819,0,0\n", 1), "(accepted)");
}

TEST(StartOverlap, TheFirstFrameCounts) {
  Model model = standard_model();
  model.module.count = 2;
  model.start = {Layout::poses, 0, 0, {Pose{}, Pose{0.0346, 0}}};
  const World world(model, 1);
  EXPECT_NEAR(world.tallies().deepest_overlap, 0.4e-3, 1e-9);
  EXPECT_NEAR(deepest_overlap(model, world.state()).depth, 0.4e-3, 1e-9);
}

TEST(StartOverlap, APosesStartIsCheckedWithoutAFile) {
  Model model = standard_model();
  model.module.count = 2;
  model.start = {Layout::poses, 0, 0, {Pose{}, Pose{0.01, 0}}};
  EXPECT_THROW(initial_state(model, 1), InputError);
}

}  // namespace
}  // namespace lilytank
