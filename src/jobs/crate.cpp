// Provenance of results as an RO-Crate, for archives and workflow systems.
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "io/sha256.hpp"
#include "jobs/run_directory.hpp"
#include "lilytank/data_file.hpp"
#include "lilytank/error.hpp"
#include "lilytank/report.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProcess = "https://w3id.org/ro/wfrun/process/0.5";
constexpr const char* kCrate = "https://w3id.org/ro/crate/1.1";

Json reference(const std::string& id) {
  return {{"@id", id}};
}

/// The lines of a text report below "Provenance": command, version and seed, hashes of inputs.
ReportProvenance provenance_in(const std::string& text) {
  ReportProvenance out;
  const std::string head = "\nProvenance\n  ";
  const std::size_t at = text.rfind(head);
  if (at == text.npos) return out;
  std::vector<std::string> lines;
  for (std::size_t from = at + head.size() - 2; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    if (end - from < 2 || text.compare(from, 2, "  ") != 0) break;
    lines.push_back(text.substr(from + 2, end - from - 2));
    from = end + 1;
  }
  if (lines.size() < 2) return out;
  out.command = lines[0];
  const std::string word = "lilytank ", seed = ", seed ";
  const std::size_t comma = lines[1].find(seed);
  out.version = lines[1].substr(word.size(), comma - word.size());
  if (comma != lines[1].npos) out.seed = lines[1].substr(comma + seed.size());
  constexpr std::size_t kHash = 64;
  for (std::size_t k = 2; k < lines.size(); ++k) {
    if (lines[k].size() > kHash + 2)
      out.inputs.emplace_back(lines[k].substr(kHash + 2), lines[k].substr(0, kHash));
  }
  return out;
}

ReportProvenance provenance_of_run(const fs::path& dir) {
  ReportProvenance out;
  const Json summary = json_or_discarded(read_whole((dir / run_file::summary_json).string()));
  if (!summary.is_object() || !summary.contains("program")) return out;
  const std::string program = summary["program"];
  out.command = std::string("lilytank run ") + run_file::resolved;
  out.version = program.substr(program.find(' ') + 1);
  out.seed = std::to_string(summary.value("seed", std::uint64_t{0}));
  out.inputs.emplace_back(run_file::resolved,
                          sha256(read_whole((dir / run_file::resolved).string())));
  return out;
}

std::vector<fs::path> files_in(const fs::path& dir) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(dir)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !name.starts_with(".") && name != kCrateFile)
      out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

ReportProvenance provenance_of(const fs::path& dir, const std::vector<fs::path>& files) {
  if (exists((dir / run_file::summary_json).string()) &&
      exists((dir / run_file::resolved).string()))
    return provenance_of_run(dir);
  for (const fs::path& file : files) {
    if (file.extension() != ".txt") continue;
    ReportProvenance found = provenance_in(read_whole(file.string()));
    if (!found.command.empty()) return found;
  }
  throw InputError("'" + dir.string() + "' holds no report with its provenance (a *.txt file)");
}

const char* type_of(const fs::path& file) {
  static const std::vector<std::pair<const char*, const char*>> types{
      {".csv", "text/csv"},         {".json", "application/json"}, {".toml", "application/toml"},
      {".txt", "text/plain"},       {".html", "text/html"},        {".png", "image/png"},
      {".svg", "image/svg+xml"},    {".pdf", "application/pdf"},   {".mp4", "video/mp4"},
      {".nc", "application/netcdf"}};
  for (const auto& [ending, type] : types) {
    if (file.extension() == ending) return type;
  }
  return "application/octet-stream";
}

// Of the file system: results have the same crate whenever it is made.
std::string time_of(const std::vector<fs::path>& files) {
  fs::file_time_type newest = fs::file_time_type::min();
  for (const fs::path& file : files) newest = std::max(newest, fs::last_write_time(file));
  const auto seconds =
      std::chrono::floor<std::chrono::seconds>(std::chrono::file_clock::to_sys(newest));
  const auto day = std::chrono::floor<std::chrono::days>(seconds);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(seconds - day);
  const auto two = [](auto value) {
    const std::string digits = std::to_string(value);
    return digits.size() < 2 ? "0" + digits : digits;
  };
  return std::to_string(static_cast<int>(date.year())) + "-" +
         two(static_cast<unsigned>(date.month())) + "-" + two(static_cast<unsigned>(date.day())) +
         "T" + two(time.hours().count()) + ":" + two(time.minutes().count()) + ":" +
         two(time.seconds().count()) + "Z";
}

}  // namespace

std::string crate_of_results(const std::string& dir, const std::string& license) {
  require_path(dir);
  if (!fs::is_directory(dir)) throw InputError("'" + dir + "' is not a directory of results");
  const std::vector<fs::path> files = files_in(dir);
  const ReportProvenance origin = provenance_of(dir, files);
  const std::string time = time_of(files), program = "#lilytank-" + origin.version;
  const std::string name = fs::weakly_canonical(dir).filename().string();
  Json graph = Json::array(), parts = Json::array(), inputs = Json::array();
  graph.push_back({{"@id", kCrateFile},
                   {"@type", "CreativeWork"},
                   {"conformsTo", reference(kCrate)},
                   {"about", reference("./")}});
  Json described = Json::array();
  for (const fs::path& file : files) {
    const std::string id = file.filename().string(), bytes = read_whole(file.string());
    parts.push_back(reference(id));
    described.push_back({{"@id", id},
                         {"@type", "File"},
                         {"name", id},
                         {"encodingFormat", type_of(file)},
                         {"contentSize", std::to_string(bytes.size())},
                         {"sha256", sha256(bytes)}});
  }
  for (const auto& [file, hash] : origin.inputs) {
    const bool inside = std::find(parts.begin(), parts.end(), reference(file)) != parts.end();
    const std::string id = inside ? file : "#input-" + hash;
    if (std::find(inputs.begin(), inputs.end(), reference(id)) != inputs.end()) continue;
    inputs.push_back(reference(id));
    if (!inside)
      described.push_back(
          {{"@id", id}, {"@type", "CreativeWork"}, {"name", file}, {"sha256", hash}});
  }
  Json root{{"@id", "./"},           {"@type", "Dataset"},
            {"name", name},          {"description", "Results of " + origin.command},
            {"datePublished", time}, {"conformsTo", reference(kProcess)},
            {"hasPart", parts},      {"mentions", reference("#run")}};
  if (!license.empty()) {
    root["license"] = reference(license);
    described.push_back({{"@id", license}, {"@type", "CreativeWork"}, {"name", license}});
  }
  graph.push_back(std::move(root));
  graph.push_back({{"@id", kProcess},
                   {"@type", "CreativeWork"},
                   {"name", "Process Run Crate"},
                   {"version", "0.5"}});
  graph.push_back({{"@id", "#run"},
                   {"@type", "CreateAction"},
                   {"name", origin.command},
                   {"description", "random seed " + (origin.seed.empty() ? "none" : origin.seed)},
                   {"instrument", reference(program)},
                   {"object", inputs},
                   {"result", parts},
                   {"endTime", time}});
  graph.push_back({{"@id", program},
                   {"@type", "SoftwareApplication"},
                   {"name", "lilytank"},
                   {"softwareVersion", origin.version}});
  for (Json& entity : described) graph.push_back(std::move(entity));
  const Json context =
      Json::array({std::string(kCrate) + "/context", {{"sha256", "https://schema.org/sha256"}}});
  return json_text({{"@context", context}, {"@graph", std::move(graph)}});
}

}  // namespace lilytank
