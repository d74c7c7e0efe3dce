// All that changes in a run, as plain data. A copy is a checkpoint, its hash a fingerprint.
#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "lilytank/model.hpp"

namespace lilytank {

/// Status of a connector.
enum class FaceStatus : std::uint8_t {
  enabled,  ///< free; latches on contact
  latched,  ///< holds a neighbour by a new latch; the modules have yet to exchange labels
  bonded,   ///< holds a neighbour by a rule
  /// Released. Returns at random (ControlParameters::off_scale), once no neighbour is in reach.
  off,
};

/// A connector of a module.
struct Face {
  /// Tick of the next evaluation, on the face of the lower module; 0: not drawn yet
  /// (Clock::events).
  std::int64_t due = 0;
  std::int32_t partner = -1;  ///< the module held; -1: none
  std::uint32_t random = 0;   ///< random number of a message that waits here
  /// off: ticks since it was released. enabled: ticks that it rests after a latch for which there
  /// was no room.
  std::uint16_t off_ticks = 0;
  std::uint8_t partner_face = 0;  ///< the partner's connector, 0..3
  FaceStatus status = FaceStatus::enabled;
  std::uint8_t spare[4] = {0, 0, 0, 0};  ///< padding, always 0: equal states have equal bytes
};

/// on: exchanges and latches. paused: keeps its labels and latches until resumed. off: switched off
/// for good.
enum class Power : std::uint8_t { on, paused, off };

/// Firmware of a module: its ruleset state and the progress of its exchange.
struct Firmware {
  std::int32_t label = 0;      ///< control state l_a; 0: isolated
  std::int8_t last = -1;       ///< connector engaged last, l_n; -1: isolated
  std::uint8_t next_face = 0;  ///< the face that it addresses next, in its round of four
  std::uint8_t waiting = 0;    ///< ticks until it is idle again (src/control/exchange.hpp)
  Power power = Power::on;
  std::uint8_t mail = 0;  ///< Bit f: a message from the neighbour at face f waits for an answer
  /// Handshake::confirmed. 0: free; 1 + f: answered at face f and waits for the confirmation;
  /// 5 + f: decided at face f and waits for the acknowledgement.
  std::uint8_t bound = 0;
  std::uint8_t spare[2] = {0, 0};  ///< padding, always 0
};

static_assert(std::has_unique_object_representations_v<Face>);
static_assert(std::has_unique_object_representations_v<Firmware>);

/// The state of one simulation. Bodies are numbered: modules [0, modules), then balls. Latched
/// modules form one rigid assembly, kept in the slot of its lowest module; only a slot whose index
/// is `assembly[i] == i` is in use. A module lies in its assembly's frame on a square lattice of
/// pitch `side`, so bonded modules cannot drift apart.
struct State {
  std::uint64_t seed = 0;         ///< key of all random numbers (random.hpp)
  std::int64_t step = 0;          ///< steps of dt since the start
  std::int32_t ruleset = 0;       ///< index into Model::rulesets
  std::int32_t next_command = 0;  ///< index into Model::commands of the next one to give
  std::int32_t field = 0;  ///< the flow now: 0 is Model::field, i is Model::other_fields[i - 1]
  /// Assemblies [bodies]: centre of mass (m), heading (cos, sin), twist (m/s, rad/s).
  std::vector<double> x, y, c, s, vx, vy, omega;
  /// Bodies [bodies]: assembly slot, lattice cell and quarter turns in the assembly's frame.
  std::vector<std::int32_t> assembly, cell_x, cell_y, turn;
  std::vector<Firmware> firmware;  ///< [modules]
  std::vector<Face> faces;         ///< [4 * modules]: face f of module i is faces[4 * i + f]
};

/// Calls visit(name, array or scalar) for every field of a state in a fixed order; the one list
/// that hashing, saving and loading share.
template <class S, class Visit>
void for_each_field(S& state, Visit&& visit) {
  visit("seed", state.seed), visit("step", state.step);
  visit("ruleset", state.ruleset), visit("next_command", state.next_command);
  visit("field", state.field);
  visit("x", state.x), visit("y", state.y), visit("c", state.c), visit("s", state.s);
  visit("vx", state.vx), visit("vy", state.vy), visit("omega", state.omega);
  visit("assembly", state.assembly), visit("cell_x", state.cell_x);
  visit("cell_y", state.cell_y), visit("turn", state.turn);
  visit("firmware", state.firmware), visit("faces", state.faces);
}

/// 64-bit fingerprint: FNV-1a over the bytes of every field. Equal states have equal fingerprints
/// on every x86-64 machine; the golden tests store them.
std::uint64_t fingerprint(const State& state);
/// A fingerprint as 16 hexadecimal digits.
std::string hex(std::uint64_t fingerprint);

/// A state as bytes: magic with version, `identity` of the scenario it belongs to, every field (a
/// vector after its length), fingerprint. Little-endian, as on every x86-64 machine.
std::string to_snapshot(const State& state, std::uint64_t identity);
/// Inverse of to_snapshot(). Throws InputError, which names `file`, if the bytes are cut, damaged,
/// of another version, or of another identity.
State from_snapshot(const std::string& bytes, std::uint64_t identity, const std::string& file);

}  // namespace lilytank
