#include "synthesis/steric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lilytank/math.hpp"

namespace lilytank {
namespace {

struct Square {
  double x = 0, y = 0;  // centre
};

// Squares of side 1 along the axes against squares turned by one angle that move in one direction.
class Sweep {
 public:
  Sweep(double turn, double heading, double clearance)
      : c_(std::cos(turn)), s_(std::sin(turn)), dx_(std::cos(heading)), dy_(std::sin(heading)) {
    // Half widths of a square and of a turned one along an axis of either.
    reach_ = 0.5 + 0.5 * (std::fabs(c_) + std::fabs(s_)) + clearance;
  }
  // Whether `guest`, moving from where it is to infinity, comes closer than the clearance to host.
  bool hits(const Square& host, const Square& guest) const {
    const double x = guest.x - host.x, y = guest.y - host.y;
    double from = 0, to = std::numeric_limits<double>::infinity();
    return narrow(x, dx_, from, to) && narrow(y, dy_, from, to) &&
           narrow(c_ * x + s_ * y, c_ * dx_ + s_ * dy_, from, to) &&
           narrow(c_ * y - s_ * x, c_ * dy_ - s_ * dx_, from, to);
  }

 private:
  // The times in [from, to] at which |offset + speed t| < reach; false if there are none.
  bool narrow(double offset, double speed, double& from, double& to) const {
    if (std::fabs(speed) < 1e-12) return std::fabs(offset) < reach_;
    double first = (-reach_ - offset) / speed, last = (reach_ - offset) / speed;
    if (first > last) std::swap(first, last);
    from = std::max(from, first), to = std::min(to, last);
    return from < to;
  }
  double c_, s_, dx_, dy_, reach_ = 1;
};

// A pose within the latching range: offset along (outwards) and across the bond, turn.
struct Offset {
  double out = 0, across = 0, turn = 0;
};

std::vector<Offset> offsets(const Approach& room) {
  std::vector<Offset> found;
  for (const double turn : {0.0, 0.5, -0.5, 0.95, -0.95}) {
    for (const double out : {0.6, 0.3, 0.95}) {
      const double wide = std::sqrt(1 - out * out);
      for (const double across : {0.0, 0.45, -0.45, 0.95, -0.95})
        found.push_back({out * room.capture, across * wide * room.capture, turn * room.angle});
    }
  }
  return found;
}

// The guest's squares in a pose; it turns about its face's centre.
std::vector<Square> posed(const std::vector<Cell>& guest, Cell at, int direction,
                          const Offset& pose) {
  constexpr std::array<int, 4> kX = {1, 0, -1, 0}, kY = {0, 1, 0, -1};
  const auto d = static_cast<std::size_t>(direction & 3);
  const double nx = kX[d], ny = kY[d], c = std::cos(pose.turn), s = std::sin(pose.turn);
  const double fx = at.x + 0.5 * nx, fy = at.y + 0.5 * ny;
  std::vector<Square> squares;
  for (const Cell& cell : guest) {
    const double x = cell.x - fx, y = cell.y - fy;
    squares.push_back({fx + c * x - s * y + pose.out * nx - pose.across * ny,
                       fy + s * x + c * y + pose.out * ny + pose.across * nx});
  }
  return squares;
}

}  // namespace

bool can_approach(const std::vector<Cell>& host, const std::vector<Cell>& guest, Cell at,
                  int direction, const Approach& room) {
  const double normal = 0.5 * kPi * (direction & 3);
  constexpr std::array<double, 11> kWays = {0, 15, -15, 30, -30, 45, -45, 60, -60, 75, -75};
  for (const Offset& pose : offsets(room)) {
    const std::vector<Square> squares = posed(guest, at, direction, pose);
    for (const double degrees : kWays) {
      const Sweep sweep(pose.turn, normal + degrees * kPi / 180, room.clearance);
      const auto hit = [&](const Cell& cell) {
        const Square fixed{static_cast<double>(cell.x), static_cast<double>(cell.y)};
        return std::any_of(squares.begin(), squares.end(),
                           [&](const Square& square) { return sweep.hits(fixed, square); });
      };
      if (std::none_of(host.begin(), host.end(), hit)) return true;
    }
  }
  return false;
}

bool free_to_meet(const Pattern& whole, std::size_t host, const Site& ours) {
  std::vector<Cell> cells[2];
  for (std::size_t k = 0; k < whole.size(); ++k) cells[k < host ? 0 : 1].push_back(whole[k].cell);
  return can_approach(cells[0], cells[1], whole[ours.module].cell, ours.direction);
}

}  // namespace lilytank
