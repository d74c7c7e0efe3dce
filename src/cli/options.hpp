// Command lines of verbs: cxxopts with messages that name the nearest right option.
#pragma once
#include <optional>
#include <string>

// The library would split --set title="a,b" at the comma.
#define CXXOPTS_VECTOR_DELIMITER '\0'
// Its own parser of option names instead of std::regex, which doubles a verb's compile time.
#define CXXOPTS_NO_REGEX
#include <cxxopts.hpp>

#include "cli/verbs.hpp"

namespace lilytank::cli {

constexpr double kLongest = 1e9;    ///< s, the longest time that an option takes
constexpr int kMostThreads = 4096;  ///< that an option takes

/// Options and positional arguments of one verb.
class VerbOptions {
 public:
  /// `usage`: the positional arguments as shown by help, "SCENARIO...".
  VerbOptions(const std::string& verb, const std::string& usage, const std::string& summary);

  /// To add options with, as in cxxopts.
  cxxopts::OptionAdder add() { return options_.add_options(); }
  /// Reads the arguments; false if only the help was asked for, which is then printed. Throws
  /// InputError on an unknown option or a missing value.
  bool parse(const Arguments& arguments);

  /// Whether an option was given; a switch given as --force=false was not.
  bool has(const std::string& name) const;
  /// The value of a text option, or `otherwise`.
  std::string text(const std::string& name, const std::string& otherwise = "") const;
  std::vector<std::string> list(const std::string& name) const;
  /// A number within bounds, or `otherwise` if the option is not given; with `unit` the user may
  /// write "2 h". Throws InputError.
  double number(const std::string& name, double otherwise, double low, double high,
                const std::string& unit = "") const;
  std::int64_t whole(const std::string& name, std::int64_t otherwise, std::int64_t low,
                     std::int64_t high) const;
  const std::vector<std::string>& positional() const { return positional_; }

  /// Refuses these options, which would have no effect, if one is given: "--NAME " + why.
  void refuse_given(const std::vector<std::string>& names, const std::string& why) const;
  /// Refuses to write to `file`, which --`option` asks for, if it is one of the `inputs`.
  void spare_inputs(const std::string& option, const std::string& file,
                    const std::vector<std::string>& inputs) const;
  /// Refuses to write into `dir`, which --`option` asks for, if one of the `inputs` lies there.
  void spare_directory(const std::string& option, const std::string& dir,
                       const std::vector<std::string>& inputs) const;
  /// Refuses two of these options that name one file.
  void spare_each_other(const std::vector<std::string>& names) const;
  /// An InputError that begins with the verb.
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  void check_names(const Arguments& arguments);
  void check_switch(const std::string& name, const std::string& value) const;
  std::string verb_;
  cxxopts::Options options_;
  cxxopts::ParseResult result_;
  std::vector<std::string> positional_;
  std::vector<std::string> switches_;  ///< names of options without a value
};

}  // namespace lilytank::cli
