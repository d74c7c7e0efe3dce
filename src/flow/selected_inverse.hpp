// Entries of the inverse of a sparse matrix, where its Cholesky factor has entries.
#pragma once
#include <Eigen/SparseCholesky>
#include <vector>

namespace lilytank {

using SparseFactor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// The inverse of a positive definite matrix at every place where the matrix itself is not zero,
/// and some more, by the recursion of Takahashi, Fagan and Chen [PICA Conference, 1973].
class SelectedInverse {
 public:
  explicit SelectedInverse(const SparseFactor& factor);
  /// Entry (i, j); 0 where it was not computed.
  double operator()(Eigen::Index i, Eigen::Index j) const;

 private:
  Eigen::SparseMatrix<double> lower_;  ///< the factor's pattern, values of the inverse
  std::vector<double> diagonal_;
  Eigen::VectorXi place_;  ///< of a row in the factor's order
};

}  // namespace lilytank
