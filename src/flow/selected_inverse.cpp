#include "flow/selected_inverse.hpp"

#include <algorithm>

namespace lilytank {
namespace {

// Columns of a strictly lower triangle.
struct LowerTriangle {
  const int *start, *row;
  int begin(int j) const { return start[j]; }
  int end(int j) const { return start[j + 1]; }
};

}  // namespace

// With A = L D L^T the inverse Z obeys Z = D^-1 L^-1 + (I - L^T) Z, whose right-hand side needs, in
// column j, only entries of later columns and of the factor's pattern.
SelectedInverse::SelectedInverse(const SparseFactor& factor) {
  const Eigen::SparseMatrix<double> all = factor.matrixL();
  lower_ = all.triangularView<Eigen::StrictlyLower>();
  lower_.makeCompressed();
  const Eigen::SparseMatrix<double> l = lower_;
  const Eigen::VectorXd d = factor.vectorD();
  place_ = factor.permutationP().indices();
  const int n = static_cast<int>(l.cols());
  diagonal_.assign(n, 0);
  const LowerTriangle c{l.outerIndexPtr(), l.innerIndexPtr()};
  const double* factor_value = l.valuePtr();
  double* z = lower_.valuePtr();
  std::vector<int> where(static_cast<std::size_t>(n), -1);
  std::vector<double> sum;
  for (int j = n - 1; j >= 0; --j) {
    const int begin = c.begin(j), count = c.end(j) - begin;
    sum.assign(count, 0);
    for (int p = 0; p < count; ++p) where[c.row[begin + p]] = p;
    for (int p = 0; p < count; ++p) {
      const int k = c.row[begin + p];
      const double lk = factor_value[begin + p];
      double own = lk * diagonal_[k];
      for (int r = c.begin(k); r < c.end(k); ++r) {
        const int at = where[c.row[r]];
        if (at < 0) continue;
        sum[at] -= lk * z[r];
        own += factor_value[begin + at] * z[r];
      }
      sum[p] -= own;
    }
    double diagonal = 1 / d[j];
    for (int p = 0; p < count; ++p) {
      z[begin + p] = sum[p];
      diagonal -= factor_value[begin + p] * z[begin + p];
      where[c.row[begin + p]] = -1;
    }
    diagonal_[j] = diagonal;
  }
}

double SelectedInverse::operator()(Eigen::Index i, Eigen::Index j) const {
  int a = place_[i], b = place_[j];
  if (a == b) return diagonal_[a];
  if (a < b) std::swap(a, b);
  const int* rows = lower_.innerIndexPtr();
  const int *begin = rows + lower_.outerIndexPtr()[b], *end = rows + lower_.outerIndexPtr()[b + 1];
  const int* found = std::lower_bound(begin, end, a);
  return found != end && *found == a ? lower_.valuePtr()[found - rows] : 0;
}

}  // namespace lilytank
