// lilytank: floating modules that assemble themselves in a stirred tank.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>

#include "cli/command.hpp"
#include "cli/printable_stream.hpp"
#include "lilytank/error.hpp"

namespace lilytank::cli {
namespace {

/// What was printed counts only once it has arrived: a full disk shows here.
int deliver(int code) {
  if (std::cout.flush()) return code;
  throw InputError("cannot write to standard output");
}

/// A standard stream that is closed would be the next file that is opened, and take its text. What
/// is printed to these placeholders still fails.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    const int placeholder = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    static_cast<void>(placeholder);  // the lowest number that is free: that of the stream
  }
}

/// Does what the command line says; every failure is one line.
int run_command(const Arguments& words, PrintableStream& err) {
  try {
    return deliver(act(words, {}));
  } catch (const Stopped& stopped) {
    std::cerr << stopped.what() << "\n";
    return Exit::stopped;
  } catch (...) {
    err.print_refusal(error_line(words, std::current_exception()));
  }
  return Exit::bad_input;
}

}  // namespace
}  // namespace lilytank::cli

int main(int argc, char** argv) {
  using lilytank::cli::PrintableStream;
  std::ios::sync_with_stdio(false);
  lilytank::cli::occupy_closed_streams();
  std::signal(SIGXFSZ,
              SIG_IGN);  // a write beyond the limit then fails, and the message names the file
  const PrintableStream out(std::cout, false);
  PrintableStream err(std::cerr, ::isatty(STDERR_FILENO) != 0);
  return lilytank::cli::run_command({argv + std::min(1, argc), argv + argc}, err);
}
