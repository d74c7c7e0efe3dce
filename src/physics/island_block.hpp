// Islands side by side, up to sixteen of any worlds, a lane each, as the vector code moves them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lilytank {

constexpr int kBlockLanes = 16;  ///< islands of a full block
constexpr int kFewLanes = 4;     ///< of a small one

/// A number of each of N islands.
template <int N>
struct alignas(4 * N) RowOf {
  float v[N];
};
template <int N>
struct alignas(4 * N) WholeRowOf {
  std::int32_t v[N];
};

/// What meets in a pair. In a pair with the wall the body comes second.
enum class PairKind : std::uint8_t { squares, square_disc, discs, wall_square, wall_disc };

/// A mover, a rigid assembly on its way through a step, of every island. Yes and no are rows of
/// bits, all or none.
template <int N>
struct MoverRowsOf {
  using Row = RowOf<N>;
  using WholeRow = WholeRowOf<N>;
  Row x, y, c, s, vx, vy, omega;             ///< m, m/s, rad/s
  Row mass, inertia, inv_mass, inv_inertia;  ///< kg, kg m^2; all 0 for what nothing moves
  Row reach;                                 ///< m, from the centre to the farthest point
  Row good_x, good_y, good_c, good_s;        ///< at the last good substep
  Row course_x, course_y, course_omega;      ///< twist at the start
  Row before_x, before_y, before_omega;      ///< twist before the last sweep
  Row touched;                               ///< left its course
  Row undone;                                ///< put back in this substep
  Row dull;                                  ///< put back in this step: no more restitution
};

/// A pair of bodies that may touch, of every island that has so many; `a` is mover 0, which nothing
/// moves, where b meets the wall.
template <int N>
struct PairRowsOf {
  using Row = RowOf<N>;
  using WholeRow = WholeRowOf<N>;
  bool uniform = true;  ///< the same two movers in all islands: `a` and `b`
  int a = 0, b = 0;
  WholeRow at_a, at_b;  ///< movers as places in rows: see gather()
  Row on;               ///< the island has this pair
  Row wall;
  WholeRow kind;
  unsigned kinds = 0;  ///< bit k: some island's kind is k
  /// Some body is not its mover's centre, or has neighbours in its assembly.
  bool offset = false;
  Row ax, ay, bx, by;         ///< m, the bodies' centres in their movers' frames
  Row arm_a, arm_b;           ///< m, their lengths
  WholeRow inner_a, inner_b;  ///< as in Square
  Row gap, nx, ny;            ///< as last surveyed; to the wall without a normal
  bool has(PairKind k) const { return (kinds >> static_cast<int>(k) & 1) != 0; }
  bool walls() const { return kinds >> static_cast<int>(PairKind::wall_square) != 0; }
};

/// A point of contact of some islands: those in which `on` is set.
template <int N>
struct PointRowsOf {
  using Row = RowOf<N>;
  using WholeRow = WholeRowOf<N>;
  const PairRowsOf<N>* pair;
  Row on;
  Row nx, ny;                  ///< unit normal from a to b; the tangent is (-ny, nx)
  Row x, y, gap;               ///< m
  Row an, at, bn, bt;          ///< m, arms of the normal and tangential impulses
  Row im_a, ii_a, im_b, ii_b;  ///< inverse masses and inertias
  Row nn, nt, tt;              ///< 1/kg, velocity gained by a unit of impulse
  Row stick;                   ///< kg^2, inverse of their determinant
  Row slide0, slide1;          ///< kg, sliding towards -t, t
  Row share0, share1;          ///< tangential by normal impulse
  Row impulse_n, impulse_t;    ///< kg m/s
  Row approach;                ///< m/s, normal velocity before; negative: nearing
  Row target;                  ///< m/s, least normal velocity after
};

/// Islands on their way through a span of time, with scratch memory.
template <int N>
struct IslandBlock {
  static constexpr int kLanes = N;
  using Row = RowOf<N>;
  using WholeRow = WholeRowOf<N>;
  using MoverRows = MoverRowsOf<N>;
  using PairRows = PairRowsOf<N>;
  int count = 0;  ///< islands: the first lanes
  int movers = 0, pairs = 0;
  Row half, corner, radius, tank;        ///< m: of squares, discs and the tank
  Row friction, restitution, threshold;  ///< as in ContactParameters
  Row span;                              ///< s
  WholeRow most_work;                    ///< visits
  WholeRow own_pairs;                    ///< pairs of each island
  std::vector<MoverRows> mover;          ///< [movers], 0 is the wall
  std::vector<PairRows> pair;            ///< [pairs]
  std::vector<PointRowsOf<N>> point;     ///< scratch
  Row deepest;                           ///< m, result
  WholeRow work, undone;                 ///< visits of contacts and pairs; bodies put back

  /// The place of a mover in a lane, in floats.
  static std::int32_t place(int mover, int lane) {
    return static_cast<std::int32_t>(mover * static_cast<int>(sizeof(MoverRows) / sizeof(float)) +
                                     lane);
  }
};

constexpr float kSlop = 8e-5f;    ///< m, overlap that is left alone
constexpr float kPushTo = 4e-5f;  ///< m, overlap that pushing apart aims at

/// Whether blocks of several islands can be moved: not by the portable code, which has no vectors.
bool islands_share_vectors();
/// Moves the islands by their spans. Sequential impulses with Coulomb friction and Newton's
/// restitution, in substeps so short that overlaps stay below kSlop; what is left is pushed apart,
/// and what cannot be helped is put back. An island's result depends on nothing but the island: not
/// on its lane, its companions, or the number of lanes.
void run_block(IslandBlock<kBlockLanes>& block);
void run_block(IslandBlock<kFewLanes>& block);
void run_block(IslandBlock<1>& block);
/// Pushes overlapping bodies apart in up to `rounds` sweeps, positions only.
void push_block(IslandBlock<1>& block, int rounds);
/// Measures the separations of all pairs; sets `deepest`.
void survey_block(IslandBlock<1>& block);

}  // namespace lilytank
