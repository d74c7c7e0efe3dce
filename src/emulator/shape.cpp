// Properties of a recording that simulated ones reproduce.
#include <algorithm>
#include <cmath>

#include "lilytank/emulator.hpp"
#include "lilytank/smoothing.hpp"
#include "tracks/seen_bonds.hpp"

namespace lilytank {
namespace {

double missing_share(const Recording& recording) {
  double all = 0, missed = 0;
  for (const Track& track : recording.tracks) {
    all += static_cast<double>(track.x.size());
    missed += static_cast<double>(
        std::count_if(track.x.begin(), track.x.end(), [](double x) { return std::isnan(x); }));
  }
  return all > 0 ? missed / all : 0;
}

// Appends a body's place and motion at a frame, and returns true, if its track has them there.
bool add_body(const SmoothTrack& track, int frame, BodiesAt& at) {
  const int k = frame - track.first;
  if (k < 0 || k >= track.frames()) return false;
  const auto i = static_cast<std::size_t>(k);
  if (!track.seen[i] || std::isnan(track.vx[i])) return false;
  const bool turns = !track.theta.empty();
  if (turns && std::isnan(track.spin[i])) return false;
  at.pose.push_back({track.x[i], track.y[i], turns ? rotation(track.theta[i]) : Rot{}});
  at.twist.push_back({track.vx[i], track.vy[i], turns ? track.spin[i] : 0});
  return true;
}

// Appends the bonds of bodies seen at a frame that stand then; `ids`: of these bodies.
void add_bonds(const std::vector<SeenBond>& bonds, const std::vector<std::int64_t>& ids,
               double rate, BodiesAt& at) {
  const auto body = [&](std::int64_t id) {
    return static_cast<int>(std::find(ids.begin(), ids.end(), id) - ids.begin());
  };
  for (const SeenBond& bond : bonds) {
    if (bond.begin > at.frame || bond.end <= at.frame) continue;
    const int a = body(bond.a), b = body(bond.b);
    if (std::max(a, b) == static_cast<int>(ids.size())) continue;
    at.bonds.push_back(
        {std::min(a, b), std::max(a, b), (bond.end - bond.begin) / rate, bond.parted});
  }
}

}  // namespace

std::vector<int> seen_by_frame(const Recording& recording) {
  std::vector<int> seen(static_cast<std::size_t>(recording.frames), 0);
  for (const Track& track : recording.tracks) {
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      if (!std::isnan(track.x[k])) ++seen[static_cast<std::size_t>(track.first) + k];
    }
  }
  return seen;
}

RecordingShape shape_of(const Recording& recording, double side, double interval) {
  RecordingShape shape;
  shape.name = recording.name, shape.body = recording.body;
  shape.frames = recording.frames, shape.rate = recording.rate;
  shape.headings = recording.has_heading(), shape.latches = recording.latches;
  shape.logged = recording.logged;
  const std::vector<int> seen = seen_by_frame(recording);
  shape.bodies = seen.empty() ? 0 : *std::max_element(seen.begin(), seen.end());
  shape.missing = missing_share(recording);
  if (recording.body == BodyKind::lily && !shape.headings) return shape;
  const SmoothRecording smoothed =
      smooth(recording, {.method = SmoothingMethod::polynomial, .window = 0.3, .degree = 3});
  const int step = std::max(1, static_cast<int>(std::lround(interval * recording.rate)));
  const std::vector<SeenBond> bonds = recording.latches && recording.body == BodyKind::lily
                                          ? seen_bonds(recording, side)
                                          : std::vector<SeenBond>{};
  for (int frame = 0; frame < recording.frames; frame += step) {
    BodiesAt at{frame, {}, {}, {}};
    std::vector<std::int64_t> ids;
    for (const SmoothTrack& track : smoothed.tracks) {
      if (add_body(track, frame, at)) ids.push_back(track.id);
    }
    if (static_cast<int>(at.pose.size()) != shape.bodies) continue;
    add_bonds(bonds, ids, recording.rate, at);
    shape.starts.push_back(std::move(at));
  }
  // Simulated recordings start as the recording begins, or at random.
  if (!shape.starts.empty() && shape.starts.front().frame > recording.rate) shape.starts.clear();
  return shape;
}

}  // namespace lilytank
