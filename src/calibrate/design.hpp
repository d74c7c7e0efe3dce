// Design points of a response surface and the statistics of their simulations.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lilytank/response_surface.hpp"

namespace lilytank {

/// Points about a centre, a row each: normal with `spread` as the root of their covariance, in
/// pairs opposite each other, none farther than 1.5 roots of their dimension, mirrored at bounds.
Eigen::MatrixXd scattered(const Eigen::VectorXd& centre, const Eigen::MatrixXd& spread, int count,
                          const FitBounds& bounds, std::uint64_t seed);

/// The spread of a design: so many standard errors of a covariance, along no axis more than `most`.
Eigen::MatrixXd spread_of(const Eigen::MatrixXd& covariance, double errors,
                          const Eigen::VectorXd& most);

/// Points and the statistics of their simulations; empty rows are worlds that diverged and are
/// left out. Throws InputError if these are more than half.
Design design_of(const Eigen::MatrixXd& points, const std::vector<std::vector<double>>& rows);

/// The rows of both, one below the other.
Design joined(const Design& above, const Design& below);

/// All rows but those of one fold, which are every `folds`-th from `fold` on.
Eigen::MatrixXd rows_without_fold(const Eigen::MatrixXd& of, int fold, int folds);
/// The same of points and numbers.
/// With these numbers alone.
Design with_columns(const Design& design, const std::vector<Eigen::Index>& columns);
Design without_fold(const Design& design, int fold, int folds);

/// Correlations of columns, drawn towards none by their summed sampling variance over their summed
/// squares, at least by `least` [Schaefer and Strimmer, Stat. Appl. Genet. Mol. Biol. 4, 2005].
/// `z`: an observation a row, divided by the deviations.
Eigen::MatrixXd shrunk_correlations(const Eigen::MatrixXd& z, double least = 0);

}  // namespace lilytank
