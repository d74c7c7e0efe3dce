#include <algorithm>
#include <cmath>

#include "axes.hpp"
#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/median.hpp"
#include "statistics/quantiles.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

double scale_of(const FoundCurve& c) {
  return c.value_unit == "N m" ? 1e6 : c.value_unit == "N" ? 1e3 : 1;
}
std::string unit_of(const FoundCurve& c) {
  if (c.value_unit == "N m") return "torque (\u00b5N m)";
  if (c.value_unit == "N") return "force (mN)";
  return "acceleration (" + with_superscripts(c.value_unit) + ")";
}

// A value that is this much less certain than most of its curve has almost no data: bodies
// were hardly ever there.
constexpr double kLeastCertain = 20;

std::string with_z(const char* what, double z) {
  return std::string(", z of the ") + what + " " + number(z, 1);
}

// One curve with the band of the null hypothesis; gaps where the data do not constrain it.
Plot curve_plot(const FoundCurve& c, const DiagnosisSubject& of, bool small) {
  Plot plot;
  plot.title = c.direction;
  plot.x_label = text_for(of.variables, c.variable) + " (" + with_superscripts(c.unit) + ")";
  plot.y_label = unit_of(c);
  plot.zero_line = true;
  if (!c.at.empty()) {
    const auto [first, last] = std::minmax_element(c.at.begin(), c.at.end());
    plot.x_low = *first, plot.x_high = *last;
  }
  if (small) plot.width = 460, plot.height = 330;
  const double half_width = normal_half_width() * scale_of(c);
  const double scale = scale_of(c), most = kLeastCertain * median(c.deviation);
  Curve nothing{"null, 95 %", c.at, {}, {}, {}}, found{"estimate", c.at, {}, {}, {}};
  for (std::size_t k = 0; k < c.at.size(); ++k) {
    const double gap = c.deviation[k] > most ? NAN : 1, band = half_width * c.deviation[k];
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
  std::vector<FoundCurve> maps = d.maps;
  std::stable_sort(maps.begin(), maps.end(),
                   [](const FoundCurve& a, const FoundCurve& b) { return a.z > b.z; });
  for (const FoundCurve& c : maps) {
    if (page.plots.size() >= 12) break;
    page.plots.push_back(curve_plot(c, *d.subject, true));
    // The z of a body's map measures its scatter, not the evidence for a finding.
    if (d.subject->curves_tested) page.plots.back().title += with_z("curve", c.z);
  }
  return page;
}

PlotPage laws_page(const Diagnosis& d) {
  PlotPage page;
  page.columns = 2;
  for (const DiagnosisFinding& f : d.findings) {
    if (f.curve.at.empty()) continue;
    Plot plot = curve_plot(f.curve, *d.subject, false);
    plot.title = f.effect + ": " + plot.title + with_z("law", f.z);
    plot.title += d.subject->curves_of;
    page.plots.push_back(std::move(plot));
  }
  return page;
}

// Of cells, the mean over the places of the hexagonal grid by their distance.
constexpr int kMapCells = 60;

MapPanel places_panel(const DiagnosisFinding& f) {
  const PlaceMap& map = f.places;
  MapPanel out;
  out.title = f.effect;
  out.cells = kMapCells, out.extent = map.tank_radius;
  const bool vector = map.components.size() == 2;
  if (!vector) out.scale = ColourScale::diverging;
  out.label = (vector ? "speed" : map.components[0]) +
              (map.units[0] == "1" ? "" : " (" + with_superscripts(map.units[0]) + ")");
  for (int k = 0; k < kMapCells * kMapCells; ++k) {
    const double cell = 2 * out.extent / kMapCells;
    const double x = (k % kMapCells + 0.5) * cell - out.extent;
    const double y = (k / kMapCells + 0.5) * cell - out.extent;
    double all = 0, sum[2] = {0, 0};
    for (const PlaceMap::Place& place : map.places) {
      const double off = std::hypot(place.x - x, place.y - y) / (0.5 * map.width);
      const double weight = std::exp(-0.5 * off * off);
      all += weight;
      for (std::size_t c = 0; c < place.value.size() && c < 2; ++c) {
        sum[c] += weight * place.value[c];
      }
    }
    const double least = std::exp(-0.5 * 4);  // one place at the effect's width
    const double vx = all > least ? sum[0] / all : NAN, vy = all > least ? sum[1] / all : NAN;
    out.values.push_back(vector ? std::hypot(vx, vy) : vx);
    if (vector) out.arrow_x.push_back(vx), out.arrow_y.push_back(vy);
  }
  if (vector) out.arrow_unit = map.units[0];
  double ring[3] = {NAN, NAN, NAN};
  for (const FoundParameter& p : f.parameters) {
    if (p.name == "x") ring[0] = p.value;
    if (p.name == "y") ring[1] = p.value;
    if (p.name == "width" || p.name == "radius") ring[2] = p.value;
  }
  if (!std::isnan(ring[0] + ring[1] + ring[2])) out.rings = {{ring[0], ring[1], ring[2]}};
  return out;
}

Map places_map(const Diagnosis& d) {
  Map map;
  for (const DiagnosisFinding& f : d.findings) {
    if (f.places.places.empty()) continue;
    map.panels.push_back(places_panel(f)), map.tank_radius = f.places.tank_radius;
  }
  map.columns = static_cast<int>(map.panels.size());
  return map;
}

// Mean squares of deviations, a row a group of numbers; of bodies, a row a group of them.
Plot fit_plot(const Diagnosis& d) {
  Plot plot;
  const DiagnosisSubject& of = *d.subject;
  if (const double removed = d.removed(); removed > 0) {
    plot.title =
        "The findings remove " + number(100 * removed, 0) + " % of the mismatch beyond chance.";
  }
  plot.x_label = of.measure_axis;
  constexpr double kRoom = 1.2;  // beside the outermost, chance included
  plot.log_x = true, plot.x_low = 1 / kRoom, plot.x_high = kRoom;
  plot.height = std::max(220, 120 + 36 * static_cast<int>(d.held_out.size()));
  Curve before{"baseline", {}, {}, {}, {}}, after{"with the findings", {}, {}, {}, {}};
  Curve chance{
      std::string(of.chance), {1, 1}, {-0.5, static_cast<double>(d.held_out.size()) - 0.5}, {}, {}};
  for (std::size_t k = 0; k < d.held_out.size(); ++k) {
    const std::string& group = d.held_out[k].group;
    plot.y_names.push_back(text_for(of.group_names, group));
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

}  // namespace

void draw_diagnosis(const Diagnosis& d, const ReportDocument& report, const std::string& dir,
                    const FigureStyle& style) {
  std::vector<Figure> figures;
  const std::string n = counted(d.recordings, "recording") + " of " + std::to_string(d.modules) +
                        " " + std::string(d.subject->bodies);
  const auto add = [&](const std::string& name, const std::string& caption, const PlotPage& page,
                       const std::string& band) {
    if (!page.plots.empty()) figures.push_back({name, caption, page, {}, {}, n, band});
  };
  const std::string null = "95 % of the null hypothesis";
  add("laws",
      "Where each finding acts: what the baseline leaves unexplained (dots), and how far it would "
      "be off by chance (band).",
      laws_page(d), null);
  if (Map places = places_map(d); !places.panels.empty()) {
    std::string laws;
    for (const DiagnosisFinding& f : d.findings) {
      if (!f.places.places.empty()) laws += " " + f.effect + ": " + f.equation + ".";
    }
    figures.push_back({"places",
                       "Where in the tank the effect would be, estimated about each place alone, "
                       "and its place and width in the fit (circle)." +
                           laws,
                       {},
                       std::move(places),
                       {},
                       n});
  }
  if (!d.held_out.empty()) {
    add("fit", std::string(d.subject->fit(d.nothing_held_out).figure_caption), {{fit_plot(d)}}, "");
  }
  add("maps",
      "Maps of the one-step innovations" + std::string(d.subject->curves_of) +
          ", strongest first: what the baseline leaves unexplained (line), and 95 % of what chance "
          "would (band). A curve assumes no formula, so its z is usually below that of a law that "
          "fits. Values that the data hardly constrain are not drawn.",
      maps_page(d), null);
  write_html_report(report, figures, dir, style);
}

}  // namespace lilytank
