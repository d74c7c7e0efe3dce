// Drag relative to a current and the wind: what drifters and ice do.
#include <gtest/gtest.h>

#include "bodies/simulated_runs.hpp"
#include "io/file_digest.hpp"
#include "lilytank/error.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {
namespace {

constexpr double kStep = 600, kRelax = 1.0 / 1500, kShare = 0.03;

// A drifter that follows the current and a wind fraction; fixes every ten minutes, 5 m of
// noise.
BodyRun drifter(std::uint64_t seed, double share) {
  BodyRun run;
  run.name = "buoy " + std::to_string(seed), run.bodies = {"buoy"}, run.mass = {1},
  run.radius = {0};
  double x[2] = {0, 0}, v[2] = {0, 0};
  for (int k = 0; k < 50; ++k) {
    const double t = k * kStep, phase = static_cast<double>(seed);
    const double current[2] = {0.2 * std::sin(t / 11000 + phase), 0.15 * std::cos(t / 8000)};
    const double wind[2] = {8 * std::sin(t / 15000 + 2 * phase), 6 * std::cos(t / 23000 + phase)};
    run.time.push_back(t);
    for (std::uint32_t d = 0; d < 2; ++d) {
      run.position.push_back(x[d] + 5 * normal_pair({seed, Stream::camera, k, d, 0})[0]);
    }
    for (const double* of : {current, wind}) run.drivers.insert(run.drivers.end(), of, of + 2);
    for (int d = 0; d < 2; ++d) {
      // The solution for water that holds until the next fix.
      const double u = current[d] + share * wind[d], off = v[d] - u;
      const double left = std::exp(-kRelax * kStep);
      x[d] += u * kStep + off * (1 - left) / kRelax, v[d] = u + off * left;
    }
  }
  return run;
}

BodyExperiment drifters(double share) {
  BodyExperiment e;
  e.name = "drifters", e.dimensions = 2, e.noise = 5;
  e.drivers = {"u", "v", "wind_u", "wind_v"};
  e.current[0] = 0, e.current[1] = 1, e.wind[0] = 2, e.wind[1] = 3;
  e.runs = {drifter(1, share), drifter(2, share)};
  return e;
}

const FoundParameter& named(const DiagnosisFinding& f, const std::string& name) {
  for (const FoundParameter& p : f.parameters) {
    if (p.name.find(name) != std::string::npos) return p;
  }
  throw InputError("no " + name);
}

TEST(Medium, DriftersFollowTheCurrentAndAShareOfTheWind) {
  for (const double share : {kShare, 0.0}) {
    const Diagnosis d = diagnosis_of(drifters(share));
    ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
    const DiagnosisFinding& f = d.findings.front();
    EXPECT_EQ(f.effect, "linear_drag_in_medium") << diagnosis_text(d);
    const FoundParameter& of_wind = named(f, "wind fraction");
    EXPECT_LE(of_wind.low, share);
    EXPECT_GE(of_wind.high, share);
    EXPECT_LT(of_wind.high - of_wind.low, 0.01);
    EXPECT_EQ(f.parameters.size(), 2u);
    const FoundParameter& rate = named(f, "coefficient");
    EXPECT_LE(rate.low, kRelax);
    EXPECT_GE(rate.high, kRelax);
  }
}

TEST(Medium, IsNotSeenWhereNothingActs) {
  BodyExperiment e = drifters(0);
  for (BodyRun& run : e.runs) {
    for (std::size_t k = 0; k < run.samples(); ++k) {
      run.position[2 * k] =
          0.1 * run.time[k] + 5 * normal_pair({run.name.size() + 40, Stream::camera,
                                               static_cast<std::int64_t>(k), 0, 0})[0];
      run.position[2 * k + 1] = 5 * normal_pair({run.name.size() + 50, Stream::camera,
                                                 static_cast<std::int64_t>(k), 1, 0})[0];
    }
  }
  e.runs.resize(1);
  const Diagnosis d = diagnosis_of(e);
  EXPECT_EQ(d.verdict, Verdict::complete) << diagnosis_text(d);
}

// A falling ball: F = 1/2 rho Cd pi r^2 v^2.
TEST(Medium, ItsDensityGivesTheDragCoefficient) {
  constexpr double kMass = 0.05, kRadius = 0.05, kDensity = 1.2, kCd = 0.5;
  const double c = 0.5 * kDensity * kCd * 3.14159265358979 * kRadius * kRadius;
  BodyExperiment e = falls(0, c / kMass, 1e-3, 3);
  e.masses = true, e.density = kDensity;
  for (BodyRun& run : e.runs) run.mass = {kMass}, run.radius = {kRadius};
  const Diagnosis d = diagnosis_of(e);
  ASSERT_EQ(d.verdict, Verdict::missing) << diagnosis_text(d);
  ASSERT_EQ(d.findings.front().effect, "quadratic_drag");
  const FoundParameter& found = named(d.findings.front(), "Cd");
  EXPECT_LE(found.low, kCd);
  EXPECT_GE(found.high, kCd);
  EXPECT_NEAR(found.value, kCd, 0.02);
}

TEST(Medium, DriversAreNamedInTheFile) {
  const TemporaryDirectory here;
  const std::string start =
      "[experiment]\nbody = \"point\"\ndimensions = 2\nwind = [\"wu\", \"wv\"]\n";
  const std::string rest =
      "[[recording]]\nfile = \"a.csv\"\ntime = \"t\"\nx = \"x\"\ny = \"y\"\ndrivers = [\"wu\", "
      "\"wv\"]\n";
  std::string table = "t,x,y,wu,wv\n";
  for (int k = 0; k < 12; ++k) table += std::to_string(k) + ",1,2,3,4\n";
  here.write("a.csv", table);
  here.write("e.toml", start + rest);
  const BodyExperiment e = load_body_experiment(here.path("e.toml"));
  EXPECT_EQ(e.wind[0], 0);
  EXPECT_EQ(e.wind[1], 1);
  EXPECT_EQ(e.current[0], -1);
  const auto refusal = [&](const std::string& line) {
    here.write("e.toml", start + line + rest);
    try {
      load_body_experiment(here.path("e.toml"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("current = [\"u\", \"wv\"]\n")
                .find("e.toml:5:12: experiment.current = \"u\" is "
                      "none of the drivers of the recordings"),
            std::string::npos)
      << refusal("current = [\"u\", \"wv\"]\n");
  EXPECT_NE(refusal("current = [\"wu\"]\n").find("experiment.current has 1 name for 2 dimensions"),
            std::string::npos);
}

// Twelve fixes to the east along the 60th parallel across the date line, a hundredth of a degree
// each: 556 m.
TEST(Geographic, DegreesBecomeMetresAndTheLatitudeADriver) {
  const TemporaryDirectory here;
  const auto table = [&](const std::string& latitude) {
    std::string text = "t,lon,lat\n";
    for (int k = 0; k < 12; ++k) {
      const double lon = 179.95 + 0.01 * k;
      text += std::to_string(600 * k) + "," + std::to_string(lon > 180 ? lon - 360 : lon) + "," +
              latitude + "\n";
    }
    here.write("a.csv", text);
  };
  const std::string rest =
      "[[recording]]\nfile = \"a.csv\"\ntime = \"t\"\nx = \"lon\"\ny = \"lat\"\n";
  here.write(
      "e.toml",
      "[experiment]\nbody = \"point\"\ndimensions = 2\ncoordinates = \"geographic\"\n" + rest);
  table("60");
  const BodyExperiment e = load_body_experiment(here.path("e.toml"));
  ASSERT_EQ(e.latitude, 0);
  EXPECT_EQ(e.drivers, std::vector<std::string>{"latitude"});
  const BodyRun& run = e.runs.front();
  EXPECT_EQ(run.drivers_at(3)[0], 60);
  for (std::size_t k = 1; k < 12; ++k) {
    EXPECT_NEAR(run.position[2 * k] - run.position[2 * k - 2], 0.5 * 1111.95, 0.01);
    EXPECT_NEAR(run.position[2 * k + 1] - run.position[2 * k - 1], 0, 0.6);
  }
  const auto refusal = [&] {
    try {
      load_body_experiment(here.path("e.toml"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  table("95");
  EXPECT_NE(refusal().find("a.csv:2"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("'95' is no latitude in degrees"), std::string::npos) << refusal();
  table("60");
  here.write("e.toml", "[experiment]\nbody = \"point\"\ncoordinates = \"geographic\"\n" + rest);
  EXPECT_NE(refusal().find("geographic coordinates need experiment.dimensions = 2"),
            std::string::npos)
      << refusal();
}

}  // namespace
}  // namespace lilytank
