// What the names of a table's columns mean.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lilytank/recording_io.hpp"

namespace lilytank {

/// The names that a format gives its columns, most wanted first.
struct FormatColumns {
  std::vector<std::string> frame, time, id, x, y, theta, missing;
};
FormatColumns columns_of(RecordingFormat format);

/// What a column seems to hold by its name, whatever the format.
enum class ColumnRole : unsigned char { other, frame, time, identity, x, y, score };
/// Letters' case, blanks, '_', '-', '.' and a unit in brackets do not count: "Track_ID" and "id"
/// are identities, "frame_idx" is a frame, "conf" is the score of a detection.
ColumnRole role_of(std::string_view name);
/// The first column of a role, -1 if there is none.
int find_role(const std::vector<std::string>& names, ColumnRole role);
/// All columns of a role.
std::vector<std::string> names_of_role(const std::vector<std::string>& names, ColumnRole role);

/// The columns of a bounding box.
struct BoxColumns {
  enum class Kind : unsigned char { corners, corner_and_size, middle_and_size };
  Kind kind = Kind::corners;
  int x1 = -1, y1 = -1;  ///< of the first corner, or of the middle
  int x2 = -1, y2 = -1;  ///< of the other corner, or width and height
};
/// The box in a table: x1, y1, x2, y2 (also from 0), xmin, ymin, xmax, ymax, left, top, right,
/// bottom, left, top, width, height, x_center, y_center, width, height, or x, y, width, height (x
/// and y of a corner), each also after "bb" or "bbox"; or nothing.
std::optional<BoxColumns> find_box(const std::vector<std::string>& names);
/// Whether x and y stand beside a width and a height: they may be of the middle or of a corner.
bool has_ambiguous_box(const std::vector<std::string>& names);

/// "'a', 'b'".
std::string quoted_names(const std::vector<std::string>& names);
/// "a, b, ..." of at most 200 characters.
std::string short_list(const std::vector<std::string>& names);
/// "; perhaps columns.id = "track_id", columns.x = "cx""; "" if no name suggests a role.
std::string suggested_keys(const std::vector<std::string>& names);

}  // namespace lilytank
