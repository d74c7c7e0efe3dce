// Tables of point bodies: which rows are refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "lilytank/bodies.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

// What a table with these columns and rows is refused for; "" if it is read. `keys` are the
// recording's besides its file and time.
std::string complaint_about(const std::string& columns, const std::string& rows,
                            const std::string& keys) {
  const TemporaryDirectory here;
  std::string table = columns + "\n" + rows;
  for (int k = 1; k < 12; ++k) {
    std::string more = rows.substr(0, rows.find('\n') + 1);
    table += std::to_string(k) + more.substr(1);  // as the first row, later
  }
  here.write("t.csv", table);
  const std::string head = "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"t.csv\"\n";
  try {
    const BodyExperiment e =
        load_body_experiment(here.write("e.toml", head + "time = \"t\"\n" + keys));
    EXPECT_EQ(e.runs.at(0).time.size(), 12u);
    return "";
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("t.csv"));
  }
}

// A second row for one instant says the same, or one of the two would be lost.
TEST(BodyExperiment, refusesRowsOfOneTimeThatDiffer) {
  const std::string x = "x = \"h\"\n";
  EXPECT_EQ(complaint_about("t,ball,h", "0,a,1\n0,b,2\n", x),
            "t.csv:3:1: t '0' is that of line 2 too, with other values: is there no column for "
            "recording.body or recording.run?");
  EXPECT_EQ(complaint_about("t,ball,h", "0,a,1\n0,b,2\n", x + "together = true\n"),
            "t.csv:3:1: t '0' is that of line 2 too, with other values: is there no column for "
            "recording.body or recording.run?");
  const std::string named = x + "body = \"ball\"\nrun = \"drop\"\n";
  EXPECT_EQ(complaint_about("t,ball,drop,h", "0,a,1,1\n0,b,1,2\n0,a,1,2\n", named),
            "t.csv:4:1: t '0' is that of line 2 too, with other values");
  EXPECT_EQ(
      complaint_about("t,ball,drop,h", "0,a,1,1\n0,b,1,2\n0,b,1,\n", named + "together = true\n"),
      "t.csv:4:1: t '0' is that of line 3 too, with other values");
  EXPECT_EQ(complaint_about("t,h,k", "0,1,1\n0,1,2\n", "x = [\"h\", \"k\"]\ntogether = true\n"),
            "t.csv:3:1: t '0' is that of line 2 too, with other values: is there no column for "
            "recording.run?");
  EXPECT_EQ(complaint_about("t,h,wind", "0,1,1\n0,1,2\n", x + "drivers = [\"wind\"]\n"),
            "t.csv:3:1: t '0' is that of line 2 too, with other values: is there no column for "
            "recording.body or recording.run?");
  EXPECT_EQ(complaint_about("t,ball,h", "0,a,\n0,a,\n", x + "body = \"ball\"\n"), "");
  EXPECT_EQ(complaint_about("t,h,wind", "0,1,1\n0,1,1\n", x + "drivers = [\"wind\"]\n"), "");
}

BodyExperiment load(const std::string& table, const std::string& keys) {
  const TemporaryDirectory here;
  here.write("t.csv", table);
  return load_body_experiment(
      here.write("e.toml",
                 "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"t.csv\"\n"
                 "time = \"t\"\nx = \"h\"\n" +
                     keys));
}

// Rows of two bodies together, by time or not.
TEST(BodyExperiment, takesRowsInAnyOrder) {
  std::vector<std::string> rows;
  for (int k = 0; k < 12; ++k) {
    for (const char* body : {"a", "b"}) {
      rows.push_back(std::to_string(k) + "," + body + "," + std::to_string(k * k) + "\n");
    }
  }
  const auto read = [&] {
    std::string table = "t,ball,h\n";
    for (const std::string& row : rows) table += row;
    return load(table, "body = \"ball\"\ntogether = true\n").runs.at(0);
  };
  const BodyRun ordered = read();
  std::rotate(rows.begin(), rows.begin() + 7, rows.end());
  std::swap(rows[2], rows[19]);
  const BodyRun shuffled = read();
  EXPECT_EQ(shuffled.bodies, ordered.bodies);
  EXPECT_EQ(shuffled.time, ordered.time);
  EXPECT_EQ(shuffled.position, ordered.position);
}

TEST(BodyExperiment, takesDatesClocksAndEpochs) {
  const auto times = [](const std::string& before, const std::string& after,
                        const std::string& keys = "") {
    std::string table = "t;h\n";
    for (int k = 10; k < 20; ++k) table += before + std::to_string(k) + after + ";0,5\n";
    return load(table, keys).runs.at(0).time;
  };
  const std::vector<double> seconds = times("", "");
  EXPECT_EQ(seconds.back(), 9);
  EXPECT_EQ(times("2018-05-01T00:00:", "Z"), seconds);
  EXPECT_EQ(times("00:00:", ""), seconds);
  EXPECT_DOUBLE_EQ(times("17000000", "000").back(), 9);  // ms
  EXPECT_EQ(times("", "", "time_unit = \"1 min\"\n").back(), 540);
}

TEST(BodyExperiment, countsRowsWithoutABodyAndComments) {
  std::string table = "t,ball,h\n";
  for (int k = 0; k < 9; ++k) table += std::to_string(k) + ",a,1\n";
  const BodyExperiment e = load(table + "9,,1\n10,NaN,1\n# end\n", "body = \"ball\"\n");
  EXPECT_EQ(e.left_out, (std::vector<std::string>{"t.csv: 2 rows without a body left out",
                                                  "t.csv: 1 comment line passed over"}));
}

// Eight rows are the least; what has fewer is told, not lost.
TEST(BodyExperiment, tellsOfRunsThatAreTooShort) {
  const TemporaryDirectory here;
  std::string table = "t,ball,h\n";
  for (int k = 0; k < 12; ++k) table += std::to_string(k) + ",a,1\n";
  for (int k = 100; k < 103; ++k) table += std::to_string(k) + ",a,1\n";  // after a long hole
  for (int k = 0; k < 7; ++k) table += std::to_string(k) + ",b,1\n";
  table += "0,c,1\n";
  here.write("t.csv", table);
  const BodyExperiment e = load_body_experiment(
      here.write("e.toml",
                 "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"t.csv\"\ntime = \"t\"\n"
                 "x = \"h\"\nbody = \"ball\"\n"));
  ASSERT_EQ(e.runs.size(), 1u);
  EXPECT_EQ(e.left_out,
            (std::vector<std::string>{"a part 2: 3 rows where eight are needed: left out",
                                      "b: 7 rows where eight are needed: left out",
                                      "c: 1 row where eight are needed: left out"}));
}

TEST(BodyExperiment, refusesEmptyNamesOfColumns) {
  const TemporaryDirectory here;
  here.write("t.csv", "t,ball,h\n0,a,1\n");
  const std::string head = "[experiment]\nbody = \"point\"\n[[recording]]\nfile = \"t.csv\"\n";
  for (const std::string key : {"time", "body", "run"}) {
    std::string keys = "x = \"h\"\n" + key + " = \"\"\n";
    if (key != "time") keys += "time = \"t\"\n";
    try {
      load_body_experiment(here.write("e.toml", head + keys));
      ADD_FAILURE() << key;
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_TRUE(what.ends_with("e.toml:6:" + std::to_string(key.size() + 4) + ": recording." +
                                 key + " is empty"))
          << what;
    }
  }
}

}  // namespace
}  // namespace lilytank
