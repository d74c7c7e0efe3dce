// Eigenvalues of small symmetric matrices with the same bits on every machine.
#pragma once
#include <vector>

namespace lilytank {

/// Of the symmetric n x n matrix `a`, row by row, by cyclic Jacobi rotations [Golub and Van Loan,
/// Matrix computations, 8.5]: eigenvalues in no order, and eigenvectors as the columns of
/// `vectors`, row by row. Written out here since the sums of a blocked matrix product follow the
/// processor's caches.
void symmetric_eigen(std::vector<double> a, int n, std::vector<double>& values,
                     std::vector<double>& vectors);

}  // namespace lilytank
