#include <algorithm>
#include <cmath>

#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

std::string short_name(const CalibratedParameter& p) {
  const std::string& path = p.parameter.path;
  return path.substr(path.rfind('.') + 1);
}
std::string with_unit(const CalibratedParameter& p) {
  return short_name(p) + (p.parameter.unit == "1" ? "" : " (" + p.parameter.unit + ")");
}

// Fig. 6a.
Plot convergence_plot(const CalibrationResult& c) {
  Plot plot;
  plot.title = "Search, " + c.name;
  plot.x_label = "iteration";
  plot.y_label = c.objective == "msd" ? "fitness, Eq. 9 (m\u00b2)" : "fitness";
  Curve best{"best", {}, {}, {}, {}}, median{"median of the iteration", {}, {}, {}, {}};
  double least = 1;
  for (const IterationRecord& r : c.history) {
    for (auto* curve : {&best, &median}) curve->x.push_back(r.iteration);
    best.y.push_back(std::isfinite(r.best) ? r.best : kUndefined);
    median.y.push_back(std::isfinite(r.median) ? r.median : kUndefined);
    least = std::min(least, r.best);
  }
  plot.log_y = least > 0;
  plot.curves = {best, median};
  return plot;
}

// Fig. 6b, a plot a set of recordings.
PlotPage msd_page(const CalibrationResult& c) {
  PlotPage page;
  for (const MsdFit& m : c.msd) {
    Plot plot;
    plot.title = c.name + ", " + m.recordings + " recordings";
    plot.x_label = "lag (s)", plot.y_label = "MSD (m\u00b2)";
    plot.curves = {{"recorded", m.lag, m.real, {}, {}},
                   {"simulated, calibrated", m.lag, m.simulated_after, {}, {}},
                   {"simulated, before", m.lag, m.simulated_before, {}, {}}};
    page.plots.push_back(std::move(plot));
  }
  return page;
}

// Fig. 7.
Map velocity_map_of(const CalibrationResult& c) {
  Map map;
  map.title = "Mean velocity, " + c.name;
  map.tank_radius = c.tank_radius, map.columns = 2;
  const VelocityMap &real = c.real_velocity, &simulated = c.simulated_velocity;
  map.panels.push_back(velocity_panel("Recorded, x", real, real.vx));
  map.panels.push_back(velocity_panel("Recorded, y", real, real.vy));
  map.panels.push_back(velocity_panel("Simulated, x", simulated, simulated.vx));
  map.panels.push_back(velocity_panel("Simulated, y", simulated, simulated.vy));
  double high = 0;
  for (const MapPanel& panel : map.panels) {
    for (const double v : panel.values) {
      if (!std::isnan(v)) high = std::max(high, std::fabs(v));
    }
  }
  for (MapPanel& panel : map.panels) {
    panel.low = -high, panel.high = high;
    panel.label = "mean velocity (m/s)";
  }
  return map;
}

constexpr double kChi95 = 3.8415;  // 95 % point of chi squared with one degree of freedom

constexpr double kBar = 0.4;  // where the interval is drawn

// How the misfit rises beside the estimate; with covariances it is comparable with chi squared.
PlotPage profile_page(const CalibrationResult& c) {
  PlotPage page;
  page.columns = 3;
  for (const CalibratedParameter& p : c.parameters) {
    if (p.profile_value.size() < 2) continue;
    Plot plot;
    plot.x_label = with_unit(p), plot.y_label = "rise of the misfit";
    plot.width = 520, plot.height = 400;
    plot.curves.push_back({"profile", p.profile_value, p.profile_rise, {}, {}});
    if (c.objective != "msd") {
      plot.curves.push_back({"95 % of chi squared",
                             {p.profile_value.front(), p.profile_value.back()},
                             {kChi95, kChi95},
                             {},
                             {}});
      plot.y_low = 0, plot.y_high = 16;
    }
    Curve interval{"95 % interval", {p.low, p.estimate, p.high}, {kBar, kBar, kBar}, {}, {}};
    interval.markers = true;
    plot.curves.push_back(std::move(interval));
    page.plots.push_back(std::move(plot));
  }
  return page;
}

// Room to the left and right of what stands outermost, as there is above and below.
void room_beside(Plot& plot) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Curve& curve : plot.curves) {
    for (const double x : curve.x) {
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    }
  }
  const double room = 0.05 * (high - low);
  if (room > 0) plot.x_low = low - room, plot.x_high = high + room;
}

// Estimates of simulated experiments, two parameters a plot: what the data do not distinguish is a
// line.
PlotPage pair_page(const CalibrationResult& c) {
  PlotPage page;
  page.columns = 4;
  page.title = "Circle: estimate; squares: simulated";  // a legend would hide some of them
  const std::size_t n = c.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const CalibratedParameter &x = c.parameters[j], &y = c.parameters[i];
      if (x.parameter.nuisance || y.parameter.nuisance) continue;
      char title[40];
      std::snprintf(title, sizeof title, "correlation %.3f", c.correlation[i * n + j]);
      Plot plot;
      plot.title = title, plot.x_label = with_unit(x), plot.y_label = with_unit(y);
      plot.width = 460, plot.height = 380;
      Curve dots;
      for (const auto& of : c.replicate_estimates) {
        dots.x.push_back(x.parameter.from_scale(of[j]));
        dots.y.push_back(y.parameter.from_scale(of[i]));
      }
      Curve estimate{"", {x.estimate}, {y.estimate}, {}, {}};
      for (Curve* curve : {&dots, &estimate}) curve->markers = true, curve->line = false;
      plot.curves = {estimate, dots};  // the first lies on top
      room_beside(plot);
      page.plots.push_back(std::move(plot));
    }
  }
  return page;
}

}  // namespace

void draw_calibration(const CalibrationResult& c, const ReportDocument& report,
                      const std::string& dir) {
  std::vector<Figure> figures;
  const auto add = [&](const std::string& name, const std::string& caption, const PlotPage& page) {
    if (!page.plots.empty()) figures.push_back({name, caption, page, {}});
  };
  add("msd", "Mean squared displacement, recorded and simulated.", msd_page(c));
  if (!c.real_velocity.vx.empty() && !c.simulated_velocity.vx.empty()) {
    figures.push_back(
        {"velocity", "Mean velocity, recorded and simulated.", {}, velocity_map_of(c)});
  }
  add("profiles",
      "Profile of the misfit over each parameter, with its 95 % interval. The interval comes from "
      "simulated experiments and includes the errors of the flow and of the response surface, so "
      "it "
      "can be wider than the part of the profile below the threshold.",
      profile_page(c));
  add("estimates", "Estimates from simulated experiments, two parameters a plot.", pair_page(c));
  if (!c.history.empty()) {
    add("convergence", "Convergence of the search.", {{convergence_plot(c)}});
  }
  write_html_report(report, figures, dir);
}

}  // namespace lilytank
