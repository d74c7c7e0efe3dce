// What is in recordings, and what is wrong with them.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "cli/recording_verb.hpp"
#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "recording/event_log.hpp"
#include "statistics/median.hpp"
#include "statistics/text_table.hpp"
#include "text/number.hpp"
#include "text/printable.hpp"
#include "text/words.hpp"
#include "tracks/seen_bonds.hpp"

namespace lilytank::cli {
namespace {

std::string body_word(BodyKind body) {
  constexpr const char* words[] = {"lily", "ball", "point"};
  return words[static_cast<std::size_t>(body)];
}

/// "3 gap (marked), 1 jump (cut)".
std::string findings_line(const std::vector<Finding>& findings) {
  std::string out;
  for (int i = 0; i < kChecks; ++i) {
    const auto check = static_cast<Check>(i);
    const auto count = std::count_if(findings.begin(), findings.end(),
                                     [&](const Finding& f) { return f.check == check; });
    if (count == 0) continue;
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + check_word(check);
  }
  return out.empty() ? "none" : out;
}

/// "2 rows without identity, 4 sightings without a position, of 900 rows read"; "" if nothing is.
std::string left_out_line(const RowCounts& counts) {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (counts.without_identity > 0) {
    add(counted(counts.without_identity, "row") + " without identity");
  }
  if (counts.not_seen > 0) add(counted(counts.not_seen, "sighting") + " without a position");
  if (!out.empty()) out += ", of " + counted(counts.read, "row") + " read";
  return out;
}

struct Numbers {
  std::size_t bodies = 0, seen = 0, frames = 0;
  double farthest = 0, typical_step = 0;
};

Numbers numbers_of(const Recording& r) {
  Numbers n;
  std::vector<double> steps, over_holes;  // m a frame
  std::int64_t last = -1;
  for (const Track& track : r.tracks) {
    n.bodies += n.bodies == 0 || track.id != last ? 1 : 0;
    last = track.id;
    n.frames += track.x.size();
    for (std::size_t i = 0; i < track.x.size(); ++i) {
      if (std::isnan(track.x[i])) continue;
      ++n.seen;
      n.farthest = std::max(n.farthest, std::hypot(track.x[i], track.y[i]));
      std::size_t before = i;
      while (before > 0 && std::isnan(track.x[before - 1])) --before;
      if (before == 0) continue;
      const std::size_t from = before - 1;
      const double way = std::hypot(track.x[i] - track.x[from], track.y[i] - track.y[from]);
      (from + 1 == i ? steps : over_holes).push_back(way / static_cast<double>(i - from));
    }
  }
  if (steps.empty()) steps = std::move(over_holes);
  if (!steps.empty()) n.typical_step = median(std::move(steps));
  return n;
}

void print_tracks(const CheckedRecording& checked, const RecordingOptions& options) {
  const Recording& r = checked.recording;
  const Numbers n = numbers_of(r);
  const double share =
      static_cast<double>(n.seen) / (static_cast<double>(n.bodies) * static_cast<double>(r.frames));
  std::cout << "  clock     " << counted(r.frames, "frame") << " at " << significant(r.rate, 6)
            << " /s, from " << significant(r.start, 6) << " s to "
            << significant(r.time(r.frames - 1), 6) << " s"
            << (checked.frame_step > 1
                    ? "; frame numbers have a common step of " + std::to_string(checked.frame_step)
                    : "")
            << "\n"
            << "  bodies    " << n.bodies << " in " << counted(r.tracks.size(), "track")
            << ", seen " << significant(100 * share, 4) << " % of the time"
            << (r.has_heading() ? ", with headings" : "") << "\n"
            << "  places    up to " << significant(n.farthest, 4) << " m from the centre";
  if (options.in_tank)
    std::cout << " of a tank of radius " << shortest(options.tank_radius) << " m";
  std::cout << ", median step " << significant(1000 * n.typical_step, 3) << " mm ("
            << significant(n.typical_step * r.rate, 3) << " m/s)\n";
}

// How modules were latched, as their poses show it.
struct SeenBonds {
  std::size_t bonds = 0, at_begin = 0;  // in all, and in the first frame
  double share = 0;                     // bonds per module, mean over time
};
std::optional<SeenBonds> bonds_of(const Recording& r, const RecordingOptions& options) {
  if (r.body != BodyKind::lily || !r.latches || !r.has_heading()) return std::nullopt;
  SeenBonds out;
  double frames = 0, modules = 0;
  for (const SeenBond& bond : seen_bonds(r, 2 * options.body_radius)) {
    out.bonds += 1, frames += bond.end - bond.begin;
    out.at_begin += bond.begin == 0 ? 1 : 0;
  }
  for (const Track& t : r.tracks) modules += static_cast<double>(t.x.size());
  out.share = modules > 0 ? frames / modules : 0;
  return out;
}

void print_bonds(const NamedRecording& named, const Recording& r) {
  if (const auto seen = bonds_of(r, named.options)) {
    std::cout << "  bonds     " << seen->bonds << " seen, on average "
              << significant(seen->share, 2) << " per module, " << seen->at_begin
              << " in the first frame\n";
  }
  if (named.options.events.empty()) return;
  std::cout << "  events    " << read_event_log(named.options.events).size() << " in "
            << named.options.events << "\n";
}

void print_info(const NamedRecording& named, const CheckedRecording& checked) {
  const Recording& r = checked.recording;
  std::cout << named.name << "\n  format    " << format_word(checked.format) << ", "
            << counted(checked.files.size(), "file") << ", " << counted(checked.rows, "row")
            << "; body " << body_word(r.body)
            << (r.body == BodyKind::lily && !r.latches ? ", latches off" : "")
            << (r.held_out ? ", held out" : "") << "\n";
  if (!checked.unused_columns.empty()) {
    std::cout << "  not used  " << joined(checked.unused_columns, ", ") << "\n";
  }
  const std::string left_out = left_out_line(checked.counts);
  if (!left_out.empty()) std::cout << "  left out  " << left_out << "\n";
  if (!checked.times.empty()) std::cout << "  times     " << checked.times << "\n";
  if (checked.comment_lines > 0) {
    std::cout << "  comments  " << counted(checked.comment_lines, "comment line")
              << " passed over\n";
  }
  if (!checked.refused()) {
    print_tracks(checked, named.options);
    print_bonds(named, r);
  } else if (checked.identities > 0) {
    std::cout << "  bodies    " << checked.identities << "\n";
  }
  std::cout << "  findings  " << findings_line(checked.findings) << "\n";
  for (const Finding& finding : checked.findings) {
    if (finding.treatment != Treatment::refuse) continue;
    std::cout << "  refused   " << finding.text() << "\n";
    break;
  }
}

Json info_json(const NamedRecording& named, const CheckedRecording& checked) {
  const Recording& r = checked.recording;
  Json findings = Json::object();
  for (const Finding& f : checked.findings) {
    Json& count = findings[check_word(f.check)];
    count = count.is_null() ? 1 : count.get<int>() + 1;
  }
  Json out{{"name", named.name},        {"format", format_word(checked.format)},
           {"files", checked.files},    {"rows", checked.rows},
           {"body", body_word(r.body)}, {"latches", r.latches},
           {"held_out", r.held_out},    {"refused", checked.refused()},
           {"findings", findings}};
  if (checked.refused()) return out;
  const Numbers n = numbers_of(r);
  out.update({{"frames", r.frames},
              {"rate", r.rate},
              {"start", r.start},
              {"bodies", n.bodies},
              {"tracks", r.tracks.size()},
              {"headings", r.has_heading()},
              {"sightings", n.seen},
              {"farthest", n.farthest},
              {"median_step", n.typical_step}});
  if (const auto seen = bonds_of(r, named.options)) {
    out["bonds"] = seen->bonds, out["bonds_per_module"] = seen->share;
    out["bonds_in_first_frame"] = seen->at_begin;
  }
  if (!named.options.events.empty()) {
    out["events"] = read_event_log(named.options.events).size();
  }
  return out;
}

/// Identity as the file writes it; "" if the finding is of no body.
std::string identity_text(const Finding& f) {
  return f.id < 0 ? "" : f.name.empty() ? std::to_string(f.id) : f.name;
}

std::string csv_row(const Finding& f) {
  std::string what = f.what;
  std::replace(what.begin(), what.end(), ',', ';');
  std::replace(what.begin(), what.end(), '"', '\'');
  return f.place.file + "," + (f.place.line > 0 ? std::to_string(f.place.line) : "") + "," +
         (f.frame >= 0 ? std::to_string(f.frame) : "") + "," + identity_text(f) + "," +
         check_word(f.check) + "," + treatment_word(f.treatment) + "," + what + "\n";
}

/// The columns of csv_row(); null where a cell is empty.
Json check_json(const NamedRecording& named, const CheckedRecording& checked) {
  Json findings = Json::array();
  for (const Finding& f : checked.findings) {
    const std::string id = identity_text(f);
    findings.push_back({{"file", f.place.file},
                        {"line", f.place.line > 0 ? Json(f.place.line) : Json()},
                        {"frame", f.frame >= 0 ? Json(f.frame) : Json()},
                        {"id", id.empty() ? Json() : Json(id)},
                        {"check", check_word(f.check)},
                        {"treatment", treatment_word(f.treatment)},
                        {"what", f.what}});
  }
  return {{"name", named.name},
          {"rows", checked.rows},
          {"rows_without_identity", checked.counts.without_identity},
          {"sightings_without_position", checked.counts.not_seen},
          {"tracks", checked.recording.tracks.size()},
          {"refused", checked.refused()},
          {"findings", findings}};
}

/// Findings, of each kind so many that one reads them.
void print_findings(const std::vector<Finding>& findings, bool all) {
  constexpr int kShown = 10;
  std::array<int, kChecks> shown{};
  for (const Finding& finding : findings) {
    if (all || ++shown[static_cast<std::size_t>(finding.check)] <= kShown) {
      std::cout << finding.text() << "\n";
    }
  }
  if (all) return;
  for (int i = 0; i < kChecks; ++i) {
    const int more = shown[static_cast<std::size_t>(i)] - kShown;
    if (more > 0) {
      std::cout << "... and " << more << " more of kind " << check_word(static_cast<Check>(i))
                << " (--all shows them)\n";
    }
  }
}

void print_check(const NamedRecording& named, const CheckedRecording& checked, bool all) {
  print_findings(checked.findings, all);
  std::cout << named.name << ": " << counted(checked.rows, "row")
            << (checked.comment_lines > 0
                    ? ", " + counted(checked.comment_lines, "comment line") + " passed over"
                    : "")
            << ", findings: " << findings_line(checked.findings);
  if (checked.refused()) {
    std::cout << "; refused\n";
  } else {
    std::cout << "; " << counted(checked.recording.tracks.size(), "track") << "\n";
  }
  const std::string left_out = left_out_line(checked.counts);
  if (!left_out.empty()) std::cout << "left out: " << left_out << "\n";
}

/// Calls act for every recording; complaints about one do not keep the others back.
template <class Act>
int for_each(const std::vector<NamedRecording>& all, const Act& act) {
  int code = Exit::done;
  for (const NamedRecording& named : all) {
    try {
      const CheckedRecording checked = check_recording(named.files, named.options);
      act(named, checked);
      if (checked.refused()) code = Exit::bad_input;
    } catch (const InputError& e) {
      std::cout << std::flush;
      std::cerr << printable(e.what()) << "\n";
      code = Exit::bad_input;
    }
  }
  return code;
}

}  // namespace

int recording_info(const Arguments& arguments) {
  VerbOptions options("recording info", "FILE...",
                      "Describes recordings: bodies, frames, gaps and faults.");
  add_reading_options(options);
  options.add({"json", "print JSON; lengths in m, times in s"});
  if (!options.parse(arguments)) return Exit::done;
  const std::vector<NamedRecording> all = named_recordings(options, options.positional());
  if (!options.has("json")) return for_each(all, print_info);
  Json out = Json::array();
  const int code = for_each(all, [&](const NamedRecording& named, const CheckedRecording& checked) {
    out.push_back(info_json(named, checked));
  });
  std::cout << json_text(out) << std::flush;
  return code;
}

int recording_check(const Arguments& arguments) {
  VerbOptions options("recording check", "FILE...",
                      "Names everything in recordings that looks wrong, with file, frame and id, "
                      "and what is done about it. Exit code 2: not usable as it is.");
  add_reading_options(options);
  options.add({"all", "show every finding, not ten of a kind"});
  options.add({"csv", "write the findings to a table", "FILE"});
  options.add({"json", "print JSON with every finding"});
  options.add({"force", "replace a file of other contents"});
  if (!options.parse(arguments)) return Exit::done;
  if (options.has("json")) options.refuse_given({"all"}, "has no effect with --json");
  const std::vector<NamedRecording> all = named_recordings(options, options.positional());
  options.spare_inputs("csv", options.text("csv"), files_read(all, options.positional()));
  std::string csv = "file,line,frame,id,check,treatment,what\n";
  Json json = Json::array();
  const auto act = [&](const NamedRecording& named, const CheckedRecording& checked) {
    if (options.has("json")) {
      json.push_back(check_json(named, checked));
    } else {
      print_check(named, checked, options.has("all"));
    }
    for (const Finding& finding : checked.findings) csv += csv_row(finding);
  };
  const int code = for_each(all, act);
  if (options.has("json")) std::cout << json_text(json) << std::flush;
  if (options.has("csv")) write_results({{options.text("csv"), csv}}, options.has("force"));
  return code;
}

}  // namespace lilytank::cli
