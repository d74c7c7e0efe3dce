// How much noise changes the order of samples [Hansen et al. 2009].
#pragma once
#include <vector>

namespace lilytank {

/// The uncertainty s of a generation [IEEE Trans. Evolutionary Computation 13 (1), 2009, algorithm
/// 1, steps 3 and 4, theta = 0.2]: `first` are all samples' means, `second` those of the first few
/// of them evaluated anew. Ranks are taken among both together; s > 0 where they change by more
/// than a fifth of what pure chance would do. Equal values rank in order.
double rank_change(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace lilytank
