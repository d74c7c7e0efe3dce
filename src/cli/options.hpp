// Command lines of verbs: cxxopts with messages that name the nearest right option.
#pragma once
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

// The library would split --set title="a,b" at the comma.
#define CXXOPTS_VECTOR_DELIMITER '\0'
// Its own parser of option names instead of std::regex, which doubles a verb's compile time.
#define CXXOPTS_NO_REGEX
#include <cxxopts.hpp>

#include "cli/verbs.hpp"

namespace lilytank::cli {

constexpr double kLongest = 1e9;    ///< s, the longest time that an option takes
constexpr int kMostThreads = 4096;  ///< that an option takes

/// How an option is declared.
struct Option {
  std::string name, help;
  std::string value = "";  ///< what the help calls its value; empty: a switch
};

/// What parse() throws if the only argument is kDescribe: a verb as others show it.
struct VerbDescription {
  std::string usage, summary;
  std::vector<Option> options;
};
inline const std::string kDescribe = "--describe-options";
/// Of a verb, or of `lilytank recording` with one of its own verbs.
VerbDescription describe(const Verb& verb, const std::string& own = "");
/// What the help of a verb ends with: its examples, or nothing.
std::string examples_of(const std::string& verb);

/// Options and positional arguments of one verb. Where add() gets a variable, parse() stores the
/// value there if the option is given; the variable must exist until then.
class VerbOptions {
 public:
  /// `usage`: the positional arguments as shown by help, "SCENARIO...".
  VerbOptions(const std::string& verb, const std::string& usage, const std::string& summary);

  /// A switch, or a text for text().
  void add(const Option& option);
  void add(const Option& option, bool* out);
  /// A text; one of `words` if there are any.
  void add(const Option& option, std::string* out, const std::vector<std::string>& words = {});
  /// Texts, for list(): the option can be repeated.
  void add_list(const Option& option);
  void add(const Option& option, std::vector<std::string>* out);
  /// A number from `low` to `high`; with `unit` the user may write "2 h".
  void add(const Option& option, double* out, double low, double high,
           const std::string& unit = "");
  template <std::integral Whole>
  void add(const Option& option, Whole* out, std::int64_t low, std::int64_t high) {
    add(option, cxxopts::value<std::string>(),
        [=, this] { *out = static_cast<Whole>(whole(option.name, low, high)); });
  }

  /// --seed, which parse() adds to `sets` as run.seed. Comes after the option that fills `sets`.
  void add_seed(const std::string& help, std::vector<std::string>* sets);

  /// Reads the arguments; false if only the help was requested, which is then printed. Throws
  /// InputError on an unknown option, a missing or unusable value and, with the message
  /// `none_given` if that is not empty, without positional arguments.
  bool parse(const Arguments& arguments, const std::string& none_given = "");

  /// Whether an option was given; a switch given as --force=false was not.
  bool has(const std::string& name) const;
  /// The value of a text option, or `otherwise`.
  std::string text(const std::string& name, const std::string& otherwise = "") const;
  std::vector<std::string> list(const std::string& name) const;
  const std::vector<std::string>& positional() const { return positional_; }
  /// The only positional argument; refuses none and several with `message`.
  const std::string& only(const std::string& message) const;
  /// The directory of results, --out, or `otherwise`; refuses an empty one.
  std::string out(const std::string& otherwise) const;

  /// Refuses these options, which would have no effect, if one is given: "--NAME " + why.
  void refuse_given(const std::vector<std::string>& names, const std::string& why) const;
  /// Refuses to write to `file`, the value of --`option`, if it is one of the `inputs`.
  void spare_inputs(const std::string& option, const std::string& file,
                    const std::vector<std::string>& inputs) const;
  /// Refuses to write into `dir`, the value of --`option`, if one of the `inputs` lies there.
  void spare_directory(const std::string& option, const std::string& dir,
                       const std::vector<std::string>& inputs) const;
  /// Refuses two of these options that name one file.
  void spare_each_other(const std::vector<std::string>& names) const;
  /// An InputError that begins with the verb.
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  void add(const Option& option, const std::shared_ptr<cxxopts::Value>& type,
           const std::function<void()>& store);
  double number(const std::string& name, double low, double high, const std::string& unit) const;
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const;
  void check_names(const Arguments& arguments);
  /// Names a positional argument "-" kStandardInput; refuses two.
  void name_standard_input();
  void check_switch(const std::string& name, const std::string& value) const;
  std::string verb_;
  VerbDescription description_;
  cxxopts::Options options_;
  cxxopts::ParseResult result_;
  std::vector<std::string> positional_;
  std::vector<std::string> switches_;          ///< names of options without a value
  std::vector<std::function<void()>> stores_;  ///< of values, in the order of the options
};

}  // namespace lilytank::cli
