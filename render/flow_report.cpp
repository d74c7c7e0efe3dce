#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/median.hpp"
#include "statistics/undefined.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

const std::string kHatching = "filled from the measured cells around";

bool in_tank(const FlowEstimate& e, std::size_t i) {
  const int at = static_cast<int>(i);
  return std::hypot(e.x(at), e.y(at)) <= e.extent;
}

// A panel of one number a cell; NaN outside the tank. Filled cells are hatched.
template <class Value>
MapPanel panel(const FlowEstimate& e, const std::string& title, const std::string& label,
               Value value) {
  MapPanel out;
  out.title = title, out.label = label;
  out.cells = e.cells, out.extent = e.extent;
  for (std::size_t i = 0; i < e.cell.size(); ++i) {
    out.values.push_back(in_tank(e, i) ? value(i) : kUndefined);
    out.hatched.push_back(in_tank(e, i) && !e.cell[i].measured);
  }
  return out;
}

void add_arrows(const FlowEstimate& e, MapPanel& out,
                const std::function<std::array<double, 2>(std::size_t)>& vector) {
  for (std::size_t i = 0; i < e.cell.size(); ++i) {
    const std::array<double, 2> v = in_tank(e, i) ? vector(i) : std::array{kUndefined, kUndefined};
    out.arrow_x.push_back(v[0]), out.arrow_y.push_back(v[1]);
  }
}

Map flow_map(const FlowReport& report, const FlowEstimate& e) {
  Map map;
  std::vector<double> speeds, errors;
  for (const FlowCell& c : e.cell) {
    if (!c.measured) continue;
    speeds.push_back(std::hypot(c.flow.mu_x, c.flow.mu_y));
    errors.push_back(std::hypot(c.error.mu_x, c.error.mu_y) / std::sqrt(2.0));
  }
  if (!speeds.empty()) {
    map.title = "The mean flow is " + significant(100 * median(speeds), 2) +
                " cm/s in the median cell, its standard error " +
                significant(100 * median(errors), 2) + " cm/s.";
  }
  map.tank_radius = report.ball.tank_radius, map.columns = 2;
  map.hatching = kHatching;
  const auto& cell = e.cell;
  map.panels.push_back(panel(e, "Mean velocity", "speed (m/s)", [&](std::size_t i) {
    return std::hypot(cell[i].flow.mu_x, cell[i].flow.mu_y);
  }));
  add_arrows(e, map.panels.back(), [&](std::size_t i) {
    return std::array{cell[i].flow.mu_x, cell[i].flow.mu_y};
  });
  map.panels.push_back(
      panel(e, "Standard deviation per axis", "standard deviation (m/s)", [&](std::size_t i) {
        const FlowSample& f = cell[i].flow;
        return std::sqrt((f.sigma_x * f.sigma_x + f.sigma_y * f.sigma_y) / 2);
      }));
  map.panels.push_back(panel(e, "Standard error of the mean", "per axis (m/s)", [&](std::size_t i) {
    const FlowSample& s = cell[i].error;
    return cell[i].measured ? std::sqrt((s.mu_x * s.mu_x + s.mu_y * s.mu_y) / 2) : kUndefined;
  }));
  const std::string what = e.noise ? "Momentum balances" : "Frames";
  map.panels.push_back(panel(e, what + " in a cell", "number",
                             [&](std::size_t i) { return static_cast<double>(cell[i].samples); }));
  return map;
}

MapPanel rejections(const FlowEstimate& e, const std::string& title, const std::vector<double>& p,
                    const std::vector<bool>& rejected) {
  MapPanel out = panel(e, title, "", [&](std::size_t i) {
    return std::isnan(p[i]) ? kUndefined : rejected[i] ? 1.0 : 0.0;
  });
  out.hatched.clear();
  out.classes = {"not rejected", "rejected"}, out.no_data = "not tested";
  return out;
}

// Fig. 3, and beside it what is left when frames are independent and tests are many.
Map normality_map(const FlowReport& report, const FlowEstimate& e) {
  Map map;
  const double level = report.options.significance;
  const std::string percent = significant(100 * level, 3) + " %";
  map.tank_radius = report.ball.tank_radius, map.columns = 2;
  for (const bool along_x : {true, false}) {
    std::vector<double> every, thinned;
    std::vector<bool> below;
    for (const FlowCell& c : e.cell) {
      const NormalityTest& a = along_x ? c.all_x : c.all_y;
      const NormalityTest& t = along_x ? c.normal_x : c.normal_y;
      every.push_back(a.samples < 4 ? kUndefined : a.raw_p);
      thinned.push_back(t.samples < 4 ? kUndefined : t.p);
      below.push_back(a.raw_p < level);
    }
    const std::string axis = along_x ? ", x axis" : ", y axis";
    map.panels.push_back(rejections(e, "All frames, " + percent + axis, every, below));
    map.panels.push_back(rejections(e, "Independent, Lilliefors, FDR " + percent + axis, thinned,
                                    false_discovery(thinned, level)));
  }
  std::int64_t rejected = 0, tests = 0;
  for (const std::size_t panel : {1u, 3u}) {
    for (const double v : map.panels[panel].values) {
      tests += std::isnan(v) ? 0 : 1, rejected += v > 0.5 ? 1 : 0;
    }
  }
  map.title = "Independent samples reject a normal distribution in " + std::to_string(rejected) +
              " of " + counted(tests, "test") + ".";
  // Rows are the two tests, columns the axes.
  std::swap(map.panels[1], map.panels[2]);
  return map;
}

// The largest value but for the worst hundredth, so that single cells do not set the scale.
double scale_of(const std::vector<MapPanel>& panels) {
  std::vector<double> sizes;
  for (const MapPanel& p : panels) {
    for (std::size_t i = 0; i < p.values.size(); ++i) {
      if (!std::isnan(p.values[i]) && !p.hatched[i]) sizes.push_back(std::fabs(p.values[i]));
    }
  }
  if (sizes.empty()) return 1;
  const std::size_t rank = sizes.size() * 99 / 100;
  return ranked(std::move(sizes), rank);
}

Map error_map(const FlowReport& report) {
  Map map;
  map.hatching = kHatching;
  map.tank_radius = report.ball.tank_radius;
  map.columns = static_cast<int>(report.estimates.size());
  const std::vector<FlowSample>& truth = report.truth->sample;
  std::vector<MapPanel> means, deviations;
  for (const FlowEstimate& e : report.estimates) {
    const auto apart = [&](std::size_t i) {
      return std::array{e.cell[i].flow.mu_x - truth[i].mu_x, e.cell[i].flow.mu_y - truth[i].mu_y};
    };
    means.push_back(panel(e, e.name + ": error of the mean", "size (m/s)",
                          [&](std::size_t i) { return std::hypot(apart(i)[0], apart(i)[1]); }));
    add_arrows(e, means.back(), [&](std::size_t i) {
      return e.cell[i].measured ? apart(i) : std::array{kUndefined, kUndefined};
    });
    deviations.push_back(panel(
        e, e.name + ": error of the standard deviation", "difference (m/s)", [&](std::size_t i) {
          const FlowSample& f = e.cell[i].flow;
          return (f.sigma_x - truth[i].sigma_x + f.sigma_y - truth[i].sigma_y) / 2;
        }));
    deviations.back().scale = ColourScale::diverging;
  }
  const double mean_scale = scale_of(means), deviation_scale = scale_of(deviations);
  for (MapPanel& p : means) p.low = 0, p.high = mean_scale;
  for (MapPanel& p : deviations) p.low = -deviation_scale, p.high = deviation_scale;
  map.panels = std::move(means);
  map.panels.insert(map.panels.end(), deviations.begin(), deviations.end());
  return map;
}

std::string samples_text(const FlowEstimate& e) {
  return std::to_string(e.samples) + (e.noise ? " momentum balances" : " frames") + " in " +
         counted(e.measured(), "cell");
}

}  // namespace

std::vector<Figure> flow_maps(const FlowReport& report) {
  std::vector<Figure> figures;
  for (const FlowEstimate& e : report.estimates) {
    figures.push_back({"flow_" + e.name,
                       "Flow of " + report.name + ", " + e.name +
                           " estimate: mean velocity, standard deviation, standard error, samples.",
                       {},
                       flow_map(report, e),
                       {},
                       samples_text(e)});
    if (e.thinning > 0) {
      figures.push_back({"normality",
                         "Cells in which a test rejects a normal distribution of the velocity.",
                         {},
                         normality_map(report, e),
                         {},
                         samples_text(e)});
    }
  }
  if (report.truth) {
    figures.push_back({"errors",
                       "Errors of the estimates against the true flow.",
                       {},
                       error_map(report),
                       {},
                       samples_text(report.estimates.back())});
  }
  return figures;
}

void draw_flow(const FlowReport& flow, const ReportDocument& report, const std::string& dir,
               const FigureStyle& style) {
  std::vector<Figure> figures = flow_maps(flow);
  // The picture beside the verdict is of the estimate that it is about, the last one.
  const auto last = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) {
    return f.name == "flow_" + flow.estimates.back().name;
  });
  std::rotate(figures.begin(), last, last + 1);
  write_html_report(report, figures, dir, style);
}

}  // namespace lilytank
