// Statistics of connections, from events of known bonds.
#include "jobs/bonds.hpp"

#include <gtest/gtest.h>

namespace lilytank {
namespace {

StoredEvent event(double time, const std::string& kind, int a, int face_a, int b, int face_b,
                  const std::string& rule = "") {
  StoredEvent e;
  e.time = time, e.a = a, e.face_a = face_a, e.b = b, e.face_b = face_b, e.rule = rule;
  const auto& words = event_words();
  e.kind = static_cast<int>(std::find(words.begin(), words.end(), kind) - words.begin());
  return e;
}

// Modules with a straight chain of three as their target.
Model chain_model() {
  Model model;
  model.module.count = 4;
  model.rulesets.emplace_back();
  model.rulesets[0].target = {{0, 0}, {1, 0}, {2, 0}};
  return model;
}

TEST(Bonds, AJoinIsRightWhereItsAssemblyIsPartOfTheTarget) {
  // 0 and 1 face to face, then 2 beyond 1; 3 at 1's side.
  const auto bonds = bonds_of({event(1, "latch", 0, 0, 1, 2), event(2, "link", 0, 0, 1, 2, "r1"),
                               event(3, "latch", 2, 3, 1, 0), event(4, "link", 2, 3, 1, 0, "r2"),
                               event(5, "latch", 1, 1, 3, 0), event(6, "link", 1, 1, 3, 0, "r3"),
                               event(9, "unlink", 1, 1, 3, 0, "r3_reverse")},
                              chain_model());
  ASSERT_EQ(bonds.size(), 3u);
  EXPECT_EQ(bonds[0].right, 1);
  EXPECT_EQ(bonds[1].right, 1);
  EXPECT_EQ(bonds[1].size, 3);
  EXPECT_EQ(bonds[2].right, 0);
  EXPECT_EQ(bonds[2].size, 4);
  EXPECT_EQ(bonds[2].end, "r3_reverse");
  EXPECT_EQ(bonds[2].released, 9);
  EXPECT_EQ(bonds[0].released, -1);
}

TEST(Bonds, ABendIsNoPartOfAChain) {
  const auto bonds = bonds_of({event(1, "latch", 0, 0, 1, 2), event(2, "link", 0, 0, 1, 2, "r1"),
                               event(3, "latch", 2, 0, 1, 1), event(4, "link", 2, 0, 1, 1, "r1")},
                              chain_model());
  EXPECT_EQ(bonds[1].size, 3);
  EXPECT_EQ(bonds[1].right, 0);
}

TEST(Bonds, LatchesAndBondsThatHoldAreCounted) {
  const auto bonds = bonds_of({event(1, "latch", 0, 0, 1, 2), event(3, "unlatch", 1, 2, 0, 0),
                               event(4, "latch", 0, 0, 1, 2), event(5, "link", 1, 2, 0, 0, "r1")},
                              chain_model());
  ASSERT_EQ(bonds.size(), 2u);
  EXPECT_EQ(bonds[0].end, "unlatch");
  EXPECT_EQ(bonds[0].right, -1);
  const std::string table = bonds_table(bonds);
  EXPECT_NE(table.find("\n1,,3,0,0,1,2,,unlatch,,\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n4,5,,0,0,1,2,r1,,2,1\n"), std::string::npos) << table;
  const ReportSection section = bonds_section(bonds, 100);
  ASSERT_EQ(section.table.rows.size(), 2u);
  EXPECT_EQ(section.table.rows[0][3].substr(0, 3), "2 s");  // a latch of two seconds
  EXPECT_EQ(section.table.rows[1][3], "-");                 // none of the bonds has ended
}

TEST(Bonds, WithoutRulesALatchJoins) {
  Model model;
  model.module.count = 2;
  const auto bonds = bonds_of({event(1, "latch", 0, 0, 1, 2)}, model);
  EXPECT_EQ(bonds[0].joined, 1);
  EXPECT_EQ(bonds[0].right, -1);
  EXPECT_EQ(bonds[0].size, 2);
}

}  // namespace
}  // namespace lilytank
