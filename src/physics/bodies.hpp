// The hot state of one world: float32 arrays that the vector code reads and writes, and nothing
// else touches in most steps.
#pragma once
#include <cstdint>
#include <vector>

#include "assembly.hpp"
#include "lilytank/model.hpp"
#include "lilytank/state.hpp"

namespace lilytank {

/// Bodies that one call of the vector code serves; arrays are padded to a multiple.
constexpr int kBodyLanes = 16;

/// A rigid assembly of several modules.
struct Compound {
  int slot = 0;
  float x = 0, y = 0, c = 1, s = 0, vx = 0, vy = 0, omega = 0;  ///< of the centre of mass
  float to_x = 0, to_y = 0, to_c = 1, to_s = 0;                 ///< at the end of a slice
  float mass = 0, inertia = 0, inv_mass = 0, inv_inertia = 0;
  float own_share = 0;  ///< of the inertia: the members' own
  float reach = 0;      ///< m, from the centre to the farthest corner
};

/// Poses and twists of all bodies. Bodies beyond the last are at rest in the tank's centre and
/// weigh nothing.
class Bodies {
 public:
  explicit Bodies(const Model& model);

  /// Takes the poses, twists and assemblies of a state, rounded to float32.
  void load(const State& state, const Assemblies& assemblies);
  /// Writes poses and twists of all assemblies and bodies, exactly.
  void save(State& state, Assemblies& assemblies) const;
  /// The members of a group go with it.
  void place_members(const Compound& group, const Assemblies& assemblies);
  /// The same for their twists only.
  void turn_members(const Compound& group, const Assemblies& assemblies);
  /// Sets where the members are at the end of a slice, with their group at to_x and so on.
  void place_members_at_end(const Compound& group, const Assemblies& assemblies);
  /// The group of an assembly's slot; null: a body by itself.
  Compound* group_of(int of) {
    return group_[of] < 0 ? nullptr : &groups[static_cast<std::size_t>(group_[of])];
  }
  const Compound* group_of(int of) const { return const_cast<Bodies*>(this)->group_of(of); }

  int count = 0, modules = 0, padded = 0;
  float* x = nullptr;
  float *y, *c, *s, *vx, *vy, *omega;              ///< [padded] m, m/s, rad/s
  float *fx, *fy, *torque;                         ///< [padded] N, N m, of this step
  float *mass, *inv_mass, *inertia, *inv_inertia;  ///< [padded] of a body by itself
  float* size;    ///< [padded] m, radius of the circle about a body
  float* radius;  ///< [padded] m, reach of a body's group; 0 of a body by itself
  float* arc;     ///< [padded] m, a member's path leaves a straight line by no more in a slice
  float* reach;   ///< [padded] m, how far a body and its way extend in a slice
  float *offset_x, *offset_y;        ///< [padded] m, in the assembly's frame
  float *quarter_c, *quarter_s;      ///< [padded] a module's turn in that frame
  float *arm_x, *arm_y;              ///< [padded] m, from the assembly's centre of mass, of groups
  float *to_arm_x, *to_arm_y;        ///< [padded] at the end of a slice
  float *to_x, *to_y, *to_c, *to_s;  ///< [padded] at the end of a slice
  std::uint8_t* covered = nullptr;   ///< [padded] as in Kinematics
  std::vector<int> slot;             ///< [count] assembly of a body
  std::vector<Compound> groups;      ///< by slot, ascending

 private:
  struct alignas(64) Lanes {
    float v[kBodyLanes];
  };
  std::vector<Lanes> storage_;
  std::vector<int> group_;  // [slot]
};

/// v += dt F / m for bodies by themselves; leaves the twists before it in to_x, to_y and to_c.
/// False if one is then faster than `fastest` (m/s, turning at its rim included) or not a number.
bool kick_all(Bodies& b, float dt, float fastest);
constexpr float kEndless = 1e9f;  ///< m
/// Sets arc and reach, and the bits of `at_wall` ([padded / 64] words) for bodies that may come
/// near the wall. Returns no less than the way of any point, m; kEndless where that is not a
/// number.
float look_ahead(Bodies& b, float h, float tank, std::uint64_t* at_wall);
/// Bits of the bodies j with |x_i - x_j| < reach_i + reach_j, for up to 64 bodies, i included.
void near_bits(const Bodies& b, const float* reach, std::uint64_t* bits);
/// Bits of bodies with centres `to` nearer to (x, y) than reach, up to 64 bodies from `first`.
std::uint64_t bits_about(const Bodies& b, float x, float y, float reach, int first);
/// Poses `to` after h seconds of free flight.
void fly_all(Bodies& b, float h);
/// Takes over the poses `to`; twists lose shares.
void arrive_all(Bodies& b, float linear, float angular);

}  // namespace lilytank
