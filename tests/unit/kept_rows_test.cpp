// Rows that are kept: what was done is not done again, and damage is refused.
#include "study/kept_rows.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "lilytank/error.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

using Row = std::vector<double>;

KeptRows kept_in(const TemporaryDirectory& here, std::uint64_t identity = 5, int threads = 0) {
  KeptRows out;
  out.file = here.path("r.rows"), out.identity = identity, out.threads = threads;
  return out;
}

Row row_of(int i) {
  return i == 3 ? Row{} : Row{0.1 * i, 1.0 / (i + 1), -1e-300};
}

TEST(KeptRows, areReadFromTheFileAndOnlyTheMissingAreDone) {
  const TemporaryDirectory here;
  const KeptRows kept = kept_in(here);
  std::atomic<int> done = 0;
  const auto work = [&](int i) { return ++done, row_of(i); };
  const auto first = kept_rows(kept, 6, work);
  EXPECT_EQ(done, 6);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(first[static_cast<std::size_t>(i)], row_of(i));
  const auto more = kept_rows(kept, 9, work);
  EXPECT_EQ(done, 9);
  EXPECT_EQ(more.size(), 9u);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), more.begin()));
}

TEST(KeptRows, ofSeveralFilesAreThoseOfEachByItself) {
  const TemporaryDirectory here;
  const auto other = [](int i) { return Row{-1.5 * i}; };
  kept_rows(kept_in(here), 2, row_of);
  std::atomic<int> done = 0;
  const auto counted = [&](int i) { return ++done, row_of(i); };
  const std::vector<RowSet> sets{{here.path("r.rows"), 5, counted},
                                 {here.path("s.rows"), 3, other}};
  const auto both = kept_row_sets(kept_in(here), sets);
  EXPECT_EQ(done, 3);  // two are in the file
  EXPECT_EQ(both.front(), kept_rows(kept_in(here), 5, row_of));
  EXPECT_EQ(both.back(), (std::vector<Row>{other(0), other(1), other(2)}));
}

TEST(KeptRows, aLastRowCutByAKillIsDoneAgain) {
  const TemporaryDirectory here;
  const KeptRows kept = kept_in(here, 5, 1);
  const auto whole = kept_rows(kept, 4, row_of);
  const std::string text = here.read("r.rows");
  for (std::size_t length = 0; length < text.size(); length += 7) {
    here.write("r.rows", text.substr(0, length));
    EXPECT_EQ(kept_rows(kept, 4, row_of), whole) << length;
  }
}

TEST(KeptRows, aNumberThatIsNoneStaysNone) {
  const TemporaryDirectory here;
  const KeptRows kept = kept_in(here);
  const auto nan = [](int) { return Row{1, std::nan(""), 2}; };
  for (int time = 0; time < 2; ++time) {
    const auto rows = kept_rows(kept, 1, nan);
    EXPECT_TRUE(std::isnan(rows.front()[1]));
    EXPECT_EQ(rows.front()[2], 2);
  }
}

TEST(KeptRows, ofAnotherCalculationOrDamagedAreRefused) {
  const TemporaryDirectory here;
  kept_rows(kept_in(here), 2, row_of);
  EXPECT_THROW(kept_rows(kept_in(here, 6), 2, row_of), InputError);
  const std::string text = here.read("r.rows");
  for (const char* line : {"x,1;\n", "0,nonsense;\n", "0,1\n", "-1,2;\n"}) {
    here.write("r.rows", text + line);
    try {
      kept_rows(kept_in(here), 2, row_of);
      ADD_FAILURE() << line;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("r.rows:4:1"), std::string::npos) << e.what();
    }
  }
}

TEST(KeptRows, stopKeepsWhatIsDone) {
  const TemporaryDirectory here;
  std::atomic<bool> stop = false;
  KeptRows kept = kept_in(here, 5, 1);
  kept.stop = &stop;
  const auto until_third = [&](int i) {
    stop = i >= 3;
    return row_of(i);
  };
  EXPECT_THROW(kept_rows(kept, 8, until_third), Stopped);
  stop = false;
  int done = 0;
  EXPECT_EQ(kept_rows(kept, 8, [&](int i) { return ++done, row_of(i); }).size(), 8u);
  EXPECT_LT(done, 8);
  EXPECT_GT(done, 0);
}

}  // namespace
}  // namespace lilytank
