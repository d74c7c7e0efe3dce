#include "optimize/repeats.hpp"

#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "lilytank/study.hpp"
#include "study/row_log.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string header_for(const std::vector<double>& point) {
  std::string out = "replicate,value at";
  for (const double x : point) out += " " + shortest(x);
  return out + std::string(kChecksumColumn);
}

std::string row_for(std::int64_t replicate, double value) {
  return std::to_string(replicate) + "," + (std::isinf(value) ? "inf" : shortest(value));
}

Incumbent mean_of(const std::vector<double>& point, const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += std::pow(value - sum / n, 2);
  return {point, sum / n, std::sqrt(squares / (n - 1) / n), static_cast<int>(values.size())};
}

}  // namespace

Incumbent repeated(const Optimization::Source& source, const std::vector<double>& point,
                   std::int64_t first, int count, const std::string& file,
                   const OptimizationOptions& options) {
  const std::string header = header_for(point);
  std::vector<double> values(static_cast<std::size_t>(count), std::nan(""));
  make_directory(std::filesystem::path(file).parent_path().string());
  std::string before = RowLog::rows_in(file);
  if (!before.starts_with(header + "\n")) before.clear();
  if (!before.empty()) {
    CsvReader csv(before, file, {header});
    while (csv.next()) {
      const std::int64_t i = csv.whole(0, first, INT64_MAX) - first;
      if (i >= count) continue;
      values[static_cast<std::size_t>(i)] = csv.text(1) == "inf" ? INFINITY : csv.number(1);
    }
  }
  RowLog log(file, header + "\n", before);
  const auto one = [&](int i) {
    double& value = values[static_cast<std::size_t>(i)];
    if (!std::isnan(value)) return;
    value = source.evaluate({point, first + i}, options);
    log.append(row_for(first + i, value));
  };
  for_each_world(count, options.threads, one, options);
  // In their order, whichever thread was first.
  std::string text = header + "\n";
  for (int i = 0; i < count; ++i) {
    text += with_checksum(row_for(first + i, values[static_cast<std::size_t>(i)])) + "\n";
  }
  write_atomically(file, text);
  return mean_of(point, values);
}

}  // namespace lilytank
