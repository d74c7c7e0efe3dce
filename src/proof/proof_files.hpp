// Experiments that a proof has diagnosed, kept in its directory's work: a proof that was stopped
// goes on with the next one.
#pragma once
#include <string>
#include <vector>

#include "lilytank/proof.hpp"

namespace lilytank {

/// Writes the experiments diagnosed so far; nothing if `dir` is empty. Throws InputError.
void keep_worlds(const std::string& dir, const Proof& so_far);

/// Those kept there of this key, from the first; none of another key's. Throws InputError where
/// they are damaged.
std::vector<ProofWorld> kept_worlds(const std::string& dir, const Proof& of);

}  // namespace lilytank
