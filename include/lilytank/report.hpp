// A report as a document: built once by a job, then written as text or as a page.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace lilytank {

/// A table of cells that are ready to print.
struct ReportTable {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< as many cells each as the head
};

/// A heading with paragraphs, a table, and paragraphs below the table; each may be empty.
struct ReportSection {
  std::string title;
  std::vector<std::string> above;
  ReportTable table;
  std::vector<std::string> below;
  bool detail = false;  ///< folded on a page
};

/// How the verdict is coloured on a page.
enum class ReportTone { neutral, good, finding, fault };

/// What a reader takes away in ten seconds.
struct ReportCard {
  ReportTone tone = ReportTone::neutral;
  std::string verdict;                                     ///< one sentence without a full stop
  std::vector<std::pair<std::string, std::string>> facts;  ///< "where", "how large", ...
};

/// Where the numbers come from.
struct ReportProvenance {
  std::string command, version, seed;
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file, SHA-256 of its content
};

struct ReportDocument {
  std::string title;     ///< "Diagnosis of tank"
  std::string subtitle;  ///< the data, in one line
  ReportCard card;
  std::vector<ReportSection> sections;
  std::vector<std::string> warnings;
  ReportProvenance provenance;
};

/// The report for a terminal or a text file.
std::string report_text(const ReportDocument& report);

/// The report as a JSON object: title, subtitle, verdict, facts, sections with their tables as
/// printed, warnings, provenance.
std::string report_json(const ReportDocument& report);

/// A figure of a page.
struct ReportPicture {
  std::string svg;      ///< the file's content
  std::string name;     ///< unique on the page
  std::string caption;  ///< what a reader sees in it; also its alternative text
};

/// The report as one page of HTML without outside references. The first picture follows the
/// verdict, the others follow the sections. All texts are escaped.
std::string report_html(const ReportDocument& report, const std::vector<ReportPicture>& pictures);

}  // namespace lilytank
