// What all experiments of a proof share: the tank, and what is open about it.
#pragma once
#include <string>

#include "lilytank/experiment.hpp"
#include "lilytank/proof.hpp"

namespace lilytank {

/// A null experiment takes as long as so many simulated experiments, on the average.
inline constexpr double kOfANull = 6;

/// The built-in tank, or the one that is drawn from the seed.
Model tank_of(const ProofOptions& options);
/// The open part of the exam: balls, and Lilies in which nothing is missing. Throws InputError if
/// the tank diverges.
Experiment open_tank(const ProofOptions& options, const Model& tank);
/// Its lines of the key; nothing else about a drawn tank is printed before the key is opened.
std::string key_of_tank(const ProofOptions& options);
/// Proof::tank.
std::string words_for_tank(const ProofOptions& options);

}  // namespace lilytank
