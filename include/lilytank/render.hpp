// Pictures of stored runs and studies: frames, films, curves. Only files in render/ know Cairo.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "lilytank/analysis.hpp"
#include "lilytank/calibration.hpp"
#include "lilytank/diagnosis.hpp"
#include "lilytank/flow_report.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/proof.hpp"
#include "lilytank/recovery.hpp"
#include "lilytank/run.hpp"
#include "lilytank/search.hpp"
#include "lilytank/study_summary.hpp"
#include "lilytank/synthesis.hpp"

namespace lilytank {

/// How figures are adapted to a journal.
struct FigureStyle {
  /// Width on paper, mm: 85 is a column, 174 two. 0: figures are as large as they say. Texts have
  /// 6 pt or more at every width.
  double width = 0;
  /// No sentences above figures. Names of panels stay.
  bool untitled = false;
  bool on_paper() const { return width > 0; }
};

/// How the mean flow is drawn below the bodies.
enum class FlowStyle { none, arrows, streamlines };

/// How a frame looks.
struct FrameStyle {
  /// Pixels, height of the picture; the width is 16/9 of it.
  int size = 1080;
  FlowStyle flow = FlowStyle::streamlines;
  /// Length of the path drawn behind each body, s; 0: none.
  double trail = 4;
  /// l_a and the last engaged connector on each module.
  bool labels = true;
  /// Title, clock, yield and legend right of the tank. Without them the picture is square.
  bool panel = true;
};

/// Frame at a time (s), poses interpolated between stored ones, as .png, .svg or .pdf by the file's
/// ending; on paper without the panel. Throws InputError outside the run or if the file cannot be
/// written.
void draw_frame(const StoredRun& run, double time, const FrameStyle& style, const std::string& file,
                const FigureStyle& paper = {});
/// The bytes that draw_frame() writes to `file`.
std::string frame_picture(const StoredRun& run, double time, const FrameStyle& style,
                          const std::string& file, const FigureStyle& paper = {});
/// What its caption file says.
std::string frame_caption(const StoredRun& run, double time, const FrameStyle& style,
                          const ReportProvenance& provenance);

/// Which part of a run is filmed, and how fast.
struct FilmOptions : JobControl {
  /// Simulated time that is filmed, s; to < 0: up to the end.
  double from = 0, to = -1;
  /// Frames per second of the film.
  double fps = 30;
  /// Simulated seconds per second of film; 0: by `length`.
  double speed = 0;
  /// Duration of the film, s, if `speed` is 0.
  double length = 60;
  FrameStyle style;
  /// Replace files that are not this film or its frames.
  bool force = true;
};
/// Throws InputError if ffmpeg, which films need, is not in PATH. Call it before long work.
void require_film_program();
/// A film, .mp4 or .gif by the file's ending: frames are piped to ffmpeg, nothing else is written;
/// the file appears whole or not at all. An .mp4 names in its comment the film that it holds, so a
/// repeated call may replace it. Throws Stopped; InputError if ffmpeg is missing or fails, and as
/// check_film() before the first frame is drawn.
void draw_film(const StoredRun& run, const FilmOptions& options, const std::string& file);
/// Throws InputError if the file exists and is not this film, unless `options.force`.
void check_film(const StoredRun& run, const FilmOptions& options, const std::string& file);
/// Whether a file is an .mp4 that draw_film() wrote. Throws InputError if it cannot be read.
bool is_film(const std::string& file);
/// When the film's frames are (s of simulated time). Throws InputError as draw_film.
std::vector<double> film_times(const StoredRun& run, const FilmOptions& options);
/// The same frames as numbered PNG files in a directory; check_stills() before the first one. With
/// `options.force`, frames of another film are removed.
void draw_stills(const StoredRun& run, const FilmOptions& options, const std::string& dir);
/// Throws InputError if the directory holds frames of another film, unless `options.force`.
void check_stills(const StoredRun& run, const FilmOptions& options, const std::string& dir);

/// One curve of a plot; `low` and `high`, where given, are drawn as a band.
struct Curve {
  /// Entry in the legend.
  std::string name;
  /// [points] In data coordinates; `low` and `high` may be empty.
  std::vector<double> x, y, low, high;
  /// Whether values hold until the next x, as in a step function.
  bool steps = false;
  bool markers = false;
  /// x of short upright strokes on the curve, such as censored times.
  std::vector<double> marks;
  /// `low` and `high` as bars at the points instead of a band.
  bool bars = false;
  bool line = true;  ///< false: markers alone
  /// 0 .. 1: a colour from dark to light, for the number that distinguishes curves; NaN: one of
  /// the curve's own, by its place.
  double shade = NAN;
};
/// A plot with axes, ticks, grid and legend, fit for a paper; .png, .svg or .pdf by the ending.
struct Plot {
  std::string title, x_label, y_label;
  /// What the curves' names are values of, as "pump power"; or empty.
  std::string legend_title;
  std::vector<Curve> curves;
  /// Logarithmic axes; points that are not positive are left out.
  bool log_x = false, log_y = false;
  /// Whether to draw a thin line at y = 0.
  bool zero_line = false;
  /// Range of the y axis; equal: from the data.
  double y_low = 0, y_high = 0;
  /// Range of the x axis; equal: from the data.
  double x_low = 0, x_high = 0;
  /// Names of the values 0, 1, ... of y, the first at the top, instead of numbers.
  std::vector<std::string> y_names;
  int width = 900, height = 600;  ///< pixels (PNG: twice that)
};
/// Writes .png, .svg or .pdf by the ending. Throws InputError if the file cannot be written.
void draw_plot(const Plot& plot, const std::string& file, const FigureStyle& style = {});

/// Plots on one page, `columns` in a row, each as large as it says.
struct PlotPage {
  std::vector<Plot> plots;
  int columns = 1;
  /// Above all plots. Of several, plots' own titles name the panels.
  std::string title;
};
/// As draw_plot(). On paper, plots have as many columns as have room, at most `columns`.
void draw_plots(const PlotPage& page, const std::string& file, const FigureStyle& style = {});

/// Colours for numbers: from dark to light, or from blue over white at 0 to red.
enum class ColourScale { rising, diverging };

/// A map of cells x cells squares over [-extent, extent]^2, stored as in FlowField: row by row from
/// the lowest y, iy * cells + ix. Values that are NaN are cells without data, drawn in grey.
struct MapPanel {
  std::string title;
  int cells = 0;
  /// Half of the side that the panel covers, m.
  double extent = 0;
  std::vector<double> values;
  /// Beside the colour bar, as "mean speed (m/s)".
  std::string label;
  ColourScale scale = ColourScale::rising;
  /// Range of the colour bar; equal: from the data (diverging: symmetric about 0).
  double low = 0, high = 0;
  /// Values are then 0, 1, ...: the classes of these names, with a legend instead of a bar.
  std::vector<std::string> classes;
  /// Cells to mark, as filled or doubtful; may be empty.
  std::vector<bool> hatched;
  /// A vector a cell, NaN: none; may be empty.
  std::vector<double> arrow_x, arrow_y;
  /// Beside the arrow that shows the scale.
  std::string arrow_unit = "m/s";
  /// What grey cells are, for a legend of classes; empty: not named.
  std::string no_data;
  /// Drawn over the cells.
  struct Ring {
    double x = 0, y = 0, radius = 0;  ///< m
  };
  std::vector<Ring> rings;
};
/// Maps of one tank side by side, `columns` in a row; panels of a row with equal scales share a
/// colour bar.
struct Map {
  std::string title;
  double tank_radius = 0;  ///< m, drawn as a circle
  int columns = 1;
  std::vector<MapPanel> panels;
  /// Pixels, of one map (PNG: twice that).
  int panel_size = 340;
  /// Legend of hatched cells, drawn below the panels where there are any; empty: none.
  std::string hatching;
};
/// Writes .png, .svg or .pdf by the ending. Throws InputError if it cannot be written.
void draw_map(const Map& map, const std::string& file, const FigureStyle& style = {});

/// A parameter of a corner plot, in its own unit; NaN: not known, not drawn.
struct CornerAxis {
  std::string name, unit;        ///< unit may be empty
  bool log = false;              ///< logarithmic axes
  double low = NAN, high = NAN;  ///< bounds of the prior
  double estimate = NAN;         ///< of the data
  double from = NAN, to = NAN;   ///< its interval
  double truth = NAN;            ///< planted in synthetic data
};
/// Parameters in pairs: draws of two below the diagonal, histograms of one on it.
struct Corner {
  std::string title;
  std::vector<CornerAxis> axes;
  std::vector<std::vector<double>> draws;  ///< [draw][axis]
  std::string draws_name;                  ///< what the draws are, for the legend
};
/// Writes .png, .svg or .pdf by the ending. Throws InputError if it cannot be written.
void draw_corner(const Corner& corner, const std::string& file, const FigureStyle& style = {});

/// Copies standing over time, from a run's metrics.
Plot yield_plot(const StoredRun& run);

/// A figure of a report: plots or maps.
struct Figure {
  std::string name;     ///< of its files, without ending
  std::string caption;  ///< what a reader sees in it
  PlotPage page;
  Map map;           ///< drawn if there are no plots
  Corner corner;     ///< drawn if there are neither plots nor maps
  std::string n;     ///< "15 bodies in 3 recordings"; empty: the caption says it
  std::string band;  ///< what bands are and their level; empty: there are none
};
/// The caption file of a picture: "a.caption.txt" of "a.pdf".
std::string caption_file(const std::string& picture);
/// The content of a caption file: what is shown, n, the band's level, seed and command.
std::string caption_text(const Figure& figure, const ReportProvenance& provenance);
/// Draws figures in a directory that exists, each as .png, .svg and .pdf beside its .caption.txt.
/// Throws InputError if a file cannot be written.
void draw_figures(const std::vector<Figure>& figures, const ReportProvenance& provenance,
                  const std::string& dir, const FigureStyle& style = {});
/// "yield": mean copies over time with bootstrap bands; "survival_<k>": Kaplan and Meier's curves
/// of the time to the k-th copy, with their intervals and censored times; "mean_time": restricted
/// mean times over the axis' values, where there is one axis and its labels show numbers; curves
/// stand a little beside each other there. Bands are left out where there are more than six
/// settings. Of more than twelve, colours show the first axis of numbers, and
/// "copies_over_<axis>" shows the copies at the end over each such axis, a dot with its interval a
/// setting. Nothing for a study without finished runs.
std::vector<Figure> study_plots(const StudySummary& summary);

/// One a set of curves, named as its CSV: all sources laid over each other, beside each other by
/// AnalysisSource::panel, and of two sources the difference with its band below; the MSD also on
/// logarithmic axes ("msd_all_log"); "contact_times"; "transfer" of the smoothers.
std::vector<Figure> analysis_plots(const Analysis& analysis);
/// Mean velocities along x and y and their arrows, a row a source, then the difference of two
/// [paper, Fig. 7]. No panels where there are no maps.
Map velocity_maps(const Analysis& analysis);
/// "flow_<estimator>": mean with arrows, deviation, standard error, samples, filled cells hatched;
/// "normality": where it is rejected, as in Fig. 3 and for independent samples with a bound on
/// false discoveries; "errors" where the truth is known.
std::vector<Figure> flow_maps(const FlowReport& report);
/// The stages of an assembly, one after each join [paper, Figs. 9 and 11]: control states in the
/// modules, hops at their faces, the connector engaged last in blue, the rule above. The bytes of a
/// picture for `file`: .png, .svg or .pdf by the ending; throws InputError for another one.
std::string stages_picture(const Target& target, const std::vector<Stage>& stages,
                           const std::string& title, const std::string& file,
                           const FigureStyle& style = {});

/// What the caption file of that picture says.
std::string stages_caption(const Target& target, const std::vector<Stage>& stages);

/// How a search came along: the best point's mean so far and the median of each iteration's new
/// points, over evaluations [paper, Figs. 10 (a) and 12 (a)]. `selected`: the last record is that
/// of a final selection, whose new values of the best point stand alone.
Plot search_plot(const std::vector<IterationRecord>& history, bool selected,
                 const std::string& title, const std::string& y_label);
// Each of the following draws the figures of a result in a directory that exists, as .png, .svg and
// .pdf with a .caption.txt, and writes report.html, the report with all of them. They throw
// InputError if a file cannot be written.

/// "frame", the last one of a run, as .svg and .pdf, and "yield".
void draw_run(const StoredRun& run, const ReportDocument& report, const std::string& dir,
              const FigureStyle& style = {});
/// study_plots().
void draw_study(const StudySummary& summary, const ReportDocument& report, const std::string& dir,
                const FigureStyle& style = {});
/// `plot`, of search_plot(), as "fitness".
void draw_search(const Plot& plot, const ReportDocument& report, const std::string& dir,
                 const FigureStyle& style = {});
/// analysis_plots(), and velocity_maps() as "velocity_map".
void draw_analysis(const Analysis& analysis, const ReportDocument& report, const std::string& dir,
                   const FigureStyle& style = {});
/// flow_maps(), the last estimate's before the others.
void draw_flow(const FlowReport& flow, const ReportDocument& report, const std::string& dir,
               const FigureStyle& style = {});
/// "convergence" of the search [paper, Fig. 6a], "msd" recorded and simulated [Fig. 6b], "velocity"
/// maps [Fig. 7], "profiles" of the parameters, and "estimates" of simulated experiments as a
/// corner plot.
void draw_calibration(const CalibrationResult& calibration, const ReportDocument& report,
                      const std::string& dir, const FigureStyle& style = {});
/// "recovery", a plot a parameter: intervals over the planted values. Without report.html.
void draw_recovery(const std::vector<RecoveryRow>& rows, const ReportProvenance& provenance,
                   const std::string& dir, const FigureStyle& style = {});
/// "maps" of the baseline's residual, "laws" of the findings, "fit" before and after.
void draw_diagnosis(const Diagnosis& diagnosis, const ReportDocument& report,
                    const std::string& dir, const FigureStyle& style = {});
/// "power" against expected z, "outcomes" of every experiment, "errors" of what was fitted.
void draw_proof(const ProofFigures& proof, const ReportDocument& report, const std::string& dir,
                const FigureStyle& style = {});

}  // namespace lilytank
