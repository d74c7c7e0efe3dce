#include "calibrate/cross_fit.hpp"

#include <cmath>

#include "calibrate/design.hpp"
#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

constexpr int kFolds = 8;

// No bounds but a distance from the centre, in deviations of the design.
const FitBounds kFree{{}, {}, 5};

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
  const Eigen::Index n = design.points.rows(), p = design.points.cols();
  CrossFit out{Eigen::MatrixXd(n, p), Eigen::VectorXd(n), {}, 0, {}};
  for (int fold = 0; fold < kFolds; ++fold) {
    const ResponseSurface& model =
        out.models.emplace_back(without_fold(design, fold, kFolds), misfit, slopes);
    for (Eigen::Index i = fold; i < n; i += kFolds) {
      const LocalFit fit = model.fit(design.numbers.row(i).transpose(), kFree);
      out.estimates.row(i) = fit.point, out.misfits(i) = fit.misfit;
    }
  }
  LocalFit of_data = out.of(data);
  out.answer = std::move(of_data.point), out.misfit = of_data.misfit;
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

InverseRegression inverse_regression(const Design& design, const Eigen::VectorXd& centre,
                                     const Prior& prior, const Eigen::VectorXd& data) {
  CrossFit by_others = cross_fit(design, data, Misfit::covariance, Slopes::shrunk);
  Line line = line_through(design.points.rowwise() - centre.transpose(), by_others.estimates);
  ParameterEstimate answer = estimate_of(line, centre, by_others.answer, prior);
  return {std::move(by_others), std::move(line), std::move(answer)};
}

}  // namespace lilytank
