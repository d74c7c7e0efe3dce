// A cell of a grid with sufficient recordings.
#include <gtest/gtest.h>

#include "lilytank/proof_grid.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

// However often it is interrupted, a cell is the benchmark with its options.
TEST(LongProofGrid, ACellIsABenchmark) {
  const TemporaryDirectory here;
  GridOptions options;
  options.axes = {{1}, {16}, {20}, {}};
  options.experiments = 2, options.proof.known_flow = true;
  DiagnosisOptions& d = options.proof.diagnosis;
  d.out = here.path("g");
  std::atomic<bool> stop = false;
  d.stop = &stop;
  for (const int reports : {40, 200}) {
    int left = reports;
    d.progress = [&](double, const std::string&) {
      if (--left == 0) stop = true;
    };
    stop = false;
    EXPECT_THROW(prove_grid(options), Stopped) << reports;
  }
  stop = false, d.progress = nullptr;
  const GridCell cell = options.axes.cells(true).front();
  const ProofGrid grid = prove_grid(options);
  ASSERT_EQ(grid.rows.size(), 1u);
  EXPECT_EQ(grid.rows[0].answered(), 2);
  ProofOptions alone = proof_of(options, cell);
  const auto kept = finished_proof(alone);
  ASSERT_TRUE(kept.has_value());
  alone.diagnosis.out.clear();
  const Proof proof = prove(alone);
  EXPECT_EQ(proof_csv(*kept), proof_csv(proof));
  EXPECT_EQ(proof_intervals_csv(*kept), proof_intervals_csv(proof));
  EXPECT_EQ(kept->key, proof.key);
}

}  // namespace
}  // namespace lilytank
