// The parts that analyse() is made of.
#pragma once
#include "lilytank/analysis.hpp"

namespace lilytank {

/// A source with all that its numbers are made from.
struct SmoothSource {
  const AnalysisSource* source = nullptr;
  std::vector<SmoothRecording> recordings;  ///< empty if only displacements are analysed
  std::vector<Contacts> contacts;           ///< a recording; empty for points
};

/// The sums of a source's recordings together.
template <class Recordings, class SumsOf>
BodySums together(const Recordings& recordings, const SumsOf& sums_of) {
  BodySums all;
  for (const auto& recording : recordings) all.append(sums_of(recording));
  return all;
}

/// All numbers of a source; `msd` and `turns` over `lags` (s), from all origins.
SourceSummary summarise_source(const SmoothSource& source, const BodySums& msd,
                               const BodySums& turns, const std::vector<double>& lags,
                               const AnalysisOptions& options);
/// Of the first two sources.
SourceComparison compare_sources(const Analysis& analysis);

}  // namespace lilytank
