// Helpers of the picture tests: temporary folders, file headers, pixels through ffmpeg.
#pragma once
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace lilytank::sample {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A folder that is there for the length of a test.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "lilytank_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  /// Names of all files in it, hidden ones too.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

struct Size {
  int width = 0, height = 0;
  friend bool operator==(const Size&, const Size&) = default;
};

/// From a PNG's header; 0 x 0 where it is none.
inline Size png_size(const std::string& file) {
  const std::string b = bytes_of(file);
  if (b.size() < 24 || b.compare(1, 3, "PNG") != 0) return {};
  const auto number = [&](std::size_t at) {
    int n = 0;
    for (std::size_t i = at; i < at + 4; ++i) n = n * 256 + static_cast<unsigned char>(b[i]);
    return n;
  };
  return {number(16), number(20)};
}

/// What a command prints.
inline std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return out;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    out.append(buffer.data(), n);
  }
  ::pclose(pipe);
  return out;
}

inline bool has_ffmpeg() {
  return !output_of("command -v ffmpeg").empty() && !output_of("command -v ffprobe").empty();
}

struct Pixel {
  int r = 0, g = 0, b = 0;
};
inline int difference(Pixel a, Pixel b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

/// A picture's pixels, read by ffmpeg.
class Pixels {
 public:
  explicit Pixels(const std::string& file)
      : size_(png_size(file)),
        data_(output_of("ffmpeg -v error -i '" + file + "' -f rawvideo -pix_fmt rgb24 -")) {}
  bool read() const {
    return !data_.empty() && data_.size() == 3u * static_cast<unsigned>(size_.width) *
                                                 static_cast<unsigned>(size_.height);
  }
  Pixel at(double x, double y) const {
    const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                        static_cast<std::size_t>(x));
    const auto channel = [&](std::size_t k) {
      return int{static_cast<unsigned char>(data_[i + k])};
    };
    return {channel(0), channel(1), channel(2)};
  }

 private:
  Size size_;
  std::string data_;
};

/// Pixels of a PNG that `is` says yes to.
template <class Is>
int count_pixels(const std::string& file, const Is& is) {
  const Pixels pixels(file);
  const Size size = png_size(file);
  int count = 0;
  for (int y = 0; pixels.read() && y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) count += is(pixels.at(x, y)) ? 1 : 0;
  }
  return count;
}

}  // namespace lilytank::sample
