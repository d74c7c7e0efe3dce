// The objective of the search.
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/setup.hpp"
#include "lilytank/random.hpp"
#include "lilytank/study.hpp"

namespace lilytank {
namespace {

constexpr std::uint64_t kSearchSeed = 1, kScaleSeed = 2;  // runs of the calibration's seed
constexpr int kScalePieces = 24;
/// Degrees of freedom of the Student's t log-likelihood: heavy tails bound the weight of statistics
/// that are far off except near the optimum.
constexpr double kFreedom = 3;

}  // namespace

struct CalibrationSearch::Parts {
  CalibrationSetup setup;
  Emulator emulator;
  SearchSpace space;
  std::vector<double> observed, deviation;

  explicit Parts(CalibrationSetup from)
      : setup(std::move(from)),
        emulator(setup.emulator(setup.shapes, CalibrationSetup::Of::pieces)) {
    for (const FitParameter& p : setup.parameters) {
      if (!p.nuisance) space.push_back({p.path, p.low, p.high, p.logarithmic});
    }
    const bool eq9_alone = setup.options.objective == CalibrationObjective::msd;
    observed = eq9_alone ? eq9_curve(setup.training, {.seconds = setup.piece})
                         : setup.numbers(setup.training);
    if (!eq9_alone) find_deviation();
  }

  std::vector<double> values(const std::vector<double>& point) const {
    std::vector<double> all = setup.start;
    std::copy(point.begin(), point.end(), all.begin());
    return all;
  }

  // Standard deviations of the statistics of a piece, from pieces simulated at the start.
  void find_deviation() {
    std::vector<std::vector<double>> rows(kScalePieces);
    for_each_world(kScalePieces, setup.options.threads, [&](int i) {
      const auto piece =
          emulator.piece(setup.start, derived_seed(setup.options.seed, kScaleSeed), i, setup.piece);
      if (piece) rows[static_cast<std::size_t>(i)] = setup.numbers({*piece});
    });
    std::erase_if(rows, [](const auto& row) { return row.empty(); });
    if (rows.size() < 4) throw InputError("simulations at the experiment's own parameters diverge");
    const auto n = static_cast<double>(rows.size());
    for (std::size_t k = 0; k < observed.size(); ++k) {
      double mean = 0, square = 0;
      for (const auto& row : rows) mean += row[k] / n;
      for (const auto& row : rows) square += (row[k] - mean) * (row[k] - mean);
      deviation.push_back(std::sqrt(square / (n - 1)));
    }
  }

  double value(const Trial& trial) const {
    const auto piece =
        emulator.piece(values(trial.point), derived_seed(setup.options.seed, kSearchSeed),
                       trial.replicate, setup.piece);
    if (!piece) return std::numeric_limits<double>::infinity();
    if (setup.options.objective == CalibrationObjective::msd) {
      return eq9(eq9_curve({*piece}, {.seconds = setup.piece, .first_origin = true}), observed);
    }
    const std::vector<double> numbers = setup.numbers({*piece});
    double sum = 0;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!(deviation[k] > 0)) continue;
      const double z = (numbers[k] - observed[k]) / deviation[k];
      sum += 0.5 * (kFreedom + 1) * log_portable(1 + z * z / kFreedom);
    }
    return sum;
  }
};

CalibrationSearch::CalibrationSearch(const Experiment& experiment,
                                     const CalibrationOptions& options)
    : parts_(std::make_unique<const Parts>(set_up(experiment, options))) {}
CalibrationSearch::CalibrationSearch(CalibrationSetup setup)
    : parts_(std::make_unique<const Parts>(std::move(setup))) {}
CalibrationSearch::~CalibrationSearch() = default;
CalibrationSearch::CalibrationSearch(CalibrationSearch&&) noexcept = default;

const SearchSpace& CalibrationSearch::space() const {
  return parts_->space;
}
double CalibrationSearch::value(const Trial& trial) const {
  return parts_->value(trial);
}

}  // namespace lilytank
