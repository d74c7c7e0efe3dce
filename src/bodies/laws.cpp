// The library of laws, a row each, and what several of them share.
#include <algorithm>
#include <numbers>

#include "bodies/driver_laws.hpp"
#include "bodies/law_forces.hpp"
#include "math/knots.hpp"

namespace lilytank::bodies {
namespace {

constexpr double kTide = 2 * std::numbers::pi / kTideRate;  // s
constexpr std::size_t kCurveKnots = 5;
constexpr double kMostExponent = 20;  // of a force that grows exponentially

bool never(const Typical&) {
  return false;
}
bool in_pairs(const Typical& t) {
  return t.bodies > 1;
}
bool in_a_plane(const Typical& t) {
  return t.dimensions == 2;
}

bool in_a_plane_of_a_run(const Typical& t) {
  return t.dimensions == 2 && t.of_a_run;
}

bool medium_known(const Typical& t) {
  return t.current[0] >= 0 || t.wind[0] >= 0;
}

// Two per cent of the wind is what drifters and ice usually take up.
Parameters of_slip_in(const Typical& t, const std::string& unit) {
  constexpr double kUsualShare = 0.02;
  Parameters out{{"coefficient", unit}, {"wind fraction", "1", Kind::place, kUsualShare}};
  out[1].scale = kUsualShare;
  if (t.wind[0] < 0) out[1] = {"wind fraction", "1", Kind::fixed, 0};
  for (const int driver : {t.current[0], t.current[1], t.wind[0], t.wind[1]})
    out.push_back({"driver", "1", Kind::driver, static_cast<double>(driver)});
  return out;
}

Parameters towards(const Typical& t, const std::string& unit) {
  Parameters out{{"stiffness", unit}, {"x0", "m", Kind::place, t.centre[0]}};
  if (t.dimensions == 2) out.push_back({"y0", "m", Kind::place, t.centre[1]});
  return out;
}

// A gap s at which strengths of pairs are given: far from those that occur, they would depend on
// the exponent.
double usual_gap(const Typical& t) {
  return std::max(t.nearest, 1e-3 * t.middle);
}

Parameters strength_at_gap(const Typical& t, const LawParameter& decay) {
  return {{"strength", "N"}, {"s", "m", Kind::fixed, usual_gap(t)}, decay};
}

// Gaps below a fifth of s count as a fifth, so that no step meets a pole.
double power_of_gap(double gap, Values p) {
  return p[0] * std::pow(p[1] / std::max(gap, p[1] / 5), p[2]);
}

// A rotation of any rate: none, or that of the strongest line.
Parameters free_rate(const Typical& t) {
  return {{"rate", "rad/s", Kind::place, t.rate, 0, std::max(1e-300, std::fabs(t.rate))}};
}

double rate_of(const Scene&, Values p) {
  return p[0];
}

// Parameters of a curve: the knots' values, then the first and the last knot's place.
Parameters knots(const VariableRange& range) {
  Parameters out;
  for (std::size_t k = 1; k <= kCurveKnots; ++k) out.push_back({"knot" + std::to_string(k), "N"});
  out.push_back({"from", "", Kind::fixed, range.low});
  out.push_back({"to", "", Kind::fixed, range.high > range.low ? range.high : range.low + 1});
  return out;
}

double curve_at(double u, Values p) {
  const double place =
      (u - p[kCurveKnots]) / (p[kCurveKnots + 1] - p[kCurveKnots]) * (kCurveKnots - 1);
  const KnotShare at = between_knots(place, kCurveKnots);
  return (1 - at.share) * p[static_cast<std::size_t>(at.first)] +
         at.share * p[static_cast<std::size_t>(at.second)];
}

constexpr std::string_view kFasterAndSlower =
    "the same body at speeds that differ by a factor of three or more";
constexpr std::string_view kFarther = "a recording that begins farther away";

constexpr Law of_slip(Law law) {
  law.variable = "slip";
  return law;
}

constexpr Law of_medium_slip(Law law) {
  law.variable = "medium slip", law.possible = medium_known, law.split = kMoreDrivers;
  return law;
}

constexpr Law of_pairs(Law law) {
  law.variable = "pair", law.possible = in_pairs;
  law.split = "faster approaches, to half the smallest gap, and slow ones that turn at twice of it";
  return law;
}

constexpr Law turning(Law law) {
  law.variable = "turn";
  law.split =
      "a recording where the latitude's turning and the tide's period differ: elsewhere than at "
      "74.5 degrees, for longer than they take to fall out of step";
  return law;
}

constexpr Law curve(Law law) {
  law.equation = "a curve, straight between its knots", law.curve = true;
  return law;
}

constexpr Law kLaws[] = {
    // For baselines only: as a candidate it is the constant force.
    {.name = "gravity",
     .equation = "F = -m g along the last coordinate",
     .parameters = [](const Typical&) -> Parameters {
       return {{"g", "m/s^2"}};
     },
     .add =
         [](const Scene& s, Values p, double* force) {
           for (int b = 0; b < s.bodies; ++b) force[(b + 1) * s.dimensions - 1] -= p[0] * s.mass[b];
         },
     .possible = never},
    {.name = "pendulum",
     .equation = "F = -m w^2 sin(x)",
     .variable = "position",
     .parameters = [](const Typical&) -> Parameters {
       return {{"w^2", "1/s^2"}};
     },
     .add =
         [](const Scene& s, Values p, double* force) {
           for (int i = 0; i < s.bodies * s.dimensions; ++i) {
             force[i] -= s.mass[i / s.dimensions] * p[0] * std::sin(s.x[i]);
           }
         },
     .possible = never},
    {.name = "constant_force",
     .equation = "F = constant",
     .split = "a recording with the camera turned",
     .parameters =
         [](const Typical& t) {
           Parameters out{{"x", "N"}};
           if (t.dimensions == 2) out.push_back({"y", "N"});
           return out;
         },
     .add =
         [](const Scene& s, Values p, double* force) {
           for (int i = 0; i < s.bodies * s.dimensions; ++i) {
             force[i] += p[static_cast<std::size_t>(i % s.dimensions)];
           }
         }},
    of_slip({.name = "linear_drag",
             .equation = "F = -k v",
             .split = kFasterAndSlower,
             .parameters = [](const Typical&) -> Parameters {
               return {{"coefficient", "N s/m"}};
             },
             .add = along_velocity<[](double, Values p) { return -p[0]; }>}),
    of_slip({.name = "quadratic_drag",
             .equation = "F = -c |v| v",
             .split = kFasterAndSlower,
             .parameters = [](const Typical&) -> Parameters {
               return {{"coefficient", "N s^2/m^2"}};
             },
             .add = along_velocity<[](double speed, Values p) { return -p[0] * speed; }>}),
    // Rounded over a twentieth of the usual speed: a step could not be integrated.
    of_slip({.name = "dry_friction",
             .equation = "F = -R v/|v|",
             .split = "the last, slowest part of the motion, until the body stands",
             .parameters = [](const Typical& t) -> Parameters {
               return {{"force", "N"}, {"rounding", "m/s", Kind::fixed, t.speed / 20}};
             },
             .add = along_velocity<[](double speed, Values p) {
               return -p[0] / std::sqrt(speed * speed + p[1] * p[1]);
             }>}),
    // Slower than its own speed a body is driven, faster it is braked (Rayleigh and Helmholtz).
    of_slip({.name = "self_propulsion",
             .equation = "F = a (1 - v^2/s^2) v: towards the speed s",
             .split = "the same body released at rest, and at twice its usual speed",
             .parameters = [](const Typical& t) -> Parameters {
               return {{"coefficient", "N s/m"}, {"speed", "m/s", Kind::positive, t.speed}};
             },
             .add = along_velocity<[](double speed, Values p) {
               return p[0] * (1 - speed * speed / (p[1] * p[1]));
             }>}),
    of_medium_slip({.name = "linear_drag_in_medium",
                    .equation = "F = -k (v - u - a w): u the current, w the wind",
                    .parameters = [](const Typical& t) { return of_slip_in(t, "N s/m"); },
                    .add = along_slip<[](double, Values p) { return -p[0]; }>}),
    of_medium_slip({.name = "quadratic_drag_in_medium",
                    .equation = "F = -c |s| s, s = v - u - a w: u the current, w the wind",
                    .parameters = [](const Typical& t) { return of_slip_in(t, "N s^2/m^2"); },
                    .add = along_slip<[](double speed, Values p) { return -p[0] * speed; }>}),
    {.name = "linear_spring",
     .equation = "F = -k (x - x0)",
     .variable = "position",
     .split = kFarther,
     .parameters =
         [](const Typical& t) {
           Parameters out = towards(t, "N/m");
           out[0].other = t.mass * t.rate * t.rate;
           return out;
         },
     .add = towards_place<[](double u) { return u; }>},
    {.name = "cubic_spring",
     .equation = "F = -k (x - x0)^3",
     .variable = "position",
     .split = kFarther,
     .parameters = [](const Typical& t) { return towards(t, "N/m^3"); },
     .add = towards_place<[](double u) { return u * u * u; }>},
    {.name = "wall",
     .equation = "F = A exp((r - R)/l) towards the centre (x0, y0); r: the distance from it",
     .variable = "position",
     .split = "bodies that are pushed against the wall",
     .parameters =
         [](const Typical& t) {
           return Parameters{{"strength", "N"},
                             {"R", "m", Kind::fixed, t.farthest},
                             {"range", "m", Kind::positive, t.farthest / 10},
                             {"x0", "m", Kind::place, t.centre[0]},
                             {"y0", "m", Kind::place, t.centre[1]}};
         },
     .add = towards_centre<[](double distance, Values p) {
       return p[0] * std::exp(std::min((distance - p[1]) / p[2], kMostExponent));
     }>,
     .possible = in_a_plane},
    of_pairs({.name = "pair_power_law",
              .equation = "F = A (s/gap)^n",
              .parameters =
                  [](const Typical& t) {
                    return strength_at_gap(t, {"n", "1", Kind::positive, 2, 4});
                  },
              .add = between_pairs<power_of_gap>}),
    of_pairs({.name = "pair_dipoles",
              .equation = "F = A (s/gap)^4",
              .parameters =
                  [](const Typical& t) {
                    return strength_at_gap(t, {"n", "1", Kind::fixed, 4});
                  },
              .add = between_pairs<power_of_gap>}),
    of_pairs({.name = "pair_exponential",
              .equation = "F = A exp(-(gap - s)/l)",
              .parameters =
                  [](const Typical& t) {
                    const double s = usual_gap(t);
                    return strength_at_gap(t, {"range", "m", Kind::positive, s / 3, s});
                  },
              .add = between_pairs<[](double gap, Values p) {
                return p[0] * std::exp(std::min(-(gap - p[1]) / p[2], kMostExponent));
              }>}),
    of_pairs(
        {.name = "pair_spring",
         .equation = "F = k (s - gap) where gap < s",
         .parameters =
             [](const Typical& t) {
               const double s = usual_gap(t);
               return Parameters{{"stiffness", "N/m"}, {"s", "m", Kind::positive, 2 * s, 1.4 * s}};
             },
         .add = between_pairs<[](double gap, Values p) {
           return gap < p[1] ? p[0] * (p[1] - gap) : 0;
         }>}),
    // Repulsion within the gap s, attraction beyond it (Morse).
    of_pairs({.name = "pair_morse",
              .equation = "F = A (exp(-2 (gap - s)/l) - exp(-(gap - s)/l)): none at the gap s",
              .parameters =
                  [](const Typical& t) {
                    const double s = usual_gap(t);
                    return Parameters{{"strength", "N"},
                                      {"s", "m", Kind::positive, 1.5 * s, std::sqrt(s * t.middle)},
                                      {"range", "m", Kind::positive, s / 2}};
                  },
              .add = between_pairs<[](double gap, Values p) {
                const double e = std::exp(std::min(-(gap - p[1]) / p[2], kMostExponent));
                return p[0] * (e - 1) * e;
              }>}),
    turning({.name = "coriolis",
             .equation = "F = m f (v_y, -v_x), f = 2 Omega sin(latitude)",
             .parameters = [](const Typical& t) -> Parameters {
               return {{"f", "1/s", Kind::fixed, t.turning},
                       {"latitude", "1", Kind::driver, static_cast<double>(t.latitude)}};
             },
             .add = turn<[](const Scene& s, Values p) {
               return p[1] >= 0 ? inertial_turning(s.drivers[static_cast<int>(p[1])]) : p[0];
             }>,
             .possible =
                 [](const Typical& t) {
                   return t.dimensions == 2 && (t.latitude >= 0 || t.turning != 0);
                 }}),
    // It fits whatever turns; the laws beside it say why.
    turning({.name = "rotation",
             .equation = "F = m w (v_y, -v_x), w free; w > 0: clockwise",
             .curve = true,
             .parameters = free_rate,
             .add = turn<rate_of>,
             .possible = in_a_plane}),
    turning({.name = "spin_lift",
             .equation = "F = m w (v_y, -v_x), w of each run: the lift of a body that spins",
             .parameters = free_rate,
             .add = turn<rate_of>,
             .possible = in_a_plane_of_a_run}),
    // A tide's current that is set anew all the time: what it leaves turns once a period.
    turning(
        {.name = "tide",
         .equation =
             "velocities turn once in 12.4206 h (M2); sense 1: clockwise, -1: anticlockwise",
         .parameters = [](const Typical&) -> Parameters {
           return {{"period", "s", Kind::fixed, kTide}, {"sense", "1", Kind::fixed, 1, -1}};
         },
         .add = turn<[](const Scene&, Values p) { return p[1] * 2 * std::numbers::pi / p[0]; }>,
         .possible = [](const Typical& t) { return t.dimensions == 2 && t.duration > 2 * kTide; }}),
    kDriverForce,
    driver_law<kProportional, 0>("driver_1"),
    driver_law<kProportional, 1>("driver_2"),
    driver_law<kProportional, 2>("driver_3"),
    driver_law<kProportional, 3>("driver_4"),
    driver_law<kSquared, 0>("driver_1_squared"),
    driver_law<kSquared, 1>("driver_2_squared"),
    driver_law<kSquared, 2>("driver_3_squared"),
    driver_law<kSquared, 3>("driver_4_squared"),
    driver_law<kLagged, 0>("driver_1_lagged", "driver_1"),
    driver_law<kLagged, 1>("driver_2_lagged", "driver_2"),
    driver_law<kLagged, 2>("driver_3_lagged", "driver_3"),
    driver_law<kLagged, 3>("driver_4_lagged", "driver_4"),
    driver_law<kEnvelope, 0>("driver_1_envelope"),
    driver_law<kEnvelope, 1>("driver_2_envelope"),
    driver_law<kEnvelope, 2>("driver_3_envelope"),
    driver_law<kEnvelope, 3>("driver_4_envelope"),
    curve({.name = "curve_of_slip",
           .variable = "slip",
           .parameters = [](const Typical& t) { return knots(range_of("slip", t)); },
           .add = along_velocity<[](double v, Values p) {
             return -curve_at(v, p) / std::max(v, 1e-3 * p[kCurveKnots + 1]);
           }>}),
    curve({.name = "curve_of_position",
           .variable = "position",
           .parameters = [](const Typical& t) { return knots(range_of("position", t)); },
           .add =
               [](const Scene& s, Values p, double* force) {
                 for (int b = 0; b < s.bodies; ++b) force[b] += curve_at(s.x[b], p);
               },
           .possible = [](const Typical& t) { return t.dimensions == 1 && t.bodies == 1; }}),
    // Nothing beyond the last knot.
    curve({.name = "curve_of_gap",
           .variable = "pair",
           .parameters =
               [](const Typical& t) {
                 return knots({t.nearest, std::min(t.middle, 4 * t.nearest + 1e-9)});
               },
           .add = between_pairs<[](double gap, Values p) {
             return gap < p[kCurveKnots + 1] ? curve_at(gap, p) : 0.0;
           }>,
           .possible = in_pairs}),
    curve({.name = "curve_of_time",
           .variable = "time",
           .parameters = [](const Typical& t) { return knots(range_of("time", t)); },
           .add =
               [](const Scene& s, Values p, double* force) {
                 for (int b = 0; b < s.bodies; ++b) force[b] += curve_at(s.time, p);
               },
           .possible = [](const Typical& t) { return t.dimensions == 1; }})};

}  // namespace

std::span<const Law> law_library() {
  return kLaws;
}

}  // namespace lilytank::bodies
