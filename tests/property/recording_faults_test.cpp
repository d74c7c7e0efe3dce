// Random tracks with random faults: every fault is found where it was made, and nothing else is.
//
// Bodies wander as in the stirred tank: velocities of 0.2 m/s that change over a second, tracking
// noise of 0.3 mm and 0.01 rad, 30 frames per second. Faults are at least 30 frames apart within a
// body, and larger than what the checks promise to see (docs/recordings.md).
#include <gtest/gtest.h>

#include <set>

#include "lilytank/random.hpp"
#include "support/recordings.hpp"

namespace lilytank {
namespace {

constexpr int kBodies = 8, kRecorded = 1500;
constexpr double kRate = 30;

class Scene {
 public:
  explicit Scene(std::uint64_t seed) : seed_(seed) {
    r_.rate = kRate, r_.frames = kRecorded;
    for (int b = 0; b < kBodies; ++b) wander(b);
  }

  double any() { return uniform({seed_, Stream::camera, next_++, 1000, 0}); }
  int below(int bound) { return static_cast<int>(any() * bound); }
  Recording& recording() { return r_; }
  Track& track(int b) { return r_.tracks[static_cast<std::size_t>(b)]; }

 private:
  // An orbit of its own radius, with slow random changes of speed, so that bodies stay apart.
  void wander(int b) {
    Track t;
    t.id = b;
    const double radius = 0.06 + 0.03 * b;
    double angle = 2 * kPi * any(), push = 0, theta = 6 * any(), spin = 0;
    for (int f = 0; f < kRecorded; ++f) {
      const auto kick = normal_pair({seed_, Stream::camera, f, static_cast<std::uint32_t>(b), 1});
      const auto noise = normal_pair({seed_, Stream::camera, f, static_cast<std::uint32_t>(b), 2});
      const auto turn = normal_pair({seed_, Stream::camera, f, static_cast<std::uint32_t>(b), 3});
      push += -push / kRate + 0.02 * kick[0], spin += -spin / kRate + 0.3 * kick[1];
      angle += (0.2 + push) / radius / kRate, theta += spin / kRate;
      t.x.push_back(radius * std::cos(angle) + 0.0003 * noise[0]);
      t.y.push_back(radius * std::sin(angle) + 0.0003 * noise[1]);
      t.theta.push_back(theta + 0.01 * turn[0]);
    }
    r_.tracks.push_back(std::move(t));
  }

  std::uint64_t seed_;
  std::int64_t next_ = 0;
  Recording r_;
};

using Places = std::set<std::tuple<Check, std::int64_t, std::int64_t>>;

std::size_t at(int frame) {
  return static_cast<std::size_t>(frame);
}

/// Makes a fault at a frame; notes what should be found. Faults are made in the order of time, as a
/// swap takes everything later along.
void make_fault(Scene& scene, int frame, Places& expected) {
  const int b = scene.below(kBodies), c = (b + 1 + scene.below(kBodies - 1)) % kBodies;
  Track& t = scene.track(b);
  const int kind = scene.below(5);
  if (kind == 0) {
    const int length = 1 + scene.below(20);
    for (int f = frame; f < frame + length; ++f) t.x[at(f)] = NAN;
    expected.insert({Check::gap, frame, b});
  } else if (kind == 1) {
    t.x[at(frame)] += 0.03 + 0.02 * scene.any();
    expected.insert({Check::spike, frame, b});
  } else if (kind == 2) {
    // Turned by 30 to 90 degrees about the centre, so that bodies stay in the tank.
    const double angle = kPi / 6 + scene.any() * kPi / 3;
    for (int f = frame; f < kRecorded; ++f) {
      const double x = t.x[at(f)], y = t.y[at(f)];
      t.x[at(f)] = std::cos(angle) * x - std::sin(angle) * y;
      t.y[at(f)] = std::sin(angle) * x + std::cos(angle) * y;
    }
    expected.insert({Check::jump, frame, b});
  } else if (kind == 3) {
    Track& u = scene.track(c);
    const double apart =
        std::hypot(t.x[at(frame)] - u.x[at(frame)], t.y[at(frame)] - u.y[at(frame)]);
    if (!(apart > 0.025)) return;
    for (int f = frame; f < kRecorded; ++f) {
      std::swap(t.x[at(f)], u.x[at(f)]);
      std::swap(t.y[at(f)], u.y[at(f)]);
      std::swap(t.theta[at(f)], u.theta[at(f)]);
    }
    expected.insert({Check::swap, frame, b});
    expected.insert({Check::swap, frame, c});
  } else {
    for (int f = frame; f < kRecorded; ++f) t.theta[at(f)] += kPi / 2;
    expected.insert({Check::heading, frame, b});
  }
}

TEST(RecordingFaults, eachIsFoundWhereItIsAndNothingElse) {
  int faults = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene(seed);
    Places expected;
    for (int frame = 40; frame < kRecorded - 60; frame += 31 + scene.below(30)) {
      make_fault(scene, frame, expected);
    }
    const TemporaryDirectory here;
    write_recording(scene.recording(), here.path("tracks.csv"));
    RecordingOptions options;
    options.in_tank = false;  // a spike may lead out of it
    const CheckedRecording c = check_recording(here.path("tracks.csv"), options);
    Places found;
    for (const Finding& f : c.findings) found.insert({f.check, f.frame, f.id});
    for (const auto& [check, frame, id] : expected) {
      EXPECT_EQ(found.count({check, frame, id}), 1u)
          << check_word(check) << " at frame " << frame << " of " << id << " was not found";
    }
    for (const Finding& f : c.findings) {
      EXPECT_EQ(expected.count({f.check, f.frame, f.id}), 1u) << f.text();
    }
    faults += static_cast<int>(expected.size());
    // Nothing was made up: every sighting of a track is one of the file, under the same id.
    for (const Track& t : c.recording.tracks) {
      const Track& truth = scene.track(static_cast<int>(t.id));
      for (std::size_t i = 0; i < t.x.size(); ++i) {
        if (std::isnan(t.x[i])) continue;
        ASSERT_NEAR(t.x[i], truth.x[i + at(t.first)], 1e-7);
        ASSERT_NEAR(t.y[i], truth.y[i + at(t.first)], 1e-7);
      }
    }
  }
  EXPECT_GT(faults, 500);
}

}  // namespace
}  // namespace lilytank
