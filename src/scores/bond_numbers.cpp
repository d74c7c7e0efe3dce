#include "scores/bond_numbers.hpp"

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "lilytank/math.hpp"
#include "text/number.hpp"
#include "tracks/seen_bonds.hpp"
#include "tracks/sets.hpp"

namespace lilytank {
namespace {

// s: a bond that parts within these times of its begin
constexpr std::array<double, 5> kTimes{1, 3, 8, 20, 60};
constexpr int kSizes = 4;               // of assemblies: 2, 3, 4, 5 and more
constexpr double kAgain = 2;            // s: a pair that parted latches again within this time
constexpr double kFarBefore = 2.5;      // reaches: farther off, a module was not seen for a while
constexpr int kSettling = 2;            // frames at a bond's begin and end
constexpr double kLeastScatter = 0.01;  // of squared distances, in radii

// A rate per s, by its logarithm: half an event is there before any data.
double log_rate(double events, double seconds) {
  return std::log((events + 0.5) / (seconds + 1));
}

double share(double part, double all) {
  return (part + 0.5) / (all + 1);
}

// Bonds that a camera sees.
class Geometry {
 public:
  explicit Geometry(const Model& model)
      : radius_(model.tank.radius),
        side_(model.module.side),
        reach_(model.control.capture_distance),
        angle_(model.control.capture_angle) {}

  void add(const Recording& r) {
    const std::vector<SeenBond> bonds = seen_bonds(r, side_);
    met_ += meetings(r, side_, reach_, angle_);
    for (const Track& t : r.tracks) module_time_ += static_cast<double>(t.x.size()) / r.rate;
    std::map<std::pair<std::int64_t, std::int64_t>, int> parted;
    for (const SeenBond& bond : bonds) {
      const double lasted = (bond.end - bond.begin) / r.rate;
      if (bond.before < kFarBefore * reach_) before_ += bond.before, known_before_ += 1;
      begun_ += bond.begin > 0 ? 1 : 0, time_ += lasted, parted_ += bond.parted ? 1 : 0;
      const auto before = parted.find({bond.a, bond.b});
      if (before != parted.end()) {
        again_ += bond.begin - before->second < kAgain * r.rate ? 1 : 0;
      }
      if (bond.parted) parted[{bond.a, bond.b}] = bond.end;
      for (std::size_t k = 0; k < kTimes.size(); ++k) {
        if (lasted >= kTimes[k] || bond.parted) at_risk_[k] += 1;
        if (lasted < kTimes[k] && bond.parted) ended_[k] += 1;
      }
    }
    count_sizes(r, bonds);
    measure(r, bonds);
  }

  void append_to(std::vector<double>& out) const {
    out.push_back(log_rate(begun_, module_time_)), out.push_back(log_rate(parted_, time_));
    out.push_back(share(again_, parted_)), out.push_back(time_ / (module_time_ + 1));
    out.push_back(log_rate(met_, module_time_)), out.push_back(share(begun_, met_));
    out.push_back((before_ + reach_) / (known_before_ + 1));
    const double n = lengths_ + 1, far = far_ / n;
    out.push_back(longer_ / n);
    out.push_back((longer_far_ / n - longer_ / n * far) /
                  (far_far_ / n - far * far + kLeastScatter));
    for (std::size_t k = 0; k < kTimes.size(); ++k) out.push_back(share(ended_[k], at_risk_[k]));
    for (const double time : in_size_) out.push_back(time / (module_time_ + 1));
  }

  static void name(std::vector<ScoreEntry>& out) {
    for (const char* what : {"new bonds", "partings", "latched again", "bonds per module",
                             "meetings", "bonds per meeting", "distance before a bond",
                             "length of bonds", "length of bonds across the image"}) {
      out.push_back({"bond", what});
    }
    for (const double time : kTimes) {
      out.push_back({"bond", "parted within " + shortest(time) + " s"});
    }
    for (int k = 0; k < kSizes; ++k) {
      out.push_back({"bond", "time in assemblies of " + std::to_string(k + 2)});
    }
  }

 private:
  // What a camera shows of squares that are face to face, in one frame a second: a lens makes them
  // shorter or longer far from its axis. Not where they may still be settling or parting.
  void measure(const Recording& r, const std::vector<SeenBond>& bonds) {
    const auto seen = [&r](std::int64_t id, int frame) -> std::optional<Vec2> {
      for (const Track& t : r.tracks) {
        if (t.id != id || frame < t.first || frame > t.last()) continue;
        const auto i = static_cast<std::size_t>(frame - t.first);
        if (!std::isnan(t.x[i])) return Vec2(t.x[i], t.y[i]);
      }
      return std::nullopt;
    };
    const int step = std::max(1, static_cast<int>(std::lround(r.rate)));
    for (const SeenBond& bond : bonds) {
      for (int frame = bond.begin + kSettling; frame < bond.end - kSettling; frame += step) {
        const auto a = seen(bond.a, frame), b = seen(bond.b, frame);
        if (!a || !b) continue;
        const double longer = (*b - *a).norm() - side_;
        const double far = (0.5 * (*a + *b)).squaredNorm() / (radius_ * radius_);
        lengths_ += 1, longer_ += longer, far_ += far;
        far_far_ += far * far, longer_far_ += longer * far;
      }
    }
  }

  // In one frame a second.
  void count_sizes(const Recording& r, const std::vector<SeenBond>& bonds) {
    std::map<std::int64_t, int> numbers;
    for (const Track& t : r.tracks) numbers.emplace(t.id, static_cast<int>(numbers.size()));
    const int step = std::max(1, static_cast<int>(std::lround(r.rate)));
    for (int frame = 0; frame < r.frames; frame += step) {
      Sets sets(static_cast<int>(numbers.size()));
      for (const SeenBond& bond : bonds) {
        if (bond.begin > frame) break;
        if (bond.end > frame) sets.join(numbers.at(bond.a), numbers.at(bond.b));
      }
      std::vector<int> sizes(numbers.size(), 0);
      for (const auto& [id, number] : numbers)
        ++sizes[static_cast<std::size_t>(sets.first(number))];
      for (const int size : sizes) {
        if (size < 2) continue;
        in_size_[static_cast<std::size_t>(std::min(size, kSizes + 1) - 2)] += size * step / r.rate;
      }
    }
  }

  double radius_, side_, reach_, angle_;
  double module_time_ = 0, begun_ = 0, parted_ = 0, time_ = 0, again_ = 0;
  double met_ = 0, before_ = 0, known_before_ = 0;
  // Lengths of bonds beyond a side, squared distances from the centre in radii of the tank, and
  // their sums.
  double lengths_ = 0, longer_ = 0, far_ = 0, far_far_ = 0, longer_far_ = 0;
  std::array<double, kTimes.size()> at_risk_{}, ended_{};
  std::array<double, kSizes> in_size_{};
};

// What the modules reported: how long latches wait for their first decision and bonds for their
// end.
class Log {
 public:
  void add(const Recording& r) {
    std::map<std::pair<std::int64_t, std::int64_t>, double> latched, bonded;
    const double end = r.time(r.frames);
    for (const Track& t : r.tracks) module_time_ += static_cast<double>(t.x.size()) / r.rate;
    for (const LoggedEvent& e : r.events) {
      if (e.time < r.start || e.time > end) continue;
      const auto pair = std::minmax(e.a, e.b);
      const auto take = [&](auto& from, double& time) {
        const auto at = from.find(pair);
        if (at == from.end()) return;
        time += e.time - at->second;
        from.erase(at);
      };
      switch (e.kind) {
        case EventKind::latch:
          latches_ += 1, latched[pair] = e.time;
          break;
        case EventKind::unlatch:
          unlatched_ += 1, take(latched, waited_);
          break;
        case EventKind::link:
          linked_ += 1, take(latched, waited_to_link_), bonded[pair] = e.time;
          break;
        case EventKind::unlink:
          unlinked_ += 1, take(bonded, bonded_), take(latched, waited_);
          break;
        case EventKind::update:
          updates_ += 1;
          break;
        default:
          break;
      }
    }
    for (const auto& [pair, time] : latched) waiting_ += end - time;
    for (const auto& [pair, time] : bonded) bonded_ += end - time;
  }

  void append_to(std::vector<double>& out) const {
    const double decided = linked_ + unlatched_;
    out.push_back(log_rate(latches_, module_time_));
    out.push_back(log_rate(decided, waited_ + waited_to_link_ + waiting_));
    out.push_back(log_rate(unlatched_, waited_)), out.push_back(log_rate(linked_, waited_to_link_));
    out.push_back(share(linked_, decided)), out.push_back(log_rate(unlinked_, bonded_));
    out.push_back(log_rate(updates_, bonded_));
  }

  static void name(std::vector<ScoreEntry>& out) {
    for (const char* what :
         {"logged latches", "decisions on a latch", "time to unlatch", "time to link",
          "latches that are linked", "unlinked bonds", "updates of labels"}) {
      out.push_back({"bond", what});
    }
  }

 private:
  double module_time_ = 0, latches_ = 0, unlatched_ = 0, linked_ = 0, unlinked_ = 0, updates_ = 0;
  double waited_ = 0, waited_to_link_ = 0, waiting_ = 0, bonded_ = 0;
};

}  // namespace

std::vector<ScoreEntry> bond_entries(const ScorePlan& plan) {
  std::vector<ScoreEntry> out;
  Geometry::name(out);
  if (plan.logged) Log::name(out);
  return out;
}

std::vector<double> bond_numbers(const ScorePlan& plan, const std::vector<Recording>& recordings) {
  Geometry geometry(plan.model);
  Log log;
  for (const Recording& r : recordings) {
    if (!r.latches) continue;
    geometry.add(r);
    log.add(r);
  }
  std::vector<double> out;
  geometry.append_to(out);
  if (plan.logged) log.append_to(out);
  return out;
}

}  // namespace lilytank
