// The tank that all experiments of a proof share, what is open about it, and the experiments.
#pragma once
#include <string>
#include <vector>

#include "lilytank/experiment.hpp"
#include "lilytank/proof.hpp"
#include "proof/sealed.hpp"

namespace lilytank {

/// A null experiment takes as long as so many simulated experiments, on the average.
inline constexpr double kOfANull = 6;

/// The built-in tank, or the one that is drawn from the seed.
Model tank_of(const ProofOptions& options);
/// The open part of the exam: balls, and Lilies in which nothing is missing. Throws InputError if
/// the tank diverges.
Experiment open_tank(const ProofOptions& options, const Model& tank);
/// "latches on with the rules chain5, events logged"; "" where they are off. Throws InputError.
std::string words_for_latches(const ProofOptions& options);
/// Its lines of the key; nothing else about a drawn tank is printed before the key is opened.
std::string key_of_tank(const ProofOptions& options);
/// Proof::tank.
std::string words_for_tank(const ProofOptions& options);
/// The experiments of the requested kind. Throws InputError if there are none, or on an effect that
/// the tank cannot have.
std::vector<Sealed> requested(const ProofOptions& options, const Model& tank,
                              const std::vector<Shape>& shapes, std::uint64_t seed);

}  // namespace lilytank
