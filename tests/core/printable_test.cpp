// Text of the input on a terminal.
#include "text/printable.hpp"

#include <gtest/gtest.h>

namespace lilytank {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  for (const char* text : {"", "K_F = 0.442", "a 'b' \"c\" \\ %s", "Größe µm → 日本 🌸"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesControlCharactersOnOneLine) {
  EXPECT_EQ(printable("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(printable("\x1b[31mred\x07"), "\\x1b[31mred\\x07");
  EXPECT_EQ(printable(std::string_view("\0\x7f", 2)), "\\x00\\x7f");
  EXPECT_EQ(printable("\xc2\x9b[2J"), "\\xc2\\x9b[2J") << "CSI as one character";
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("M\xfcll"), "M\\xfcll");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82") << "cut";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "longer than needed";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
  EXPECT_EQ(printable("\xf5\x80\x80\x80"), "\\xf5\\x80\\x80\\x80") << "beyond the last character";
}

TEST(Printable, EscapesWhatEndsALineOrTurnsTheDirection) {
  EXPECT_EQ(printable("a\u2028b"), "a\\xe2\\x80\\xa8b");
  EXPECT_EQ(printable("txt.\u202Egpj"), "txt.\\xe2\\x80\\xaegpj");
}

TEST(Printable, DoesNothingMoreASecondTime) {
  const std::string once = printable("\x1b[0m\n\xff");
  EXPECT_EQ(printable(once), once);
}

}  // namespace
}  // namespace lilytank
