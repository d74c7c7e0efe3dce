// Faces that find each other: new latches, and faces that come on again.
#pragma once
#include <vector>

#include "control/tick.hpp"

namespace lilytank {

/// "Default latched": an enabled face that meets an enabled face holds it at once. Keeps nothing
/// from tick to tick but memory.
class Docking {
 public:
  explicit Docking(const Model& model);
  /// Off faces whose neighbour has gone may come on; then faces that met latch, nearest first, and
  /// their assemblies become one on a common lattice.
  ///
  /// A latch for which there is no room is refused: nothing moves, and the two faces rest for
  /// kRetryTicks ticks before they latch onto anything.
  void run(Tick& tick);

  /// A latch that fails [ControlParameters::latch_failure] leaves both faces off until they part.
  static constexpr int kRetryTicks = 4;

 private:
  struct Candidate {
    double distance2 = 0;  // m^2, between the face centres
    Connector a, b;
  };
  struct SavedSlot {
    int slot = 0;
    double x = 0, y = 0, c = 1, s = 0, vx = 0, vy = 0, omega = 0;
  };
  struct SavedMember {
    std::int32_t body = 0, assembly = 0, cell_x = 0, cell_y = 0, turn = 0;
  };

  bool meet(const Bodies& bodies, int i, int j, Candidate& found) const;
  void look_around(Tick& tick);
  void add_candidate(const Candidate& candidate);
  void come_on(Tick& tick);
  void latch(Tick& tick, Connector a, Connector b);
  bool join(Tick& tick, Connector a, Connector b);
  void save(const Tick& tick, int slot);
  void restore(Tick& tick);

  const Model* model_;
  double half_side_, reach_, reach2_, least_cosine_;
  std::vector<std::uint8_t> peer_;     // [4 * modules] a face of another module is in reach
  std::vector<Candidate> candidates_;  // nearest first
  std::vector<SavedSlot> saved_slots_;
  std::vector<SavedMember> saved_members_;
};

}  // namespace lilytank
