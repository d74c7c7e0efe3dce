// From a point of a search to a scenario.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/scenario_layers.hpp"
#include "lilytank/optimize.hpp"
#include "optimize/optimize_file.hpp"

namespace lilytank {

class ScenarioText;

struct Optimization::Source {
  Source(OptimizeFile what, std::vector<std::string> overlays, std::vector<std::string> sets);
  /// The same with another ruleset in place of the scenario's own, and a space with the names of
  /// its rules. Throws InputError.
  Source(const Source& other, Ruleset instead);

  /// With another ruleset it is the model that has it; entries and texts stay as they are.
  Scenario scenario(const std::vector<double>& point) const;
  double evaluate(const Trial& trial, const JobControl& control) const;
  /// CMA-ES with another budget, start and first sigma.
  std::unique_ptr<Search> cma_es(std::int64_t budget, const std::vector<double>& start,
                                 double sigma) const;
  /// The search of the ruleset that has won a race, from its best point.
  std::unique_ptr<Search> winners_search(const std::vector<double>& start) const;
  /// Evaluations of a first generation of CMA-ES.
  std::int64_t generation() const;
  std::unique_ptr<Search> search() const;
  std::vector<Scenario::Attachment> overlay(const std::vector<double>& point,
                                            const std::string& stem,
                                            const std::string& comment) const;
  std::string identity() const;
  /// What a study makes of the scenario's files with one more laid over them, with run.seed = 0.
  /// Throws InputError.
  Scenario with_overlay(const std::string& overlay) const;
  /// All files that are read.
  std::vector<std::string> inputs() const;

  OptimizeFile file;
  OptimizationPlan plan;
  std::optional<Ruleset> ruleset;  ///< in place of the scenario's own
  /// Of a race: one for each of its rulesets, the scenario's own first.
  std::vector<std::unique_ptr<const Source>> contestants;

 private:
  /// What an axis of the space sets.
  enum class Use { parameter, after_p, after_copies, power, change };
  struct Axis {
    Use use = Use::parameter;
    Assignment path;         ///< of parameter and after_p
    bool whole = false;      ///< rounded
    std::size_t number = 0;  ///< of power and change
  };
  /// A point with everything rounded that is, and times of change in order.
  struct DecodedPoint {
    std::vector<Assignment> values;                     ///< the scenario's
    std::vector<std::pair<std::string, double>> after;  ///< rules of the second set and their p
    int after_copies = 0;                               ///< 0: no second set
    std::vector<double> powers, changes;                ///< % and s
  };

  void check_names() const;
  void prepare();
  void check_base(const Model& model) const;
  void add_parameter(const OptimizeParameter& parameter, const Scenario& base);
  void add_axis(SearchAxis axis, Axis use, double start);
  void add_second_set();
  void add_agitation(const Scenario& base);
  void check_overrides() const;
  void check_corners() const;
  std::int64_t checked_budget() const;
  Scenario built(Layer point) const;
  DecodedPoint decoded(const std::vector<double>& point) const;
  Layer layer(const DecodedPoint& point) const;
  Ruleset second_set(const DecodedPoint& point, const Ruleset& first) const;
  void add_commands(const DecodedPoint& point, const std::string& after_file,
                    ScenarioText& out) const;

  std::vector<std::string> files_;  ///< scenarios and overlays
  std::vector<Layer> base_;
  Layer overrides_;
  std::vector<Axis> axes_;
};

}  // namespace lilytank
