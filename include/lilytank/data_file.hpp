// Stored results for other programs: arrays in NetCDF, provenance in an RO-Crate.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lilytank {

/// Name and text.
using DataAttributes = std::vector<std::pair<std::string, std::string>>;

/// An array. `dimensions` are names of its group's dimensions, the slowest first; the values have
/// as many elements as these have together.
struct DataVariable {
  std::string name;
  std::vector<std::string> dimensions;
  /// NaN stands for an empty cell of a column of numbers.
  std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>,
               std::vector<std::int16_t>, std::vector<std::int8_t>, std::vector<std::string>>
      values;
  DataAttributes attributes = {};  ///< "units", "long_name"
};

struct DataGroup {
  std::string name;
  std::vector<std::pair<std::string, std::size_t>> dimensions;  ///< name and length
  std::vector<DataVariable> variables;
};

/// A whole file.
struct DataFile {
  DataAttributes attributes;
  std::vector<DataGroup> groups;
};

/// Results in a directory: a group for each table (*.csv), named as the table, with a variable for
/// each column along the dimension "row"; of a run the group "trajectory" with the dimensions
/// "frame" and "body". A column of whole numbers without empty cells is int64, but for times; one
/// of numbers is float64, else text. Throws InputError if there are no tables, or one is damaged.
DataFile data_of_results(const std::string& dir);

/// The bytes of a NetCDF-4 file: a group of the file for each group, numbers deflated. Equal data
/// give equal bytes. Throws InputError if the program was built without the NetCDF library.
std::string netcdf(const DataFile& data);

/// Name of the file that describes a directory as an RO-Crate.
inline constexpr const char* kCrateFile = "ro-crate-metadata.json";
/// That file for a directory of results: RO-Crate 1.1, Process Run Crate 0.5. It lists every file
/// with its SHA-256, the inputs with theirs, the command, its seed and the program's version, as
/// the report in the directory has them. `license`: of the data, an address; "" for none. Throws
/// InputError if the directory holds no report with its provenance.
std::string crate_of_results(const std::string& dir, const std::string& license);

}  // namespace lilytank
