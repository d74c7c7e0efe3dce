// The text of run.until_metric.
#pragma once
#include <string>

#include "lilytank/scenario.hpp"

namespace lilytank {

/// "singles <= 2" as a bound, for that many modules. Throws InputError with what is wrong.
EndMetric end_metric(const std::string& text, int modules);

}  // namespace lilytank
