#include "io/poses_csv.hpp"

#include "io/table.hpp"

namespace lilytank {

std::vector<Pose> parse_poses(const std::string& text, const std::string& file,
                              std::vector<int>* line_numbers) {
  std::vector<Pose> poses;
  LineSource source(text, file);
  Table table(source);
  const std::vector<int> at = table.fixed_columns({"id", "x", "y", "theta"}, "a file of poses");
  while (table.next()) {
    const auto id = table.whole(at[0]);
    if (!id) table.refuse(at[0], table.quoted(at[0]) + " is not a whole number");
    if (*id != static_cast<std::int64_t>(poses.size())) {
      table.refuse(at[0], table.quoted(at[0]) + " instead of " + std::to_string(poses.size()));
    }
    if (line_numbers != nullptr) line_numbers->push_back(table.line());
    poses.push_back({table.finite(at[1]), table.finite(at[2]), rotation(table.finite(at[3]))});
  }
  return poses;
}

}  // namespace lilytank
