#include "lilytank/target.hpp"

#include <gtest/gtest.h>

#include "support/polyominoes.hpp"

using namespace lilytank;

namespace {

std::string complaint(const std::string& text) {
  try {
    parse_target(text, "t.txt");
  } catch (const InputError& e) {
    return e.what();
  }
  return "(none)";
}

TEST(Target, CompactDrawing) {
  const Target target = parse_target("; an L\nname l4\n  #.\n  #\n  ##\n\n", "t.txt");
  EXPECT_EQ(target.name, "l4");
  EXPECT_EQ(target.cells, (std::vector<Cell>{{0, 2}, {0, 1}, {0, 0}, {1, 0}}));
  EXPECT_TRUE(target.bonds.empty());
  EXPECT_EQ(parse_target("##", "dir/pair.v2.txt").name, "pair");
  EXPECT_EQ(parse_target("\xEF\xBB\xBF##\r\n##\r\n", "t.txt").cells.size(), 4u);
}

TEST(Target, SpacedDrawingWithBonds) {
  const Target target = parse_target("#-#\n|  \n#-#\n", "t.txt");
  EXPECT_EQ(target.cells.size(), 4u);
  EXPECT_EQ(target.bonds, (std::vector<Contact>{{0, 1}, {0, 2}, {2, 3}}));
  EXPECT_FALSE(target.ordered);
  // An oddly placed drawing is the same.
  EXPECT_EQ(parse_target("\n   #-#\n   |\n   #-#\n", "t.txt").bonds, target.bonds);
}

TEST(Target, NumberedBonds) {
  const Target target = parse_target("#3#\n1 .\n#2#\n", "t.txt");
  EXPECT_TRUE(target.ordered);
  EXPECT_EQ(target.bonds, (std::vector<Contact>{{0, 2}, {2, 3}, {0, 1}}));
  const Target chain = parse_target("#1#2#3#4#5#6#7#8#9#a#b#", "t.txt");
  EXPECT_EQ(chain.bonds.back(), (Contact{10, 11}));
}

TEST(Target, DrawingsReadBack) {
  for (const auto& shape : lilytank::test::one_sided_polyominoes(5)) {
    const Target target = target_of(shape, "shape");
    EXPECT_EQ(parse_target(to_text(target), "t.txt").cells, target.cells);
  }
  for (const char* text : {"#-#\n|\n#-#\n", "#3#\n1\n#2#\n"}) {
    const Target target = parse_target(text, "t.txt");
    const Target again = parse_target(to_text(target), "t.txt");
    EXPECT_EQ(again.bonds, target.bonds);
    EXPECT_EQ(again.ordered, target.ordered);
  }
}

TEST(Target, Handedness) {
  EXPECT_TRUE(is_chiral(parse_target("#.\n#.\n##", "l.txt")));
  EXPECT_FALSE(is_chiral(parse_target("##\n##", "o.txt")));
  EXPECT_EQ(canonical_shape(mirrored(parse_target("#.\n#.\n##", "l.txt")).cells),
            canonical_shape(parse_target(".#\n.#\n##", "j.txt").cells));
}

TEST(TargetErrors, NameThePlace) {
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "t.txt: there is no '#'"},
      {"; nothing\n...\n", "there is no '#'"},
      {"#", "two modules or more"},
      {"##\n#*", "t.txt:2:2: '*' in a drawing"},
      {"##\n#x", "t.txt:1:2: this '#' is out of step with the first one: as there is a bond, 'x'"},
      {"#\t#", "t.txt:1:2: a tab"},
      {"##\n..\n##", "t.txt:1: the drawing is in several pieces"},
      {"#.\n.#", "several pieces"},
      {"name 1st\n##", "t.txt:1:6: '1st' is not a name"},
      {"name\n##", "'' is not a name"},
      {"name a\nname b\n##", "t.txt:2:1: 'name' is given twice"},
      {"##\nname a", "t.txt:2:1: 'name' stands before"},
      {"#-\n", "t.txt:1:2: '-' joins nothing"},
      {"#-#\n-\n#-#", "t.txt:2:1: '-' is turned the wrong way"},
      {"#|#", "t.txt:1:2: '|' is turned the wrong way"},
      {"#-#\n #", "t.txt:2:2: this '#' is out of step"},
      {"#-#\n -\n#-#", "t.txt:2:2: '-' is not between two cells"},
      {"#-#-#\n\n#-#-#", "t.txt:1: the drawn bonds do not hold all modules together"},
      {"#1#-#", "t.txt:1:4: this bond has no number"},
      {"#1#1#", "t.txt:1:4: the number '1' is there twice"},
      {"#1#3#", "t.txt:1:4: there is a bond numbered '3' but none numbered '2'"},
      {"#1#\n2 3\n#4#", "t.txt:1: numbered bonds must be a tree: 4 modules need 3 bonds"},
      {"-", "t.txt:1:1: there are bonds but no '#'"},
  };
  for (const auto& c : cases)
    EXPECT_NE(complaint(c.text).find(c.message), std::string::npos)
        << c.text << "\n-> " << complaint(c.text);
  EXPECT_NE(complaint(std::string(200, '#')).find("too large"), std::string::npos);
  EXPECT_THROW(read_target("/nowhere/t.txt"), InputError);
}

}  // namespace
