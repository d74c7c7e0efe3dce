#include <algorithm>
#include <cmath>

#include "recording/checks.hpp"

namespace lilytank {
namespace {

/// A track that may go on.
struct Open {
  std::int64_t id = 0;
  std::int64_t frame = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< m, m per frame
};

/// More cannot be distinguished, and would take long.
constexpr std::size_t kMostInFrame = 1000;

class Linker {
 public:
  Linker(Sightings& s, const FrameClock& clock, const RecordingOptions& options, Report& report)
      : s_(&s), clock_(&clock), report_(&report) {
    const CheckRules& rules = report.rules();
    // Two bodies are never nearer than twice this, so one prediction has one body.
    gate_ = std::max(options.body_radius, rules.least_jump);
    longest_gap_ = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::floor(rules.longest_gap * clock.rate)));
  }

  void link() {
    std::vector<Sighting>& rows = s_->rows;
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Sighting& a, const Sighting& b) { return a.frame < b.frame; });
    for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
      while (end < rows.size() && rows[end].frame == rows[begin].frame) ++end;
      frame(begin, end);
    }
    s_->identities = true;
  }

 private:
  struct Pair {
    double distance;
    std::size_t track, row;
  };

  // Nearest pairs first; rows without a track begin one.
  void frame(std::size_t begin, std::size_t end) {
    const std::int64_t now = s_->rows[begin].frame;
    if (end - begin > kMostInFrame) {
      throw InputError(s_->place(s_->rows[begin]),
                       std::to_string(end - begin) +
                           " sightings without identities in one frame: more than " +
                           std::to_string(kMostInFrame));
    }
    std::erase_if(open_, [&](const Open& t) { return now - t.frame > longest_gap_; });
    std::vector<Pair> pairs = candidates(begin, end);
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    const auto of_rows = by_row(pairs, begin, end);
    std::vector<bool> taken(open_.size()), ended(open_.size()), linked(end - begin);
    for (const Pair& pair : pairs) {
      if (taken[pair.track] || linked[pair.row - begin]) continue;
      if (const std::size_t rival = rival_of(pair, of_rows[pair.row - begin], taken);
          rival < open_.size() && competed(pair, rival) != Treatment::keep) {
        ended[pair.track] = ended[rival] = true;
      }
      if (ended[pair.track]) continue;
      taken[pair.track] = linked[pair.row - begin] = true;
      go_on(open_[pair.track], s_->rows[pair.row]);
    }
    std::size_t at = 0;
    std::erase_if(open_, [&](const Open&) { return ended[at++]; });
    for (std::size_t i = begin; i < end; ++i) {
      if (linked[i - begin]) continue;
      Sighting& row = s_->rows[i];
      row.id = next_++;
      open_.push_back({row.id, row.frame, row.x, row.y, 0, 0});
    }
  }

  std::vector<Pair> candidates(std::size_t begin, std::size_t end) const {
    std::vector<Pair> pairs;
    for (std::size_t t = 0; t < open_.size(); ++t) {
      const Open& track = open_[t];
      const auto gap = static_cast<double>(s_->rows[begin].frame - track.frame);
      const double x = track.x + gap * track.vx, y = track.y + gap * track.vy;
      for (std::size_t i = begin; i < end; ++i) {
        const double distance = length(s_->rows[i].x - x, s_->rows[i].y - y);
        if (distance <= gate_) pairs.push_back({distance, t, i});
      }
    }
    return pairs;
  }

  /// The pairs of each row, nearest first.
  static std::vector<std::vector<const Pair*>> by_row(const std::vector<Pair>& pairs,
                                                      std::size_t begin, std::size_t end) {
    std::vector<std::vector<const Pair*>> out(end - begin);
    for (const Pair& pair : pairs) out[pair.row - begin].push_back(&pair);
    return out;
  }

  /// Another track that fits the same row nearly as well.
  std::size_t rival_of(const Pair& pair, const std::vector<const Pair*>& of_row,
                       const std::vector<bool>& taken) const {
    for (const Pair* other : of_row) {
      const bool free = other->track != pair.track && !taken[other->track];
      if (free && other->distance < 2 * pair.distance + 0.2 * gate_) return other->track;
    }
    return open_.size();
  }

  Treatment competed(const Pair& pair, std::size_t rival) const {
    const Sighting& row = s_->rows[pair.row];
    Treatment treatment = report_->rules()[Check::link];
    if (treatment == Treatment::mark) treatment = Treatment::split;
    report_->add(Check::link, treatment, s_->place(row), clock_->number(row.frame),
                 open_[pair.track].id,
                 "goes on where track " + std::to_string(open_[rival].id) + " may as well");
    return treatment;
  }

  static void go_on(Open& track, Sighting& row) {
    row.id = track.id;
    const auto frames = static_cast<double>(row.frame - track.frame);
    track.vx = (row.x - track.x) / frames, track.vy = (row.y - track.y) / frames;
    track.x = row.x, track.y = row.y, track.frame = row.frame;
  }

  Sightings* s_;
  const FrameClock* clock_;
  Report* report_;
  double gate_ = 0;
  std::int64_t longest_gap_ = 1;
  std::vector<Open> open_;
  std::int64_t next_ = 0;
};

}  // namespace

void link(Sightings& sightings, const FrameClock& clock, const RecordingOptions& options,
          Report& report) {
  Linker(sightings, clock, options, report).link();
}

}  // namespace lilytank
