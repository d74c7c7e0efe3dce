#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "recording/checks.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

/// A linear map of the file's coordinates.
struct Map {
  double pixel = 1, origin_x = 0, origin_y = 0;
  double y_sign = 1, angle = 1;
};

Map map_of(const Sightings& s, const RecordingOptions& options) {
  const Calibration& c = options.calibration;
  Map map;
  map.pixel = c.pixel > 0 ? c.pixel : s.units.pixel;
  if (c.circle_radius > 0) map.pixel = options.tank_radius / c.circle_radius;
  if (map.pixel == 0) {
    throw InputError({s.files.front(), 0, 0},
                     "positions are in pixels: say where the tank is with tank_circle = [x, y, "
                     "radius], or give pixel (the length of one) and origin");
  }
  map.origin_x = c.origin_x, map.origin_y = c.origin_y;
  const bool down = c.y_axis == YAxis::by_format ? s.units.y_down : c.y_axis == YAxis::down;
  const bool clockwise = c.y_axis == YAxis::by_format ? s.units.clockwise : down;
  map.y_sign = down ? -1 : 1;
  map.angle = clockwise ? -1 : 1;
  if (c.angles == AngleUnit::degrees) map.angle *= kPi / 180;
  return map;
}

/// What the user may have meant, if positions reach from the tank's centre to `reach` (m), around a
/// middle at (x, y).
std::string length_hint(const RecordingOptions& options, double reach, double x, double y,
                        double half_width, double pixel) {
  const double radius = options.tank_radius;
  if (length(x, y) > 0.5 * half_width && half_width < 1.1 * radius) {
    return "; the tank's centre seems to be near [" + brief(x / pixel) + ", " + brief(y / pixel) +
           "]: give origin or tank_circle";
  }
  const bool may_scale = options.calibration.circle_radius == 0;
  for (const auto& [scale, name] : {std::pair{1e-2, "cm"}, {1e-3, "mm"}}) {
    const double scaled = reach * scale / pixel;
    if (may_scale && scaled < 1.1 * radius && scaled > 0.3 * radius) {
      return std::string("; if lengths are in ") + name + ", say pixel = \"1 " + name + "\"";
    }
  }
  return "; are lengths in pixels? then say where the tank is: tank_circle = [x, y, radius]";
}

void check_lengths_with(const Map& map, const Sightings& s, const RecordingOptions& options,
                        Report& report) {
  constexpr double kMostOutside = 0.1;  // of the sightings
  const double limit = 1.1 * options.tank_radius;
  std::vector<double> radii, xs, ys;
  for (const Sighting& row : s.rows) {
    if (row.unseen) continue;
    radii.push_back(length(row.x, row.y));
    xs.push_back(row.x), ys.push_back(row.y);
  }
  if (radii.empty()) return;
  const auto n = static_cast<double>(radii.size());
  const auto outside = static_cast<double>(
      std::count_if(radii.begin(), radii.end(), [&](double r) { return !(r <= limit); }));
  const auto far = radii.begin() + static_cast<std::ptrdiff_t>(0.98 * (n - 1));
  std::nth_element(radii.begin(), far, radii.end());
  const SourcePlace place{s.files.front(), 0, 0};
  if (outside > kMostOutside * n) {
    const double x = median(xs), y = median(ys);
    std::vector<double> from_middle;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      from_middle.push_back(length(xs[i] - x, ys[i] - y));
    }
    const auto edge = from_middle.begin() + static_cast<std::ptrdiff_t>(0.98 * (n - 1));
    std::nth_element(from_middle.begin(), edge, from_middle.end());
    const Map& m = map;
    report.add(Check::units, place, -1, -1,
               "positions reach " + brief(*far) + " m from the centre of a tank of radius " +
                   brief(options.tank_radius) + " m" +
                   length_hint(options, *far, x + m.origin_x * m.pixel,
                               m.y_sign * y + m.origin_y * m.pixel, *edge, m.pixel));
  } else if (*far < 0.05 * options.tank_radius && n > 100) {
    report.add(Check::units, place, -1, -1,
               "positions stay within " + length_text(*far) +
                   " of the centre of a tank of radius " + brief(options.tank_radius) +
                   " m: are lengths in a larger unit?");
  }
}

/// Degrees show by whole turns of 360.
void check_angles(const Sightings& s, const RecordingOptions& options, Report& report) {
  if (!s.headings || options.calibration.angles == AngleUnit::degrees) return;
  double most = 0;
  const Sighting* where = nullptr;
  for (const Sighting& row : s.rows) {
    if (!(std::fabs(row.theta) > most)) continue;
    most = std::fabs(row.theta), where = &row;
  }
  if (where == nullptr || most <= 2 * kPi + 0.5 || most > 361) return;
  std::unordered_map<std::int64_t, double> last;
  int turns = 0, leaps = 0;
  for (const Sighting& row : s.rows) {
    if (std::isnan(row.theta)) continue;
    const auto [before, first] = last.emplace(row.id, row.theta);
    const double change = std::fabs(row.theta - before->second);
    turns += change > 300 ? 1 : 0, leaps += change > 20 && change <= 300 ? 1 : 0;
    before->second = row.theta;
  }
  if (turns == 0 || leaps > turns) return;
  report.add(Check::units, s.place(*where), where->frame, where->id,
             "headings reach " + brief(most) +
                 " and turn over at 360: if they are in degrees, say angle_unit = \"deg\"");
}

}  // namespace

void to_metres(Sightings& s, const RecordingOptions& options, Report& report) {
  const Map map = map_of(s, options);
  check_angles(s, options, report);
  for (Sighting& row : s.rows) {
    row.x = map.pixel * (row.x - map.origin_x);
    row.y = map.y_sign * map.pixel * (row.y - map.origin_y);
    row.theta *= map.angle;
  }
}

void check_lengths(const Sightings& s, const RecordingOptions& options, Report& report) {
  if (options.in_tank) check_lengths_with(map_of(s, options), s, options, report);
}

}  // namespace lilytank
