// Agreement of simulated and recorded motion before and after calibration: Eq. 9 with its noise
// floor, and maps of the mean velocity.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibrate/stages.hpp"
#include "lilytank/random.hpp"
#include "lilytank/smoothing.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

constexpr std::uint64_t kCompareSeed = 3000, kSplitSeed = 3001;
constexpr int kMapCells = 25;
using Curve = std::vector<double>;

// A random permutation of 0 .. n-1, of which the first n / 2 (rounded down) are one half.
std::vector<std::size_t> shuffled(std::size_t n, std::uint64_t seed, int draw) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = n; i > 1; --i) {
    const auto bits =
        random_bits({seed, Stream::calibrate, draw, static_cast<std::uint32_t>(i), 3});
    std::swap(order[i - 1], order[(bits[0] * i) >> 32]);
  }
  return order;
}

std::vector<Recording> some_of(const std::vector<Recording>& pieces,
                               const std::vector<std::size_t>& order, std::size_t from,
                               std::size_t to) {
  std::vector<Recording> out;
  for (std::size_t i = from; i < to; ++i) out.push_back(pieces[order[i]]);
  return out;
}

// mean -/+ t s k of the curves at each lag; none of fewer than two.
void add_band(const std::vector<Curve>& curves, double k, Curve& low, Curve& high) {
  const auto n = static_cast<double>(curves.size());
  if (n < 2) return;
  const double t = student_half_width(n - 1);
  for (std::size_t i = 0; i < curves[0].size(); ++i) {
    double sum = 0, square = 0;
    for (const Curve& c : curves) sum += c[i];
    for (const Curve& c : curves) square += (c[i] - sum / n) * (c[i] - sum / n);
    const double half = t * k * std::sqrt(square / (n - 1));
    low.push_back(std::max(0.0, sum / n - half)), high.push_back(sum / n + half);
  }
}

// Adds the n-th part of the distance of two curves at each lag.
void add_distance(const Curve& a, const Curve& b, int n, Curve& mean) {
  mean.resize(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mean[i] += std::fabs(a[i] - b[i]) / n;
}

class Comparison {
 public:
  Comparison(Stages& stages, const std::vector<Recording>& recordings,
             const std::vector<RecordingShape>& shapes, std::string name)
      : stages_(stages),
        setup_(stages.setup()),
        emulator_(setup_.emulator(shapes, Stages::Of::experiments)),
        pieces_(pieces_of(recordings, setup_.piece)),
        rule_{.seconds = setup_.piece},
        seed_(derived_seed(setup_.options.seed, kSplitSeed)) {
    out_.recordings = std::move(name);
    out_.pieces = static_cast<int>(pieces_.size()), out_.seconds = setup_.piece;
    out_.real = eq9_curve(pieces_, rule_);
    for (std::size_t k = 0; k < out_.real.size(); ++k) {
      out_.lag.push_back(rule_.lag * static_cast<double>(k + 1));
    }
  }

  MsdFit fit(const std::vector<double>& start, const std::vector<double>& estimate) {
    const int n = setup_.options.comparisons;
    for (int i = 0; i < n; ++i) {
      const auto order = shuffled(pieces_.size(), seed_, i);
      const std::size_t half = pieces_.size() / 2;
      halves_.push_back(eq9_curve(some_of(pieces_, order, 0, half), rule_));
      const Curve other = eq9_curve(some_of(pieces_, order, half, 2 * half), rule_);
      out_.floor += eq9(halves_.back(), other) / n;
      add_distance(halves_.back(), other, n, out_.floor_at);
    }
    band_of_pieces();
    out_.experiments = n;
    against(start, "start", out_.simulated_before, out_.before, out_.before_at);
    const std::vector<Curve> same =
        against(estimate, "estimate", out_.simulated_after, out_.after, out_.after_at);
    add_band(whole_, 1, out_.after_low, out_.after_high);
    compare_equals(same);
    return std::move(out_);
  }

 private:
  // Pieces, not bodies, are independent: bodies of one share its flow, latched ones their motion.
  void band_of_pieces() {
    std::vector<Curve> curves;
    for (const Recording& piece : pieces_) curves.push_back(eq9_curve({piece}, rule_));
    add_band(curves, 1 / std::sqrt(static_cast<double>(curves.size())), out_.real_low,
             out_.real_high);
  }

  // Compares every simulated experiment with the others, as the recordings are compared with all.
  void compare_equals(const std::vector<Curve>& same) {
    const std::size_t n = same.size();
    if (n == 0) {
      out_.equals = out_.equals_p = NAN;
      return;
    }
    std::size_t as_far = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double mean = 0;
      for (std::size_t j = 0; j < n; ++j) {
        if (j != i) mean += eq9(same[i], same[j]) / static_cast<double>(n - 1);
      }
      out_.equals += mean / static_cast<double>(n);
      as_far += mean >= out_.after ? 1 : 0;
    }
    out_.equals_p = static_cast<double>(as_far + 1) / static_cast<double>(n + 1);
  }

  // Simulates halves; sets `fit` to the mean of Eq. 9 against them, `mean` to the mean curve and
  // `distance` to the mean distance at each lag.
  std::vector<Curve> against(const std::vector<double>& values, const std::string& when,
                             Curve& mean, double& fit, Curve& distance) {
    const int n = setup_.options.comparisons;
    const auto rows =
        stages_.rows("comparison with the " + when + ", " + out_.recordings, n, [&](int i) {
          const auto made = emulator_.record(
              values, derived_seed(setup_.options.seed, kCompareSeed + static_cast<unsigned>(i)));
          if (!made) return Curve{};
          const auto pieces = pieces_of(*made, setup_.piece);
          const auto order = shuffled(pieces.size(), seed_, i);
          Curve row = eq9_curve(some_of(pieces, order, 0, pieces.size() / 2), rule_);
          const Curve whole = eq9_curve(pieces, rule_);
          row.insert(row.end(), whole.begin(), whole.end());
          return row;
        });
    std::vector<Curve> simulated;
    mean.assign(out_.real.size(), 0), fit = 0;
    whole_.clear();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // A diverged world has the largest misfit.
      if (rows[i].empty()) {
        fit = INFINITY;
        whole_.clear(), distance.clear();
        return {};
      }
      const auto middle = rows[i].begin() + static_cast<std::ptrdiff_t>(mean.size());
      simulated.emplace_back(rows[i].begin(), middle);
      whole_.emplace_back(middle, rows[i].end());
      fit += eq9(simulated.back(), halves_[i]) / n;
      add_distance(simulated.back(), halves_[i], n, distance);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += rows[i][mean.size() + k] / n;
    }
    return simulated;
  }

  Stages& stages_;
  const CalibrationSetup& setup_;
  Emulator emulator_;
  std::vector<Recording> pieces_;
  Eq9 rule_;
  std::uint64_t seed_;
  std::vector<Curve> halves_, whole_;  // recorded; simulated last
  MsdFit out_;
};

VelocityMap map_of(const std::vector<Recording>& recordings, double radius) {
  std::vector<SmoothRecording> smoothed;
  for (const Recording& one : recordings) {
    smoothed.push_back(
        smooth(one, {.method = SmoothingMethod::polynomial, .window = 0.3, .degree = 3}));
  }
  return velocity_map(smoothed, kMapCells, radius);
}

}  // namespace

void compare_with_data(Stages& stages, CalibrationResult& out) {
  const CalibrationSetup& setup = stages.setup();
  std::vector<double> start, estimate;
  for (const CalibratedParameter& p : out.parameters) {
    start.push_back(p.start), estimate.push_back(p.estimate);
  }
  out.msd.push_back(
      Comparison(stages, setup.training, setup.shapes, "training").fit(start, estimate));
  if (!setup.held_out.empty()) {
    out.msd.push_back(
        Comparison(stages, setup.held_out, setup.held_out_shapes, "held out").fit(start, estimate));
  }
  const auto made = setup.emulator(setup.shapes, Stages::Of::experiments)
                        .record(estimate, derived_seed(setup.options.seed, kCompareSeed));
  const double radius = setup.model.tank.radius;
  out.real_velocity = map_of(setup.training, radius);
  if (made) out.simulated_velocity = map_of(*made, radius);
}

}  // namespace lilytank
