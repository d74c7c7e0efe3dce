// What a proof leaves on the disk: read back as it was, told together with others, refused where
// damaged.
#include <gtest/gtest.h>

#include "io/file_digest.hpp"
#include "io/sha256.hpp"
#include "lilytank/error.hpp"
#include "lilytank/proof.hpp"
#include "proof/proof_files.hpp"
#include "proof/sealed.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

Proof three_worlds() {
  Proof p;
  p.key = "0 null 1 1\n1 two coriolis 2 wall_force 3 1 1\n2 unnamed slip 4 1 1\n";
  p.hash = sha256(p.key), p.sealed = 3;
  ProofWorld null, two, odd;
  null.kind = "null", null.displacement = 0.125;
  two.kind = "two", two.effects = {"coriolis", "wall_force"}, two.expected_z = 12.5;
  two.verdict = Verdict::missing;
  two.findings = {{"magnus_lift", {"coriolis", "spin_torque"}, "", 20.1},
                  {"wall_force", {}, "", 7}};
  two.intervals = {{"forces.coriolis.strength", 1, 1.1, 0.9, 1.3}, {"K_F", 0.5, 0.7, 0.6, 0.8}};
  two.removed = 0.9, two.gain = 120, two.gain_low = 80, two.regression = "body_force";
  odd.kind = "unnamed", odd.effects = {"slip"}, odd.expected_z = 30;
  odd.verdict = Verdict::missing, odd.findings = {{"unnamed", {}, "slip", 25}};
  p.worlds = {null, two, odd};
  return p;
}

class ProofFiles : public testing::Test {
 protected:
  void write(const std::string& dir, const Proof& p) const {
    here.write(dir + "/key.txt", p.key);
    here.write(dir + "/proof.csv", proof_csv(p));
    here.write(dir + "/intervals.csv", proof_intervals_csv(p));
    if (!p.tank.empty()) here.write(dir + "/tank.txt", p.tank + "\n");
  }
  std::string refusal(const std::string& dir) const {
    try {
      read_proof(here.path(dir));
    } catch (const InputError& e) {
      return e.what();
    }
    return "(none)";
  }
  TemporaryDirectory here;
};

TEST_F(ProofFiles, AreReadBackAsTheyWere) {
  const Proof p = three_worlds();
  write("a", p);
  const Proof q = read_proof(here.path("a"));
  EXPECT_EQ(proof_csv(q), proof_csv(p));
  EXPECT_EQ(proof_intervals_csv(q), proof_intervals_csv(p));
  EXPECT_EQ(proof_text({&q, 1}), proof_text({&p, 1}));
  EXPECT_EQ(q.worlds[1].findings[0].alternatives, p.worlds[1].findings[0].alternatives);
  EXPECT_TRUE(q.worlds[1].right());
  EXPECT_EQ(q.dir, here.path("a"));
  EXPECT_NE(proof_text({&q, 1}).find("magnus_lift | coriolis | spin_torque + wall_force"),
            std::string::npos)
      << proof_text({&q, 1});
}

// Neither right nor wrong: rates are of the others.
TEST_F(ProofFiles, InsufficientExperimentsCountByThemselves) {
  Proof p = three_worlds();
  ProofWorld& null = p.worlds[0];
  null.verdict = Verdict::insufficient;
  null.shortfalls = {Requirement::gusts, Requirement::lily_time};
  write("a", p);
  const Proof q = read_proof(here.path("a"));
  EXPECT_EQ(q.worlds[0].shortfalls, null.shortfalls);
  EXPECT_EQ(proof_csv(q), proof_csv(p));
  const std::string text = proof_text({&q, 1});
  EXPECT_EQ(text, proof_text({&p, 1}));
  EXPECT_TRUE(text.starts_with("Blinded synthetic benchmark: 2 of 3 experiments diagnosed\n"))
      << text;
  EXPECT_EQ(text.find("false positives"), std::string::npos) << text;
  EXPECT_NE(text.find("Insufficient recordings (1)"), std::string::npos) << text;
  EXPECT_EQ(proof_figures({&q, 1}).points.size(), 2u);
  p.worlds.resize(1);
  EXPECT_NE(proof_text({&p, 1}).find("0 of 3 experiments diagnosed"), std::string::npos);
  null.shortfalls.clear();
  write("mute", p);
  EXPECT_NE(refusal("mute").find("has requirements that are not met"), std::string::npos)
      << refusal("mute");
}

// Of another tank, if it is told.
TEST_F(ProofFiles, AreToldTogether) {
  Proof both[] = {three_worlds(), three_worlds()};
  both[0].tank = "a tank", both[1].tank = "another";
  const std::string text = proof_text(both);
  EXPECT_TRUE(text.starts_with(
      "Blinded synthetic benchmark: 6 of 6 experiments diagnosed, in 2 tanks or sets "
      "of balls\n"))
      << text;
  both[1].tank = "a tank";
  EXPECT_TRUE(
      proof_text(both).starts_with("Blinded synthetic benchmark: 6 of 6 experiments diagnosed\n"));
  EXPECT_NE(text.find("2 of 4 ("), std::string::npos) << text;  // intervals that hold the truth
}

// Of complete experiments the baseline's intervals are counted by themselves.
TEST_F(ProofFiles, IntervalsOfCompleteExperimentsAreNoModels) {
  Proof p = three_worlds();
  p.worlds[0].intervals = {{"flow.K_v", 1, 1.1, 0.9, 1.3}, {"flow.K_v", 1, 1.2, 1.1, 1.3}};
  const std::string text = proof_text({&p, 1});
  const auto
      baselines = text.find(
          "Baseline parameters of null experiments (1)\n  95 % intervals that hold the "
          "truth: 1 of 2 ("),
      models = text.find(
          "Fitted models of correctly diagnosed experiments (1)\n  95 % intervals that hold the "
          "truth: 1 of 2 (");
  EXPECT_NE(baselines, std::string::npos) << text;
  EXPECT_NE(models, std::string::npos) << text;
}

// The MSD is judged by the nulls of its own tank, however far those of another are off.
TEST_F(ProofFiles, DisplacementsAreJudgedByTheirOwnTanksNulls) {
  ProofWorld null, named;
  null.kind = "null", null.displacement = 2;
  named.kind = "named", named.effects = {"coriolis"}, named.expected_z = 20;
  named.displacement = 3;
  Proof calm, wild;
  calm.tank = "calm", calm.worlds = {null, named};
  wild.tank = "wild", wild.worlds = {null, named};
  wild.worlds[0].displacement = 9;
  const Proof both[] = {calm, wild};
  EXPECT_NE(proof_text(both).find("MSD alone (notices, does not name)         1 of 2"),
            std::string::npos)
      << proof_text(both);
  Proof without = wild;
  without.tank = "unknown", without.worlds.erase(without.worlds.begin());
  const Proof three[] = {calm, without};
  EXPECT_NE(proof_text(three).find("MSD alone (notices, does not name)         1 of 1"),
            std::string::npos)
      << proof_text(three);
}

TEST_F(ProofFiles, OfAnotherEngineOfLatchesAndOfADrawnTankHaveMoreLinesInTheKey) {
  Proof p = three_worlds();
  p.key = "engine Box2D\nlatches on with the rules chain5, events logged\n" +
          key_text(drawn_tank(7)) + p.key;
  p.hash = sha256(p.key);
  p.tank = "a drawn tank of seed 7";
  write("drawn", p);
  const Proof q = read_proof(here.path("drawn"));
  EXPECT_EQ(q.sealed, 3u);
  EXPECT_EQ(q.tank, p.tank);
  EXPECT_EQ(proof_text({&q, 1}), proof_text({&p, 1}));
}

// A proof that was stopped goes on after the worlds that it had told, but not after those of
// another key, as `--only` makes one.
TEST_F(ProofFiles, AreKeptForTheSameKey) {
  const Proof p = three_worlds();
  const std::string dir = here.path("kept");
  EXPECT_TRUE(kept_worlds(dir, p).empty());
  std::filesystem::create_directories(here.path("kept/work"));
  keep_worlds(dir, p);
  Proof again = p;
  again.worlds = kept_worlds(dir, p);
  EXPECT_EQ(proof_csv(again), proof_csv(p));
  EXPECT_EQ(proof_intervals_csv(again), proof_intervals_csv(p));
  Proof other = p;
  other.key = "0 null 1 1\n", other.hash = sha256(other.key);
  EXPECT_TRUE(kept_worlds(dir, other).empty());
  EXPECT_TRUE(kept_worlds("", p).empty());
}

// Nothing is drawn of complete experiments; what is told in part is neither right nor silent.
TEST(ProofFigures, ShowEveryExperimentWithSomethingMissing) {
  Proof p = three_worlds();
  p.worlds[1].findings[1] = {"unnamed", {}, "radius", 7};
  ProofWorld silent, wrong;
  silent.kind = wrong.kind = "named", silent.effects = wrong.effects = {"coriolis"};
  silent.expected_z = 0, wrong.expected_z = 8;
  wrong.verdict = Verdict::missing, wrong.findings = {{"wall_layer", {}, "", 9}};
  p.worlds.insert(p.worlds.end(), {silent, wrong});
  const ProofFigures f = proof_figures({&p, 1});
  ASSERT_EQ(f.points.size(), 4u);
  EXPECT_EQ(f.points[0].row, "two effects");
  EXPECT_EQ(f.points[0].outcome, ProofPoint::Outcome::other);
  EXPECT_EQ(f.points[1].outcome, ProofPoint::Outcome::right);
  EXPECT_EQ(f.points[2].outcome, ProofPoint::Outcome::silent);
  EXPECT_GT(f.points[2].expected_z, 0);  // on a logarithmic axis
  EXPECT_EQ(f.points[3].outcome, ProofPoint::Outcome::wrong_name);
  ASSERT_EQ(f.named.size(), 2u);  // below 5, and from 5 to 10
  EXPECT_NEAR(f.named[1].z, 8, 1e-12);
  EXPECT_EQ(f.named[1].right, 0);
  EXPECT_EQ(f.named[1].all, 1);
  ASSERT_EQ(f.unnamed.size(), 1u);
  EXPECT_EQ(f.unnamed[0].right, 1);
}

TEST(ProofFigures, TellErrorsInHalfWidthsOfTheirOwnSide) {
  Proof p = three_worlds();
  // Half widths below and above differ: an error is told by the side on which the truth is.
  p.worlds[1].intervals = {{"forces.coriolis.rate", 1, 1.1, 0.9, 1.5},
                           {"flow.K_v", 1, 0.8, 0.7, 1.2},
                           {"flow.K_v", 1, 1, 1, 1}};
  const ProofFigures f = proof_figures({&p, 1});
  ASSERT_EQ(f.effect_errors.size(), 1u);
  EXPECT_NEAR(f.effect_errors[0], 0.5, 1e-12);
  ASSERT_EQ(f.baseline_errors.size(), 2u);
  EXPECT_NEAR(f.baseline_errors[0], -0.5, 1e-12);
  EXPECT_EQ(f.baseline_errors[1], 0);
}

TEST_F(ProofFiles, AreRefusedWhereDamaged) {
  const Proof p = three_worlds();
  write("unfinished", p);
  std::filesystem::remove(here.path("unfinished/key.txt"));
  EXPECT_NE(refusal("unfinished").find("holds no finished proof"), std::string::npos);
  Proof other = p;
  other.worlds[0].kind = "named", other.worlds[0].effects = {"coriolis"};
  write("other", other);
  EXPECT_NE(refusal("other").find("proof.csv:2:3: the key says otherwise"), std::string::npos)
      << refusal("other");
  Proof mute = p;
  mute.worlds[2].findings.clear();
  write("mute", mute);
  EXPECT_NE(refusal("mute").find("such a verdict has findings"), std::string::npos);
  write("typo", p);
  std::string rows = proof_csv(p);
  const std::size_t begin = rows.find('\n') + 1, end = rows.find('\n', begin);
  std::string row = rows.substr(begin, rows.rfind(',', end) - begin);
  row.replace(row.find("complete"), 8, "compelte");
  here.write("typo/proof.csv", rows.substr(0, begin) + row + rows.substr(rows.rfind(',', end)));
  EXPECT_NE(refusal("typo").find("was changed since it was written"), std::string::npos);
  rows.replace(begin, end - begin, with_checksum(row));
  here.write("typo/proof.csv", rows);
  EXPECT_NE(refusal("typo").find("did you mean 'complete'?"), std::string::npos) << refusal("typo");
}

}  // namespace
}  // namespace lilytank
