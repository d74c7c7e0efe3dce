// What `lilytank prove` does with --grid.
#pragma once
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "lilytank/proof.hpp"

namespace lilytank::cli {

/// `proof`: from the command line, without a directory; `cells`: the values of --cells.
int prove_on_grid(const VerbOptions& options, const ProofOptions& proof,
                  const std::vector<std::string>& cells, const Arguments& arguments, bool quiet,
                  const Host& host);

}  // namespace lilytank::cli
