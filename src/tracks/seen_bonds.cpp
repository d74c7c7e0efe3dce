#include "tracks/seen_bonds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "lilytank/math.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

// A bond begins within the first limits and ends beyond the second: 2 and 3.5 mm of a side of 30
// mm. Tracking noise of 0.3 mm and 0.01 rad moves a neighbour's centre by 0.5 mm.
constexpr double kBeginsWithin = 1.0 / 15, kEndsBeyond = 3.5 / 30;  // sides
constexpr double kBeginsTurned = 0.12, kEndsTurned = 0.2;           // rad
constexpr double kLasts = 0.3;   // s: encounters of free modules are seldom so still for so long
constexpr double kUnseen = 0.5;  // s without a sighting after which nothing is known of a bond
constexpr int kJustBefore = 2;   // frames, one of them unseen
constexpr double kLeaves = 1.5;  // reaches beyond which a meeting is over

struct Sighting {
  bool seen = false;
  double x = 0, y = 0, theta = 0;
};

// How far two squares are from face to face.
struct Misalignment {
  double offset = 0, turn = 0;  // sides, rad
  bool within(double offset_limit, double turn_limit) const {
    return offset < offset_limit && turn < turn_limit;
  }
};

Misalignment misalignment(const Sighting& a, const Sighting& b, double side) {
  const Vec2 at = unrotate(rotation(a.theta), {b.x - a.x, b.y - a.y});
  const double ahead = std::max(std::fabs(at.x()), std::fabs(at.y()));
  const double aside = std::min(std::fabs(at.x()), std::fabs(at.y()));
  const double turn = b.theta - a.theta;
  return {std::hypot(ahead - side, aside) / side,
          std::fabs(turn - kPi / 2 * std::round(turn / (kPi / 2)))};
}

// The modules of a recording, by number, frame after frame.
class Frames {
 public:
  explicit Frames(const Recording& recording) : recording_(recording) {
    std::map<std::int64_t, int> numbers;
    for (const Track& t : recording.tracks) numbers.emplace(t.id, 0);
    for (auto& [id, number] : numbers) number = modules_++, ids_.push_back(id);
    for (const Track& t : recording.tracks) number_.push_back(numbers.at(t.id));
    now_.resize(static_cast<std::size_t>(modules_));
  }

  int modules() const { return modules_; }
  std::int64_t id(int number) const { return ids_[static_cast<std::size_t>(number)]; }

  /// Calls `look(a, b, frame, at, other)` for every pair in every frame.
  template <class Look>
  void for_pairs(const Look& look) {
    for (int frame = 0; frame < recording_.frames; ++frame) {
      see(frame);
      for (int a = 0; a < modules_; ++a) {
        for (int b = a + 1; b < modules_; ++b) {
          look(a, b, frame, now_[static_cast<std::size_t>(a)], now_[static_cast<std::size_t>(b)]);
        }
      }
    }
  }

 private:
  void see(int frame) {
    std::fill(now_.begin(), now_.end(), Sighting{});
    for (std::size_t k = 0; k < recording_.tracks.size(); ++k) {
      const Track& t = recording_.tracks[k];
      if (frame < t.first || frame > t.last()) continue;
      const auto i = static_cast<std::size_t>(frame - t.first);
      if (std::isnan(t.x[i])) continue;
      now_[static_cast<std::size_t>(number_[k])] = {true, t.x[i], t.y[i], t.theta[i]};
    }
  }

  const Recording& recording_;
  int modules_ = 0;
  std::vector<std::int64_t> ids_;  // by number
  std::vector<int> number_;        // of each track
  std::vector<Sighting> now_;
};

bool far_apart(const Sighting& a, const Sighting& b, double side) {
  return std::fabs(a.x - b.x) + std::fabs(a.y - b.y) > 2 * side;
}

// A pair's bond so far.
struct Candidate {
  bool open = false;
  int begin = 0, known = -1, last = 0;  // known: -1 until it has lasted
  double before = kUndefined;           // sides, their offset in the frame before `begin`
  double offset = kUndefined;           // likewise, in frame `looked`
  int looked = 0;
};

class Watch {
 public:
  Watch(const Recording& recording, double side)
      : recording_(recording),
        side_(side),
        lasts_(std::max(2, static_cast<int>(std::lround(kLasts * recording.rate)))),
        unseen_(static_cast<int>(std::lround(kUnseen * recording.rate))),
        frames_(recording),
        modules_(frames_.modules()) {
    const auto n = static_cast<std::size_t>(modules_);
    pairs_.resize(n * n);
  }

  std::vector<SeenBond> run() {
    frames_.for_pairs([this](int a, int b, int frame, const Sighting& at, const Sighting& other) {
      follow(a, b, frame, at, other);
    });
    for (int a = 0; a < modules_; ++a) {
      for (int b = a + 1; b < modules_; ++b) close(a, b, recording_.frames, false);
    }
    std::sort(bonds_.begin(), bonds_.end(), [](const SeenBond& p, const SeenBond& q) {
      return std::tie(p.begin, p.a, p.b) < std::tie(q.begin, q.a, q.b);
    });
    return std::move(bonds_);
  }

 private:
  Candidate& pair(int a, int b) { return pairs_[static_cast<std::size_t>(a * modules_ + b)]; }

  void follow(int a, int b, int frame, const Sighting& at, const Sighting& other) {
    Candidate& bond = pair(a, b);
    if (!at.seen || !other.seen) {
      if (bond.open && frame - bond.last > unseen_) close(a, b, frame, false);
      return;
    }
    const bool known = bond.open && bond.known >= 0;
    if (!bond.open && far_apart(at, other, side_)) return;
    const Misalignment off = misalignment(at, other, side_);
    const bool holds =
        known ? off.within(kEndsBeyond, kEndsTurned) : off.within(kBeginsWithin, kBeginsTurned);
    const double before = frame - bond.looked <= kJustBefore ? bond.offset : kUndefined;
    bond.offset = off.offset, bond.looked = frame;
    if (!holds) return close(a, b, frame, true);
    if (!bond.open) {
      bond.open = true, bond.begin = frame, bond.known = -1, bond.before = before;
    }
    bond.last = frame;
    if (bond.known < 0 && frame - bond.begin >= lasts_) bond.known = frame;
  }

  void close(int a, int b, int frame, bool parted) {
    Candidate& bond = pair(a, b);
    if (bond.open && bond.known >= 0) {
      bonds_.push_back({frames_.id(a), frames_.id(b), bond.begin, bond.known,
                        parted ? frame : bond.last + 1, parted, side_ * bond.before});
    }
    bond.open = false;
  }

  const Recording& recording_;
  double side_;
  int lasts_, unseen_;
  Frames frames_;
  int modules_;
  std::vector<Candidate> pairs_;
  std::vector<SeenBond> bonds_;
};

}  // namespace

std::vector<SeenBond> seen_bonds(const Recording& recording, double side) {
  if (!recording.has_heading()) return {};
  return Watch(recording, side).run();
}

int meetings(const Recording& recording, double side, double reach, double angle) {
  if (!recording.has_heading()) return 0;
  Frames frames(recording);
  const auto n = static_cast<std::size_t>(frames.modules());
  std::vector<char> near(n * n, 0);
  int count = 0;
  frames.for_pairs([&](int a, int b, int frame, const Sighting& at, const Sighting& other) {
    if (!at.seen || !other.seen) return;
    char& met = near[static_cast<std::size_t>(a) * n + static_cast<std::size_t>(b)];
    if (far_apart(at, other, side)) {
      met = 0;
      return;
    }
    const Misalignment off = misalignment(at, other, side);
    if (met == 0 && off.within(reach / side, angle)) {
      met = 1, count += frame > 0 ? 1 : 0;
    } else if (met != 0 && !off.within(kLeaves * reach / side, kLeaves * angle)) {
      met = 0;
    }
  });
  return count;
}

}  // namespace lilytank
