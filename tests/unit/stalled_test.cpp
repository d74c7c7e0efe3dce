// A world that was given up because a step took too much work: what its result says.
#include <gtest/gtest.h>

#include "jobs/checkpoint.hpp"
#include "jobs/report.hpp"

namespace lilytank {
namespace {

TEST(Stalled, NamesStepBodyAndWork) {
  Model model = standard_model();
  model.ball.count = 2;
  EXPECT_EQ(divergence_text({40, 3, kStalled, 4e8}, model),
            "stalled at 1 s (step 40): module 3 and what it touches take more than 4e+08 visits of "
            "contacts in one step");
  EXPECT_EQ(divergence_text({40, 16, "face_drag", 2.5}, model),
            "diverged at 1 s (step 40): ball 1, largest force face_drag, 2.5 N");
}

TEST(Stalled, ACheckpointKeepsTheReason) {
  const Model model = standard_model();
  Checkpoint c;
  c.finished = true, c.status = RunStatus::diverged;
  c.divergence = {40, 3, kStalled, 4e8};
  c.state = initial_state(model, 1);
  const Checkpoint again = checkpoint_from(to_bytes(c, 5), 5, "x");
  EXPECT_EQ(again.status, RunStatus::diverged);
  EXPECT_EQ(again.divergence.force, kStalled);
  EXPECT_EQ(again.divergence.size, 4e8);
}

}  // namespace
}  // namespace lilytank
