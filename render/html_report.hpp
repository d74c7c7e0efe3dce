// A page of figures and text in one file, as a browser shows it.
#pragma once
#include <string>
#include <vector>

#include "lilytank/render.hpp"

namespace lilytank {

struct ReportFigure {
  std::string name;     ///< of its files, without ending
  std::string caption;  ///< what a reader sees in it
  PlotPage page;
};

/// Draws the figures in a directory, each as .png and .svg, and report.html, one file with all of
/// them and `text`. Returns the files' names. Throws InputError if they cannot be written.
std::vector<std::string> write_html_report(const std::string& title,
                                           const std::vector<ReportFigure>& figures,
                                           const std::string& text, const std::string& dir);

}  // namespace lilytank
