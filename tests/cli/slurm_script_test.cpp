// Scripts for Slurm, run with programs in Slurm's place: whatever things are called, no name
// becomes a command or a directive, and the study gets its arguments byte by byte.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/process.hpp"
#include "cli/program.hpp"
#include "support/study_rig.hpp"

namespace lilytank {
namespace {

const std::vector<std::string> kHostile{
    "plain",
    "two words",
    "line\ntouch canary\nline",
    "end\n",
    "\r\ntouch canary\r\n",
    "$(touch canary)",
    "`touch canary`",
    "a; touch canary; #",
    "a' ; touch canary ; '",
    "a\" ; touch canary ; \"",
    "back\\slash\\' ; touch canary\n",
    "a\n#SBATCH --wrap=canary\n",
    "#SBATCH --nodes=99",
    "-leading",
    "--wrap=touch canary",
    "a && touch canary || touch canary > canary",
    "${IFS}%A_%a*?[a]~!",
    "\xC3\xA9t\xC3\xA9\x01\x1b[31m\x7f",
    "'; touch canary; $'\n",
};

class SlurmScript : public testing::Test {
 protected:
  SlurmScript() {
    here().write("pair.rules", test::kPairRulesText);
    here().write("pair.toml", test::kPairScenario);
    stub("srun", "printf '%s\\0' \"$@\" > \"$HERE/arguments\"\nexit 3");
    stub("squeue", "echo RUNNING");
    stub("scontrol", "printf '%s\\0' \"$@\" > \"$HERE/requeued\"");
    stub("sbatch", "touch \"$HERE/canary\"");
  }
  const TemporaryDirectory& here() const { return lilytank_.here; }
  void stub(const std::string& name, const std::string& script) const {
    here().write("bin/" + name, "#!/bin/bash\n" + script + "\n");
    std::filesystem::permissions(here().path("bin/" + name), std::filesystem::perms::owner_all);
  }
  /// What the verb prints.
  std::string script(const std::vector<std::string>& words) const {
    std::filesystem::remove(here().path("script"));
    std::vector<std::string> arguments{"study", "slurm"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    Process process(here().path(), arguments, here().path("script"));
    process.await([] { return false; });
    EXPECT_EQ(process.end(0), 0);
    return here().read("script");
  }
  void run(const std::string& text) const {
    here().write("study.sbatch", text);
    const std::string command = "cd '" + here().path() + "' && HERE='" + here().path() +
                                "' PATH='" + here().path("bin") +
                                "':$PATH SLURM_JOB_ID=17 SLURM_CPUS_PER_TASK=2 bash study.sbatch";
    EXPECT_EQ(std::system(command.c_str()), 0);
  }
  std::vector<std::string> arguments() const {
    std::vector<std::string> words(1);
    for (const char c : here().read("arguments")) {
      if (c == '\0')
        words.emplace_back();
      else
        words.back() += c;
    }
    words.pop_back();
    return words;
  }
  static std::vector<std::string> directives(const std::string& text) {
    std::vector<std::string> found;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("#SBATCH")) found.push_back(line.substr(0, line.find('=')));
    }
    return found;
  }
  Program lilytank_;
};

TEST_F(SlurmScript, NamesAreArgumentsAndNothingElse) {
  here().write("plain.toml", "[study]\nname = \"n\"\nscenario = \"pair.toml\"\nreplicates = 2\n");
  const auto usual = directives(script({"plain.toml"}));
  EXPECT_EQ(usual.size(), 9u);
  for (const std::string& name : kHostile) {
    const std::string file = name + ".toml", out = "out/" + name;
    std::string escaped;
    for (const char c : name) {
      char code[16];
      std::snprintf(code, sizeof code, "\\u%04x", unsigned{static_cast<unsigned char>(c)});
      escaped += static_cast<unsigned char>(c) < 0x80 ? code : std::string(1, c);
    }
    here().write(file, "[study]\nname = \"n\"\nscenario = \"pair.toml\"\nreplicates = 2\n");
    const std::string path = name.starts_with('-') ? "./" + file : file;
    const std::string set = "title=\"" + escaped + "\"";
    const std::string text = script({path, "--out=" + name, "--set", set});
    EXPECT_EQ(directives(text), usual) << text;
    run(text);
    EXPECT_FALSE(here().has("canary")) << text;
    const std::vector<std::string> words = arguments();
    ASSERT_EQ(words.size(), 10u) << text;
    EXPECT_EQ((std::vector<std::string>(words.begin() + 2, words.end())),
              (std::vector<std::string>{"study", path, "--out",
                                        (name.starts_with('-') ? "./" : "") + name, "--set", set,
                                        "--threads", "2"}))
        << text;
    EXPECT_EQ(here().read("requeued"), std::string("requeue\0"
                                                   "17\0",
                                                   11));
  }
}

// The second command of the comments, as a user would copy it.
TEST_F(SlurmScript, TheMergeIsOfTheDirectoryNamed) {
  stub("lilytank", "printf '%s\\0' \"$@\" >> \"$HERE/arguments\"");
  stub("sbatch", "for word; do case $word in --*) ;; *) sh -c \"$word\";; esac; done");
  for (const std::string& name : kHostile) {
    SlurmJob job;
    job.program = here().path("bin/lilytank"), job.study = "s.toml", job.name = job.out = name;
    std::istringstream in(slurm_script(job));
    std::string merge;
    for (std::string line; std::getline(in, line);) {
      if (line.find("--job-name=merge --wrap ") != std::string::npos) merge = line.substr(1);
    }
    std::filesystem::remove(here().path("arguments"));
    run("job=1\n" + merge + "\n");
    EXPECT_FALSE(here().has("canary")) << merge;
    const std::string dir = (name.starts_with('-') ? "./" : "") + name;
    EXPECT_EQ(arguments(),
              (std::vector<std::string>{"study", "merge", dir, "study", "report", dir}))
        << merge;
  }
}

TEST_F(SlurmScript, ATimeIsATime) {
  SlurmJob job;
  for (const std::string time : {"", "1\n#SBATCH --wrap=x", "1;x", "soon", "$(x)"}) {
    job.time = time;
    EXPECT_THROW(slurm_script(job), InputError) << time;
  }
}

}  // namespace
}  // namespace lilytank
