// The built-in tank. Its radial profiles follow what is known of the paper's tank: a swirl whose
// peak lies near 13 cm, an inflow beside it that vanishes towards the centre, gusts of 0.14 to 0.19
// m/s per axis; on top of that the streams of the inlets. The inflow's size is chosen so that balls
// move at about 0.2 m/s as in the paper.
#include <cmath>

#include "lilytank/flow_field.hpp"

namespace lilytank {
namespace {

constexpr double kReference = 0.30;  // m, tank radius of the profiles; other tanks scale them
constexpr double kSwirl = 0.23;      // m/s, at its peak
constexpr double kInflow = 0.33;     // of the swirl, both at their peaks
constexpr double kJet = 0.10;        // m/s, at an inlet
constexpr double kJetReach = 0.08;   // m, the stream's speed falls by e
constexpr double kJetWidth = 0.018;  // m, at the inlet; it spreads by an eighth of its length
constexpr double kGustCentre = 0.14, kGustPeak = 0.05;  // m/s

// Rises as r^power, peaks with 1 at r = peak, and falls as an exponential.
double profile(double r, double peak, int power) {
  const double q = r / peak * exp_portable(1 - r / peak);
  return power == 2 ? q * q : q * q * q;
}

struct Inlet {
  Rot out, way;  // from the centre to the inlet; of its stream
};

std::vector<Inlet> inlets_of(const AnalyticTank& tank) {
  std::vector<Inlet> inlets;
  for (int k = 0; k < tank.inlets; ++k) {
    const double angle = 2 * kPi * k / tank.inlets;
    // Inwards, turned towards the swirl (counter-clockwise as seen from above).
    inlets.push_back({rotation(angle), rotation(angle + kPi - tank.inlet_angle)});
  }
  return inlets;
}

Vec2 jets(const std::vector<Inlet>& inlets, double x, double y, double scale) {
  Vec2 sum(0, 0);
  for (const auto& [out, way] : inlets) {
    const double dx = x / scale - kReference * out.c, dy = y / scale - kReference * out.s;
    const double along = dx * way.c + dy * way.s, aside = dy * way.c - dx * way.s;
    if (along < 0) continue;
    const double width = kJetWidth + along / 8, q = aside / width;
    const double speed = kJet * exp_portable(-along / kJetReach - q * q);
    sum += speed * Vec2(way.c, way.s);
  }
  return sum;
}

}  // namespace

double AnalyticTank::strength() const {
  return pump_power / 69 * std::fmax(0, 1 + 15 * (-0.08 - water_level));
}

FlowField analytic_tank(const AnalyticTank& tank, Interpolation interpolation) {
  const double scale = tank.radius / kReference, strength = tank.strength();
  // Stronger streams turn the water faster and push it further towards the centre: the inflow
  // grows faster than the swirl, which is what lowers the plateau of the MSD in Fig. 4.
  const double inflow = kInflow * strength;
  const std::vector<Inlet> inlets = inlets_of(tank);
  std::vector<FlowSample> samples;
  const double h = 2 * tank.radius / tank.cells;
  for (int iy = 0; iy < tank.cells; ++iy) {
    for (int ix = 0; ix < tank.cells; ++ix) {
      const double x = (ix + 0.5) * h - tank.radius, y = (iy + 0.5) * h - tank.radius;
      const double r = std::sqrt(x * x + y * y);
      const double c = r > 0 ? x / r : 0, s = r > 0 ? y / r : 0;
      const double around = strength * kSwirl * profile(r / scale, 0.13, 2);
      const double inward = inflow * strength * kSwirl * profile(r / scale, 0.13, 3);
      const Vec2 jet = strength * jets(inlets, x, y, scale);
      const double sigma = strength * (kGustCentre + kGustPeak * profile(r / scale, 0.18, 2));
      samples.push_back(
          {-around * s - inward * c + jet.x(), around * c - inward * s + jet.y(), sigma, sigma});
    }
  }
  std::vector<bool> measured(samples.size(), true);
  return FlowField(tank.cells, tank.radius, std::move(samples), std::move(measured), interpolation);
}

}  // namespace lilytank
