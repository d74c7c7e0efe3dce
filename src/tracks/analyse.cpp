#include <algorithm>
#include <cmath>

#include "lilytank/analysis.hpp"
#include "smoothing/motion_model.hpp"
#include "statistics/undefined.hpp"
#include "text/number.hpp"
#include "tracks/source_summary.hpp"

namespace lilytank {
namespace {

using Values = std::vector<double>;

// Every frame up to 2 s, then coarser: an oscillation of some seconds still shows.
Values choose_lags(double rate, double longest) {
  Values lags;
  for (double frame = 1; frame / rate <= longest * (1 + 1e-9);) {
    lags.push_back(frame / rate);
    const double step = frame < 2 * rate ? 1 : std::max(0.1 * rate, 0.005 * frame);
    frame += std::max(1.0, std::round(step));
  }
  return lags;
}

// 1, 2, 3, 5 times a power of ten, at least `value`.
double round_above(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 3.0, 5.0}) {
    if (step * power >= value) return step * power;
  }
  return 10 * power;
}

class Analyser {
 public:
  Analyser(const std::vector<AnalysisSource>& sources, const AnalysisOptions& options) {
    out_.options = options;
    double rate = HUGE_VAL, longest = 0;
    for (const AnalysisSource& source : sources) {
      check(source, rate, longest);
      if (!options.msd_only) check_window(source, options.smoothing);
      out_.tank_radius = std::max(out_.tank_radius, source.tank_radius);
      sources_.push_back(prepared(source));
    }
    lags_ = choose_lags(rate, std::min(options.longest_lag, longest));
  }

  Analysis run() {
    const std::vector<BodySums> msd = displacements();
    const std::vector<BodySums> turns = this->turns();
    if (!out_.options.msd_only) velocities(), places(), neighbours();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      out_.sources.push_back(summarise_source(sources_[i], msd[i], turns[i], lags_, out_.options));
    }
    if (sources_.size() == 2) {
      out_.compared = true;
      out_.comparison = compare_sources(out_);
    }
    return std::move(out_);
  }

 private:
  static void check(const AnalysisSource& source, double& rate, double& longest) {
    double own = 0;
    for (const Recording& r : source.recordings) {
      for (const Track& t : r.tracks) {
        own = std::max(own, static_cast<double>(t.x.size() - 1) / r.rate);
      }
      rate = std::min(rate, r.rate);
    }
    if (!(own > 0)) throw InputError("'" + source.name + "' has no track of two frames or more");
    longest = std::max(longest, own);
  }

  // A polynomial over more frames than any track has is a fit to whole tracks, not a smoother.
  static void check_window(const AnalysisSource& source, const SmoothingOptions& smoothing) {
    if (smoothing.method != SmoothingMethod::polynomial) return;
    for (const Recording& r : source.recordings) {
      std::size_t most = 0;
      for (const Track& t : r.tracks) most = std::max(most, t.x.size());
      const double longest = static_cast<double>(most) / r.rate;
      const double window = used_window(smoothing, 1 / r.rate);
      if (most < 2 || window <= longest * (1 + 1e-9)) continue;
      throw InputError("'" + source.name + "': a smoothing window of " +
                       shortest(smoothing.window) + " s takes " +
                       std::to_string(std::llround(window * r.rate)) +
                       " frames, and its longest track has " + std::to_string(most));
    }
  }

  SmoothSource prepared(const AnalysisSource& source) const {
    SmoothSource s{&source, {}, {}};
    if (out_.options.msd_only) return s;
    SmoothingOptions smoothing = out_.options.smoothing;
    // Below what stored positions resolve, but not nothing: filters divide by it.
    if (source.exact) smoothing.noise = 1e-7, smoothing.heading_noise = 1e-6;
    for (const Recording& recording : source.recordings) {
      s.recordings.push_back(smooth(recording, smoothing));
      if (recording.body == BodyKind::point) continue;
      // Squares without headings are taken for discs as wide as they are.
      const bool squares = recording.body == BodyKind::lily && recording.has_heading();
      const double gap = out_.options.touching;
      s.contacts.push_back(
          find_contacts(s.recordings.back(), {source.body_size, squares, gap, 2 * gap}));
    }
    return s;
  }

  // A coordinate of a curve.
  struct Axis {
    std::string name, unit;
    Values values = {};
  };

  // Adds a set of curves, one a source that has bodies in it.
  void add(const std::string& name, const std::string& title, const Axis& x, const Axis& y,
           const std::vector<BodySums>& sums, bool relative = false) {
    AnalysisCurves set{name, title, x.name, x.unit, y.name, y.unit, x.values, {}, {}};
    Bootstrap bootstrap = out_.options.bootstrap;
    bootstrap.relative = relative;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (sums[i].bodies() == 0) continue;
      AnalysisCurves::Of of{static_cast<int>(i), ratio_curve(sums[i], bootstrap), sums[i].tracks,
                            Values(set.x.size(), 0.0)};
      for (std::size_t k = 0; k < sums[i].weight.size(); ++k) {
        of.samples[k % set.x.size()] += sums[i].weight[k];
      }
      set.sources.push_back(std::move(of));
    }
    if (set.sources.empty()) return;
    if (sums.size() == 2 && set.sources.size() == 2) {
      set.difference = ratio_difference(sums[0], sums[1], bootstrap);
    }
    out_.curves.push_back(std::move(set));
  }

  // Sums of every source's recordings (raw), or smoothed recordings.
  template <class SumsOf>
  std::vector<BodySums> of_raw(const SumsOf& sums_of) const {
    std::vector<BodySums> all;
    for (const SmoothSource& s : sources_) all.push_back(together(s.source->recordings, sums_of));
    return all;
  }
  template <class SumsOf>
  std::vector<BodySums> of_smooth(const SumsOf& sums_of) const {
    std::vector<BodySums> all;
    for (const SmoothSource& s : sources_) all.push_back(together(s.recordings, sums_of));
    return all;
  }

  std::vector<BodySums> displacements() {
    const auto from = [&](Origins origins) {
      return of_raw([&](const Recording& r) { return squared_displacements(r, lags_, origins); });
    };
    const Axis lag{"lag", "s", lags_}, msd{"msd", "m^2"};
    add("msd_first", "mean squared displacement, from the begin", lag, msd, from(Origins::first));
    const std::vector<BodySums> all = from(Origins::all);
    add("msd_all", "mean squared displacement, all origins", lag, msd, all);
    return all;
  }

  std::vector<BodySums> turns() {
    auto all = of_raw([&](const Recording& r) { return squared_turns(r, lags_, Origins::all); });
    add("turn_msd", "mean squared turn, all origins", {"lag", "s", lags_}, {"msd", "rad^2"}, all);
    return all;
  }

  void velocities() {
    Axis lag{"lag", "s", lags_}, correlation{"correlation", "1"};
    lag.values.insert(lag.values.begin(), 0.0);
    const Values& lags = lag.values;
    add("velocity_acf", "autocorrelation of velocity", lag, correlation,
        of_smooth([&](const SmoothRecording& r) { return velocity_products(r, lags); }), true);
    add("spin_acf", "autocorrelation of spin", lag, correlation,
        of_smooth([&](const SmoothRecording& r) { return spin_products(r, lags); }), true);
    const double fastest = most(Quantity::speed);
    const Bins signed_speeds{-fastest, fastest, 60};
    spread("speed", "speed", Quantity::speed, {0, fastest, 50}, "m/s");
    spread("velocity_x", "velocity along x", Quantity::velocity_x, signed_speeds, "m/s");
    spread("velocity_y", "velocity along y", Quantity::velocity_y, signed_speeds, "m/s");
    spread("velocity_out", "velocity away from the centre", Quantity::velocity_out, signed_speeds,
           "m/s");
    spread("velocity_around", "velocity about the centre", Quantity::velocity_around, signed_speeds,
           "m/s");
    const double quickest = most(Quantity::spin);
    if (quickest > 0) spread("spin", "spin", Quantity::spin, {-quickest, quickest, 60}, "rad/s");
  }
  // What nearly all samples of all sources stay below.
  double most(Quantity quantity) const {
    double most = 0;
    for (const SmoothSource& s : sources_) {
      for (const SmoothRecording& r : s.recordings) {
        most = std::max(most, quantile_of_size(r, quantity, 0.999));
      }
    }
    return most > 0 ? round_above(most) : quantity == Quantity::spin ? 0 : 1;
  }
  void spread(const std::string& name, const std::string& what, Quantity quantity, const Bins& bins,
              const std::string& unit) {
    add(name, "distribution of the " + what, {what, unit, middles(bins)},
        {"density", unit == "m/s" ? "s/m" : "s/rad"},
        of_smooth([&](const SmoothRecording& r) { return distribution(r, quantity, bins); }));
  }
  static Values middles(const Bins& bins) {
    Values x;
    for (int i = 0; i < bins.count; ++i) x.push_back(bins.middle(i));
    return x;
  }

  void places() {
    const Bins rings{0, out_.tank_radius, 30};
    std::vector<BodySums> density;
    for (const SmoothSource& s : sources_) {
      density.push_back(together(s.recordings, [&](const SmoothRecording& r) {
        return radial_density(r, s.source->tank_radius, rings);
      }));
      out_.maps.push_back(velocity_map(s.recordings, out_.options.map_cells, out_.tank_radius));
    }
    add("density", "density over an even spread", {"distance from the centre", "m", middles(rings)},
        {"relative density", "1"}, density);
  }

  void neighbours() {
    const Bins bins{0, 0.2, 100};
    add("pair_correlation", "pair correlation", {"distance of centres", "m", middles(bins)},
        {"g", "1"}, of_smooth([&](const SmoothRecording& r) { return pair_correlation(r, bins); }));
    add("nearest", "distribution of the distance to the nearest neighbour",
        {"distance", "m", middles(bins)}, {"density", "1/m"},
        of_smooth([&](const SmoothRecording& r) { return nearest_neighbours(r, bins); }));
  }

  Analysis out_;
  std::vector<SmoothSource> sources_;
  Values lags_;
};

}  // namespace

const AnalysisCurves* Analysis::find(const std::string& name) const {
  for (const AnalysisCurves& c : curves) {
    if (c.name == name) return &c;
  }
  return nullptr;
}

Analysis analyse(const std::vector<AnalysisSource>& sources, const AnalysisOptions& options) {
  return Analyser(sources, options).run();
}

}  // namespace lilytank
