#include "search/eigen.hpp"

#include <cmath>

namespace lilytank {
namespace {

constexpr int kMostSweeps = 60;

class Jacobi {
 public:
  Jacobi(std::vector<double>& a, std::vector<double>& vectors, int n)
      : a_(a), v_(vectors), n_(static_cast<std::size_t>(n)) {}

  /// Every off-diagonal element once; false when there was nothing left to do.
  bool sweep() {
    bool turned = false;
    for (std::size_t p = 0; p + 1 < n_; ++p) {
      for (std::size_t q = p + 1; q < n_; ++q) turned |= turn(p, q);
    }
    return turned;
  }

 private:
  double& a(std::size_t i, std::size_t j) { return a_[i * n_ + j]; }

  bool turn(std::size_t p, std::size_t q) {
    const double off = a(p, q);
    const double size = std::sqrt(std::fabs(a(p, p)) * std::fabs(a(q, q)));
    if (std::fabs(off) <= 1e-17 * size || std::fabs(off) < 1e-300) return false;
    const double theta = (a(q, q) - a(p, p)) / (2 * off);
    const double root = std::sqrt(theta * theta + 1);
    const double t = theta >= 0 ? 1 / (theta + root) : 1 / (theta - root);
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    for (std::size_t k = 0; k < n_; ++k) mix(a(k, p), a(k, q), c, s);
    for (std::size_t k = 0; k < n_; ++k) mix(a(p, k), a(q, k), c, s);
    a(p, q) = a(q, p) = 0;
    for (std::size_t k = 0; k < n_; ++k) mix(v_[k * n_ + p], v_[k * n_ + q], c, s);
    return true;
  }

  static void mix(double& x, double& y, double c, double s) {
    const double old = x;
    x = c * old - s * y;
    y = s * old + c * y;
  }

  std::vector<double>&a_, &v_;
  std::size_t n_;
};

}  // namespace

void symmetric_eigen(std::vector<double> a, int n, std::vector<double>& values,
                     std::vector<double>& vectors) {
  const auto size = static_cast<std::size_t>(n);
  vectors.assign(size * size, 0.0);
  for (std::size_t i = 0; i < size; ++i) vectors[i * size + i] = 1;
  Jacobi jacobi(a, vectors, n);
  for (int sweep = 0; sweep < kMostSweeps && jacobi.sweep(); ++sweep) {
  }
  values.resize(size);
  for (std::size_t i = 0; i < size; ++i) values[i] = a[i * size + i];
}

}  // namespace lilytank
