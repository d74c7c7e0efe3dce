// Files with random damage: every reader either accepts them or says what is wrong, and nothing
// else.
#include <gtest/gtest.h>

#include <functional>

#include "cli/program.hpp"
#include "lilytank/random.hpp"
#include "lilytank/run.hpp"

namespace lilytank {
namespace {

constexpr std::uint32_t kDamages = 300;

/// The bytes with a few of them changed, removed, doubled or moved.
std::string damaged(std::string bytes, std::uint32_t number) {
  const auto draw = random_bits({11, Stream::message, 0, number, 0});
  for (std::uint32_t i = 0; i <= draw[0] % 3 && !bytes.empty(); ++i) {
    const auto r = random_bits({11, Stream::message, 1, number, i});
    const std::size_t at = r[0] % bytes.size();
    const std::size_t length = 1 + r[1] % std::min<std::size_t>(8, bytes.size() - at);
    const std::size_t from = r[2] % bytes.size();
    switch (r[3] % 5) {
      case 0:
        bytes[at] = static_cast<char>(r[1]);
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(from, length));
        break;
      case 3:
        bytes.resize(at);
        break;
      default:
        bytes[at] = "0123456789.-+e\n,\"[]=#x"[r[1] % 22];
    }
  }
  return bytes;
}

class DamagedInputTest : public testing::Test {
 protected:
  /// Writes damaged copies of a file and reads each.
  void damage(const std::string& name, const std::function<void()>& read) {
    const std::string good = dir_.read(name);
    ASSERT_NO_THROW(read()) << name;
    std::uint32_t refused = 0;
    for (std::uint32_t i = 0; i < kDamages; ++i) {
      dir_.write(name, damaged(good, i));
      try {
        read();
      } catch (const InputError& e) {
        ++refused;
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
      } catch (const std::exception& e) {
        ADD_FAILURE() << name << " " << i << ": " << e.what();
      }
    }
    EXPECT_GT(refused, kDamages / 20) << name;
    dir_.write(name, good);
  }
  TemporaryDirectory dir_;
};

TEST_F(DamagedInputTest, IsAcceptedOrRefused) {
  dir_.write("pair.rules", kPairRules);
  dir_.write("start.csv", "id,x,y,theta\n0,0.1,0,0\n1,-0.1,0.02,1.5\n2,0,0.1,-0.3\n");
  dir_.write("s.toml",
             "title = \"t\"\n[run]\nduration = \"2 s\"\n[module]\ncount = 3\n[ruleset]\n"
             "file = \"pair.rules\"\n[rules]\npart.p = 0.1\n[start]\nfile = \"start.csv\"\n"
             "[[command]]\nat = 1\ndo = \"ruleset\"\nfile = \"pair.rules\"\nmodules = [1]\n");
  const auto load = [&] { load_scenario({dir_.path("s.toml")}, {}); };
  for (const char* name : {"s.toml", "pair.rules", "start.csv"}) damage(name, load);

  const Scenario scenario = load_scenario({dir_.path("s.toml")}, {"output.trajectory=csv"});
  RunOptions options;
  options.out = dir_.path("a");
  run(scenario, options);
  damage("a/trajectory.csv", [&] { read_trajectory(dir_.path("a/trajectory.csv")); });
  damage("a/metrics.csv", [&] { load_run(options.out); });
  damage("a/checkpoint.bin", [&] { run(scenario, options); });

  const Scenario binary = load_scenario({dir_.path("s.toml")}, {});
  options.out = dir_.path("b");
  run(binary, options);
  damage("b/trajectory.bin", [&] { read_trajectory(dir_.path("b/trajectory.bin")); });
}

}  // namespace
}  // namespace lilytank
