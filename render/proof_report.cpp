// Figures of blinded synthetic experiments: power, outcomes, errors.
#include <algorithm>
#include <cmath>

#include "html_report.hpp"
#include "lilytank/render.hpp"
#include "statistics/quantiles.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr double kFar = 3;            // half widths, where larger errors are drawn
constexpr double kRoom = 1.2;         // of z, beside the outermost
constexpr double kBarsApart = 0.009;  // of the axis' length, that bars are apart at least

// `apart`: a factor of z by which bars are to be apart from those in `taken`, or they would hide
// them: they move to the right until they are.
Curve power_curve(const std::string& name, const std::vector<ProofPower>& power, double apart,
                  std::vector<double>& taken) {
  Curve out;
  out.name = name, out.markers = out.bars = true;
  for (const ProofPower& p : power) {
    double z = p.z;
    std::sort(taken.begin(), taken.end());
    for (const double other : taken) {
      if (z > other / apart && z < other * apart) z = other * apart;
    }
    out.x.push_back(z), out.y.push_back(100.0 * p.right / p.all);
    out.low.push_back(100 * p.low), out.high.push_back(100 * p.high);
  }
  taken.insert(taken.end(), out.x.begin(), out.x.end());
  return out;
}

// Room beside the outermost experiments.
void spread_x(const ProofFigures& of, Plot& plot) {
  plot.x_low = plot.x_high = 10;
  for (const ProofPoint& p : of.points) {
    plot.x_low = std::min(plot.x_low, p.expected_z / kRoom);
    plot.x_high = std::max(plot.x_high, p.expected_z * kRoom);
  }
}

Plot power_plot(const ProofFigures& of) {
  Plot plot;
  const auto right = std::count_if(of.points.begin(), of.points.end(), [](const ProofPoint& p) {
    return p.outcome == ProofPoint::Outcome::right;
  });
  plot.title = std::to_string(right) + " of " + std::to_string(of.points.size()) +
               " experiments with an omitted effect have a correct verdict.";
  plot.x_label = "standardised effect size (expected z)";
  plot.y_label = "correct verdicts (%)";
  plot.log_x = true, plot.y_low = 0, plot.y_high = 100;
  spread_x(of, plot);
  const double apart = std::pow(plot.x_high / plot.x_low, kBarsApart);
  std::vector<double> taken;
  plot.curves.push_back(power_curve("one effect", of.named, apart, taken));
  for (const auto& [name, power] :
       {std::pair("two effects: both", &of.two), {"a law of no effect", &of.unnamed}}) {
    if (power->empty()) continue;
    plot.curves.push_back(power_curve(name, *power, apart, taken));
    plot.curves.back().line = false;
  }
  return plot;
}

// A row an effect, a marker an experiment.
Plot outcomes_plot(const ProofFigures& of) {
  Plot plot;
  plot.x_label = "standardised effect size (expected z)";
  plot.log_x = true;
  for (const ProofPoint& p : of.points) plot.y_names.push_back(p.row);
  std::sort(plot.y_names.begin(), plot.y_names.end(), [](const auto& a, const auto& b) {
    const bool odd_a = a.find(' ') != std::string::npos, odd_b = b.find(' ') != std::string::npos;
    return odd_a != odd_b ? odd_b : a < b;
  });
  plot.y_names.erase(std::unique(plot.y_names.begin(), plot.y_names.end()), plot.y_names.end());
  plot.width = 1100, plot.height = 130 + 26 * static_cast<int>(plot.y_names.size());
  spread_x(of, plot);
  using Outcome = ProofPoint::Outcome;
  // Places among the curves choose colour and marker, and the first lies on top: what went wrong
  // above what is right, which is blue and round at place 0 as at place 12.
  struct Kind {
    Outcome outcome;
    const char* name;
    std::size_t place;
  };
  for (const Kind& kind : {Kind{Outcome::wrong_name, "a wrong name", 1},
                           Kind{Outcome::silent, "no discrepancy detected", 2},
                           Kind{Outcome::other, "in part, unnamed or undecided", 3},
                           Kind{Outcome::right, "correct", 12}}) {
    Curve curve;
    curve.markers = true, curve.line = false;
    for (const ProofPoint& p : of.points) {
      if (p.outcome != kind.outcome) continue;
      const auto row = std::find(plot.y_names.begin(), plot.y_names.end(), p.row);
      curve.x.push_back(p.expected_z);
      curve.y.push_back(static_cast<double>(row - plot.y_names.begin()));
    }
    curve.name = std::string(kind.name) + ": " + std::to_string(curve.x.size());
    plot.curves.resize(kind.place);
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

Curve errors_curve(const std::string& name, const std::vector<double>& sorted) {
  Curve out;
  out.name = name, out.steps = true;
  out.x.push_back(-kFar), out.y.push_back(0);
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    out.x.push_back(std::clamp(sorted[k], -kFar, kFar));
    out.y.push_back(100 * static_cast<double>(k + 1) / static_cast<double>(sorted.size()));
  }
  out.x.push_back(kFar), out.y.push_back(100);
  return out;
}

Plot errors_plot(const ProofFigures& of) {
  Plot plot;
  std::size_t within = 0, all = 0;
  for (const auto* errors : {&of.baseline_errors, &of.effect_errors}) {
    all += errors->size();
    for (const double e : *errors) within += std::fabs(e) <= 1 ? 1 : 0;
  }
  plot.title = std::to_string(within) + " of " + std::to_string(all) +
               " 95 % intervals contain the true value.";
  plot.x_label = "error (half widths of the 95 % interval)";
  plot.y_label = "intervals with a lower error (%)";
  plot.x_low = -kFar, plot.x_high = kFar, plot.y_low = 0, plot.y_high = 100;
  for (const auto& [name, errors] :
       {std::pair("baseline", &of.baseline_errors), {"effects and laws", &of.effect_errors}}) {
    if (!errors->empty()) plot.curves.push_back(errors_curve(name, *errors));
  }
  Curve normal;
  normal.name = "normal errors";
  const double half_width = normal_half_width();
  for (double x = -kFar; x <= kFar + 1e-9; x += 0.05) {
    normal.x.push_back(x), normal.y.push_back(50 * std::erfc(-half_width * x / std::sqrt(2.0)));
  }
  plot.curves.push_back(std::move(normal));
  return plot;
}

std::string power_caption(const ProofFigures& of) {
  std::string out =
      "Fraction of synthetic experiments with a correct verdict. Bars: 95 % (Wilson). Effects "
      "below "
      "the detection threshold are missed so that the false-positive rate stays low.";
  if (!of.two.empty()) out += " Of two effects the expected z is the weaker one's.";
  if (!of.two.empty() || !of.unnamed.empty()) {
    out += " Bars that would hide each other stand a little to the right of their z.";
  }
  return out;
}

std::string outcomes_caption(const ProofFigures& of) {
  std::string out =
      "Verdict on every experiment with an omitted effect. A correct name beside a wrong one "
      "counts "
      "as a wrong name.";
  const bool held = std::any_of(of.points.begin(), of.points.end(), [](const ProofPoint& p) {
    return p.expected_z <= ProofFigures::kLeastZ;
  });
  if (held) out += " What shows next to nothing, expected z 0.5 or less, stands at the left edge.";
  return out;
}

}  // namespace

void draw_proof(const ProofFigures& of, const ReportDocument& report, const std::string& dir,
                const FigureStyle& style) {
  std::vector<Figure> figures;
  if (!of.points.empty()) {
    const std::string n =
        counted(static_cast<std::int64_t>(of.points.size()), "synthetic experiment") +
        " with an omitted effect";
    figures.push_back(
        {"power", power_caption(of), {{power_plot(of)}}, {}, {}, n, "bars: 95 % (Wilson)"});
    figures.push_back({"outcomes", outcomes_caption(of), {{outcomes_plot(of)}}, {}, {}, n});
  }
  if (!of.baseline_errors.empty() || !of.effect_errors.empty()) {
    figures.push_back(
        {"errors",
         "Errors of fitted parameters: 95 % should be within one half width of their "
         "interval, as a normal law with it has.",
         {{errors_plot(of)}},
         {},
         {},
         std::to_string(of.baseline_errors.size() + of.effect_errors.size()) + " intervals"});
  }
  write_html_report(report, figures, dir, style);
}

}  // namespace lilytank
