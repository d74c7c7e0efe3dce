// Colours that carry a meaning are distinct for every reader: with full colour vision, and without
// red (protanopia) or green (deuteranopia) cones.
#include "../../render/palette.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lilytank {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

constexpr Matrix kFull{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
// Machado, Oliveira and Fernandes 2009, IEEE Trans. Vis. Comput. Graph. 15, 1291, severity 1; of
// linear RGB.
constexpr Matrix kProtanopia{{{0.152286, 1.052583, -0.204868},
                              {0.114503, 0.786281, 0.099216},
                              {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kDeuteranopia{{{0.367322, 0.860646, -0.227968},
                                {0.280085, 0.672501, 0.047413},
                                {-0.011820, 0.042940, 0.968881}}};
constexpr Matrix kXyz{{{0.4124564, 0.3575761, 0.1804375},
                       {0.2126729, 0.7151522, 0.0721750},
                       {0.0193339, 0.1191920, 0.9503041}}};

Triple times(const Matrix& m, const Triple& v) {
  Triple out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  }
  return out;
}

double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

// CIE L*, a*, b* of a colour as an eye sees it.
Triple seen(const Colour& c, const Matrix& eye) {
  Triple rgb = times(eye, {linear(c.r), linear(c.g), linear(c.b)});
  for (double& v : rgb) v = std::min(1.0, std::max(0.0, v));
  Triple f = times(kXyz, rgb);
  const Triple white{0.95047, 1, 1.08883};
  for (std::size_t i = 0; i < 3; ++i) {
    const double v = f[i] / white[i];
    f[i] = v > 0.008856 ? std::cbrt(v) : 7.787 * v + 16.0 / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

double apart(const Colour& a, const Colour& b, const Matrix& eye) {
  const Triple p = seen(a, eye), q = seen(b, eye);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// The least distance of a pair, of all three eyes. 2 is just noticeable; small marks need more.
template <class ColourOf>
double least_apart(int colours, const ColourOf& colour_of) {
  double least = 1e9;
  for (const Matrix& eye : {kFull, kProtanopia, kDeuteranopia}) {
    for (int i = 0; i < colours; ++i) {
      for (int j = 0; j < i; ++j) {
        least = std::min(least, apart(colour_of(i), colour_of(j), eye));
      }
    }
  }
  return least;
}

TEST(Palette, SimulatedEyesConfuseWhatRealOnesDo) {
  const Colour red = rgb(0xD1495B), green = rgb(0x228833);
  EXPECT_GT(apart(red, green, kFull), 80);
  EXPECT_LT(apart(red, green, kDeuteranopia), 15);
  EXPECT_NEAR(apart(rgb(0), rgb(0xFFFFFF), kProtanopia), 100, 1) << "grey stays grey";
}

TEST(Palette, CurvesAreDistinctForEveryEye) {
  EXPECT_GT(least_apart(6, colour_of_curve), 30);
}

TEST(Palette, ClassesOfMapsAreDistinctForEveryEye) {
  EXPECT_GT(least_apart(5, colour_of_class), 30);
}

TEST(Palette, StatesAreDistinctForEveryEye) {
  EXPECT_GT(least_apart(10, colour_of_state), 25) << "neutral modules among them";
}

// A scale for numbers rises in lightness, so that it stays in order in grey print and for any eye.
TEST(Palette, TheRisingScaleRisesForEveryEye) {
  for (const Matrix& eye : {kFull, kProtanopia, kDeuteranopia}) {
    for (int i = 0; i < 16; ++i) {
      EXPECT_LT(seen(colour_on(ColourScale::rising, i / 16.0), eye)[0],
                seen(colour_on(ColourScale::rising, (i + 1) / 16.0), eye)[0])
          << i;
    }
  }
}

TEST(Palette, EndsOfTheDivergingScaleAreDistinctForEveryEye) {
  const Colour low = colour_on(ColourScale::diverging, 0.1);
  const Colour high = colour_on(ColourScale::diverging, 0.9);
  for (const Matrix& eye : {kFull, kProtanopia, kDeuteranopia})
    EXPECT_GT(apart(low, high, eye), 50);
}

TEST(Palette, LinesAreReadOnPaper) {
  for (int i = 0; i < 6; ++i) EXPECT_GT(apart(colour_of_curve(i), palette::paper, kFull), 30) << i;
}

}  // namespace
}  // namespace lilytank
