// All that is constant in a run. A Model is made once (by hand or from a Scenario), never changed
// afterwards, and may be shared by any number of Worlds and threads.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "lilytank/flow_field.hpp"
#include "lilytank/force.hpp"
#include "lilytank/ruleset.hpp"

namespace lilytank {

/// Gusts, stochastic force and firmware are defined by intervals of 25 ms; a step is a whole
/// fraction of that, so results do not depend on the step.
constexpr double kTick = 0.025;  // s

struct TankParameters {
  double radius = 0.30;  ///< m
};

/// A Lily: a floating square with a latch on each face. Faces 0..3 look along +x, +y, -x, -y of
/// the module's own frame.
struct ModuleParameters {
  int count = 15;
  double side = 0.035;     ///< m
  double mass = 0.035;     ///< kg
  double draught = 0.035;  ///< m, height of a face that feels drag
  bool shadowing = true;   ///< a face covered by a latched neighbour feels no drag
  double inertia() const { return mass * side * side / 6; }  ///< kg m^2, uniform square
};

/// A ball of the flow measurements: a disc that does not turn.
struct BallParameters {
  int count = 0;
  double radius = 0.015;    ///< m
  double mass = 0.0131;     ///< kg
  double drag_area = 7e-4;  ///< m^2
};

struct ContactParameters {
  double friction = 0.2;            ///< Coulomb's coefficient
  double restitution = 0.2;         ///< share of the approach speed that is given back
  double restitution_speed = 0.01;  ///< m/s, no restitution below
};

/// Gusts on a module's faces.
enum class Gusts {
  per_point,       ///< each drag point has its own [authors' simulation]
  per_module,      ///< one for the whole module [paper, Eq. 4 read literally]
  moment_matched,  ///< as per_point, but the wrench is drawn as a normal with its mean and
                   ///< covariance
};
/// Where the water is read for the drag on a module.
enum class FlowAt { points, centre };
enum class Clock { firmware, events };
/// How two modules agree on a decision (src/control/exchange.hpp).
enum class Handshake {
  plain,      ///< the responder acts and answers; a lost answer leaves the initiator's old labels
  confirmed,  ///< both act once the decision is confirmed; lost messages are sent again
};

struct FlowParameters {
  double K_v = 1.365;  ///< factor on mean and deviation [Eq. 4]
  Gusts gusts = Gusts::per_point;
  FlowAt at = FlowAt::points;
  double rho = 1000;  ///< kg/m^3
};

/// The most that an initiator can wait: Firmware::waiting, a byte, then begins with 255.
inline constexpr int kMostReplyTicks = 253;

/// Latches and firmware of a module.
struct ControlParameters {
  bool latches = true;  ///< false: EPMs off, nothing latches
  Clock clock = Clock::firmware;
  Handshake handshake = Handshake::plain;
  double capture_distance = 0.005;  ///< m, between face centres
  double capture_angle = 0.2;       ///< rad, from anti-parallel
  double initiative = 0.1;          ///< probability per 25 ms to begin an exchange
  int reply_ticks = 5;              ///< that an initiator waits, 1 .. kMostReplyTicks
  double evaluation_rate = 0.68;    ///< 1/s per bond, of the event-driven clock
  double off_scale = 256;           ///< an off face returns with probability (ticks off) / scale
  // Faults, all of them probabilities; 0: the ideal channel and latches.
  double message_loss = 0;     ///< that a message never arrives
  double answer_loss = 0;      ///< that a message from responder to initiator never arrives
  double latch_failure = 0;    ///< that two faces that meet do not hold; they are then off
  double release_failure = 0;  ///< that a latch holds on although it is told to let go
};

enum class CommandKind { pause, resume, switch_off, replace_ruleset, query, pump_power };

/// What the base station says or sets, and when.
struct Command {
  double at = 0;  ///< s
  CommandKind kind = CommandKind::query;
  std::vector<int> modules;  ///< empty: all
  int ruleset = 0;           ///< index into Model::rulesets, of replace_ruleset
  int copies = 0;            ///< of Model::feedback: from that many finished copies on
  int field = 0;             ///< of pump_power: 0 Model::field, i Model::other_fields[i - 1]
};

enum class Layout { random, lattice, poses };

/// How bodies lie at the start.
struct StartParameters {
  Layout layout = Layout::random;
  double radius = 0.20;     ///< m, centres are within it
  double distance = 0.05;   ///< m, least distance of two centres (lattice: the pitch)
  std::vector<Pose> poses;  ///< of Layout::poses
};

struct Model {
  double dt = kTick;       ///< s
  int steps_per_tick = 1;  ///< dt = kTick / steps_per_tick
  TankParameters tank;
  ModuleParameters module;
  BallParameters ball;
  ContactParameters contact;
  FlowParameters flow;
  ControlParameters control;
  StartParameters start;
  std::shared_ptr<const FlowField> field;
  std::vector<std::shared_ptr<const FlowField>> other_fields;  ///< that pump_power commands set
  std::vector<ActiveForce> forces;
  std::vector<Ruleset> rulesets;  ///< [0] is in force at the start; empty: latched bonds never end
  std::vector<Command> commands;  ///< by time
  /// Rulesets and pump power that go with the number of finished copies that the modules report,
  /// by Command::copies, rising. The last one of its kind that is reached holds; before the first
  /// one, what `commands` said.
  std::vector<Command> feedback;
  /// Nothing random: random forces are left out, and drag on modules is its mean over gusts (with
  /// moment-matched gusts). Such a world tells where bodies are expected to go.
  bool expected = false;
  int bodies() const { return module.count + ball.count; }
};

/// The command of an EventKind::command: those of `commands` first, then those of `feedback`.
const Command& command_at(const Model& model, int index);

}  // namespace lilytank
