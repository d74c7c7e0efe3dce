#include "optimize/comparison.hpp"

#include <filesystem>
#include <map>

#include "io/scenario_values.hpp"
#include "lilytank/study.hpp"
#include "optimize/assignments.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

/// A list of TOML texts.
std::string list_of(const std::vector<std::string>& words) {
  return "[" + joined(words, ", ", toml_quoted) + "]";
}

}  // namespace

void check_comparison(const Optimization::Source& source) {
  const CompareTable& compare = source.file.compare;
  StudyPlan plan;
  plan.seed = compare.seed;
  std::map<std::uint64_t, std::string> seen;
  for (std::size_t i = 0; i < compare.overlays.size(); ++i) {
    const std::string& label = compare.labels[i];
    const Scenario scenario = source.with_overlay(compare.overlays[i]);
    const auto [same, fresh] = seen.emplace(scenario.identity, label);
    if (!fresh) {
      throw InputError(
          place_in(source.file.hybrid_place.file, {"compare.overlays"}),
          "overlays '" + same->second + "' and '" + label + "' make one and the same scenario");
    }
    try {
      initial_state(scenario.model, plan.seed_of(0));  // do the bodies fit?
    } catch (const InputError& e) {
      throw InputError(label + ": " + e.what());
    }
  }
}

OptimumComparison comparison_with(const Optimization::Source& source, const std::string& optimum) {
  const CompareTable& compare = source.file.compare;
  const fs::path here = fs::path(optimum).parent_path();
  const auto from_here = [&](const std::string& file) {
    return fs::proximate(file, here).generic_string();
  };
  OptimumComparison out;
  std::vector<std::string> scenarios, overlays{from_here(optimum)}, labels{"optimum"};
  for (const std::string& file : source.plan.scenarios) scenarios.push_back(from_here(file));
  const std::uint64_t identity = source.with_overlay(optimum).identity;
  for (std::size_t i = 0; i < compare.overlays.size(); ++i) {
    if (source.with_overlay(compare.overlays[i]).identity == identity) {
      out.left_out.push_back(compare.labels[i]);
      continue;
    }
    overlays.push_back(from_here(compare.overlays[i]));
    labels.push_back(compare.labels[i]);
  }
  out.text = "# The optimum beside what it is compared with.\n";
  if (!out.left_out.empty()) {
    out.text +=
        "# Left out, since it is the optimum's own scenario: " + list_of(out.left_out) + "\n";
  }
  out.text +=
      "[study]\nname = " + toml_quoted(source.plan.name + "_compare") +
      "\nscenario = " + list_of(scenarios) +
      "\nreplicates = " + std::to_string(compare.replicates) +
      "\nseed = " + std::to_string(compare.seed) +
      "\nuntil = \"settled\"\n\n[[axis]]\nname = \"strategy\"\noverlays = " + list_of(overlays) +
      "\nlabels = " + list_of(labels) + "\n";
  return out;
}

}  // namespace lilytank
