// Which part of a study a process does.
#include <cstdlib>

#include "lilytank/study.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr int kMostShards = 1'000'000;
constexpr std::int64_t kMostNumber =
    1'000'000'000'000;  // of a task; their differences do not overflow

using Lookup = std::function<const char*(const char*)>;

/// A whole number of the environment, or `otherwise` where the variable is not there.
std::int64_t number_of(const Lookup& variable, const char* name, std::int64_t otherwise) {
  const char* text = variable(name);
  if (text == nullptr) return otherwise;
  const auto value = parse_whole(text);
  if (value && *value >= -kMostNumber && *value <= kMostNumber) return *value;
  throw InputError(std::string("the environment's ") + name + "='" + text + "' is " +
                   (value ? "out of range" : "not a whole number") + "; give --shard i/n");
}

/// Part `index` of `count`, named by two variables.
Shard checked(std::int64_t index, std::int64_t count, const std::string& index_name,
              const std::string& count_name) {
  if (count >= 1 && count <= kMostShards && index >= 0 && index < count) {
    return {static_cast<int>(index), static_cast<int>(count), index_name};
  }
  throw InputError("the environment's " + index_name + " is part " + std::to_string(index + 1) +
                   " of " + count_name + "=" + std::to_string(count) + "; give --shard i/n");
}

Shard of_array(const Lookup& variable) {
  const std::int64_t id = number_of(variable, "SLURM_ARRAY_TASK_ID", 0);
  const std::int64_t least = number_of(variable, "SLURM_ARRAY_TASK_MIN", 0);
  const std::int64_t step = number_of(variable, "SLURM_ARRAY_TASK_STEP", 1);
  if (variable("SLURM_ARRAY_TASK_COUNT") == nullptr) {
    throw InputError(
        "SLURM_ARRAY_TASK_ID is set, but not SLURM_ARRAY_TASK_COUNT; "
        "give --shard i/n");
  }
  if (step < 1 || (id - least) % step != 0) {
    throw InputError("the array's task numbers are not in equal steps; give --shard i/n");
  }
  return checked((id - least) / step, number_of(variable, "SLURM_ARRAY_TASK_COUNT", 1),
                 "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT");
}

/// The processes of one start. mpirun's own variables come first: within a job its processes see
/// the numbers of the job's script as well. A job's script by itself is process 0 of all that the
/// job might start, but there are no others: without srun, it is not a part.
Shard of_launcher(const Lookup& variable) {
  constexpr const char* pairs[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                      {"SLURM_PROCID", "SLURM_NTASKS"}};
  const bool script = variable("SLURM_JOB_ID") != nullptr && variable("SLURM_STEP_ID") == nullptr;
  for (const auto& [rank, size] : pairs) {
    if (variable(rank) == nullptr || variable(size) == nullptr) continue;
    if (script && rank == std::string_view("SLURM_PROCID")) continue;
    return checked(number_of(variable, rank, 0), number_of(variable, size, 1), rank, size);
  }
  return {};
}

}  // namespace

bool Shard::holds(const std::string& id) const {
  return std::strtoull(id.c_str(), nullptr, 16) % static_cast<std::uint64_t>(count) ==
         static_cast<std::uint64_t>(index);
}

Shard shard_from(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = parse_whole(std::string_view(text).substr(0, slash));
  const auto count = slash == std::string::npos
                         ? std::nullopt
                         : parse_whole(std::string_view(text).substr(slash + 1));
  if (!index || !count) throw InputError("--shard " + text + " is not of the form i/n, as 2/5");
  if (*count < 1 || *count > kMostShards || *index < 1 || *index > *count) {
    throw InputError("--shard " + text + ": shards are 1/n to n/n, with n up to " +
                     std::to_string(kMostShards));
  }
  return {static_cast<int>(*index - 1), static_cast<int>(*count), "--shard"};
}

Shard shard_of_environment(const std::function<const char*(const char*)>& variable) {
  const Shard inner = of_launcher(variable);
  if (variable("SLURM_ARRAY_TASK_ID") == nullptr) return inner;
  const Shard array = of_array(variable);
  if (inner.count == 1) return array;
  // Several processes in each task of an array.
  return checked(std::int64_t{array.index} * inner.count + inner.index,
                 std::int64_t{array.count} * inner.count, array.origin + " and " + inner.origin,
                 "the number of processes");
}

}  // namespace lilytank
