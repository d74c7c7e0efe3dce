// Tables of a proof, written and read back: one row a world, one row an interval.
#include "proof/proof_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "io/file_digest.hpp"
#include "io/sha256.hpp"
#include "jobs/job_directory.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 16;  // of a key, in names of files
const std::string kWorldColumns =
    "world,kind,key,expected_z,verdict,said,alternatives,z,removed,gain_nat,gain_low_nat,"
    "regression,msd_misfit,right,wrong_name,checksum";
enum WorldColumn : std::size_t {
  kWorld,
  kKind,
  kKey,
  kExpected,
  kVerdict,
  kSaid,
  kAlternatives,
  kZ,
  kRemoved,
  kGain,
  kGainLow,
  kRegression,
  kMsd
};
const std::string kIntervalColumns = "world,effect,path,truth,value,low,high,holds,checksum";
enum IntervalColumn : std::size_t { kOf, kEffect, kPath, kTruth, kValue, kLow, kHigh };
const std::string kLoopColumns =
    "world,key,group,proposals,minutes,split,left,repeat_minutes,repeat_split,repeat_left,checksum";
enum LoopColumn : std::size_t {
  kLoopOf,
  kLoopKey,
  kGroup,
  kProposals,
  kMinutes,
  kSplit,
  kLeft,
  kRepeatMinutes,
  kRepeatSplit,
  kRepeatLeft
};
// Between the words of a cell, between those of one finding, and where a finding has none.
constexpr std::string_view kAnd = " + ", kOr = " | ", kNoAlternative = "-";
const std::string kUnnamed = "unnamed: ";

std::vector<std::string> split(std::string_view cell, std::string_view between) {
  std::vector<std::string> out;
  while (!cell.empty()) {
    const auto end = cell.find(between);
    out.emplace_back(cell.substr(0, end));
    cell = end == std::string_view::npos ? "" : cell.substr(end + between.size());
  }
  return out;
}

/// The one of `words` that a cell holds.
std::string word_in(const CsvReader& rows, std::size_t column,
                    const std::vector<std::string>& words) {
  const std::string word(rows.text(column));
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    rows.refuse(column,
                "'" + word + "' is not one of " + joined(words, ", ") + did_you_mean(word, words));
  }
  return word;
}

Verdict verdict_in(const CsvReader& rows) {
  std::vector<std::string> words;
  for (const Verdict v : {Verdict::complete, Verdict::missing, Verdict::measurement,
                          Verdict::undecided, Verdict::insufficient}) {
    words.push_back(name_of(v));
    if (rows.text(kVerdict) == words.back()) return v;
  }
  word_in(rows, kVerdict, words);
  return {};
}

// Insufficient experiments have requirements for findings.
std::vector<Requirement> shortfalls_in(const CsvReader& rows) {
  std::vector<Requirement> out;
  for (const std::string& name : split(rows.text(kSaid), kAnd)) {
    const auto is = [&](Requirement r) { return name_of(r) == name; };
    const auto found = std::ranges::find_if(kRequirements, is);
    if (found == kRequirements.end()) rows.refuse(kSaid, "'" + name + "' is not a requirement");
    out.push_back(*found);
  }
  if (out.empty()) rows.refuse(kSaid, "such a verdict has requirements that are not met");
  return out;
}

std::vector<ProofFinding> findings_in(const CsvReader& rows) {
  const auto said = split(rows.text(kSaid), kAnd), z = split(rows.text(kZ), kAnd),
             others = split(rows.text(kAlternatives), kAnd);
  if (z.size() != said.size() || others.size() != said.size()) {
    rows.refuse(kSaid, "said, alternatives and z do not have as many findings");
  }
  std::vector<ProofFinding> out;
  for (std::size_t i = 0; i < said.size(); ++i) {
    ProofFinding f;
    f.effect = said[i];
    if (f.effect.starts_with(kUnnamed)) {
      f.variable = f.effect.substr(kUnnamed.size()), f.effect = "unnamed";
    }
    if (others[i] != kNoAlternative) f.alternatives = split(others[i], kOr);
    const auto number = parse_number(z[i]);
    if (!number) rows.refuse(kZ, "'" + z[i] + "' is not a number");
    f.z = *number;
    out.push_back(std::move(f));
  }
  return out;
}

// Of a key: what all its worlds have in common. A line of a world begins with its number.
bool is_heading(const std::string& line) {
  return line.find_first_of("0123456789") != 0;
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void read_worlds(const std::string& file, Proof& proof) {
  const std::string text = read_whole(file);
  CsvReader rows(text, file, {kWorldColumns});
  std::vector<std::string> key = split(proof.key, "\n");
  std::erase_if(key, is_heading);
  while (rows.next()) {
    ProofWorld w;
    const std::size_t number = proof.worlds.size();
    rows.whole(kWorld, static_cast<std::int64_t>(number), static_cast<std::int64_t>(number));
    w.kind = word_in(rows, kKind, {"null", "named", "two", "unnamed"});
    // The numbers of the key leave out the kinds that were not requested.
    const std::string line = number < key.size() ? key[number] : "";
    const std::size_t kind = line.find_first_not_of("0123456789");
    if (kind == 0 || kind == std::string::npos || !line.substr(kind).starts_with(" " + w.kind)) {
      rows.refuse(kKind, "the key says otherwise");
    }
    w.effects = split(rows.text(kKey), kAnd);
    for (const std::string& name : w.effects) {
      if (line.find(" " + name + " ") == std::string::npos) {
        rows.refuse(kKey, "the key says otherwise");
      }
    }
    w.expected_z = rows.number(kExpected);
    w.verdict = verdict_in(rows);
    if (w.insufficient()) {
      w.shortfalls = shortfalls_in(rows);
    } else {
      w.findings = findings_in(rows);
    }
    if (w.findings.empty() &&
        (w.verdict == Verdict::missing || w.verdict == Verdict::measurement)) {
      rows.refuse(kSaid, "such a verdict has findings");
    }
    w.removed = rows.text(kRemoved).empty() ? std::nan("") : rows.number(kRemoved);
    w.gain = rows.number(kGain), w.gain_low = rows.number(kGainLow);
    w.regression = rows.text(kRegression);
    w.displacement = rows.number(kMsd);
    proof.worlds.push_back(std::move(w));
  }
}

void read_intervals(const std::string& file, Proof& proof) {
  const std::string text = read_whole(file);
  CsvReader rows(text, file, {kIntervalColumns});
  while (rows.next()) {
    const auto world = static_cast<std::size_t>(
        rows.whole(kOf, 0, static_cast<std::int64_t>(proof.worlds.size()) - 1));
    proof.worlds[world].intervals.push_back({std::string(rows.text(kPath)), rows.number(kTruth),
                                             rows.number(kValue), rows.number(kLow),
                                             rows.number(kHigh)});
  }
}

void read_loops(const std::string& file, Proof& proof) {
  if (!fs::exists(file)) return;
  const std::string text = read_whole(file);
  CsvReader rows(text, file, {kLoopColumns});
  while (rows.next()) {
    const auto world = static_cast<std::size_t>(
        rows.whole(kLoopOf, 0, static_cast<std::int64_t>(proof.worlds.size()) - 1));
    ProofLoop& loop = proof.worlds[world].loop.emplace();
    loop.group = split(rows.text(kGroup), kOr), loop.texts = split(rows.text(kProposals), kAnd);
    loop.minutes = rows.number(kMinutes), loop.repeat_minutes = rows.number(kRepeatMinutes);
    loop.split = rows.whole(kSplit, 0, 1) == 1;
    loop.repeat_split = rows.whole(kRepeatSplit, 0, 1) == 1;
    loop.left = rows.text(kLeft), loop.repeat_left = rows.text(kRepeatLeft);
  }
}

// Where worlds of a key are kept, their intervals and loops.
struct KeptFiles {
  std::string worlds, intervals, loops;
  KeptFiles(const std::string& dir, const std::string& hash) {
    const fs::path work = fs::path(dir) / "work";
    const std::string of = " of " + hash.substr(0, kHashDigits) + ".csv";
    worlds = (work / ("worlds" + of)).string(), intervals = (work / ("intervals" + of)).string();
    loops = (work / ("loops" + of)).string();
  }
};

}  // namespace

std::string proof_csv(const Proof& proof) {
  std::string out = kWorldColumns + "\n";
  for (std::size_t i = 0; i < proof.worlds.size(); ++i) {
    const ProofWorld& w = proof.worlds[i];
    std::vector<std::string> said, others, z;
    for (const ProofFinding& f : w.findings) {
      said.push_back(f.effect == "unnamed" ? kUnnamed + f.variable : f.effect);
      others.push_back(f.alternatives.empty() ? std::string(kNoAlternative)
                                              : joined(f.alternatives, kOr));
      z.push_back(significant(f.z, 3));
    }
    for (const Requirement r : w.shortfalls) said.push_back(name_of(r));
    out += with_checksum(std::to_string(i) + "," + w.kind + "," + joined(w.effects, kAnd) + "," +
                         shortest(w.expected_z) + "," + name_of(w.verdict) + "," +
                         joined(said, kAnd) + "," + joined(others, kAnd) + "," + joined(z, kAnd) +
                         "," + (std::isnan(w.removed) ? "" : shortest(w.removed)) + "," +
                         shortest(w.gain) + "," + shortest(w.gain_low) + "," + w.regression + "," +
                         shortest(w.displacement) + (w.right() ? ",1" : ",0") +
                         (w.wrong_name() ? ",1" : ",0")) +
           "\n";
  }
  return out;
}

std::string proof_intervals_csv(const Proof& proof) {
  std::string out = kIntervalColumns + "\n";
  for (std::size_t i = 0; i < proof.worlds.size(); ++i) {
    for (const ProofInterval& of : proof.worlds[i].intervals) {
      out +=
          with_checksum(std::to_string(i) + "," + joined(proof.worlds[i].effects, kAnd) + "," +
                        of.path + "," + shortest(of.truth) + "," + shortest(of.value) + "," +
                        shortest(of.low) + "," + shortest(of.high) + (of.holds() ? ",1" : ",0")) +
          "\n";
    }
  }
  return out;
}

std::string proof_loops_csv(const Proof& proof) {
  std::string out = kLoopColumns + "\n";
  for (std::size_t i = 0; i < proof.worlds.size(); ++i) {
    const ProofWorld& w = proof.worlds[i];
    if (!w.loop) continue;
    const ProofLoop& l = *w.loop;
    std::vector<std::string> texts;
    for (std::string text : l.texts) {
      std::replace(text.begin(), text.end(), ',', ';');
      texts.push_back(text);
    }
    out +=
        with_checksum(std::to_string(i) + "," + joined(w.effects, kAnd) + "," +
                      joined(l.group, kOr) + "," + joined(texts, kAnd) + "," + shortest(l.minutes) +
                      (l.split ? ",1," : ",0,") + l.left + "," + shortest(l.repeat_minutes) +
                      (l.repeat_split ? ",1," : ",0,") + l.repeat_left) +
        "\n";
  }
  return out;
}

std::vector<std::string> proof_files() {
  return with_figures({"proof.txt", "proof.csv", "tank.txt", "intervals.csv", "closed_loop.csv",
                       "key.txt", "report.html"},
                      {"power", "outcomes", "errors"});
}

void write_proof(const Proof& so_far, const std::string& dir) {
  const auto write = [&](const char* name, const std::string& text) {
    write_atomically((fs::path(dir) / name).string(), text);
  };
  write("proof.txt", proof_text({&so_far, 1}));
  write("proof.csv", proof_csv(so_far));
  write("tank.txt", so_far.tank + "\n");
  write("intervals.csv", proof_intervals_csv(so_far));
  const bool loops =
      std::ranges::any_of(so_far.worlds, [](const auto& w) { return w.loop.has_value(); });
  if (loops) write("closed_loop.csv", proof_loops_csv(so_far));
}

void forget_other_key(const std::string& dir, const std::string& hash) {
  const fs::path key = fs::path(dir) / "key.txt";
  std::error_code ignored;
  if (!fs::exists(key, ignored)) return;
  if (sha256(read_whole(key.string())) != hash) fs::remove(key, ignored);
}

void open_key(const Proof& proof, const std::string& dir) {
  write_atomically((fs::path(dir) / "key.txt").string(), proof.key);
}

Proof read_proof(const std::string& dir) {
  const fs::path key = fs::path(dir) / "key.txt";
  if (!fs::exists(key)) {
    throw InputError(dir + " holds no finished proof: there is no key.txt");
  }
  Proof proof;
  proof.dir = dir;
  proof.key = read_whole(key.string());
  proof.hash = sha256(proof.key), proof.sealed = lines_of(proof.key);
  const std::vector<std::string> key_lines = split(proof.key, "\n");
  proof.sealed -= static_cast<std::size_t>(std::ranges::count_if(key_lines, is_heading));
  const fs::path tank = fs::path(dir) / "tank.txt";
  if (fs::exists(tank)) {
    const std::string text = read_whole(tank.string());
    proof.tank = text.substr(0, text.find('\n'));
  }
  read_worlds((fs::path(dir) / "proof.csv").string(), proof);
  read_intervals((fs::path(dir) / "intervals.csv").string(), proof);
  read_loops((fs::path(dir) / "closed_loop.csv").string(), proof);
  return proof;
}

// After a kill before the last file a world has no model, and is evaluated again. Loops come first,
// as a world without one would not be.
void keep_worlds(const std::string& dir, const Proof& so_far) {
  if (dir.empty()) return;
  const KeptFiles files(dir, so_far.hash);
  write_atomically(files.loops, proof_loops_csv(so_far));
  write_atomically(files.worlds, proof_csv(so_far));
  write_atomically(files.intervals, proof_intervals_csv(so_far));
}

std::vector<ProofWorld> kept_worlds(const std::string& dir, const Proof& of) {
  const KeptFiles files(dir, of.hash);
  if (dir.empty() || !fs::exists(files.worlds)) return {};
  Proof kept;
  kept.key = of.key, kept.hash = of.hash;
  read_worlds(files.worlds, kept);
  if (fs::exists(files.intervals)) read_intervals(files.intervals, kept);
  read_loops(files.loops, kept);
  return std::move(kept.worlds);
}

}  // namespace lilytank
