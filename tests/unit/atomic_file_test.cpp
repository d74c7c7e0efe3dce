// Files are replaced whole; what is no regular file is left what it is.
#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  std::string refusal(const std::string& file) const {
    try {
      write_atomically(file, "new");
    } catch (const InputError& e) {
      return e.what();
    }
    return "(written)";
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(here_.path())) {
      out.push_back(entry.path().filename().string());
    }
    std::sort(out.begin(), out.end());
    return out;
  }
  TemporaryDirectory here_;
};

TEST_F(AtomicFile, ReplacesAFileAndLeavesNothingElse) {
  here_.write("a", "old and longer");
  write_atomically(here_.path("a"), "new");
  write_atomically(here_.path("b"), "made");
  EXPECT_EQ(here_.read("a"), "new");
  EXPECT_EQ(here_.read("b"), "made");
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "b"}));
}

TEST_F(AtomicFile, APipeStaysAPipe) {
  const std::string pipe = here_.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  write_atomically(pipe, "new");
  char read[8] = "";
  EXPECT_EQ(::read(reader, read, sizeof read), 3);
  EXPECT_EQ(std::string(read), "new");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(names(), (std::vector<std::string>{"pipe"}));
}

TEST_F(AtomicFile, ALinkStaysALink) {
  here_.write("folder/real", "old");
  fs::create_symlink("folder/real", here_.path("near"));
  fs::create_symlink(here_.path("near"), here_.path("far"));
  fs::create_symlink("folder/later", here_.path("dangling"));
  write_atomically(here_.path("far"), "new");
  write_atomically(here_.path("dangling"), "made");
  EXPECT_EQ(here_.read("folder/real"), "new");
  EXPECT_EQ(here_.read("folder/later"), "made");
  for (const char* link : {"near", "far", "dangling"}) {
    EXPECT_TRUE(fs::is_symlink(here_.path(link))) << link;
  }
}

// As /dev/stdout: the file may have no name, and others go on writing to it.
TEST_F(AtomicFile, AnOpenFileIsWrittenThrough) {
  const int opened = ::open(here_.write("out", "first ").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(opened, 0);
  const std::string name = "/proc/self/fd/" + std::to_string(opened);
  fs::create_symlink(name, here_.path("stdout"));
  fs::create_symlink("/proc/self/fd", here_.path("fd"));  // as /dev/fd
  struct stat before {
  }, after{};
  ::fstat(opened, &before);
  write_atomically(here_.path("stdout"), "second ");
  write_atomically(here_.path("fd/" + std::to_string(opened)), "third");
  ::stat(here_.path("out").c_str(), &after);
  ::close(opened);
  EXPECT_EQ(here_.read("out"), "first second third");
  EXPECT_EQ(before.st_ino, after.st_ino);
}

TEST_F(AtomicFile, RefusesWhatNoFileCanBe) {
  fs::create_directory(here_.path("folder"));
  fs::create_symlink("ring", here_.path("ring"));
  here_.write("file", "");
  const auto before = names();
  const auto cannot = [&](const std::string& name, const std::string& why) {
    EXPECT_EQ(refusal(here_.path(name)), "cannot write '" + here_.path(name) + "': " + why);
  };
  cannot("folder", "Is a directory");
  cannot("ring", "Too many levels of symbolic links");
  cannot("file/a", "Not a directory");
  cannot("none/a", "No such file or directory");
  EXPECT_EQ(names(), before);
  EXPECT_TRUE(fs::is_symlink(here_.path("ring")));
}

}  // namespace
}  // namespace lilytank
