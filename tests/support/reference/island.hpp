// Assemblies that may touch one another or the wall within a step: their motion while contacts are
// solved, apart from the State until it is known to be good.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "collide.hpp"
#include "lilytank/model.hpp"

namespace lilytank::reference {

inline double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// A rigid assembly on its way through a step. Mover 0 of an island is the wall, which nothing
/// moves.
struct Mover {
  int slot = -1;
  Pose pose;
  Twist twist;
  double mass = 0, inertia = 0;          ///< kg, kg m^2
  double inv_mass = 0, inv_inertia = 0;  ///< 0 for the wall; a ball does not turn
  double reach = 0;                      ///< m, from the centre to the farthest point
  double motion_bound = 0;               ///< m, no point may end farther than this from its start
  Pose good;                             ///< at the last good substep
  Pose start;                            ///< at the start of the step
  Twist course;                          ///< at the start of the step
  double strayed = 0;                    ///< m, no point was farther from its course
  bool touched = false;                  ///< left its course
  bool undone = false;                   ///< put back in this substep
  bool dull = false;                     ///< put back in this step: no more restitution
};

enum class PairKind : std::uint8_t { squares, square_disc, discs, wall_square, wall_disc };

/// Two bodies of different movers that may touch; `a` is the wall (0) for wall kinds.
struct ContactPair {
  int a = 0, b = 0;  ///< movers
  PairKind kind = PairKind::squares;
  std::uint8_t inner_a = 0, inner_b = 0;  ///< Assemblies::inner
  double ax = 0, ay = 0, bx = 0, by = 0;  ///< m, the bodies' centres in their movers' frames
  int order_a = 0, order_b = 0;           ///< body numbers, -1 for the wall: the order of solving
  double arm_a = 0, arm_b = 0;            ///< m, lengths of (ax, ay) and (bx, by)
  Gap gap;                                ///< as last surveyed; to the wall without a normal
};

/// How fast the pairs of an island move.
struct StepLimits {
  double free_time = 0;  ///< s in which nothing can touch if twists stay
  double fastest = 0;    ///< m/s, no two bodies close faster
  double longest = 0;    ///< s, longest substep that keeps contact points accurate
};

/// The movers of one island and the pairs among them. Poses only; velocities are changed by
/// ContactSolver.
class Island {
 public:
  explicit Island(const Model& model);

  /// Forgets everything but the wall.
  void clear();
  /// Adds an assembly, to be filled in.
  Mover& add();
  void add(const ContactPair& pair);
  /// Puts pairs in order of their bodies, so that results do not depend on how they were found.
  void sort_pairs();

  std::vector<Mover>& movers() { return movers_; }
  const std::vector<Mover>& movers() const { return movers_; }
  const std::vector<ContactPair>& pairs() const { return pairs_; }
  void forget_pairs() { pairs_.clear(); }

  /// Measures the separations of all pairs; returns the deepest overlap (m, 0 if there is none).
  double survey();
  /// For the separations of the last survey; `left` (s) is the time still to go in the step.
  StepLimits step_limits(double left) const;
  /// Moves everything by its twist for h seconds.
  void move(double h);
  /// Pushes overlapping bodies apart, without giving them speed, in at most `rounds` sweeps over
  /// the pairs; returns what is left of the deepest overlap (m), 0 if nothing overlapped by more
  /// than the slop.
  double push_apart(int rounds);
  /// Visits of contacts and pairs by the solvers since it was last set to 0; clear() leaves it.
  std::int64_t work = 0;

  /// Whether any mover is beyond its motion bound.
  bool any_beyond_bound() const;
  /// Puts back to their last good pose those that are beyond their motion bound or overlap by more
  /// than `limit` (m), and what then overlaps with those. Returns how many.
  int put_back(double limit);
  /// Poses as they are now, `time` (s) after the start, count as good.
  void accept(double time);

  /// Points of contact of a pair within `margin` (m): calls use(nx, ny, touch), the normal from a
  /// to b.
  template <class Use>
  void touches(const ContactPair& pair, double margin, Use&& use) const;

 private:
  Gap separation(const ContactPair& pair) const;
  void push(Mover& a, Mover& b, double nx, double ny, const Touch& touch);
  void undo(Mover& mover, int& count);

  double half_, corner_, radius_, tank_;
  std::vector<Mover> movers_;
  std::vector<ContactPair> pairs_;
};

constexpr double kSlop = 8e-5;    ///< m, overlap that is left alone
constexpr double kPushTo = 4e-5;  ///< m, overlap that pushing apart aims at

inline Square square_of(const Mover& m, double ox, double oy, double half, std::uint8_t inner) {
  return {m.pose.x + m.pose.r.c * ox - m.pose.r.s * oy,
          m.pose.y + m.pose.r.s * ox + m.pose.r.c * oy, m.pose.r, half, inner};
}
inline Disc disc_of(const Mover& m, double radius) {
  return {m.pose.x, m.pose.y, radius};
}

template <class Use>
void Island::touches(const ContactPair& pair, double margin, Use&& use) const {
  const Mover &a = movers_[pair.a], &b = movers_[pair.b];
  const auto use_all = [&](const Manifold& m) {
    for (int k = 0; k < m.count; ++k) use(m.nx, m.ny, m.touch[k]);
  };
  const auto square_b = [&] { return square_of(b, pair.bx, pair.by, half_, pair.inner_b); };
  const auto square_a = [&] { return square_of(a, pair.ax, pair.ay, half_, pair.inner_a); };
  switch (pair.kind) {
    case PairKind::squares:
      return use_all(collide(square_a(), square_b(), margin));
    case PairKind::square_disc:
      return use_all(collide(square_a(), disc_of(b, radius_), margin));
    case PairKind::discs:
      return use_all(collide(disc_of(a, radius_), disc_of(b, radius_), margin));
    case PairKind::wall_disc:
      return use_all(collide_wall(disc_of(b, radius_), tank_, margin));
    case PairKind::wall_square: {
      const WallManifold m = collide_wall(square_b(), tank_, margin);
      for (int k = 0; k < m.count; ++k) use(m.nx[k], m.ny[k], m.touch[k]);
    }
  }
}

}  // namespace lilytank::reference
