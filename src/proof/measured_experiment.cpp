#include "proof/measured_experiment.hpp"

namespace lilytank {
namespace {

constexpr Eigen::Index kRowBegins = 5;  // numbers before the summary

}  // namespace

std::vector<double> row_of(const MeasuredExperiment& m) {
  std::vector<double> row{static_cast<double>(m.regression),
                          static_cast<double>(m.observed.summary.size()), m.details.pulsation,
                          m.details.swinging, static_cast<double>(m.details.heaviest)};
  row.insert(row.end(), m.observed.summary.begin(), m.observed.summary.end());
  row.insert(row.end(), m.observed.scores.begin(), m.observed.scores.end());
  return row;
}

std::optional<MeasuredExperiment> measured_of(const std::vector<double>& row) {
  if (row.empty()) return std::nullopt;
  MeasuredExperiment m;
  m.regression = static_cast<int>(row[0]);
  const auto summary = static_cast<Eigen::Index>(row[1]);
  m.details.pulsation = row[2], m.details.swinging = row[3];
  m.details.heaviest = static_cast<int>(row[4]);
  const Eigen::Map<const Eigen::VectorXd> all(row.data() + kRowBegins,
                                              static_cast<Eigen::Index>(row.size()) - kRowBegins);
  m.observed = {all.head(summary), all.tail(all.size() - summary)};
  return m;
}

}  // namespace lilytank
