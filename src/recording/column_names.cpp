#include "recording/column_names.hpp"

#include <algorithm>
#include <array>

#include "text/words.hpp"

namespace lilytank {
namespace {

/// The letters and digits of a name, small, without a unit in brackets behind it.
std::string plain(std::string_view name) {
  const auto bracket = name.find_first_of("([");
  if (bracket != std::string_view::npos && bracket > 0) name = name.substr(0, bracket);
  std::string out;
  for (const char c : in_small_letters(name)) {
    if (c != ' ' && c != '_' && c != '-' && c != '.' && c != ':') out += c;
  }
  return out;
}

/// The words of each role, by plain(), most wanted first. Roles are tried in this order.
const std::pair<ColumnRole, std::vector<std::string_view>> kWords[] = {
    {ColumnRole::frame,
     {"frame", "frames", "frameno", "framenr", "framenumber", "frameindex", "frameidx", "frameid",
      "framenum", "imagenumber", "imageindex"}},
    {ColumnRole::time,
     {"time", "times", "timestamp", "timestamps", "timestampms", "timems", "timesec", "seconds",
      "positiont", "datetime", "date", "msec", "t"}},
    {ColumnRole::identity,
     {"id",         "ids",          "trackid",    "track",       "trackno",      "tracknumber",
      "trackindex", "tracklet",     "trackletid", "trackerid",   "particle",     "particleid",
      "individual", "individualid", "label",      "labelid",     "object",       "objectid",
      "objid",      "obj",          "identity",   "identityid",  "animal",       "animalid",
      "animalname", "target",       "targetid",   "agent",       "agentid",      "body",
      "bodyid",     "robot",        "robotid",    "ball",        "ballid",       "marker",
      "markerid",   "tag",          "tagid",      "trajectory",  "trajectoryid", "fish",
      "fishid",     "fly",          "flyid",      "ant",         "antid",        "bee",
      "beeid",      "subject",      "subjectid",  "instance",    "instanceid",   "blob",
      "blobid",     "spotid",       "detection",  "detectionid", "name"}},
    {ColumnRole::x,
     {"x",       "xpos",    "posx",    "positionx", "xposition", "cx",     "xc",     "xcenter",
      "xcentre", "centerx", "centrex", "centroidx", "xcentroid", "xbody",  "xpx",    "xpixel",
      "pixelx",  "px",      "xmm",     "xcm",       "xworld",    "worldx", "xcoord", "coordx"}},
    {ColumnRole::y,
     {"y",       "ypos",    "posy",    "positiony", "yposition", "cy",     "yc",     "ycenter",
      "ycentre", "centery", "centrey", "centroidy", "ycentroid", "ybody",  "ypx",    "ypixel",
      "pixely",  "py",      "ymm",     "ycm",       "yworld",    "worldy", "ycoord", "coordy"}},
    {ColumnRole::score,
     {"conf", "confidence", "score", "cls", "class", "classid", "classname", "classes", "category",
      "categoryid", "detconf", "visibility", "objectness"}},
};

/// A plain name without the "bbox", "bb" or "box" before it.
std::string without_box(const std::string& word) {
  for (const std::string_view before : {"bbox", "bb", "box"}) {
    if (word.size() > before.size() && word.starts_with(before)) return word.substr(before.size());
  }
  return word;
}

}  // namespace

FormatColumns columns_of(RecordingFormat format) {
  using enum RecordingFormat;
  switch (format) {
    case trackpy:
      return {{"frame"}, {}, {"particle"}, {"x"}, {"y"}, {}, {}};
    case idtracker:
      return {{"frame"}, {"time", "seconds"}, {"individual"}, {"x"}, {"y"}, {}, {}};
    case fasttrack:
      return {{"imageNumber"}, {}, {"id"}, {"xBody"}, {"yBody"}, {"tBody"}, {}};
    case swistrack_tracks:
      return {{"Frame number"}, {}, {}, {"x"}, {"y"}, {}, {}};
    case swistrack_particles:
      return {{"Frame number"}, {"Time"}, {}, {"X (world)"}, {"Y (world)"}, {}, {}};
    case trex:
      return {
          {"frame"},
          {"time", "time (s)"},
          {},
          {"X#wcentroid (cm)", "X#wcentroid", "X (cm)", "X", "X#pcentroid (cm)", "X#centroid (cm)"},
          {"Y#wcentroid (cm)", "Y#wcentroid", "Y (cm)", "Y", "Y#pcentroid (cm)", "Y#centroid (cm)"},
          {"ANGLE", "ANGLE (rad)", "ANGLE#wcentroid"},
          {"missing"}};
    case boxes:
      return {{"frame"}, {"time"}, {"track_id", "id"}, {}, {}, {}, {}};
    case idtracker_wide:
      return {{"frame"}, {"time", "seconds"}, {}, {}, {}, {}, {}};
    default:
      return {{"frame"}, {"time"}, {"id"}, {"x"}, {"y"}, {"theta"}, {}};
  }
}

ColumnRole role_of(std::string_view name) {
  const std::string word = plain(name);
  for (const auto& [role, words] : kWords) {
    if (std::find(words.begin(), words.end(), word) != words.end()) return role;
  }
  return ColumnRole::other;
}

int find_role(const std::vector<std::string>& names, ColumnRole wanted) {
  for (const auto& [role, words] : kWords) {
    if (role != wanted) continue;
    for (const std::string_view word : words) {
      const auto found = std::find_if(names.begin(), names.end(),
                                      [&](const std::string& name) { return plain(name) == word; });
      if (found != names.end()) return static_cast<int>(found - names.begin());
    }
  }
  return -1;
}

std::vector<std::string> names_of_role(const std::vector<std::string>& names, ColumnRole role) {
  std::vector<std::string> out;
  std::copy_if(names.begin(), names.end(), std::back_inserter(out),
               [&](const std::string& name) { return role_of(name) == role; });
  return out;
}

std::optional<BoxColumns> find_box(const std::vector<std::string>& names) {
  using Kind = BoxColumns::Kind;
  struct Layout {
    Kind kind;
    std::array<std::string_view, 4> words;
  };
  static constexpr Layout layouts[] = {
      {Kind::corners, {"xmin", "ymin", "xmax", "ymax"}},
      {Kind::corners, {"minx", "miny", "maxx", "maxy"}},
      {Kind::corners, {"xtl", "ytl", "xbr", "ybr"}},
      {Kind::corners, {"left", "top", "right", "bottom"}},
      {Kind::corner_and_size, {"left", "top", "width", "height"}},
      {Kind::corner_and_size, {"left", "top", "w", "h"}},
      {Kind::corner_and_size, {"xmin", "ymin", "width", "height"}},
      {Kind::middle_and_size, {"xcenter", "ycenter", "width", "height"}},
      {Kind::middle_and_size, {"cx", "cy", "width", "height"}},
      {Kind::middle_and_size, {"cx", "cy", "w", "h"}},
      {Kind::corners, {"x1", "y1", "x2", "y2"}},
      {Kind::corners, {"x0", "y0", "x1", "y1"}},
      {Kind::corner_and_size, {"x", "y", "width", "height"}},
      {Kind::corner_and_size, {"x", "y", "w", "h"}},
  };
  std::vector<std::string> words;
  for (const std::string& name : names) words.push_back(without_box(plain(name)));
  for (const Layout& layout : layouts) {
    std::array<int, 4> at{};
    bool all = true;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto found = std::find(words.begin(), words.end(), layout.words[i]);
      all = all && found != words.end();
      at[i] = static_cast<int>(found - words.begin());
    }
    if (all) return BoxColumns{layout.kind, at[0], at[1], at[2], at[3]};
  }
  return std::nullopt;
}

bool has_ambiguous_box(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view word) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return without_box(plain(name)) == word; });
  };
  return has("x") && has("y") && (has("w") || has("width")) && (has("h") || has("height"));
}

std::string quoted_names(const std::vector<std::string>& names) {
  return joined(names, ", ", [](const std::string& name) { return "'" + name + "'"; });
}

std::string short_list(const std::vector<std::string>& names) {
  const std::string list = joined(names, ", ");
  return list.size() > 200 ? list.substr(0, 200) + ", ..." : list;
}

std::string suggested_keys(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& [key, role, own] : {std::tuple{"frame", ColumnRole::frame, "frame"},
                                       {"time", ColumnRole::time, "time"},
                                       {"id", ColumnRole::identity, "id"},
                                       {"x", ColumnRole::x, "x"},
                                       {"y", ColumnRole::y, "y"}}) {
    const int found = find_role(names, role);
    if (found < 0 || names[found] == own) continue;
    out += std::string(out.empty() ? "; perhaps " : ", ") + "columns." + key + " = \"" +
           names[found] + "\"";
  }
  return out;
}

}  // namespace lilytank
