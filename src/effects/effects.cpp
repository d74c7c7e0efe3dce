#include "effects/effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "effects/bond_effects.hpp"
#include "forces/library.hpp"
#include "lilytank/math.hpp"
#include "lilytank/model_parameter.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kRankOfBonds = 280;  // after contacts
constexpr double kOfWay = 0.9;             // to the bound of a parameter of the control
constexpr double kSlowest = 0.05;  // m/s, of water that curves over slip and spin are made for
constexpr int kPlaces = 6;         // on a circle, at which an effect that has a place is tried
constexpr double kPlacesAt = 0.45, kFarthestPlace = 0.8;  // of the tank's radius
const std::string kFriction = "contact.friction", kRestitution = "contact.restitution";

ParameterRef parameter_named(const ForceTerm& term, std::string_view name) {
  const std::span<const Parameter> all = term.parameters();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].name == name) return {&term, k};
  }
  throw std::logic_error("an effect of " + std::string(term.name()) + " has a parameter \"" +
                         std::string(name) + "\" that the term lacks");
}

Effect described(const ForceTerm& term, const EffectDescription& d, const Model& model) {
  Effect e;
  e.name = term.name(), e.equation = term.equation(), e.term = &term, e.variable = d.variable;
  e.negative_of = d.negative_of == nullptr ? nullptr : &d.negative_of();
  e.estimated = d.estimated, e.two_sided = d.two_sided, e.split = d.split, e.growth = d.growth;
  // The force of the negative differs from this one by its sign: scores of both would be the same.
  e.scored = d.scored && e.negative_of == nullptr, e.mean_force = d.mean_force;
  for (const auto& [name, size] : d.amplitudes) {
    if (name.empty()) continue;
    const ParameterRef of = parameter_named(term, name);
    e.paths.push_back(of.path()), e.sizes.push_back(size), e.units.emplace_back(of->unit);
  }
  const double edge = kFarthestPlace * model.tank.radius;
  for (const auto& [name, value, low, high, scanned_from] : d.held) {
    if (name.empty()) continue;
    const ParameterRef of = parameter_named(term, name);
    const std::string unit(of->unit);
    e.held.push_back({of, value});
    if (of->kind == ParameterKind::place) {
      e.refine.push_back({of.path(), unit, -edge, edge, false, false});
    } else if (low < high) {
      e.refine.push_back({of.path(), unit, low, high, true, false});
      const bool scanned = e.scored && e.estimated == Estimated::none && e.refine.size() == 1;
      if (scanned) e.scanned_from = scanned_from > 0 ? scanned_from : low;
    }
  }
  return e;
}

std::vector<Effect> at_places(const Effect& effect, const Model& model) {
  const auto whole = [](double place) { return std::round(place * 1e6) / 1e6; };  // um
  const double out = kPlacesAt * model.tank.radius, width = effect.held[2].value;
  std::vector<Effect> all;
  for (int k = 0; k < kPlaces; ++k) {
    const Rot at = rotation(2 * k * kPi / kPlaces);
    all.push_back(placed(effect, whole(out * at.c), whole(out * at.s), width));
  }
  return all;
}

// What the camera does to places, and contacts. No force stands behind these. Ranks as those of the
// force terms.
std::vector<std::pair<int, Effect>> effects_without_force() {
  Effect lens;
  lens.name = "lens_distortion", lens.paths = {kLens}, lens.sizes = {0.15};
  lens.units = {"1/m^2"}, lens.two_sided = true, lens.scored = lens.mean_force = false;
  lens.variable = "radius", lens.split = split_by::kGrid;
  lens.equation = "places are seen at x (1 + lens |x|^2)";
  Effect tilt = lens;
  tilt.name = "camera_tilt", tilt.paths = {kTiltX, kTiltY}, tilt.sizes = {0.03, 0.03};
  tilt.units = {"rad", "rad"}, tilt.variable = "position";
  tilt.equation = "the camera's axis leans; from 1 m above the water";
  Effect contact;
  contact.name = "contact_law", contact.paths = {kFriction, kRestitution};
  contact.sizes = {0.3, 0.4}, contact.units = {"1", "1"};
  contact.two_sided = true, contact.variable = "pair", contact.scored = contact.mean_force = false;
  contact.split = split_by::kLatches;
  return {{250, lens}, {260, tilt}, {270, contact}};
}

// Root mean square of the mean flow within the tank, m/s.
double usual_speed(const Model& model) {
  if (!model.field) return 0;
  const FlowField& field = *model.field;
  double sum = 0, count = 0;
  for (int i = 0; i < field.cells() * field.cells(); ++i) {
    const double pitch = 2 * field.extent() / field.cells();
    const double x = (i % field.cells() + 0.5) * pitch - field.extent();
    const double y = (i / field.cells() + 0.5) * pitch - field.extent();
    if (x * x + y * y > model.tank.radius * model.tank.radius) continue;
    const FlowSample u = field.at(x, y);
    sum += u.mu_x * u.mu_x + u.mu_y * u.mu_y, count += 1;
  }
  return model.flow.K_v * std::sqrt(sum / std::max(count, 1.0));
}

}  // namespace

bool Effect::camera() const {
  return !paths.empty() && of_camera(paths.front());
}

std::optional<ParameterRef> parameter_of(const ForceTerm& term, ParameterKind kind) {
  const std::span<const Parameter> all = term.parameters();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].kind == kind) return ParameterRef{&term, k};
  }
  return std::nullopt;
}

std::string Effect::variant() const {
  std::string out = joined(paths, ", ", own_name);
  for (const auto& [of, value] : held) {
    const std::string unit(of->unit);
    out += ", " + std::string(of->name) + " = " + significant(value, 2);
    if (unit != "1") out += " " + unit;
  }
  return out;
}

double Effect::absent(const Model& model, std::size_t component) const {
  const std::string& path = paths[component];
  const bool of_force = path.starts_with("forces.") || of_camera(path);
  return of_force ? 0 : parameter_value(model, path);
}

double Effect::value(const Model& model, std::size_t component, double amplitude) const {
  const double by = amplitude * sizes[component], none = absent(model, component);
  return logarithmic(component) ? none * exp_portable(by) : none + by;
}

double Effect::amplitude(const Model& model, std::size_t component, double value) const {
  const double none = absent(model, component);
  const double by = logarithmic(component) ? log_portable(value / none) : value - none;
  return by / sizes[component];
}

Eigen::VectorXd Effect::within(const Eigen::VectorXd& amplitudes) const {
  return amplitudes.cwiseMin(kOfWay * high).cwiseMax(kOfWay * low);
}

Effect together(const std::vector<Effect>& effects) {
  Effect out;
  for (const Effect& e : effects) {
    out.name += (out.name.empty() ? "" : " + ") + e.name;
    out.paths.insert(out.paths.end(), e.paths.begin(), e.paths.end());
    out.sizes.insert(out.sizes.end(), e.sizes.begin(), e.sizes.end());
    out.units.insert(out.units.end(), e.units.begin(), e.units.end());
    for (std::size_t c = 0; c < e.paths.size(); ++c) out.logarithms.push_back(e.logarithmic(c));
    out.held.insert(out.held.end(), e.held.begin(), e.held.end());
    out.two_sided = out.two_sided || e.two_sided;
  }
  return out;
}

Effect placed(Effect effect, double x, double y, double width) {
  effect.held[0].value = x, effect.held[1].value = y, effect.held[2].value = width;
  return effect;
}

std::vector<Effect> effect_catalogue(const Model& model) {
  // By rank, number among those of the term, and place in the library: ranges of one law and its
  // negative alternate.
  using Place = std::array<std::size_t, 3>;
  std::vector<std::pair<Place, Effect>> all;
  const auto library = force_library();
  for (std::size_t t = 0; t < library.size(); ++t) {
    const std::span<const EffectDescription> own = library[t]->effects();
    for (std::size_t k = 0; k < own.size(); ++k) {
      const Place place{static_cast<std::size_t>(own[k].order), k, t};
      Effect effect = described(*library[t], own[k], model);
      if (effect.estimated == Estimated::place) {
        for (Effect& e : at_places(effect, model)) all.emplace_back(place, std::move(e));
      } else {
        all.emplace_back(place, std::move(effect));
      }
    }
  }
  for (auto& [order, e] : effects_without_force()) {
    all.emplace_back(Place{static_cast<std::size_t>(order), 0, library.size()}, std::move(e));
  }
  for (Effect& e : bond_effects(model)) {
    all.emplace_back(Place{kRankOfBonds, 0, library.size()}, std::move(e));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Effect> out;
  std::map<std::string, int> families;
  for (auto& [place, e] : all) {
    e.family = families.emplace(e.name, static_cast<int>(families.size())).first->second;
    out.push_back(std::move(e));
  }
  return out;
}

Model with_effect(const Model& model, const Effect& effect, const std::vector<double>& amplitudes) {
  if (effect.camera()) return model;
  Model out = model;
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    const ModelParameter of = model_parameter(effect.paths[i]);
    of.set(out, std::clamp(amplitudes[i], of.low, of.high));
  }
  for (const auto& [of, value] : effect.held) {
    for (ActiveForce& active : out.forces) {
      if (active.term == of.term) active.p[of.index] = value;
    }
  }
  return out;
}

std::vector<Shape> shape_catalogue(const Model& model, double seconds) {
  const double R = model.tank.radius, force_size = 2e-3, torque_size = 2e-5;
  std::vector<Shape> all;
  const auto add = [&](Along along, Toward toward, double low, double high, const char* variable,
                       const char* direction, const char* unit) {
    const double size = toward == Toward::torque ? torque_size : force_size;
    all.push_back({{along, toward, low, high}, variable, direction, unit, size});
  };
  const double inner = 0.15 * R, outer = R - model.module.side;
  add(Along::radius, Toward::out, inner, outer, "radius", "outwards", "m");
  add(Along::radius, Toward::around, inner, outer, "radius", "around the centre", "m");
  add(Along::radius, Toward::torque, inner, outer, "radius", "as a torque", "m");
  add(Along::heading, Toward::torque, -kPi, kPi, "heading", "as a torque", "rad");
  add(Along::heading, Toward::x, -kPi, kPi, "heading", "along x", "rad");
  add(Along::heading, Toward::y, -kPi, kPi, "heading", "along y", "rad");
  // Where 99 % of the spins and slips are: knots beyond would say nothing, and leave those between
  // too few.
  const double speed = std::max(usual_speed(model), kSlowest);
  const double turning = 3.2 * speed / R, slow = 0.2 * speed, fast = 0.9 * speed;
  add(Along::spin, Toward::torque, -turning, turning, "spin", "as a torque", "rad/s");
  add(Along::spin, Toward::across_slip, -turning, turning, "spin", "across the slip", "rad/s");
  add(Along::slip, Toward::slip, slow, fast, "slip", "along the slip", "m/s");
  add(Along::slip, Toward::across_slip, slow, fast, "slip", "across the slip", "m/s");
  add(Along::slip, Toward::torque, slow, fast, "slip", "as a torque", "m/s");
  add(Along::time, Toward::x, 0, seconds, "time", "along x", "s");
  add(Along::time, Toward::y, 0, seconds, "time", "along y", "s");
  add(Along::time, Toward::slip, 0, seconds, "time", "along the slip", "s");
  add(Along::time, Toward::torque, 0, seconds, "time", "as a torque", "s");
  add(Along::gap, Toward::out, 0, 0.06, "pair", "apart", "m");
  add(Along::gap, Toward::around, 0, 0.06, "pair", "around each other", "m");
  add(Along::gap, Toward::torque, 0, 0.06, "pair", "as a torque", "m");
  const double wide = 0.7 * R;
  add(Along::x, Toward::x, -wide, wide, "position", "along x", "m");
  add(Along::x, Toward::y, -wide, wide, "position", "along y", "m");
  add(Along::y, Toward::x, -wide, wide, "position", "along x", "m");
  add(Along::y, Toward::y, -wide, wide, "position", "along y", "m");
  add(Along::x, Toward::torque, -wide, wide, "position", "as a torque", "m");
  add(Along::y, Toward::torque, -wide, wide, "position", "as a torque", "m");
  return all;
}

Effect effect_of(const Shape& shape) {
  const ForceTerm& term = empirical_force();
  const auto parameter = [&](std::size_t index) { return ParameterRef{&term, index}; };
  Effect e;
  e.name = term.name(), e.term = &term, e.curve = shape.curve;
  e.variable = shape.variable, e.two_sided = true;
  const std::string unit = shape.curve.toward == Toward::torque ? "N m" : "N";
  for (std::size_t k = 0; k < kKnots; ++k) {
    e.paths.push_back(parameter(kFirstKnot + k).path());
    e.sizes.push_back(shape.size), e.units.push_back(unit);
  }
  const double held[kFirstKnot] = {static_cast<double>(shape.curve.along),
                                   static_cast<double>(shape.curve.toward), shape.curve.low,
                                   shape.curve.high};
  for (std::size_t k = 0; k < kFirstKnot; ++k) e.held.push_back({parameter(k), held[k]});
  return e;
}

}  // namespace lilytank
