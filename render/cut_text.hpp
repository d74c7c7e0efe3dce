// Texts that are cut to the room there is.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace lilytank {

using TextWidth = std::function<double(const std::string&)>;

/// A text no wider than `widest`: its beginning and "…" if it is longer.
std::string begin_within(const std::string& s, double widest, const TextWidth& width);

/// The text in lines no wider than `widest`, broken at spaces; words that are wider are cut.
std::vector<std::string> lines_within(const std::string& s, double widest, const TextWidth& width);

/// The names, each no wider than `widest` by `width`, and no two alike that are not: those that are
/// too wide lose their ends or, if some would read alike then, their beginnings ("…" stands for
/// them); where that is no better, all are numbered from 1 and lose their ends.
std::vector<std::string> cut_apart(const std::vector<std::string>& names, double widest,
                                   const TextWidth& width);

}  // namespace lilytank
