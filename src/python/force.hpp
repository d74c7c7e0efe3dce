// Forces that Python adds to a scenario.
#pragma once
#include <pybind11/pybind11.h>

#include <exception>
#include <memory>
#include <vector>

#include "lilytank/scenario.hpp"

namespace lilytank::python {

/// A scenario with terms of its own. The terms' model must not outlive it.
class ExtendedScenario {
 public:
  /// `functions` are called as f(time, bodies) for the wrenches on all bodies. With `applies`, the
  /// array applied() is added as well.
  ExtendedScenario(const Scenario& scenario, const std::vector<pybind11::function>& functions,
                   bool applies);
  ~ExtendedScenario();
  const Scenario& scenario() const { return scenario_; }
  /// [bodies * 3] Force (N) and torque (N m) on each body; empty without `applies`.
  std::vector<double>& applied() { return applied_; }
  /// Throws the first exception of a function. Until then its term adds nothing.
  void check() const;
  /// Whether a function has thrown.
  bool failed() const;

 private:
  class Function;
  class Applied;
  Scenario scenario_;
  std::vector<double> applied_;
  std::vector<std::unique_ptr<const ForceTerm>> terms_;
  mutable std::exception_ptr failure_;
};

}  // namespace lilytank::python
