#include "diagnose/effects.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/model_parameter.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

std::string force(const std::string& term, const std::string& parameter) {
  return "forces." + term + "." + parameter;
}

Effect one(const std::string& name, const std::string& parameter, double size,
           const std::string& unit, const std::string& variable) {
  Effect e;
  e.name = name, e.paths = {force(name, parameter)}, e.sizes = {size}, e.units = {unit};
  e.variable = variable;
  return e;
}

// An amplitude along each of two axes.
Effect two(const std::string& name, const std::string& first, const std::string& second,
           double size, const std::string& unit, const std::string& variable) {
  Effect e = one(name, first, size, unit, variable);
  e.paths.push_back(force(name, second)), e.sizes.push_back(size), e.units.push_back(unit);
  e.two_sided = true;
  return e;
}

constexpr double kSlowest = 0.05;  // m/s, of water that curves over slip and spin are made for
constexpr const char* kLogLatches = "latches off, or their times logged";
constexpr const char* kLonely = "a recording of one module alone";
constexpr const char* kOtherBody = "a recording of bodies of another shape or mass";
constexpr const char* kTurnedCamera = "a recording with the camera turned by half a turn";
constexpr const char* kGrid = "a picture of a square grid on the water";
constexpr const char* kPumps = "a recording at another pump power";

void add_pairs(std::vector<Effect>& all) {
  for (const double range : {0.004, 0.012, 0.03}) {
    for (const char* name : {"pair_attraction", "pair_repulsion"}) {
      Effect e = one(name, "strength", 5e-3, "N", "pair");
      e.shape = {{force(name, "range"), range}};
      e.refine = {{force(name, "range"), "m", 0.0015, 0.08, true, false}};
      e.split = kLogLatches;
      e.scored = name[5] == 'a';  // the other one's force is this one's, turned round
      all.push_back(e);
    }
  }
  Effect magnet = one("magnetic_dipole", "strength", 0.012, "N", "pair");
  magnet.split = kLonely;
  all.push_back(magnet);
  magnet.shape = {{force("magnetic_dipole", "angle"), kPi / 2}};
  all.push_back(magnet);
  Effect stick = one("latch_stick", "strength", 0.02, "N", "pair");
  stick.split = kLogLatches;
  all.push_back(stick);
  Effect film = one("lubrication", "coefficient", 0.15, "N s/m", "pair");
  film.split = kLonely;
  all.push_back(film);
  Effect lee = one("wake_shielding", "share", 0.4, "1", "pair");
  lee.split = kLonely;
  all.push_back(lee);
}

void add_walls(std::vector<Effect>& all) {
  for (const double range : {0.005, 0.02}) {
    Effect e = one("wall_force", "strength", range < 0.01 ? 0.01 : 5e-3, "N", "radius");
    e.shape = {{force("wall_force", "range"), range}};
    e.refine = {{force("wall_force", "range"), "m", 0.002, 0.05, true, false}};
    e.two_sided = true, e.split = kOtherBody;
    all.push_back(e);
  }
  Effect layer = one("wall_layer", "share", 0.6, "1", "radius");
  layer.shape = {{force("wall_layer", "thickness"), 0.02}};
  layer.refine = {{force("wall_layer", "thickness"), "m", 0.005, 0.08, true, false}};
  layer.split = kOtherBody;
  all.push_back(layer);
}

void add_water(std::vector<Effect>& all, const Model& model) {
  // More would gather all modules in the middle: what less of it does could not be learned there.
  Effect mass = one("added_mass", "coefficient", 0.25, "1", "slip");
  mass.split = kOtherBody, mass.growth = 2;
  all.push_back(mass);
  Effect magnus = one("magnus_lift", "coefficient", 0.3, "1", "spin");
  magnus.two_sided = true;
  all.push_back(magnus);
  Effect viscous = one("viscous_drag", "coefficient", 0.03, "N s/m", "slip");
  viscous.two_sided = true, viscous.split = kPumps, viscous.growth = 2;
  all.push_back(viscous);
  Effect turning = one("rotational_drag", "coefficient", 5e-6, "N m s", "spin");
  turning.two_sided = true;
  all.push_back(turning);
  Effect coriolis = one("coriolis", "rate", 0.4, "1/s", "slip");
  coriolis.two_sided = true, coriolis.split = kTurnedCamera;
  all.push_back(coriolis);
  Effect push = two("body_force", "force_x", "force_y", 1.5e-3, "N", "position");
  push.split = kTurnedCamera;
  all.push_back(push);
  Effect drift = one("flow_drift", "rate", 5e-4, "1/s", "time");
  drift.two_sided = true;
  all.push_back(drift);
  const double out = 0.45 * model.tank.radius;
  for (int k = 0; k < 6; ++k) {
    const Rot at = rotation(k * kPi / 3);
    const auto whole = [](double place) { return std::round(place * 1e6) / 1e6; };  // um
    all.push_back(stream_effect(model, whole(out * at.c), whole(out * at.s), 0.06));
  }
}

void add_modules(std::vector<Effect>& all) {
  all.push_back(two("self_propulsion", "force_x", "force_y", 1e-3, "N", "heading"));
  Effect torque = one("spin_torque", "torque", 1.2e-5, "N m", "spin");
  torque.two_sided = true;
  all.push_back(torque);
  all.push_back(two("mass_offset", "forward", "left", 1e-3, "m", "heading"));
  Effect heavy = one("heterogeneous_module", "extra", 0.4, "1", "module");
  heavy.scored = heavy.mean_force = false, heavy.growth = 2;
  all.push_back(heavy);
}

// Effects without a mean force: they change how innovations scatter.
void add_noise(std::vector<Effect>& all) {
  Effect pumps = one("flow_pulsation", "share", 0.15, "1", "time");
  pumps.shape = {{force("flow_pulsation", "frequency"), 0.9}};
  pumps.scored = pumps.mean_force = false, pumps.growth = 2;
  all.push_back(pumps);
  for (const double time : {0.25, 1.0}) {
    for (const double length : {0.03, 0.08}) {
      Effect eddies = one("correlated_gusts", "share", 0.15, "1", "lag");
      eddies.shape = {{force("correlated_gusts", "time"), time},
                      {force("correlated_gusts", "length"), length}};
      eddies.refine = {{force("correlated_gusts", "time"), "s", 0.08, 3, true, false},
                       {force("correlated_gusts", "length"), "m", 0.01, 0.25, true, false}};
      eddies.scored = eddies.mean_force = false;
      all.push_back(eddies);
    }
  }
  for (const double frequency : {0.3, 0.8}) {
    Effect vortices = one("vortex_shedding", "coefficient", 0.8, "1", "lag");
    vortices.shape = {{force("vortex_shedding", "frequency"), frequency}};
    vortices.refine = {{force("vortex_shedding", "frequency"), "Hz", 0.1, 3, true, false}};
    vortices.scored = vortices.mean_force = false, vortices.growth = 2;
    all.push_back(vortices);
  }
  for (const char* by : {"by_radius", "by_slip"}) {
    const bool radius = by[3] == 'r';
    Effect e = one("state_dependent_noise", by, radius ? 0.012 : 0.06, radius ? "N" : "N s/m",
                   radius ? "radius" : "slip");
    e.scored = e.mean_force = false, e.growth = 2;
    all.push_back(e);
  }
  Effect kicks = one("heavy_tailed_kicks", "impulse", 1.5e-3, "N s", "lag");
  kicks.scored = kicks.mean_force = false, kicks.growth = 2;
  all.push_back(kicks);
}

// What the camera does to places. No force stands behind it.
void add_camera(std::vector<Effect>& all) {
  Effect lens;
  lens.name = "lens_distortion", lens.paths = {kLens}, lens.sizes = {0.15};
  lens.units = {"1/m^2"}, lens.two_sided = true, lens.scored = lens.mean_force = false;
  lens.variable = "radius", lens.split = kGrid;
  all.push_back(lens);
  Effect tilt = lens;
  tilt.name = "camera_tilt", tilt.paths = {kTiltX, kTiltY}, tilt.sizes = {0.03, 0.03};
  tilt.units = {"rad", "rad"}, tilt.variable = "position";
  all.push_back(tilt);
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

std::string Effect::variant() const {
  std::string out = joined(paths, ", ", own_name);
  for (const auto& [path, value] : shape) {
    const std::string unit = model_parameter(path).unit;
    out += ", " + own_name(path) + " = " + significant(value, 2) + (unit == "1" ? "" : " " + unit);
  }
  return out;
}

double Effect::absent(const Model& model, std::size_t component) const {
  return paths[component].rfind("contact.", 0) == 0 ? parameter_value(model, paths[component]) : 0;
}

Effect together(const std::vector<Effect>& effects) {
  Effect out;
  for (const Effect& e : effects) {
    out.name += (out.name.empty() ? "" : " + ") + e.name;
    out.paths.insert(out.paths.end(), e.paths.begin(), e.paths.end());
    out.sizes.insert(out.sizes.end(), e.sizes.begin(), e.sizes.end());
    out.units.insert(out.units.end(), e.units.begin(), e.units.end());
    out.shape.insert(out.shape.end(), e.shape.begin(), e.shape.end());
    out.two_sided = out.two_sided || e.two_sided;
  }
  return out;
}

Effect stream_effect(const Model& model, double x, double y, double width) {
  Effect stream = two("local_flow", "speed_x", "speed_y", 0.06, "m/s", "position");
  stream.shape = {{force("local_flow", "x"), x},
                  {force("local_flow", "y"), y},
                  {force("local_flow", "width"), width}};
  const double edge = 0.8 * model.tank.radius;
  stream.refine = {{force("local_flow", "x"), "m", -edge, edge, false, false},
                   {force("local_flow", "y"), "m", -edge, edge, false, false},
                   {force("local_flow", "width"), "m", 0.02, 0.2, true, false}};
  stream.split = kOtherBody;
  return stream;
}

std::vector<Effect> effect_catalogue(const Model& model) {
  std::vector<Effect> all;
  add_pairs(all), add_walls(all), add_water(all, model), add_modules(all), add_noise(all);
  add_camera(all);
  Effect contact;
  contact.name = "contact_law", contact.paths = {"contact.friction", "contact.restitution"};
  contact.sizes = {0.3, 0.4}, contact.units = {"1", "1"};
  contact.two_sided = true, contact.variable = "pair", contact.scored = contact.mean_force = false;
  contact.split = kLogLatches;
  all.push_back(contact);
  return all;
}

Model with_effect(const Model& model, const Effect& effect, const std::vector<double>& amplitudes) {
  if (effect.camera()) return model;
  std::vector<double> values = amplitudes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ModelParameter of = model_parameter(effect.paths[i]);
    values[i] = std::clamp(values[i], of.low, of.high);
  }
  Model out = with_parameters(model, effect.paths, values);
  for (const auto& [path, value] : effect.shape) {
    const auto dot = path.rfind('.');
    const std::string term = path.substr(7, dot - 7), parameter = path.substr(dot + 1);
    for (ActiveForce& active : out.forces) {
      if (active.term->name() != term) continue;
      const auto parameters = active.term->parameters();
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (parameters[k].name == parameter) active.p[k] = value;
      }
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
  Effect e;
  e.name = "empirical_force", e.variable = shape.variable, e.two_sided = true;
  const std::string unit = shape.curve.toward == Toward::torque ? "N m" : "N";
  for (int k = 1; k <= kKnots; ++k) {
    e.paths.push_back(force(e.name, "v" + std::to_string(k)));
    e.sizes.push_back(shape.size), e.units.push_back(unit);
  }
  e.shape = {{force(e.name, "variable"), static_cast<int>(shape.curve.along)},
             {force(e.name, "direction"), static_cast<int>(shape.curve.toward)},
             {force(e.name, "low"), shape.curve.low},
             {force(e.name, "high"), shape.curve.high}};
  return e;
}

}  // namespace lilytank
