// A report as a document: built once by a job, then written as text or as a page.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace lilytank {

/// A table of cells that are ready to print.
struct ReportTable {
  std::vector<std::string> head;               ///< titles of the columns, with units
  std::vector<std::vector<std::string>> rows;  ///< as many cells each as the head
};

/// A heading with paragraphs, a table, and paragraphs below the table; each may be empty.
struct ReportSection {
  std::string title;               ///< "Diagnosis of tank".#2
  std::vector<std::string> above;  ///< paragraphs between heading and table
  ReportTable table;
  std::vector<std::string> below;  ///< paragraphs below the table: notes, units, sources
  bool detail = false;             ///< folded on a page until the reader opens it
};

/// Colour of the verdict on a page. good: the result is as intended. finding: an effect was found.
/// fault: the result is not to be trusted, as by a bad fit or too few data.
enum class ReportTone { neutral, good, finding, fault };

/// The summary on top of a report.
struct ReportCard {
  ReportTone tone = ReportTone::neutral;
  std::string verdict;  ///< one sentence without a full stop
  /// Name and value: "where", "how large", ...
  std::vector<std::pair<std::string, std::string>> facts;
};

/// Where the numbers come from.
struct ReportProvenance {
  std::string command, version, seed;  ///< command line, program version and seed, ready to print
  std::vector<std::pair<std::string, std::string>> inputs;  ///< file, SHA-256 of its content
};

/// The whole report. Text, JSON and HTML hold the same numbers.
struct ReportDocument {
  std::string title;     ///< "Diagnosis of tank"
  std::string subtitle;  ///< the data, in one line
  ReportCard card;       ///< verdict and facts
  std::vector<ReportSection> sections;
  std::vector<std::string> warnings;  ///< one sentence each, printed above the sections
  ReportProvenance provenance;  ///< filled in by the program, not by the job that builds the report
};

/// The report as plain text for a terminal or a file: tables in aligned columns, ends in a new
/// line.
std::string report_text(const ReportDocument& report);

/// The report as a JSON object: title, subtitle, verdict, facts, sections with their tables as
/// printed, warnings, provenance.
std::string report_json(const ReportDocument& report);

/// A figure of a page.
struct ReportPicture {
  std::string svg;      ///< the figure as SVG
  std::string name;     ///< unique on the page: prefix of the identifiers in its SVG
  std::string caption;  ///< what a reader sees in it; also its alternative text
};

/// The report as one page of HTML without outside references. The first picture follows the
/// verdict, the others follow the sections. All texts are escaped.
std::string report_html(const ReportDocument& report, const std::vector<ReportPicture>& pictures);

}  // namespace lilytank
