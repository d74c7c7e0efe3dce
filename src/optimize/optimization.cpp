// The public face: everything is the Source's.
#include "io/scenario_layers.hpp"
#include "optimize/comparison.hpp"
#include "optimize/race.hpp"
#include "optimize/source.hpp"

namespace lilytank {

Optimization::Optimization(const std::string& file, const std::vector<std::string>& overlays,
                           std::vector<std::string> sets) {
  const auto seed = take_seed(sets);
  auto source = std::make_unique<Source>(read_optimize_file(file, seed), overlays, std::move(sets));
  check_comparison(*source);
  if (source->file.race) {
    source->contestants = contestants_of(*source);
    source->plan.rulesets = static_cast<int>(source->contestants.size());
    source->plan.budget += race_evaluations(source->plan.rulesets, source->file.race->evaluations);
  }
  source_ = std::move(source);
}
Optimization::~Optimization() = default;
Optimization::Optimization(Optimization&&) noexcept = default;

const OptimizationPlan& Optimization::plan() const {
  return source_->plan;
}
Scenario Optimization::scenario(const std::vector<double>& point) const {
  return source_->scenario(point);
}
double Optimization::evaluate(const Trial& trial, const JobControl& control) const {
  return source_->evaluate(trial, control);
}
std::unique_ptr<Search> Optimization::search() const {
  return source_->search();
}
std::vector<Scenario::Attachment> Optimization::overlay(const std::vector<double>& point,
                                                        const std::string& stem,
                                                        const std::string& comment) const {
  return source_->overlay(point, stem, comment);
}
std::string Optimization::identity() const {
  return source_->identity();
}

}  // namespace lilytank
