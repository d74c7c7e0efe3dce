// The verbs. A verb is one file beside this one and one line in command.cpp.
#pragma once
#include <string>
#include <vector>

#include "cli/host.hpp"

namespace lilytank::cli {

using Arguments = std::vector<std::string>;

/// Exit codes of the program.
enum Exit : int {
  done = 0,
  diverged = 1,   ///< a world was given up; its files are there
  fault = 1,      ///< a check found one
  bad_input = 2,  ///< one line on stderr says what is wrong
  stopped = 3,    ///< by a signal; the same command resumes
};

struct Verb {
  std::string name;
  std::string summary;
  /// Does it for the host; the arguments are those after the verb. "--help" among them prints the
  /// verb's help. Throws InputError.
  int (*act)(const Arguments& arguments, const Host& host);
  std::vector<std::string> examples;  ///< whole commands, for its help
};

/// All, in the order of the help.
const std::vector<Verb>& verbs();
/// Of `lilytank recording`.
inline const std::vector<std::string> kRecordingVerbs{"info", "check", "convert"};

int run_verb(const Arguments& arguments, const Host& host);
int flow_verb(const Arguments& arguments, const Host& host);
int info_verb(const Arguments& arguments, const Host& host);
int forces_verb(const Arguments& arguments, const Host& host);
int calibrate_verb(const Arguments& arguments, const Host& host);
int diagnose_verb(const Arguments& arguments, const Host& host);
int prove_verb(const Arguments& arguments, const Host& host);
int render_verb(const Arguments& arguments, const Host& host);
int study_verb(const Arguments& arguments, const Host& host);
int optimize_verb(const Arguments& arguments, const Host& host);
int analyze_verb(const Arguments& arguments, const Host& host);
int recording_verb(const Arguments& arguments, const Host& host);
int synthesize_verb(const Arguments& arguments, const Host& host);
int check_verb(const Arguments& arguments, const Host& host);
int schema_verb(const Arguments& arguments, const Host& host);
int completion_verb(const Arguments& arguments, const Host& host);
int man_verb(const Arguments& arguments, const Host& host);
int view_verb(const Arguments& arguments, const Host& host);
int export_verb(const Arguments& arguments, const Host& host);

}  // namespace lilytank::cli
