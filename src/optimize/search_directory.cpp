#include "optimize/search_directory.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/search_run.hpp"
#include "study/search_store.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

const std::string kAdvice = "; choose another directory, or --force to replace it";

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

}  // namespace

std::string race_identity_file(const std::string& dir) {
  return (fs::path(dir) / "race" / "identity.txt").string();
}

std::string race_identity(const Optimization::Source& source) {
  return source.identity() + " " + std::to_string(source.file.race->rulesets) + " " +
         std::to_string(source.file.race->evaluations) + " " + std::to_string(source.plan.seed) +
         "\n";
}

void check_search_directory(const Optimization::Source& source, const std::string& dir,
                            bool force) {
  if (force) return;
  const std::string race = race_identity_file(dir);
  if (source.file.race && is_there(race)) {
    if (read_whole(race) == race_identity(source)) return;  // the search is of a winner yet unknown
    throw InputError("'" + dir + "' holds another race" + kAdvice);
  }
  const fs::path state = fs::path(dir) / search_file::state;
  if (is_there(state)) {
    if (!source.file.race &&
        is_search_of(read_whole(state.string()), source.identity(), *source.search()))
      return;
    throw InputError("'" + dir + "' holds another search" + kAdvice);
  }
  for (const char* name : {search_file::evaluations, search_file::history}) {
    if (!is_there(fs::path(dir) / name)) continue;
    throw InputError("'" + dir + "' holds a file '" + name + "' that is not of a search" + kAdvice);
  }
}

}  // namespace lilytank
