#include "io/poses_csv.hpp"

#include <limits>

#include "io/csv.hpp"

namespace lilytank {

std::vector<Pose> parse_poses(const std::string& text, const std::string& file,
                              std::vector<int>* lines) {
  std::vector<Pose> poses;
  CsvReader reader(text, file, {"id,x,y,theta"});
  while (reader.next()) {
    const auto id = reader.whole(0, 0, std::numeric_limits<std::int32_t>::max());
    if (id != static_cast<std::int64_t>(poses.size())) {
      reader.refuse(0,
                    "id '" + std::to_string(id) + "' instead of " + std::to_string(poses.size()));
    }
    if (lines != nullptr) lines->push_back(reader.line());
    poses.push_back({reader.number(1), reader.number(2), rotation(reader.number(3))});
  }
  return poses;
}

}  // namespace lilytank
