#include <zlib.h>

#include <charconv>
#include <cmath>

#include "io/atomic_file.hpp"
#include "lilytank/math.hpp"
#include "lilytank/recording_io.hpp"
#include "recording/formats.hpp"

namespace lilytank {
namespace {

void add_fixed(std::string& out, double value, int digits) {
  char buffer[64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr;
  out.append(buffer, end);
}

std::string tidy_text(const Recording& recording) {
  const bool headings = recording.has_heading();
  std::string out = headings ? "frame,time,id,x,y,theta\n" : "frame,time,id,x,y\n";
  for (int f = 0; f < recording.frames; ++f) {
    for (const Track& track : recording.tracks) {
      if (f < track.first || f > track.last()) continue;
      const auto i = static_cast<std::size_t>(f - track.first);
      if (std::isnan(track.x[i])) continue;
      out += std::to_string(f) + ",";
      add_fixed(out, recording.time(f), 4);
      out += "," + std::to_string(track.id) + ",";
      add_fixed(out, track.x[i], 7);
      out += ",";
      add_fixed(out, track.y[i], 7);
      if (headings) {
        const double turn = 2 * kPi;
        const double theta = track.theta[i];
        out += ",";
        add_fixed(out, theta - turn * std::ceil(theta / turn - 0.5), 6);
      }
      out += "\n";
    }
  }
  return out;
}

std::string compressed(const std::string& text) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;
  if (::deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::bad_alloc();
  }
  std::string out(::deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  ::deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  ::deflateEnd(&stream);
  return out;
}

}  // namespace

void write_recording(const Recording& recording, const std::string& file, RecordingFormat format,
                     const Calibration& calibration) {
  static_cast<void>(calibration);
  if (format != RecordingFormat::tidy) {
    throw InputError("recordings cannot be written as " + format_word(format) + " yet");
  }
  const std::string text = tidy_text(recording);
  write_atomically(file, file.ends_with(".gz") ? compressed(text) : text);
}

}  // namespace lilytank
