// Interactive pages of stored results: one HTML file that plays runs in a browser. docs/view.md.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lilytank/experiment.hpp"
#include "lilytank/job_control.hpp"
#include "lilytank/run.hpp"
#include "lilytank/run_events.hpp"
#include "lilytank/statistics.hpp"
#include "lilytank/study.hpp"

namespace lilytank {

/// Grid of the stored poses: positions are rounded to 0.1 mm, headings to 0.1 degrees. The largest
/// errors are half of that.
inline constexpr double kViewPositionStep = 1e-4;       // m
inline constexpr double kViewHeadingStep = kPi / 1800;  // rad
/// Poses of one tank that a page keeps unless ViewOptions::rate is given: all of four hours of 15
/// modules at 5 frames/s. Of more, every second, third, ... frame is kept.
inline constexpr std::int64_t kViewPoses = 1'100'000;
/// Tanks on one page.
inline constexpr int kViewTanks = 4;

/// A tank over time, as one canvas of a page shows it.
struct ViewTank {
  std::string name, note;  ///< title and one line below it
  StoredRun run;           ///< model and poses; of a recording without markings
  std::vector<StoredEvent> events;
  std::vector<std::int64_t> ids;   ///< [bodies] names of the bodies; empty: their numbers
  std::vector<std::uint8_t> seen;  ///< [frames * bodies] 0: not seen by the camera; empty: all seen
  bool headings = true;            ///< whether headings are known
};

/// A mean yield curve with its band.
struct ViewYield {
  std::string name;
  CurveBand band;  ///< completed copies over time, s
};

/// All that a page shows.
struct ViewPage {
  std::string title, subtitle;
  std::vector<ViewTank> tanks;  ///< 1 .. kViewTanks
  std::vector<ViewYield> yields;
  std::string version, command;  ///< of the program, for the page's end
};

/// Settings of a page.
struct ViewOptions : JobControl {
  double rate = 0;  ///< frames per second of simulated time that are kept; 0: by kViewPoses
};

/// The page of runs, by their directories. Throws InputError.
ViewPage view_runs(const std::vector<std::string>& dirs);
/// The page of a study: simulates the named runs again (empty: the first run of each of the first
/// settings) and adds the mean yield of their settings. `study` must be the one whose results
/// `dir` holds. `rate`: stored frames per second; 0: the scenario's. Throws InputError, Stopped.
ViewPage view_study(const std::string& dir, const Study& study, const std::vector<std::string>& ids,
                    const ViewOptions& options);
/// The page of a diagnosis: a recording of Lilies of its experiment (the first that is held out, or
/// the one of that name) beside a simulation of the calibrated baseline and one with the omitted
/// effects. Both begin with the poses and velocities of the recording. Throws InputError, Stopped.
ViewPage view_diagnosis(const std::string& dir, const std::string& experiment,
                        const std::string& recording, const JobControl& control);

/// The page as HTML without outside references. All texts are escaped.
std::string view_html(const ViewPage& page, const ViewOptions& options);

}  // namespace lilytank
