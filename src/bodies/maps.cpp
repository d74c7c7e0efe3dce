#include "bodies/maps.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank::bodies {
namespace {

struct Point {
  double at = 0, value = 0;
};

// The reported law over the medium slip, as it is fitted to a group; null: there is none.
const Term* medium_of(const Comparison& c, std::size_t group) {
  if (c.reported == nullptr) return nullptr;
  for (const Term& t : c.reported->fits[group].model.terms) {
    if (t.law->variable == "medium slip") return &t;
  }
  return nullptr;
}

// Variable and push of one body at one sample; NaN where it has none.
Point point_of(const std::string& variable, const BodyRun& run, const Believed& b,
               const Term* medium, std::size_t k, std::size_t body, std::size_t nd) {
  const std::size_t row = run.bodies.size() * nd, i = k * row + body * nd;
  const double *x = &b.x[i], *v = &b.v[i], *a = &b.push[i];
  const double mass = run.mass[body];
  if (variable == "time") return {run.time[k], mass * a[0]};
  if (variable == "position") return {x[0], mass * a[0]};
  double u[2] = {v[0], nd > 1 ? v[1] : 0}, away = 0;
  if (variable == "pair") {
    const std::size_t other = k * row + (body == 0 ? 1 : 0) * nd;
    for (std::size_t d = 0; d < nd; ++d) u[d] = x[d] - b.x[other + d];
    away = run.radius[0] + run.radius[1];
  }
  if (variable == "medium slip") {
    const Scene scene = scene_of(run, static_cast<int>(nd), k, run.time[k], x, v);
    for (std::size_t d = 0; d < nd; ++d)
      u[d] -= velocity_of_medium(scene, medium->value, static_cast<int>(d));
  }
  const double size = std::hypot(u[0], u[1]);
  const double push = variable == "turn" ? (nd > 1 ? a[0] * u[1] - a[1] * u[0] : NAN)
                                         : a[0] * u[0] + (nd > 1 ? a[1] * u[1] : 0);
  return {size - away, mass * push / std::max(size, 1e-12)};
}

std::vector<Point> points_of(const Comparison& c, const std::string& variable) {
  const auto nd = static_cast<std::size_t>(c.experiment->dimensions);
  std::vector<Point> out;
  for (std::size_t i = 0; i < c.groups.size(); ++i) {
    const Term* medium = medium_of(c, i);
    if (variable == "medium slip" && medium == nullptr) continue;
    for (const BodyRun* run : c.groups[i].runs) {
      if (variable == "pair" && run->bodies.size() < 2) continue;
      const Believed b = believed(c.baseline.fits[i].model, c.groups[i].typical, *run);
      for (std::size_t k = 4; k < run->samples(); ++k) {
        const std::size_t bodies = variable == "pair" ? 2 : run->bodies.size();
        for (std::size_t body = 0; body < bodies; ++body) {
          const Point p = point_of(variable, *run, b, medium, k, body, nd);
          if (std::isfinite(p.at) && std::isfinite(p.value)) out.push_back(p);
        }
      }
    }
  }
  return out;
}

}  // namespace

FoundCurve map_of(const Comparison& c, const std::string& variable) {
  constexpr std::size_t kBins = 8;
  FoundCurve out;
  out.variable = variable.empty() ? "position" : variable;
  out.direction = variable == "slip"          ? "along the motion"
                  : variable == "medium slip" ? "along the slip"
                  : variable == "turn"        ? "to the right of the motion"
                  : variable == "pair"        ? "outwards"
                                              : "along x";
  out.unit = unit_of(variable, c.experiment->unit);
  out.value_unit = c.experiment->masses ? "N" : c.experiment->unit + "/s^2";
  std::vector<Point> p = points_of(c, out.variable);
  std::sort(p.begin(), p.end(), [](const Point& a, const Point& b) { return a.at < b.at; });
  if (p.size() < 8 * kBins) return {};
  double square = 0;
  for (std::size_t k = 0; k < kBins; ++k) {
    const std::size_t from = k * p.size() / kBins, to = (k + 1) * p.size() / kBins;
    const auto n = static_cast<double>(to - from);
    double at = 0, mean = 0, spread = 0;
    for (std::size_t i = from; i < to; ++i) at += p[i].at / n, mean += p[i].value / n;
    for (std::size_t i = from; i < to; ++i) spread += std::pow(p[i].value - mean, 2) / (n - 1);
    // Pushes are correlated in time: an eighth of the points is independent.
    out.at.push_back(at), out.value.push_back(mean);
    out.deviation.push_back(std::sqrt(8 * spread / n));
    square += std::pow(mean / std::max(out.deviation.back(), 1e-300), 2);
  }
  out.z = std::max(0.0, (square - kBins) / std::sqrt(2.0 * kBins));
  return out;
}

std::vector<FoundCurve> maps_of(const Comparison& c) {
  std::vector<FoundCurve> out;
  for (const char* variable : {"slip", "medium slip", "turn", "position", "pair", "time"}) {
    FoundCurve curve = map_of(c, variable);
    if (!curve.at.empty()) out.push_back(std::move(curve));
  }
  return out;
}

}  // namespace lilytank::bodies
