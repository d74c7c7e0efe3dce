#include <algorithm>
#include <cmath>
#include <map>

#include "lilytank/recording_io.hpp"
#include "recording/formats.hpp"

namespace lilytank {
namespace {

/// Rows to tracks; frames in which a body was not seen hold NaN.
void fill_tracks(const Sightings& from, std::int64_t first_frame, Recording& out) {
  std::map<std::int64_t, std::vector<const Sighting*>> bodies;
  for (const Sighting& row : from.rows) bodies[row.id].push_back(&row);
  for (auto& [id, rows] : bodies) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->frame < b->frame; });
    Track track;
    track.id = id;
    track.first = static_cast<int>(rows.front()->frame - first_frame);
    const auto size = static_cast<std::size_t>(rows.back()->frame - rows.front()->frame + 1);
    const bool heading = !std::isnan(rows.front()->theta);
    track.x.assign(size, kUnknown), track.y.assign(size, kUnknown);
    if (heading) track.theta.assign(size, kUnknown);
    double turns = 0, last = rows.front()->theta;
    for (const Sighting* row : rows) {
      const auto i = static_cast<std::size_t>(row->frame - rows.front()->frame);
      track.x[i] = row->x, track.y[i] = row->y;
      if (!heading) continue;
      turns -= 2 * 3.14159265358979323846 * std::round((row->theta - last) / 6.283185307179586);
      last = row->theta;
      track.theta[i] = row->theta + turns;
    }
    out.frames = std::max(out.frames, track.last() + 1);
    out.tracks.push_back(std::move(track));
  }
}

}  // namespace

CheckedRecording check_recording(const std::string& file, const RecordingOptions& options) {
  const Sightings sightings = read_sightings({file}, options);
  if (sightings.rows.empty()) throw InputError({file, 0, 0}, "there is no sighting in it");
  CheckedRecording out;
  out.format = sightings.format, out.files = sightings.files;
  out.sightings = static_cast<std::int64_t>(sightings.rows.size());
  Recording& r = out.recording;
  r.name = options.name.empty() ? file : options.name;
  r.body = options.body, r.latches = options.latches, r.held_out = options.held_out;
  const auto by_frame = [](const Sighting& a, const Sighting& b) { return a.frame < b.frame; };
  const auto [first, last] =
      std::minmax_element(sightings.rows.begin(), sightings.rows.end(), by_frame);
  r.rate = options.rate > 0
               ? options.rate
               : static_cast<double>(last->frame - first->frame) / (last->time - first->time);
  r.start = first->time;
  fill_tracks(sightings, first->frame, r);
  return out;
}

Recording read_recording(const std::string& file, const RecordingOptions& options) {
  return check_recording(file, options).recording;
}

}  // namespace lilytank
