// What legends write where names are too wide.
#include "../../render/cut_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace lilytank {
namespace {

// Every character is one wide, ten at most fit.
std::vector<std::string> cut(const std::vector<std::string>& names) {
  return cut_apart(names, 10, [](const std::string& text) {
    return static_cast<double>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  });
}

using Texts = std::vector<std::string>;

TEST(LegendTexts, NamesThatFitStayWhole) {
  EXPECT_EQ(cut({"a", "count=10", "ten wide µµ"}), (Texts{"a", "count=10", "ten wide …"}));
  EXPECT_EQ(cut({"same", "same"}), (Texts{"same", "same"}));
  EXPECT_EQ(cut({}), Texts{});
}

TEST(LegendTexts, AreCutWhereNamesStayApart) {
  EXPECT_EQ(cut({"a long name", "b long name"}), (Texts{"a long na…", "b long na…"}));
  EXPECT_EQ(cut({"a setting with µ=1", "a setting with µ=2", "short"}),
            (Texts{"… with µ=1", "… with µ=2", "short"}));
  EXPECT_EQ(cut({"a setting p=1, clock=events", "a setting p=2, clock=events"}),
            (Texts{"1: a sett…", "2: a sett…"}));
}

}  // namespace
}  // namespace lilytank
