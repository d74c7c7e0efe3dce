// Pairs of bodies: correlation, nearest neighbours, contacts.
#include <algorithm>
#include <array>
#include <cmath>

#include "lilytank/distributions.hpp"
#include "statistics/median.hpp"
#include "tracks/frames_view.hpp"

namespace lilytank {
namespace {

double distance(const SeenBody& a, const SeenBody& b) {
  const double dx = a.x - b.x, dy = a.y - b.y;
  return std::sqrt(dx * dx + dy * dy);
}

BodySums empty_sums(const SmoothRecording& recording, const FramesView& frames, int bins) {
  BodySums sums;
  sums.bins = bins;
  sums.sum.assign(frames.units() * static_cast<std::size_t>(bins), 0.0);
  sums.weight = sums.sum;
  sums.tracks.assign(bins, static_cast<std::int64_t>(recording.tracks.size()));
  return sums;
}

// Pairs of different bodies, by bin and unit: [unit * bins + bin], and all of a unit's.
struct PairCounts {
  std::vector<double> by_bin, all;
};

void count_pairs(const SeenBody* a, const SeenBody* a_end, const SeenBody* b, const SeenBody* b_end,
                 const Bins& bins, PairCounts& counts) {
  const double reach = bins.high * bins.high;
  for (; a != a_end; ++a) {
    for (const SeenBody* p = b; p != b_end; ++p) {
      if (p->body == a->body) continue;
      ++counts.all[a->unit];
      const double dx = a->x - p->x, dy = a->y - p->y;
      if (dx * dx + dy * dy > reach) continue;
      const int bin = bins.of(std::sqrt(dx * dx + dy * dy));
      if (bin >= 0) ++counts.by_bin[a->unit * bins.count + bin];
    }
  }
}

// Frames from one that is evaluated to the next, for ten a second.
std::size_t stride_of(const SmoothRecording& recording) {
  return static_cast<std::size_t>(std::max(1.0, std::round(recording.rate / 10)));
}

// Calls act(unit, distance to the nearest other body) for frames with two bodies or more.
template <class Act>
void for_each_nearest(const SmoothRecording& recording, const FramesView& frames, const Act& act) {
  std::vector<double> nearest;  // squared
  for (std::size_t f = 0; f < frames.frames(); f += stride_of(recording)) {
    const SeenBody* const first = frames.begin(f);
    const auto seen = static_cast<std::size_t>(frames.end(f) - first);
    if (seen < 2) continue;
    nearest.assign(seen, HUGE_VAL);
    for (std::size_t i = 0; i < seen; ++i) {
      for (std::size_t j = i + 1; j < seen; ++j) {
        const double dx = first[i].x - first[j].x, dy = first[i].y - first[j].y;
        const double square = dx * dx + dy * dy;
        nearest[i] = std::min(nearest[i], square), nearest[j] = std::min(nearest[j], square);
      }
    }
    for (std::size_t i = 0; i < seen; ++i) act(first[i].unit, std::sqrt(nearest[i]));
  }
}

// Gap of two equal squares along the axes of the first.
double gap_along(const SeenBody& a, const SeenBody& b, double side) {
  const double c = std::cos(a.theta), s = std::sin(a.theta), turn = b.theta - a.theta;
  const double x = c * (b.x - a.x) + s * (b.y - a.y), y = c * (b.y - a.y) - s * (b.x - a.x);
  const double reach = 0.5 * side * (1 + std::fabs(std::cos(turn)) + std::fabs(std::sin(turn)));
  return std::max(std::fabs(x), std::fabs(y)) - reach;
}

double gap(const SeenBody& a, const SeenBody& b, const ContactRule& rule) {
  const double apart = distance(a, b);
  // Beyond their corners' reach no axes need to be tested.
  if (!rule.squares || apart > 1.4142135623730951 * rule.size + rule.apart) {
    return apart - rule.size;
  }
  return std::max(gap_along(a, b, rule.size), gap_along(b, a, rule.size));
}

// Frames from one that shows bodies to the next: 1, unless most frames are holes.
std::size_t usual_spacing(const FramesView& frames) {
  std::vector<double> steps;
  std::size_t last = frames.frames();
  for (std::size_t f = 0; f < frames.frames(); ++f) {
    if (frames.begin(f) == frames.end(f)) continue;
    if (last < f) steps.push_back(static_cast<double>(f - last));
    last = f;
  }
  return steps.empty() ? 1 : std::max<std::size_t>(1, static_cast<std::size_t>(median(steps)));
}

// A contact that goes on.
struct Touch {
  bool on = false;
  bool counted = false;             ///< it was seen to begin
  std::size_t since = 0, seen = 0;  ///< frames
};

class ContactFinder {
 public:
  ContactFinder(const SmoothRecording& recording, const ContactRule& rule)
      : rule_(rule),
        frames_(recording),
        spacing_(usual_spacing(frames_)),
        interval_(1 / recording.rate),
        touches_(frames_.bodies() * frames_.bodies()) {
    out_.begun = empty_sums(recording, frames_, 1);
    out_.touching = out_.begun;
  }
  Contacts find() {
    for (std::size_t f = 0; f < frames_.frames(); ++f) look_at(f);
    for (Touch& t : touches_) end(t, t.seen, false);
    return std::move(out_);
  }

 private:
  void look_at(std::size_t f) {
    const SeenBody* const last = frames_.end(f);
    touching_.assign(frames_.bodies(), false);
    for (const SeenBody* a = frames_.begin(f); a != last; ++a) {
      out_.begun.weight[a->unit] += static_cast<double>(spacing_) * interval_;
      out_.touching.weight[a->unit] += 1;
      for (const SeenBody* b = a + 1; b != last; ++b) look_at_pair(f, *a, *b);
    }
    for (const SeenBody* a = frames_.begin(f); a != last; ++a) {
      out_.touching.sum[a->unit] += touching_[a->body];
    }
  }
  void look_at_pair(std::size_t f, const SeenBody& a, const SeenBody& b) {
    const auto [low, high] = std::minmax(a.body, b.body);
    Touch& t = touches_[low * frames_.bodies() + high];
    // One of them was lost for a while: what happened meanwhile is not known.
    const bool known = f > 0 && t.seen + spacing_ >= f && ever_.contains(low, high);
    if (t.on && !known) end(t, t.seen, false);
    const double space = gap(a, b, rule_);
    if (t.on && space > rule_.apart) end(t, f, true);
    if (!t.on && space <= rule_.touching) {
      t.on = true, t.counted = known, t.since = f;
      if (known) ++out_.begun.sum[a.unit], ++out_.begun.sum[b.unit];
    }
    if (t.on) touching_[low] = touching_[high] = true;
    t.seen = f;
    ever_.insert(low, high);
  }
  void end(Touch& t, std::size_t f, bool observed) {
    if (t.on && t.counted) {
      out_.durations.push_back({static_cast<double>(f - t.since) * interval_, observed});
    }
    t.on = false;
  }
  // Pairs that were seen at least once.
  struct Pairs {
    std::vector<bool> met;
    std::size_t n = 0;
    bool contains(std::size_t a, std::size_t b) const { return met[a * n + b]; }
    void insert(std::size_t a, std::size_t b) { met[a * n + b] = true; }
  };
  ContactRule rule_;
  FramesView frames_;
  std::size_t spacing_;
  double interval_;
  std::vector<Touch> touches_;  // [low * bodies + high]
  Pairs ever_{std::vector<bool>(frames_.bodies() * frames_.bodies()), frames_.bodies()};
  std::vector<bool> touching_;
  Contacts out_;
};

}  // namespace

BodySums pair_correlation(const SmoothRecording& recording, const Bins& bins) {
  const FramesView frames(recording);
  BodySums sums = empty_sums(recording, frames, bins.count);
  PairCounts same{sums.sum, std::vector<double>(frames.units(), 0.0)}, other = same;
  // Shifts that are far from each other and from whole turns of each other.
  const std::size_t n = frames.frames();
  constexpr std::array kShifts{0.2137, 0.3819, 0.5393};
  const std::size_t stride = stride_of(recording);
  for (std::size_t f = 0; f < n; f += stride) {
    count_pairs(frames.begin(f), frames.end(f), frames.begin(f), frames.end(f), bins, same);
    const double shift = kShifts[f / stride % kShifts.size()];
    const std::size_t g = (f + static_cast<std::size_t>(shift * static_cast<double>(n))) % n;
    count_pairs(frames.begin(f), frames.end(f), frames.begin(g), frames.end(g), bins, other);
  }
  for (std::size_t i = 0; i < sums.sum.size(); ++i) {
    const std::size_t unit = i / static_cast<std::size_t>(bins.count);
    sums.sum[i] = same.by_bin[i];
    if (other.all[unit] > 0) sums.weight[i] = other.by_bin[i] * same.all[unit] / other.all[unit];
  }
  return sums;
}

BodySums nearest_neighbours(const SmoothRecording& recording, const Bins& bins) {
  const FramesView frames(recording);
  BodySums sums = empty_sums(recording, frames, bins.count);
  std::vector<double> samples(frames.units(), 0.0);
  for_each_nearest(recording, frames, [&](std::size_t unit, double nearest) {
    ++samples[unit];
    const int bin = bins.of(nearest);
    if (bin >= 0) sums.sum[unit * bins.count + bin] += 1 / bins.width();
  });
  for (std::size_t i = 0; i < sums.weight.size(); ++i) sums.weight[i] = samples[i / bins.count];
  return sums;
}

BodySums nearest_distance(const SmoothRecording& recording) {
  const FramesView frames(recording);
  BodySums sums = empty_sums(recording, frames, 1);
  for_each_nearest(recording, frames, [&](std::size_t unit, double nearest) {
    sums.sum[unit] += nearest;
    ++sums.weight[unit];
  });
  return sums;
}

Contacts find_contacts(const SmoothRecording& recording, const ContactRule& rule) {
  return ContactFinder(recording, rule).find();
}

}  // namespace lilytank
