// Rows of events.csv, read back.
#include "lilytank/run_events.hpp"

#include <gtest/gtest.h>

namespace lilytank {
namespace {

std::string refusal(const std::string& rows) {
  try {
    read_events(kEventColumns + "\n" + rows, "events.csv", 3);
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

TEST(RunEvents, EveryCellIsRead) {
  const auto rows = read_events(kEventColumns +
                                    "\n2.25,90,link,1,3,2,0,r1,1,2,4,3,\n3,120,copy,,,,,,,,,,1\n"
                                    "4,160,command,,,,,pause,,,,,\n5,2",
                                "events.csv", 3);
  ASSERT_EQ(rows.size(), 3u);  // the cut last row is dropped
  const StoredEvent& e = rows[0];
  EXPECT_EQ(e.time, 2.25);
  EXPECT_EQ(event_words()[static_cast<std::size_t>(e.kind)], "link");
  EXPECT_EQ((std::vector{e.a, e.face_a, e.b, e.face_b}), (std::vector{1, 3, 2, 0}));
  EXPECT_EQ((std::vector{e.label_a, e.last_a, e.label_b, e.last_b}), (std::vector{1, 2, 4, 3}));
  EXPECT_EQ(e.rule, "r1");
  EXPECT_EQ(rows[1].kind, kCopyEvent);
  EXPECT_EQ(rows[1].copies, 1);
  EXPECT_EQ(rows[2].rule, "pause");
  EXPECT_EQ(rows[2].a, -1);
}

TEST(RunEvents, ChangedRowsAreRefusedWithTheirPlace) {
  EXPECT_NE(refusal("2,80,links,0,1,2,3,,1,1,2,2,\n").find("events.csv:2:6"), std::string::npos);
  EXPECT_NE(refusal("2,80,link,3,1,2,3,,1,1,2,2,\n").find("events.csv:2:11"), std::string::npos);
  EXPECT_NE(refusal("2,80,latch,,,2,3,,1,1,2,2,\n").find("events.csv:2:"), std::string::npos);
  EXPECT_NE(refusal("2,80,copy,,,,,,,,,,\n").find("events.csv:2:"), std::string::npos);
}

}  // namespace
}  // namespace lilytank
