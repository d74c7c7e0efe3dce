// Text tables as programs and people write them.
#include "io/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "text/words.hpp"

namespace lilytank {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Names and rows of a table; or one cell with what it is refused for.
Rows rows_of(std::string_view text, const TableLayout& layout = {}) {
  try {
    LineSource lines(text, "t.csv");
    Table table(lines, layout);
    Rows out{table.names()};
    while (table.next()) {
      out.emplace_back();
      for (std::size_t c = 0; c < table.names().size(); ++c) {
        out.back().emplace_back(table.cell(static_cast<int>(c)));
      }
    }
    return out;
  } catch (const InputError& e) {
    return {{e.what()}};
  }
}

std::string table_refusal(std::string_view text, const TableLayout& layout = {}) {
  const Rows rows = rows_of(text, layout);
  return rows.size() == 1 ? rows[0][0] : "(accepted)";
}

/// The numbers of a column, joined by blanks; or what they are refused for.
std::string numbers(std::string_view text, const std::string& name,
                    const TableLayout& layout = {}) {
  try {
    LineSource lines(text, "t.csv");
    Table table(lines, layout);
    std::vector<double> out;
    while (table.next()) out.push_back(table.number(table.find(name)));
    return joined(out, " ", [](double v) { return std::isnan(v) ? "nan" : std::to_string(v); });
  } catch (const InputError& e) {
    return e.what();
  }
}

std::string utf16(std::string_view text, bool big, bool mark) {
  std::string out;
  const auto put = [&](int unit) {
    const char high = static_cast<char>(unit >> 8), low = static_cast<char>(unit & 255);
    out += big ? high : low, out += big ? low : high;
  };
  if (mark) put(0xfeff);
  for (const char c : text) put(static_cast<unsigned char>(c));
  return out;
}

const Rows kPlain{{"id", "x"}, {"7", "0.5"}, {"8", "1.5"}};

TEST(Table, LinesEndInAnyWay) {
  for (const std::string end : {"\n", "\r\n", "\r\r\n", "\r"}) {
    EXPECT_EQ(rows_of("id,x" + end + "7,0.5" + end + "8,1.5" + end), kPlain);
    EXPECT_EQ(rows_of("id,x" + end + end + "7,0.5" + end + "8,1.5"), kPlain);
  }
  EXPECT_EQ(table_refusal("id,x\r7,0.5\r\r8\r"), "t.csv:4:1: 1 columns instead of 2");
}

TEST(Table, EncodingsOfOtherPrograms) {
  EXPECT_EQ(rows_of("\xef\xbb\xbfid,x\n7,0.5\n8,1.5\n"), kPlain);
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) {
      EXPECT_EQ(rows_of(utf16("id\tx\r\n7\t0.5\r\n8\t1.5\r\n", big, mark)), kPlain);
    }
  }
  std::string text;
  Utf16Decoder(false).decode(std::string_view("\xb5\x00\x3d\xd8\x00\xde\x3d\xd8", 8), true, text);
  EXPECT_EQ(text, "\u00b5\U0001f600\ufffd");
}

TEST(Table, FilesThatAreNoTables) {
  EXPECT_TRUE(table_refusal("PK\x03\x04xl/workbook")
                  .starts_with("t.csv:1:1: this is no text table but a zip archive, as Excel's"));
  EXPECT_EQ(table_refusal(std::string_view("\x01\x02\x03\x00\x00\x05\x06\x07", 8)),
            "t.csv:1:1: this is no text table but a binary file: it holds zero bytes");
  EXPECT_EQ(table_refusal("id,x\a\n1,2\n"),
            "t.csv:1:1: the name of column 2 holds a control character (byte 7): is this a text "
            "table?");
  EXPECT_EQ(table_refusal(std::string(2000, 'a') + ",x\n1,2\n1," + std::string(3, '\0') + "\n"),
            "t.csv:3:3: there is a zero byte in this line: the file is damaged, or no text table");
}

TEST(Table, EmptyRowsAndExcelsSeparatorLine) {
  EXPECT_EQ(rows_of("sep=;\r\nid;x\r\n7;0.5\r\n;\r\n8;1.5\r\n;;;\r\n;\r\n"), kPlain);
  EXPECT_EQ(rows_of("\n,,\nid,x\n  \n7,0.5\n,\n8,1.5\n\n"), kPlain);
  EXPECT_EQ(rows_of("id\tx\t\n7\t0.5\t\n8\t1.5\t\n"),
            (Rows{{"id", "x", ""}, {"7", "0.5", ""}, {"8", "1.5", ""}}));
  EXPECT_EQ(rows_of("id,x\n7,0.5,\n8,1.5,,\n"), kPlain);
  EXPECT_EQ(rows_of("id  x\n7\t0.5\n 8   1.5 \n"), kPlain);
  LineSource lines("a,b\n1,1\n,\n,\n2,2\n", "t.csv");
  Table table(lines);
  ASSERT_TRUE(table.next());
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.empty_rows_before(), 2);
}

TEST(Table, QuotesAsInRfc4180) {
  EXPECT_EQ(rows_of("\"id\",\"x, mm\"\n\"a,\"\"b\"\"\", 3\n\"two\nlines\",4\n"),
            (Rows{{"id", "x, mm"}, {"a,\"b\"", "3"}, {"two\nlines", "4"}}));
  EXPECT_EQ(table_refusal("id,x\n\"two\nlines\",4\n1\n"), "t.csv:4:1: 1 columns instead of 2");
  EXPECT_EQ(table_refusal("id,x\n\"a,4\n5,6\n"),
            "t.csv:2:1: a quote (\") that begins a cell here is never closed");
  EXPECT_EQ(table_refusal("id,x\n\"a\"b,4\n"),
            "t.csv:2:1: there is text behind the closing quote of \"a\": a quote within a cell is "
            "written twice");
  EXPECT_EQ(rows_of("id,x\n5\" pipe,4\n"), (Rows{{"id", "x"}, {"5\" pipe", "4"}}));
}

TEST(Table, DecimalCommas) {
  const std::string half = "0.500000 1.250000";
  EXPECT_EQ(numbers("id;x\n7;0,5\n8;1,25\n", "x"), half);
  EXPECT_EQ(numbers("id\tx\n7\t0,5\n8\t1,25\n", "x"), half);
  EXPECT_EQ(numbers("id x\n7 0,5\n8 1,25\n", "x"), half);
  // With three digits behind it, a comma may part thousands; another column says what it does.
  EXPECT_EQ(
      numbers("id;x\n7;447,410\n", "x"),
      "t.csv:2:3: x '447,410' is not a number: if the comma is a decimal comma, decimal_comma "
      "= true reads it");
  EXPECT_EQ(numbers("id;x;y\n7;447,410;0,1\n", "x"), "447.410000");
  TableLayout commas;
  commas.decimal_comma = true;
  EXPECT_EQ(numbers("id;x\n7;447,410\n", "x", commas), "447.410000");
  EXPECT_EQ(numbers("id,x\n7,\"0,5\"\n", "x", commas), "0.500000");
  EXPECT_EQ(numbers("id,x\n7,\"0,5\"\n", "x"),
            "t.csv:2:4: x '0,5' is not a number: if the comma is a decimal comma, decimal_comma = "
            "true reads it");
  EXPECT_EQ(numbers("id;x\n7;1.234,5\n8;0,5\n", "x"),
            "t.csv:2:3: x '1.234,5' is not a number: write it without separators of thousands");
  EXPECT_EQ(numbers("id;x;y\n7;1.234;0,5\n", "x").substr(0, 40),
            "t.csv:2:3: x '1.234' is not a number: ot");
  EXPECT_EQ(table_refusal("id,x,y\n7,0,5,1,25\n"),
            "t.csv:2:1: 5 columns instead of 3: decimal commas need ';' or tabs between the cells");
}

TEST(Table, CommentsAreCountedAndRowsAreNot) {
  LineSource lines("# by hand\n% in water\nid,x\n#2,0.5\n# lamp off\n3,1\n%\n", "t.csv");
  Table table(lines);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.cell(0), "#2");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.cell(0), "3");
  EXPECT_FALSE(table.next());
  EXPECT_EQ(table.comment_lines(), 2);
}

TEST(Table, NamesOnLaterLines) {
  const Rows trackmate{{"LABEL", "TRACK_ID", "POSITION_X", "POSITION_Y"}, {"ID1", "4", "1", "2"}};
  EXPECT_EQ(rows_of("LABEL,TRACK_ID,POSITION_X,POSITION_Y\nLabel,Track ID,X,Y\nLabel,Track ID,X,Y\n"
                    ",,(mm),(mm)\nID1,4,1,2\n"),
            trackmate);
  EXPECT_EQ(rows_of("LABEL,TRACK_ID,POSITION_X,POSITION_Y\nID1,4,1,2\n"), trackmate);
  EXPECT_EQ(rows_of("scorer,n,n,n\nbodyparts,nose,nose,nose\ncoords,x,y,likelihood\n0,1,2,0.9\n"),
            (Rows{{"frame", "x", "y", "likelihood"}, {"0", "1", "2", "0.9"}}));
  EXPECT_EQ(rows_of("scorer,n,n,n,n\nindividuals,a,a,b,b\nbodyparts,nose,nose,nose,nose\n"
                    "coords,x,y,x,y\n0,1,2,3,4\n"),
            (Rows{{"frame", "a_x", "a_y", "b_x", "b_y"}, {"0", "1", "2", "3", "4"}}));
  EXPECT_EQ(
      rows_of("scorer,n,n,n,n\nbodyparts,nose,nose,tail,tail\ncoords,x,y,x,y\n0,1,2,3,4\n")[0],
      (std::vector<std::string>{"frame", "nose_x", "nose_y", "tail_x", "tail_y"}));
  EXPECT_EQ(rows_of("# id,x\n7,0.5\n8,1.5\n"), kPlain);  // NumPy's savetxt
  const std::string titled = "Tank 3\nid,x\nnumber,metres\n7,0.5\n8,1.5\n";
  EXPECT_EQ(table_refusal(titled),
            "t.csv:2:1: 2 columns instead of 1: header_line = N says in which line "
            "the names are, if not in line 1");
  TableLayout layout;
  layout.header_line = 2, layout.first_row = 4;
  EXPECT_EQ(rows_of(titled, layout), kPlain);
  layout.header_line = 0, layout.first_row.reset();
  EXPECT_EQ(rows_of("a,0.5\n", layout), (Rows{{"1", "2"}, {"a", "0.5"}}));
  layout.header_line = 9;
  EXPECT_EQ(table_refusal(titled, layout), "t.csv: header_line = 9, but there are 5 lines");
}

TEST(Table, RepeatedNames) {
  EXPECT_EQ(numbers("f,x,f\n1,5,1.0\n2,6,2\n", "f"), "1.000000 2.000000");
  EXPECT_EQ(numbers("f,x,f\n1,5,1\n2,6,3\n", "x"), "5.000000 6.000000");
  EXPECT_EQ(numbers("f,x,f\n1,5,1\n2,6,3\n", "f"),
            "t.csv:3: two columns are called 'f' (1 and 3), and differ: '2', '3'");
}

TEST(Table, WordsForNotSeen) {
  for (const char* word :
       {"nan",       "NaN",    "-nan", "nan(ind)",  "-nan(ind)", "1.#QNAN", "-1.#IND",
        "-1.#IND00", "1.#INF", "inf",  "-Infinity", "#N/A",      "<NA>",    "NA",
        "N/A",       "null",   "None", "NaT",       "-",         ""}) {
    EXPECT_TRUE(is_not_seen(word)) << word;
    EXPECT_EQ(numbers("id,x\n1," + std::string(word) + "\n", "x"), "nan") << word;
  }
  for (const char* word : {"0", "nano", "infra", "1.#", "-1", "bee", "#1"}) {
    EXPECT_FALSE(is_not_seen(word)) << word;
  }
}

}  // namespace
}  // namespace lilytank
