// Exact repeats: sightings that have the pose of the one before to the last digit.
//
// Positions have noise, and bodies that move do not stand still for a frame, so an exact repeat of
// a moving body is not a measurement: the tracker held a pose that it had lost, or a frame was
// written twice. But a body that rests, or moves by less than the last digit, repeats its pose as
// well. So a run of repeats is improbable only if the body arrives and leaves by steps that are far
// above the resolution and usual for the recording, and leaves a longer run by more than a usual
// step. How many single repeats chance explains is estimated from the steps that are shorter than
// usual.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "recording/checks.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

/// Runs of more repeats than this are named one by one.
constexpr std::size_t kShort = 3;
/// So many times the resolution is no matter of rounding.
constexpr double kAboveResolution = 6;

/// A row's frame, or its time where there are no frames.
double instant_of(const Sighting& row) {
  return row.frame == kNoFrame ? row.time : static_cast<double>(row.frame);
}

bool same_pose(const Sighting& a, const Sighting& b) {
  const bool turned = a.theta != b.theta && !(std::isnan(a.theta) && std::isnan(b.theta));
  return a.x == b.x && a.y == b.y && !turned;
}

/// Repeats that follow one sighting of a body.
struct Run {
  std::int64_t id = 0;
  std::vector<std::size_t> rows;  ///< the repeats
  bool has_before = false, has_after = false;
  double in_x = 0, in_y = 0;    ///< m, the step that led to the repeated pose
  double out_x = 0, out_y = 0;  ///< m, the step away from it
  bool improbable = false;
  double in() const { return length(in_x, in_y); }
  double out() const { return length(out_x, out_y); }
  bool goes_on() const { return in_x * out_x + in_y * out_y > 0; }
};

class RepeatFinder {
 public:
  RepeatFinder(Sightings& s, Report& report) : s_(&s), report_(&report) {}

  void find() {
    sort();
    zeros();
    collect();
    if (runs_.empty() || steps_.empty()) return;
    measure();
    judge();
    doubled_frames();
    note_frames();
    note_runs();
  }

 private:
  const Sighting& row(std::size_t i) const { return s_->rows[order_[i]]; }

  // By body, then in time.
  void sort() {
    order_.resize(s_->rows.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      const Sighting &p = s_->rows[a], &q = s_->rows[b];
      return p.id != q.id ? p.id < q.id : instant_of(p) < instant_of(q);
    });
  }

  /// Calls act(first, last) for the rows of every body.
  template <class Act>
  void for_each_body(const Act& act) const {
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      while (end < order_.size() && row(end).id == row(begin).id) ++end;
      act(begin, end);
    }
  }

  // A body that is at 0, 0 of the file and elsewhere, but never near it in between, was not seen
  // there.
  void zeros() {
    for_each_body([&](std::size_t begin, std::size_t end) {
      std::vector<std::size_t> found;
      std::vector<double> steps, leaps;
      for (std::size_t i = begin; i < end; ++i) {
        if (row(i).zero) found.push_back(order_[i]);
        if (i == begin) continue;
        const double step = length(row(i).x - row(i - 1).x, row(i).y - row(i - 1).y);
        if (row(i).zero != row(i - 1).zero) leaps.push_back(step);
        if (!row(i).zero && !row(i - 1).zero) steps.push_back(step);
      }
      constexpr double kLeap = 5;  // usual steps
      if (found.size() < 2 || leaps.empty()) return;
      const double least = *std::min_element(leaps.begin(), leaps.end());
      const double usual = steps.empty() ? 0 : median(std::move(steps));
      if (!(least > kLeap * usual) || !(least > report_->rules().least_jump)) return;
      treat(found, "exactly at 0, 0 of the file in " + std::to_string(found.size()) +
                       " sightings, and far from there before and after: not seen");
    });
  }

  void collect() {
    for_each_body([&](std::size_t begin, std::size_t end) {
      std::size_t before = end;  // the last sighting with another pose
      double step_x = kUnknown, step_y = kUnknown;
      for (std::size_t i = begin, next = begin; i < end; i = next) {
        next = i + 1;
        if (row(i).unseen) continue;
        Run run;
        run.id = row(i).id;
        while (next < end && (row(next).unseen || same_pose(row(i), row(next)))) {
          if (!row(next).unseen && instant_of(row(next)) > instant_of(row(next - 1))) {
            run.rows.push_back(order_[next]);
          }
          ++next;
        }
        if (before < end) {
          run.has_before = true;
          run.in_x = row(i).x - row(before).x, run.in_y = row(i).y - row(before).y;
          add_step(run, step_x, step_y);
          step_x = run.in_x, step_y = run.in_y;
        }
        if (next < end) {
          run.has_after = true;
          run.out_x = row(next).x - row(i).x, run.out_y = row(next).y - row(i).y;
        }
        before = i;
        if (!run.rows.empty()) runs_.push_back(std::move(run));
      }
    });
  }

  void add_step(const Run& step, double before_x, double before_y) {
    if (!(step.in() > 0)) return;  // turned at one place
    steps_.push_back(step.in());
    for (const double change : {std::fabs(step.in_x), std::fabs(step.in_y)}) {
      if (change > 0) resolution_ = std::min(resolution_, change);
    }
    if (!std::isnan(before_x)) {
      changes_.push_back(length(step.in_x - before_x, step.in_y - before_y));
    }
  }

  void measure() {
    std::sort(steps_.begin(), steps_.end());
    usual_ = median(steps_);
    // Where even the least changes of steps are far above the resolution, bodies at rest show
    // noise.
    if (!changes_.empty()) {
      const auto low = changes_.begin() + static_cast<std::ptrdiff_t>(changes_.size() / 10);
      std::nth_element(changes_.begin(), low, changes_.end());
      noisy_ = *low > 4 * resolution_;
    }
    // Single repeats that chance explains: the density of short steps times the resolution.
    const double near = std::max(2.5 * resolution_, 0.1 * usual_);
    const auto count = std::upper_bound(steps_.begin(), steps_.end(), near) - steps_.begin();
    expected_ = static_cast<double>(count) * resolution_ / (2 * near);
  }

  /// More than chance explains; p < 0.003 by Chernoff's bound.
  bool more_than_chance(double found) const {
    const double expected = std::max(expected_, 1e-12);
    return found > expected && found * std::log(found / expected) - found + expected > 6;
  }

  void judge() {
    const double step = std::max(kAboveResolution * resolution_, 0.25 * usual_);
    double single = 0;
    for (Run& run : runs_) {
      const std::size_t n = run.rows.size();
      if (!run.has_before || !run.has_after) {
        run.improbable = never_leaves(run);
        continue;
      }
      if (run.in() < step || run.out() < step) continue;
      run.improbable = n > kShort ? run.out() > 3 * usual_ : n > 1 || run.goes_on();
      if (n == 1 && run.improbable) ++single;
    }
    if (!more_than_chance(single)) {
      for (Run& run : runs_) {
        if (run.rows.size() == 1) run.improbable = false;
      }
    }
    follow_bodies();
  }

  // Lost for good, or not yet seen: a body does not stop or start by a usual step and then show no
  // noise.
  bool never_leaves(const Run& run) const {
    constexpr std::size_t kLong = 10;
    const double step = std::max(kAboveResolution * resolution_, 0.5 * usual_);
    return noisy_ && run.rows.size() >= kLong && std::max(run.in(), run.out()) > step;
  }

  // Where most runs of a body are improbable, its tracker repeats poses: so do the other runs.
  void follow_bodies() {
    std::map<std::int64_t, std::pair<std::size_t, std::size_t>> of_body;  // improbable, all
    for (const Run& run : runs_) {
      auto& [improbable, all] = of_body[run.id];
      improbable += run.improbable ? 1 : 0, ++all;
    }
    for (Run& run : runs_) {
      const auto& [improbable, all] = of_body[run.id];
      if (improbable > 0 && 2 * improbable >= all) run.improbable = true;
    }
  }

  // A frame in which everybody repeats, one of them improbably, was written twice: also bodies that
  // rest did not repeat by themselves there.
  void doubled_frames() {
    std::map<double, std::pair<std::size_t, bool>> repeats;  // by instant: how many, any improbable
    std::map<double, std::size_t> seen;
    for (const Run& run : runs_) {
      for (const std::size_t i : run.rows) {
        auto& [count, any] = repeats[instant_of(s_->rows[i])];
        ++count, any = any || run.improbable;
      }
    }
    for (const Sighting& row : s_->rows) {
      const auto found = repeats.find(instant_of(row));
      if (found != repeats.end() && !row.unseen) ++seen[found->first];
    }
    std::set<std::int64_t> bodies;
    for (const Sighting& row : s_->rows) bodies.insert(row.id);
    if (bodies.size() < 2) return;
    for (const auto& [instant, found] : repeats) {
      const bool everybody = found.first == seen[instant] && found.first > 1;
      if (everybody && found.second) doubled_.insert(instant);
    }
  }

  void note_frames() {
    if (doubled_.empty()) return;
    std::vector<std::size_t> rows;
    for (const Run& run : runs_) {
      for (const std::size_t i : run.rows) {
        if (doubled_.contains(instant_of(s_->rows[i]))) rows.push_back(i);
      }
    }
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      return instant_of(s_->rows[a]) < instant_of(s_->rows[b]);
    });
    std::set<double> instants;
    for (const Sighting& row : s_->rows) instants.insert(instant_of(row));
    treat(rows,
          "all bodies repeat the frame before to the last digit in " +
              std::to_string(doubled_.size()) + " of " + std::to_string(instants.size()) +
              " frames" +
              (2 * doubled_.size() + 1 >= instants.size() ? " (every frame is written "
                                                            "twice)"
                                                          : "") +
              list_of(rows),
          true);
  }

  void note_runs() {
    std::map<std::int64_t, std::vector<std::size_t>> short_ones;
    for (const Run& run : runs_) {
      std::vector<std::size_t> rows;
      if (!run.improbable) continue;
      for (const std::size_t i : run.rows) {
        if (!doubled_.contains(instant_of(s_->rows[i]))) rows.push_back(i);
      }
      if (rows.size() > kShort) {
        treat(rows, "holds its pose to the last digit for " + std::to_string(rows.size()) +
                        " frames" + until(rows.back()) +
                        (run.has_after ? ", and is " + length_text(run.out()) + " away then" : ""));
      } else {
        auto& all = short_ones[run.id];
        all.insert(all.end(), rows.begin(), rows.end());
      }
    }
    for (const auto& [id, rows] : short_ones) {
      if (rows.empty()) continue;
      treat(rows, "repeats the pose before to the last digit in " + std::to_string(rows.size()) +
                      (rows.size() == 1 ? " frame" : " frames") + list_of(rows));
    }
  }

  std::string until(std::size_t i) const {
    const Sighting& last = s_->rows[i];
    return last.frame == kNoFrame ? ", up to " + time_text(last.time)
                                  : ", up to frame " + std::to_string(last.frame);
  }

  /// ": frames 3, 8, 12, ...".
  std::string list_of(const std::vector<std::size_t>& rows) const {
    constexpr std::size_t kListed = 8;
    const bool numbered = s_->rows[rows.front()].frame != kNoFrame;
    std::string out;
    std::set<double> listed;
    for (const std::size_t i : rows) {
      const Sighting& row = s_->rows[i];
      if (!listed.insert(instant_of(row)).second) continue;
      if (listed.size() > kListed) return out + ", ...";
      out += out.empty() ? (numbered ? ": frames " : ": at ") : ", ";
      out += numbered ? std::to_string(row.frame) : time_text(row.time);
    }
    return listed.size() == 1 ? "" : out;
  }

  void treat(const std::vector<std::size_t>& rows, const std::string& what,
             bool all_bodies = false) {
    const Sighting& first = s_->rows[rows.front()];
    const Treatment treatment =
        report_->add(Check::repeat, s_->place(first), first.frame == kNoFrame ? -1 : first.frame,
                     all_bodies ? -1 : first.id, what);
    for (const std::size_t i : rows) {
      if (treatment == Treatment::mark) s_->rows[i].unseen = true;
    }
    if (treatment != Treatment::split) return;
    for (const std::size_t i : rows) s_->rows[i].cut = true;
  }

  Sightings* s_;
  Report* report_;
  std::vector<std::size_t> order_;  ///< of the rows
  std::vector<Run> runs_;
  std::vector<double> steps_;     ///< m, between poses that differ, in order of their lengths
  std::vector<double> changes_;   ///< m, from one step to the next
  double resolution_ = HUGE_VAL;  ///< m, the least change of a coordinate
  bool noisy_ = false;            ///< far above the resolution
  double usual_ = 0;              ///< m, the median step
  double expected_ = 0;           ///< single repeats by chance
  std::set<double> doubled_;      ///< instants of frames that were written twice
};

}  // namespace

void check_repeats(Sightings& sightings, Report& report) {
  RepeatFinder(sightings, report).find();
}

}  // namespace lilytank
