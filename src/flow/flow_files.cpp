#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/scenario_text.hpp"
#include "lilytank/flow_report.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Scenario keys under which balls move in this flow as they did in the recordings.
std::string overlay(const FlowReport& report, const FlowEstimate& e) {
  const BallPhysics& ball = report.ball;
  ScenarioText out;
  out.comment("Balls in the flow of " + report.name + ", " + e.name +
              " estimate: an overlay for a scenario with balls.");
  out.table("flow");
  out.quoted("file", "flow_" + e.name + ".csv");
  out.number("K_v", 1), out.number("rho", ball.rho);
  out.table("ball");
  out.number("radius", ball.radius), out.number("mass", ball.mass);
  out.number("drag_area", ball.drag_area);
  out.table("forces");
  out.number("ball_drag.C", ball.drag_coefficient), out.number("ball_drag.draws", ball.draws);
  out.line("damping.D_linear", without_rounding(1 - std::exp(-ball.damping)));
  if (e.noise) out.number("stochastic.sigma_stoch", std::round(e.noise->stochastic * 1e7) / 1e7);
  return out.text();
}

std::string bias_csv(const std::vector<FlowBiasRow>& rows) {
  std::string out =
      "recordings,estimator,cells,mean_rms_mps,mean_radial_mps,mean_around_mps,"
      "std_rms_mps,std_bias_mps,mean_coverage,std_coverage\n";
  for (const FlowBiasRow& row : rows) {
    const FlowError& e = row.error;
    out += row.what + "," + row.estimator + "," + std::to_string(e.cells);
    if (!row.missing.empty()) {
      out += ",,,,,,,\n";  // unknown values are empty cells
      continue;
    }
    for (const double v : {e.mean_rms, e.mean_radial, e.mean_around, e.deviation_rms,
                           e.deviation_bias, e.mean_coverage, e.deviation_coverage}) {
      out += "," + without_rounding(v);
    }
    out += "\n";
  }
  return out;
}

// Seven digits are more than any flow is known to; unknown values are empty cells.
std::string number(double value) {
  if (std::isnan(value)) return "";
  return significant(value, 7);
}

std::string place(const FlowEstimate& e, int i) {
  return std::to_string(i % e.cells) + "," + std::to_string(i / e.cells) + "," + number(e.x(i)) +
         "," + number(e.y(i));
}

std::string sample(const FlowSample& s) {
  return number(s.mu_x) + "," + number(s.mu_y) + "," + number(s.sigma_x) + "," + number(s.sigma_y);
}

// Distance and probability; Lilliefors' where samples are independent, else Kolmogorov's.
std::string normality(const NormalityTest& t, double p) {
  return t.samples < 4 ? "," : number(t.distance) + "," + number(p);
}

}  // namespace

std::string flow_csv(const FlowEstimate& estimate) {
  std::string out = "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured\n";
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    const FlowCell& c = estimate.cell[i];
    out += place(estimate, static_cast<int>(i)) + "," + sample(c.flow) +
           (c.measured ? ",1\n" : ",0\n");
  }
  return out;
}

std::string flow_cells_csv(const FlowEstimate& estimate) {
  std::string out =
      "ix,iy,x_m,y_m,measured,samples,stays,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,"
      "mean_vx_se,mean_vy_se,std_vx_se,std_vy_se,ks_all_x,ks_all_x_p,ks_all_y,ks_all_y_p,ks_x,"
      "ks_x_p,ks_y,ks_y_p\n";
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    const FlowCell& c = estimate.cell[i];
    out += place(estimate, static_cast<int>(i)) + (c.measured ? ",1," : ",0,");
    out += std::to_string(c.samples) + "," + std::to_string(c.stays) + ",";
    out += sample(c.flow) + "," + sample(c.error) + ",";
    out += normality(c.all_x, c.all_x.raw_p) + "," + normality(c.all_y, c.all_y.raw_p) + ",";
    out += normality(c.normal_x, c.normal_x.p) + "," + normality(c.normal_y, c.normal_y.p) + "\n";
  }
  return out;
}

std::vector<std::string> flow_files() {
  std::vector<std::string> files{"bias.csv", "flow.txt", "flow.json", "report.html"};
  for (const char* figure : {"flow_paper", "flow_smooth", "normality", "errors"}) {
    for (const char* ending : {".png", ".svg", ".pdf", ".caption.txt"}) {
      files.push_back(std::string(figure) + ending);
    }
  }
  for (const char* table : {"flow_", "cells_", "errors_"}) {
    for (const char* estimator : {"paper.csv", "smooth.csv"}) {
      files.push_back(std::string(table) + estimator);
    }
  }
  files.insert(files.end(), {"balls_paper.toml", "balls_smooth.toml"});
  return files;
}

void write_flow(const FlowReport& report, const ReportDocument& document, const std::string& dir) {
  const std::filesystem::path path(dir);
  make_directory(dir);
  const auto write = [&](const std::string& name, const std::string& content) {
    write_atomically((path / name).string(), content);
  };
  for (const FlowEstimate& e : report.estimates) {
    write("flow_" + e.name + ".csv", flow_csv(e));
    write("cells_" + e.name + ".csv", flow_cells_csv(e));
    write("balls_" + e.name + ".toml", overlay(report, e));
    if (report.truth) write("errors_" + e.name + ".csv", flow_errors_csv(e, *report.truth));
  }
  if (!report.bias.empty()) write("bias.csv", bias_csv(report.bias));
  write("flow.txt", report_text(document));
  write("flow.json", report_json(document));
}

}  // namespace lilytank
