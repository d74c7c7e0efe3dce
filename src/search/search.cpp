#include "lilytank/search.hpp"

#include <algorithm>

#include "search/cma_es.hpp"
#include "search/swarm.hpp"
#include "text/refusals.hpp"

namespace lilytank {

double Search::done() const {
  return std::min(1.0, static_cast<double>(evaluations()) / static_cast<double>(budget()));
}

SwarmOptions swarm_for(std::int64_t budget, int particles) {
  SwarmOptions options;
  const std::int64_t last = budget / 10 >= 4 ? budget / 10 : 0;
  const std::int64_t cost =
      std::max(std::int64_t{particles} * options.evaluations, std::int64_t{1});
  options.particles = particles;
  options.iterations = static_cast<int>(std::max((budget - last) / cost, std::int64_t{1}));
  options.final_evaluations = static_cast<int>(last);
  return options;
}

CmaEsOptions cma_es_for(std::int64_t budget) {
  CmaEsOptions options;
  options.budget = budget;
  options.final_evaluations = budget / 10 >= 4 ? static_cast<int>(budget / 10) : 0;
  return options;
}

std::unique_ptr<Search> make_swarm(SearchSpace space, SwarmOptions options, std::uint64_t seed) {
  return std::make_unique<Swarm>(std::move(space), std::move(options), seed);
}

std::unique_ptr<Search> make_cma_es(SearchSpace space, CmaEsOptions options, std::uint64_t seed) {
  return std::make_unique<CmaEs>(std::move(space), std::move(options), seed);
}

std::unique_ptr<Search> restore_search(std::string_view bytes, const std::string& file) {
  StateReader in(bytes, file);
  const auto restore = [&]() -> std::unique_ptr<Search> {
    if (in.kind() == kSwarmKind) return std::make_unique<Swarm>(in);
    if (in.kind() == kCmaEsKind) return std::make_unique<CmaEs>(in);
    return nullptr;
  };
  if (auto search = refusals_of(file, restore)) return search;
  throw InputError(SourcePlace{file, 1, 1}, "no search is called '" + in.kind() + "'");
}

}  // namespace lilytank
