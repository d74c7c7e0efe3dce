// Measures the overlaps of a stored run apart from the simulator: poses in, deepest overlap out. It
// shares no code with it, so a fault in src/physics cannot hide itself here.
//
//   overlap_check draw K [STEPS]
//       prints the options of random scenario K for `lilytank run`, of STEPS module-steps (default:
//       a few seconds) and at most 800 frames
//   overlap_check check DIR
//       reads DIR/trajectory.csv, resolved.toml and summary.json, prints a row: frames, deepest
//       overlap of two bodies, of a body and the wall, and the one that the run reports (mm);
//       exit 1 if one exceeds 0.5 mm or what is reported
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr double kLimit = 0.5e-3;     // m, the promise
constexpr double kRounding = 0.5e-6;  // m, poses are stored as float32
constexpr double kFrames = 800;       // at most, of one scenario

struct Point {
  double x, y;
};
using Polygon = std::vector<Point>;

struct Body {
  double x = 0, y = 0, theta = 0;
};

struct Sizes {
  int modules = 0;
  double side = 0, ball = 0, tank = 0;
};

Polygon outline(const Body& b, double side) {
  const double c = std::cos(b.theta) * side / 2, s = std::sin(b.theta) * side / 2;
  return {{b.x + c - s, b.y + s + c},
          {b.x - c - s, b.y - s + c},
          {b.x - c + s, b.y - s - c},
          {b.x + c + s, b.y + s - c}};
}

// The largest gap of two polygons over the directions of the sides of the first one.
double gap_along_sides(const Polygon& p, const Polygon& q) {
  double best = -1e9;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point a = p[k], b = p[(k + 1) % p.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double nx = (b.y - a.y) / length, ny = -(b.x - a.x) / length;  // outwards
    double nearest = 1e9;
    for (const Point& v : q) nearest = std::min(nearest, (v.x - a.x) * nx + (v.y - a.y) * ny);
    best = std::max(best, nearest);
  }
  return best;
}

double square_square(const Polygon& p, const Polygon& q) {
  return -std::max(gap_along_sides(p, q), gap_along_sides(q, p));
}

// Depth of a disc in a square: radius less the signed distance of the centre from the square.
double square_disc(const Body& square, double side, const Body& disc, double radius) {
  const double dx = disc.x - square.x, dy = disc.y - square.y;
  const double c = std::cos(square.theta), s = std::sin(square.theta);
  const double u = std::fabs(c * dx + s * dy) - side / 2, v = std::fabs(c * dy - s * dx) - side / 2;
  const double outside = std::hypot(std::max(u, 0.0), std::max(v, 0.0));
  return radius - (outside > 0 ? outside : std::max(u, v));
}

struct Depths {
  double pair = 0, wall = 0;
};

void measure(const std::vector<Body>& bodies, const Sizes& sizes, Depths& deepest) {
  const int n = static_cast<int>(bodies.size());
  std::vector<Polygon> squares;
  for (int i = 0; i < sizes.modules; ++i) squares.push_back(outline(bodies[i], sizes.side));
  const auto reach = [&](int i) { return i < sizes.modules ? 0.7072 * sizes.side : sizes.ball; };
  for (int i = 0; i < n; ++i) {
    if (i < sizes.modules) {
      for (const Point& p : squares[i])
        deepest.wall = std::max(deepest.wall, std::hypot(p.x, p.y) - sizes.tank);
    } else {
      deepest.wall =
          std::max(deepest.wall, std::hypot(bodies[i].x, bodies[i].y) + sizes.ball - sizes.tank);
    }
    for (int j = i + 1; j < n; ++j) {
      const double distance = std::hypot(bodies[i].x - bodies[j].x, bodies[i].y - bodies[j].y);
      if (distance > reach(i) + reach(j)) continue;
      const double depth = j < sizes.modules ? square_square(squares[i], squares[j])
                           : i < sizes.modules
                               ? square_disc(bodies[i], sizes.side, bodies[j], sizes.ball)
                               : 2 * sizes.ball - distance;
      deepest.pair = std::max(deepest.pair, depth);
    }
  }
}

// "table.key" to text, of the few lines of TOML or JSON that the program writes one a line.
std::map<std::string, std::string> values_of(const std::string& file, char separator) {
  std::ifstream in(file);
  std::map<std::string, std::string> out;
  std::string line, table;
  while (std::getline(in, line)) {
    if (line.starts_with('[')) table = line.substr(1, line.find(']') - 1) + ".";
    const auto at = line.find(separator);
    if (at == std::string::npos) continue;
    std::string name;
    for (const char c : line.substr(0, at)) {
      if (c != ' ' && c != '"') name += c;
    }
    out[table + name] = line.substr(at + 1);
  }
  return out;
}

double number(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) {
    std::cerr << "there is no " << name << "\n";
    std::exit(2);
  }
  return std::atof(found->second.c_str());
}

int check(const std::string& dir) {
  const auto scenario = values_of(dir + "/resolved.toml", '=');
  const auto summary = values_of(dir + "/summary.json", ':');
  const Sizes sizes{static_cast<int>(number(scenario, "module.count")),
                    number(scenario, "module.side"), number(scenario, "ball.radius"),
                    number(scenario, "tank.radius")};
  const auto bodies =
      static_cast<std::size_t>(sizes.modules + static_cast<int>(number(scenario, "ball.count")));
  std::ifstream in(dir + "/trajectory.csv");
  std::string line;
  std::getline(in, line);
  std::vector<Body> frame;
  Depths deepest;
  int frames = 0;
  while (std::getline(in, line)) {  // frame, time, id, x, y, theta, ...
    std::array<double, 6> cell{};
    std::istringstream row(line);
    std::string text;
    for (double& v : cell) std::getline(row, text, ','), v = std::atof(text.c_str());
    frame.push_back({cell[3], cell[4], cell[5]});
    if (frame.size() < bodies) continue;
    measure(frame, sizes, deepest), frame.clear(), ++frames;
  }
  const double reported = number(summary, "deepest_overlap_m");
  std::printf("%7d %9.4f %9.4f %9.4f", frames, 1e3 * deepest.pair, 1e3 * deepest.wall,
              1e3 * reported);
  const double most = std::max(deepest.pair, deepest.wall);
  if (frames == 0 || !frame.empty()) return std::puts("  frames are cut or missing"), 1;
  if (most > kLimit + kRounding) return std::puts("  beyond 0.5 mm"), 1;
  if (most > reported + kRounding) return std::puts("  not reported"), 1;
  return std::puts(""), 0;
}

// SplitMix64.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u) {}
  double between(double low, double high) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return low + (high - low) * (static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53);
  }
  bool chance(double p) { return between(0, 1) < p; }
  template <std::size_t N>
  const char* of(const std::array<const char*, N>& words) {
    return words[static_cast<std::size_t>(between(0, N))];
  }

 private:
  std::uint64_t state_;
};

void set(const std::string& name, double value) {
  std::printf("--set %s=%.6g ", name.c_str(), value);
}
void set(const std::string& name, const char* value) {
  std::printf("--set %s=%s ", name.c_str(), value);
}

// Sizes, numbers, step, friction, layout, flow and forces of scenario k. Lattices fill up to nine
// tenths of the tank, random layouts a tenth. Zero module-steps: a few seconds.
void draw(std::uint64_t k, double module_steps) {
  Draws u(k);
  const double tank = u.between(0.1, 0.4), side = u.between(0.01, 0.04);
  const bool balls = u.chance(0.4), lattice = u.chance(0.7);
  const double ball = balls ? u.between(0.006, 0.02) : 0.001;
  const double widest = std::max({side, 2 * ball}), radius = tank - 0.75 * std::max(side, 2 * ball);
  const double pitch = widest * (lattice ? u.between(1.005, 1.3) : 1.45);
  const double most = 3.1416 * radius * radius / (pitch * pitch);
  const int count = std::clamp(
      static_cast<int>(most * (lattice ? u.between(0.3, 0.9) : u.between(0.05, 0.15))), 2, 250);
  const int modules = balls ? static_cast<int>(count * u.between(0, 1)) : count;
  std::printf("%s ", u.of(std::array{"chain5.toml", "cross5.toml", "l4.toml", "tank_lilies.toml"}));
  set("run.seed", static_cast<double>(k));
  const double brief = std::clamp(1500.0 / count, 4.0, 20.0);
  const double dt = 0.025 / std::array{1, 1, 2, 5}[static_cast<std::size_t>(u.between(0, 4))];
  const double duration = module_steps > 0 ? std::ceil(module_steps * dt / count) : brief;
  set("run.duration", duration), set("run.dt", dt);
  set("tank.radius", tank), set("start.radius", radius), set("start.distance", pitch);
  set("start.layout", lattice ? "lattice" : "random");
  set("module.count", modules), set("ball.count", count - modules);
  set("module.side", side), set("module.mass", std::pow(10, u.between(-2.5, 0.5)));
  if (balls) set("ball.radius", ball);
  set("contact.friction", u.chance(0.2) ? 0 : u.between(0, 1.5));
  set("contact.restitution", u.chance(0.3) ? u.between(0.9, 1) : u.between(0, 0.9));
  set("control.capture_distance", std::min(0.005, 0.3 * side));
  set("control.clock", u.of(std::array{"firmware", "events"}));
  set("flow.pump_power", u.between(0, 100)), set("flow.K_v", u.between(0, 5));
  if (u.chance(0.3)) {
    set("forces.body_force.force_x", u.between(-0.5, 0.5));
    set("forces.body_force.force_y", u.between(-0.5, 0.5));
  }
  set("output.trajectory", "csv"), set("output.rate", std::min(40.0, kFrames / duration));
  std::puts("");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string verb = argc >= 3 ? argv[1] : "";
  if (verb == "check" && argc == 3) return check(argv[2]);
  if (verb == "draw" && argc <= 4) {
    return draw(std::strtoull(argv[2], nullptr, 10), argc == 4 ? std::atof(argv[3]) : 0), 0;
  }
  std::cerr << "usage: overlap_check draw K [STEPS] | check DIR\n";
  return 2;
}
