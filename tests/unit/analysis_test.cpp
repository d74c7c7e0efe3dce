// The whole analysis: what it makes of sources, alone and against each other.
#include "lilytank/analysis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/temporary_directory.hpp"
#include "support/tracks.hpp"

namespace lilytank {
namespace {

std::string analysis_text(const Analysis& analysis) {
  return report_text(analysis_report(analysis));
}

// Bodies that go round at radii about 0.12 m with 1.5 rad/s, each at its own pace.
Recording orbits(std::uint64_t seed, int bodies, int frames, double rate, double spread = 0.1) {
  Recording r = test::recording_of(bodies, frames, rate, [=](int b, int f) {
    const double radius = 0.12 + 0.02 * test::normal(seed, 0, b, 0);
    const double pace = 1.5 + spread * test::normal(seed, 0, b, 1);
    const double a = 6.28 * b / bodies + pace * f / rate;
    const double noise = 3e-4;
    return std::array{radius * std::cos(a) + noise * test::normal(seed, f, b, 2),
                      radius * std::sin(a) + noise * test::normal(seed, f, b, 3)};
  });
  r.name = "orbits";
  return r;
}

AnalysisSource source(const std::string& name, Recording recording) {
  AnalysisSource s;
  s.name = name, s.body_size = 0.03;
  s.recordings.push_back(std::move(recording));
  return s;
}

TEST(Analysis, OfOrbitsFindsTheirMotion) {
  const Analysis a = analyse({source("a", orbits(1, 12, 400, 30))});
  const SourceSummary& s = a.sources[0];
  EXPECT_EQ(s.bodies, 12);
  EXPECT_EQ(s.sightings, 12 * 400);
  EXPECT_NEAR(s.duration, 399 / 30.0, 1e-9);
  EXPECT_NEAR(s.motion[0].noise, 3e-4, 3e-5);
  EXPECT_NEAR(s.circulation.value, 1.5, 0.1);
  EXPECT_LT(s.circulation.low, s.circulation.value);
  EXPECT_NEAR(s.first_maximum_lag.value, 3.14159 / 1.5, 0.2) << "half an orbit";
  EXPECT_TRUE(std::isnan(s.diffusion.D.value));
  EXPECT_FALSE(a.compared);
  ASSERT_NE(a.find("msd_all"), nullptr);
  EXPECT_EQ(a.find("msd_all")->sources[0].tracks[0], 12);
  EXPECT_EQ(a.find("spin"), nullptr) << "balls do not turn";
  EXPECT_NE(analysis_text(a).find("Smoothing"), std::string::npos);
}

TEST(Analysis, OfOneSourceTwiceShowsNoDifference) {
  const Recording r = orbits(2, 6, 300, 30);
  const Analysis a = analyse({source("a", r), source("b", r)});
  ASSERT_TRUE(a.compared);
  EXPECT_EQ(a.comparison.msd_difference, 0);
  EXPECT_EQ(a.comparison.msd_outside, 0);
  EXPECT_NEAR(a.comparison.map_correlation_x, 1, 1e-12);
  EXPECT_EQ(a.comparison.map_difference, 0);
  for (const AnalysisCurves& set : a.curves) {
    ASSERT_EQ(set.difference.value.size(), set.x.size()) << set.name;
    for (std::size_t i = 0; i < set.x.size(); ++i) {
      if (std::isnan(set.difference.value[i])) continue;
      EXPECT_LE(set.difference.low[i], 0) << set.name;
      EXPECT_GE(set.difference.high[i], 0) << set.name;
    }
  }
}

TEST(Analysis, ComparesSourcesOfUnequalRates) {
  AnalysisOptions options;
  options.msd_only = true;
  const Analysis a = analyse(
      {source("slow", orbits(3, 30, 300, 10, 0)), source("fast", orbits(3, 30, 1200, 40, 0))},
      options);
  EXPECT_NEAR(a.find("msd_all")->x[0], 0.1, 1e-12) << "lags are those of the slower";
  EXPECT_LT(a.comparison.msd_relative, 0.01);
}

TEST(Analysis, SeesThatMotionsDiffer) {
  Recording faster = orbits(4, 12, 300, 45);
  faster.rate = 30;  // the same paths at two thirds of the pace
  const Analysis a = analyse({source("a", orbits(4, 12, 300, 30)), source("b", faster)});
  EXPECT_GT(a.comparison.msd_outside, 0.5);
  EXPECT_LT(a.sources[1].circulation.high, a.sources[0].circulation.low);
}

TEST(Analysis, TakesRecordingsOfOneSourceTogether) {
  AnalysisSource both = source("both", orbits(5, 8, 300, 30));
  both.recordings.push_back(orbits(6, 8, 300, 30));
  const Analysis a = analyse({both});
  EXPECT_EQ(a.sources[0].bodies, 16) << "equal ids in two recordings are two bodies";
  EXPECT_EQ(a.find("msd_all")->sources[0].tracks[0], 16);
}

TEST(Analysis, WritesATidyTableForEveryCurve) {
  const TemporaryDirectory dir;
  const Analysis a =
      analyse({source("a, first", orbits(7, 6, 200, 30)), source("b", orbits(8, 6, 200, 30))});
  const std::vector<std::string> files = write_analysis(a, analysis_report(a), dir.path("out"));
  EXPECT_EQ(files.size(), a.curves.size() + 5);
  const std::string msd = dir.read("out/msd_all.csv");
  EXPECT_EQ(msd.substr(0, msd.find('\n')), "source,lag_s,msd_m2,low,high,tracks,samples");
  EXPECT_NE(msd.find("\"a, first\",0.03333333333,"), std::string::npos);
  EXPECT_NE(msd.find("\ndifference,0.03333333333,"), std::string::npos);
  EXPECT_NE(dir.read("out/summary.csv").find("\nb,circulation,rad/s,"), std::string::npos);
  const std::string map = dir.read("out/velocity_map.csv");
  EXPECT_EQ(map.substr(0, 17), "source,ix,iy,x_m,");
}

// A polynomial over 0.2 s says nothing of a track's first and last frames at 30 Hz: bodies are
// nowhere there, and neither near to others nor in contact anew once they are somewhere.
TEST(Analysis, FramesWithoutAnEstimateAreNoNeighbours) {
  AnalysisOptions options;
  options.smoothing.method = SmoothingMethod::polynomial, options.smoothing.window = 0.2;
  const Recording pair = test::recording_of(2, 60, 30, [](int b, int f) {
    return std::array{0.03 * b + 1e-4 * test::normal(3, f, b, 0), 0.001 * f};
  });
  const Analysis a = analyse({source("a", pair)}, options);
  EXPECT_NEAR(a.sources[0].nearest.value, 0.03, 1e-3);
  EXPECT_EQ(a.sources[0].contacts.contacts, 0);
  EXPECT_EQ(a.sources[0].contact_share.value, 1);
  const AnalysisCurves* nearest = a.find("nearest");
  ASSERT_NE(nearest, nullptr);
  double all = 0;
  for (const double v : nearest->sources[0].curve.value) all += v * 0.2 / 100;
  EXPECT_NEAR(all, 1, 1e-9);
}

TEST(Analysis, TellsTheWindowThatIsUsed) {
  AnalysisOptions options;
  options.smoothing.method = SmoothingMethod::polynomial, options.smoothing.window = 0.2;
  const Recording r = orbits(12, 4, 200, 5);
  const Analysis a = analyse({source("a", r)}, options);
  const std::string text = analysis_text(a);
  EXPECT_NE(text.find("window used (s)"), std::string::npos) << text;
  EXPECT_NE(text.find("1.00\n"), std::string::npos) << text;  // five frames
  EXPECT_NE(analysis_summary_csv(a).find("a,smoothing window used,s,1,"), std::string::npos);
  EXPECT_EQ(text.find("smooths away motion"), std::string::npos) << text;
  options.smoothing.window = 4;
  const std::string wide = analysis_text(analyse({source("a", r)}, options));
  EXPECT_NE(wide.find("a: a window of 4.20 s is longer than"), std::string::npos) << wide;
  EXPECT_EQ(analysis_text(analyse({source("a", r)})).find("window used"), std::string::npos);
}

// Of orbits with 1.5 rad/s the velocity's memory is 1 / 1.5 s.
TEST(Analysis, WarnsOfFramesTooFarApart) {
  const Analysis often = analyse({source("a", orbits(12, 4, 800, 30, 0))});
  EXPECT_FALSE(frames_too_far_apart(often.sources[0]));
  EXPECT_EQ(analysis_text(often).find("warning"), std::string::npos);
  EXPECT_NE(analysis_summary_csv(often).find("a,frames too far apart for velocities,1,0,"),
            std::string::npos);
  const Analysis rarely = analyse({source("a", orbits(12, 4, 100, 2, 0))});
  EXPECT_TRUE(frames_too_far_apart(rarely.sources[0]));
  const std::string text = analysis_text(rarely);
  const auto at = text.find(
      "warning: frames are further apart than a quarter of the velocity's "
      "memory: a (0.500 s, memory ");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NE(text.substr(at, text.find('\n', at) - at).find("--set output.rate=40"),
            std::string::npos)
      << "one line";
  EXPECT_NE(analysis_summary_csv(rarely).find("a,frames too far apart for velocities,1,1,"),
            std::string::npos);
  AnalysisOptions options;
  options.msd_only = true;
  const Analysis displacements = analyse({source("a", orbits(12, 4, 100, 2, 0))}, options);
  EXPECT_EQ(analysis_text(displacements).find("warning"), std::string::npos);
  const Recording still = test::recording_of(2, 60, 1, [](int b, int) {
    return std::array{0.1 * b, 0.0};
  });
  EXPECT_FALSE(frames_too_far_apart(analyse({source("a", still)}).sources[0]));
}

TEST(Analysis, RefusesWindowsLongerThanTracks) {
  AnalysisOptions options;
  options.smoothing.method = SmoothingMethod::polynomial, options.smoothing.window = 10;
  try {
    analyse({source("a", orbits(12, 4, 300, 30))}, options);
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "'a': a smoothing window of 10 s takes 301 frames, and its longest track has 300");
  }
  options.msd_only = true;  // which smooths nothing
  EXPECT_NO_THROW(analyse({source("a", orbits(12, 4, 300, 30))}, options));
}

TEST(Analysis, OfShortAndPoorRecordingsHoldsTogether) {
  for (const int frames : {2, 3, 9, 40}) {
    const Analysis a = analyse({source("a", orbits(9, 1, frames, 30))});
    EXPECT_FALSE(analysis_text(a).empty());
    for (const AnalysisCurves& set : a.curves) EXPECT_FALSE(curve_csv(a, set).empty());
  }
  EXPECT_THROW(analyse({source("none", Recording{})}), InputError);
  EXPECT_THROW(analyse({source("one frame", orbits(9, 3, 1, 30))}), InputError);
}

TEST(Analysis, OfDisplacementsOnlySmoothsNothing) {
  AnalysisOptions options;
  options.msd_only = true, options.longest_lag = 5;
  const Analysis a = analyse({source("a", orbits(1, 12, 900, 30))}, options);
  EXPECT_EQ(a.curves.size(), 2u);
  EXPECT_LE(a.curves[0].x.back(), 5.0001);
  EXPECT_TRUE(a.maps.empty());
  EXPECT_TRUE(std::isnan(a.sources[0].speed.value));
}

}  // namespace
}  // namespace lilytank
