#include "lilytank/search.hpp"

#include <algorithm>

#include "search/cma_es.hpp"
#include "search/swarm.hpp"

namespace lilytank {

double Search::done() const {
  return std::min(1.0, static_cast<double>(evaluations()) / static_cast<double>(budget()));
}

std::unique_ptr<Search> make_swarm(SearchSpace space, SwarmOptions options, std::uint64_t seed) {
  return std::make_unique<Swarm>(std::move(space), std::move(options), seed);
}

std::unique_ptr<Search> make_cma_es(SearchSpace space, CmaEsOptions options, std::uint64_t seed) {
  return std::make_unique<CmaEs>(std::move(space), std::move(options), seed);
}

std::unique_ptr<Search> restore_search(std::string_view bytes, const std::string& file) {
  StateReader in(bytes, file);
  if (in.kind() == kSwarmKind) return std::make_unique<Swarm>(in);
  if (in.kind() == kCmaEsKind) return std::make_unique<CmaEs>(in);
  throw InputError(SourcePlace{file, 1, 1}, "no search is called '" + in.kind() + "'");
}

}  // namespace lilytank
