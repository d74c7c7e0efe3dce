#include "finder/response_model.hpp"

#include "statistics/linear.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kSteps = 12;
constexpr double kStart = 0.3;   // sizes
constexpr double kMostSize = 6;  // sizes beyond which an answer is no guide
// Validity range of a local response, relative to its amplitudes and absolute.
constexpr double kNearShare = 0.5, kNearLeast = 0.4;

Vector reach(const ResponseModel& of) {
  return of.local() ? Vector((kNearShare * of.about.cwiseAbs()).array() + kNearLeast)
                    : Vector(Vector::Constant(of.about.size(), kMostSize));
}

}  // namespace

Vector ResponseModel::at(const Vector& amplitudes) const {
  const Vector d = amplitudes - about;
  return base + first * d + second * d.array().square().matrix();
}

Matrix ResponseModel::slope(const Vector& amplitudes) const {
  return first + 2 * second * (amplitudes - about).asDiagonal();
}

Vector ResponseModel::least() const {
  return (about - reach(*this)).cwiseMax(two_sided ? low : 0.0);
}

Vector ResponseModel::most() const {
  return (about + reach(*this)).cwiseMin(high);
}

bool ResponseModel::at_bound(const Vector& amplitudes) const {
  return ((amplitudes - about).cwiseAbs().array() >= (1 - 1e-9) * reach(*this).array()).any();
}

ResponseModel ResponseModel::top(Eigen::Index numbers) const {
  ResponseModel out = *this;
  out.base = base.head(numbers);
  out.first = first.topRows(numbers), out.second = second.topRows(numbers);
  return out;
}

ResponseFit fit_responses(const std::vector<const ResponseModel*>& answers, const Vector& data,
                          const Vector& start) {
  const Eigen::Index m = start.size();
  Vector least(m), most(m);
  Eigen::Index at = 0;
  for (const ResponseModel* of : answers) {
    const Eigen::Index n = of->about.size();
    least.segment(at, n) = of->least(), most.segment(at, n) = of->most();
    at += n;
  }
  ResponseFit best;
  Vector a = start;
  Matrix slope(data.size(), m);
  for (int step = 0;; ++step) {
    Vector left = data;
    at = 0;
    for (const ResponseModel* of : answers) {
      const Vector own = a.segment(at, of->about.size());
      left -= of->at(own);
      slope.middleCols(at, own.size()) = of->slope(own);
      at += own.size();
    }
    Matrix normal = slope.transpose() * slope;
    normal.diagonal().array() += 1e-6 + 1e-3 * normal.diagonal().maxCoeff();
    const Vector change = solve_symmetric(normal, Vector(slope.transpose() * left));
    if (step == 0 || left.squaredNorm() < best.left.squaredNorm()) best = {a, std::move(left)};
    if (step == kSteps) return best;
    a = (a + change).cwiseMax(least).cwiseMin(most);
  }
}

ResponseFit fit_response(const ResponseModel& answer, const Vector& data) {
  const Eigen::Index m = answer.about.size();
  const bool either = answer.two_sided && !answer.local() && m == 1;
  ResponseFit best{Vector::Zero(m), data};
  for (const double sign : {1.0, -1.0}) {
    if (sign < 0 && !either) break;
    Vector start = answer.about;
    if (!answer.local() && m == 1) start(0) = kStart * sign;
    ResponseFit fit = fit_responses({&answer}, data, start);
    if (fit.left.squaredNorm() < best.left.squaredNorm()) best = std::move(fit);
  }
  return best;
}

}  // namespace lilytank
