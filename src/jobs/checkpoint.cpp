#include "jobs/checkpoint.hpp"

#include <algorithm>
#include <sstream>

#include "lilytank/force.hpp"
#include "text/fnv.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

const std::string kFirstLine = "lilytank checkpoint 2";
constexpr std::size_t kHashDigits = 16;

std::string hash_of(std::string_view bytes) {
  Fnv hash;
  hash.add(bytes);
  return hex(hash.value());
}

/// Takes "name value value ..." lines off the front of a text, complaining about anything else.
class LineReader {
 public:
  LineReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  /// The values of the next line, which must begin with `name`.
  std::istringstream line(const std::string& name) {
    const auto end = text_.find('\n');
    if (end == std::string_view::npos || !text_.starts_with(name)) refuse();
    std::istringstream in(std::string(text_.substr(name.size(), end - name.size())));
    text_.remove_prefix(end + 1);
    return in;
  }
  template <class... T>
  void values(const std::string& name, T&... to) {
    std::istringstream in = line(name);
    if (!(in >> ... >> to)) refuse();
  }
  double number(std::istringstream& in) {
    std::string word;
    const auto value = in >> word ? parse_number(word) : std::nullopt;
    if (!value) refuse();
    return *value;
  }
  FileDigest digest(const std::string& name) {
    std::istringstream in = line(name);
    FileDigest out;
    if (!(in >> out.length >> out.value)) refuse();
    for (std::uint64_t block = 0; in >> block;) out.blocks.push_back(block);
    return out;
  }
  std::string bytes(std::size_t size) {
    if (size > text_.size()) refuse();
    std::string out(text_.substr(0, size));
    text_.remove_prefix(size);
    return out;
  }
  std::string rest() { return bytes(text_.size()); }

  [[noreturn]] void refuse() const {
    throw InputError({file_, 0, 0}, "the checkpoint is damaged; remove it to begin the run again");
  }

 private:
  std::string_view text_;
  const std::string& file_;
};

std::string digest_line(const std::string& name, const FileDigest& digest) {
  std::string out =
      "\n" + name + " " + std::to_string(digest.length) + " " + std::to_string(digest.value);
  for (const std::uint64_t block : digest.blocks) out += " " + std::to_string(block);
  return out;
}

/// The library's own name for a force, which lives as long as the program.
std::string_view force_name(const std::string& name) {
  if (name == kStalled) return kStalled;
  const ForceTerm* term = find_force(name);
  return term == nullptr ? "none" : term->name();
}

}  // namespace

std::string to_bytes(const Checkpoint& c, std::uint64_t identity) {
  std::ostringstream out;
  const Divergence& d = c.divergence;
  out << kFirstLine << "\nfinished " << c.finished << " " << (c.status == RunStatus::diverged)
      << "\ndivergence " << d.step << " " << d.body << " "
      << (d.force.empty() ? "none" : std::string(d.force)) << " " << shortest(d.size)
      << "\nscenario " << identity << digest_line("trajectory", c.files.trajectory)
      << digest_line("events", c.files.events) << digest_line("metrics", c.files.metrics)
      << "\ntallies " << c.tallies.evaluations << " " << c.tallies.snaps_refused << " "
      << c.tallies.moves_undone << " " << shortest(c.tallies.deepest_overlap)
      << (c.last_event > 0 ? " " + std::to_string(c.last_event) : "") << "\nrecord "
      << c.record.size() << "\n"
      << c.record << to_snapshot(c.state, identity);
  const std::string body = out.str();
  return hash_of(body) + "\n" + body;
}

std::optional<std::uint64_t> identity_in(const std::string& bytes) {
  const std::string head = bytes.substr(0, std::min(kHashDigits, bytes.size()));
  if (bytes.size() <= kHashDigits + 1) return std::nullopt;
  const std::string body = bytes.substr(kHashDigits + 1);
  const std::string name = "\nscenario ";
  const auto at = body.find(name);
  if (head != hash_of(body) || !body.starts_with(kFirstLine) || at == std::string::npos) {
    return std::nullopt;
  }
  std::uint64_t identity = 0;
  std::istringstream(body.substr(at + name.size(), 24)) >> identity;
  return identity;
}

Checkpoint checkpoint_from(const std::string& bytes, std::uint64_t identity,
                           const std::string& file) {
  LineReader whole(bytes, file);
  const std::string hash = whole.bytes(std::min(kHashDigits + 1, bytes.size()));
  const std::string body = whole.rest();
  if (hash != hash_of(body) + "\n") whole.refuse();
  Checkpoint c;
  LineReader in(body, file);
  in.line(kFirstLine);
  bool diverged = false;
  in.values("finished", c.finished, diverged);
  c.status = diverged ? RunStatus::diverged : RunStatus::ok;
  std::istringstream divergence = in.line("divergence");
  std::string force;
  if (!(divergence >> c.divergence.step >> c.divergence.body >> force)) in.refuse();
  c.divergence.force = force_name(force), c.divergence.size = in.number(divergence);
  std::uint64_t owner = 0;
  in.values("scenario", owner);
  c.files = {in.digest("trajectory"), in.digest("events"), in.digest("metrics")};
  std::istringstream tallies = in.line("tallies");
  Tallies& t = c.tallies;
  if (!(tallies >> t.evaluations >> t.snaps_refused >> t.moves_undone)) in.refuse();
  t.deepest_overlap = in.number(tallies);
  if (!(tallies >> c.last_event)) c.last_event = 0;
  std::size_t size = 0;
  in.values("record", size);
  c.record = in.bytes(size);
  c.state = from_snapshot(in.rest(), identity, file);
  return c;
}

}  // namespace lilytank
