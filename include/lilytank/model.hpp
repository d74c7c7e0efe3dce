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

/// Gusts, stochastic force and firmware are defined by intervals of 25 ms, s. A step is a whole
/// fraction of that, so their statistics do not depend on the step.
constexpr double kTick = 0.025;

/// The tank: a round basin with a smooth vertical wall, its centre at the origin.
struct TankParameters {
  double radius = 0.30;  ///< inner radius, m, 0.05 .. 5 in scenarios
};

/// A Lily: a floating square with a latch on each face. Faces 0..3 look along +x, +y, -x, -y of
/// the module's own frame. Mass and water act as on a uniform square.
struct ModuleParameters {
  int count = 15;       ///< modules in the tank: bodies [0, count)
  double side = 0.035;  ///< side of the square, m; also the pitch of an assembly's lattice
  /// kg; the mass of the displaced water is not included (see the force term added_mass).
  double mass = 0.035;
  /// Immersion depth, m: height of the face that the water pushes on, in Eq. 5.
  double draught = 0.035;
  bool shadowing = true;  ///< whether a face that a latched neighbour covers feels no drag
  /// Moment of inertia about the centre, kg m^2: m a^2 / 6 of a uniform square.
  double inertia() const { return mass * side * side / 6; }
};

/// A ball of the flow measurements: a disc that does not rotate and has no latches.
struct BallParameters {
  int count = 0;            ///< balls in the tank: bodies [module.count, module.count + count)
  double radius = 0.015;    ///< m
  double mass = 0.0131;     ///< kg
  double drag_area = 7e-4;  ///< wetted cross-section in the drag law, m^2
};

/// Contacts between bodies, and between a body and the wall: Coulomb friction and Newton's
/// restitution, solved by sequential impulses (src/physics/island_block.hpp).
struct ContactParameters {
  double friction = 0.2;  ///< Coulomb's coefficient, the same for all pairs and for the wall
  /// Separation speed divided by approach speed, 0 (inelastic) .. 1 (elastic).
  double restitution = 0.2;
  /// Approach speed below which restitution is 0, m/s, so that bodies at rest do not jitter.
  double restitution_speed = 0.01;
};

/// How the gusts xi of Eq. 4 are drawn for the drag points of a module. Each is a standard normal
/// per axis and holds for one tick.
enum class Gusts {
  per_point,   ///< one draw for each drag point [authors' simulation]
  per_module,  ///< one draw for the whole module [paper, Eq. 4 read literally]
  /// The wrench is drawn from a normal law with the mean and covariance that per_point has: about
  /// three times faster.
  moment_matched,
};

/// Where the flow field is read for the drag on a module: at each drag point, or once at the
/// module's centre.
enum class FlowAt { points, centre };

/// When pairs of latched modules evaluate rules: as state machines that run every tick, or at
/// geometric random times of mean 1 / ControlParameters::evaluation_rate.
enum class Clock { firmware, events };

/// How two modules agree on a decision (protocol: src/control/exchange.hpp). Without lost messages
/// both have the same outcome.
enum class Handshake {
  /// The responder acts and answers. If the answer is lost, the initiator keeps its old labels and
  /// the pair disagrees.
  plain,
  /// Two-phase commit: both act once the decision is confirmed, and lost messages are sent again.
  confirmed,
};

/// The flow at a point: K_v (mu + sigma xi) [paper, Eq. 4].
struct FlowParameters {
  double K_v = 1.365;  ///< factor on the field's mean and standard deviation; dimensionless
  Gusts gusts = Gusts::per_point;
  FlowAt at = FlowAt::points;
  double rho = 1000;  ///< density of the water, kg/m^3
};

/// Upper bound of ControlParameters::reply_ticks: Firmware::waiting, a byte, begins at 2 more.
inline constexpr int kMostReplyTicks = 253;

/// Latches and firmware of a module [paper, section 5].
struct ControlParameters {
  /// Whether the electro-permanent magnets are on. Without them nothing latches.
  bool latches = true;
  Clock clock = Clock::firmware;
  Handshake handshake = Handshake::plain;
  /// Two faces latch if their centres are within this distance, m ...
  double capture_distance = 0.005;
  /// ... and their normals within this angle of anti-parallel, rad, 0 .. 0.75.
  double capture_angle = 0.2;
  double initiative = 0.1;  ///< probability per tick that an idle module begins an exchange
  int reply_ticks = 5;      ///< ticks that an initiator waits for the answer, 1 .. kMostReplyTicks
  double evaluation_rate = 0.68;  ///< evaluations per bond, 1/s, of Clock::events
  /// A released face returns in a tick with probability (ticks since its release) / off_scale.
  double off_scale = 256;
  // Faults, all of them probabilities; 0: ideal channel and latches.
  /// Probability that a request, confirmation or dismissal is lost.
  double message_loss = 0;
  /// Probability that an answer or acknowledgement from responder to initiator is lost.
  double answer_loss = 0;
  /// Probability that two faces that meet fail to hold; they then are off, as after a release.
  double latch_failure = 0;
  /// Probability that a latch still holds after a release command; the pair decides again later.
  double release_failure = 0;
};

/// pause, resume, switch_off, query: to modules. replace_ruleset, pump_power: to the tank.
enum class CommandKind { pause, resume, switch_off, replace_ruleset, query, pump_power };

/// A command of the base station. It takes effect in the first tick that does not begin before it.
struct Command {
  double at = 0;  ///< s from the start; of Model::commands
  CommandKind kind = CommandKind::query;
  std::vector<int> modules;  ///< modules that it addresses; empty: all
  int ruleset = 0;           ///< index into Model::rulesets, of replace_ruleset
  int copies = 0;            ///< completed copies from which on it holds; of Model::feedback
  int field = 0;             ///< of pump_power: 0 is Model::field, i is Model::other_fields[i - 1]
};

/// random: uniform in a disc. lattice: a square grid. poses: StartParameters::poses.
enum class Layout { random, lattice, poses };

/// Initial positions of the bodies. All start at rest with nothing latched.
struct StartParameters {
  Layout layout = Layout::random;
  double radius = 0.20;  ///< radius of the disc that holds all centres, m (random)
  /// Least distance of two centres, m (random); pitch of the grid (lattice).
  double distance = 0.05;
  std::vector<Pose> poses;  ///< one for each body, modules first (poses)
};

/// Everything that a simulation does not change. The defaults are no valid model: begin with
/// standard_model() (start.hpp) or load_scenario() (scenario.hpp).
struct Model {
  double dt = kTick;       ///< time step, s: kTick / steps_per_tick
  int steps_per_tick = 1;  ///< steps in a tick, 1 .. 256
  TankParameters tank;
  ModuleParameters module;
  BallParameters ball;
  ContactParameters contact;
  FlowParameters flow;
  ControlParameters control;
  StartParameters start;
  std::shared_ptr<const FlowField> field;  ///< the flow at the start; never null
  /// Flows at other pump powers, which pump_power commands set.
  std::vector<std::shared_ptr<const FlowField>> other_fields;
  /// Active force terms with their parameters, in the order of force_library(). The order of sums
  /// is part of the result's bits.
  std::vector<ActiveForce> forces;
  /// [0] is in force at the start. Empty: latched modules never separate.
  std::vector<Ruleset> rulesets;
  std::vector<Command> commands;  ///< commands by time, ascending
  /// Rulesets and pump powers that depend on the number of completed copies that the modules
  /// report, ascending in Command::copies. Of each kind, the last one whose number is reached
  /// holds; before the first one, what `commands` set.
  std::vector<Command> feedback;
  /// Deterministic dynamics: random forces are off, and the drag on modules is its mean over gusts
  /// (of Gusts::moment_matched). The one-step predictor uses it to compute expected motion.
  bool expected = false;
  /// Modules and balls.
  int bodies() const { return module.count + ball.count; }
};

/// The command that Event::a of an EventKind::command refers to: indices of `commands` come first,
/// those of `feedback` follow. `index` must be in range.
const Command& command_at(const Model& model, int index);

}  // namespace lilytank
