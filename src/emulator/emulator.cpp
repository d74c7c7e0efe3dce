#include "lilytank/emulator.hpp"

#include <algorithm>
#include <cmath>

#include "emulator/initial_assemblies.hpp"
#include "lilytank/camera.hpp"
#include "lilytank/random.hpp"
#include "lilytank/start.hpp"
#include "lilytank/world.hpp"

namespace lilytank {

struct Emulator::Scene {
  Model model;
  Camera camera;
};

namespace {

struct CameraParameter {
  ParameterInfo info;
  double CameraNumbers::*number;
};

const CameraParameter* camera_parameter(const std::string& path) {
  using N = CameraNumbers;
  static const std::vector<CameraParameter> all{
      {{kPositionNoise, "m", 0, 0.1, "standard error of a position"}, &N::position_noise},
      {{kHeadingNoise, "rad", 0, 1, "standard error of a heading"}, &N::heading_noise},
      {{kLens, "1/m^2", -1.5, 1.5, "places are seen at x (1 + lens |x|^2)"}, &N::lens},
      {{kTiltX, "rad", -0.3, 0.3, "the camera leans towards +x"}, &N::tilt_x},
      {{kTiltY, "rad", -0.3, 0.3, "the camera leans towards +y"}, &N::tilt_y},
  };
  for (const CameraParameter& one : all) {
    if (one.info.path == path) return &one;
  }
  return nullptr;
}

// The seed of a camera must differ from that of its world.
constexpr std::uint64_t kCameraRun = 1u << 20;

// How a simulated recording begins: as a frame of a recording, or at random.
struct Begin {
  const BodiesAt* start = nullptr;                // nullptr: at random
  const InitialAssemblies* assemblies = nullptr;  // nullptr: no frame shows bonds
  double settle = 0;                              // s before the first frame, of bodies at random
};

State state_at(const Model& model, const Begin& begin, std::uint64_t seed) {
  const BodiesAt& start = *begin.start;
  // Poses of a recording have noise: they may overlap by a millimetre, which the first step
  // resolves.
  State state = state_of_poses(model, start.pose, seed);
  for (std::size_t i = 0; i < start.twist.size(); ++i) {
    const Twist& twist = start.twist[i];
    state.vx[i] = twist.vx, state.vy[i] = twist.vy, state.omega[i] = twist.omega;
  }
  if (model.control.latches && begin.assemblies) begin.assemblies->bond(model, start, seed, state);
  return state;
}

// Events of two modules in the last step; the log begins at step `first`.
void log_events(const World& world, std::int64_t first, std::vector<LoggedEvent>& log) {
  for (const Event& e : world.events()) {
    if (e.kind > EventKind::update) continue;
    log.push_back({static_cast<double>(e.step + 1 - first) * world.model().dt, e.kind, e.a, e.b});
  }
}

// The world in which a recording begins. Bodies that start at random settle with their latches off:
// a simulated recording of self-assembly begins with single modules.
std::optional<World> begun(const Model& model, const Begin& begin, std::uint64_t seed) {
  if (begin.start != nullptr) return World(model, state_at(model, begin, seed));
  Model loose = model;
  loose.control.latches = false;
  World world(loose, seed);
  const auto steps = static_cast<std::int64_t>(std::llround(begin.settle / model.dt));
  for (std::int64_t step = 0; step < steps; ++step) {
    if (world.step() == RunStatus::diverged) return std::nullopt;
  }
  return World(model, world.state());
}

// Poses about each frame; nothing if the world diverges. Events go to `log` if there is one.
std::optional<Trajectory> moved(const Model& model, const Begin& begin, double seconds, double rate,
                                std::uint64_t seed, std::vector<LoggedEvent>* log) {
  std::optional<World> started = begun(model, begin, seed);
  if (!started) return std::nullopt;
  World& world = *started;
  const std::int64_t first = world.steps();
  Trajectory trajectory;
  const auto steps = static_cast<std::int64_t>(std::ceil(seconds / model.dt - 1e-9));
  append_poses(world, trajectory);
  for (std::int64_t step = 1; step <= steps; ++step) {
    if (world.step() == RunStatus::diverged) return std::nullopt;
    if (log != nullptr) log_events(world, first, *log);
    // A frame lies between two poses: the others are not seen.
    const double at = static_cast<double>(step) * model.dt;
    const double off = at - std::round(at * rate) / rate;
    if (step == steps || std::fabs(off) < model.dt * (1 + 1e-6)) append_poses(world, trajectory);
  }
  return trajectory;
}

}  // namespace

bool of_camera(const std::string& path) {
  return path.rfind("camera.", 0) == 0;
}

ParameterInfo emulator_parameter(const std::string& path) {
  const CameraParameter* camera = camera_parameter(path);
  return camera != nullptr ? camera->info : model_parameter(path);
}

Emulator::Parameter Emulator::parameter(const std::string& path) {
  if (const CameraParameter* camera = camera_parameter(path)) return camera->number;
  return model_parameter(path);
}

Emulator::Emulator(Model model, std::vector<std::string> paths, std::vector<RecordingShape> shapes,
                   const EmulatorOptions& options)
    : model_(std::move(model)),
      paths_(std::move(paths)),
      shapes_(std::move(shapes)),
      options_(options) {
  for (const std::string& path : paths_) parameters_.push_back(parameter(path));
  if (options_.moment_matched && model_.flow.gusts == Gusts::per_point &&
      model_.flow.at == FlowAt::points) {
    model_.flow.gusts = Gusts::moment_matched;
  }
  Model full = model_;
  for (const RecordingShape& shape : shapes_) {
    full.module.count = std::max(full.module.count, shape.bodies);
  }
  const auto bonded = [](const BodiesAt& start) { return !start.bonds.empty(); };
  if (std::ranges::any_of(shapes_, [&](const RecordingShape& shape) {
        return shape.latches && std::ranges::any_of(shape.starts, bonded);
      })) {
    assemblies_ = std::make_shared<const InitialAssemblies>(full);
  }
}

Emulator::Scene Emulator::scene(std::span<const double> values, const RecordingShape& shape,
                                const std::shared_ptr<const FlowField>& field) const {
  Scene out{model_, {}};
  CameraNumbers seen{options_.position_noise, options_.heading_noise};
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (const auto* number = std::get_if<ModelParameter>(&parameters_[i])) {
      number->set(out.model, values[i]);
    } else {
      seen.*std::get<double CameraNumbers::*>(parameters_[i]) = values[i];
    }
  }
  Camera& camera = out.camera;
  camera.position_noise = seen.position_noise, camera.heading_noise = seen.heading_noise;
  camera.lens = seen.lens, camera.tilt = std::hypot(seen.tilt_x, seen.tilt_y);
  if (camera.tilt > 0) camera.tilt_direction = std::atan2(seen.tilt_y, seen.tilt_x);
  if (field) out.model.field = field;
  const bool balls = shape.body == BodyKind::ball;
  out.model.module.count = balls ? 0 : shape.bodies;
  out.model.ball.count = balls ? shape.bodies : 0;
  out.model.control.latches = shape.latches;
  out.camera.rate = shape.rate, out.camera.missed = shape.missing;
  out.camera.headings = shape.headings;
  return out;
}

std::optional<Recording> Emulator::simulate(const Scene& scene, const RecordingShape& shape,
                                            const BodiesAt* start, double seconds,
                                            std::uint64_t seed) const {
  const double settle = start != nullptr ? 0 : options_.settle;
  std::vector<LoggedEvent> log;
  std::optional<Trajectory> trajectory =
      options_.engine && start == nullptr
          ? options_.engine(scene.model, settle, seconds, seed)
          : moved(scene.model, {start, assemblies_.get(), settle}, seconds, shape.rate, seed,
                  shape.logged ? &log : nullptr);
  if (!trajectory) return std::nullopt;
  Camera camera = scene.camera;
  camera.seed = derived_seed(seed, kCameraRun);
  Recording out = film(*trajectory, camera, shape.body);
  out.name = shape.name, out.latches = shape.latches;
  out.logged = shape.logged, out.events = std::move(log);
  return out;
}

std::optional<std::vector<Recording>> Emulator::record(
    std::span<const double> values, std::uint64_t seed,
    const std::shared_ptr<const FlowField>& field) const {
  std::vector<Recording> out;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const RecordingShape& shape = shapes_[i];
    const BodiesAt* start = shape.starts.empty() ? nullptr : &shape.starts.front();
    auto one = simulate(scene(values, shape, field), shape, start, (shape.frames - 1) / shape.rate,
                        derived_seed(seed, i));
    if (!one) return std::nullopt;
    out.push_back(std::move(*one));
  }
  return out;
}

std::optional<Recording> Emulator::piece(std::span<const double> values, std::uint64_t seed,
                                         std::int64_t replicate, double seconds) const {
  const auto r = static_cast<std::uint64_t>(replicate);
  const auto draw = random_bits({seed, Stream::calibrate, replicate, 0, 0});
  const RecordingShape& shape = shapes_[r % shapes_.size()];
  // A start from which the recording goes on for as long, so that the same time is compared.
  std::size_t usable = 0;
  while (usable < shape.starts.size() &&
         (shape.frames - 1 - shape.starts[usable].frame) / shape.rate >= seconds) {
    ++usable;
  }
  const BodiesAt* start =
      shape.starts.empty() ? nullptr : &shape.starts[usable == 0 ? 0 : (draw[0] * usable) >> 32];
  return simulate(scene(values, shape, nullptr), shape, start, seconds, derived_seed(seed, r));
}

}  // namespace lilytank
