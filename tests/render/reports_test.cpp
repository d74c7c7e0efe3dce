// Figures of reports: diagnoses, proofs, analyses, calibrations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lilytank/render.hpp"
#include "render/picture.hpp"

namespace lilytank {
namespace {

using sample::Folder;

Diagnosis found(const DiagnosisSubject& subject) {
  Diagnosis d;
  d.name = "found", d.subject = &subject, d.verdict = Verdict::missing;
  FoundCurve curve{"pair", "outwards", "m", "N", {0.01, 0.02, 0.03}, {2, 1, 0}, {1, 1, 1}, 90};
  DiagnosisFinding finding;
  finding.effect = "pair_attraction", finding.z = 7, finding.curve = curve;
  d.findings = {finding}, d.maps = {curve};
  d.held_out = {{"contact", 30, 2}};
  return d;
}

// The bytes of one of its files.
std::string drawn(const Diagnosis& d, const std::string& name) {
  const Folder folder;
  draw_diagnosis(d, diagnosis_report(d), folder.path());
  return sample::bytes_of(folder.file(name));
}

TEST(DiagnosisFigures, OfBodiesDoNotSpeakOfHeldOutRecordings) {
  const std::string tank = drawn(found(kLiliesInTank), "report.html");
  const std::string bodies = drawn(found(kPointBodies), "report.html");
  EXPECT_NE(tank.find("recordings that were not used"), std::string::npos);
  EXPECT_EQ(bodies.find("not used"), std::string::npos);
  EXPECT_EQ(bodies.find("chance alone would give"), std::string::npos);
  EXPECT_NE(bodies.find("a quarter of a run ahead"), std::string::npos);
  EXPECT_NE(bodies.find("fitted to all runs"), std::string::npos);
  EXPECT_FALSE(drawn(found(kLiliesInTank), "fit.png") == drawn(found(kPointBodies), "fit.png"));
}

TEST(DiagnosisFigures, GroupsOfBodiesKeepTheirNames) {
  Diagnosis d = found(kPointBodies), other = d;
  other.held_out[0].group = "bounces";  // what "contact" reads as in a tank
  EXPECT_FALSE(drawn(d, "fit.png") == drawn(other, "fit.png"));
  d.subject = other.subject = &kLiliesInTank;
  EXPECT_TRUE(drawn(d, "fit.png") == drawn(other, "fit.png"));
}

TEST(DiagnosisFigures, TellTheFindingsOwnZ) {
  for (const DiagnosisSubject* subject : {&kLiliesInTank, &kPointBodies}) {
    const Diagnosis d = found(*subject);
    Diagnosis other = d;
    other.findings[0].curve.z = 5;
    EXPECT_TRUE(drawn(d, "laws.png") == drawn(other, "laws.png")) << subject->bodies;
    other.findings[0].z = 6;
    EXPECT_FALSE(drawn(d, "laws.png") == drawn(other, "laws.png")) << subject->bodies;
    other = d;
    other.maps[0].z = 5;
    EXPECT_EQ(drawn(d, "maps.png") == drawn(other, "maps.png"), !subject->curves_tested)
        << "of bodies there is none";
  }
}

TEST(DiagnosisFigures, OfOneGroupHaveRoomForTheirLegend) {
  const Folder folder;
  draw_diagnosis(found(kPointBodies), diagnosis_report(found(kPointBodies)), folder.path());
  EXPECT_GE(sample::png_size(folder.file("fit.png")).height, 400);
}

// A map where the effect has a place, with a circle at the place of the fit.
TEST(DiagnosisFigures, MapThePlaceOfAnEffect) {
  Diagnosis d = found(kLiliesInTank);
  EXPECT_EQ(drawn(d, "report.html").find("places.png"), std::string::npos);
  DiagnosisFinding& f = d.findings[0];
  f.effect = "drag_patch";
  f.places = {{"strength"}, {"1"}, 0.06, 0.3, {}};
  for (int k = 0; k < 49; ++k) {
    const double x = 0.08 * (k % 7 - 3), y = 0.08 * (k / 7 - 3);
    f.places.places.push_back({x, y, {std::exp(-50 * (x * x + y * y))}, 5});
  }
  const std::string alone = drawn(d, "places.png");
  f.parameters = {{"x", "forces.drag_patch.x", 0.1, 0.05, 0.15, "m"},
                  {"y", "forces.drag_patch.y", 0, -0.05, 0.05, "m"},
                  {"radius", "forces.drag_patch.radius", 0.06, 0.03, 0.1, "m"}};
  EXPECT_FALSE(alone == drawn(d, "places.png"));
  const Folder folder;
  const std::vector<std::string> files = write_diagnosis(d, diagnosis_report(d), folder.path());
  EXPECT_EQ(std::ranges::count(files, "places.csv"), 1);
  EXPECT_NE(
      sample::bytes_of(folder.file("places.csv")).find("\ndrag_patch,0,0,0.06,strength,1,1,5\n"),
      std::string::npos);
}

ProofWorld told(const std::string& kind, std::vector<std::string> effects, double z,
                std::vector<std::string> names) {
  ProofWorld w;
  w.kind = kind, w.effects = std::move(effects), w.expected_z = z;
  w.verdict = names.empty() ? Verdict::complete : Verdict::missing;
  for (const std::string& name : names) w.findings.push_back({name, {}, "", 9});
  return w;
}

std::string proof_page(const std::vector<ProofWorld>& worlds) {
  Proof p;
  p.worlds = worlds;
  const Folder folder;
  draw_proof(proof_figures({&p, 1}), proof_report({&p, 1}), folder.path());
  return sample::bytes_of(folder.file("report.html"));
}

TEST(ProofFigures, AWrongNameIsOneWhateverIsRightBesideIt) {
  Proof p;
  p.worlds = {told("named", {"coriolis"}, 12, {"coriolis", "wall_layer"})};
  ASSERT_TRUE(p.worlds[0].right());
  ASSERT_TRUE(p.worlds[0].wrong_name());
  EXPECT_EQ(proof_figures({&p, 1}).points[0].outcome, ProofPoint::Outcome::wrong_name);
}

TEST(ProofFigures, SayWhatStandsAtTheEdgeOnlyIfSomethingDoes) {
  const ProofWorld strong = told("named", {"coriolis"}, 12, {"coriolis"});
  EXPECT_EQ(proof_page({strong}).find("left edge"), std::string::npos);
  EXPECT_NE(proof_page({strong, told("named", {"coriolis"}, 0, {})}).find("left edge"),
            std::string::npos);
}

TEST(ProofFigures, SayWhoseZTwoEffectsHave) {
  const ProofWorld one = told("named", {"coriolis"}, 12, {"coriolis"});
  const ProofWorld two = told("two", {"coriolis", "wall_layer"}, 12, {"coriolis", "wall_layer"});
  EXPECT_EQ(proof_page({one}).find("the weaker one's"), std::string::npos);
  EXPECT_NE(proof_page({one, two}).find("the weaker one's"), std::string::npos);
}

int red_pixels(const std::string& file) {
  return sample::count_pixels(
      file, [](const sample::Pixel& p) { return p.r > 180 && p.g < 120 && p.b < 140; });
}

TEST(ProofFigures, FailuresLieAboveWhatIsRight) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  ProofFigures f;
  f.points.assign(1, {"coriolis", 12, ProofPoint::Outcome::wrong_name});
  draw_proof(f, ReportDocument{}, folder.path());
  const int alone = red_pixels(folder.file("outcomes.png"));
  EXPECT_GT(alone, 50);
  f.points.insert(f.points.begin(), 40, {"coriolis", 12, ProofPoint::Outcome::right});
  draw_proof(f, ReportDocument{}, folder.path());
  EXPECT_GE(red_pixels(folder.file("outcomes.png")), 0.9 * alone) << "but for its mixed edge";
}

// A measured and a modelled curve over the same lags, the model's band reaching up to `high`.
Analysis compared(double high) {
  Analysis a;
  a.sources.resize(2);
  a.sources[0].name = "measured", a.sources[1].name = "model";
  AnalysisCurves set;
  set.name = "msd_all", set.title = "MSD", set.x_name = "lag", set.x_unit = "s";
  set.y_name = "msd", set.y_unit = "m^2", set.x = {0, 1, 2};
  for (int s = 0; s < 2; ++s) {
    set.sources.push_back(
        {s, {{0, 1e-4, 2e-4}, {0, 1e-4, 2e-4}, {0, 1e-4, 2e-4}}, {3, 2, 1}, {1, 1, 1}});
  }
  set.sources[1].curve.high[1] = high;
  a.curves = {set};
  return a;
}

TEST(AnalysisFigures, PanelsShareAnAxisWithRoomForTheirBands) {
  Analysis a = compared(9e-4);
  a.sources[0].panel = "low", a.sources[1].panel = "high";
  a.curves[0].sources[1].curve.value[2] = NAN;
  const PlotPage page = analysis_plots(a).front().page;
  ASSERT_EQ(page.plots.size(), 2u);
  EXPECT_GE(page.plots[0].y_high, 9) << "cm^2";
  EXPECT_EQ(page.plots[0].y_high, page.plots[1].y_high);
  EXPECT_EQ(page.plots[0].x_high, 2);
  EXPECT_EQ(page.plots[1].x_high, 2) << "though its curve ends before";
}

// An MSD at the first lag is not one at lag 0.
TEST(AnalysisFigures, LinearAxesBeginAtZero) {
  Analysis a = compared(9e-4);
  a.curves[0].name = "msd_all", a.curves[0].x = {1, 2, 3};
  const auto plots = analysis_plots(a);
  ASSERT_EQ(plots[0].name, "msd_all");
  EXPECT_EQ(plots[0].page.plots[0].x_low, 0);
  EXPECT_EQ(plots[0].page.plots[0].x_high, 3);
  ASSERT_EQ(plots[1].name, "msd_all_log");
  EXPECT_NE(plots[1].page.plots[0].x_low, plots[0].page.plots[0].x_high);
  EXPECT_TRUE(plots[1].page.plots[0].log_x);
  // Velocities have both signs.
  a.curves[0].name = "velocity_x", a.curves[0].x = {-2, 0, 3};
  EXPECT_EQ(analysis_plots(a).front().page.plots[0].x_low, -2);
}

TEST(AnalysisFigures, LegendsSayWhatNamesAreValuesOf) {
  Analysis a = compared(9e-4);
  EXPECT_EQ(analysis_plots(a).front().page.plots[0].legend_title, "");
  a.sources[0].key = a.sources[1].key = "pump power";
  EXPECT_EQ(analysis_plots(a).front().page.plots[0].legend_title, "pump power");
  a.sources[1].key = "";
  EXPECT_EQ(analysis_plots(a).front().page.plots[0].legend_title, "");
}

TEST(AnalysisFigures, ADifferenceHasItsOwnColourAndTheSameLags) {
  Analysis a = compared(2e-4);
  a.curves[0].difference = {{NAN, 1e-5, 2e-5}, {NAN, 0, 0}, {NAN, 3e-5, 4e-5}};
  const PlotPage page = analysis_plots(a).front().page;
  ASSERT_EQ(page.plots.size(), 3u) << "curves, difference, tracks";
  const std::vector<Curve>& difference = page.plots[1].curves;
  ASSERT_EQ(difference.size(), 3u) << "the third colour";
  EXPECT_TRUE(difference[0].x.empty() && difference[1].x.empty());
  EXPECT_EQ(difference[2].x.size(), 3u);
  for (const Plot& plot : page.plots) {
    EXPECT_EQ(plot.x_low, 0);
    EXPECT_EQ(plot.x_high, 2);
  }
}

TEST(CalibrationFigures, ReplicatesAreMarkers) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  CalibrationResult c;
  c.parameters.resize(2);
  c.correlation = {1, 0.5, 0.5, 1};
  for (CalibratedParameter& p : c.parameters) {
    p.parameter.path = "flow.K_v", p.parameter.unit = "1", p.estimate = 0.5;
  }
  for (int k = 0; k < 5; ++k) c.replicate_estimates.push_back({0.25 * k, 0.25 * (4 - k)});
  const Folder folder;
  draw_calibration(c, calibration_report(c), folder.path());
  // Red, of the second curve: five squares and one in the legend, of 40 pixels and more each. Those
  // outermost stand within the frame.
  EXPECT_GT(red_pixels(folder.file("estimates.png")), 240);
}

CalibrationResult calibrated(double truth) {
  CalibrationResult c;
  c.name = "tank", c.objective = "summary", c.recordings = 2, c.bodies = 15;
  for (const char* path : {"flow.K_v", "forces.damping.D_linear"}) {
    CalibratedParameter p;
    p.parameter = {path, "1/s", 0, 0.8, false, false};
    p.estimate = 0.4, p.low = 0.3, p.high = 0.5, p.truth = truth;
    // Far narrower than the interval, and never at the threshold on the left.
    p.profile_value = {0.38, 0.4, 0.42}, p.profile_rise = {2, 0, 30};
    c.parameters.push_back(p);
  }
  c.correlation = {1, -0.9, -0.9, 1};
  for (int i = 0; i < 30; ++i) c.replicate_estimates.push_back({0.3 + 0.01 * i, 0.5 - 0.01 * i});
  MsdFit m;
  m.recordings = "training", m.pieces = 8, m.experiments = 24, m.seconds = 60;
  m.floor = 2, m.after = 3, m.before = 8;
  m.lag = {1, 2, 3}, m.real = m.simulated_after = m.simulated_before = {1, 3, 2};
  m.real_low = m.after_low = {0.9, 2.9, 1.9}, m.real_high = m.after_high = {1.1, 3.1, 2.1};
  m.floor_at = m.after_at = m.before_at = {0.1, 0.2, 0.3};
  c.msd = {m};
  return c;
}

// A file of its figures.
std::string drawn(const CalibrationResult& c, const std::string& file) {
  const Folder folder;
  draw_calibration(c, ReportDocument{}, folder.path());
  return sample::bytes_of(folder.file(file));
}

TEST(CalibrationFigures, TheCornerHasPriorBoundsAndTheTruthWhereItIsKnown) {
  const std::string known = drawn(calibrated(0.45), "estimates.svg");
  const std::string unknown = drawn(calibrated(NAN), "estimates.svg");
  for (const std::string& svg : {known, unknown}) {
    EXPECT_NE(svg.find(">prior 0</text>"), std::string::npos);
    EXPECT_NE(svg.find(">to 0.8 1/s</text>"), std::string::npos);
    EXPECT_NE(svg.find("K_v and D_linear correlate by −0.90."), std::string::npos);
  }
  EXPECT_NE(known.find("planted truth"), std::string::npos);
  EXPECT_EQ(unknown.find("planted truth"), std::string::npos);
  EXPECT_NE(drawn(calibrated(NAN), "estimates.caption.txt").find("n: 30 simulated experiments"),
            std::string::npos);
}

TEST(CalibrationFigures, MsdsHaveBandsAndTheNoiseFloor) {
  const std::string svg = drawn(calibrated(NAN), "msd.svg");
  EXPECT_NE(svg.find("noise floor</text>"), std::string::npos);
  EXPECT_NE(svg.find("by 1.5 times"), std::string::npos) << "as a sentence";
  const std::string caption = drawn(calibrated(NAN), "msd.caption.txt");
  EXPECT_NE(caption.find("8 pieces of 60 s"), std::string::npos) << caption;
  EXPECT_NE(caption.find("24 simulated experiments"), std::string::npos) << caption;
  EXPECT_NE(caption.find("bands: 95 %"), std::string::npos) << caption;
  CalibrationResult bare = calibrated(NAN);
  bare.msd[0].real_low.clear(), bare.msd[0].real_high.clear();
  EXPECT_FALSE(drawn(bare, "msd.png") == drawn(calibrated(NAN), "msd.png")) << "without a band";
}

// From frame to frame, though the profile is a tenth of the axis.
TEST(CalibrationFigures, TheThresholdOfProfilesIsDrawnInFull) {
  if (!sample::has_ffmpeg()) GTEST_SKIP() << "reading pixels needs ffmpeg";
  const Folder folder;
  CalibrationResult c = calibrated(NAN);
  c.parameters.resize(1), c.correlation = {1};
  draw_calibration(c, ReportDocument{}, folder.path());
  const std::string file = folder.file("profiles.png");
  const sample::Pixels pixels(file);
  ASSERT_TRUE(pixels.read());
  const sample::Size size = sample::png_size(file);
  int longest = 0;
  for (int y = 0; y < size.height; ++y) {
    int green = 0;
    for (int x = 0; x < size.width; ++x) {
      const sample::Pixel p = pixels.at(x, y);
      green += p.g > p.r + 80 && p.g > p.b + 20;
    }
    longest = std::max(longest, green);
  }
  EXPECT_GT(longest, 0.75 * size.width) << "all but the margins";
}

TEST(RecoveryFigures, ShowEveryParameterAndCountWhatIsCovered) {
  const Folder folder;
  std::vector<RecoveryRow> rows(3);
  for (int i = 0; i < 3; ++i) {
    rows[i] = {i + 1, "summary", "flow.K_v", 0.4 + 0.1 * i, 0.5, 0.35, 0.55, 0.1, 1, false};
  }
  draw_recovery(rows, {"lilytank calibrate", "0.1.0", "1", {}}, folder.path());
  const std::string svg = sample::bytes_of(folder.file("recovery.svg"));
  EXPECT_NE(svg.find("2 of 3 intervals contain the planted value."), std::string::npos);
  EXPECT_NE(svg.find("K_v, planted"), std::string::npos);
  EXPECT_NE(
      sample::bytes_of(folder.file("recovery.caption.txt")).find("n: 3 synthetic experiments"),
      std::string::npos);
}

}  // namespace
}  // namespace lilytank
