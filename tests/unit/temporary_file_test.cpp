// Nothing but the named file changes: no neighbour, no input, nothing behind a link, whatever its
// name.
#include "io/temporary_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>

#include "io/append_file.hpp"
#include "io/atomic_file.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

class TemporaryFiles : public testing::Test {
 protected:
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(here_.path())) {
      const std::string name = entry.path().filename().string();
      found[name] =
          entry.is_symlink() ? "-> " + fs::read_symlink(entry.path()).string() : here_.read(name);
    }
    return found;
  }
  mode_t mode(const std::string& name) const {
    struct stat there {};
    ::lstat(here_.path(name).c_str(), &there);
    return there.st_mode & 07777;
  }
  /// Does `work` in another process; its exit code, or minus its signal.
  template <class Work>
  static int elsewhere(const Work& work) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  /// A temporary file of `target` whose process was killed; its name.
  std::string killed(const std::string& target) const {
    const auto before = files();
    elsewhere([&] {
      TemporaryFile file(here_.path(target));
      file.write("half");
      return ::raise(SIGKILL);
    });
    for (const auto& [name, content] : files()) {
      if (!before.contains(name)) return name;
    }
    return "(none)";
  }
  TemporaryDirectory here_;
};

TEST_F(TemporaryFiles, NeighboursStayAsTheyAre) {
  here_.write("behind", "precious");
  for (const char* name : {"a.tmp", "a.part", ".a.part", "a~", "a.lock", ".lilytank-lock"}) {
    here_.write(name, "precious");
  }
  auto expected = files();
  write_atomically(here_.path("a"), "new");
  write_together({{here_.path("b"), "new"}, {here_.path("c"), "new"}});
  for (const char* name : {"a", "b", "c"}) expected[name] = "new";
  EXPECT_EQ(files(), expected);
}

// At every name that could be used next, a link, a directory or another's file.
TEST_F(TemporaryFiles, NothingAtATemporaryNameIsTouched) {
  here_.write("behind", "precious");
  std::string first = killed("a");
  ASSERT_NE(first, "(none)");
  fs::remove(here_.path(first));
  first.pop_back();
  for (int k = 0; k < 40; ++k) {
    const std::string name = here_.path(first + std::to_string(k));
    if (k % 4 == 0) fs::create_symlink("behind", name);
    if (k % 4 == 1) fs::create_symlink("absent", name);
    if (k % 4 == 2) fs::create_hard_link(here_.path("behind"), name);
    if (k % 4 == 3) fs::copy_file(here_.path("behind"), name);
  }
  fs::create_symlink("absent", here_.path(".lilytank-lock"));
  auto expected = files();
  write_atomically(here_.path("a"), "new");
  write_together({{here_.path("a"), "newer"}});
  expected["a"] = "newer";
  EXPECT_EQ(files(), expected);
}

TEST_F(TemporaryFiles, RightsStayAndNewOnesAreOfTheUmask) {
  const mode_t before = ::umask(027);
  here_.write("secret", "old");
  ::chmod(here_.path("secret").c_str(), 0600);
  here_.write("shared", "old");
  ::chmod(here_.path("shared").c_str(), 0664);
  for (const char* name : {"secret", "shared", "new"}) write_atomically(here_.path(name), "x");
  create_atomically(here_.path("created"), "x");
  ::umask(before);
  EXPECT_EQ(mode("secret"), 0600u);
  EXPECT_EQ(mode("shared"), 0664u);
  EXPECT_EQ(mode("new"), 0640u);
  EXPECT_EQ(mode("created"), 0640u);
}

TEST_F(TemporaryFiles, OwnersStay) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  here_.write("theirs", "old");
  ASSERT_EQ(::chown(here_.path("theirs").c_str(), 12, 34), 0);
  write_atomically(here_.path("theirs"), "new");
  struct stat there {};
  ::stat(here_.path("theirs").c_str(), &there);
  EXPECT_EQ(there.st_uid, 12u);
  EXPECT_EQ(there.st_gid, 34u);
}

TEST_F(TemporaryFiles, AProtectedFileOrDirectoryIsRefused) {
  here_.write("kept", "old");
  ::chmod(here_.path("kept").c_str(), 0444);
  fs::create_directory(here_.path("closed"));
  ::chmod(here_.path("closed").c_str(), 0555);
  ::chmod(here_.path().c_str(), 0777);
  const int code = elsewhere([&] {
    if (::geteuid() == 0 && ::setuid(65534) != 0) return 9;
    int refused = 0;
    for (const char* name : {"kept", "closed/a"}) {
      try {
        write_atomically(here_.path(name), "new");
      } catch (const InputError& e) {
        refused += std::string(e.what()).ends_with(": Permission denied") ? 1 : 0;
      }
    }
    return refused;
  });
  EXPECT_EQ(code, 2);
  EXPECT_EQ(files().at("kept"), "old");
  EXPECT_TRUE(fs::is_empty(here_.path("closed")));
}

TEST_F(TemporaryFiles, AFullDiskLeavesTheOldFileAndNothingElse) {
  here_.write("a", "old");
  here_.write("b", "old");
  const auto before = files();
  const int code = elsewhere([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit most{100, 100};
    ::setrlimit(RLIMIT_FSIZE, &most);
    try {
      write_together({{here_.path("a"), "new"}, {here_.path("b"), std::string(1000, 'x')}});
    } catch (const InputError& e) {
      return e.what() == "cannot write '" + here_.path("b") + "': File too large" ? 0 : 1;
    }
    return 2;
  });
  EXPECT_EQ(code, 0);
  EXPECT_EQ(files(), before);
}

TEST_F(TemporaryFiles, WhatAKilledProcessLeftGoesWithTheNextWriteOfTheSameFile) {
  const std::string left = killed("a"), other = killed("b");
  ASSERT_TRUE(left.starts_with(".lilytank-")) << left;
  ASSERT_NE(left, other);
  const TemporaryFile living(here_.path("a"));  // has taken the place of the one that was left
  write_atomically(here_.path("a"), "new");
  auto found = files();
  EXPECT_EQ(found.erase(fs::path(living.name()).filename().string()), 1u);
  EXPECT_EQ(found, (std::map<std::string, std::string>{{"a", "new"}, {other, "half"}}));
}

TEST_F(TemporaryFiles, AFileIsCreatedOnce) {
  EXPECT_TRUE(create_atomically(here_.path("a"), "first"));
  EXPECT_FALSE(create_atomically(here_.path("a"), "second"));
  EXPECT_EQ(files(), (std::map<std::string, std::string>{{"a", "first"}}));
}

TEST_F(TemporaryFiles, SignalsWaitForTheFile) {
  const int code = elsewhere([&] {
    const HeldSignals held;
    ::raise(SIGTERM);
    write_atomically(here_.path("a"), "whole");
    return 0;
  });
  EXPECT_EQ(code, -SIGTERM);
  EXPECT_EQ(files(), (std::map<std::string, std::string>{{"a", "whole"}}));
}

// Sets of two processes at once, again and again: never one's file beside another's.
TEST_F(TemporaryFiles, FilesThatBelongTogetherAreOneProcesss) {
  for (int round = 0; round < 12; ++round) {
    std::vector<pid_t> children;
    for (const std::string content : {"1", "2", "3"}) {
      const pid_t child = ::fork();
      if (child == 0) {
        for (int k = 0; k < 3; ++k) {
          write_together({{here_.path("a"), content}, {here_.path("b"), content}});
        }
        ::_exit(0);
      }
      children.push_back(child);
    }
    for (const pid_t child : children) ::waitpid(child, nullptr, 0);
    const auto found = files();
    ASSERT_EQ(found.size(), 2u);
    ASSERT_EQ(found.at("a"), found.at("b"));
  }
}

TEST_F(TemporaryFiles, ALogBegunAnewFollowsNoLink) {
  here_.write("behind", "precious");
  fs::create_symlink("behind", here_.path("log"));
  fs::create_hard_link(here_.path("behind"), here_.path("second"));
  for (const char* name : {"log", "second"}) {
    AppendFile file(here_.path(name));
    file.append("new");
    file.flush();
  }
  EXPECT_EQ(files(), (std::map<std::string, std::string>{
                         {"behind", "precious"}, {"log", "new"}, {"second", "new"}}));
}

}  // namespace
}  // namespace lilytank
