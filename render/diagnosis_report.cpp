#include <algorithm>
#include <cmath>
#include <map>

#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/median.hpp"
#include "statistics/quantiles.hpp"

namespace lilytank {
namespace {

double scale_of(const FoundCurve& c) {
  return c.value_unit == "N m" ? 1e6 : c.value_unit == "N" ? 1e3 : 1;
}
std::string unit_of(const FoundCurve& c) {
  if (c.value_unit == "N m") return "torque (\u00b5N m)";
  return c.value_unit == "N" ? "force (mN)" : "acceleration (" + c.value_unit + ")";
}

// What the horizontal axis of a curve shows, of Lilies in a tank or of other bodies.
std::string label_of(const FoundCurve& c, bool tank) {
  const std::map<std::string, std::string> kLabels = {
      {"radius", "distance from the centre"},
      {"pair", tank ? "gap to another module" : "gap to another body"},
      {"slip", tank ? "speed through the water" : "speed"},
      {"position", "position x"},
      {"turn", tank ? "rate of turning" : "speed"},  // of a body: pushes aside, over its speed
  };
  const auto known = kLabels.find(c.variable);
  return (known == kLabels.end() ? c.variable : known->second) + " (" + c.unit + ")";
}

// A value that is this much less certain than most of its curve is told by next to nothing: bodies
// were hardly ever there.
constexpr double kUntold = 20;

std::string with_z(double z) {
  char text[24];
  std::snprintf(text, sizeof text, ", z %.1f", z);
  return text;
}

// One curve with the band in which nothing would lie; gaps where the data tell nothing.
Plot curve_plot(const FoundCurve& c, bool tank, bool small) {
  Plot plot;
  plot.title = c.direction;
  plot.x_label = label_of(c, tank), plot.y_label = unit_of(c);
  plot.zero_line = true;
  if (!c.at.empty()) {
    const auto [first, last] = std::minmax_element(c.at.begin(), c.at.end());
    plot.x_low = *first, plot.x_high = *last;
  }
  if (small) plot.width = 460, plot.height = 330;
  const double half_width = normal_half_width() * scale_of(c);
  const double scale = scale_of(c), untold = kUntold * median(c.deviation);
  Curve nothing{"null, 95 %", c.at, {}, {}, {}}, found{"estimate", c.at, {}, {}, {}};
  for (std::size_t k = 0; k < c.at.size(); ++k) {
    const double gap = c.deviation[k] > untold ? NAN : 1, band = half_width * c.deviation[k];
    nothing.y.push_back(0 * gap), found.y.push_back(c.value[k] * scale * gap);
    nothing.low.push_back(-band * gap), nothing.high.push_back(band * gap);
  }
  if (small) found.name = nothing.name = "";  // the page says what they are
  found.markers = true;
  plot.curves = {found, nothing};
  return plot;
}

PlotPage maps_page(const Diagnosis& d) {
  PlotPage page;
  page.columns = 4;
  page.title = "What the baseline leaves unexplained (line), and 95 % of what chance would (band)";
  if (!d.tank) page.title += ", all bodies together";
  std::vector<FoundCurve> maps = d.maps;
  std::stable_sort(maps.begin(), maps.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.z > b.z; });
  for (const FoundCurve& c : maps) {
    if (page.plots.size() >= 12) break;
    page.plots.push_back(curve_plot(c, d.tank, true));
    // A body's map tells how far it scatters, which is not what a finding's z is about.
    if (d.tank) page.plots.back().title += with_z(c.z);
  }
  return page;
}

PlotPage laws_page(const Diagnosis& d) {
  PlotPage page;
  page.columns = 2;
  for (const DiagnosisFinding& f : d.findings) {
    if (f.curve.at.empty()) continue;
    Plot plot = curve_plot(f.curve, d.tank, false);
    plot.title = f.effect + ": " + plot.title + with_z(f.z);
    if (!d.tank) plot.title += ", all bodies together";
    page.plots.push_back(std::move(plot));
  }
  return page;
}

// A group of numbers in words.
std::string words_for(const std::string& group) {
  static const std::map<std::string, std::string> kWords = {
      {"balance", "balance of momentum"},
      {"camera", "gaps at contact, across the image"},
      {"contact", "bounces"},
      {"displacement", "displacement (MSD)"},
      {"kicks", "process noise between frames"},
      {"module", "differences between modules"},
      {"neighbours", "distance of neighbours"},
      {"noise", "size and memory of gusts"},
      {"place", "place in the tank, mean flow"},
      {"spectrum", "rhythms"},
      {"turning", "turning and its memory"},
      {"velocity", "speed and its memory"},
  };
  const auto known = kWords.find(group);
  return known == kWords.end() ? group : known->second;
}

// Mean squares of deviations, a row a group of numbers; of bodies, a row a group of them.
Plot fit_plot(const Diagnosis& d) {
  Plot plot;
  plot.title = !d.tank ? "A quarter of a run ahead, coefficients of all runs: before and after"
               : d.nothing_held_out
                   ? "Fitted recordings: distance from simulations, before and after"
                   : "Held-out recordings: distance from simulations, before and after";
  plot.x_label = d.tank ? "mean squared z (expected by chance: 1)"
                        : "mean square error / noise of the measurement squared";
  constexpr double kRoom = 1.2;  // beside the outermost, chance included
  plot.log_x = true, plot.x_low = 1 / kRoom, plot.x_high = kRoom;
  plot.height = std::max(220, 120 + 36 * static_cast<int>(d.held_out.size()));
  Curve before{"baseline", {}, {}, {}, {}}, after{"with the findings", {}, {}, {}, {}};
  Curve chance{d.tank ? "chance" : "noise alone",
               {1, 1},
               {-0.5, static_cast<double>(d.held_out.size()) - 0.5},
               {},
               {}};
  for (std::size_t k = 0; k < d.held_out.size(); ++k) {
    const std::string& group = d.held_out[k].group;
    plot.y_names.push_back(d.tank ? words_for(group) : group);
    before.y.push_back(static_cast<double>(k)), after.y.push_back(static_cast<double>(k));
    before.x.push_back(std::max(1e-2, d.held_out[k].before));
    after.x.push_back(std::max(1e-2, d.held_out[k].after));
    for (const double x : {before.x.back(), after.x.back()}) {
      plot.x_low = std::min(plot.x_low, x / kRoom), plot.x_high = std::max(plot.x_high, x * kRoom);
    }
  }
  before.markers = after.markers = true;
  before.line = after.line = false;
  plot.curves = {before, after, chance};
  return plot;
}

std::string fit_caption(const Diagnosis& d) {
  if (d.tank) {
    return std::string("Before and after, on recordings that ") +
           (d.nothing_held_out ? "the fit rests on, as none was held out" : "were not used") +
           ": groups of numbers that describe the motion, each in units of what chance alone would "
           "give.";
  }
  return "Before and after: mean square error of places a quarter of a run ahead, over the square "
         "of the measurement's noise. The coefficients are those fitted to all runs, these "
         "included.";
}

}  // namespace

std::vector<std::string> draw_diagnosis(const Diagnosis& d, const ReportDocument& report,
                                        const std::string& dir) {
  std::vector<ReportFigure> figures;
  if (const PlotPage page = laws_page(d); !page.plots.empty()) {
    figures.push_back({"laws",
                       "Where each finding acts: what the baseline leaves unexplained (dots), and "
                       "how far it would be off by chance (band).",
                       page});
  }
  if (!d.held_out.empty()) {
    figures.push_back({"fit", fit_caption(d), {{fit_plot(d)}, 1}});
  }
  if (!d.maps.empty()) {
    figures.push_back({"maps",
                       "Maps of the one-step innovations, strongest first. Values that the data "
                       "hardly constrain are not drawn.",
                       maps_page(d)});
  }
  return write_html_report(report, figures, dir);
}

}  // namespace lilytank
