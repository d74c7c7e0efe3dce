#include <cmath>
#include <filesystem>

#include "io/atomic_file.hpp"
#include "lilytank/analysis.hpp"
#include "smoothing/motion_model.hpp"
#include "statistics/csv_cells.hpp"

namespace lilytank {
namespace {

// "distance from the centre" as a column's name.
std::string column(const std::string& name, const std::string& unit) {
  std::string out = name;
  if (unit != "1") out += "_" + unit;
  for (char& c : out) c = c == ' ' ? '_' : c;
  std::string plain;
  for (const char c : out) {
    if (c == '/')
      plain += "_per_";
    else if (c != '^')
      plain += c;
  }
  return plain;
}

// A source's cells: its name, after its panel where there are panels.
bool has_panels(const Analysis& analysis) {
  bool any = false;
  for (const SourceSummary& s : analysis.sources) any = any || !s.panel.empty();
  return any;
}
std::string source_head(const Analysis& analysis) {
  return has_panels(analysis) ? "panel,source" : "source";
}
std::string source_cells(const Analysis& analysis, const SourceSummary& s) {
  return (has_panels(analysis) ? cell(s.panel) + "," : "") + cell(s.name);
}

void add_rows(std::string& out, const std::string& source, const std::vector<double>& x,
              const CurveEstimate& curve, const AnalysisCurves::Of* counts) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(curve.value[i])) continue;
    out += source + "," + cell(x[i]) + "," +
           cells(Estimate{curve.value[i], curve.low[i], curve.high[i]});
    if (counts) {
      out += "," + std::to_string(counts->tracks[i]) + "," + cell(std::round(counts->samples[i]));
    } else {
      out += ",,";
    }
    out += "\n";
  }
}

// Rows of a summary: a number each.
class SummaryRows {
 public:
  explicit SummaryRows(std::string& out) : out_(out) {}
  void source(const std::string& cells) { name_ = cells; }
  void add(const std::string& number, const std::string& unit, const Estimate& e) {
    if (std::isnan(e.value)) return;
    out_ += name_ + "," + number + "," + unit + "," + cells(e) + "\n";
  }
  void add(const std::string& number, const std::string& unit, double value) {
    if (!std::isnan(value)) {
      out_ += name_ + "," + number + "," + unit + "," + cell(value) + ",,\n";
    }
  }

 private:
  std::string& out_;
  std::string name_;
};

void add_motion(SummaryRows& rows, const std::string& what, const std::string& unit,
                const std::vector<MotionModel>& models, bool exact) {
  const double n = static_cast<double>(models.size());
  double noise = 0, acceleration = 0, memory = 0, jolts = 0, samples = 0;
  for (const MotionModel& m : models) {
    noise += m.noise / n, acceleration += m.acceleration / n, memory += m.memory / n;
    jolts += m.jolts / n, samples += static_cast<double>(m.samples);
  }
  if (samples == 0) return;
  if (!exact) rows.add(what + " noise", unit, noise);
  rows.add(what + " lasting acceleration", unit + "/s^2", acceleration);
  rows.add(what + " acceleration memory", "s", memory);
  rows.add(what + " process noise", unit + "/s^1.5", jolts);
}

void add_source(SummaryRows& rows, const SourceSummary& s) {
  rows.add("recordings", "1", s.recordings);
  rows.add("bodies", "1", s.bodies);
  rows.add("tracks", "1", s.tracks);
  rows.add("sightings", "1", static_cast<double>(s.sightings));
  rows.add("missing share", "1", s.missing);
  rows.add("rate", "Hz", s.rate);
  rows.add("duration", "s", s.duration);
  add_motion(rows, "position", "m", s.motion, s.exact);
  add_motion(rows, "heading", "rad", s.turning, s.exact);
  rows.add("mean speed", "m/s", s.speed);
  rows.add("rms speed", "m/s", s.rms_speed);
  rows.add("rms spin", "rad/s", s.rms_spin);
  rows.add("circulation", "rad/s", s.circulation);
  rows.add("velocity memory", "s", s.motion.empty() ? NAN : s.velocity_memory);
  rows.add("independent velocity samples", "1", s.motion.empty() ? NAN : s.independent_samples);
  rows.add("frames too far apart for velocities", "1",
           s.motion.empty() ? NAN : frames_too_far_apart(s));
  rows.add("msd first maximum", "m^2", s.first_maximum);
  rows.add("msd first maximum lag", "s", s.first_maximum_lag);
  rows.add("msd plateau", "m^2", s.plateau);
  rows.add("diffusion coefficient", "m^2/s", s.diffusion.D);
  rows.add("rotational diffusion coefficient", "rad^2/s", s.rotation.D);
  rows.add("nearest neighbour distance", "m", s.nearest);
  rows.add("contact rate", "1/s", s.contact_rate);
  rows.add("contact share of time", "1", s.contact_share);
  rows.add("contact duration", "s", s.contacts.mean);
}

}  // namespace

std::string curve_csv(const Analysis& analysis, const AnalysisCurves& curves) {
  std::string out = source_head(analysis) + "," + column(curves.x_name, curves.x_unit) + "," +
                    column(curves.y_name, curves.y_unit) + ",low,high,tracks,samples\n";
  for (const AnalysisCurves::Of& of : curves.sources) {
    const SourceSummary& s = analysis.sources[of.source];
    add_rows(out, source_cells(analysis, s), curves.x, of.curve, &of);
  }
  if (!curves.difference.value.empty()) {
    const std::string name = has_panels(analysis) ? ",difference" : "difference";
    add_rows(out, name, curves.x, curves.difference, nullptr);
  }
  return out;
}

std::string velocity_map_csv(const Analysis& analysis) {
  std::string out = source_head(analysis) +
                    ",ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,se_vx_mps,se_vy_mps,samples,bodies\n";
  for (std::size_t s = 0; s < analysis.maps.size(); ++s) {
    const VelocityMap& map = analysis.maps[s];
    const Bins bins{-map.extent, map.extent, map.cells};
    for (std::size_t i = 0; i < map.vx.size(); ++i) {
      if (map.samples[i] == 0) continue;
      const auto ix = static_cast<int>(i) % map.cells, iy = static_cast<int>(i) / map.cells;
      out += source_cells(analysis, analysis.sources[s]) + "," + std::to_string(ix) + "," +
             std::to_string(iy) + "," + cell(bins.middle(ix)) + "," + cell(bins.middle(iy)) + "," +
             cell(map.vx[i]) + "," + cell(map.vy[i]) + "," + cell(map.se_x[i]) + "," +
             cell(map.se_y[i]) + "," + std::to_string(map.samples[i]) + "," +
             std::to_string(map.bodies[i]) + "\n";
    }
  }
  return out;
}

std::string contact_times_csv(const Analysis& analysis) {
  std::string out =
      source_head(analysis) + ",time_s,share_longer,low,high,at_risk,ended,censored\n";
  for (const SourceSummary& s : analysis.sources) {
    const Survival& c = s.contacts.survival;
    for (std::size_t i = 0; i < c.time.size(); ++i) {
      out += source_cells(analysis, s) + "," + cell(c.time[i]) + "," +
             cells(Estimate{c.survival[i], c.low[i], c.high[i]}) + "," +
             std::to_string(c.at_risk[i]) + "," + std::to_string(c.events[i]) + "," +
             std::to_string(c.censored[i]) + "\n";
    }
  }
  return out;
}

std::string transfer_csv(const Analysis& analysis) {
  std::string out = source_head(analysis) + ",frequency_Hz,position,velocity,acceleration\n";
  for (const SourceSummary& s : analysis.sources) {
    for (std::size_t i = 0; i < s.transfer.frequency.size(); ++i) {
      out += source_cells(analysis, s) + "," + cell(s.transfer.frequency[i]) + "," +
             cell(s.transfer.position[i]) + "," + cell(s.transfer.velocity[i]) + "," +
             cell(s.transfer.acceleration[i]) + "\n";
    }
  }
  return out;
}

std::string analysis_summary_csv(const Analysis& analysis) {
  std::string out = source_head(analysis) + ",number,unit,value,low,high\n";
  SummaryRows rows(out);
  for (const SourceSummary& s : analysis.sources) {
    rows.source(source_cells(analysis, s));
    if (analysis.options.smoothing.method == SmoothingMethod::polynomial && !s.motion.empty()) {
      rows.add("smoothing window used", "s", used_window(analysis.options.smoothing, 1 / s.rate));
    }
    add_source(rows, s);
  }
  if (!analysis.compared) return out;
  const SourceComparison& c = analysis.comparison;
  rows.source((has_panels(analysis) ? std::string(",") : std::string()) + "difference");
  rows.add("msd mean absolute difference", "m^2", c.msd_difference);
  rows.add("msd relative difference", "1", c.msd_relative);
  rows.add("msd share of lags beyond the band", "1", c.msd_outside);
  if (c.map_cells == 0) return out;
  rows.add("map correlation x", "1", c.map_correlation_x);
  rows.add("map correlation y", "1", c.map_correlation_y);
  rows.add("map rms difference", "m/s", c.map_difference);
  rows.add("map rms expected from errors", "m/s", c.map_expected);
  rows.add("map cells", "1", c.map_cells);
  return out;
}

std::vector<std::pair<std::string, std::string>> analysis_files(const Analysis& analysis,
                                                                const ReportDocument& report) {
  std::vector<std::pair<std::string, std::string>> files{
      {"summary.txt", report_text(report)}, {"summary.csv", analysis_summary_csv(analysis)}};
  for (const AnalysisCurves& curves : analysis.curves) {
    files.emplace_back(curves.name + ".csv", curve_csv(analysis, curves));
  }
  if (analysis.options.msd_only) return files;
  files.emplace_back("velocity_map.csv", velocity_map_csv(analysis));
  files.emplace_back("contact_times.csv", contact_times_csv(analysis));
  files.emplace_back("transfer.csv", transfer_csv(analysis));
  return files;
}

std::vector<std::string> write_analysis(const Analysis& analysis, const ReportDocument& report,
                                        const std::string& dir) {
  std::vector<std::string> files = write_files(dir, analysis_files(analysis, report));
  for (std::string& file : files) file = (std::filesystem::path(dir) / file).string();
  return files;
}

}  // namespace lilytank
