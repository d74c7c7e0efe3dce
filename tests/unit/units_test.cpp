#include "io/units.hpp"

#include <gtest/gtest.h>

#include "lilytank/force.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

double read(const std::string& text, const std::string& unit) {
  return read_quantity(text, unit, "tank.radius", {"t.toml", 3, 10});
}

std::string refusal(const std::string& text, const std::string& unit) {
  try {
    read(text, unit);
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

// Decimal prefixes must not add rounding: the value is the double nearest to what is written.
TEST(Units, DecimalPrefixesRoundOnce) {
  EXPECT_EQ(read("30 cm", "m"), 0.3);
  EXPECT_EQ(read("7 cm", "m"), 0.07);
  EXPECT_EQ(read("12.68 mN", "N"), 0.01268);
  EXPECT_EQ(read("25 ms", "s"), 0.025);
  EXPECT_EQ(read("35 g", "kg"), 0.035);
  EXPECT_EQ(read("1.31e1 g", "kg"), 0.0131);
  EXPECT_EQ(read("7 cm^2", "m^2"), 7e-4);
  EXPECT_EQ(read("1 g/cm^3", "kg/m^3"), 1000);
  EXPECT_EQ(read("69 %", "%"), 69);
  EXPECT_EQ(read("69 %", "1"), 0.69);
  EXPECT_EQ(read("-8cm", "m"), -0.08);
  EXPECT_EQ(read("+5 Hz", "1/s"), 5);
}

TEST(Units, OtherFactors) {
  EXPECT_EQ(read("4 h", "s"), 14400);
  EXPECT_EQ(read("1.5 min", "s"), 90);
  EXPECT_EQ(read("2 d", "s"), 172800);
  EXPECT_DOUBLE_EQ(read("15 deg", "rad"), 0.2617993877991494);
  EXPECT_DOUBLE_EQ(read("9 l/min", "m^3/s"), 1.5e-4);
}

TEST(Units, ProductsPowersAndGroups) {
  EXPECT_EQ(read("1 mN m", "N m"), 1e-3);
  EXPECT_EQ(read("1 mN*m", "N m"), 1e-3);
  EXPECT_EQ(read("1 kg m/s^2", "N"), 1);
  EXPECT_EQ(read("1 g/(cm s)", "kg/(m s)"), 0.1);
  EXPECT_EQ(read("1 m^-1", "1/m"), 1);
  EXPECT_EQ(read("3 \u00b5m", "m"), 3e-6);
}

// As keyboards and word processors write them.
TEST(Units, LettersAsPeopleTypeThem) {
  EXPECT_EQ(read("3 \u03bcm", "m"), 3e-6);
  EXPECT_EQ(read("30\u00a0cm", "m"), 0.3);
  EXPECT_EQ(read("30\u202fcm", "m"), 0.3);
  EXPECT_EQ(read("30\u2009cm", "m"), 0.3);
  EXPECT_EQ(read("7 cm\u00b2", "m^2"), 7e-4);
  EXPECT_EQ(read("2 m\u00b7s\u207b\u00b2", "m/s^2"), 2);
  EXPECT_EQ(read("\u22128\u00a0cm", "m"), -0.08);
  EXPECT_DOUBLE_EQ(read("15 \u00b0", "rad"), 0.2617993877991494);
  EXPECT_EQ(refusal("0,30 m", "m"),
            "t.toml:3:10: tank.radius = \"0,30 m\" has a comma in its number, which is not read: "
            "write \"0.30 m\" if it is a decimal comma");
}

TEST(Units, WrongDimensionNamesTheRightOne) {
  EXPECT_EQ(refusal("3 kg", "m"), "t.toml:3:10: tank.radius is a length in m; 'kg' is not");
  EXPECT_EQ(refusal("3 m", "1"), "t.toml:3:10: tank.radius is a number without a unit; 'm' is not");
  EXPECT_EQ(refusal("3 m", "rad"), "t.toml:3:10: tank.radius is an angle in rad; 'm' is not");
  EXPECT_EQ(refusal("3 furlong", "m"),
            "t.toml:3:10: 'furlong' is not a unit known here; tank.radius is a length in m");
}

TEST(Units, RefusesWhatIsNoQuantity) {
  for (const char* text : {"", " ", "m", "wide", "nan m", "inf m", "1e400 m", "0x10 m"}) {
    EXPECT_NE(refusal(text, "m"), "(accepted)") << text;
  }
  for (const char* text : {"1 m^", "1 m/", "1 (m", "1 m)", "1 m^999", "1 *m", "1 kkm", "1 m^x"}) {
    EXPECT_NE(refusal(text, "m"), "(accepted)") << text;
  }
  EXPECT_EQ(refusal("0.3", "m"),
            "t.toml:3:10: tank.radius = \"0.3\" has no unit - write 0.3 without quotes for SI "
            "units, or name the unit");
  // The number as TOML takes it.
  for (const auto& [text, plain] : {std::pair(".3", "0.3"), {"3.", "3"}, {"-.3", "-0.3"}}) {
    EXPECT_NE(refusal(text, "m").find(std::string("write ") + plain + " without"),
              std::string::npos)
        << refusal(text, "m");
  }
  EXPECT_NE(refusal("1e308 km", "m"), "(accepted)");
}

TEST(Units, HintIsAUnitThatWouldFit) {
  EXPECT_EQ(unit_hint(300, "m", 0.05, 5), " - if this is in mm, write \"300 mm\"");
  EXPECT_EQ(unit_hint(35, "kg", 1e-4, 10), " - if this is in g, write \"35 g\"");
  EXPECT_EQ(unit_hint(69, "1", 0, 1), " - if this is in %, write \"69 %\"");
  EXPECT_EQ(unit_hint(-1, "m", 0.05, 5), "");
  EXPECT_EQ(unit_hint(7, "no unit at all", 0, 1), "");
}

TEST(Units, EveryForceParameterHasAUnitThatCanBeWritten) {
  for (const ForceTerm* term : force_library()) {
    for (const Parameter& p : term->parameters()) {
      EXPECT_TRUE(parse_unit(p.unit)) << term->name() << "." << p.name << ": " << p.unit;
    }
  }
  EXPECT_FALSE(parse_unit("furlong"));
  EXPECT_FALSE(parse_unit(""));
}

TEST(Number, ShortestTextReadsBackTheSame) {
  for (const double v : {0.1, 1e-300, 5e-324, 0.1 + 0.2, 1e22, 14400.0, -0.0, 1.0 / 3}) {
    EXPECT_EQ(parse_number(shortest(v)), v) << shortest(v);
  }
  EXPECT_EQ(shortest(0.3), "0.3");
  EXPECT_EQ(parse_float(shortest(0.1f)), 0.1f);
}

TEST(Number, ReadsWholeFiniteNumbersOnly) {
  EXPECT_EQ(parse_number("+1.5e1"), 15);
  for (const char* text :
       {"", " 1", "1 ", "nan", "inf", "-inf", "1e999", "0x1", "1,5", "+-1", "--1"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  EXPECT_EQ(parse_whole("-12"), -12);
  for (const char* text : {"1.0", "9223372036854775808", ""})
    EXPECT_FALSE(parse_whole(text)) << text;
  EXPECT_EQ(without_rounding(58 * 0.025), "1.45");
  EXPECT_EQ(without_rounding(14400), "14400");
}

}  // namespace
}  // namespace lilytank
