// A running ffmpeg that takes raw frames and makes one film file.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lilytank {

/// What ffmpeg is to make.
struct Encoding {
  int width = 0, height = 0;  ///< pixels, both even
  double fps = 30;
  bool gif = false;  ///< else H.264 in MP4
  /// GIF only: the first frames, spread over the film, from which the palette is made; they are
  /// not shown. ffmpeg would otherwise keep the whole film in memory until it knows all colours.
  int palette_frames = 0;
  /// MP4 only: stored as the film's comment.
  std::string comment;
};

/// Starts ffmpeg (found in PATH), sends it frames, and waits for it. If the object goes away
/// before finish(), ffmpeg is ended. Its output belongs to the caller, who removes it then.
class Ffmpeg {
 public:
  /// Writes to `output`, whatever its ending. Throws InputError if ffmpeg cannot be started.
  Ffmpeg(const Encoding& encoding, const std::string& output);
  ~Ffmpeg();
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  /// Sends one frame, width * height * 4 bytes: blue, green, red, unused. Throws InputError with
  /// ffmpeg's own words if it has stopped.
  void send(std::span<const unsigned char> frame);
  /// Waits until the file is complete. Throws InputError if ffmpeg failed.
  void finish();

 private:
  int end();
  [[noreturn]] void fail(int status);

  int input_ = -1;     // our end of a socket that is ffmpeg's standard input
  int messages_ = -1;  // its standard error
  int child_ = -1;     // its process, -1: ended
};

/// The command line for an encoding.
std::vector<std::string> ffmpeg_command(const Encoding& encoding, const std::string& output);

}  // namespace lilytank
