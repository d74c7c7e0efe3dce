// The joint fit of findings and baseline, and its test on held-out recordings.
#pragma once
#include <vector>

#include "finder/judgement.hpp"

namespace lilytank {

/// Adds the baseline's parameters to `out`: with intervals, by nulls, where nothing is missing.
/// Returns all that are calibrated, as the baseline alone has them.
std::vector<double> report_baseline(const PreparedTank& tank, const Judged& judged, Diagnosis& out);

/// Fits the findings jointly with the baseline and adds parameters, overlay and the comparison
/// before and after on `held_out`, recordings that had no part in the verdict. Throws Stopped.
void fit_findings(PreparedTank& tank, const Judged& judged, const std::vector<Recording>& held_out,
                  Diagnosis& out);

}  // namespace lilytank
