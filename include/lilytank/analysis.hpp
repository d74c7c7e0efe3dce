// All statistics of recordings or runs at once, and the comparison of two of them,
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
  /// Sources of one panel share a plot; empty for all: one plot.
  std::string panel;
  std::vector<Recording> recordings;  ///< of one kind of body
  /// Inner radius of the tank, m.
  double tank_radius = 0.30;
  /// Side of squares or diameter of balls, m.
  double body_size = 0.035;
  /// Places without noise, as a simulation's own: none is estimated.
  bool exact = false;
  /// What the name is a value of, "pump power", for legends; empty: nothing.
  std::string key;
};

/// What is computed, at which lags and with which smoother.
struct AnalysisOptions {
  /// s; the paper compares 60 s of MSD (Eq. 9).
  double longest_lag = 60;
  /// Cells along one side of the velocity maps, over the tank's diameter.
  int map_cells = 50;
  /// s, lags to fit D to; 0, 0: where the MSD is one of diffusion.
  double diffusion_from = 0, diffusion_to = 0;
  /// Gap below which bodies touch, m.
  double touching = 0.001;
  /// Whether only displacements are analysed.
  bool msd_only = false;
  /// Smoother of velocities; the MSD needs none.
  SmoothingOptions smoothing;
  /// Bands and intervals: bootstrap over bodies.
  Bootstrap bootstrap;
};

/// One curve of all sources over the same x.
struct AnalysisCurves {
  std::string name;  ///< "msd_all", of files
  /// "mean squared displacement, all origins".
  std::string title;
  /// "lag", "s", "msd", "m^2"; unit 1: none.
  std::string x_name, x_unit, y_name, y_unit;
  /// Common abscissa of all sources, ascending.
  std::vector<double> x;
  /// The curve of one source, with its band and the data behind each x.
  struct Of {
    /// Index into Analysis::sources.
    int source = 0;
    /// [x] Value with its band.
    CurveEstimate curve;
    /// [x] Tracks that contribute.
    std::vector<std::int64_t> tracks;
    /// [x] Weight of the mean, such as the number of displacements.
    std::vector<double> samples;
  };
  std::vector<Of> sources;  ///< that have it
  /// Second less first, where there are just two; else empty.
  CurveEstimate difference;
};

/// How long contacts last, of one source.
struct ContactTimes {
  /// Share of contacts that last longer, over time (s).
  Survival survival;
  /// Mean duration, s, restricted to the longest time observed.
  Estimate mean;
  /// Contacts that were seen to begin.
  std::int64_t contacts = 0;
};

/// Numbers of one source; NaN where it does not have them.
struct SourceSummary {
  std::string name, panel, key;  ///< as in AnalysisSource
  BodyKind body = BodyKind::lily;
  /// Counts of the source: bodies are distinct ids within a recording, tracks the unbroken pieces.
  int recordings = 0, bodies = 0, tracks = 0;
  /// Positions in all tracks.
  std::int64_t sightings = 0;
  bool exact = false;  ///< places without noise
  /// Frames per second, Hz; duration of the longest recording, s.
  double rate = 0, duration = 0;
  /// Fraction of the frames within tracks in which the body was not seen.
  double missing = 0;
  /// Fitted model of positions and of headings, one per recording.
  std::vector<MotionModel> motion, turning;
  /// Transfer function of the positions' smoother, with the model of the first recording.
  TransferFunction transfer;
  /// Mean speed and root mean square speed, m/s.
  Estimate speed, rms_speed;
  /// Root mean square angular velocity, rad/s.
  Estimate rms_spin;
  /// Mean angular velocity about the tank's centre, rad/s.
  Estimate circulation;
  /// Integral of the velocity's autocorrelation up to where it first is 0, s.
  double velocity_memory = 0;
  /// Effective number of independent velocities: time in all tracks / (2 memory).
  double independent_samples = 0;
  Estimate first_maximum_lag, first_maximum;  ///< s, m^2: half an orbit
  /// Mean MSD over the second half of the lags, m^2.
  Estimate plateau;
  /// D of displacements (m^2/s) and of headings (rad^2/s).
  Diffusion diffusion, rotation;
  /// Contacts begun by a body, 1/s.
  Estimate contact_rate;
  /// Fraction of time in which a body touches another.
  Estimate contact_share;
  /// How long they last.
  ContactTimes contacts;
  /// Mean distance to the nearest neighbour, m.
  Estimate nearest;
};

/// Whether frames are further apart than a quarter of the velocity's memory. Speeds, spins and the
/// number of contacts are then too low, contacts too long, and the memory itself is coarse.
/// False where nothing moves or velocities were not requested.
bool frames_too_far_apart(const SourceSummary& source);

/// Two sources against each other, second less first.
struct SourceComparison {
  /// Mean of |difference| over the lags [paper, Eq. 9], m^2.
  double msd_difference = 0;
  /// msd_difference divided by the first source's mean MSD.
  double msd_relative = 0;
  /// Share of lags at which the band of the difference excludes 0.
  double msd_outside = 0;
  /// Correlation of mean velocities over the cells, per axis.
  double map_correlation_x = 0, map_correlation_y = 0;
  /// Root mean square per axis, m/s.
  double map_difference = 0;
  /// The difference that the standard errors alone predict, m/s.
  double map_expected = 0;
  /// Cells that at least two bodies passed in both sources.
  int map_cells = 0;
};

/// All results. Curves, maps and tests refer to sources by their index.
struct Analysis {
  AnalysisOptions options;
  std::vector<SourceSummary> sources;
  std::vector<AnalysisCurves> curves;
  /// One per source; empty with msd_only.
  std::vector<VelocityMap> maps;
  /// Largest of the sources, m.
  double tank_radius = 0;
  /// Whether `comparison` is set: there are two sources.
  bool compared = false;
  SourceComparison comparison;
  /// The curves of that name; null if there are none.
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
