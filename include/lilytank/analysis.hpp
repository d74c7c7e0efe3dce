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
  std::string panel;  ///< sources of one panel share a plot; empty for all: one plot
  std::vector<Recording> recordings;  ///< of one kind of body
  double tank_radius = 0.30;          ///< inner radius of the tank, m
  double body_size = 0.035;           ///< side of squares or diameter of balls, m
  bool exact = false;  ///< places without noise, as a simulation's own: none is estimated
  std::string key;     ///< what the name is a value of, "pump power", for legends; empty: nothing
};

/// What is computed, at which lags and with which smoother.
struct AnalysisOptions {
  double longest_lag = 60;  ///< s; the paper compares 60 s of MSD (Eq. 9)
  int map_cells = 50;       ///< cells along one side of the velocity maps, over the tank's diameter
  /// s, lags to fit D to; 0, 0: where the MSD is one of diffusion.
  double diffusion_from = 0, diffusion_to = 0;
  double touching = 0.001;     ///< gap below which bodies touch, m
  bool msd_only = false;       ///< whether only displacements are analysed
  SmoothingOptions smoothing;  ///< smoother of velocities; the MSD needs none
  Bootstrap bootstrap;         ///< bands and intervals: bootstrap over bodies and assemblies
};

/// One curve of all sources over the same x.
struct AnalysisCurves {
  std::string name;                            ///< "msd_all", of files
  std::string title;                           ///< "mean squared displacement, all origins"
  std::string x_name, x_unit, y_name, y_unit;  ///< "lag", "s", "msd", "m^2"; unit 1: none
  std::vector<double> x;                       ///< common abscissa of all sources, ascending
  /// The curve of one source, with its band and the data behind each x.
  struct Of {
    int source = 0;                    ///< index into Analysis::sources
    CurveEstimate curve;               ///< [x] value with its band
    std::vector<std::int64_t> tracks;  ///< [x] tracks that contribute
    std::vector<double> samples;  ///< [x] weight of the mean, such as the number of displacements
  };
  std::vector<Of> sources;   ///< that have it
  CurveEstimate difference;  ///< second less first, where there are just two; else empty
};

/// How long contacts last, of one source.
struct ContactTimes {
  Survival survival;          ///< fraction of contacts that last longer, over time (s)
  Estimate mean;              ///< mean duration, s, restricted to the longest time observed
  std::int64_t contacts = 0;  ///< contacts that were seen to begin
};

/// Numbers of one source; NaN where it does not have them.
struct SourceSummary {
  std::string name, panel, key;  ///< as in AnalysisSource
  BodyKind body = BodyKind::lily;
  /// Counts of the source: bodies are distinct ids within a recording, tracks the unbroken pieces.
  int recordings = 0, bodies = 0, tracks = 0;
  int units = 0;               ///< that bands resample: bodies, of which latched ones count as one
  std::int64_t sightings = 0;  ///< positions in all tracks
  bool exact = false;          ///< places without noise
  double rate = 0, duration = 0;  ///< frames per second, Hz; duration of the longest recording, s
  double missing = 0;  ///< fraction of the frames within tracks in which the body was not seen
  /// Fitted model of positions and of headings, one per recording.
  std::vector<MotionModel> motion, turning;
  /// Transfer function of the positions' smoother, with the model of the first recording.
  TransferFunction transfer;
  Estimate speed, rms_speed;  ///< mean speed and root mean square speed, m/s
  Estimate rms_spin;          ///< root mean square angular velocity, rad/s
  Estimate circulation;       ///< mean angular velocity about the tank's centre, rad/s
  /// Integral of the velocity's autocorrelation up to where it first is 0, s.
  double velocity_memory = 0;
  /// Effective number of independent velocities: time in all tracks / (2 memory).
  double independent_samples = 0;
  Estimate first_maximum_lag, first_maximum;  ///< s, m^2: half an orbit
  Estimate plateau;                           ///< mean MSD over the second half of the lags, m^2
  Diffusion diffusion, rotation;  ///< D of displacements (m^2/s) and of headings (rad^2/s)
  Estimate contact_rate;          ///< contacts started by a body, 1/s
  Estimate contact_share;         ///< fraction of time in which a body touches another
  ContactTimes contacts;          ///< how long they last
  Estimate nearest;               ///< mean distance to the nearest neighbour, m
};

/// Whether frames are further apart than a quarter of the velocity's memory. Speeds, spins and the
/// number of contacts are then too low, contacts too long, and the memory itself is coarse.
/// False where nothing moves or velocities were not requested.
bool frames_too_far_apart(const SourceSummary& source);

/// Two sources against each other, second less first.
struct SourceComparison {
  double msd_difference = 0;  ///< mean of |difference| over the lags [paper, Eq. 9], m^2
  double msd_relative = 0;    ///< msd_difference divided by the first source's mean MSD
  double msd_outside = 0;     ///< fraction of lags at which the band of the difference excludes 0
  /// Correlation of mean velocities over the cells, per axis.
  double map_correlation_x = 0, map_correlation_y = 0;
  double map_difference = 0;  ///< root mean square per axis, m/s
  double map_expected = 0;    ///< the difference that the standard errors alone predict, m/s
  int map_cells = 0;          ///< cells that at least two bodies passed in both sources
};

/// All results. Curves, maps and tests refer to sources by their index.
struct Analysis {
  AnalysisOptions options;
  std::vector<SourceSummary> sources;
  std::vector<AnalysisCurves> curves;
  std::vector<VelocityMap> maps;  ///< one per source; empty with msd_only
  double tank_radius = 0;         ///< largest of the sources, m
  bool compared = false;          ///< whether `comparison` is set: there are two sources
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

/// What bands resample: "bootstrap over bodies", or over assemblies where modules were latched.
std::string resampled(const Analysis& analysis);

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
