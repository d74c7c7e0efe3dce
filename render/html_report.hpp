// A page of figures and text in one file, as a browser shows it, and what reports draw alike.
#pragma once
#include <string>
#include <vector>

#include "lilytank/render.hpp"
#include "lilytank/report.hpp"

namespace lilytank {

/// Draws the figures in a directory, each as .png and .svg, and writes report.html, one file with
/// the report and all of them. A figure without plots and maps has its .svg there already. Throws
/// InputError if a file cannot be written.
void write_html_report(const ReportDocument& report, const std::vector<Figure>& figures,
                       const std::string& dir);

/// Values in another unit.
std::vector<double> divided(std::vector<double> values, double by);

/// A panel of one component of a mean velocity, without its range and label.
MapPanel velocity_panel(const std::string& title, const VelocityMap& map,
                        const std::vector<double>& values);

}  // namespace lilytank
