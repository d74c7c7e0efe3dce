#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "recording/checks.hpp"
#include "recording/column_names.hpp"
#include "statistics/median.hpp"

namespace lilytank {
namespace {

constexpr double kMostFrames = 2e9;

/// One instant of the file.
struct Instant {
  std::int64_t frame;
  double time;
  std::size_t row;  ///< the first at it
};

class ClockFinder {
 public:
  ClockFinder(Sightings& s, const RecordingOptions& options, Report& report)
      : s_(&s), options_(&options), report_(&report), file_{s.files.front(), 0, 0} {
    for (const Sighting& row : s.rows) {
      has_frames_ = has_frames_ && row.frame != kNoFrame;
      has_times_ = has_times_ && !std::isnan(row.time);
    }
  }

  FrameClock find() {
    if (!has_times_ && options_->rate == 0) {
      throw InputError(
          file_, "there are no times in it: give rate, the frames per second" +
                     (s_->unused.empty() ? "" : "; columns not used: " + short_list(s_->unused)));
    }
    if (has_times_) refuse_whole_seconds();
    if (!has_frames_) {
      collect(false);
      number_frames();
    } else {
      collect(true);
    }
    if (instants_.empty()) {
      throw InputError(file_, "the checks excluded all of its rows");
    }
    clock_.first = instants_.front().frame;
    take_step();
    check_span();
    clock_.frames = static_cast<int>(instants_.back().frame) + 1;
    fit();
    if (has_times_) check_unit();
    if (has_times_ && !report_->refused()) check();
    return clock_;
  }

 private:
  /// Each frame, or each time, once and in order.
  void collect(bool by_frame) {
    const auto before = [by_frame](const Instant& a, const Instant& b) {
      return by_frame ? a.frame < b.frame : a.time < b.time;
    };
    for (std::size_t i = 0; i < s_->rows.size(); ++i) {
      const Sighting& row = s_->rows[i];
      if (row.unseen) continue;
      const Instant instant{row.frame, row.time, i};
      if (!instants_.empty() && !before(instants_.back(), instant) &&
          !before(instant, instants_.back())) {
        continue;
      }
      instants_.push_back(instant);
    }
    std::stable_sort(instants_.begin(), instants_.end(), before);
    const auto same = [&](const Instant& a, const Instant& b) { return !before(a, b); };
    instants_.erase(std::unique(instants_.begin(), instants_.end(), same), instants_.end());
  }

  // Times that are rounded to seconds do not determine a higher frame rate.
  void refuse_whole_seconds() const {
    const double unit = options_->time_unit.value_or(1);
    std::set<double> times;
    std::set<std::pair<std::int64_t, double>> sightings;
    for (const Sighting& row : s_->rows) {
      const double count = row.time / unit;
      if (std::fabs(count - std::round(count)) > 1e-9 * std::max(1.0, std::fabs(count))) return;
      times.insert(row.time);
      sightings.emplace(has_frames_ ? row.frame : row.id, row.time);
    }
    constexpr double kShared = 1.5;  // frames, or sightings of a body, at one time
    const std::string what =
        unit == 1 ? "times are whole seconds" : "times are whole numbers of time_unit";
    const auto n = static_cast<double>(times.size());
    if (has_frames_ && static_cast<double>(sightings.size()) > kShared * n) {
      throw InputError(file_, what + ", and " + brief(static_cast<double>(sightings.size()) / n) +
                                  " frames share one: say columns.time = \"-\" and rate, the "
                                  "frames per second");
    }
    const auto rows = static_cast<double>(s_->rows.size());
    if (has_frames_ || !s_->identities || rows < kShared * static_cast<double>(sightings.size())) {
      return;
    }
    throw InputError(file_, what + ", and a body is seen " +
                                brief(rows / static_cast<double>(sightings.size())) +
                                " times in one: the table needs a column of frame numbers");
  }

  // Only times: the usual distance of two is a frame; then each time has the nearest frame.
  void number_frames() {
    double rate = options_->rate;
    if (rate == 0) {
      std::vector<double> steps;
      for (std::size_t i = 1; i < instants_.size(); ++i) {
        steps.push_back(instants_[i].time - instants_[i - 1].time);
      }
      if (steps.empty()) throw InputError(file_, "there is a single time in it: give rate");
      rate = 1 / median(steps);
    }
    std::int64_t frame = 0;
    for (std::size_t i = 0; i < instants_.size(); ++i) {
      if (i > 0) {
        const double step = (instants_[i].time - instants_[i - 1].time) * rate;
        if (!(step < kMostFrames)) {
          throw InputError(s_->place(s_->rows[instants_[i].row]),
                           "the time " + brief(instants_[i].time) + " s is far from all others");
        }
        // A time less than half a frame after another is a second one in the same frame.
        frame += static_cast<std::int64_t>(std::floor(step + 0.5));
      }
      instants_[i].frame = frame;
    }
    std::unordered_map<double, std::int64_t> frames;
    for (const Instant& instant : instants_) frames.emplace(instant.time, instant.frame);
    std::erase_if(s_->rows, [&](const Sighting& row) { return !frames.contains(row.time); });
    for (Sighting& row : s_->rows) row.frame = frames.at(row.time);
  }

  // Frames are counted from the first one by the greatest step that all of them have in common.
  void take_step() {
    if (instants_.size() > 1 && instants_.back().frame == clock_.first) {
      throw InputError(
          file_, "its " + std::to_string(instants_.size()) + " times lie within one frame" +
                     (options_->rate > 0 ? " at " + brief(options_->rate) + " frames/s" : "") +
                     ": check rate and time_unit");
    }
    if (instants_.size() > 2) {
      std::int64_t step = 0;
      for (const Instant& i : instants_) step = std::gcd(step, i.frame - clock_.first);
      clock_.step = step;
    }
    for (Instant& i : instants_) i.frame = (i.frame - clock_.first) / clock_.step;
    std::erase_if(s_->rows, [&](const Sighting& row) {
      const std::int64_t frames = row.frame - clock_.first;
      return row.unseen && (frames < 0 || frames % clock_.step != 0 ||
                            frames / clock_.step > instants_.back().frame);
    });
    for (Sighting& row : s_->rows) row.frame = (row.frame - clock_.first) / clock_.step;
    find_usual_step();
  }

  // Nearly all sightings follow the last one of their body after the same number of frames, but the
  // frames have no step in common: bodies in turns, or a single frame between the others.
  void find_usual_step() {
    if (clock_.step > 1 || !s_->identities) return;
    constexpr double kUsual = 0.9;
    constexpr std::size_t kFewest = 20;
    std::unordered_map<std::int64_t, std::int64_t> last;
    std::map<std::int64_t, std::size_t> steps;
    std::size_t count = 0;
    for (const Sighting& row : s_->rows) {
      const auto [before, first] = last.emplace(row.id, row.frame);
      if (!first && row.frame > before->second) ++steps[row.frame - before->second], ++count;
      before->second = row.frame;
    }
    if (count < kFewest) return;
    for (const auto& [step, times] : steps) {
      if (step == 1 || static_cast<double>(times) < kUsual * static_cast<double>(count)) continue;
      report_->add(Check::gap, Treatment::keep, file_, -1, -1,
                   "most sightings are " + std::to_string(step) +
                       " frames after the last one of their body, but frame numbers have no step "
                       "in common: frames are counted one by one, most are holes of the tracks, "
                       "and contacts "
                       "of bodies that are seen in turns are not found");
    }
  }

  void check_span() const {
    const auto span = static_cast<double>(instants_.back().frame) + 1;
    const auto seen = static_cast<double>(instants_.size());
    if (span <= kMostFrames && span <= 1e6 + 20 * seen) return;
    throw InputError(file_, "frames run from " + std::to_string(clock_.first) + " to " +
                                std::to_string(clock_.number(instants_.back().frame)) +
                                ", but only " + std::to_string(instants_.size()) +
                                " of them hold anything: are frame numbers or times right?");
  }

  void fit() {
    clock_.rate = options_->rate / static_cast<double>(clock_.step);
    if (!has_times_) {
      clock_.start = static_cast<double>(clock_.first) / options_->rate;
      return;
    }
    if (clock_.rate == 0) clock_.rate = likely_rate();
    clock_.start = start_for(clock_.rate);
  }

  // Of the slopes over short and long spans, the one that puts most frames at their times: long
  // ones do not mind rounded times, short ones do not mind frames that were lost once.
  double likely_rate() const {
    const std::size_t n = instants_.size();
    double best = 0;
    std::size_t most = 0;
    for (const std::size_t span : {(n + 1) / 2, n / 8, std::size_t{20}, std::size_t{1}}) {
      const double rate = span > 0 && span < n ? 1 / median_period(span) : 0;
      if (!(rate > 0)) continue;
      const std::size_t fitting = count_fitting(rate, report_->rules().clock_error);
      if (fitting > most) best = rate, most = fitting;
    }
    if (best == 0) {
      throw InputError(file_, n == 1 ? "there is a single frame in it: give rate"
                                     : "times do not rise with frames");
    }
    // Times are written with few digits: 29.9998 is 30 where that explains them as well.
    constexpr double kRounding = 0.02;  // frames
    const double whole = std::floor(best + 0.5);
    const bool near = whole >= 1 && std::fabs(whole - best) <= 0.01 * whole;
    return near && count_fitting(whole, kRounding) >= most ? whole : best;
  }

  double median_period(std::size_t span) const {
    std::vector<double> periods;
    for (std::size_t i = 0; i + span < instants_.size(); ++i) {
      const Instant &a = instants_[i], &b = instants_[i + span];
      periods.push_back((b.time - a.time) / static_cast<double>(b.frame - a.frame));
    }
    return median(periods);
  }

  std::size_t count_fitting(double rate, double tolerance) const {
    const double start = start_for(rate);
    return static_cast<std::size_t>(
        std::count_if(instants_.begin(), instants_.end(), [&](const Instant& i) {
          return std::fabs(i.time - start - offset(i, rate)) * rate < tolerance;
        }));
  }

  double start_for(double rate) const {
    std::vector<double> starts;
    for (const Instant& i : instants_) starts.push_back(i.time - offset(i, rate));
    return median(starts);
  }
  double offset(const Instant& instant, double rate) const {
    return static_cast<double>(instant.frame) / rate;
  }

  // Nobody tracks what floats in a tank by a frame in more than two seconds, or thousands of frames
  // a second. Where the user gave the unit of the times, or the rate, it is believed.
  void check_unit() {
    constexpr double kSlowest = 0.5, kFastest = 1000, kUsual = 30;  // frames/s
    const bool given = options_->rate > 0 || options_->time_unit;
    const bool dates = s_->times.dated();
    const bool usual = clock_.rate >= kSlowest && clock_.rate <= kFastest;
    if (given || dates || !options_->in_tank || usual) return;
    std::string hint;
    double least = HUGE_VAL;
    for (const auto& [scale, name] :
         {std::pair{1e-3, "ms"}, {1e-6, "us"}, {60.0, "min"}, {3600.0, "h"}, {86400.0, "d"}}) {
      const double rate = clock_.rate / scale, off = std::fabs(std::log(rate / kUsual));
      if (rate < kSlowest || rate > kFastest || off >= least) continue;
      least = off;
      hint = "; if times are in " + std::string(name) + ", say time_unit = \"1 " + name + "\"";
    }
    report_->add(Check::units, file_, -1, -1,
                 "frames are " + time_text(1 / clock_.rate) + " apart" + hint +
                     "; if that is so, say time_unit = \"1 s\"");
  }

  double error(const Sighting& row) const {
    return (row.time - clock_.start) * clock_.rate - static_cast<double>(row.frame);
  }

  // Neighbouring frames that are off are one finding.
  void check() {
    const double most = report_->rules().clock_error;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < s_->rows.size(); ++i) {
      if (std::fabs(error(s_->rows[i])) > most) rows.push_back(i);
    }
    if (rows.empty()) return;
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      return s_->rows[a].frame < s_->rows[b].frame;
    });
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
      double worst = 0;
      for (end = begin; end < rows.size(); ++end) {
        const Sighting& row = s_->rows[rows[end]];
        if (end > begin && row.frame > s_->rows[rows[end - 1]].frame + 1) break;
        if (std::fabs(error(row)) > std::fabs(worst)) worst = error(row);
      }
      note(rows[begin], rows[end - 1], worst);
    }
    if (report_->rules()[Check::clock] == Treatment::mark) {
      for (const std::size_t i : rows) s_->rows[i].unseen = true;
    }
  }

  void note(std::size_t first, std::size_t last, double worst) {
    const Sighting& a = s_->rows[first];
    const std::int64_t from = a.frame, to = s_->rows[last].frame;
    const std::string until =
        to > from ? " up to frame " + std::to_string(clock_.number(to)) + ", at most" : "";
    const Treatment treatment = report_->add(
        Check::clock, s_->place(a), clock_.number(from), -1,
        "taken" + until + " " + brief(std::fabs(worst)) + " frames (" +
            time_text(std::fabs(worst) / clock_.rate) + ") " + (worst > 0 ? "late" : "early") +
            " on a clock of " + brief(clock_.rate) + " frames/s");
    if (treatment != Treatment::split) return;
    for (Sighting& row : s_->rows) {
      row.cut = row.cut || row.frame == from || row.frame == to + 1;
    }
  }

  Sightings* s_;
  const RecordingOptions* options_;
  Report* report_;
  SourcePlace file_;
  bool has_frames_ = true, has_times_ = true;
  std::vector<Instant> instants_;
  FrameClock clock_;
};

}  // namespace

FrameClock find_clock(Sightings& sightings, const RecordingOptions& options, Report& report) {
  return ClockFinder(sightings, options, report).find();
}

}  // namespace lilytank
