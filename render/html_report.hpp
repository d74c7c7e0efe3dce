// A page of figures and text in one file, as a browser shows it, and what reports draw alike.
#pragma once
#include <string>
#include <vector>

#include "lilytank/render.hpp"
#include "lilytank/report.hpp"

namespace lilytank {

/// draw_figures(), and report.html: one file with the report and all figures. A figure without
/// plots, maps and a corner has its pictures there already.
void write_html_report(const ReportDocument& report, const std::vector<Figure>& figures,
                       const std::string& dir, const FigureStyle& style);

/// What is shown, n and the band's level, as sentences.
std::string whole_caption(const Figure& figure);

/// Values in another unit.
std::vector<double> divided(std::vector<double> values, double by);

/// A panel of one component of a mean velocity, without its range and label.
MapPanel velocity_panel(const std::string& title, const VelocityMap& map,
                        const std::vector<double>& values);

}  // namespace lilytank
