#include "lilytank/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lilytank/math.hpp"
#include "lilytank/random.hpp"
#include "math/bulk_random.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kTurn = 2 * kPi;
/// What a draw of Stream::camera is for, in Draw::index.
enum : std::uint32_t { kNoise = 0, kMissed = 2, kDropped = 3, kSwapped = 4 };
/// The noise of one body: numbers of a bulk draw.
enum { kNoiseX = 0, kNoiseY = 1, kNoiseHeading = 2, kNoiseCount = 3 };

/// The trajectory at any time.
class Interpolator {
 public:
  explicit Interpolator(const Trajectory& from) : from_(&from) {}

  /// Goes to a time at or after the last one.
  void go_to(double time) {
    const auto& t = from_->time;
    while (at_ + 2 < t.size() && t[at_ + 1] <= time) ++at_;
    const double width = t[at_ + 1] - t[at_];
    share_ = std::clamp((time - t[at_]) / width, 0.0, 1.0);
  }
  double x(int body) const { return between(from_->x, body); }
  double y(int body) const { return between(from_->y, body); }
  /// The shorter way round.
  double theta(int body) const {
    const double a = value(from_->theta, at_, body), b = value(from_->theta, at_ + 1, body);
    const double turn = b - a - kTurn * std::floor((b - a) / kTurn + 0.5);
    return a + share_ * turn;
  }

 private:
  double value(const std::vector<float>& of, std::size_t frame, int body) const {
    return of[frame * static_cast<std::size_t>(from_->bodies) + static_cast<std::size_t>(body)];
  }
  double between(const std::vector<float>& of, int body) const {
    const double a = value(of, at_, body);
    return a + share_ * (value(of, at_ + 1, body) - a);
  }
  const Trajectory* from_;
  std::size_t at_ = 0;
  double share_ = 0;
};

class Filming {
 public:
  Filming(const Trajectory& trajectory, const Camera& camera, BodyKind body)
      : scene_(trajectory), camera_(camera) {
    const bool balls = body == BodyKind::ball;
    first_ = balls ? trajectory.modules : 0;
    count_ = balls ? trajectory.bodies - trajectory.modules : trajectory.modules;
    out_.body = body, out_.rate = camera.rate;
    if (count_ <= 0 || trajectory.frames() < 2) {
      throw InputError(count_ <= 0 ? "there is no such body to film"
                                   : "a film needs a trajectory of two frames or more");
    }
    out_.start = trajectory.time.front() + camera.latency;
    // A little more than rounding, so that a last frame at the very end counts.
    const double length = trajectory.time.back() - trajectory.time.front();
    out_.frames = 1 + static_cast<int>(std::floor(length * camera.rate + 1e-6));
    headings_ = camera.headings && !balls;
    tilt_ = rotation(camera.tilt), lean_ = rotation(camera.tilt_direction);
    shown_.resize(count_);
    std::iota(shown_.begin(), shown_.end(), 0);
  }

  Recording film() {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const auto frames = static_cast<std::size_t>(out_.frames);
    out_.tracks.resize(count_);
    for (std::size_t b = 0; b < out_.tracks.size(); ++b) {
      Track& track = out_.tracks[b];
      track.id = static_cast<std::int64_t>(b);
      track.x.assign(frames, none), track.y.assign(frames, none);
      if (headings_) track.theta.assign(frames, none);
    }
    for (int f = 0; f < out_.frames; ++f) frame(f);
    for (Track& track : out_.tracks) trim(track);
    std::erase_if(out_.tracks, [](const Track& track) { return track.x.empty(); });
    return std::move(out_);
  }

 private:
  Draw draw(int frame, int body, std::uint32_t index) const {
    return {camera_.seed, Stream::camera, frame, static_cast<std::uint32_t>(body), index};
  }

  void frame(int f) {
    scene_.go_to(out_.time(f) - camera_.latency);
    if (camera_.swaps > 0) exchange(f);
    if (happens(camera_.dropped, draw(f, 0, kDropped))) return;
    for (int id = 0; id < count_; ++id) {
      if (id % kBulkBodies == 0) bulk_normals(draw(f, id, kNoise), kNoiseCount, noise_);
      if (happens(camera_.missed, draw(f, id, kMissed))) continue;
      see(f, id);
    }
  }

  static bool happens(double chance, const Draw& draw) {
    return chance > 0 && uniform(draw) < chance;
  }

  double noise(int id, int which) const {
    return static_cast<double>(noise_[which * kBulkBodies + id % kBulkBodies]);
  }

  // Where a place in the tank is seen: through a camera that leans, then its lens.
  Vec2 image_of(const Vec2& place) const {
    const Vec2 seen = unrotate(lean_, place);
    const double nearer = 1 - seen.x() * tilt_.s / camera_.height;
    const Vec2 image = rotate(lean_, {seen.x() * tilt_.c / nearer, seen.y() / nearer});
    return image * (1 + camera_.lens * image.squaredNorm());
  }

  void see(int f, int id) {
    Track& track = out_.tracks[id];
    const int body = first_ + shown_[id];
    const Vec2 place = image_of({scene_.x(body), scene_.y(body)});
    track.x[f] = place.x() + camera_.position_noise * noise(id, kNoiseX);
    track.y[f] = place.y() + camera_.position_noise * noise(id, kNoiseY);
    if (!headings_) return;
    const double seen = scene_.theta(body) + camera_.heading_noise * noise(id, kNoiseHeading);
    // Continued from the last one.
    std::size_t before = f;
    while (before > 0 && std::isnan(track.theta[before - 1])) --before;
    const double last = before > 0 ? track.theta[before - 1] : seen;
    track.theta[f] = seen - kTurn * std::floor((seen - last) / kTurn + 0.5);
  }

  // Every pair that is near takes its chance in every frame; from then on each has the other's id.
  void exchange(int f) {
    const double chance = 1 - exp_portable(-camera_.swaps / camera_.rate);
    const double near = camera_.swap_distance * camera_.swap_distance;
    for (int a = 0; a < count_; ++a) {
      for (int b = a + 1; b < count_; ++b) {
        int& first = shown_[a];
        int& second = shown_[b];
        const double dx = scene_.x(first_ + first) - scene_.x(first_ + second);
        const double dy = scene_.y(first_ + first) - scene_.y(first_ + second);
        if (dx * dx + dy * dy > near) continue;
        if (uniform(draw(f, a * count_ + b, kSwapped)) < chance) std::swap(first, second);
      }
    }
  }

  /// Takes unseen frames off both ends.
  static void trim(Track& track) {
    const auto seen = [](double v) { return !std::isnan(v); };
    const auto begin = std::find_if(track.x.begin(), track.x.end(), seen) - track.x.begin();
    const auto end = std::find_if(track.x.rbegin(), track.x.rend(), seen).base() - track.x.begin();
    track.first = static_cast<int>(begin);
    for (auto* of : {&track.x, &track.y, &track.theta}) {
      if (of->empty()) continue;
      of->erase(of->begin() + std::max(end, begin), of->end());
      of->erase(of->begin(), of->begin() + begin);
    }
  }

  Interpolator scene_;
  Camera camera_;
  Recording out_;
  std::vector<int> shown_;  ///< which body has an id
  int first_ = 0, count_ = 0;
  bool headings_ = false;
  Rot tilt_, lean_;
  alignas(64) float noise_[(kNoiseCount + 1) * kBulkBodies];  ///< of the bodies seen now
};

}  // namespace

Recording film(const Trajectory& trajectory, const Camera& camera, BodyKind body) {
  return Filming(trajectory, camera, body).film();
}

}  // namespace lilytank
