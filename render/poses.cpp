#include "poses.hpp"
#include "text/number.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

std::string seconds(double t) {
  return significant(t, 6) + " s";
}

void copy_poses(const Trajectory& trajectory, std::size_t frame, std::vector<BodyPose>& poses) {
  const auto bodies = static_cast<std::size_t>(trajectory.bodies);
  poses.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const std::size_t i = frame * bodies + b;
    poses[b] = {trajectory.x[i], trajectory.y[i], trajectory.theta[i]};
  }
}

// Simulated runs have one entry a body; one a module is accepted as well.
std::size_t marks_per_frame(const Trajectory& trajectory) {
  const bool all = trajectory.markings.size() == trajectory.x.size();
  return static_cast<std::size_t>(all ? trajectory.bodies : trajectory.modules);
}

void copy_marks(const Trajectory& trajectory, std::size_t frame, Snapshot& out) {
  out.marks.clear();
  if (trajectory.markings.empty()) return;
  const auto first = trajectory.markings.begin() +
                     static_cast<std::ptrdiff_t>(frame * marks_per_frame(trajectory));
  out.marks.assign(first, first + trajectory.modules);
}

// Where b is, seen from a.
Vec2 seen_from(const BodyPose& a, const BodyPose& b) {
  const double c = std::cos(a.theta), s = std::sin(a.theta), dx = b.x - a.x, dy = b.y - a.y;
  return {c * dx + s * dy, c * dy - s * dx};
}

// The face of module i that holds j now and in the next frame, or -1.
int held_face(double side, const Snapshot& s, std::size_t i, std::size_t j) {
  const Vec2 place = seen_from(s.poses[i], s.poses[j]);
  if (std::fabs(place.norm() - side) > 0.1 * side) return -1;
  const int face = static_cast<int>(std::lround(std::atan2(place.y(), place.x()) / (kPi / 2))) & 3;
  if ((s.marks[i].latched >> face & 1) == 0) return -1;
  return (place - seen_from(s.next[i], s.next[j])).norm() < 0.05 * side ? face : -1;
}

// Sets group[b] to the lowest body that moves with b, and lets go of faces whose neighbour will
// have left by the next frame: drawn in between, they would hold nothing.
void find_groups(double side, Snapshot& s) {
  s.group.resize(s.poses.size());
  for (std::size_t b = 0; b < s.group.size(); ++b) s.group[b] = static_cast<int>(b);
  s.held.assign(s.marks.size(), 0);
  for (std::size_t i = 0; i < s.marks.size(); ++i) {
    for (std::size_t j = i + 1; j < s.marks.size(); ++j) {
      if (s.marks[i].latched == 0 || s.marks[j].latched == 0) continue;
      const int face = held_face(side, s, i, j);
      const int other = face < 0 ? -1 : held_face(side, s, j, i);
      if (other < 0) continue;
      s.held[i] = static_cast<std::uint8_t>(s.held[i] | 1 << face);
      s.held[j] = static_cast<std::uint8_t>(s.held[j] | 1 << other);
      const int keep = std::min(s.group[i], s.group[j]), drop = std::max(s.group[i], s.group[j]);
      if (keep == drop) continue;
      for (int& group : s.group) group = group == drop ? keep : group;
    }
  }
  for (std::size_t i = 0; i < s.marks.size(); ++i) {
    s.marks[i].latched = s.marks[i].latched & s.held[i];
    s.marks[i].bonded = s.marks[i].bonded & s.held[i];
  }
}

// Moves the bodies of one group by the share w of the way to the next frame.
void move_group(std::size_t root, double w, Snapshot& s) {
  Vec2 from(0, 0), to(0, 0);
  double count = 0;
  const auto each = [&](const auto& act) {
    for (std::size_t b = root; b < s.poses.size(); ++b) {
      if (s.group[b] == static_cast<int>(root)) act(b);
    }
  };
  each([&](std::size_t b) {
    from += Vec2(s.poses[b].x, s.poses[b].y), to += Vec2(s.next[b].x, s.next[b].y), ++count;
  });
  from /= count, to /= count;
  const double turn = w * std::remainder(s.next[root].theta - s.poses[root].theta, 2 * kPi);
  const Rot r{std::cos(turn), std::sin(turn)};
  each([&](std::size_t b) {
    BodyPose& p = s.poses[b];
    const Vec2 at = from + w * (to - from) + rotate(r, Vec2(p.x, p.y) - from);
    p = {at.x(), at.y(), p.theta + turn};
  });
}

}  // namespace

int frame_at(const Trajectory& trajectory, double time) {
  const auto& t = trajectory.time;
  const auto after = std::upper_bound(t.begin(), t.end(), time);
  return std::max(0, static_cast<int>(after - t.begin()) - 1);
}

void interpolate(const Trajectory& trajectory, double side, double time, Snapshot& out) {
  const int frame = frame_at(trajectory, time);
  const int next = std::min(frame + 1, trajectory.frames() - 1);
  const auto f = static_cast<std::size_t>(frame), g = static_cast<std::size_t>(next);
  const double span = trajectory.time[g] - trajectory.time[f];
  const double w = span > 0 ? std::clamp((time - trajectory.time[f]) / span, 0.0, 1.0) : 0;
  out.time = time;
  out.modules = trajectory.modules;
  out.frame = frame;
  copy_marks(trajectory, f, out);
  copy_poses(trajectory, f, out.poses);
  if (w <= 0) return;
  copy_poses(trajectory, g, out.next);
  find_groups(side, out);
  const std::size_t bodies = out.poses.size();
  for (std::size_t root = 0; root < bodies; ++root) {
    if (out.group[root] == static_cast<int>(root)) move_group(root, w, out);
  }
}

void check_time(const Trajectory& trajectory, double time) {
  if (trajectory.frames() == 0) {
    throw InputError(
        "this run stored no frames (output.trajectory = \"none\", or it has just "
        "started): there is nothing to draw");
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
  const std::size_t stride = marks_per_frame(trajectory);
  int complete = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(trajectory.modules); ++i) {
    complete += trajectory.markings[static_cast<std::size_t>(frame) * stride + i].complete != 0;
  }
  return complete / target_size;
}

}  // namespace lilytank
