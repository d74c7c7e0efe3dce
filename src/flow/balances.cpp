#include "flow/balances.hpp"

#include <algorithm>
#include <cmath>

namespace lilytank {
namespace {

constexpr double kDuration = 0.1;         // s, of a balance
constexpr double kLongestDuration = 0.3;  // s
constexpr double kLeastKick = 1e-6;       // m^2/s^3
constexpr double kNear = 0.15;            // m, farther balls are ignored

// A ball at the first frame of a balance, and where it is going.
struct Place {
  double x, y, vx, vy;
  std::int32_t track, at;
};

bool all_seen(const Track& t, int from, int to) {
  for (int i = from; i <= to; ++i) {
    if (std::isnan(t.x[i])) return false;
  }
  return true;
}

// How near two balls come within `time`, going straight on.
double closest(const Place& a, const Place& b, double time) {
  const double dx = b.x - a.x, dy = b.y - a.y, ux = b.vx - a.vx, uy = b.vy - a.vy;
  const double uu = ux * ux + uy * uy;
  const double t = uu > 0 ? std::clamp(-(dx * ux + dy * uy) / uu, 0.0, time) : 0;
  const double x = dx + ux * t, y = dy + uy * t;
  return std::sqrt(x * x + y * y);
}

class Finder {
 public:
  Finder(const BallPhysics& ball, const TrackNoise& noise, BalanceSet& out)
      : ball_(ball), out_(out), shape_(out.shape) {
    // Standard deviation of the displacement by process noise during a balance.
    const double wander = std::sqrt(noise.kick * std::pow(shape_.duration(), 3) / 3);
    margin_ = std::clamp(2 * wander, 0.003, 0.010);
  }
  // The balances that begin at a frame.
  void look(int frame) {
    gather(frame);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!complete_[i]) continue;
      if (free(i))
        add(places_[i]);
      else
        ++out_.dropped;
    }
  }

 private:
  // Tracks are sorted by their first frames; frames are visited in order.
  void follow(int frame) {
    while (next_ < out_.tracks.size() && out_.tracks[next_]->first <= frame) {
      present_.push_back(next_++);
    }
    std::erase_if(present_, [&](std::size_t k) { return out_.tracks[k]->last() < frame; });
  }

  void gather(int frame) {
    follow(frame);
    places_.clear(), complete_.clear();
    for (const std::size_t k : present_) {
      const Track& t = *out_.tracks[k];
      const int at = frame - t.first, n = static_cast<int>(t.x.size());
      if (std::isnan(t.x[at])) continue;
      Place p{t.x[at], t.y[at], 0, 0, static_cast<std::int32_t>(k), at};
      const int back = at - 2 * shape_.half;
      if (back >= 0 && !std::isnan(t.x[back])) {
        p.vx = (p.x - t.x[back]) / shape_.box();
        p.vy = (p.y - t.y[back]) / shape_.box();
      }
      places_.push_back(p);
      complete_.push_back(at >= shape_.lead() && at + shape_.tail() < n &&
                          all_seen(t, at - shape_.lead(), at + shape_.tail()));
    }
  }

  // Neither about to touch anything, nor was it in the box before.
  bool free(std::size_t i) const {
    const Place& p = places_[i];
    const double time = shape_.duration() + shape_.half * shape_.interval;
    const double wall = ball_.tank_radius - ball_.radius;
    const double ex = p.x + p.vx * time, ey = p.y + p.vy * time;
    const double far = std::max(ex * ex + ey * ey, p.x * p.x + p.y * p.y);
    if (far > (wall - margin_) * (wall - margin_)) return false;
    if (was_at_wall(p, wall - 0.002)) return false;
    for (std::size_t j = 0; j < places_.size(); ++j) {
      const Place& o = places_[j];
      const double dx = o.x - p.x, dy = o.y - p.y;
      if (j == i || dx * dx + dy * dy > kNear * kNear) continue;
      if (closest(p, o, time) < 2 * ball_.radius + margin_) return false;
      if (touched(p, o, 2 * ball_.radius + 0.004)) return false;
    }
    return true;
  }

  bool was_at_wall(const Place& p, double limit) const {
    const Track& t = *out_.tracks[p.track];
    for (int b = 1; b <= 2 * shape_.half; ++b) {
      const auto i = static_cast<std::size_t>(p.at - b);
      if (t.x[i] * t.x[i] + t.y[i] * t.y[i] > limit * limit) return true;
    }
    return false;
  }

  bool touched(const Place& p, const Place& o, double limit) const {
    const Track& a = *out_.tracks[p.track];
    const Track& b = *out_.tracks[o.track];
    for (int back = 1; back <= 2 * shape_.half && back <= o.at; ++back) {
      const auto i = static_cast<std::size_t>(p.at - back),
                 j = static_cast<std::size_t>(o.at - back);
      const double dx = a.x[i] - b.x[j], dy = a.y[i] - b.y[j];
      if (dx * dx + dy * dy < limit * limit) return true;  // false where b was not seen
    }
    return false;
  }

  void add(const Place& p) {
    const Track& t = *out_.tracks[p.track];
    const auto speed = [&](const std::vector<double>& x, int f) {
      return (x[f + shape_.half] - x[f - shape_.half]) / shape_.box();
    };
    const int end = p.at + shape_.length, before = p.at - 2 * shape_.half - shape_.gap;
    Balance b{};
    b.ax = (speed(t.x, end) - speed(t.x, p.at)) / shape_.duration();
    b.ay = (speed(t.y, end) - speed(t.y, p.at)) / shape_.duration();
    b.x0 = t.x[before], b.y0 = t.y[before];
    b.vx0 = speed(t.x, before), b.vy0 = speed(t.y, before);
    b.track = p.track, b.at = p.at;
    out_.balances.push_back(b);
  }

  const BallPhysics& ball_;
  BalanceSet& out_;
  const BalanceShape shape_;
  double margin_ = 0;
  std::size_t next_ = 0;              // first track that starts later
  std::vector<std::size_t> present_;  // tracks at this frame
  std::vector<Place> places_;
  std::vector<bool> complete_;
};

}  // namespace

double BalanceShape::kick_share(double hold) const {
  // The kernel is a trapezoid, a box of the duration averaged over the velocities' box. A held
  // force has a triangular autocorrelation, which rounds the kernel's own near 0.
  const double t = duration(), b = box();
  return (t - b / 3 - hold * hold / (6 * b)) / (t * t);
}

double BalanceShape::velocity_wander(double kick, double hold) const {
  // Half the mean square of v(t) - v(t') over all pairs in the box. Under held forces that square
  // is |t - t'| - hold / 3 for distant and (t - t')^2 / hold - ... for near times.
  const double b = box();
  if (b < hold) return kick * (b * b / (12 * hold) - b * b * b / (60 * hold * hold));
  const double h = hold / b;
  return kick * b * (1.0 / 6 - h / 6 + h * h / 12 - h * h * h / 60);
}

BalanceShape balance_shape(double rate, const TrackNoise& noise, double hold) {
  BalanceShape s;
  s.interval = 1 / rate;
  double least = -1;
  for (int half = 1; half <= std::max(1, static_cast<int>(0.1 * rate)); ++half) {
    BalanceShape tried = s;
    tried.half = half;
    const double error =
        2 * tried.velocity_wander(noise.kick, hold) + tried.velocity_noise(noise.variance);
    if (least < 0 || error < least) least = error, s.half = half;
  }
  const double kick = std::max(noise.kick, kLeastKick);
  // Long enough that noise adds less than a fifth to the kicks.
  const double quiet = 5 * 4 * noise.variance / (kick * s.box() * s.box());
  const double duration = std::clamp(quiet, kDuration, kLongestDuration);
  s.length = std::max(2 * s.half, static_cast<int>(std::lround(duration * rate)));
  s.gap = std::max(1, static_cast<int>(std::ceil(hold * rate - 1e-9)));
  return s;
}

BalanceSet find_balances(const Recording& recording, const BallPhysics& ball,
                         const BalanceShape& shape, const TrackNoise& noise) {
  BalanceSet out;
  out.shape = shape;
  out.variance = noise.variance;
  std::vector<const Track*> waiting;
  for (const Track& t : recording.tracks) waiting.push_back(&t);
  std::stable_sort(waiting.begin(), waiting.end(),
                   [](const Track* a, const Track* b) { return a->first < b->first; });
  out.tracks = std::move(waiting);
  Finder finder(ball, noise, out);
  for (int q = shape.lead(); q < recording.frames; q += shape.length) finder.look(q);
  return out;
}

SecondDifference second_difference(std::span<const Recording> recordings, int lag) {
  SecondDifference out;
  double limit = 0;
  // Contacts are rare but large: without what exceeds 16 times the mean square of the round before.
  for (int round = 0; round < 3; ++round) {
    double sum = 0;
    std::int64_t count = 0;
    for (const Recording& recording : recordings) {
      if (recording.body != BodyKind::ball) continue;
      for (const Track& t : recording.tracks) {
        for (std::size_t i = static_cast<std::size_t>(2 * lag); i < t.x.size(); ++i) {
          const auto middle = i - static_cast<std::size_t>(lag),
                     back = middle - static_cast<std::size_t>(lag);
          const double dx = t.x[i] - 2 * t.x[middle] + t.x[back];
          const double dy = t.y[i] - 2 * t.y[middle] + t.y[back];
          const double square = dx * dx + dy * dy;
          if (std::isnan(square) || (round > 0 && square > limit)) continue;
          sum += square, ++count;
        }
      }
    }
    out.count = 2 * count;
    out.mean_square = count > 0 ? sum / static_cast<double>(2 * count) : 0;
    limit = 32 * out.mean_square;
  }
  return out;
}

double second_difference_share(double span, double hold) {
  // The autocorrelation of a triangle, averaged over that of a held force, itself a triangle. For
  // forces held longer than the span, the shorter of both is the triangle that counts.
  const double d = std::min(hold, span);
  return 2.0 / 3 * span * span * span - d * d * span / 6 + d * d * d / 20;
}

TrackNoise track_noise(std::span<const Recording> recordings, double rate, double hold) {
  const int far = std::max(3, static_cast<int>(std::lround(kDuration * rate)));
  const double near_share = second_difference_share(1 / rate, hold);
  const double far_share = second_difference_share(far / rate, hold);
  const double near_square = second_difference(recordings, 1).mean_square;
  const double far_square = second_difference(recordings, far).mean_square;
  TrackNoise out;
  out.kick = std::max(kLeastKick, (far_square - near_square) / (far_share - near_share));
  out.variance = std::max(0.0, (near_square - out.kick * near_share) / 6);
  return out;
}

}  // namespace lilytank
