// The laws that a report names, with their numbers in its units.
#pragma once
#include "bodies/verdict.hpp"

namespace lilytank::bodies {

/// The experiment's unit for a law's parameter: forces are per mass where masses are unknown.
std::string unit_for(const BodyExperiment& experiment, std::string unit);

/// " of NAME"; "" of a group of all runs.
std::string of_group(const Group& group);

/// The name of a term's parameter: of forces by drivers the driver's own and the axis.
std::string name_of(const BodyExperiment& experiment, const Term& term, std::size_t number);

/// A parameter of a fit; where it is fitted, with its 95 % interval.
FoundParameter parameter_of(const Comparison& comparison, std::size_t group, const Fitted& fit,
                            const TermParameter& of);

/// A finding for each of the reported laws, by their gains.
std::vector<DiagnosisFinding> findings(const Comparison& comparison);

}  // namespace lilytank::bodies
