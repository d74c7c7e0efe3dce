#include "bodies/geographic.hpp"

#include <cmath>
#include <numbers>

namespace lilytank {
namespace {

// Calls use(longitude, latitude) in radians with both numbers of every position that is known.
template <class Use>
void each_position(BodyExperiment& e, Use&& use) {
  constexpr double kDegree = std::numbers::pi / 180;
  for (BodyRun& run : e.runs) {
    for (std::size_t i = 0; i + 1 < run.position.size(); i += 2) {
      double &x = run.position[i], &y = run.position[i + 1];
      if (std::isfinite(x) && std::isfinite(y)) use(kDegree * x, kDegree * y, x, y);
    }
  }
}

}  // namespace

void add_latitudes(BodyExperiment& e) {
  const std::size_t before = e.drivers.size();
  for (BodyRun& run : e.runs) {
    std::vector<double> drivers;
    const std::size_t row = run.coordinates();
    double last = NAN;
    for (std::size_t k = run.samples(); k-- > 0;) {
      if (std::isfinite(run.position[k * row + 1])) last = run.position[k * row + 1];  // the first
    }
    for (std::size_t k = 0; k < run.samples(); ++k) {
      if (std::isfinite(run.position[k * row + 1])) last = run.position[k * row + 1];
      const auto own = run.drivers.begin() + static_cast<std::ptrdiff_t>(k * before);
      drivers.insert(drivers.end(), own, own + static_cast<std::ptrdiff_t>(before));
      drivers.push_back(std::isfinite(last) ? last : 0);
    }
    run.drivers = std::move(drivers);
  }
  e.latitude = static_cast<int>(before);
  e.drivers.emplace_back("latitude");
}

void project_positions(const std::string& file, BodyExperiment& e) {
  constexpr double kEarth = 6371008.8;  // m, mean radius
  constexpr double kFarthest = 1e6;     // m
  double sum[3] = {0, 0, 0};
  each_position(e, [&](double lon, double lat, double&, double&) {
    sum[0] += std::cos(lat) * std::cos(lon), sum[1] += std::cos(lat) * std::sin(lon);
    sum[2] += std::sin(lat);
  });
  const double lon0 = std::atan2(sum[1], sum[0]);
  const double lat0 = std::atan2(sum[2], std::hypot(sum[0], sum[1]));
  each_position(e, [&](double lon, double lat, double& x, double& y) {
    const double east = std::cos(lat) * std::sin(lon - lon0);
    const double north =
        std::cos(lat0) * std::sin(lat) - std::sin(lat0) * std::cos(lat) * std::cos(lon - lon0);
    const double up =
        std::sin(lat0) * std::sin(lat) + std::cos(lat0) * std::cos(lat) * std::cos(lon - lon0);
    const double sine = std::hypot(east, north), angle = std::atan2(sine, up);
    if (kEarth * angle > kFarthest) {
      throw InputError({file},
                       "positions are more than 1000 km from their centre, too far for a "
                       "plane: diagnose parts of the tracks");
    }
    const double by = sine > 0 ? kEarth * angle / sine : kEarth;
    x = by * east, y = by * north;
  });
}

}  // namespace lilytank
