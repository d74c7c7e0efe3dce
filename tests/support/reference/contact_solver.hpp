// Velocities after contact: sequential impulses with Coulomb friction and Newton's restitution.
#pragma once
#include <vector>

#include "island.hpp"

namespace lilytank::reference {

/// A point where two movers touch or may within the substep.
struct ContactPoint {
  int a = 0, b = 0;                       ///< movers; a = 0: the wall
  double nx = 0, ny = 0;                  ///< unit normal from a to b; the tangent is (-ny, nx)
  double x = 0, y = 0, gap = 0;           ///< m
  double an = 0, at = 0, bn = 0, bt = 0;  ///< m, arms of the normal and tangential impulses
  double nn = 0, nt = 0, tt = 0;          ///< 1/kg, velocity gained by a unit of impulse
  double stick = 0;                       ///< kg^2, inverse of their determinant
  double slide[2] = {}, share[2] = {};    ///< sliding towards -t, t: kg; tangential by normal
  double impulse_n = 0, impulse_t = 0;    ///< kg m/s
  double approach = 0;                    ///< m/s, normal velocity before; negative: nearing
  double target = 0;                      ///< m/s, least normal velocity after
};

/// Solves the contacts of an island for one substep in two parts. Before the bodies move: a gap may
/// close, not more (so bodies meet in the substep, without overlap and without tunnelling). After
/// they moved: those that met no longer near each other, and rebound. Impulses act on both bodies
/// at one point, so momentum and angular momentum are kept in both parts.
class ContactSolver {
 public:
  explicit ContactSolver(const Model& model);

  /// Finds the contacts within `margin` (m) from the island's last survey and changes twists so
  /// that no gap closes by more than itself in h seconds. False if nothing had to be changed; then
  /// there is nothing to rebound.
  bool approach(Island& island, double margin, double h);
  /// After the island moved by h: removes what is left of the approach, adds restitution, and
  /// makes sure that no energy was gained.
  void rebound(Island& island, double h);

 private:
  void prepare(ContactPoint& contact, const Mover& a, const Mover& b) const;
  bool retarget(const std::vector<Mover>& movers);
  void iterate(Island& island);
  void sweep(std::vector<Mover>& movers);
  double moved(const std::vector<Mover>& movers);

  double friction_, restitution_, threshold_;
  double energy_ = 0;  // J, of the island before its contacts were solved
  std::vector<ContactPoint> contacts_;
  std::vector<Twist> before_;  // of the movers, before the last sweep
};

}  // namespace lilytank::reference
