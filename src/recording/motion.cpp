// Spikes, jumps, swaps, speeds and headings: motion that a body cannot have made.
//
// A step between two sightings is compared with what the steps before and after it let expect. In
// stirred water the difference is a few millimetres at 30 frames per second and grows with the
// frame's length, so its usual size is taken from the recording itself.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lilytank/math.hpp"
#include "recording/checks.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

/// How many times the median of all differences an impossible one is, at least.
constexpr double kTimesUsual = 10;
/// Beyond so many frames nothing is expected.
constexpr int kFarthest = 10;

double wrapped(double angle) {
  return angle - 2 * kPi * std::floor(angle / (2 * kPi) + 0.5);
}

/// Change per frame between two points.
struct Rate {
  double x = 0, y = 0, theta = 0;
};

Rate rate_between(const Point& a, const Point& b) {
  const double frames = b.frame - a.frame;
  return {(b.x - a.x) / frames, (b.y - a.y) / frames, wrapped(b.theta - a.theta) / frames};
}

/// The seen points of a path.
std::vector<Point*> seen_points(Path& path) {
  std::vector<Point*> seen;
  for (Point& point : path.points) {
    if (!point.unseen) seen.push_back(&point);
  }
  return seen;
}

/// One step of a track and the changes per frame before and after it.
struct Step {
  std::int64_t id = 0;
  Point *from = nullptr, *to = nullptr;
  std::optional<Rate> before, after;
  int frames() const { return to->frame - from->frame; }
  bool comparable() const { return (before || after) && frames() <= kFarthest; }
};

Step step_at(std::int64_t id, const std::vector<Point*>& seen, std::size_t i) {
  Step step{id, seen[i - 1], seen[i], std::nullopt, std::nullopt};
  const auto near = [&](std::size_t a, std::size_t b) {
    return seen[b]->frame - seen[a]->frame <= kFarthest && !seen[b]->cut;
  };
  if (i >= 2 && near(i - 2, i - 1)) step.before = rate_between(*seen[i - 2], *seen[i - 1]);
  if (i + 1 < seen.size() && near(i, i + 1)) step.after = rate_between(*seen[i], *seen[i + 1]);
  return step;
}

/// How far `to` is from where `from` should have gone, in m.
double surprise(const Point& from, const Point& to, const Rate& expected) {
  const double frames = to.frame - from.frame;
  return length(to.x - from.x - frames * expected.x, to.y - from.y - frames * expected.y);
}

double turn_surprise(const Point& from, const Point& to, const Rate& expected) {
  return std::fabs(wrapped(to.theta - from.theta - (to.frame - from.frame) * expected.theta));
}

/// The least of what the step before, the one after and their mean let expect: a leap is the one
/// step that agrees with none, while each of its neighbours still agrees with the other one of its
/// own.
template <class Measure>
double least(const Step& step, const Measure& measure) {
  double out = std::numeric_limits<double>::infinity();
  const auto &before = step.before, &after = step.after;
  if (before) out = std::min(out, measure(*step.from, *step.to, *before));
  if (after) out = std::min(out, measure(*step.from, *step.to, *after));
  if (before && after) {
    const Rate mean{(before->x + after->x) / 2, (before->y + after->y) / 2,
                    (before->theta + after->theta) / 2};
    out = std::min(out, measure(*step.from, *step.to, mean));
  }
  return out;
}

class MotionChecks {
 public:
  MotionChecks(std::vector<Path>& paths, const CheckContext& context)
      : paths_(&paths), c_(&context), headings_(context.sightings.headings) {}

  void check() {
    measure();
    for (Path& path : *paths_) spikes(path);
    for (Path& path : *paths_) steps(path);
    std::stable_sort(leaps_.begin(), leaps_.end(),
                     [](const Step& a, const Step& b) { return a.to->frame < b.to->frame; });
    swaps();
    for (std::size_t i = 0; i < leaps_.size(); ++i) {
      if (!swapped_[i]) jump(leaps_[i]);
    }
  }

 private:
  /// The usual difference between a step and its neighbours, per frame.
  void measure() {
    std::vector<double> moves, turns;
    for (Path& path : *paths_) {
      const auto seen = seen_points(path);
      for (std::size_t i = 1; i < seen.size(); ++i) {
        const Step step = step_at(path.id, seen, i);
        if (!step.before || !step.after || step.frames() > 1) continue;
        moves.push_back(least(step, surprise));
        if (headings_) turns.push_back(least(step, turn_surprise));
      }
    }
    const CheckRules& rules = c_->report.rules();
    jump_ = std::max(rules.least_jump, kTimesUsual * median(std::move(moves)));
    turn_ = std::max(rules.least_turn, kTimesUsual * median(std::move(turns)));
  }

  void treat(Treatment treatment, Point& point, Point* after) const {
    if (treatment == Treatment::mark) point.unseen = true;
    if (treatment != Treatment::split) return;
    point.cut = true;
    if (after != nullptr) after->cut = true;
  }

  /// How far a sighting is from the line between those before and after it.
  struct Aside {
    double place = 0, turn = 0;  ///< m, rad
    double score = 0;            ///< the larger of both, in units of what is impossible
    bool back = false;           ///< the neighbours are nearer to each other than to it
  };

  Aside aside(const Point& a, const Point& b, const Point& c) const {
    Aside out;
    if (c.frame - a.frame > kFarthest || b.cut || c.cut) return out;
    const Rate through = rate_between(a, c);
    const double frames = std::max(b.frame - a.frame, c.frame - b.frame);
    out.place = surprise(a, b, through);
    out.score = out.place / (frames * jump_);
    out.back = length(c.x - a.x, c.y - a.y) < out.place;
    if (!headings_) return out;
    out.turn = turn_surprise(a, b, through);
    if (out.turn / (frames * turn_) <= out.score) return out;
    out.score = out.turn / (frames * turn_);
    out.back = std::fabs(wrapped(c.theta - a.theta)) < out.turn / 2;
    out.place = 0;
    return out;
  }

  // There and back: the sightings around one agree with each other and not with it, and it is
  // further off its line than they are off theirs.
  void spikes(Path& path) {
    const auto seen = seen_points(path);
    std::vector<Aside> asides(seen.size());
    for (std::size_t i = 1; i + 1 < seen.size(); ++i) {
      asides[i] = aside(*seen[i - 1], *seen[i], *seen[i + 1]);
    }
    for (std::size_t i = 1; i + 1 < seen.size(); ++i) {
      const Aside& here = asides[i];
      const bool most = here.score >= asides[i - 1].score && here.score > asides[i + 1].score;
      if (here.score <= 1 || !here.back || !most) continue;
      const std::string what =
          here.place > 0
              ? length_text(here.place) + " from the line between the sightings around it"
              : "heading " + brief(here.turn) + " rad off those around it";
      Point& b = *seen[i];
      treat(c_->report.add(Check::spike, c_->place(b), c_->frame(b), path.id, what), b,
            seen[i + 1]);
    }
  }

  void steps(Path& path) {
    const auto seen = seen_points(path);
    for (std::size_t i = 1; i < seen.size(); ++i) {
      if (seen[i]->cut) continue;
      const Step step = step_at(path.id, seen, i);
      if (step.comparable() && least(step, surprise) > step.frames() * jump_) {
        leaps_.push_back(step);
        continue;
      }
      speed(step);
      if (headings_ && step.comparable()) leap_of_heading(step);
    }
  }

  void speed(const Step& step) {
    const double distance = length(step.to->x - step.from->x, step.to->y - step.from->y);
    const double seconds = step.frames() / c_->clock.rate;
    if (distance <= c_->report.rules().fastest * seconds) return;
    treat(c_->report.add(Check::speed, c_->place(*step.to), c_->frame(*step.to), step.id,
                         "moved " + length_text(distance) + " in " + time_text(seconds) + ", " +
                             brief(distance / seconds) + " m/s"),
          *step.to, nullptr);
  }

  void leap_of_heading(const Step& step) {
    const double turned = least(step, turn_surprise);
    if (turned <= step.frames() * turn_) return;
    const double quarters = turned / (kPi / 2);
    const double off = std::fabs(quarters - std::floor(quarters + 0.5)) * (kPi / 2);
    const std::string hint =
        off < 0.2 ? (quarters > 1.5 ? ", about half a turn" : ", about a quarter turn") : "";
    treat(c_->report.add(Check::heading, c_->place(*step.to), c_->frame(*step.to), step.id,
                         "turns by " + brief(turned) + " rad more than before and after" + hint),
          *step.to, nullptr);
  }

  /// Whether a goes on where b was, and b where a was.
  bool exchanged(const Step& a, const Step& b) const {
    if (a.from->frame >= b.to->frame || b.from->frame >= a.to->frame) return false;
    const auto fits = [&](const Step& from, const Step& to) {
      const Step crossed{from.id, from.from, to.to, from.before, to.after};
      return crossed.frames() > 0 && crossed.comparable() &&
             least(crossed, surprise) <= crossed.frames() * jump_;
    };
    return fits(a, b) && fits(b, a);
  }

  void swaps() {
    swapped_.assign(leaps_.size(), false);
    for (std::size_t i = 0; i < leaps_.size(); ++i) {
      for (std::size_t j = i + 1; j < leaps_.size() && !swapped_[i]; ++j) {
        if (leaps_[j].to->frame > leaps_[i].to->frame + kFarthest) break;
        if (swapped_[j] || !exchanged(leaps_[i], leaps_[j])) continue;
        swapped_[i] = swapped_[j] = true;
        note_swap(leaps_[i], leaps_[j]);
        note_swap(leaps_[j], leaps_[i]);
      }
    }
  }

  void note_swap(const Step& step, const Step& other) {
    const double apart = length(step.from->x - other.from->x, step.from->y - other.from->y);
    treat(c_->report.add(Check::swap, c_->place(*step.to), c_->frame(*step.to), step.id,
                         "goes on in the place of id " + std::to_string(other.id) + ", " +
                             length_text(apart) + " away, and that one in its place"),
          *step.to, nullptr);
  }

  void jump(const Step& step) {
    const double away = least(step, surprise);
    treat(c_->report.add(Check::jump, c_->place(*step.to), c_->frame(*step.to), step.id,
                         "leaps " + length_text(away) + " off its way in " +
                             time_text(step.frames() / c_->clock.rate)),
          *step.to, nullptr);
  }

  std::vector<Path>* paths_;
  const CheckContext* c_;
  bool headings_;
  double jump_ = 0, turn_ = 0;  ///< m and rad per frame
  std::vector<Step> leaps_;
  std::vector<bool> swapped_;
};

}  // namespace

void check_motion(std::vector<Path>& paths, const CheckContext& context) {
  MotionChecks(paths, context).check();
}

}  // namespace lilytank
