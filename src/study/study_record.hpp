// study.toml: a study's plan, as its directory keeps it.
#pragma once
#include <string>

#include "lilytank/study.hpp"

namespace lilytank {

/// The plan as TOML; the same text for the same plan.
std::string plan_text(const StudyPlan& plan);
/// Whether a text is the work of plan_text(), and not a study file of the user's.
bool is_plan(const std::string& text);
/// Reads it back. Throws InputError.
StudyPlan read_plan(const std::string& file);

}  // namespace lilytank
