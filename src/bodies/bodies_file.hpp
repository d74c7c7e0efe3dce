// Files of experiments of point bodies; their tables are read elsewhere.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/toml_key.hpp"
#include "lilytank/bodies.hpp"
#include "lilytank/table_layout.hpp"

namespace lilytank {

/// A name with its place in the file.
struct NamedAt {
  std::string name;
  SourcePlace place;
};

/// Numbers of bodies: one for all, one a column in wide tables, or by name.
struct BodyFigures {
  std::vector<double> values;
  std::map<std::string, double> by_name;
  SourcePlace place;
  bool given() const { return !values.empty() || !by_name.empty(); }
};

/// A [[recording]].
struct BodyTable {
  std::string file;
  SourcePlace place;
  NamedAt time, body, run;
  std::optional<double> time_unit;  ///< s per unit of times
  TableLayout layout;
  std::vector<NamedAt> x, y, drivers;
  BodyFigures mass, radius;
  double scale = 1;  ///< m (or the experiment's unit) for 1 in the columns of positions
  int every = 1;     ///< one row in so many is taken, of each run
  bool together = false, held_out = false;
};

struct BodyFile {
  BodyExperiment experiment;  ///< without runs
  std::vector<BodyTable> tables;
  NamedAt latitude;
  std::vector<NamedAt> current, wind;
};

/// The most bodies that are followed together: the filter carries eight coordinates.
constexpr std::size_t most_together(int dimensions) {
  return dimensions == 1 ? 8 : 4;
}

/// The keys of such a file.
TomlKeys body_file_keys(const std::vector<std::string>& laws);
/// The laws that [baseline] may have besides contact.
std::vector<std::string> baseline_laws();

/// Throws InputError. `laws` are the words that [baseline] may have besides contact.
BodyFile read_body_file(const std::string& file, const std::vector<std::string>& laws);

}  // namespace lilytank
