// A page of figures and text in one file, as a browser shows it.
#pragma once
#include <string>
#include <vector>

#include "lilytank/render.hpp"
#include "lilytank/report.hpp"

namespace lilytank {

/// A plot of a report.
struct ReportFigure {
  std::string name;     ///< of its files, without ending
  std::string caption;  ///< what a reader sees in it
  PlotPage page;
};

/// Draws the figures in a directory, each as .png and .svg, and writes report.html, one file with
/// the report and all of them. Returns the files' names. Throws InputError if they cannot be
/// written.
std::vector<std::string> write_html_report(const ReportDocument& report,
                                           const std::vector<ReportFigure>& figures,
                                           const std::string& dir);

/// The same with figures that lie in the directory already, pairs of name and caption.
void write_html_report(const ReportDocument& report,
                       const std::vector<std::pair<std::string, std::string>>& figures,
                       const std::string& dir);

}  // namespace lilytank
