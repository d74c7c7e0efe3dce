#include "lilytank/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "flow/grid.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

// Calls with each sighting of a body, its position and the seconds that it stands for.
template <class Use>
void for_sightings(std::span<const Recording> recordings, BodyKind body, Use use) {
  for (const Recording& one : recordings) {
    if (one.body != body) continue;
    for (const Track& track : one.tracks) {
      for (std::size_t i = 0; i < track.x.size(); ++i) {
        if (!std::isnan(track.x[i])) use(track.x[i], track.y[i], 1 / one.rate);
      }
    }
  }
}

// Of bodies of a kind. Their number is a mean over the recordings: trackers that lose a body give
// it another identity, so identities are no count.
struct TimeSeen {
  double minutes = 0;
  double bodies = 1;
};

TimeSeen time_seen(std::span<const Recording> recordings, BodyKind body) {
  double seen = 0, recorded = 0;  // s
  for_sightings(recordings, body, [&](double, double, double s) { seen += s; });
  for (const Recording& one : recordings) recorded += one.body == body ? one.frames / one.rate : 0;
  return {seen / 60, recorded > 0 ? std::max(1.0, std::round(seen / recorded)) : 1};
}

// Seconds that Lilies were in each cell.
std::vector<double> seconds_by_cell(const FlowGrid& grid, std::span<const Recording> recordings) {
  std::vector<double> out(static_cast<std::size_t>(grid.size()), 0);
  for_sightings(recordings, BodyKind::lily, [&](double x, double y, double s) {
    if (const int cell = grid.cell_at(x, y); cell >= 0) out[static_cast<std::size_t>(cell)] += s;
  });
  return out;
}

// Mean over the cells within two of each: what a cell will get if the balls go on as they did.
std::vector<double> smoothed(const FlowGrid& grid, const std::vector<double>& of) {
  constexpr int kAround = 2;
  std::vector<double> out(of.size(), 0);
  for (int iy = 0; iy < grid.cells; ++iy) {
    for (int ix = 0; ix < grid.cells; ++ix) {
      int count = 0;
      double sum = 0;
      for (int y = std::max(0, iy - kAround); y <= std::min(grid.cells - 1, iy + kAround); ++y) {
        for (int x = std::max(0, ix - kAround); x <= std::min(grid.cells - 1, ix + kAround); ++x) {
          sum += of[static_cast<std::size_t>(y * grid.cells + x)], ++count;
        }
      }
      out[static_cast<std::size_t>(iy * grid.cells + ix)] = sum / count;
    }
  }
  return out;
}

// Factor by which the balls' time must grow until the Lilies spend `share` of theirs in measured
// cells. `samples`: in each cell. A cell is measured with the fewest samples that one is measured
// with now; what it will get is Poisson, so for nine in ten more are needed on average.
double factor_for_share(const FlowEstimate& flow, const std::vector<double>& samples,
                        const std::vector<double>& lilies, double share) {
  constexpr double kNineInTen = 1.28;  // normal quantile
  double least = HUGE_VAL, all = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (flow.cell[i].measured) least = std::min(least, samples[i]);
    all += lilies[i];
  }
  const double expected_least = least + kNineInTen * std::sqrt(least);
  const std::vector<double> expected = smoothed({flow.cells, flow.extent}, samples);
  std::vector<std::pair<double, double>> needed;  // factor, Lilies' seconds
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (lilies[i] <= 0) continue;
    const double factor =
        flow.cell[i].measured ? 1 : expected_least / std::max(expected[i], 1e-9 * least);
    needed.emplace_back(std::max(1.0, factor), lilies[i]);
  }
  std::sort(needed.begin(), needed.end());
  double sum = 0;
  for (const auto& [factor, seconds] : needed) {
    sum += seconds;
    if (sum >= share * all) return factor;
  }
  return 1;
}

std::string percent(double share) {
  return significant(100 * share, 2) + " %";
}

// Sums over the Lilies' time.
void measure_flow(const FlowEstimate& flow, const std::vector<double>& where, Coverage& out) {
  double all = 0, measured = 0, error = 0, speed = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const FlowCell& cell = flow.cell[i];
    all += where[i], measured += cell.measured ? where[i] : 0;
    const FlowSample &e = cell.error, &u = cell.flow;
    if (!std::isnan(e.mu_x)) error += where[i] * (e.mu_x * e.mu_x + e.mu_y * e.mu_y) / 2;
    speed += where[i] * (u.mu_x * u.mu_x + u.mu_y * u.mu_y);
  }
  out.measured = measured / all;
  out.flow_error = std::sqrt(error / all), out.flow_speed = std::sqrt(speed / all);
  if (flow.noise) out.gust_error = flow.noise->gusts_error / flow.noise->gusts;
}

// What the flow map falls short of, and by what factor the balls' time must grow.
void check_flow(const FlowEstimate& flow, const std::vector<double>& where, double balls,
                Coverage& out) {
  const double minutes = out.ball_minutes / balls;
  const auto add = [&](Requirement of, const std::string& what, double value, const char* bound,
                       double needed, double factor) {
    out.flow.push_back({of,
                        what + ": " + percent(value) + " (" + bound + " " + percent(needed) + ")",
                        (factor - 1) * minutes, BodyKind::ball, static_cast<int>(balls)});
  };
  if (out.measured < kLeastMeasured) {
    std::vector<double> samples;
    for (const FlowCell& cell : flow.cell) samples.push_back(cell.samples);
    add(Requirement::measured_cells,
        "fraction of the Lilies' time in cells where the balls measured the flow", out.measured,
        "at least", kLeastMeasured, factor_for_share(flow, samples, where, kLeastMeasured));
  }
  // Errors fall with the root of the time.
  const auto limit = [&](Requirement of, const std::string& what, double relative, double largest) {
    if (relative > largest)
      add(of, what, relative, "at most", largest, std::pow(relative / largest, 2));
  };
  limit(Requirement::mean_flow,
        "standard error of the mean flow over its speed, where the Lilies went",
        out.flow_error / out.flow_speed, kLargestFlowError);
  limit(Requirement::gusts, "relative standard error of the gusts' standard deviation",
        out.gust_error, kLargestGustError);
}

}  // namespace

std::string name_of(Requirement requirement) {
  switch (requirement) {
    case Requirement::lily_time:
      return "time of the Lilies";
    case Requirement::measured_cells:
      return "measured cells";
    case Requirement::mean_flow:
      return "mean flow";
    default:
      return "gusts";
  }
}

std::string Shortfall::bodies() const {
  return std::to_string(count) + (body == BodyKind::ball ? " balls" : " Lilies");
}

std::string to_record(const std::vector<Shortfall>& shortfalls) {
  std::map<std::string, double> minutes;  // the most of each kind
  for (const Shortfall& s : shortfalls)
    minutes[s.bodies()] = std::max(minutes[s.bodies()], s.minutes);
  return joined(minutes, " and ", [](const auto& one) {
    return significant(std::max(one.second, 0.1), 2) + " min more of " + one.first;
  });
}

Coverage coverage_of(const FlowEstimate* flow, std::span<const Recording> balls,
                     std::span<const Recording> lilies) {
  Coverage out;
  const TimeSeen ball = time_seen(balls, BodyKind::ball);
  const TimeSeen lily = time_seen(lilies, BodyKind::lily);
  out.ball_minutes = ball.minutes, out.lily_minutes = lily.minutes;
  if (lily.minutes < kLeastLilyMinutes) {
    out.lilies.push_back(
        {Requirement::lily_time,
         "time of the Lilies, summed over modules: " + significant(lily.minutes, 2) +
             " min (at least " + significant(kLeastLilyMinutes, 2) + " min)",
         (kLeastLilyMinutes - lily.minutes) / lily.bodies, BodyKind::lily,
         static_cast<int>(lily.bodies)});
  }
  out.flow_error = out.flow_speed = out.gust_error = NAN;
  if (flow == nullptr || out.lily_minutes <= 0) return out;
  const std::vector<double> where = seconds_by_cell({flow->cells, flow->extent}, lilies);
  measure_flow(*flow, where, out);
  check_flow(*flow, where, ball.bodies, out);
  return out;
}

std::vector<Shortfall> shortfalls_of(const FlowEstimate* flow, std::span<const Recording> balls,
                                     std::span<const Recording> lilies) {
  const Coverage coverage = coverage_of(flow, balls, lilies);
  std::vector<Shortfall> out = coverage.flow;
  out.insert(out.end(), coverage.lilies.begin(), coverage.lilies.end());
  return out;
}

}  // namespace lilytank
