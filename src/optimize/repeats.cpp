#include "optimize/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "lilytank/study.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr int kKeptTogether = 64;  // worlds that a kill may cost

/// Values of one point, and their file. A file of another point begins anew.
struct Repeats {
  Repeats(const std::vector<double>& of, std::int64_t from, int count, std::string to)
      : point(of), first(from), file(std::move(to)), values(static_cast<std::size_t>(count)) {
    header = "replicate,value at";
    for (const double x : point) header += " " + shortest(x);
    header += kChecksumColumn;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return;
    const std::string text = read_whole(file);
    if (!text.starts_with(header + "\n")) return;
    CsvReader csv(text, file, {header});
    while (csv.next()) {
      const std::int64_t i = csv.whole(0, first, INT64_MAX) - first;
      if (i >= count) continue;
      values[static_cast<std::size_t>(i)] = csv.text(1) == "inf" ? INFINITY : csv.number(1);
    }
  }

  /// Writes what is there; whether the first `expected` values are.
  bool keep(int expected) const {
    std::string text = header + "\n";
    bool all = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto number = static_cast<std::int64_t>(i);
      if (values[i]) {
        text += with_checksum(std::to_string(first + number) + "," +
                              (std::isinf(*values[i]) ? "inf" : shortest(*values[i]))) +
                "\n";
      } else {
        all = all && number >= expected;
      }
    }
    make_directory(fs::path(file).parent_path().string());
    write_atomically(file, text);
    return all;
  }

  Incumbent mean() const {
    const auto n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const auto& value : values) sum += *value;
    for (const auto& value : values) squares += std::pow(*value - sum / n, 2);
    return {point, sum / n, std::sqrt(squares / (n - 1) / n), static_cast<int>(values.size())};
  }

  std::vector<double> point;
  std::int64_t first = 0;
  std::string file, header;
  std::vector<std::optional<double>> values;
};

}  // namespace

Incumbent repeated(const Optimization::Source& source, const std::vector<double>& point,
                   std::int64_t first, int count, const std::string& file,
                   const OptimizationOptions& options) {
  Repeats repeats(point, first, count, file);
  for (int begin = 0; begin < count; begin += kKeptTogether) {
    for_each_world(std::min(kKeptTogether, count - begin), options.threads, [&](int i) {
      auto& value = repeats.values[static_cast<std::size_t>(begin + i)];
      if (!value) value = source.evaluate({point, first + begin + i}, options.stop);
    });
    if (!repeats.keep(begin + kKeptTogether)) throw Stopped();
  }
  return repeats.mean();
}

}  // namespace lilytank
