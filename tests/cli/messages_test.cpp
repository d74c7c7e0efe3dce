// What the program says is one printable line that names the file, whatever the input holds.
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace lilytank {
namespace {

bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7f;
  });
}

class MessagesTest : public testing::Test {
 protected:
  MessagesTest() { lilytank_.here.write("tiny.toml", kTiny); }
  std::string refusal(const std::string& arguments) {
    const Answer outcome = lilytank_(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(has_control(outcome.err)) << outcome.err;
    return outcome.err;
  }
  Program lilytank_;
};

TEST_F(MessagesTest, ControlCharactersOfTheInputAreShownAsText) {
  EXPECT_EQ(refusal("run \"$(printf 'no\\nsuch\\033[31m.toml')\""),
            "cannot read 'no\\nsuch\\x1b[31m.toml': No such file or directory\n");
  EXPECT_EQ(refusal("\"$(printf '\\033[2J')\""),
            "unknown verb '\\x1b[2J' - 'lilytank help' lists what there is\n");
  lilytank_.here.write("key.toml", "\"\\u001b[2J\\n\" = 1\n");
  EXPECT_TRUE(refusal("info key.toml").starts_with("key.toml:1:1: "));
  lilytank_.here.write("latin.toml", "title = \"M\xfcll\"\n");
  EXPECT_TRUE(refusal("info latin.toml").starts_with("latin.toml:1:"));
  lilytank_.here.write("title.toml", "title = \"\\u001b[31mred\"\n");
  const Answer info = lilytank_("info title.toml");
  EXPECT_EQ(info.code, 0);
  EXPECT_FALSE(has_control(info.out));
  EXPECT_NE(info.out.find("[31mred"), std::string::npos) << "shown, but as text";
}

TEST_F(MessagesTest, TwoDashesEndTheOptions) {
  lilytank_.here.write("-dash.toml", kTiny);
  lilytank_.here.write("--out", kTiny);
  EXPECT_EQ(lilytank_("run --quiet --out a -- -dash.toml").code, 0);
  EXPECT_EQ(lilytank_("info -- --out").code, 0);
  EXPECT_EQ(refusal("info -dash.toml"), "lilytank info: unknown option '-dash.toml'\n");
  EXPECT_EQ(refusal("info -- --none"), "cannot read '--none': No such file or directory\n");
}

TEST_F(MessagesTest, ARefusalOfAnotherRunShowsWhatDiffers) {
  ASSERT_EQ(lilytank_("run tiny.toml --out a --quiet").code, 0);
  const std::string whole = lilytank_.here.read("a/resolved.toml");
  std::string text = whole;
  const auto note = text.find("name of the scenario");
  ASSERT_NE(note, std::string::npos);
  text[note] = 'N';
  lilytank_.here.write("a/resolved.toml", text);
  const std::string noted = refusal("run tiny.toml --out a");
  EXPECT_NE(noted.find("resolved.toml:2 was changed"), std::string::npos) << noted;
  EXPECT_NE(noted.find("Name of the scenario"), std::string::npos) << noted;
  text = whole;
  text.insert(text.find('\n'), "\r");
  lilytank_.here.write("a/resolved.toml", text);
  const std::string unseen = refusal("run tiny.toml --out a");
  EXPECT_NE(unseen.find("\\r', here"), std::string::npos) << unseen;
}

TEST_F(MessagesTest, ARunThatHasJustBegunHasNoFrame) {
  ASSERT_EQ(lilytank_("run tiny.toml --out a --quiet").code, 0);
  lilytank_.here.write("b/resolved.toml", lilytank_.here.read("a/resolved.toml"));
  EXPECT_NE(refusal("analyze b").find("b/trajectory.bin: there is no frame"), std::string::npos);
  lilytank_.here.write("b/trajectory.bin", "");
  EXPECT_NE(refusal("analyze b").find("b/trajectory.bin: there is no frame"), std::string::npos);
}

TEST_F(MessagesTest, BodiesThatDoNotFitAreOfAFile) {
  lilytank_.here.write("full.toml", "[module]\ncount = 500\n");
  for (const char* how : {"", " --dry-run"}) {
    const std::string err = refusal("run tiny.toml full.toml" + std::string(how));
    EXPECT_TRUE(err.starts_with("full.toml: only ")) << err;
  }
}

TEST_F(MessagesTest, MemoryThatRunsOutIsOfTheCommand) {
  lilytank_.here.write("big.txt", "x");
  std::filesystem::resize_file(lilytank_.here.path("big.txt"), 1'000'000'000);  // of holes
#ifndef __SANITIZE_ADDRESS__
  TemporaryDirectory aside;
  const std::string limited = "ulimit -v 300000; cd '" + lilytank_.here.path() +
                              "' && '" LILYTANK_PROGRAM "' synthesize big.txt 2> '" +
                              aside.path("err") + "'";
  const int status = std::system(limited.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_EQ(aside.read("err"), "lilytank synthesize big.txt: out of memory\n");
#endif
}

TEST_F(MessagesTest, ClosedStreamsTakeNoTextIntoFiles) {
  ASSERT_EQ(lilytank_("run tiny.toml --out a --quiet").code, 0);
  lilytank_("run tiny.toml --out b --quiet >&- <&-");
  EXPECT_EQ(lilytank_.files("a"), lilytank_.files("b"));
  EXPECT_EQ(refusal("info tiny.toml >&-"), "cannot write to standard output\n");
}

}  // namespace
}  // namespace lilytank
