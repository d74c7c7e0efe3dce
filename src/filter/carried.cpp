#include "filter/carried.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "statistics/undefined.hpp"
#include "tracks/sets.hpp"

namespace lilytank {
namespace {

// m/s, rad/s: deviation of a velocity that nothing is known of yet
constexpr double kAnySpeed = 0.3, kAnySpin = 5;

// Sets of modules that bonds connect, of two and more, ascending.
std::vector<std::vector<int>> connected(const std::vector<std::pair<int, int>>& bonds) {
  int modules = 0;
  for (const auto& [a, b] : bonds) modules = std::max({modules, a + 1, b + 1});
  Sets sets(modules);
  for (const auto& [a, b] : bonds) sets.join(a, b);
  std::vector<std::vector<int>> by_first(static_cast<std::size_t>(modules));
  for (int m = 0; m < modules; ++m) by_first[static_cast<std::size_t>(sets.first(m))].push_back(m);
  std::erase_if(by_first, [](const std::vector<int>& set) { return set.size() < 2; });
  return by_first;
}

// The nearest of the four directions, 0..3, of a vector.
int direction(Vec2 v) {
  if (std::fabs(v.x()) >= std::fabs(v.y())) return v.x() >= 0 ? 0 : 2;
  return v.y() >= 0 ? 1 : 3;
}

int quarters(double angle) {
  return static_cast<int>(std::lround(angle / (kPi / 2)));
}

// Carried modules, by identity; -1: not carried.
int number_of(int module, const std::vector<Carried>& carried) {
  for (std::size_t i = 0; i < carried.size(); ++i) {
    if (carried[i].module == module) return static_cast<int>(i);
  }
  return -1;
}

// Cells and turns from neighbour to neighbour, so that errors of headings do not add up. False if
// two modules would lie on one cell: these poses are of no rigid assembly.
bool lay_on_lattice(const std::vector<const Carried*>& of,
                    const std::vector<std::pair<int, int>>& bonds, CarriedAssembly& out) {
  const std::vector<int>& modules = out.modules;
  const std::size_t n = modules.size();
  out.cell_x.assign(n, 0), out.cell_y.assign(n, 0), out.turn.assign(n, 0);
  const auto place = [&](int module) {
    return static_cast<std::size_t>(std::lower_bound(modules.begin(), modules.end(), module) -
                                    modules.begin());
  };
  std::vector<std::size_t> found{0};
  std::vector<bool> known(n, false);
  known[0] = true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t from = found[k];
    for (const auto& [a, b] : bonds) {
      if (a != modules[from] && b != modules[from]) continue;
      const std::size_t to = place(a == modules[from] ? b : a);
      if (known[to]) continue;
      const Carried &p = *of[from], &q = *of[to];
      const Vec2 step = unrotate(rotation(p.theta), {q.x - p.x, q.y - p.y});
      const Rot along = quarter(direction(step) + out.turn[from]);
      out.cell_x[to] = out.cell_x[from] + static_cast<int>(along.c);
      out.cell_y[to] = out.cell_y[from] + static_cast<int>(along.s);
      out.turn[to] = out.turn[from] + quarters(q.theta - p.theta);
      known[to] = true, found.push_back(to);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (out.cell_x[i] == out.cell_x[j] && out.cell_y[i] == out.cell_y[j]) return false;
    }
  }
  return true;
}

// Faces between neighbours on the lattice: those that are not latched are as hidden.
void cover(CarriedAssembly& a) {
  a.covered.assign(a.modules.size(), 0);
  for (std::size_t i = 0; i < a.modules.size(); ++i) {
    for (std::size_t j = 0; j < a.modules.size(); ++j) {
      const int dx = a.cell_x[j] - a.cell_x[i], dy = a.cell_y[j] - a.cell_y[i];
      if (std::abs(dx) + std::abs(dy) != 1) continue;
      const int side = dx == 0 ? 2 - dy : 1 - dx;  // +x, +y, -x, -y
      a.covered[i] |= 1u << ((side - a.turn[i]) & 3);
    }
  }
}

void move_members(const CarriedAssembly& a, std::vector<Carried>& carried) {
  const Rot r = rotation(a.theta);
  for (std::size_t k = 0; k < a.at.size(); ++k) {
    Carried& c = carried[static_cast<std::size_t>(a.at[k])];
    const Vec2 arm = rotate(r, {a.arm_x[k], a.arm_y[k]});
    c.x = a.x + arm.x(), c.y = a.y + arm.y(), c.theta = a.theta + a.turn[k] * kPi / 2;
    c.vx = a.vx - a.omega * arm.y(), c.vy = a.vy + a.omega * arm.x(), c.omega = a.omega;
  }
}

}  // namespace

double CarriedAssemblies::inertia(const CarriedAssembly& a) const {
  return a.size() * model_.module.inertia() + model_.module.mass * a.spread;
}

void CarriedAssemblies::regroup(const std::vector<std::pair<int, int>>& bonds, int frame,
                                std::vector<Carried>& carried) {
  std::vector<CarriedAssembly> now;
  std::vector<std::pair<int, int>> standing;
  for (const auto& [a, b] : bonds) {
    if (number_of(a, carried) >= 0 && number_of(b, carried) >= 0) standing.emplace_back(a, b);
  }
  for (const std::vector<int>& modules : connected(standing)) {
    const auto old = std::find_if(all_.begin(), all_.end(),
                                  [&](const CarriedAssembly& a) { return a.modules == modules; });
    // A member that was just taken up may count its turns from another heading.
    const bool fresh = std::any_of(modules.begin(), modules.end(), [&](int module) {
      return carried[static_cast<std::size_t>(number_of(module, carried))].begun == frame;
    });
    if (old != all_.end() && !fresh) {
      now.push_back(*old);
    } else if (CarriedAssembly one; form(modules, standing, frame, carried, one)) {
      now.push_back(std::move(one));
    }
  }
  std::vector<int> before;
  for (Carried& c : carried) before.push_back(c.assembly), c.assembly = -1;
  for (std::size_t k = 0; k < now.size(); ++k) {
    now[k].at.clear();
    for (const int module : now[k].modules) {
      now[k].at.push_back(number_of(module, carried));
      carried[static_cast<std::size_t>(now[k].at.back())].assembly = static_cast<int>(k);
    }
    move_members(now[k], carried);
  }
  for (std::size_t i = 0; i < carried.size(); ++i) {
    if (before[i] < 0 || carried[i].assembly >= 0) continue;
    carried[i].place = {noise_.place, 0, kAnySpeed * kAnySpeed};
    carried[i].turn = {noise_.heading, 0, kAnySpin * kAnySpin};
    carried[i].begun = frame;
  }
  all_ = std::move(now);
}

bool CarriedAssemblies::form(const std::vector<int>& modules,
                             const std::vector<std::pair<int, int>>& bonds, int frame,
                             const std::vector<Carried>& carried, CarriedAssembly& out) const {
  out = {};
  out.modules = modules, out.begun = frame;
  std::vector<const Carried*> of;
  for (const int module : modules) {
    of.push_back(&carried[static_cast<std::size_t>(number_of(module, carried))]);
  }
  if (!lay_on_lattice(of, bonds, out)) return false;
  cover(out);
  take_motion(of, out);
  return true;
}

// With the momentum and the angular momentum of the single modules.
void CarriedAssemblies::take_motion(const std::vector<const Carried*>& of,
                                    CarriedAssembly& out) const {
  const double share = 1 / out.size(), side = model_.module.side;
  double centre_x = 0, centre_y = 0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    centre_x += share * side * out.cell_x[k], centre_y += share * side * out.cell_y[k];
    out.x += share * of[k]->x, out.y += share * of[k]->y;
    out.vx += share * of[k]->vx, out.vy += share * of[k]->vy;
    out.theta += share * (of[k]->theta - out.turn[k] * kPi / 2);
  }
  double spin = 0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    out.arm_x.push_back(out.cell_x[k] * side - centre_x);
    out.arm_y.push_back(out.cell_y[k] * side - centre_y);
    out.spread += out.arm_x[k] * out.arm_x[k] + out.arm_y[k] * out.arm_y[k];
    const Carried& c = *of[k];
    const double across = (c.x - out.x) * (c.vy - out.vy) - (c.y - out.y) * (c.vx - out.vx);
    spin += model_.module.inertia() * c.omega + model_.module.mass * across;
  }
  out.omega = spin / inertia(out);
  out.place = {share * noise_.place, 0, share * kAnySpeed * kAnySpeed};
  out.rotation = {share * noise_.heading, 0, share * kAnySpin * kAnySpin};
}

PredictedAssembly CarriedAssemblies::seen(CarriedAssembly& a, const PredictedFrame& frame,
                                          double dt, double usable_from) const {
  const double n = a.size(), mass = model_.module.mass, own = model_.module.inertia();
  PredictedAssembly out;
  out.members = a.at, out.first = a.modules.front(), out.begun = a.begun;
  out.mass = n * mass, out.inertia = inertia(a);
  out.usable = (frame.frame - a.begun) * dt >= usable_from;
  out.x = out.y = 0;
  for (const int member : a.at) {
    const auto i = static_cast<std::size_t>(member);
    out.x += frame.now.x[i] / n, out.y += frame.now.y[i] / n;
    out.contact = std::max(out.contact, frame.contact[i]);
  }
  // Random forces of members are independent; their arms make torques of them.
  a.place.pass(dt, noise_.kicks / n);
  a.rotation.pass(dt, (n * own * own * noise_.turns + mass * mass * a.spread * noise_.kicks) /
                          (out.inertia * out.inertia));
  const double known = n / noise_.heading + a.spread / noise_.place;  // of the heading, 1/rad^2
  const double place = a.place.xx + noise_.place / n, turn = a.rotation.xx + 1 / known;
  Innovation& e = out.innovation;
  e.sd_x = std::sqrt(place), e.sd_theta = std::sqrt(turn);
  const Rot r = rotation(a.theta);
  for (std::size_t k = 0; k < a.at.size(); ++k) {
    const auto i = static_cast<std::size_t>(a.at[k]);
    const Vec2 arm = rotate(r, {a.arm_x[k], a.arm_y[k]});
    e.dx += frame.dx[i] / n, e.dy += frame.dy[i] / n;
    e.dtheta += (frame.dtheta[i] / noise_.heading +
                 (arm.x() * frame.dy[i] - arm.y() * frame.dx[i]) / noise_.place) /
                known;
  }
  if (std::isnan(e.dx + e.dy + e.dtheta)) {
    e.dx = e.dy = e.dtheta = kUndefined;
    return out;
  }
  e.gain_x = a.place.xx / place, e.gain_v = a.place.xv / place;
  e.gain_theta = a.rotation.xx / turn, e.gain_omega = a.rotation.xv / turn;
  return out;
}

void CarriedAssemblies::correct(CarriedAssembly& a, const Innovation& by,
                                std::vector<Carried>& carried) const {
  if (!std::isnan(by.dx)) {
    a.x += by.gain_x * by.dx, a.y += by.gain_x * by.dy, a.theta += by.gain_theta * by.dtheta;
    a.vx += by.gain_v * by.dx, a.vy += by.gain_v * by.dy, a.omega += by.gain_omega * by.dtheta;
    a.place.see(by.gain_x, by.gain_v), a.rotation.see(by.gain_theta, by.gain_omega);
  }
  move_members(a, carried);
}

}  // namespace lilytank
