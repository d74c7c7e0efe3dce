// The files of a calibration.
#include <cmath>

#include "calibrate/fit_conditions.hpp"
#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/calibration.hpp"
#include "statistics/csv_cells.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Six digits, finer than any interval; empty for NaN.
std::string number(double value) {
  if (!std::isfinite(value)) return "";
  return significant(value, 6);
}

std::string overlay(const CalibrationResult& c) {
  ScenarioText out = begun_overlay(
      "Parameters found from the recordings of " + c.name + " (objective " + c.objective +
          "): an overlay of a scenario, as in\n"
          "  lilytank run scenarios/tank_lilies.toml calibrated.toml\n"
          "95 % intervals follow each estimate; they hold for the other values here.",
      c.conditions, !c.flow_csv.empty());
  for (const CalibratedParameter& p : c.parameters) {
    if (p.parameter.nuisance) continue;
    const std::string unit = p.parameter.unit == "1" ? "" : " " + p.parameter.unit;
    out.line(p.parameter.path, number(p.estimate), number(p.low) + " .. " + number(p.high) + unit);
  }
  return out.text();
}

std::string intervals_csv(const CalibrationResult& c) {
  std::string out =
      "parameter,unit,scale,bound_low,bound_high,start,searched,middle,estimate,low,high,"
      "deviation,bias,nuisance\n";
  for (const CalibratedParameter& p : c.parameters) {
    const FitParameter& of = p.parameter;
    out += of.path + "," + of.unit + "," + (of.logarithmic ? "log" : "linear");
    for (const double v : {of.low, of.high, p.start, p.searched, p.middle, p.estimate, p.low,
                           p.high, p.deviation, p.bias}) {
      out += "," + number(v);
    }
    out += of.nuisance ? ",1\n" : ",0\n";
  }
  return out;
}

std::string correlation_csv(const CalibrationResult& c) {
  std::string out = "first,second,correlation\n";
  const std::size_t n = c.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      out += c.parameters[i].parameter.path + "," + c.parameters[j].parameter.path + "," +
             number(c.correlation[i * n + j]) + "\n";
    }
  }
  return out;
}

std::string profiles_csv(const CalibrationResult& c) {
  std::string out = "parameter,value,misfit_rise\n";
  for (const CalibratedParameter& p : c.parameters) {
    for (std::size_t i = 0; i < p.profile_value.size(); ++i) {
      out += p.parameter.path + "," + number(p.profile_value[i]) + "," + number(p.profile_rise[i]) +
             "\n";
    }
  }
  return out;
}

std::string numbers_csv(const CalibrationResult& c) {
  std::string out = "group,number,observed,expected,deviation,z\n";
  for (const ComparedNumber& n : c.numbers) {
    out += cell(n.entry.group) + "," + cell(n.entry.name);
    for (const double v : {n.observed, n.expected, n.deviation, n.z()}) out += "," + number(v);
    out += "\n";
  }
  return out;
}

std::string msd_csv(const CalibrationResult& c) {
  std::string out =
      "recordings,lag_s,real_m2,before_m2,after_m2,real_low_m2,real_high_m2,after_low_m2,"
      "after_high_m2,floor_m2\n";
  for (const MsdFit& m : c.msd) {
    for (std::size_t k = 0; k < m.lag.size(); ++k) {
      out += m.recordings;
      for (const double v : {m.lag[k], m.real[k], m.simulated_before[k], m.simulated_after[k]}) {
        out += "," + number(v);
      }
      for (const auto* values :
           {&m.real_low, &m.real_high, &m.after_low, &m.after_high, &m.floor_at}) {
        out += "," + (k < values->size() ? number((*values)[k]) : "");
      }
      out += "\n";
    }
  }
  return out;
}

std::string velocity_csv(const CalibrationResult& c) {
  std::string out = "ix,iy,real_vx_mps,real_vy_mps,simulated_vx_mps,simulated_vy_mps\n";
  const VelocityMap &a = c.real_velocity, &b = c.simulated_velocity;
  for (std::size_t i = 0; i < a.vx.size(); ++i) {
    const auto cells = static_cast<std::size_t>(a.cells);
    out += std::to_string(i % cells) + "," + std::to_string(i / cells) + "," + number(a.vx[i]) +
           "," + number(a.vy[i]);
    out += b.vx.empty() ? ",," : "," + number(b.vx[i]) + "," + number(b.vy[i]);
    out += "\n";
  }
  return out;
}

std::string history_csv(const CalibrationResult& c) {
  std::string out = "iteration,evaluations,best,median,worst,spread\n";
  for (const IterationRecord& r : c.history) {
    out += std::to_string(r.iteration) + "," + std::to_string(r.evaluations);
    for (const double v : {r.best, r.median, r.worst, r.spread}) out += "," + number(v);
    out += "\n";
  }
  return out;
}

// The sequence of response surfaces.
std::string rounds_csv(const CalibrationResult& c) {
  std::string out = "round,simulations,moved,misfit,at_reach";
  for (const CalibratedParameter& p : c.parameters) out += "," + p.parameter.path;
  out += "\n";
  for (const LocalRound& r : c.rounds_taken) {
    out += r.name + "," + std::to_string(r.simulations) + "," + number(r.moved) + "," +
           number(r.misfit) + (r.at_bound ? ",1" : ",0");
    for (const double v : r.estimate) out += "," + number(v);
    out += "\n";
  }
  return out;
}

std::string json(const CalibrationResult& c) {
  Json out{{"name", c.name},     {"objective", c.objective},
           {"flow", c.flow},     {"search", c.search_name},
           {"dt", c.dt},         {"simulations", c.simulations},
           {"misfit", c.misfit}, {"misfit_p", c.misfit_p}};
  out["parameters"] = Json::array(), out["eq9"] = Json::array();
  for (const CalibratedParameter& p : c.parameters) {
    out["parameters"].push_back({{"path", p.parameter.path},
                                 {"unit", p.parameter.unit},
                                 {"start", p.start},
                                 {"estimate", p.estimate},
                                 {"low", p.low},
                                 {"high", p.high}});
  }
  for (const MsdFit& m : c.msd) {
    out["eq9"].push_back({{"recordings", m.recordings},
                          {"pieces", m.pieces},
                          {"seconds", m.seconds},
                          {"before", m.before},
                          {"after", m.after},
                          {"floor", m.floor},
                          {"equals", m.equals},
                          {"equals_p", m.equals_p}});
  }
  out["warnings"] = c.warnings;
  return json_text(out);
}

}  // namespace

std::vector<std::string> calibration_files() {
  return with_figures({"calibrated.toml", "intervals.csv", "correlation.csv", "profiles.csv",
                       "numbers.csv", "history.csv", "rounds.csv", "calibration.json",
                       "calibration.txt", "msd.csv", "velocity.csv", "flow.csv", "report.html"},
                      {"convergence", "msd", "velocity", "profiles", "estimates"});
}

std::vector<std::string> write_calibration(const CalibrationResult& c, const ReportDocument& report,
                                           const std::string& dir) {
  std::vector<std::pair<std::string, std::string>> files{
      {"calibrated.toml", overlay(c)},         {"intervals.csv", intervals_csv(c)},
      {"correlation.csv", correlation_csv(c)}, {"profiles.csv", profiles_csv(c)},
      {"numbers.csv", numbers_csv(c)},         {"rounds.csv", rounds_csv(c)},
      {"calibration.json", json(c)},           {"calibration.txt", report_text(report)}};
  if (!c.history.empty()) files.emplace_back("history.csv", history_csv(c));
  if (!c.msd.empty()) {
    files.emplace_back("msd.csv", msd_csv(c));
    files.emplace_back("velocity.csv", velocity_csv(c));
  }
  if (!c.flow_csv.empty()) files.emplace_back("flow.csv", c.flow_csv);
  return write_files(dir, files);
}

}  // namespace lilytank
