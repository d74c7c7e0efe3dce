// A scenario or an overlay of one as TOML, line by line.
#pragma once
#include <string>

namespace lilytank {

/// The writer of every scenario file that the program makes. Keys are dotted paths, or names within
/// the last table.
class ScenarioText {
 public:
  /// Each line of `lines` as a comment.
  void comment(const std::string& lines);
  /// A header, "flow" or "[command]", after an empty line unless only comments stand before it.
  void table(const std::string& header);
  /// key = toml  # remark
  void line(const std::string& key, const std::string& toml, const std::string& remark = "");
  /// With the shortest digits that read back as the value.
  void number(const std::string& key, double value, const std::string& remark = "");
  void quoted(const std::string& key, const std::string& text);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool begun_ = false;  // something but comments stands there
};

}  // namespace lilytank
