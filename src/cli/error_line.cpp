#include "cli/error_line.hpp"

#include <filesystem>
#include <new>

#include "lilytank/error.hpp"
#include "text/printable.hpp"
#include "text/words.hpp"

namespace lilytank::cli {
namespace {

bool exists(const std::string& file) {
  std::error_code ignored;
  return !file.empty() && std::filesystem::exists(file, ignored);
}

/// Whether a refusal says what it is about: an option, a place in a file, or a file in quotes.
bool names_its_subject(const std::string& message) {
  for (const char* begin : {"lilytank ", "--", "cannot ", "'"}) {
    if (message.starts_with(begin)) return true;
  }
  if (exists(message.substr(0, message.find(':')))) return true;
  for (auto open = message.find('\''); open != std::string::npos;) {
    const auto close = message.find('\'', open + 1);
    if (close == std::string::npos) return false;
    if (exists(message.substr(open + 1, close - open - 1))) return true;
    open = close;
  }
  return false;
}

std::string refusal_line(const Arguments& words, const std::string& message) {
  if (names_its_subject(message)) return message;
  std::string file;
  for (std::size_t k = 1; k < words.size(); ++k) {  // the first one is the verb
    if (!exists(words[k])) continue;
    if (message.find(words[k]) != std::string::npos) return message;
    if (words[k - 1] != "--out") file = words[k];
  }
  return file.empty() ? message : file + ": " + message;
}

}  // namespace

std::string error_line(const Arguments& words, const std::exception_ptr& failure) {
  const std::string command = "lilytank " + joined(words, " ");
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& e) {
    return printable(refusal_line(words, e.what()));
  } catch (const std::bad_alloc&) {
    return printable(command + ": out of memory");
  } catch (const std::exception& e) {
    return printable(command + ": unexpected: " + e.what());
  } catch (...) {
    return printable(command + ": unexpected failure");
  }
}

}  // namespace lilytank::cli
