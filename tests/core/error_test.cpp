#include "lilytank/error.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lilytank {
namespace {

using Words = std::vector<std::string>;

TEST(Error, PlaceTellsWhatIsKnown) {
  EXPECT_EQ((SourcePlace{"tank.toml", 14, 3}).text(), "tank.toml:14:3");
  EXPECT_EQ((SourcePlace{"tank.toml", 14, 0}).text(), "tank.toml:14");
  EXPECT_EQ((SourcePlace{"tank.toml", 0, 3}).text(), "tank.toml");
}

TEST(Error, MessageBeginsWithThePlace) {
  EXPECT_STREQ(InputError({"a.csv", 2, 1}, "no").what(), "a.csv:2:1: no");
  EXPECT_STREQ(InputError("no").what(), "no");
}

TEST(Error, NearestWordByEdits) {
  const Words words{"radius", "count", "K_F", "latches"};
  EXPECT_EQ(nearest_word("radus", words), "radius");    // left out
  EXPECT_EQ(nearest_word("raddius", words), "radius");  // too much
  EXPECT_EQ(nearest_word("cuont", words), "count");     // swapped: one edit, not two
  EXPECT_EQ(nearest_word("K_f", words), "K_F");         // replaced
  EXPECT_EQ(nearest_word("latch", words), "latches");
}

TEST(Error, NothingNearIsNothing) {
  const Words words{"radius", "on"};
  EXPECT_EQ(nearest_word("viscosity", words), "");
  EXPECT_EQ(nearest_word("of", words), "");  // half of its letters differ
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(did_you_mean("viscosity", words), "");
  EXPECT_EQ(did_you_mean("radios", words), " - did you mean 'radius'?");
}

TEST(Error, FirstOfEquallyNearWords) {
  EXPECT_EQ(nearest_word("size", Words{"side", "siye", "sire"}), "side");
}

}  // namespace
}  // namespace lilytank
