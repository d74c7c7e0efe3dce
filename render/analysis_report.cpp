#include <algorithm>
#include <cmath>
#include <map>

#include "axes.hpp"
#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/median.hpp"
#include "statistics/undefined.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kBandsUpTo = 4;  // sources in a plot; more bands hide each other
constexpr int kWidth = 760, kHeight = 500, kLowHeight = 330;  // pixels
constexpr int kPanelWidth = 560, kPanelHeight = 440;          // of plots beside each other

// Numbers as a reader wants them: metres as centimetres.
struct Shown {
  std::string unit;
  double size = 1;
};
Shown shown(const std::string& unit) {
  if (unit == "m") return {"cm", 0.01};
  if (unit == "m^2") return {"cm²", 1e-4};
  if (unit == "1/m") return {"1/cm", 100};
  if (unit == "rad^2") return {"rad²", 1};
  return {unit, 1};
}

std::string label(const std::string& name, const Shown& unit) {
  return name + (unit.unit == "1" ? "" : " (" + unit.unit + ")");
}

Curve curve_of(const std::string& name, const std::vector<double>& x, const CurveEstimate& estimate,
               double x_unit, double y_unit, bool band) {
  Curve curve;
  curve.name = name;
  curve.x = divided(x, x_unit), curve.y = divided(estimate.value, y_unit);
  if (!band) return curve;
  curve.low = divided(estimate.low, y_unit), curve.high = divided(estimate.high, y_unit);
  // Beside a value without a band, an infinite one would be drawn to the edge.
  for (std::size_t i = 0; i < curve.low.size(); ++i) {
    if (std::isinf(curve.low[i]) || std::isinf(curve.high[i])) {
      curve.low[i] = curve.high[i] = kUndefined;
    }
  }
  return curve;
}

std::vector<std::string> panels_of(const Analysis& analysis) {
  std::vector<std::string> panels;
  for (const SourceSummary& s : analysis.sources) {
    if (std::find(panels.begin(), panels.end(), s.panel) == panels.end()) panels.push_back(s.panel);
  }
  return panels;
}

std::string y_label(const AnalysisCurves& set, const Shown& unit) {
  return label(set.y_name == "msd" ? "MSD" : set.y_name, unit);
}

bool is_correlation(const AnalysisCurves& set) {
  return set.name == "velocity_acf" || set.name == "spin_acf";
}

Plot empty_plot(const AnalysisCurves& set, const Shown& x, const Shown& y) {
  Plot plot;
  plot.x_label = label(set.x_name, x), plot.y_label = y_label(set, y);
  plot.width = kWidth, plot.height = kHeight;
  // Beyond, correlations say nothing that could be seen.
  if (is_correlation(set)) plot.x_low = 0, plot.x_high = std::min(set.x.back(), 15.0);
  return plot;
}

bool is_given(double low, double high) {
  return low < high;
}

// Panels side by side can be compared only on one axis, which has room for what is drawn: curves
// and bands within the horizontal axis.
void share_y(std::vector<Plot>& plots) {
  if (plots.size() < 2) return;
  double low = 0, high = 0;
  const auto add = [&](const std::vector<double>& values, std::size_t i) {
    if (i >= values.size() || !std::isfinite(values[i])) return;
    low = std::min(low, values[i]), high = std::max(high, values[i]);
  };
  for (const Plot& plot : plots) {
    const bool cut = is_given(plot.x_low, plot.x_high);
    for (const Curve& curve : plot.curves) {
      for (std::size_t i = 0; i < curve.y.size(); ++i) {
        const bool shown = !cut || (curve.x[i] >= plot.x_low && curve.x[i] <= plot.x_high);
        for (const auto* values : {&curve.y, &curve.low, &curve.high}) {
          if (shown && std::isfinite(curve.y[i])) add(*values, i);
        }
      }
    }
  }
  for (Plot& plot : plots) plot.y_low = low, plot.y_high = low + 1.06 * (high - low);
}

// Plots above each other, too: an x is at one place in all of them. What begins above 0 is lags and
// distances: their axis begins at 0, or a first point on its left frame would pass for one there.
void share_x(std::vector<Plot>& plots) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Plot& plot : plots) {
    if (is_given(plot.x_low, plot.x_high)) return;  // the same for all of a set
    for (const Curve& curve : plot.curves) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const bool shown = std::isfinite(curve.y[i]) && (!plot.log_x || curve.x[i] > 0) &&
                           (!plot.log_y || curve.y[i] > 0);
        if (shown) low = std::min(low, curve.x[i]), high = std::max(high, curve.x[i]);
      }
    }
  }
  if (!plots.empty() && !plots[0].log_x) low = std::min(low, 0.0);
  if (!is_given(low, high)) return;
  for (Plot& plot : plots) plot.x_low = low, plot.x_high = high;
}

std::vector<Plot> overlays(const Analysis& analysis, const AnalysisCurves& set, const Shown& x,
                           const Shown& y) {
  std::vector<Plot> plots;
  const std::vector<std::string> panels = panels_of(analysis);
  for (const std::string& panel : panels) {
    Plot plot = empty_plot(set, x, y);
    if (panels.size() > 1) {
      plot.title = panel;
      plot.width = kPanelWidth, plot.height = kPanelHeight;
    }
    std::vector<const AnalysisCurves::Of*> in;
    for (const auto& of : set.sources) {
      if (analysis.sources[static_cast<std::size_t>(of.source)].panel == panel) in.push_back(&of);
    }
    for (const auto* of : in) {
      const std::string& name = analysis.sources[static_cast<std::size_t>(of->source)].name;
      plot.curves.push_back(
          curve_of(name, set.x, of->curve, x.size, y.size, in.size() <= kBandsUpTo));
    }
    plot.legend_title = shared_key(analysis);
    if (!plot.curves.empty()) plots.push_back(std::move(plot));
  }
  share_y(plots);
  return plots;
}

Plot difference_plot(const Analysis& analysis, const AnalysisCurves& set, const Shown& x,
                     const Shown& y) {
  Plot plot = empty_plot(set, x, y);
  plot.height = kLowHeight;
  plot.title = analysis.sources[1].name + " less " + analysis.sources[0].name;
  plot.y_label = "difference" + (y.unit == "1" ? "" : " (" + y.unit + ")");
  plot.curves.resize(2);  // empty: their colours are those of the sources
  plot.curves.push_back(curve_of("", set.x, set.difference, x.size, y.size, true));
  plot.zero_line = true;
  return plot;
}

// Where tracks end early, how many there are at each lag.
void add_track_numbers(const Analysis& analysis, const AnalysisCurves& set, PlotPage& page) {
  Plot plot = empty_plot(set, {"s", 1}, {"", 1});
  plot.height = kLowHeight;
  plot.y_label = "tracks", plot.legend_title = shared_key(analysis);
  bool varies = false;
  for (const auto& of : set.sources) {
    Curve curve;
    curve.name = analysis.sources[static_cast<std::size_t>(of.source)].name;
    curve.x = set.x, curve.steps = true;
    for (const std::int64_t n : of.tracks) curve.y.push_back(static_cast<double>(n));
    varies = varies || of.tracks.front() != of.tracks.back();
    plot.curves.push_back(std::move(curve));
  }
  if (varies) page.plots.push_back(std::move(plot));
}

PlotPage page_of(const Analysis& analysis, const AnalysisCurves& set, bool logarithmic) {
  const Shown x = shown(set.x_unit), y = shown(set.y_unit);
  PlotPage page{overlays(analysis, set, x, y)};
  page.columns = static_cast<int>(std::min<std::size_t>(3, page.plots.size()));
  const bool several = page.plots.size() > 1;
  if (logarithmic) {
    for (Plot& plot : page.plots) plot.log_x = plot.log_y = true, plot.y_low = plot.y_high = 0;
  } else if (!several) {
    if (!set.difference.value.empty()) {
      page.plots.push_back(difference_plot(analysis, set, x, y));
    }
    if (set.name.starts_with("msd")) add_track_numbers(analysis, set, page);
  }
  if (several || !logarithmic) share_x(page.plots);
  if (set.name == "msd_all" && analysis.compared && analysis.comparison.msd_relative > 0) {
    page.title = "The MSDs of " + analysis.sources[0].name + " and " + analysis.sources[1].name +
                 " differ by " + number(100 * analysis.comparison.msd_relative, 0) +
                 " % on average.";
  }
  return page;
}

Figure contact_plot(const Analysis& analysis) {
  Plot plot;
  plot.x_label = "time (s)", plot.y_label = "fraction that lasts longer";
  plot.width = kWidth, plot.height = kHeight;
  plot.y_low = -0.03, plot.y_high = 1.04;
  double longest = 0;
  for (const SourceSummary& s : analysis.sources) {
    const Survival& c = s.contacts.survival;
    if (c.time.empty()) continue;
    Curve curve;
    curve.name = s.name, curve.steps = true;
    curve.x = c.time, curve.y = c.survival, curve.low = c.low, curve.high = c.high;
    curve.x.insert(curve.x.begin(), 0.0);
    for (auto* v : {&curve.y, &curve.low, &curve.high}) v->insert(v->begin(), 1.0);
    for (std::size_t i = 0; i < c.time.size(); ++i) {
      if (c.survival[i] >= 0.01) longest = std::max(longest, c.time[i]);
    }
    if (analysis.sources.size() > kBandsUpTo) curve.low.clear(), curve.high.clear();
    plot.curves.push_back(std::move(curve));
  }
  plot.x_low = 0, plot.x_high = longest;
  plot.legend_title = shared_key(analysis);
  return {
      "contact_times", "Fraction of contacts that last longer (Kaplan and Meier).", {{plot}}, {}};
}

Figure transfer_plot(const Analysis& analysis) {
  Plot plot;
  plot.x_label = "frequency (Hz)", plot.y_label = "amplitude kept";
  plot.width = kWidth, plot.height = kHeight;
  plot.y_low = 0, plot.y_high = 1.08;
  const auto add = [&](const std::string& name, const TransferFunction& t,
                       const std::vector<double>& gain) {
    plot.curves.push_back({name, t.frequency, gain, {}, {}});
  };
  if (analysis.sources.size() == 1) {
    const TransferFunction& t = analysis.sources[0].transfer;
    add("position", t, t.position), add("velocity", t, t.velocity);
    add("acceleration", t, t.acceleration);
  } else {
    plot.y_label = "amplitude of velocity kept";
    plot.legend_title = shared_key(analysis);
    for (const SourceSummary& s : analysis.sources) add(s.name, s.transfer, s.transfer.velocity);
  }
  Figure made{"transfer", "Transfer functions of the smoother.", {{plot}}, {}};
  share_x(made.page.plots);
  return made;
}

// The size that 98 of 100 values stay below: a lone wild cell must not pale all others.
double usual_most(const std::vector<const std::vector<double>*>& all) {
  std::vector<double> sizes;
  for (const auto* values : all) {
    for (const double v : *values) {
      if (std::isfinite(v)) sizes.push_back(std::fabs(v));
    }
  }
  if (sizes.empty()) return 1;
  const auto rank = static_cast<std::size_t>(0.98 * (sizes.size() - 1.0));
  const double usual = ranked(std::move(sizes), rank);
  const double step = std::pow(10.0, std::floor(std::log10(std::max(usual, 1e-9)))) / 2;
  return step * std::ceil(usual / step);
}

void add_row(Map& map, const VelocityMap& v, const std::string& name, const std::string& what,
             double most) {
  MapPanel x = velocity_panel(name + ": along x", v, v.vx);
  MapPanel y = velocity_panel(name + ": along y", v, v.vy);
  x.low = y.low = -most, x.high = y.high = most;
  MapPanel speed = velocity_panel(name, v, {});
  x.label = y.label = what + " (m/s)";
  speed.label = "size of the " + what + " (m/s)";
  speed.scale = ColourScale::rising;
  for (std::size_t i = 0; i < v.vx.size(); ++i) {
    speed.values.push_back(std::hypot(v.vx[i], v.vy[i]));
  }
  speed.low = 0, speed.high = most;
  speed.arrow_x = v.vx, speed.arrow_y = v.vy;
  map.panels.push_back(std::move(x));
  map.panels.push_back(std::move(y));
  map.panels.push_back(std::move(speed));
}

// "recorded: 45 bodies in 3 recordings; simulated: ..."
std::string sources_text(const Analysis& analysis) {
  constexpr std::size_t kMost = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(kMost, analysis.sources.size()); ++i) {
    const SourceSummary& s = analysis.sources[i];
    out += (i == 0 ? "" : "; ") + s.name + ": " + std::to_string(s.bodies) +
           (s.bodies == 1 ? " body" : " bodies");
    if (s.units < s.bodies) out += " (" + std::to_string(s.units) + " with latched ones as one)";
    out += " in " + counted(s.recordings, "recording");
  }
  if (analysis.sources.size() > kMost) {
    out += "; " + std::to_string(analysis.sources.size() - kMost) + " more sources";
  }
  return out;
}

std::string bands_text(const Analysis& analysis) {
  const Bootstrap& b = analysis.options.bootstrap;
  return number(100 * b.level, 0) + " %, " + resampled(analysis) + ", " +
         std::to_string(b.resamples) + " resamples, seed " + std::to_string(b.seed);
}

std::string caption_of(const std::string& plot) {
  static const std::map<std::string, std::string> kCaptions = {
      {"msd_first", "Mean squared displacement from the first frame of each track (Eq. 8)."},
      {"msd_all", "Mean squared displacement, all origins."},
      {"msd_all_log", "Mean squared displacement, all origins, logarithmic axes."},
      {"turn_msd", "Mean squared change of heading."},
      {"velocity_acf", "Autocorrelation of the velocity."},
      {"spin_acf", "Autocorrelation of the spin."},
      {"speed", "Probability density of the speed."},
      {"velocity_x", "Probability density of the velocity along x."},
      {"velocity_y", "Probability density of the velocity along y."},
      {"velocity_out", "Probability density of the velocity away from the centre."},
      {"velocity_around", "Probability density of the velocity about the centre."},
      {"spin", "Probability density of the spin."},
      {"density", "Density of centres over the distance from the centre; 1: uniform."},
      {"pair_correlation", "Pair correlation; 1: independent."},
      {"nearest", "Probability density of the distance to the nearest body."},
  };
  const auto known = kCaptions.find(plot);
  return known == kCaptions.end() ? plot : known->second;
}

}  // namespace

std::vector<Figure> analysis_plots(const Analysis& analysis) {
  std::vector<Figure> figures;
  const std::string n = sources_text(analysis);
  const auto add = [&](const std::string& name, const PlotPage& page) {
    figures.push_back({name, caption_of(name), page, {}, {}, n, bands_text(analysis)});
  };
  for (const AnalysisCurves& set : analysis.curves) {
    add(set.name, page_of(analysis, set, false));
    if (set.name == "msd_all") add("msd_all_log", page_of(analysis, set, true));
  }
  if (analysis.options.msd_only) return figures;
  Figure contacts = contact_plot(analysis);
  contacts.n = n;
  contacts.band = number(100 * analysis.options.bootstrap.level, 0) +
                  " %, Kaplan and Meier; contacts count as independent";
  if (!contacts.page.plots[0].curves.empty()) figures.push_back(std::move(contacts));
  figures.push_back(transfer_plot(analysis));
  figures.back().n = n;
  return figures;
}

Map velocity_maps(const Analysis& analysis) {
  Map map;
  map.tank_radius = analysis.tank_radius;
  map.columns = 3;
  std::vector<const std::vector<double>*> all;
  for (const VelocityMap& v : analysis.maps) all.push_back(&v.vx), all.push_back(&v.vy);
  const double most = usual_most(all);
  for (std::size_t i = 0; i < analysis.maps.size(); ++i) {
    add_row(map, analysis.maps[i], analysis.sources[i].name, "mean velocity", most);
  }
  if (analysis.maps.size() != 2) return map;
  VelocityMap less = analysis.maps[1];
  for (std::size_t i = 0; i < less.vx.size(); ++i) {
    less.vx[i] -= analysis.maps[0].vx[i], less.vy[i] -= analysis.maps[0].vy[i];
  }
  add_row(map, less, "difference", "difference", usual_most({&less.vx, &less.vy}));
  return map;
}

void draw_analysis(const Analysis& analysis, const ReportDocument& report, const std::string& dir,
                   const FigureStyle& style) {
  std::vector<Figure> figures = analysis_plots(analysis);
  Map map = velocity_maps(analysis);
  if (!map.panels.empty()) {
    figures.push_back({"velocity_map",
                       "Mean velocity along x, along y and as arrows.",
                       {},
                       std::move(map),
                       {},
                       sources_text(analysis)});
  }
  write_html_report(report, figures, dir, style);
}

}  // namespace lilytank
