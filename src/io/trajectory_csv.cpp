#include <cstdint>
#include <fstream>
#include <limits>

#include "io/append_file.hpp"
#include "io/csv.hpp"
#include "io/trajectory_format.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

/// The number of the frame after the last one within the first `bytes` of a file of ours.
std::int64_t frame_after(const std::string& file, std::int64_t bytes) {
  constexpr std::int64_t kLongestRow = 512;
  const std::int64_t begin = std::max<std::int64_t>(0, bytes - kLongestRow);
  std::string tail(static_cast<std::size_t>(bytes - begin), '\0');
  std::ifstream in(file, std::ios::binary);
  in.seekg(begin);
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (tail.ends_with('\n')) tail.pop_back();
  const std::string row = tail.substr(tail.rfind('\n') + 1);
  return parse_whole(row.substr(0, row.find(','))).value_or(-1) + 1;  // the header: frame 0
}

class CsvWriter final : public TrajectoryWriter {
 public:
  CsvWriter(const std::string& file, const FileDigest* keep)
      : frame_(keep == nullptr ? 0 : frame_after(file, keep->length)),
        out_(keep == nullptr ? AppendFile(file) : AppendFile(file, *keep)) {
    if (keep == nullptr) out_.append(kTrajectoryColumns + "\n");
  }

  void write(const World& world, const std::vector<std::uint8_t>& complete) override {
    const Kinematics& k = world.kinematics();
    const std::string begin = std::to_string(frame_++) + "," + without_rounding(world.time()) + ",";
    std::string rows;
    for (int b = 0; b < k.size(); ++b) {
      rows += begin + std::to_string(b);
      // As narrow as the binary format, so that both hold the same numbers.
      for (const double v : {k.x[b], k.y[b], angle_of({k.c[b], k.s[b]})}) {
        rows += "," + shortest(static_cast<float>(v));
      }
      rows += b < k.modules ? marked(markings_of(world, b, complete)) : ",,,,,";
      rows += "\n";
    }
    out_.append(rows);
  }

  FileDigest flush() override { return out_.flush(); }

 private:
  static std::string marked(const Markings& m) {
    std::string out;
    for (const int v :
         {int{m.label}, int{m.last}, int{m.latched}, int{m.bonded}, int{m.complete}}) {
      out += "," + std::to_string(v);
    }
    return out;
  }

  std::int64_t frame_;
  AppendFile out_;
};

/// Builds a trajectory row by row; rows are sorted by frame and id, without gaps or repeats.
class CsvTrajectory {
 public:
  explicit CsvTrajectory(CsvReader& reader) : reader_(&reader), marked_(reader.header() == 0) {}

  Trajectory read() {
    while (reader_->next()) row();
    if (out_.bodies == 0) out_.bodies = rows_, out_.modules = modules_;  // a single frame
    if (rows_ < out_.bodies) drop_last_frame();
    return std::move(out_);
  }

 private:
  void row() {
    const auto most = std::numeric_limits<std::int32_t>::max();
    const std::int64_t frame = reader_->whole(0, 0, most), id = reader_->whole(2, 0, most);
    const double time = reader_->number(1);
    if (frame != out_.frames() - 1) begin_frame(frame, time);
    if (time != out_.time.back()) reader_->refuse(1, "the time changes within a frame");
    if (out_.bodies > 0 && id >= out_.bodies) {
      reader_->refuse(2, "id '" + std::to_string(id) + "' in a file of " +
                             std::to_string(out_.bodies) + " bodies");
    }
    if (id != rows_) {
      reader_->refuse(2, "id '" + std::to_string(id) + "' instead of " + std::to_string(rows_) +
                             ": rows are sorted by frame and id, each once");
    }
    ++rows_;
    out_.x.push_back(reader_->float_number(3));
    out_.y.push_back(reader_->float_number(4));
    out_.theta.push_back(reader_->float_number(5));
    markings(static_cast<int>(id));
  }

  void begin_frame(std::int64_t frame, double time) {
    if (frame != out_.frames()) {
      reader_->refuse(0, "frame '" + std::to_string(frame) + "' instead of " +
                             std::to_string(out_.frames()) +
                             ": rows are sorted by frame and id, each once");
    }
    if (frame == 1) out_.bodies = rows_, out_.modules = modules_;
    if (frame > 0 && rows_ != out_.bodies) {
      reader_->refuse(0, "the frame before has " + std::to_string(rows_) + " of " +
                             std::to_string(out_.bodies) + " bodies");
    }
    if (frame > 0 && time <= out_.time.back()) reader_->refuse(1, "times do not rise");
    out_.time.push_back(time);
    rows_ = 0;
  }

  // Modules have markings, balls have empty cells.
  void markings(int id) {
    if (!marked_) {
      modules_ = rows_;
      return;
    }
    const bool module = !reader_->empty(6);
    if (out_.frames() == 1 && module && id == modules_) ++modules_;
    if (module != (id < modules_)) reader_->refuse(6, "modules come before balls");
    Markings m;
    if (module) {
      m.label = static_cast<std::int16_t>(reader_->whole(6, 0, 32767));
      m.last = static_cast<std::int8_t>(reader_->whole(7, -1, 3));
      m.latched = static_cast<std::uint8_t>(reader_->whole(8, 0, 15));
      m.bonded = static_cast<std::uint8_t>(reader_->whole(9, 0, 15));
      m.complete = static_cast<std::uint8_t>(reader_->whole(10, 0, 1));
    }
    out_.markings.push_back(m);
  }

  void drop_last_frame() {
    const std::size_t poses = out_.x.size() - static_cast<std::size_t>(rows_);
    out_.time.pop_back();
    out_.x.resize(poses), out_.y.resize(poses), out_.theta.resize(poses);
    if (marked_) out_.markings.resize(poses);
  }

  CsvReader* reader_;
  bool marked_;
  Trajectory out_;
  int rows_ = 0;  ///< of the present frame
  int modules_ = 0;
};

}  // namespace

std::unique_ptr<TrajectoryWriter> open_csv_trajectory(const std::string& file,
                                                      const FileDigest* keep) {
  return std::make_unique<CsvWriter>(file, keep);
}

Trajectory parse_csv_trajectory(std::string_view text, const std::string& file) {
  CsvReader reader(whole_lines(text), file, {kTrajectoryColumns, kPoseColumns});
  return CsvTrajectory(reader).read();
}

}  // namespace lilytank
