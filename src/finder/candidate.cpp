#include "finder/candidate.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/linear.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

}  // namespace

EffectCandidate candidate_of(const Whitening& whitening, const Fingerprint& fingerprint, int effect,
                             int shape) {
  EffectCandidate out;
  out.effect = effect, out.shape = shape, out.source = fingerprint;
  // Residuals have unit variance; a fingerprint about estimated amplitudes has the errors of its
  // slope and of its mean as well.
  const auto n = static_cast<double>(std::max(1, fingerprint.experiments));
  const auto kept = [&](const Matrix& of, double e) {
    Matrix clear = of.unaryExpr([=](double v) { return std::fabs(v) < kNoisy * e ? 0.0 : v; });
    clear.topRows(fingerprint.exact) = of.topRows(fingerprint.exact);
    return clear;
  };
  const double error = fingerprint.local() ? 0 : 1 / std::sqrt(kLearnedSquare * n);
  out.learned = kept(fingerprint.first, error);
  out.all = fingerprint;
  out.all.base = whitening.whitened(kept(fingerprint.base, 1 / std::sqrt(n)));
  out.all.first = whitening.whitened(out.learned);
  out.all.second = whitening.whitened(kept(fingerprint.second, error));
  out.named = out.all.top(whitening.named);
  out.basis = out.all.first;
  return out;
}

EffectCandidate renewed(const EffectCandidate& candidate, const Whitening& whitening,
                        const Fingerprint& fingerprint) {
  EffectCandidate out = candidate_of(whitening, fingerprint, candidate.effect, candidate.shape);
  out.learned = candidate.learned, out.basis = whitening.whitened(candidate.learned);
  out.scale = candidate.scale, out.scale_all = candidate.scale_all;
  return out;
}

std::size_t place_of(const std::vector<EffectCandidate>& candidates, int effect, int shape) {
  std::size_t place = candidates.size();
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates[k].effect == effect && candidates[k].shape == shape) place = k;
  }
  return place;
}

double z_of_gain(double gain, double scale, Eigen::Index freedom) {
  return chi_squared_z(std::max(0.0, gain) / std::max(scale, 1e-9), static_cast<int>(freedom));
}

EffectFit fitted(const EffectCandidate& candidate, const ResponseModel& response,
                 const Vector& data) {
  ResponseFit fit = fit_response(response, data);
  EffectFit out;
  out.effect = candidate.effect, out.shape = candidate.shape,
  out.about = candidate.source.local() ? candidate.source.experiments : 0;
  out.gain = data.squaredNorm() - fit.left.squaredNorm();
  out.at_bound = out.gain > 0 && response.at_bound(fit.amplitudes);
  out.amplitudes = std::move(fit.amplitudes);
  return out;
}

EffectFit fit_of(const EffectCandidate& candidate, const Vector& whitened) {
  EffectFit out = fitted(candidate, candidate.named, whitened.head(candidate.named.first.rows()));
  const Eigen::Index m = out.amplitudes.size();
  out.z = z_of_gain(out.gain, candidate.scale, m);
  if (candidate.effect >= 0) {
    const double gain = fitted(candidate, candidate.all, whitened).gain;
    out.z = std::max(out.z, z_of_gain(gain, candidate.scale_all, m));
  }
  return out;
}

std::vector<CandidatePair> leading_pairs(const std::vector<EffectCandidate>& candidates,
                                         const Vector& whitened, std::size_t count) {
  std::vector<Eigen::Index> first{0};
  for (const EffectCandidate& c : candidates) {
    first.push_back(first.back() + (c.source.local() ? 1 : c.all.first.cols()));
  }
  Matrix basis(whitened.size(), first.back());
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const ResponseModel& of = candidates[k].all;
    basis.middleCols(first[k], first[k + 1] - first[k]) = of.local() ? Matrix(of.base) : of.first;
  }
  const Matrix gram = basis.transpose() * basis;
  const Vector seen = basis.transpose() * whitened;
  const auto possible = [&](std::size_t k, const Vector& amplitudes) {
    return candidates[k].all.two_sided || amplitudes.minCoeff() > 0;
  };
  std::vector<std::pair<double, CandidatePair>> ranked;  // by -gain
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    for (std::size_t b = a + 1; b < candidates.size(); ++b) {
      const auto of_a = Eigen::seq(first[a], first[a + 1] - 1);
      const auto of_b = Eigen::seq(first[b], first[b + 1] - 1);
      Matrix normal(of_a.size() + of_b.size(), of_a.size() + of_b.size());
      normal << gram(of_a, of_a), gram(of_a, of_b), gram(of_b, of_a), gram(of_b, of_b);
      normal.diagonal().array() += 1e-6 + 1e-3 * normal.diagonal().maxCoeff();
      Vector both(of_a.size() + of_b.size());
      both << seen(of_a), seen(of_b);
      const Vector amplitudes = solve_symmetric(normal, both);
      if (possible(a, amplitudes.head(of_a.size())) && possible(b, amplitudes.tail(of_b.size()))) {
        ranked.push_back({-both.dot(amplitudes), {a, b}});
      }
    }
  }
  const auto most = static_cast<std::ptrdiff_t>(std::min(ranked.size(), count));
  std::partial_sort(ranked.begin(), ranked.begin() + most, ranked.end());
  std::vector<CandidatePair> out;
  for (auto pair = ranked.begin(); pair != ranked.begin() + most; ++pair) {
    out.push_back(pair->second);
  }
  return out;
}

}  // namespace lilytank
