#include "ffmpeg.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "lilytank/error.hpp"
#include "lilytank/render.hpp"
#include "text/number.hpp"

extern char** environ;

namespace lilytank {
namespace {

constexpr std::size_t kMostWords = 4000;  // bytes of ffmpeg's messages that are kept
constexpr const char* kNotThere =
    "cannot make films: the program ffmpeg is not in PATH; install it, or draw stills";

void close_and_forget(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

// A child inherits none of our descriptors except those it is given.
int spawn(const std::vector<std::string>& command, int standard_in, int standard_error,
          pid_t& child) {
  std::vector<char*> arguments;
  for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, standard_in, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, standard_error, 2);
  // A group of its own: Ctrl-C is for us, and we end ffmpeg ourselves.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error =
      ::posix_spawnp(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

void require_film_program() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/bin:/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/ffmpeg";
    std::error_code problem;
    const bool is_file = std::filesystem::is_regular_file(file, problem);
    if (is_file && ::access(file.c_str(), X_OK) == 0) return;
  }
  throw InputError(kNotThere);
}

std::vector<std::string> ffmpeg_command(const Encoding& e, const std::string& output) {
  std::vector<std::string> c{"ffmpeg",
                             "-nostdin",
                             "-hide_banner",
                             "-loglevel",
                             "error",
                             "-xerror",
                             "-y",
                             "-f",
                             "rawvideo",
                             "-pixel_format",
                             "bgr0",
                             "-video_size",
                             std::to_string(e.width) + "x" + std::to_string(e.height),
                             "-framerate",
                             significant(e.fps, 6),
                             "-i",
                             "pipe:0"};
  const auto add = [&](std::initializer_list<const char*> more) {
    c.insert(c.end(), more.begin(), more.end());
  };
  if (e.gif) {
    const std::string n = std::to_string(e.palette_frames);
    add({"-filter_complex"});
    c.push_back("[0:v]split[a][b];[a]trim=end_frame=" + n +
                ",palettegen=stats_mode=full[p];[b]trim=start_frame=" + n +
                ",setpts=PTS-STARTPTS[c];"
                "[c][p]paletteuse=dither=bayer:bayer_scale=5:diff_mode=rectangle");
    add({"-loop", "0", "-f", "gif"});
  } else {
    // Water that a module or a trail uncovers is known from frames before: a film that refers to as
    // many as a decoder of level 4 keeps is an eighth smaller. Colours get finer steps than x264's
    // usual ones, which turn thin blue lines grey.
    const int macroblocks = ((e.width + 15) / 16) * ((e.height + 15) / 16);
    const std::string references = std::to_string(std::clamp(32768 / macroblocks, 1, 12));
    add({"-c:v", "libx264", "-preset", "veryfast", "-crf", "23", "-refs"});
    c.push_back(references);
    add({"-x264-params", "chroma-qp-offset=-6"});
    add({"-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
         "-color_primaries", "bt709", "-color_trc", "bt709", "-movflags", "+faststart",
         "-metadata"});
    c.push_back("comment=" + e.comment);
    add({"-f", "mp4"});
  }
  c.push_back("file:" + output);
  return c;
}

// A socket instead of a pipe: send() can do without SIGPIPE, and leaves the program's signal
// handlers alone. Messages go to a file in memory, so that neither side waits for the other to read
// them.
Ffmpeg::Ffmpeg(const Encoding& encoding, const std::string& output) {
  int sockets[2] = {-1, -1};
  const bool ready = ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) == 0 &&
                     (messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC)) >= 0;
  const int error =
      ready ? spawn(ffmpeg_command(encoding, output), sockets[1], messages_, child_) : errno;
  input_ = sockets[0];
  close_and_forget(sockets[1]);
  if (error == 0) return;
  close_and_forget(input_), close_and_forget(messages_);
  throw InputError(error == ENOENT ? std::string(kNotThere)
                                   : std::string("cannot start ffmpeg: ") + std::strerror(error));
}

Ffmpeg::~Ffmpeg() {
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    end();
  }
  close_and_forget(messages_);
}

void Ffmpeg::send(std::span<const unsigned char> frame) {
  while (!frame.empty()) {
    const ssize_t n = ::send(input_, frame.data(), frame.size(), MSG_NOSIGNAL);
    if (n > 0)
      frame = frame.subspan(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      fail(end());
  }
}

// Closes ffmpeg's input and waits until it ends; returns its status.
int Ffmpeg::end() {
  close_and_forget(input_);
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return status;
}

void Ffmpeg::fail(int status) {
  std::string reason(kMostWords, ' ');
  const ssize_t n = ::pread(messages_, reason.data(), reason.size(), 0);
  reason.resize(static_cast<std::size_t>(std::max<ssize_t>(0, n)));
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
  // Its messages are one a line; the user gets them in one.
  for (std::size_t i = 0; (i = reason.find('\n', i)) != std::string::npos;) {
    reason.replace(i, 1, "; ");
  }
  if (reason.empty()) {
    reason = WIFSIGNALED(status) ? "ended by signal " + std::to_string(WTERMSIG(status))
                                 : "exit code " + std::to_string(WEXITSTATUS(status));
  }
  throw InputError("ffmpeg failed: " + reason);
}

void Ffmpeg::finish() {
  const int status = end();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(status);
}

}  // namespace lilytank
