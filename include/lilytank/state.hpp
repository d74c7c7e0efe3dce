// All that changes in a run, as plain data. A copy is a checkpoint, its hash a fingerprint.
#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "lilytank/model.hpp"

namespace lilytank {

enum class FaceStatus : std::uint8_t {
  enabled,  ///< free, latches on contact
  latched,  ///< new contact: held, the modules are still to exchange labels
  bonded,   ///< held by a rule
  off,      ///< released, comes on again after a while and when no neighbour is there
};

/// A connector of a module.
struct Face {
  std::int64_t due = 0;  ///< tick of the next evaluation (event-driven clock, lower module's face)
  std::int32_t partner = -1;    ///< the module held, -1: none
  std::uint32_t random = 0;     ///< the random number of a message that waits here
  std::uint16_t off_ticks = 0;  ///< off: ticks since it was released; enabled: ticks that it rests
                                ///< after a latch for which there was no room
  std::uint8_t partner_face = 0;
  FaceStatus status = FaceStatus::enabled;
  std::uint8_t spare[4] = {0, 0, 0, 0};
};

enum class Power : std::uint8_t { on, paused, off };

/// A module's firmware: ruleset state and where its exchange stands.
struct Firmware {
  std::int32_t label = 0;      ///< l_a
  std::int8_t last = -1;       ///< l_n, -1: isolated
  std::uint8_t next_face = 0;  ///< where the round of its faces goes on
  std::uint8_t waiting = 0;    ///< ticks until it is idle again (src/control/exchange.hpp)
  Power power = Power::on;
  std::uint8_t mail = 0;  ///< bit f: the message of face f's neighbour waits for an answer
  /// Handshake::confirmed, 0: free; 1 + f: answered at face f and waits for the confirmation;
  /// 5 + f: decided at face f and waits for the acknowledgement.
  std::uint8_t bound = 0;
  std::uint8_t spare[2] = {0, 0};
};

static_assert(std::has_unique_object_representations_v<Face>);
static_assert(std::has_unique_object_representations_v<Firmware>);

/// The state of one world. Bodies are numbered: modules [0, modules), then balls. Latched modules
/// form one rigid assembly, kept in the slot of its lowest module; only a slot whose index is
/// `assembly[i] == i` is in use. A module lies in its assembly's frame on a square lattice of
/// pitch `side`, so bonded modules cannot drift apart.
struct State {
  std::uint64_t seed = 0;
  std::int64_t step = 0;
  std::int32_t ruleset = 0;       ///< index into Model::rulesets
  std::int32_t next_command = 0;  ///< index into Model::commands
  std::int32_t field = 0;         ///< the flow now: 0 Model::field, i Model::other_fields[i - 1]
  // Assemblies [bodies]: centre of mass (m), heading, twist (m/s, rad/s).
  std::vector<double> x, y, c, s, vx, vy, omega;
  // Bodies [bodies]: assembly slot, lattice cell and quarter turns in the assembly's frame.
  std::vector<std::int32_t> assembly, cell_x, cell_y, turn;
  // Modules [modules], and their faces [4 * modules].
  std::vector<Firmware> firmware;
  std::vector<Face> faces;
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

/// 64-bit fingerprint (FNV-1a over every field); equal states have equal fingerprints.
std::uint64_t fingerprint(const State& state);
/// A fingerprint as 16 hexadecimal digits.
std::string hex(std::uint64_t fingerprint);

/// A state as bytes: magic, version, `identity` of the scenario it belongs to, sizes, fields.
std::string to_snapshot(const State& state, std::uint64_t identity);
/// Throws InputError if the bytes are cut, of another version, or of another identity.
State from_snapshot(const std::string& bytes, std::uint64_t identity, const std::string& file);

}  // namespace lilytank
