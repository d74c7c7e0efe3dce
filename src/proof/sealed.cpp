#include "proof/sealed.hpp"

#include <algorithm>
#include <memory>

#include "forces/library.hpp"
#include "lilytank/emulator.hpp"
#include "lilytank/model_parameter.hpp"
#include "lilytank/random.hpp"
#include "lilytank/state.hpp"
#include "proof/foreign_tank.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kOff = 0.08;        // relative error of the parameters of a synthetic experiment
constexpr double kOtherTank = 1.25;  // factor by which a drawn tank's parameters are off at most
constexpr double kOtherShape = 1.5;  // factor by which a range of the catalogue is off at most
constexpr double kPlaces = 0.5;      // of the radius, that a place is off along each axis at most
constexpr double kMissed = 0.01;     // share of the frames in which a body is not seen

double draw(std::uint64_t seed, int world, std::uint32_t which) {
  return uniform({seed, Stream::calibrate, world, which, 30});
}

// A law that the catalogue does not have: a curve of one variable.
Shape odd_law(const std::vector<Shape>& shapes, std::uint64_t seed, int world) {
  std::vector<Shape> odd;
  for (const Shape& s : shapes) {
    const ForceCurve& c = s.curve;
    const bool torque = c.toward == Toward::torque && c.along != Along::x && c.along != Along::y;
    if (torque || (c.toward == Toward::across_slip && c.along == Along::slip)) odd.push_back(s);
  }
  return odd[static_cast<std::size_t>(draw(seed, world, 1) * static_cast<double>(odd.size()))];
}

SealedEffect odd_effect(const Shape& shape, std::uint64_t seed, int world) {
  SealedEffect out{-1, effect_of(shape), {}};
  const double phase = 2 * kPi * draw(seed, world, 2), size = 0.5 + 1.5 * draw(seed, world, 3);
  for (int k = 0; k < kKnots; ++k) {
    out.amplitudes.push_back(size * rotation(phase + 2 * kPi * k / kKnots).c);
  }
  return out;
}

// The value of a parameter in a synthetic experiment, by a random number from 0 to 1.
double displaced(const HeldParameter& held, const Model& tank, double u) {
  const double both = 2 * u - 1;
  switch (held.of->kind) {
    case ParameterKind::place:
      return kPlaces * tank.tank.radius * both;
    case ParameterKind::module:
      return std::floor(u * tank.module.count);
    case ParameterKind::phase:
      return kPi * both;
    case ParameterKind::direction:
      return held.value;
    default:
      return held.value * exp_portable(both * log_portable(kOtherShape));
  }
}

// Ranges, times, lengths, frequencies and places are not those of the catalogue.
void displace(Effect& e, const Model& tank, std::uint64_t seed, int world, std::uint32_t first) {
  if (e.term == nullptr) return;
  std::map<std::string, HeldParameter> other;
  for (std::size_t k = 0; k < e.term->parameters().size(); ++k) {
    const ParameterRef of{e.term, k};
    other[of.path()] = {of, of->standard};
  }
  for (const std::string& path : e.paths) other.erase(path);
  for (const HeldParameter& one : e.held) other[one.of.path()] = one;
  e.held.clear();
  std::uint32_t k = first + 20;
  for (auto& [path, one] : other) {
    one.value = displaced(one, tank, draw(seed, world, k++));
    e.held.push_back(one);
  }
}

// `number`: of the draw.
SealedEffect drawn_effect(const std::vector<Effect>& effects, const Model& tank, std::uint64_t seed,
                          int world, std::uint32_t number) {
  const std::uint32_t first = 100 * number;
  const auto which =
      static_cast<std::size_t>(draw(seed, world, first + 1) * static_cast<double>(effects.size()));
  SealedEffect out{static_cast<int>(which), effects[which], {}};
  for (std::uint32_t c = 0; c < out.effect.paths.size(); ++c) {
    const double size = 0.4 + 1.6 * draw(seed, world, first + 4 + 2 * c);
    const bool negative = out.effect.two_sided && draw(seed, world, first + 5 + 2 * c) < 0.5;
    out.amplitudes.push_back(
        out.effect.within(Eigen::VectorXd::Constant(1, negative ? -size : size))(0));
  }
  displace(out.effect, tank, seed, world, first);
  return out;
}

// Whether two effects can be there at once: other terms, and none of the camera's, which would be
// the verdict.
bool beside(const Effect& a, const Effect& b) {
  const bool other = a.term != b.term || (a.term == nullptr && a.name != b.name);
  return !a.camera() && !b.camera() && other;
}

bool may_be_two(const std::vector<Effect>& effects) {
  return std::ranges::any_of(effects, [&](const Effect& a) {
    return std::ranges::any_of(effects, [&](const Effect& b) { return beside(a, b); });
  });
}

// Amplitudes in their own units.
std::vector<double> strengths(const SealedEffect& e, const Model& model) {
  std::vector<double> out;
  for (std::size_t c = 0; c < e.amplitudes.size(); ++c) {
    out.push_back(e.effect.value(model, c, e.amplitudes[c]));
  }
  return out;
}

// The five parameters, by path.
std::map<std::string, double> baseline_of(const Model& tank, const Sealed& s) {
  std::map<std::string, double> out;
  const std::vector<FitParameter> five = standard_parameters(BodyKind::lily);
  for (std::size_t k = 0; k < five.size(); ++k) {
    out[five[k].path] =
        std::clamp(s.factors[k] * parameter_value(tank, five[k].path), five[k].low, five[k].high);
  }
  return out;
}

Model with_parameters(const Model& model, const std::map<std::string, double>& values) {
  std::vector<std::string> paths;
  std::vector<double> numbers;
  for (const auto& [path, value] : values) paths.push_back(path), numbers.push_back(value);
  return with_parameters(model, paths, numbers);
}

}  // namespace

RecordingShape shape_named(const std::string& name, BodyKind body, int bodies, double seconds) {
  RecordingShape shape;
  shape.name = name, shape.body = body, shape.bodies = bodies;
  shape.frames = static_cast<int>(std::lround(seconds * kSealedRate)) + 1, shape.rate = kSealedRate;
  shape.headings = body == BodyKind::lily, shape.missing = kMissed;
  return shape;
}

Model tank_model() {
  Model model = standard_model();
  model.flow.K_v = 1, model.module.draught = 0.025;
  model.control.latches = false;
  // The water is extracted with the drag of a sphere: the balls must have it.
  for (ActiveForce& force : model.forces) {
    if (force.term == &ball_drag()) force.p[0] = BallPhysics{}.drag_coefficient;
  }
  return model;
}

DrawnTank drawn_tank(std::uint64_t seed) {
  const auto draw = [seed](std::uint32_t which) {
    return uniform({seed, Stream::calibrate, 0, which, 31});
  };
  DrawnTank out;
  out.water.pump_power = 50 + 35 * draw(0);
  out.water.water_level = -0.07 - 0.02 * draw(1);
  out.water.inlets = 3 + static_cast<int>(7 * draw(2));
  out.water.inlet_angle = kPi / 6 * draw(3);
  for (std::uint32_t k = 4; k < 8; ++k) {
    out.factors.push_back(exp_portable((2 * draw(k) - 1) * log_portable(kOtherTank)));
  }
  return out;
}

Model tank_model(const DrawnTank& tank) {
  Model model = tank_model();
  model.field =
      std::make_shared<const FlowField>(analytic_tank(tank.water, model.field->interpolation()));
  std::vector<std::string> paths;
  std::vector<double> values;
  for (const FitParameter& p : standard_parameters(BodyKind::lily)) {
    if (p.path == "flow.K_v") continue;
    values.push_back(
        std::clamp(tank.factors[paths.size()] * parameter_value(model, p.path), p.low, p.high));
    paths.push_back(p.path);
  }
  return with_parameters(model, paths, values);
}

std::string key_text(const DrawnTank& tank) {
  const AnalyticTank& w = tank.water;
  std::string out = "tank pump_power " + shortest(w.pump_power) + " water_level " +
                    shortest(w.water_level) + " inlets " + std::to_string(w.inlets) +
                    " inlet_angle " + shortest(w.inlet_angle);
  for (const double f : tank.factors) out += " " + shortest(f);
  return out + "\n";
}

Model with_steps(Model model, int steps) {
  model.steps_per_tick = steps, model.dt = kTick / steps;
  return model;
}

Sealed seal(const Model& tank, const std::vector<Effect>& effects, const std::vector<Shape>& shapes,
            std::uint64_t seed, int world) {
  Sealed out;
  out.world = world;
  for (std::uint32_t k = 0; k < 5; ++k) {
    out.factors.push_back(1 + kOff * (2 * draw(seed, world, 40 + k) - 1));
  }
  if (world % 4 == 0) {
    out.kind = "null";
    return out;
  }
  if (world % 8 == 7) {
    const Shape shape = odd_law(shapes, seed, world);
    out.kind = "unnamed", out.names = {shape.variable};
    out.effects.push_back(odd_effect(shape, seed, world));
    return out;
  }
  const bool two = world % 8 == 3 && may_be_two(effects);
  out.kind = two ? "two" : "named";
  std::uint32_t number = 0;
  const auto next = [&] { return drawn_effect(effects, tank, seed, world, number++); };
  out.effects.push_back(next());
  while (two && out.effects[0].effect.camera()) out.effects[0] = next();
  while (two && out.effects.size() < 2) {
    SealedEffect second = next();
    if (beside(out.effects[0].effect, second.effect)) out.effects.push_back(std::move(second));
  }
  for (const SealedEffect& e : out.effects) out.names.push_back(e.effect.name);
  return out;
}

std::string key_text(const Sealed& s) {
  std::string out = s.kind;
  for (std::size_t e = 0; e < s.effects.size(); ++e) {
    out += " " + s.names[e];
    for (const auto& [of, value] : s.effects[e].effect.held) {
      out += " " + of.path() + " " + shortest(value);
    }
    for (const double a : s.effects[e].amplitudes) out += " " + shortest(a);
  }
  for (const double f : s.factors) out += " " + shortest(f);
  return out + "\n";
}

std::optional<std::vector<Recording>> film_tank(const Model& model,
                                                const std::vector<std::string>& cameras,
                                                const std::vector<double>& seen,
                                                const std::vector<RecordingShape>& shapes,
                                                std::uint64_t seed, bool foreign) {
  EmulatorOptions options;
  options.moment_matched = false;
  if (foreign) options.engine = foreign_engine(), options.position_noise = kForeignNoise;
  auto out = Emulator(model, cameras, shapes, options).record(seen, seed);
  if (foreign && out) round_to_pixels(*out);
  return out;
}

std::optional<std::vector<Recording>> film_sealed(const Model& tank, const Sealed& s, int modules,
                                                  double seconds, int count, std::uint64_t seed) {
  Model model = with_steps(tank, kSealedSteps);
  model = with_parameters(model, baseline_of(model, s));
  std::vector<std::string> cameras;
  std::vector<double> seen;
  for (const SealedEffect& e : s.effects) {
    const std::vector<double> amplitudes = strengths(e, model);
    model = with_effect(model, e.effect, amplitudes);
    if (!e.effect.camera()) continue;
    cameras.insert(cameras.end(), e.effect.paths.begin(), e.effect.paths.end());
    seen.insert(seen.end(), amplitudes.begin(), amplitudes.end());
  }
  RecordingShape shape = shape_named("synthetic", BodyKind::lily, modules, seconds);
  shape.latches = tank.control.latches, shape.logged = shape.latches && s.logged;
  const std::vector<RecordingShape> shapes(static_cast<std::size_t>(count), shape);
  return film_tank(model, cameras, seen, shapes, seed, s.foreign);
}

std::optional<std::vector<Recording>> film_sealed(const Model& tank, const Sealed& s,
                                                  double seconds, std::uint64_t seed) {
  return film_sealed(tank, s, tank.module.count, seconds, kSealedRecordings, seed);
}

std::map<std::string, double> truth_of(const Model& tank, const Sealed& s) {
  std::map<std::string, double> out = baseline_of(tank, s);
  for (const SealedEffect& e : s.effects) {
    const std::vector<double> amplitudes = strengths(e, tank);
    for (std::size_t c = 0; c < amplitudes.size(); ++c) out[e.effect.paths[c]] = amplitudes[c];
    for (const auto& [of, value] : e.effect.held) out[of.path()] = value;
  }
  return out;
}

}  // namespace lilytank
