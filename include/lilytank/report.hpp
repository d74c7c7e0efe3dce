// A report as a document: built once by a job, then written as text or as a page.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace lilytank {

/// A table of cells that are ready to print.
struct ReportTable {
  /// Titles of the columns, with units.
  std::vector<std::string> head;
  /// As many cells each as the head.
  std::vector<std::vector<std::string>> rows;
};

/// A heading with paragraphs, a table, and paragraphs below the table; each may be empty.
struct ReportSection {
  /// "Diagnosis of tank".#2
  std::string title;
  /// Paragraphs between heading and table.
  std::vector<std::string> above;
  ReportTable table;
  /// Paragraphs below the table: notes, units, sources.
  std::vector<std::string> below;
  /// Folded on a page until the reader opens it.
  bool detail = false;
};

/// Colour of the verdict on a page. good: the result is as intended. finding: an effect was found.
/// fault: the result is not to be trusted, as by a bad fit or too few data.
enum class ReportTone { neutral, good, finding, fault };

/// The summary on top of a report.
struct ReportCard {
  ReportTone tone = ReportTone::neutral;
  /// One sentence without a full stop.
  std::string verdict;
  /// Name and value: "where", "how large", ...
  std::vector<std::pair<std::string, std::string>> facts;
};

/// Where the numbers come from.
struct ReportProvenance {
  /// Command line, program version and seed, ready to print.
  std::string command, version, seed;
  /// File, SHA-256 of its content.
  std::vector<std::pair<std::string, std::string>> inputs;
};

/// The whole report. Text, JSON and HTML hold the same numbers.
struct ReportDocument {
  std::string title;  ///< "Diagnosis of tank"
  /// The data, in one line.
  std::string subtitle;
  /// Verdict and facts.
  ReportCard card;
  std::vector<ReportSection> sections;
  /// One sentence each, printed above the sections.
  std::vector<std::string> warnings;
  /// Filled in by the program, not by the job that builds the report.
  ReportProvenance provenance;
};

/// The report as plain text for a terminal or a file: tables in aligned columns, ends in a new
/// line.
std::string report_text(const ReportDocument& report);

/// The report as a JSON object: title, subtitle, verdict, facts, sections with their tables as
/// printed, warnings, provenance.
std::string report_json(const ReportDocument& report);

/// A figure of a page.
struct ReportPicture {
  /// The figure as SVG.
  std::string svg;
  /// Unique on the page: prefix of the identifiers in its SVG.
  std::string name;
  /// What a reader sees in it; also its alternative text.
  std::string caption;
};

/// The report as one page of HTML without outside references. The first picture follows the
/// verdict, the others follow the sections. All texts are escaped.
std::string report_html(const ReportDocument& report, const std::vector<ReportPicture>& pictures);

}  // namespace lilytank
