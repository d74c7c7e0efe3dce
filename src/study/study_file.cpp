#include "study/study_file.hpp"

#include <algorithm>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_values.hpp"
#include "io/standard_input.hpp"
#include "io/toml_fields.hpp"
#include "study/study_axis.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMostReplicates = 10'000'000;
constexpr std::int64_t kMostSamples = 100'000;
constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000'000;

void check_metric(const std::string& name, const SourcePlace& place) {
  if (is_metric(name)) return;
  const std::vector<std::string> names{"copies", "full_yield", "assembly_rate", "time_1"};
  throw InputError(place, "unknown metric '" + name + "' - there are copies, full_yield, " +
                              "assembly_rate, time_1, time_2, ..." + did_you_mean(name, names));
}

class Reader {
 public:
  explicit Reader(const std::string& file)
      : file_(file),
        directory_(fs::path(file).parent_path().string()),
        root_(parse_toml(read_whole(file), file)) {}

  StudyFile read() {
    const TomlFields top(root_, "", file_, study_file_keys());
    if (!top.has("study")) throw InputError({file_, 1, 1}, "there is no [study] table");
    study(top.fields("study"));
    if (top.has("stop")) stop(top.fields("stop"));
    if (out_.replicates < 0) {
      throw InputError(top.place("study"),
                       "study.replicates is missing: the number of simulations of each setting");
    }
    for (const TomlFields& axis : top.list_of_fields("axis")) {
      out_.axes.push_back(read_axis(axis, directory_));
      check_axis(top);
    }
    const bool latin = std::any_of(out_.axes.begin(), out_.axes.end(), [](const StudyAxis& axis) {
      return axis.range && axis.range->latin;
    });
    if (out_.samples > 0 && !latin) {
      throw InputError(samples_place_, "study.samples goes with an axis that has latin");
    }
    return std::move(out_);
  }

 private:
  void study(const TomlFields& fields) {
    out_.name = fields.has("name") ? fields.text("name") : stem_of(file_);
    check_name(out_.name, "study.name", fields.place("name"));
    for (const auto& [name, place] : fields.texts("scenario")) {
      const std::string path = (fs::path(directory_) / name).string();
      static_cast<void>(read_whole(path, place));  // the message should point here
      out_.scenarios.push_back(path);
    }
    if (fields.has("seed")) out_.seed = static_cast<std::uint64_t>(fields.whole("seed"));
    out_.until_settled = fields.has("until") && fields.word("until") == 1;
    out_.replicates = -1;
    if (fields.has("replicates")) {
      out_.replicates = static_cast<int>(fields.whole("replicates"));
      replicates_place_ = fields.place("replicates");
    }
    if (fields.has("samples")) {
      out_.samples = static_cast<int>(fields.whole("samples"));
      samples_place_ = fields.place("samples");
    }
  }

  void stop(const TomlFields& fields) {
    StoppingRule rule;
    rule.metric = fields.text("metric");
    out_.stop_place = fields.place("metric");
    check_metric(rule.metric, out_.stop_place);
    const std::string unit = metric_unit(rule.metric);
    rule.half_width = fields.number("half_width", unit);
    if (!(rule.half_width > 0)) {
      fields.refuse("half_width",
                    "stop.half_width = " + shortest(rule.half_width) + " is not above 0");
    }
    if (out_.replicates >= 0) {
      throw InputError(replicates_place_,
                       "study.replicates is a fixed number; with [stop] give stop.max instead");
    }
    rule.max = static_cast<int>(fields.whole("max"));
    rule.min = std::min(rule.max, 20);
    if (fields.has("min")) rule.min = static_cast<int>(fields.whole("min", 2, rule.max));
    rule.round = 10;
    if (fields.has("round")) rule.round = static_cast<int>(fields.whole("round"));
    out_.replicates = rule.max;
    out_.stop = rule;
  }

  /// The last axis against the ones before and against study.samples.
  void check_axis(const TomlFields& top) const {
    const StudyAxis& last = out_.axes.back();
    for (const StudyAxis& axis : out_.axes) {
      if (&axis == &last) continue;
      const bool same_path = !axis.path.keys.empty() && axis.path.keys == last.path.keys;
      if (axis.name == last.name || same_path) {
        throw InputError(last.place, "there is an axis '" + axis.name + "' already");
      }
    }
    if (last.range && last.range->latin && out_.samples == 0) {
      throw InputError(top.place("study"),
                       "study.samples is missing: how many points of the latin hypercube");
    }
  }

  std::string file_, directory_;
  toml::table root_;
  StudyFile out_;
  SourcePlace replicates_place_, samples_place_;
};

}  // namespace

TomlKeys study_file_keys() {
  using namespace toml_key;
  const TomlKeys study{
      text("name", "names files and the report (default: the file's name)"),
      needed(texts("scenario", "a scenario file, or a list with its overlays")),
      whole("replicates", 1, kMostReplicates,
            "simulations of each setting, unless there is [stop]"),
      whole("seed", 0, kLargestSeed, "where the seeds of the replicates come from (1)"),
      whole("samples", 1, kMostSamples, "points of the latin hypercube"),
      word("until", {"end", "settled"},
           "simulate to run.duration, or until all possible copies are completed"),
  };
  const TomlKeys stop{
      needed(text("metric", "whose interval is to be narrow, as copies")),
      needed(quantity("half_width", "how narrow: half of the 95 % interval")),
      needed(whole("max", 2, kMostReplicates, "the most replicates of a setting")),
      whole("min", 2, kMostReplicates, "the fewest replicates (20)"),
      whole("round", 1, kMostReplicates, "replicates between two looks at the interval (10)"),
  };
  return {table("study", study, "what is simulated"),
          table("stop", stop, "replicates until an interval is narrow"),
          tables("axis", axis_keys(), "what is varied")};
}

StudyFile read_study_file(const std::string& file) {
  return Reader(file).read();
}

}  // namespace lilytank
