// The program, or a piece of work, in a process of its own, to be interrupted.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace lilytank {

class Process {
 public:
  /// Starts the program in `directory`; what it says goes to a file there, or is thrown away.
  Process(const std::string& directory, const std::vector<std::string>& arguments,
          const std::string& says = "/dev/null")
      : child_(::fork()) {
    if (child_ != 0) return;
    if (::chdir(directory.c_str()) != 0) ::_exit(99);
    std::vector<char*> words{const_cast<char*>("lilytank")};
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const int out = ::open(says.c_str(), O_WRONLY | O_CREAT, 0666);
    ::dup2(out, STDOUT_FILENO), ::dup2(out, STDERR_FILENO);
    ::execv(LILYTANK_PROGRAM, words.data());
    ::_exit(98);
  }
  /// Does `work` in a process of its own.
  explicit Process(const std::function<void()>& work) : child_(::fork()) {
    if (child_ != 0) return;
    work();
    ::_exit(0);
  }
  ~Process() {
    if (!ended_) end(SIGKILL);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool has_ended() const {
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid != 0;
  }

  /// Whether it would answer a signal rather than end by it.
  bool catches(int signal) const {
    std::ifstream status("/proc/" + std::to_string(child_) + "/status");
    for (std::string word; status >> word;) {
      if (word != "SigCgt:" || !(status >> word)) continue;
      return (std::stoull(word, nullptr, 16) >> (signal - 1) & 1) != 0;
    }
    return false;
  }

  /// Waits until `enough` says so or the process has ended.
  template <class Enough>
  void await(const Enough& enough) const {
    while (!enough() && !has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// Sends a signal and waits; the exit code, or minus the signal that ended it.
  int end(int signal) {
    ::kill(child_, signal);
    int status = 0;
    ::waitpid(child_, &status, 0);
    ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t child_;
  bool ended_ = false;
};

}  // namespace lilytank
