#include "diagnose/sealed.hpp"

#include <algorithm>

#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/state.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kOff = 0.08;  // share by which parameters of a sealed world are off

double draw(std::uint64_t seed, int world, std::uint32_t which) {
  return uniform({seed, Stream::calibrate, world, which, 30});
}

// A law that the catalogue does not have: a curve of one variable.
Shape odd_law(const std::vector<Shape>& shapes, std::uint64_t seed, int world) {
  std::vector<Shape> odd;
  for (const Shape& s : shapes) {
    const bool torque = s.curve.toward == Toward::torque;
    const bool across = s.curve.toward == Toward::across_slip;
    if ((torque && s.variable != "position") || (across && s.variable == "slip")) odd.push_back(s);
  }
  return odd[static_cast<std::size_t>(draw(seed, world, 1) * static_cast<double>(odd.size()))];
}

}  // namespace

RecordingShape shape_named(const std::string& name, BodyKind body, int bodies, double seconds) {
  RecordingShape shape;
  shape.name = name, shape.body = body, shape.bodies = bodies;
  shape.frames = static_cast<int>(std::lround(seconds * kSealedRate)) + 1, shape.rate = kSealedRate;
  shape.headings = body == BodyKind::lily;
  return shape;
}

Model tank_model() {
  Model model = standard_model();
  model.flow.K_v = 1, model.module.draught = 0.025;
  model.control.latches = false;
  // The water is extracted with the drag of a sphere: the balls must have it.
  for (ActiveForce& force : model.forces) {
    if (force.term->name() == "ball_drag") force.p[0] = BallPhysics{}.drag_coefficient;
  }
  return model;
}

Model with_steps(Model model, int steps) {
  model.steps_per_tick = steps, model.dt = kTick / steps;
  return model;
}

Sealed seal(const std::vector<Effect>& effects, const std::vector<Shape>& shapes,
            std::uint64_t seed, int world) {
  Sealed out;
  for (std::uint32_t k = 0; k < 5; ++k) {
    out.factors.push_back(1 + kOff * (2 * draw(seed, world, 40 + k) - 1));
  }
  if (world % 4 == 0) {
    out.key.kind = "null";
    return out;
  }
  const bool odd = world % 8 == 7;
  out.key.kind = odd ? "unnamed" : "named";
  if (odd) {
    const Shape shape = odd_law(shapes, seed, world);
    out.effect = effect_of(shape), out.key.effect = shape.variable;
    const double phase = 2 * kPi * draw(seed, world, 2), size = 0.5 + 1.5 * draw(seed, world, 3);
    for (int k = 0; k < kKnots; ++k) {
      out.key.amplitudes.push_back(size * rotation(phase + 2 * kPi * k / kKnots).c);
    }
    return out;
  }
  out.effect =
      effects[static_cast<std::size_t>(draw(seed, world, 1) * static_cast<double>(effects.size()))];
  out.key.effect = out.effect.name;
  for (std::uint32_t c = 0; c < out.effect.paths.size(); ++c) {
    const double size = 0.4 + 1.6 * draw(seed, world, 4 + 2 * c);
    const bool negative = out.effect.two_sided && draw(seed, world, 5 + 2 * c) < 0.5;
    out.key.amplitudes.push_back(negative ? -size : size);
  }
  return out;
}

std::string key_text(const Sealed& s) {
  std::string out = s.key.kind + " " + s.key.effect;
  for (const auto& [path, value] : s.effect.shape) out += " " + path + " " + shortest(value);
  for (const double a : s.key.amplitudes) out += " " + shortest(a);
  for (const double f : s.factors) out += " " + shortest(f);
  return out + "\n";
}

std::optional<std::vector<Recording>> film_sealed(const Model& tank, const Sealed& s,
                                                  double seconds, std::uint64_t seed) {
  Model model = with_steps(tank, kSealedSteps);
  std::vector<std::string> paths;
  std::vector<double> values;
  const std::vector<FitParameter> five = standard_parameters(BodyKind::lily);
  for (std::size_t k = 0; k < five.size(); ++k) {
    paths.push_back(five[k].path);
    values.push_back(
        std::clamp(s.factors[k] * parameter_value(model, five[k].path), five[k].low, five[k].high));
  }
  model = with_parameters(model, paths, values);
  std::vector<double> amplitudes;
  for (std::size_t c = 0; c < s.effect.paths.size(); ++c) {
    amplitudes.push_back(s.effect.absent(model, c) + s.key.amplitudes[c] * s.effect.sizes[c]);
  }
  if (!amplitudes.empty()) model = with_effect(model, s.effect, amplitudes);
  if (!s.effect.camera()) amplitudes.clear();
  std::vector<RecordingShape> shapes(
      kSealedRecordings, shape_named("sealed", BodyKind::lily, model.module.count, seconds));
  EmulatorOptions options;
  options.moment_matched = false;
  const auto varied = amplitudes.empty() ? std::vector<std::string>{} : s.effect.paths;
  return Emulator(model, varied, shapes, options).record(amplitudes, seed);
}

std::map<std::string, double> truth_of(const Model& tank, const Sealed& s) {
  std::map<std::string, double> out;
  const std::vector<FitParameter> five = standard_parameters(BodyKind::lily);
  for (std::size_t k = 0; k < five.size(); ++k) {
    out[five[k].path] =
        std::clamp(s.factors[k] * parameter_value(tank, five[k].path), five[k].low, five[k].high);
  }
  for (std::size_t c = 0; c < s.effect.paths.size(); ++c) {
    out[s.effect.paths[c]] = s.effect.absent(tank, c) + s.key.amplitudes[c] * s.effect.sizes[c];
  }
  for (const auto& [path, value] : s.effect.shape) out[path] = value;
  return out;
}

}  // namespace lilytank
