#include <algorithm>
#include <cmath>

#include "axes.hpp"
#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/undefined.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

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

std::string bodies_in(const CalibrationResult& c) {
  return std::to_string(c.bodies) + (c.bodies == 1 ? " body" : " bodies");
}

Curve with_band(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& low, const std::vector<double>& high) {
  return {name, x, y, low, high};
}

// The distances of halves over the lag, and the floor: what halves of equal experiments have.
Plot distance_plot(const MsdFit& m) {
  Plot plot;
  plot.x_label = "lag (s)", plot.y_label = "|difference| (m\u00b2)";
  plot.width = 640, plot.height = 330;
  // Places among the curves are those of the MSDs above: they choose the colours.
  plot.curves = {{},
                 {"simulated, calibrated", m.lag, m.after_at, {}, {}},
                 {"simulated, before", m.lag, m.before_at, {}, {}},
                 {"noise floor", m.lag, m.floor_at, {}, {}}};
  return plot;
}

// Fig. 6b, a column a set of recordings; below it the distances.
PlotPage msd_page(const CalibrationResult& c) {
  PlotPage page;
  page.columns = static_cast<int>(c.msd.size());
  for (const MsdFit& m : c.msd) {
    Plot plot;
    if (c.msd.size() > 1) plot.title = m.recordings + " recordings";
    plot.x_label = "lag (s)", plot.y_label = "MSD (m\u00b2)";
    plot.width = 640, plot.height = 440;
    plot.curves = {
        with_band("recorded", m.lag, m.real, m.real_low, m.real_high),
        with_band("simulated, calibrated", m.lag, m.simulated_after, m.after_low, m.after_high),
        {"simulated, before", m.lag, m.simulated_before, {}, {}}};
    page.plots.push_back(std::move(plot));
  }
  for (const MsdFit& m : c.msd) {
    if (m.floor_at.empty()) continue;
    page.plots.push_back(distance_plot(m));
    if (c.msd.size() > 1) page.plots.back().title = m.recordings + " recordings, halves";
  }
  if (c.msd.empty() || !(c.msd[0].floor > 0)) return page;
  const MsdFit& m = c.msd[0];
  if (!std::isfinite(m.after) || !std::isfinite(m.before)) return page;
  page.title = "MSDs differ from the recorded ones by " + significant(m.after / m.floor, 2) +
               " times the noise floor, before the calibration by " +
               significant(m.before / m.floor, 2) + " times.";
  return page;
}

Figure msd_figure(const CalibrationResult& c) {
  Figure figure{"msd",
                "Mean squared displacement, recorded and simulated, and the mean distance of the "
                "MSDs of halves. Noise floor: between two halves of the recordings.",
                msd_page(c)};
  if (c.msd.empty()) return figure;
  for (const MsdFit& m : c.msd) {
    figure.n += (figure.n.empty() ? "" : "; ") + counted(m.pieces, "piece") + " of " +
                significant(m.seconds, 3) + " s (" + m.recordings + " recordings)";
  }
  figure.n += ", up to " + bodies_in(c) + " in each; " +
              counted(c.msd[0].experiments, "simulated experiment") + " for each curve";
  figure.band = "95 % of the recorded mean over pieces, and 95 % of single simulated experiments";
  return figure;
}

// Fig. 7.
Map velocity_map_of(const CalibrationResult& c) {
  Map map;
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
constexpr double kHighestRise = 16;

// Both axes hold all that is drawn: the profile, the interval, the truth.
void take_range(const CalibratedParameter& p, Plot& plot) {
  plot.x_low = std::min(p.profile_value.front(), p.low);
  plot.x_high = std::max(p.profile_value.back(), p.high);
  if (!std::isnan(p.truth)) {
    plot.x_low = std::min(plot.x_low, p.truth), plot.x_high = std::max(plot.x_high, p.truth);
  }
  const double room = 0.03 * (plot.x_high - plot.x_low);
  plot.x_low -= room, plot.x_high += room;
}

// How the misfit rises beside the estimate; with covariances it is comparable with chi squared.
PlotPage profile_page(const CalibrationResult& c) {
  PlotPage page;
  page.columns = 3;
  for (const CalibratedParameter& p : c.parameters) {
    if (p.profile_value.size() < 2) continue;
    Plot plot;
    plot.x_label = with_unit(p), plot.y_label = "rise of the misfit";
    plot.width = 520, plot.height = 400;
    take_range(p, plot);
    const double top = *std::max_element(p.profile_rise.begin(), p.profile_rise.end());
    plot.y_low = 0, plot.y_high = top;
    plot.curves.push_back({"profile", p.profile_value, p.profile_rise, {}, {}});
    Curve interval{"95 % interval", {p.low, p.estimate, p.high}, {kBar, kBar, kBar}, {}, {}};
    interval.markers = true;
    plot.curves.push_back(std::move(interval));
    if (c.objective != "msd") {
      // The threshold runs from frame to frame, and is in the picture where no profile reaches it.
      plot.y_high = std::clamp(1.05 * top, 1.5 * kChi95, kHighestRise);
      plot.curves.push_back(
          {"threshold, 95 % of \u03c7\u00b2", {plot.x_low, plot.x_high}, {kChi95, kChi95}, {}, {}});
    }
    if (!std::isnan(p.truth)) {
      plot.curves.resize(3);
      plot.curves.push_back({"planted truth", {p.truth, p.truth}, {0, plot.y_high}, {}, {}});
    }
    page.plots.push_back(std::move(plot));
  }
  return page;
}

Corner corner_of(const CalibrationResult& c) {
  Corner corner;
  corner.draws_name = "simulated experiment";
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const CalibratedParameter& p = c.parameters[i];
    if (p.parameter.nuisance) continue;
    shown.push_back(i);
    corner.axes.push_back({short_name(p), p.parameter.unit == "1" ? "" : p.parameter.unit,
                           p.parameter.logarithmic, p.parameter.low, p.parameter.high, p.estimate,
                           p.low, p.high, p.truth});
  }
  for (const auto& of : c.replicate_estimates) {
    corner.draws.emplace_back();
    for (const std::size_t i : shown) {
      corner.draws.back().push_back(c.parameters[i].parameter.from_scale(of[i]));
    }
  }
  double most = 0;
  for (std::size_t a = 0; a < shown.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double r = c.correlation[shown[a] * c.parameters.size() + shown[b]];
      if (!(std::fabs(r) > std::fabs(most))) continue;
      most = r;
      corner.title = short_name(c.parameters[shown[b]]) + " and " +
                     short_name(c.parameters[shown[a]]) + " correlate by " +
                     (r < 0 ? "\u2212" : "") + number(std::fabs(r), 2) + ".";
    }
  }
  return corner;
}

Figure corner_figure(const CalibrationResult& c) {
  Figure figure;
  figure.name = "estimates";
  figure.caption =
      "Estimates from simulated experiments, in pairs below the diagonal and one by one on it. "
      "Circle and vertical line: estimate from the recordings; horizontal line: its 95 % interval; "
      "grey: outside the bounds of the prior.";
  figure.corner = corner_of(c);
  const bool truth = std::any_of(c.parameters.begin(), c.parameters.end(),
                                 [](const auto& p) { return !std::isnan(p.truth); });
  if (truth) figure.caption += " Dashed: values in the simulation that made the recordings.";
  figure.n =
      counted(static_cast<std::int64_t>(c.replicate_estimates.size()), "simulated experiment");
  return figure;
}

std::string recordings_text(const CalibrationResult& c) {
  return counted(c.recordings, "recording") + " of up to " + bodies_in(c);
}

}  // namespace

void draw_calibration(const CalibrationResult& c, const ReportDocument& report,
                      const std::string& dir, const FigureStyle& style) {
  std::vector<Figure> figures;
  const auto add = [&](Figure figure) {
    const bool empty =
        figure.page.plots.empty() && figure.map.panels.empty() && figure.corner.axes.empty();
    if (!empty) figures.push_back(std::move(figure));
  };
  add(msd_figure(c));
  if (!c.real_velocity.vx.empty() && !c.simulated_velocity.vx.empty()) {
    add({"velocity",
         "Mean velocity, recorded and simulated.",
         {},
         velocity_map_of(c),
         {},
         recordings_text(c)});
  }
  add({"profiles",
       "Profile of the misfit over each parameter, with its 95 % interval and the threshold that "
       "95 % of chi squared with one degree of freedom stay below. The interval comes from "
       "simulated experiments and includes the errors of the flow and of the response surface, so "
       "it can be wider than the part of the profile below the threshold.",
       profile_page(c),
       {},
       {},
       recordings_text(c),
       "interval: 95 %"});
  if (!c.replicate_estimates.empty()) add(corner_figure(c));
  if (!c.history.empty()) {
    add({"convergence",
         "Convergence of the search: the best value so far and each iteration's "
         "median.",
         {{convergence_plot(c)}},
         {},
         {},
         recordings_text(c)});
  }
  write_html_report(report, figures, dir, style);
}

}  // namespace lilytank
