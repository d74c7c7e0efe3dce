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
  /// Inner radius, m, 0.05 .. 5 in scenarios.
  double radius = 0.30;
};

/// A Lily: a floating square with a latch on each face. Faces 0..3 look along +x, +y, -x, -y of
/// the module's own frame. Mass and water act as on a uniform square.
struct ModuleParameters {
  /// Modules in the tank: bodies [0, count).
  int count = 15;
  /// Side of the square, m; also the pitch of an assembly's lattice.
  double side = 0.035;
  /// kg; the mass of the displaced water is not included (see the force term added_mass).
  double mass = 0.035;
  /// Immersion depth, m: height of the face that the water pushes on, in Eq. 5.
  double draught = 0.035;
  /// Whether a face that a latched neighbour covers feels no drag.
  bool shadowing = true;
  /// Moment of inertia about the centre, kg m^2: m a^2 / 6 of a uniform square.
  double inertia() const { return mass * side * side / 6; }
};

/// A ball of the flow measurements: a disc that does not rotate and has no latches.
struct BallParameters {
  /// Balls in the tank: bodies [module.count, module.count + count).
  int count = 0;
  /// m
  double radius = 0.015;
  /// kg
  double mass = 0.0131;
  /// Wetted cross-section in the drag law, m^2.
  double drag_area = 7e-4;
};

/// Contacts between bodies, and between a body and the wall: Coulomb friction and Newton's
/// restitution, solved by sequential impulses (src/physics/contact_solver.hpp).
struct ContactParameters {
  /// Coulomb's coefficient, the same for all pairs and for the wall.
  double friction = 0.2;
  /// Separation speed divided by approach speed, 0 (inelastic) .. 1 (elastic).
  double restitution = 0.2;
  /// Approach speed below which restitution is 0, m/s, so that bodies at rest do not jitter.
  double restitution_speed = 0.01;
};

/// How the gusts xi of Eq. 4 are drawn for the drag points of a module. Each is a standard normal
/// per axis and holds for one tick.
enum class Gusts {
  /// One draw for each drag point [authors' simulation].
  per_point,
  /// One draw for the whole module [paper, Eq. 4 read literally].
  per_module,
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
  /// Factor on the field's mean and standard deviation; dimensionless.
  double K_v = 1.365;
  Gusts gusts = Gusts::per_point;
  FlowAt at = FlowAt::points;
  /// Density of the water, kg/m^3.
  double rho = 1000;
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
  /// Probability per tick that an idle module begins an exchange.
  double initiative = 0.1;
  /// Ticks that an initiator waits for the answer, 1 .. kMostReplyTicks.
  int reply_ticks = 5;
  /// Evaluations per bond, 1/s, of Clock::events.
  double evaluation_rate = 0.68;
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
  /// s from the start; of Model::commands.
  double at = 0;
  CommandKind kind = CommandKind::query;
  /// Modules that it addresses; empty: all.
  std::vector<int> modules;
  /// Index into Model::rulesets, of replace_ruleset.
  int ruleset = 0;
  /// Completed copies from which on it holds; of Model::feedback.
  int copies = 0;
  /// Of pump_power: 0 is Model::field, i is Model::other_fields[i - 1].
  int field = 0;
};

/// random: uniform in a disc. lattice: a square grid. poses: StartParameters::poses.
enum class Layout { random, lattice, poses };

/// Initial positions of the bodies. All start at rest with nothing latched.
struct StartParameters {
  Layout layout = Layout::random;
  /// Radius of the disc that holds all centres, m (random).
  double radius = 0.20;
  /// Least distance of two centres, m (random); pitch of the grid (lattice).
  double distance = 0.05;
  /// One for each body, modules first (poses).
  std::vector<Pose> poses;
};

/// Everything that a simulation does not change. The defaults are no valid model: begin with
/// standard_model() (start.hpp) or load_scenario() (scenario.hpp).
struct Model {
  /// Time step, s: kTick / steps_per_tick.
  double dt = kTick;
  /// Steps in a tick, 1 .. 256.
  int steps_per_tick = 1;
  TankParameters tank;
  ModuleParameters module;
  BallParameters ball;
  ContactParameters contact;
  FlowParameters flow;
  ControlParameters control;
  StartParameters start;
  /// The flow at the start; never null.
  std::shared_ptr<const FlowField> field;
  /// Flows at other pump powers, which pump_power commands set.
  std::vector<std::shared_ptr<const FlowField>> other_fields;
  /// Active force terms with their parameters, in the order of force_library(). The order of sums
  /// is part of the result's bits.
  std::vector<ActiveForce> forces;
  /// [0] is in force at the start. Empty: latched modules never separate.
  std::vector<Ruleset> rulesets;
  /// Commands by time, ascending.
  std::vector<Command> commands;
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
