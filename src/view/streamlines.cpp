#include "view/streamlines.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace lilytank {
namespace {

// Points of accepted lines in square bins of the separation's size.
class Bins {
 public:
  Bins(double radius, double size)
      : size_(size),
        half_(radius + size),
        side_(static_cast<int>(std::ceil(2 * half_ / size))),
        bins_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  void add(const Vec2& p) { bins_[index(cell(p.x()), cell(p.y()))].push_back(p); }

  bool any_within(const Vec2& p, double distance) const {
    const int cx = cell(p.x()), cy = cell(p.y());
    for (int iy = std::max(0, cy - 1); iy <= std::min(side_ - 1, cy + 1); ++iy) {
      for (int ix = std::max(0, cx - 1); ix <= std::min(side_ - 1, cx + 1); ++ix) {
        for (const Vec2& q : bins_[index(ix, iy)]) {
          if ((p - q).squaredNorm() < distance * distance) return true;
        }
      }
    }
    return false;
  }

 private:
  int cell(double v) const {
    return std::clamp(static_cast<int>((v + half_) / size_), 0, side_ - 1);
  }
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(ix);
  }
  double size_, half_;
  int side_;
  std::vector<std::vector<Vec2>> bins_;
};

class Tracer {
 public:
  Tracer(const FlowField& field, const StreamlineSettings& s)
      : field_(field),
        s_(s),
        still_(1e-3 * peak_speed(field, s.radius)),
        bins_(s.radius, s.separation) {}

  // The line through a seed, or an empty one where there is no room for it.
  Streamline through(const Vec2& seed) {
    if (!inside(seed) || bins_.any_within(seed, s_.separation)) return {};
    const std::vector<Vec2> back = half(seed, -1, {});
    const std::vector<Vec2> ahead = half(seed, 1, back);
    Streamline line;
    line.points.assign(back.rbegin(), back.rend());
    line.points.push_back(seed);
    line.points.insert(line.points.end(), ahead.begin(), ahead.end());
    const double length = s_.step * static_cast<double>(line.points.size() - 1);
    if (length < s_.shortest) return {};
    for (const Vec2& p : line.points) {
      bins_.add(p);
      line.speed.push_back(velocity(p).norm());
    }
    return line;
  }

 private:
  bool inside(const Vec2& p) const { return p.norm() < s_.radius; }
  Vec2 velocity(const Vec2& p) const {
    const FlowSample f = field_.at(p.x(), p.y());
    return {f.mu_x, f.mu_y};
  }
  // One midpoint step along (+1) or against (-1) the flow; false where the water stands.
  bool advance(Vec2& p, double sign) const {
    const Vec2 here = velocity(p);
    if (!(here.norm() > still_)) return false;
    const Vec2 there = velocity(p + 0.5 * s_.step * sign * here.normalized());
    if (!(there.norm() > still_)) return false;
    p += s_.step * sign * there.normalized();
    return true;
  }
  // The line's points on one side of the seed; `other` are those on the other side.
  std::vector<Vec2> half(const Vec2& seed, double sign, const std::vector<Vec2>& other) const {
    constexpr double kTest = 0.55;  // a line may come this near (in separations) before it ends
    const double nearest = kTest * s_.separation;
    // A line that spirals or closes meets itself: compare with its points beyond this many steps.
    const auto gap = static_cast<std::size_t>(3 * s_.separation / s_.step);
    const auto most = static_cast<std::size_t>(4 * s_.radius / s_.step);
    std::vector<Vec2> points;
    Bins own(s_.radius, s_.separation);
    for (std::size_t i = gap; i < other.size(); ++i) own.add(other[i]);
    Vec2 p = seed;
    while (points.size() < most && advance(p, sign) && inside(p)) {
      if (bins_.any_within(p, nearest) || own.any_within(p, nearest)) break;
      points.push_back(p);
      if (points.size() > gap) own.add(points[points.size() - 1 - gap]);
    }
    return points;
  }

  const FlowField& field_;
  StreamlineSettings s_;
  double still_;
  Bins bins_;
};

}  // namespace

double peak_speed(const FlowField& field, double radius) {
  constexpr int kProbes = 120;
  double peak = 0;
  for (int iy = 0; iy < kProbes; ++iy) {
    for (int ix = 0; ix < kProbes; ++ix) {
      const double x = ((ix + 0.5) / kProbes * 2 - 1) * radius;
      const double y = ((iy + 0.5) / kProbes * 2 - 1) * radius;
      if (x * x + y * y > radius * radius) continue;
      const FlowSample f = field.at(x, y);
      peak = std::max(peak, std::sqrt(f.mu_x * f.mu_x + f.mu_y * f.mu_y));
    }
  }
  return peak;
}

std::vector<Streamline> streamlines(const FlowField& field, const StreamlineSettings& settings) {
  std::vector<Streamline> lines;
  if (field.cells() == 0) return lines;
  Tracer tracer(field, settings);
  std::deque<Vec2> seeds;
  const auto add = [&](const Vec2& seed) {
    Streamline line = tracer.through(seed);
    if (line.points.empty()) return;
    // New seeds beside the line, one separation away, so that lines pack evenly.
    for (std::size_t i = 0; i + 1 < line.points.size(); i += 4) {
      const Vec2 way = (line.points[i + 1] - line.points[i]).normalized();
      const Vec2 aside = 1.001 * settings.separation * Vec2(-way.y(), way.x());
      seeds.push_back(line.points[i] + aside);
      seeds.push_back(line.points[i] - aside);
    }
    lines.push_back(std::move(line));
  };
  // Begin at half the radius, then sweep the tank for places that no line reached.
  add(Vec2(0.5 * settings.radius, 0));
  const double pitch = settings.separation;
  const int n = static_cast<int>(settings.radius / pitch);
  for (int iy = -n; iy <= n; ++iy) {
    for (int ix = -n; ix <= n; ++ix) {
      while (!seeds.empty()) {
        const Vec2 seed = seeds.front();
        seeds.pop_front();
        add(seed);
      }
      add(Vec2(ix * pitch, iy * pitch));
    }
  }
  return lines;
}

}  // namespace lilytank
