#include "bodies/checks.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/median.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank::bodies {
namespace {

// One coordinate of a run, and what its places are rounded to.
struct Track {
  std::vector<double> x, time;
  double quantum = 0;  // what places are rounded to; 0: they are not
  double range = 0;
};

// The smallest difference of two values, of which all others are multiples; 0 where values are not
// rounded to such a step.
double quantum_of(std::vector<double> values, double range) {
  std::sort(values.begin(), values.end());
  std::vector<double> steps;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = values[k] - values[k - 1];
    if (step > 1e-9 * range) steps.push_back(step);
  }
  if (steps.empty()) return 0;
  const double least = *std::min_element(steps.begin(), steps.end());
  const auto multiple = [&](double step) {
    return std::fabs(step / least - std::round(step / least)) < 1e-3;
  };
  return std::all_of(steps.begin(), steps.end(), multiple) ? least : 0;
}

Track track_of(const BodyRun& run, std::size_t coordinate) {
  Track out;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t k = 0; k < run.samples(); ++k) {
    const double x = run.position[k * run.coordinates() + coordinate];
    if (!std::isfinite(x)) continue;
    out.x.push_back(x), out.time.push_back(run.time[k]);
    low = std::min(low, x), high = std::max(high, x);
  }
  out.range = out.x.empty() ? 0 : high - low;
  out.quantum = quantum_of(out.x, out.range);
  return out;
}

// Whether places of neighbouring rows are unrelated: no correlation at four lags, each within
// three standard errors of 0. That of a motion is near 1 at the first, or a cosine of the lag.
bool unrelated(const Track& t) {
  constexpr std::size_t kLeast = 24, kLags = 4;
  const std::size_t n = t.x.size();
  if (n < kLeast) return false;
  double mean = 0, square = 0;
  for (const double x : t.x) mean += x / static_cast<double>(n);
  for (const double x : t.x) square += (x - mean) * (x - mean);
  for (std::size_t lag = 1; lag <= kLags; ++lag) {
    double sum = 0;
    for (std::size_t k = lag; k < n; ++k) sum += (t.x[k] - mean) * (t.x[k - lag] - mean);
    if (std::fabs(sum) > 3 * square / std::sqrt(static_cast<double>(n))) return false;
  }
  return true;
}

// All coordinates that change are unrelated, by more than the noise where it is known.
bool out_of_order(const BodyExperiment& e, const std::vector<Track>& all) {
  bool changes = false;
  for (const Track& t : all) {
    if (!(t.range > 0)) continue;
    if (!unrelated(t) || t.range < 10 * e.noise) return false;
    changes = true;
  }
  return changes;
}

// Rows after which a body is elsewhere: displaced by far more than its velocities of the two rows
// before and after allow, and than these scatter. Bounces change velocities, not places.
int jumps(const Track& t) {
  constexpr double kScatter = 20, kQuanta = 6;
  const std::size_t n = t.x.size();
  if (n < 12) return 0;
  std::vector<double> steps, off(n, 0), spread(n, INFINITY), usual;
  for (std::size_t k = 1; k < n; ++k) steps.push_back(t.time[k] - t.time[k - 1]);
  const double step = median(std::vector<double>(steps));
  const auto velocity = [&](std::size_t k) { return (t.x[k + 1] - t.x[k]) / steps[k]; };
  for (std::size_t k = 2; k + 3 < n; ++k) {
    double around[4] = {velocity(k - 2), velocity(k - 1), velocity(k + 1), velocity(k + 2)};
    std::sort(around, around + 4);
    off[k] = std::fabs(velocity(k) - (around[1] + around[2]) / 2) * steps[k];
    spread[k] = (around[3] - around[0]) * steps[k];
    usual.push_back(off[k]);
  }
  const double scatter = 1.5 * median(std::move(usual));
  int out = 0;
  for (std::size_t k = 2; k + 3 < n; ++k) {
    const bool far = off[k] > kScatter * scatter && off[k] > kQuanta * t.quantum;
    if (far && off[k] > 3 * spread[k] && steps[k] < 1.5 * step) ++out;
  }
  return out;
}

// Rows with the places of the row before, within a motion that is resolved.
int repeated_rows(const std::vector<Track>& all) {
  constexpr double kQuanta = 6;
  std::size_t n = SIZE_MAX;
  for (const Track& t : all) n = std::min(n, t.x.size());
  int out = 0;
  for (std::size_t k = 2; k + 2 < n; ++k) {
    bool same = true, moves = false;
    for (const Track& t : all) {
      same = same && t.x[k] == t.x[k - 1];
      moves = moves || std::min(std::fabs(t.x[k + 1] - t.x[k]),
                                std::fabs(t.x[k - 1] - t.x[k - 2])) > kQuanta * t.quantum;
    }
    if (same && moves) ++out;
  }
  return out;
}

// The longest part in which one coordinate of a body keeps exactly its value while the other
// changes in nearly every row.
std::size_t stuck_rows(const Track& held, const Track& other) {
  const std::size_t n = std::min(held.x.size(), other.x.size());
  std::size_t longest = 0, changes = 0;
  for (std::size_t k = 1, from = 0; k < n; ++k) {
    if (held.x[k] != held.x[k - 1]) from = k, changes = 0;
    if (other.x[k] != other.x[k - 1]) ++changes;
    if (10 * changes >= 9 * (k - from)) longest = std::max(longest, k - from);
  }
  return longest;
}

bool same_positions(const BodyRun& a, const BodyRun& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.position.size() == b.position.size() &&
         std::equal(a.position.begin(), a.position.end(), b.position.begin(), same);
}

// Collects the runs that have a kind of fault.
class Faults {
 public:
  explicit Faults(const BodyExperiment& e) : e_(e) {
    for (std::size_t r = 0; r < e.runs.size(); ++r) check(r);
  }

  std::vector<DiagnosisFinding> findings() const {
    std::vector<DiagnosisFinding> out;
    const auto add = [&](const std::string& name, const std::vector<std::string>& runs,
                         const std::string& text) {
      if (runs.empty()) return;
      DiagnosisFinding& f = out.emplace_back();
      f.effect = name, f.variable = "time", f.unit = "s", f.confidence = 1;
      f.text = text + " (" + joined(runs, ", ") + ")";
    };
    add("row order", order_,
        "positions of neighbouring rows are unrelated: rows or times are out of order, samples "
        "are too far apart, or nothing moves but noise, which noise in [experiment] then states");
    add("position jumps", jumps_, "bodies are displaced from one row to the next and stay there");
    add("repeated rows", repeats_, "moving bodies repeat the positions of the row before");
    add("stuck axis", stuck_, "one coordinate keeps its exact value while the other changes");
    add("repeated run", twice_, "runs have the same positions");
    return out;
  }

 private:
  void check(std::size_t r) {
    const BodyRun& run = e_.runs[r];
    std::vector<Track> all;
    for (std::size_t c = 0; c < run.coordinates(); ++c) all.push_back(track_of(run, c));
    if (out_of_order(e_, all)) {
      order_.push_back(run.name);
      return;  // in no order, everything jumps
    }
    int jumped = 0;
    for (const Track& t : all) jumped += jumps(t);
    if (jumped > 0) jumps_.push_back(run.name + ": " + counted(jumped, "row"));
    const int same = repeated_rows(all);
    if (same >= 5 && same * 20 > static_cast<int>(run.samples())) {
      repeats_.push_back(run.name + ": " + counted(same, "row"));
    }
    constexpr std::size_t kStuck = 20;
    for (std::size_t c = 0; e_.dimensions == 2 && c < all.size(); ++c) {
      const std::size_t rows = stuck_rows(all[c], all[c ^ 1]);
      if (rows < kStuck) continue;
      stuck_.push_back(run.name + ": " + (c % 2 == 0 ? "x" : "y") + " in " +
                       counted(static_cast<std::int64_t>(rows), "row"));
    }
    const bool moves = std::any_of(all.begin(), all.end(), [](auto& t) { return t.range > 0; });
    for (std::size_t o = 0; moves && o < r; ++o) {
      if (same_positions(e_.runs[o], run)) twice_.push_back(e_.runs[o].name + " and " + run.name);
    }
  }

  const BodyExperiment& e_;
  std::vector<std::string> order_, jumps_, repeats_, stuck_, twice_;
};

}  // namespace

std::vector<DiagnosisFinding> recording_faults(const BodyExperiment& e) {
  return Faults(e).findings();
}

}  // namespace lilytank::bodies
