#include "poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lilytank {
namespace {

std::string seconds(double t) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g s", t);
  return text;
}

}  // namespace

int frame_at(const Trajectory& trajectory, double time) {
  const auto& t = trajectory.time;
  const auto after = std::upper_bound(t.begin(), t.end(), time);
  return std::max(0, static_cast<int>(after - t.begin()) - 1);
}

void interpolate(const Trajectory& trajectory, double time, Snapshot& out) {
  const int frame = frame_at(trajectory, time);
  const int next = std::min(frame + 1, trajectory.frames() - 1);
  const auto bodies = static_cast<std::size_t>(trajectory.bodies);
  const auto f = static_cast<std::size_t>(frame), g = static_cast<std::size_t>(next);
  const double span = trajectory.time[g] - trajectory.time[f];
  const double w = span > 0 ? std::clamp((time - trajectory.time[f]) / span, 0.0, 1.0) : 0;
  out.time = time;
  out.frame = frame;
  out.modules = trajectory.modules;
  out.poses.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const std::size_t i = f * bodies + b, j = g * bodies + b;
    const double turn = std::remainder(double{trajectory.theta[j]} - trajectory.theta[i], 2 * kPi);
    out.poses[b] = {trajectory.x[i] + w * (double{trajectory.x[j]} - trajectory.x[i]),
                    trajectory.y[i] + w * (double{trajectory.y[j]} - trajectory.y[i]),
                    trajectory.theta[i] + w * turn};
  }
  // Trajectories keep one entry a body and frame; balls have empty markings.
  if (trajectory.markings.size() == trajectory.x.size()) {
    const auto first = trajectory.markings.begin() + static_cast<std::ptrdiff_t>(f * bodies);
    out.marks.assign(first, first + trajectory.modules);
  } else if (!trajectory.markings.empty()) {
    const auto m = static_cast<std::size_t>(trajectory.modules);
    const auto first = trajectory.markings.begin() + static_cast<std::ptrdiff_t>(f * m);
    out.marks.assign(first, first + trajectory.modules);
  } else {
    out.marks.clear();
  }
}

void check_time(const Trajectory& trajectory, double time) {
  if (trajectory.frames() == 0) {
    throw InputError(
        "this run stored no frames (output.trajectory = \"none\", or it has just "
        "begun): there is nothing to draw");
  }
  const double first = trajectory.time.front(), last = trajectory.time.back();
  // Times typed with a few digits may miss the stored end by their rounding.
  const double slack = 1e-6 * std::max(1.0, std::fabs(last));
  if (!(time >= first - slack && time <= last + slack)) {
    throw InputError("there is no picture at " + seconds(time) + ": the run was stored from " +
                     seconds(first) + " to " + seconds(last));
  }
}

int copies_in_frame(const Trajectory& trajectory, int frame, int target_size) {
  if (target_size <= 0 || trajectory.markings.empty()) return 0;
  const bool per_body = trajectory.markings.size() == trajectory.x.size();
  const auto stride = static_cast<std::size_t>(per_body ? trajectory.bodies : trajectory.modules);
  int complete = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(trajectory.modules); ++i) {
    complete += trajectory.markings[static_cast<std::size_t>(frame) * stride + i].complete != 0;
  }
  return complete / target_size;
}

}  // namespace lilytank
