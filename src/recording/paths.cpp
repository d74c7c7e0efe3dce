#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "recording/checks.hpp"

namespace lilytank {
namespace {

/// Rows that say the same body is at two places in one frame.
void take_out_duplicates(Path& path, const CheckContext& context) {
  std::vector<Point> once;
  for (const Point& point : path.points) {
    if (once.empty() || once.back().frame != point.frame) {
      once.push_back(point);
      continue;
    }
    Point& first = once.back();
    const double apart = length(point.x - first.x, point.y - first.y);
    const Treatment treatment = context.report.add(
        Check::duplicate, context.place(point), context.frame(point), path.id,
        "seen before in this frame, in line " + std::to_string(context.place(first).line) + ", " +
            length_text(apart) + " away");
    if (treatment != Treatment::keep) first.unseen = true;
    if (treatment == Treatment::split) first.cut = true;
  }
  path.points = std::move(once);
}

/// A sighting without the heading that others have counts as none: a track's places and headings
/// have the same holes.
void take_out_without_heading(Path& path, const CheckContext& context) {
  auto& points = path.points;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end + 1) {
    for (end = begin; end < points.size() && std::isnan(points[end].theta); ++end) {
      points[end].unseen = true;
    }
    if (end == begin) continue;
    const std::int64_t last = context.frame(points[end - 1]);
    context.report.add(Check::heading, Treatment::mark, context.place(points[begin]),
                       context.frame(points[begin]), path.id,
                       end - begin == 1
                           ? "seen without a heading"
                           : "seen without headings up to frame " + std::to_string(last));
  }
}

/// Builds the tracks of one path.
class TrackMaker {
 public:
  TrackMaker(const Path& path, const CheckContext& context, std::vector<Track>& out)
      : path_(&path), out_(&out), headings_(context.sightings.headings) {
    const CheckRules& rules = context.report.rules();
    const double frames = rules.longest_gap * context.clock.rate + 1e-9;
    const Treatment gaps = rules[Check::gap];
    longest_gap_ = gaps == Treatment::split  ? 0
                   : gaps == Treatment::keep ? 1e4  // bounds the memory of a few wrong frames
                                             : std::floor(frames);
  }

  void make() {
    bool cut = true;
    for (const Point& point : path_->points) {
      cut = cut || point.cut;
      if (point.unseen) continue;
      if (!cut) cut = point.frame - out_->back().last() - 1 > longest_gap_;
      if (cut) begin(point);
      add(point);
      cut = false;
    }
  }

 private:
  void begin(const Point& point) {
    out_->emplace_back();
    out_->back().id = path_->id;
    out_->back().first = point.frame;
    turned_ = 0;
  }

  void add(const Point& point) {
    Track& track = out_->back();
    const auto size = static_cast<std::size_t>(point.frame - track.first);
    track.x.resize(size, kUnknown), track.x.push_back(point.x);
    track.y.resize(size, kUnknown), track.y.push_back(point.y);
    if (!headings_) return;
    // Whole turns are added so that it is as near as can be to the last one.
    if (!track.theta.empty()) {
      turned_ -= 2 * kPi * std::floor((point.theta - last_) / (2 * kPi) + 0.5);
    }
    last_ = point.theta;
    track.theta.resize(size, kUnknown), track.theta.push_back(point.theta + turned_);
  }

  const Path* path_;
  std::vector<Track>* out_;
  bool headings_;
  double longest_gap_ = 0, turned_ = 0, last_ = 0;
};

}  // namespace

std::vector<Path> make_paths(const Sightings& s, const FrameClock& clock, Report& report) {
  std::vector<Path> paths;
  std::unordered_map<std::int64_t, std::size_t> index;
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    const Sighting& row = s.rows[i];
    const auto [found, added] = index.emplace(row.id, paths.size());
    if (added) paths.push_back({row.id, {}});
    Point point{static_cast<int>(row.frame), static_cast<std::int32_t>(i), row.x, row.y, row.theta};
    point.unseen = row.unseen, point.cut = row.cut;
    paths[found->second].points.push_back(point);
  }
  std::sort(paths.begin(), paths.end(), [](const Path& a, const Path& b) { return a.id < b.id; });
  const RecordingOptions none;
  const CheckContext context{s, clock, none, report};
  const auto by_frame = [](const Point& a, const Point& b) { return a.frame < b.frame; };
  for (Path& path : paths) {
    if (!std::is_sorted(path.points.begin(), path.points.end(), by_frame)) {
      std::stable_sort(path.points.begin(), path.points.end(), by_frame);
    }
    take_out_duplicates(path, context);
    if (s.headings) take_out_without_heading(path, context);
  }
  return paths;
}

void check_gaps(const std::vector<Path>& paths, const CheckContext& c) {
  std::vector<bool> any(static_cast<std::size_t>(c.clock.frames));
  for (const Path& path : paths) {
    for (const Point& point : path.points) any[point.frame] = true;
  }
  std::vector<int> before(any.size() + 1);  // frames with something, of those before
  for (std::size_t f = 0; f < any.size(); ++f) before[f + 1] = before[f] + (any[f] ? 1 : 0);
  const auto note = [&](const SourcePlace& place, int frame, int count, std::int64_t id) {
    const double seconds = count / c.clock.rate;
    const Treatment rule = c.report.rules()[Check::gap];
    const bool cut = rule == Treatment::mark && seconds > c.report.rules().longest_gap;
    c.report.add(Check::gap, cut ? Treatment::split : rule, place, c.clock.number(frame), id,
                 std::string(id < 0 ? "nothing" : "not") + " seen in " + std::to_string(count) +
                     (count == 1 ? " frame" : " frames, " + brief(seconds) + " s"));
  };
  const SourcePlace file{c.sightings.files.front(), 0, 0};
  for (std::size_t f = 0, end = 0; f < any.size(); f = end + 1) {
    end = f;
    while (end < any.size() && !any[end]) ++end;
    if (end > f) note(file, static_cast<int>(f), static_cast<int>(end - f), -1);
  }
  for (const Path& path : paths) {
    for (std::size_t i = 1; i < path.points.size(); ++i) {
      const int from = path.points[i - 1].frame + 1, to = path.points[i].frame;
      const int unseen = before[to] - before[from];
      if (unseen > 0) note(c.place(path.points[i]), from, to - from, path.id);
    }
  }
}

void check_outside(std::vector<Path>& paths, const CheckContext& c) {
  const CheckRules& rules = c.report.rules();
  const double limit = c.options.tank_radius - c.options.body_radius + rules.beyond_tank;
  for (Path& path : paths) {
    auto& points = path.points;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end + 1) {
      double most = 0;
      for (end = begin; end < points.size(); ++end) {
        const double r = length(points[end].x, points[end].y);
        if (r <= limit) break;
        most = std::max(most, r);
      }
      if (end == begin) continue;
      const std::int64_t last = c.frame(points[end - 1]);
      const std::string until =
          end - begin > 1 ? " up to frame " + std::to_string(last) + ", at most" : "";
      const Treatment treatment =
          c.report.add(Check::outside, c.place(points[begin]), c.frame(points[begin]), path.id,
                       "centre" + until + " " + length_text(most - limit + rules.beyond_tank) +
                           " nearer to the wall than its body allows, " + length_text(most) +
                           " from the middle");
      if (treatment == Treatment::mark) {
        for (std::size_t i = begin; i < end; ++i) points[i].unseen = true;
      } else if (treatment == Treatment::split) {
        points[begin].cut = true;
        if (end < points.size()) points[end].cut = true;
      }
    }
  }
}

std::vector<Track> make_tracks(const std::vector<Path>& paths, const CheckContext& context) {
  std::vector<Track> tracks;
  for (const Path& path : paths) TrackMaker(path, context, tracks).make();
  return tracks;
}

}  // namespace lilytank
