#include <cmath>

#include "lilytank/analysis.hpp"
#include "smoothing/motion_model.hpp"
#include "statistics/text_table.hpp"

namespace lilytank {
namespace {

const char* body_word(BodyKind body) {
  return body == BodyKind::lily ? "modules" : body == BodyKind::ball ? "balls" : "points";
}

std::string or_dash(const Estimate& e, double unit = 1) {
  return std::isnan(e.value) ? "-" : with_interval(e, unit);
}

// A number with three digits.
std::string three(double value, double unit = 1) {
  if (!std::isfinite(value)) return "-";
  const double v = std::fabs(value / unit);
  if (v < 1e-4) return "0";
  const int decimals = v >= 100 ? 0 : v >= 10 ? 1 : v >= 1 ? 2 : v >= 0.1 ? 3 : v >= 0.01 ? 4 : 6;
  return fixed(value / unit, decimals);
}

constexpr std::size_t kMostColumns = 4;  // more sources than these are rows

// Sources as columns: with many, that would be too wide, so they are rows.
class Table {
 public:
  explicit Table(const Analysis& analysis) : analysis_(analysis) {}
  template <class CellOf>
  void add(const std::string& head, const CellOf& cell_of) {
    heads_.push_back(head);
    cells_.emplace_back();
    bool any = false;
    for (const SourceSummary& s : analysis_.sources) {
      cells_.back().push_back(cell_of(s));
      any = any || cells_.back().back() != "-";
    }
    if (!any) heads_.pop_back(), cells_.pop_back();
  }
  ReportTable made() const {
    ReportTable table;
    if (heads_.empty()) return table;
    if (analysis_.sources.size() > kMostColumns) return by_row();
    table.head = {""};
    for (const SourceSummary& s : analysis_.sources) table.head.push_back(s.name);
    for (std::size_t i = 0; i < heads_.size(); ++i) {
      table.rows.push_back({heads_[i]});
      table.rows.back().insert(table.rows.back().end(), cells_[i].begin(), cells_[i].end());
    }
    return table;
  }

 private:
  ReportTable by_row() const {
    const std::string key = shared_key(analysis_);
    ReportTable table;
    table.head = {key.empty() ? "source" : key};
    table.head.insert(table.head.end(), heads_.begin(), heads_.end());
    for (std::size_t s = 0; s < analysis_.sources.size(); ++s) {
      const SourceSummary& source = analysis_.sources[s];
      const bool panel = !source.panel.empty();
      std::vector<std::string> row{source.name + (panel ? ", " + source.panel : "")};
      for (const auto& cells : cells_) row.push_back(cells[s]);
      table.rows.push_back(std::move(row));
    }
    return table;
  }
  const Analysis& analysis_;
  std::vector<std::string> heads_;
  std::vector<std::vector<std::string>> cells_;
};

// One line, where frames are too rare for velocities; it names the sources.
std::string rate_warning(const Analysis& analysis) {
  std::string which;
  for (const SourceSummary& s : analysis.sources) {
    if (!frames_too_far_apart(s)) continue;
    which += (which.empty() ? "" : ", ") + s.name + (s.panel.empty() ? "" : " at " + s.panel) +
             " (" + three(1 / s.rate) + " s, memory " + three(s.velocity_memory) + " s)";
  }
  if (which.empty()) return "";
  return "frames are further apart than a quarter of the velocity's memory: " + which +
         ". Speeds, spins and the number of contacts are then too low, contacts too long and the "
         "memory coarse; displacements and density are not affected. Store a run more often: "
         "--set output.rate=40";
}

bool any_latched(const Analysis& analysis) {
  return std::any_of(analysis.sources.begin(), analysis.sources.end(),
                     [](const SourceSummary& s) { return s.units < s.bodies; });
}

ReportSection tracks_section(const Analysis& analysis) {
  Table table(analysis);
  table.add("bodies", [](const SourceSummary& s) { return std::to_string(s.bodies); });
  if (any_latched(analysis)) {
    table.add("bodies, latched ones as one",
              [](const SourceSummary& s) { return std::to_string(s.units); });
  }
  table.add("tracks", [](const SourceSummary& s) { return std::to_string(s.tracks); });
  table.add("recordings", [](const SourceSummary& s) { return std::to_string(s.recordings); });
  table.add("duration (s)", [](const SourceSummary& s) { return three(s.duration); });
  table.add("frames/s", [](const SourceSummary& s) { return three(s.rate); });
  table.add("sightings", [](const SourceSummary& s) { return std::to_string(s.sightings); });
  table.add("missing (%)", [](const SourceSummary& s) { return fixed(100 * s.missing, 2); });
  return {"Tracks", {}, table.made()};
}

double mean_of(const std::vector<MotionModel>& models, double MotionModel::*member) {
  if (models.empty() || models[0].samples == 0) return NAN;
  double sum = 0;
  for (const MotionModel& m : models) sum += m.*member;
  return sum / static_cast<double>(models.size());
}

// The polynomials' window that a source's rate really leads to.
double window_of(const Analysis& analysis, const SourceSummary& s) {
  return used_window(analysis.options.smoothing, 1 / s.rate);
}

// Where polynomials take in more of the motion than it remembers, velocities are not the bodies'.
std::vector<std::string> wide_windows(const Analysis& analysis) {
  std::vector<std::string> out;
  for (const SourceSummary& s : analysis.sources) {
    const double window = window_of(analysis, s);
    if (!(s.velocity_memory > 0) || window <= 4 * s.velocity_memory) continue;
    out.push_back(s.name + ": a window of " + three(window) +
                  " s is longer than four memories of the velocity (" + three(s.velocity_memory) +
                  " s): it smooths away motion.");
  }
  return out;
}

void add_cutoffs(Table& table) {
  const auto cutoff = [&](const std::string& head, double TransferFunction::*member) {
    table.add(head, [&](const SourceSummary& s) {
      return s.motion.empty() ? "-" : three(s.transfer.*member);
    });
  };
  cutoff("position kept to (Hz)", &TransferFunction::position_cutoff);
  cutoff("velocity kept to (Hz)", &TransferFunction::velocity_cutoff);
  cutoff("acceleration kept to (Hz)", &TransferFunction::acceleration_cutoff);
}

ReportSection smoothing_section(const Analysis& analysis) {
  const bool kalman = analysis.options.smoothing.method == SmoothingMethod::kalman;
  Table table(analysis);
  if (!kalman) {
    table.add("window used (s)", [&](const SourceSummary& s) {
      return s.motion.empty() ? "-" : three(window_of(analysis, s));
    });
  }
  const auto model = [&](const std::string& head, auto models, double MotionModel::*member,
                         double unit) {
    table.add(head,
              [&](const SourceSummary& s) { return three(mean_of(s.*models, member), unit); });
  };
  table.add("noise (mm)", [](const SourceSummary& s) {
    return s.motion.empty() ? "-"
           : s.exact        ? "none"
                            : three(mean_of(s.motion, &MotionModel::noise), 1e-3);
  });
  model("lasting acceleration (m/s^2)", &SourceSummary::motion, &MotionModel::acceleration, 1);
  model("its memory (s)", &SourceSummary::motion, &MotionModel::memory, 1);
  model("process noise (m/s^1.5)", &SourceSummary::motion, &MotionModel::jolts, 1);
  table.add("heading noise (mrad)", [](const SourceSummary& s) {
    const double noise = mean_of(s.turning, &MotionModel::noise);
    return s.exact && !std::isnan(noise) ? "none" : three(noise, 1e-3);
  });
  add_cutoffs(table);
  const std::string how = kalman ? "Kalman smoother, model and noise fitted to the tracks"
                                 : "polynomials of degree " +
                                       std::to_string(analysis.options.smoothing.degree) +
                                       " over " + three(analysis.options.smoothing.window) + " s";
  return {"Smoothing",
          {how + "; kept: amplitude above 1/sqrt(2)"},
          table.made(),
          kalman ? std::vector<std::string>{} : wide_windows(analysis)};
}

ReportSection displacements_section(const Analysis& analysis) {
  Table table(analysis);
  table.add("first maximum (cm^2)",
            [](const SourceSummary& s) { return or_dash(s.first_maximum, 1e-4); });
  table.add("at lag (s)", [](const SourceSummary& s) { return or_dash(s.first_maximum_lag); });
  table.add("plateau (cm^2)", [](const SourceSummary& s) { return or_dash(s.plateau, 1e-4); });
  table.add("D (cm^2/s)", [](const SourceSummary& s) { return or_dash(s.diffusion.D, 1e-4); });
  const auto range = [](const Diffusion& d) {
    return d.to > 0 ? three(d.from) + " .. " + three(d.to) : std::string("-");
  };
  table.add("  from lags (s)", [&](const SourceSummary& s) { return range(s.diffusion); });
  table.add("D of turning (rad^2/s)", [](const SourceSummary& s) { return or_dash(s.rotation.D); });
  table.add("  from lags (s)", [&](const SourceSummary& s) { return range(s.rotation); });
  std::vector<std::string> note;
  for (const SourceSummary& s : analysis.sources) {
    if (s.diffusion.to > 0 || !note.empty()) continue;
    note = {
        "No D where the MSD is proportional to the lag over no factor of 2 of lags: the motion is "
        "not diffusive there."};
  }
  const std::vector<double>& lags = analysis.curves.front().x;
  return {"Mean squared displacement up to " + three(lags.back()) + " s, all origins",
          {},
          table.made(),
          std::move(note)};
}

ReportSection motion_section(const Analysis& analysis) {
  Table table(analysis);
  table.add("mean speed (cm/s)", [](const SourceSummary& s) { return or_dash(s.speed, 0.01); });
  table.add("rms speed (cm/s)", [](const SourceSummary& s) { return or_dash(s.rms_speed, 0.01); });
  table.add("rms spin (rad/s)", [](const SourceSummary& s) { return or_dash(s.rms_spin); });
  table.add("circulation (rad/s)", [](const SourceSummary& s) { return or_dash(s.circulation); });
  table.add("velocity memory (s)", [](const SourceSummary& s) {
    return s.motion.empty() ? "-" : three(s.velocity_memory);
  });
  table.add("independent samples", [](const SourceSummary& s) {
    return s.motion.empty() ? "-" : fixed(s.independent_samples, 0);
  });
  return {"Velocities", {}, table.made()};
}

ReportSection neighbours_section(const Analysis& analysis) {
  Table table(analysis);
  table.add("nearest neighbour (cm)",
            [](const SourceSummary& s) { return or_dash(s.nearest, 0.01); });
  table.add("contacts seen to begin", [](const SourceSummary& s) {
    return std::isnan(s.contact_rate.value) ? "-" : std::to_string(s.contacts.contacts);
  });
  table.add("contacts started by a body (1/min)",
            [](const SourceSummary& s) { return or_dash(s.contact_rate, 1 / 60.0); });
  table.add("time in contact (%)",
            [](const SourceSummary& s) { return or_dash(s.contact_share, 0.01); });
  table.add("mean duration (s)", [](const SourceSummary& s) { return or_dash(s.contacts.mean); });
  return {"Neighbours",
          {"Contact: gap below " + three(analysis.options.touching, 1e-3) + " mm"},
          table.made()};
}

ReportSection comparison_section(const Analysis& analysis) {
  const SourceComparison& c = analysis.comparison;
  ReportSection section;
  section.title = analysis.sources[1].name + " less " + analysis.sources[0].name;
  section.above.push_back("MSD: mean |difference| " + three(c.msd_difference, 1e-4) + " cm^2, " +
                          fixed(100 * c.msd_relative, 1) +
                          " % of the first's mean; its band excludes 0 at " +
                          fixed(100 * c.msd_outside, 0) + " % of lags");
  if (c.map_cells > 0) {
    section.above.push_back("mean velocities in " + std::to_string(c.map_cells) +
                            " cells: correlation x " + fixed(c.map_correlation_x, 3) + ", y " +
                            fixed(c.map_correlation_y, 3) + "; rms difference " +
                            three(c.map_difference, 0.01) + " cm/s, " +
                            three(c.map_expected, 0.01) + " expected from their errors alone");
  }
  return section;
}

std::string sources_of(const Analysis& analysis) {
  if (analysis.sources.size() > kMostColumns) {
    return std::to_string(analysis.sources.size()) + " sources";
  }
  std::string out;
  for (const SourceSummary& s : analysis.sources) {
    out += (out.empty() ? "" : ", ") + s.name + " (" + body_word(s.body) + ")";
  }
  return out;
}

ReportCard card_of(const Analysis& analysis) {
  ReportCard card;
  card.verdict = sources_of(analysis);
  const auto fact = [&](const std::string& name, const std::string& unit, const auto& get,
                        double scale) {
    std::string values;
    for (const SourceSummary& s : analysis.sources) {
      if (std::isnan(get(s).value)) continue;
      values += (values.empty() ? "" : "; ") + with_interval(get(s), scale) + " " + unit +
                (analysis.sources.size() > 1 ? ", " + s.name : "");
    }
    if (!values.empty()) card.facts.emplace_back(name, values);
  };
  if (analysis.sources.size() > kMostColumns) return card;
  fact(
      "mean speed", "cm/s", [](const SourceSummary& s) { return s.speed; }, 0.01);
  fact(
      "MSD plateau", "cm^2", [](const SourceSummary& s) { return s.plateau; }, 1e-4);
  fact(
      "diffusion coefficient", "cm^2/s", [](const SourceSummary& s) { return s.diffusion.D; },
      1e-4);
  return card;
}

}  // namespace

std::string resampled(const Analysis& analysis) {
  return any_latched(analysis) ? "bootstrap over bodies and assemblies" : "bootstrap over bodies";
}

ReportDocument analysis_report(const Analysis& analysis) {
  ReportDocument report;
  report.title = "Analysis";
  report.subtitle = "Intervals: " + fixed(100 * analysis.options.bootstrap.level, 0) + " %, " +
                    resampled(analysis);
  report.card = card_of(analysis);
  if (const std::string warning = rate_warning(analysis); !warning.empty()) {
    report.warnings.push_back(warning);
  }
  for (ReportSection section :
       {tracks_section(analysis), smoothing_section(analysis), displacements_section(analysis),
        motion_section(analysis), neighbours_section(analysis)}) {
    if (!section.table.rows.empty()) report.sections.push_back(std::move(section));
  }
  if (analysis.compared) report.sections.push_back(comparison_section(analysis));
  return report;
}

}  // namespace lilytank
