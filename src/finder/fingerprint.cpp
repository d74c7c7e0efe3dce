#include "finder/fingerprint.hpp"

#include <algorithm>

#include "lilytank/random.hpp"

namespace lilytank {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kApartShare = 0.25, kApartLeast = 0.5;  // of amplitudes, and in sizes
constexpr double kOfRest = 0.3, kLeastRest = 0.2;  // of what is left up to the bound, and in sizes
constexpr double kLeastSize = 0.4;  // of the amplitudes at which fingerprints are learned

}  // namespace

// Faults that are nearly certain change what is seen in proportion to 1 / (1 - probability).
Vector apart(const Effect& effect, const Vector& amplitudes) {
  Vector out = kApartShare * (amplitudes.cwiseAbs().array() + kApartLeast).matrix();
  if (!effect.control() || effect.two_sided) return out;
  const Vector rest = (effect.high - amplitudes.array()).max(kLeastRest);
  return out.cwiseMin(kOfRest * rest);
}

double Fingerprint::noise_at(const Vector& amplitudes) const {
  const double n = std::max(1, experiments);
  return local() ? 1 / n : amplitudes.squaredNorm() / (kLearnedSquare * n);
}

Vector Fingerprint::moved(const Vector& amplitudes) const {
  if (local()) return moved_base;
  // Beyond the sizes at which it was measured, the shift of the parameters saturates.
  return moved_first * amplitudes * std::min(1.0, kLearnedSize / amplitudes.cwiseAbs().maxCoeff());
}

Matrix learning_amplitudes(const Effect& effect, int count, std::uint64_t seed) {
  const auto m = static_cast<Eigen::Index>(effect.paths.size());
  Matrix out(count, m);
  for (int i = 0; i < count; ++i) {
    for (Eigen::Index c = 0; c < m; ++c) {
      const double u = uniform({seed, Stream::calibrate, i, static_cast<std::uint32_t>(c), 9});
      const bool negative = effect.two_sided && (m == 1 ? i % 2 == 1 : ((i >> c) & 1) == 1);
      out(i, c) = (kLeastSize + (kLearnedSize - kLeastSize) * u) * (negative ? -1 : 1);
    }
  }
  return out;
}

Matrix amplitudes_about(const Effect& effect, const Vector& amplitudes, int count,
                        std::uint64_t seed) {
  Matrix out(count, amplitudes.size());
  for (int i = 0; i < count; ++i) {
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      const double u = uniform({seed, Stream::calibrate, i, static_cast<std::uint32_t>(c), 9});
      out(i, c) = i % 2 == 0 ? 2 * u - 1 : -out(i - 1, c);
    }
  }
  out = (out * apart(effect, amplitudes).asDiagonal()).rowwise() + amplitudes.transpose();
  return out.cwiseMax(effect.two_sided ? -1e9 : 0);
}

Fingerprint together(const std::vector<Fingerprint>& fingerprints,
                     const std::vector<Vector>& amplitudes) {
  Eigen::Index m = 0, at = 0;
  for (const Vector& a : amplitudes) m += a.size();
  const Fingerprint& one = fingerprints.front();
  Fingerprint out;
  out.about.resize(m), out.base = Vector::Zero(one.base.size());
  out.first.resize(one.base.size(), m), out.second = Matrix::Zero(one.base.size(), m);
  out.moved_first = Matrix::Zero(one.moved_base.size(), m);
  out.moved_base = Vector::Zero(one.moved_base.size());
  out.identifiable_share = one.identifiable_share;
  out.experiments = one.experiments;
  for (std::size_t i = 0; i < fingerprints.size(); ++i) {
    const Fingerprint& f = fingerprints[i];
    const Vector& a = amplitudes[i];
    out.about.segment(at, a.size()) = a;
    out.first.middleCols(at, a.size()) = f.slope(a);
    out.two_sided = out.two_sided || f.two_sided;
    out.base += f.at(a), out.moved_base += f.moved(a);
    out.identifiable_share = out.identifiable_share.cwiseMin(f.identifiable_share);
    out.experiments = std::min(out.experiments, f.experiments);
    at += a.size();
  }
  return out;
}

}  // namespace lilytank
