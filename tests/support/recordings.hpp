// Recordings whose truth is known.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lilytank/math.hpp"
#include "lilytank/recording_io.hpp"
#include "support/temporary_directory.hpp"

namespace lilytank {

/// Bodies that go round the tank's centre on circles 4 cm apart at 0.2 m/s, turning as they go.
inline Recording circling(int bodies, int frames, double rate = 30, bool headings = true) {
  Recording r;
  r.name = "circling", r.rate = rate, r.frames = frames;
  for (int b = 0; b < bodies; ++b) {
    Track track;
    track.id = b;
    const double radius = 0.05 + 0.04 * b;
    for (int f = 0; f < frames; ++f) {
      const double angle = b + 0.2 / radius * f / rate;
      track.x.push_back(radius * std::cos(angle));
      track.y.push_back(radius * std::sin(angle));
      if (headings) track.theta.push_back(angle + 0.5);
    }
    r.tracks.push_back(std::move(track));
  }
  return r;
}

/// Every track of `read` lies on the one of the same place in `truth`, within `place` (m) and
/// `turn` (rad); whole turns of the heading do not count.
inline void expect_same_tracks(const Recording& truth, const Recording& read, double place = 2e-7,
                               double turn = 2e-6) {
  ASSERT_EQ(read.tracks.size(), truth.tracks.size());
  EXPECT_EQ(read.frames, truth.frames);
  EXPECT_NEAR(read.rate, truth.rate, 1e-3 * truth.rate);
  for (std::size_t t = 0; t < truth.tracks.size(); ++t) {
    const Track &a = truth.tracks[t], &b = read.tracks[t];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.first, b.first);
    ASSERT_EQ(a.x.size(), b.x.size());
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      ASSERT_EQ(std::isnan(a.x[i]), std::isnan(b.x[i])) << "track " << t << " frame " << i;
      if (std::isnan(a.x[i])) continue;
      ASSERT_NEAR(a.x[i], b.x[i], place);
      ASSERT_NEAR(a.y[i], b.y[i], place);
      if (b.theta.empty() || a.theta.empty()) continue;
      const double off = (a.theta[i] - b.theta[i]) / (2 * kPi);
      ASSERT_NEAR(off, std::round(off), turn);
    }
  }
}

/// The findings of one kind.
inline std::vector<Finding> of_kind(const CheckedRecording& checked, Check check) {
  std::vector<Finding> out;
  for (const Finding& finding : checked.findings) {
    if (finding.check == check) out.push_back(finding);
  }
  return out;
}

inline std::string all_texts(const CheckedRecording& checked) {
  std::string out;
  for (const Finding& finding : checked.findings) out += finding.text() + "\n";
  return out;
}

/// What reading a file of this content complains about; "" if it is read.
inline std::string complaint(const std::string& content, const RecordingOptions& options = {},
                             const std::string& name = "tracks.csv") {
  const TemporaryDirectory here;
  try {
    read_recording(here.write(name, content), options);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find(name));
  }
  return "";
}

}  // namespace lilytank
