// Everything that lilytank tells of recordings or runs at once, and two of them against each other;
// as text, tidy tables and (render.hpp) plots.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "lilytank/distributions.hpp"
#include "lilytank/metrics.hpp"
#include "lilytank/report.hpp"
#include "lilytank/smoothing.hpp"

namespace lilytank {

/// Recordings that belong together: repetitions of one experiment, or one run.
struct AnalysisSource {
  std::string name;
  std::string panel;  ///< sources of one panel share a plot; empty for all: one plot
  std::vector<Recording> recordings;  ///< of one kind of body
  double tank_radius = 0.30;          ///< m
  double body_size = 0.035;           ///< m, side of squares or diameter of balls
  bool exact = false;  ///< places without noise, as a simulation's own: none is estimated
  std::string key;     ///< what the name is a value of, "pump power", for legends; empty: nothing
};

struct AnalysisOptions {
  double longest_lag = 60;  ///< s; the paper compares 60 s of MSD (Eq. 9)
  int map_cells = 50;
  double diffusion_from = 0, diffusion_to = 0;  ///< s, lags to fit D to; 0, 0: where the MSD is one
                                                ///< of diffusion
  double touching = 0.001;                      ///< m, gap below which bodies touch
  bool msd_only = false;                        ///< nothing but displacements
  SmoothingOptions smoothing;
  Bootstrap bootstrap;
};

/// One curve of all sources over the same x.
struct AnalysisCurves {
  std::string name;                            ///< "msd_all", of files
  std::string title;                           ///< "mean squared displacement, all origins"
  std::string x_name, x_unit, y_name, y_unit;  ///< "lag", "s", "msd", "m^2"; unit 1: none
  std::vector<double> x;
  struct Of {
    int source = 0;
    CurveEstimate curve;
    std::vector<std::int64_t> tracks;
    std::vector<double> samples;
  };
  std::vector<Of> sources;   ///< that have it
  CurveEstimate difference;  ///< second less first, where there are just two; else empty
};

/// How long contacts last, of one source.
struct ContactTimes {
  Survival survival;          ///< share of contacts that last longer, over time (s)
  Estimate mean;              ///< s, restricted to the longest that was watched
  std::int64_t contacts = 0;  ///< seen to begin
};

/// Numbers of one source; NaN where it does not have them.
struct SourceSummary {
  std::string name, panel, key;  ///< as in AnalysisSource
  BodyKind body = BodyKind::lily;
  int recordings = 0, bodies = 0, tracks = 0;
  std::int64_t sightings = 0;
  bool exact = false;                        ///< places without noise
  double rate = 0, duration = 0;             ///< Hz; s, of the longest recording
  double missing = 0;                        ///< share of frames within tracks
  std::vector<MotionModel> motion, turning;  ///< a recording
  TransferFunction transfer;                 ///< of the positions' smoother, first recording
  Estimate speed, rms_speed;                 ///< m/s, mean and root of mean square
  Estimate rms_spin;                         ///< rad/s
  Estimate circulation;                      ///< rad/s about the tank's centre
  double velocity_memory = 0;      ///< s, integral of the velocity's autocorrelation up to
                                   ///< where it first is 0
  double independent_samples = 0;  ///< of velocity, in all tracks: time / (2 memory)
  Estimate first_maximum_lag, first_maximum;  ///< s, m^2: half an orbit
  Estimate plateau;                           ///< m^2, mean MSD over the second half of the lags
  Diffusion diffusion, rotation;
  Estimate contact_rate;   ///< 1/s, begun by a body
  Estimate contact_share;  ///< of time in which a body touches another
  ContactTimes contacts;
  Estimate nearest;  ///< m, mean distance to the nearest neighbour
};

/// Whether frames are further apart than a quarter of the velocity's memory. Speeds, spins and the
/// number of contacts are then too low, contacts too long, and the memory itself is coarse.
/// False where nothing moves or velocities were not asked for.
bool frames_too_far_apart(const SourceSummary& source);

/// Two sources against each other, second less first.
struct SourceComparison {
  double msd_difference = 0;  ///< m^2, mean of |difference| over the lags [paper, Eq. 9]
  double msd_relative = 0;    ///< the same over the first's mean MSD
  double msd_outside = 0;     ///< share of lags at which the band of the difference excludes 0
  double map_correlation_x = 0, map_correlation_y = 0;  ///< of mean velocities, cell by cell
  double map_difference = 0;                            ///< m/s, root mean square per axis
  double map_expected = 0;  ///< m/s, the same from the standard errors alone
  int map_cells = 0;        ///< seen in both by two bodies or more
};

struct Analysis {
  AnalysisOptions options;
  std::vector<SourceSummary> sources;
  std::vector<AnalysisCurves> curves;
  std::vector<VelocityMap> maps;  ///< a source; empty with msd_only
  double tank_radius = 0;         ///< m, the largest
  bool compared = false;
  SourceComparison comparison;
  const AnalysisCurves* find(const std::string& name) const;
};
/// What the names of all sources are values of; empty where they differ in that.
std::string shared_key(const Analysis& analysis);

/// Analyses sources together: lags and bins are the same for all, so that curves can be laid over
/// each other. Lags are whole frames of the slowest source. Throws InputError for a source without
/// tracks of two frames.
Analysis analyse(const std::vector<AnalysisSource>& sources, const AnalysisOptions& options = {});

/// The report, without its provenance.
ReportDocument analysis_report(const Analysis& analysis);
std::string analysis_text(const Analysis& analysis);
/// Tidy tables: one row a source and x (`difference` rows after them), a cell of a map, a step of
/// a survival curve, a frequency of a transfer function, a number of the summary.
std::string curve_csv(const Analysis& analysis, const AnalysisCurves& curves);
std::string velocity_map_csv(const Analysis& analysis);
std::string contact_times_csv(const Analysis& analysis);
std::string transfer_csv(const Analysis& analysis);
std::string analysis_summary_csv(const Analysis& analysis);
/// All of these as files, pairs of name and content: summary.txt (the report), summary.csv and one
/// CSV a plot.
std::vector<std::pair<std::string, std::string>> analysis_files(const Analysis& analysis,
                                                                const ReportDocument& report);
/// Writes analysis_files() to a directory, made if absent. Returns their paths. Throws InputError
/// if it cannot.
std::vector<std::string> write_analysis(const Analysis& analysis, const ReportDocument& report,
                                        const std::string& dir);

}  // namespace lilytank
