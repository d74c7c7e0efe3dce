#include "calibrate/cross_fit.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/design.hpp"
#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

constexpr int kFolds = 8;

// No bounds but a distance from the centre, in deviations of the design.
const FitBounds kFree{{}, {}, 5};

// Row i is estimated by the surface that was made without it.
void estimate(const Eigen::MatrixXd& numbers, const Eigen::VectorXd& data, CrossFit& out) {
  out.misfits.resize(numbers.rows());
  for (Eigen::Index i = 0; i < numbers.rows(); ++i) {
    const ResponseSurface& model = out.models[static_cast<std::size_t>(i % kFolds)];
    const LocalFit fit = model.fit(numbers.row(i).transpose(), kFree);
    if (i == 0) out.estimates.resize(numbers.rows(), fit.point.size());
    out.estimates.row(i) = fit.point, out.misfits(i) = fit.misfit;
  }
  LocalFit of_data = out.of(data);
  out.answer = std::move(of_data.point), out.misfit = of_data.misfit;
}

}  // namespace

LocalFit CrossFit::of(const Eigen::VectorXd& numbers) const {
  LocalFit out;
  out.point = Eigen::VectorXd::Zero(estimates.cols());
  for (const ResponseSurface& model : models) {
    const LocalFit fit = model.fit(numbers, kFree);
    out.point += fit.point / kFolds, out.misfit += fit.misfit / kFolds;
  }
  return out;
}

CrossFit cross_fit(const Design& design, const Eigen::VectorXd& data, Misfit misfit,
                   Slopes slopes) {
  CrossFit out;
  for (int fold = 0; fold < kFolds; ++fold)
    out.models.emplace_back(without_fold(design, fold, kFolds), misfit, slopes);
  estimate(design.numbers, data, out);
  return out;
}

BiasCorrectedFit bias_corrected(const Design& design, const CrossFit& fit, double least) {
  using Matrix = Eigen::MatrixXd;
  const Eigen::VectorXd centre = design.points.colwise().mean().transpose();
  const Matrix off = design.points.rowwise() - centre.transpose();
  // In deviations of the design, so that an unknown slope has the same error in every direction.
  Matrix spread = off.transpose() * off / static_cast<double>(off.rows() - 1);
  spread.diagonal().array() += 1e-14;
  const Matrix unit = lower_root(spread), to_unit = lower_inverse(unit);
  const Line line =
      line_through(off * to_unit.transpose(),
                   (fit.estimates.rowwise() - centre.transpose()) * to_unit.transpose());
  const Matrix back = floored_inverse(line.slope, least);
  const Eigen::VectorXd z = back * (to_unit * (fit.answer - centre) - line.at_centre);
  Eigen::VectorXd x(z.size() + 1);
  x << 1, z;
  const Matrix root = unit * back;
  return {centre + unit * z, root * line.covariance * root.transpose(),
          line.residuals * root.transpose(),
          student_half_width(line.freedom) * std::sqrt(1 + x.dot(line.inverse * x))};
}

BiasCorrectedFit bias_corrected(const Design& design, const CrossFit& fit, const Prior& prior) {
  const Eigen::VectorXd centre = design.points.colwise().mean().transpose();
  const Line line = line_through(design.points.rowwise() - centre.transpose(), fit.estimates);
  const ParameterEstimate answer = estimate_of(line, centre, fit.answer, prior);
  const auto scale = answer.deviation.asDiagonal();
  return {answer.estimate, scale * answer.correlation * scale,
          line.residuals * answer.back.transpose(), answer.wide};
}

InverseRegression inverse_regression(const Design& design, const Eigen::VectorXd& centre,
                                     const Prior& prior, const Eigen::VectorXd& data) {
  CrossFit by_others = cross_fit(design, data, Misfit::covariance, Slopes::shrunk);
  Line line = line_through(design.points.rowwise() - centre.transpose(), by_others.estimates);
  ParameterEstimate answer = estimate_of(line, centre, by_others.answer, prior);
  return {std::move(by_others), std::move(line), std::move(answer)};
}

InverseRegression anchored(const InverseRegression& about, const Design& design,
                           const Eigen::VectorXd& point, const Eigen::MatrixXd& experiments,
                           const Prior& prior, const Eigen::VectorXd& data) {
  CrossFit fit;
  for (int fold = 0; fold < kFolds; ++fold) {
    ResponseSurface& model =
        fit.models.emplace_back(about.by_others.models[static_cast<std::size_t>(fold)]);
    model.anchor(point, rows_without_fold(experiments, fold, kFolds));
  }
  estimate(design.numbers, data, fit);
  const Line along = line_through(design.points.rowwise() - point.transpose(), fit.estimates);
  estimate(experiments, data, fit);
  Line line = line_through(Eigen::MatrixXd::Zero(experiments.rows(), point.size()), fit.estimates);
  // The inverse covariance of few experiments is biased [Hartlap, Simon and Schneider 2007].
  const auto n = static_cast<double>(experiments.rows()), p = static_cast<double>(point.size());
  line.covariance *= (n - 1) / std::max(1.0, n - p - 2);
  line.freedom = std::max(1.0, n - 1 - p);
  line.slope = along.slope;
  ParameterEstimate answer = estimate_of(line, point, fit.answer, prior);
  return {std::move(fit), std::move(line), std::move(answer)};
}

}  // namespace lilytank
