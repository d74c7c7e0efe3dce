// Names that fit a legend.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace lilytank {

/// The names, each no wider than `widest` by `width`, and no two alike that are not: those that are
/// too wide lose their ends or, if some would read alike then, their beginnings ("…" stands for
/// them); where that is no better, all are numbered from 1 and lose their ends.
std::vector<std::string> cut_apart(const std::vector<std::string>& names, double widest,
                                   const std::function<double(const std::string&)>& width);

}  // namespace lilytank
