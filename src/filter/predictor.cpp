#include "lilytank/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "filter/carried.hpp"
#include "lilytank/start.hpp"
#include "lilytank/world.hpp"
#include "statistics/undefined.hpp"

namespace lilytank {
namespace {

constexpr double kFirstSpeed = 0.3,
                 kFirstSpin = 5;  // m/s, rad/s: deviation before anything is seen

// Velocity kicks in a second, as if all random force were white.
double kicks_of(const MotionModel& m) {
  return m.jolts * m.jolts + 2 * m.acceleration * m.acceleration * m.memory;
}

constexpr double kLeastJolts = 1e-4, kLeastTurns = 1e-3;  // m/s and rad/s in the root of a second
constexpr double kFitted = 40;  // s of a recording that jolts are fitted to
constexpr int kFittingRounds = 8;
constexpr double kPushed = 0.03, kOdd = 8;  // m/s of contact; deviations of a lost identity

// Arrays of a PredictedFrame.
struct Scratch {
  std::vector<double> x, y, c, s, vx, vy, omega, dx, dy, dtheta, sd_x, sd_theta, contact, gain_x,
      gain_v, gain_theta, gain_omega;
  std::vector<std::uint8_t> covered, usable;
  std::vector<int> module;
  void resize(std::size_t n) {
    for (auto* of : {&x, &y, &c, &s, &vx, &vy, &omega, &dx, &dy, &dtheta, &sd_x, &sd_theta,
                     &contact, &gain_x, &gain_v, &gain_theta, &gain_omega}) {
      of->resize(n);
    }
    covered.assign(n, 0), usable.resize(n), module.resize(n);
  }
};

// The expected tank with any number of modules.
class Tanks {
 public:
  explicit Tanks(Model model) : model_(std::move(model)) {}
  struct Tank {
    explicit Tank(Model of)
        : model(std::move(of)), state(state_of_poses(model, {}, 0)), world(model, state) {}
    Model model;
    State state;  ///< to be filled in, and the world to go on from it
    World world;
  };
  Tank& with(int modules) {
    auto found = tanks_.find(modules);
    if (found != tanks_.end()) return *found->second;
    Model model = model_;
    model.module.count = modules;
    return *tanks_.emplace(modules, std::make_unique<Tank>(std::move(model))).first->second;
  }

 private:
  Model model_;
  std::map<int, std::unique_ptr<Tank>> tanks_;
};

class Filter {
 public:
  Filter(const Model& model, const PredictorOptions& options, double rate)
      : options_(options),
        model_(model),
        dt_(1 / rate),
        tanks_(expected(model, options.substeps, rate)),
        noise_{options.position.noise * options.position.noise,
               options.heading.noise * options.heading.noise, kicks_of(options.position),
               kicks_of(options.heading)},
        assemblies_(model, noise_) {}

  void run(const Recording& recording, int index, const std::map<std::int64_t, int>& modules,
           const std::function<void(const PredictedFrame&)>& visit) {
    carried_.clear();
    const bool latched = recording.latches && model_.control.latches;
    const std::vector<SeenBond> bonds =
        latched ? seen_bonds(recording, model_.module.side) : std::vector<SeenBond>{};
    for (int frame = 0; frame + 1 < recording.frames; ++frame) {
      take_up(recording, frame, modules);
      if (carried_.empty()) continue;
      if (latched) assemblies_.regroup(standing(bonds, frame, modules), frame, carried_);
      step(frame, frame * dt_);
      PredictedFrame out = seen(frame);
      out.recording = index, out.frame = frame, out.time = frame * dt_;
      visit(out);
      correct();
    }
  }

 private:
  static Model expected(Model model, int substeps, double rate) {
    model.expected = true, model.control.latches = false;
    model.flow.at = FlowAt::points;
    model.dt = 1 / (rate * substeps);
    model.ball.count = 0, model.rulesets.clear(), model.commands.clear(), model.feedback.clear();
    // Nothing in an expected tank goes by ticks but the firmware, which sleeps.
    model.steps_per_tick = 1;
    return model;
  }

  static std::vector<std::pair<int, int>> standing(const std::vector<SeenBond>& bonds, int frame,
                                                   const std::map<std::int64_t, int>& modules) {
    std::vector<std::pair<int, int>> out;
    for (const SeenBond& bond : bonds) {
      if (bond.begin > frame) break;
      if (bond.known > frame || bond.end <= frame) continue;
      out.emplace_back(modules.at(bond.a), modules.at(bond.b));
    }
    return out;
  }

  // Modules that are seen for the first time, or again; those long unseen are dropped.
  void take_up(const Recording& recording, int frame, const std::map<std::int64_t, int>& modules) {
    const auto lost = [&](const Carried& c) { return (frame - c.seen) * dt_ > options_.forget; };
    carried_.erase(std::remove_if(carried_.begin(), carried_.end(), lost), carried_.end());
    for (const Track& track : recording.tracks) {
      const int k = frame - track.first;
      if (k < 0 || k >= static_cast<int>(track.x.size())) continue;
      const auto i = static_cast<std::size_t>(k);
      if (std::isnan(track.x[i])) continue;
      const bool known = std::any_of(carried_.begin(), carried_.end(),
                                     [&](const Carried& c) { return c.track == &track; });
      if (known) continue;
      Carried c;
      c.track = &track, c.module = modules.at(track.id);
      // It goes on in this piece: its last one is not carried along beside it.
      std::erase_if(carried_, [&](const Carried& old) { return old.module == c.module; });
      c.x = track.x[i], c.y = track.y[i], c.theta = track.theta[i];
      c.place = {noise_.place, 0, kFirstSpeed * kFirstSpeed};
      c.turn = {noise_.heading, 0, kFirstSpin * kFirstSpin};
      c.begun = c.seen = frame;
      carried_.push_back(c);
    }
  }

  // One frame of the expected tank.
  void step(int frame, double time) {
    const auto n = carried_.size();
    at_.resize(n);
    Tanks::Tank& tank = tanks_.with(static_cast<int>(n));
    State& state = tank.state;
    for (std::size_t i = 0; i < n; ++i) {
      const Carried& c = carried_[i];
      const Rot r = rotation(c.theta);
      at_.x[i] = state.x[i] = c.x, at_.y[i] = state.y[i] = c.y;
      at_.c[i] = state.c[i] = r.c, at_.s[i] = state.s[i] = r.s;
      at_.vx[i] = state.vx[i] = c.vx, at_.vy[i] = state.vy[i] = c.vy;
      at_.omega[i] = state.omega[i] = c.omega;
      at_.module[i] = c.module;
      at_.usable[i] = c.assembly < 0 && (frame - c.begun) * dt_ >= options_.start ? 1 : 0;
      state.assembly[i] = static_cast<std::int32_t>(i);
      state.cell_x[i] = state.cell_y[i] = state.turn[i] = 0;
      at_.covered[i] = 0;
    }
    std::fill(state.faces.begin(), state.faces.end(), Face{});
    for (const CarriedAssembly& a : assemblies_.all()) put(a, state);
    state.step = std::llround(time / tank.model.dt);
    World& world = tank.world;
    world.go_on_from(state);
    for (int k = 0; k < options_.substeps; ++k) {
      // An expected tank that diverges predicts rest: the next frame corrects it.
      if (world.step() == RunStatus::diverged) return;
    }
    const Kinematics& end = world.kinematics();
    for (std::size_t i = 0; i < n; ++i) {
      Carried& c = carried_[i];
      // What is not explained by the mean velocity of the way is a push by contacts.
      const double ex = end.x[i] - c.x - dt_ * 0.5 * (c.vx + end.vx[i]);
      const double ey = end.y[i] - c.y - dt_ * 0.5 * (c.vy + end.vy[i]);
      const double jump = std::hypot(end.vx[i] - c.vx, end.vy[i] - c.vy);
      at_.contact[i] = std::max(std::hypot(ex, ey) / dt_, jump > kPush ? jump : 0);
      c.x = end.x[i], c.y = end.y[i];
      c.theta += angle_of(between({at_.c[i], at_.s[i]}, {end.c[i], end.s[i]}));
      c.vx = end.vx[i], c.vy = end.vy[i], c.omega = end.omega[i];
    }
    for (CarriedAssembly& a : assemblies_.all()) follow(a);
  }

  // An assembly as one body of the tank's, in the slot of its lowest member.
  void put(const CarriedAssembly& a, State& state) {
    const int slot = *std::min_element(a.at.begin(), a.at.end());
    const auto s = static_cast<std::size_t>(slot);
    const Rot r = rotation(a.theta);
    for (std::size_t k = 0; k < a.at.size(); ++k) {
      const auto i = static_cast<std::size_t>(a.at[k]);
      state.assembly[i] = slot, state.turn[i] = a.turn[k] & 3;
      state.cell_x[i] = a.cell_x[k], state.cell_y[i] = a.cell_y[k];
      at_.covered[i] = static_cast<std::uint8_t>(a.covered[k]);
      for (std::size_t f = 0; f < 4; ++f) {
        if (a.covered[k] >> f & 1) state.faces[4 * i + f].status = FaceStatus::latched;
      }
    }
    state.x[s] = a.x, state.y[s] = a.y, state.c[s] = r.c, state.s[s] = r.s;
    state.vx[s] = a.vx, state.vy[s] = a.vy, state.omega[s] = a.omega;
  }

  // Takes over how its members were moved.
  void follow(CarriedAssembly& a) {
    const double n = a.size();
    a.x = a.y = a.vx = a.vy = 0;
    for (const int member : a.at) {
      const Carried& c = carried_[static_cast<std::size_t>(member)];
      a.x += c.x / n, a.y += c.y / n, a.vx += c.vx / n, a.vy += c.vy / n;
    }
    const Carried& first = carried_[static_cast<std::size_t>(a.at.front())];
    a.theta = first.theta - a.turn.front() * kPi / 2, a.omega = first.omega;
  }

  // Compares with the next frame.
  PredictedFrame seen(int frame) {
    const auto n = carried_.size();
    for (std::size_t i = 0; i < n; ++i) {
      Carried& c = carried_[i];
      c.place.pass(dt_, noise_.kicks), c.turn.pass(dt_, noise_.turns);
      const double sx = c.place.xx + noise_.place, st = c.turn.xx + noise_.heading;
      at_.sd_x[i] = std::sqrt(sx), at_.sd_theta[i] = std::sqrt(st);
      const int k = frame + 1 - c.track->first;
      const bool there = k < static_cast<int>(c.track->x.size()) &&
                         !std::isnan(c.track->x[static_cast<std::size_t>(k)]);
      if (!there) {
        at_.dx[i] = at_.dy[i] = at_.dtheta[i] = kUndefined;
        at_.gain_x[i] = at_.gain_v[i] = at_.gain_theta[i] = at_.gain_omega[i] = 0;
        continue;
      }
      const auto j = static_cast<std::size_t>(k);
      c.seen = frame + 1;
      at_.dx[i] = c.track->x[j] - c.x, at_.dy[i] = c.track->y[j] - c.y;
      at_.dtheta[i] = c.track->theta[j] - c.theta;
      at_.gain_x[i] = c.place.xx / sx, at_.gain_v[i] = c.place.xv / sx;
      at_.gain_theta[i] = c.turn.xx / st, at_.gain_omega[i] = c.turn.xv / st;
    }
    PredictedFrame out;
    out.interval = dt_;
    out.model = &tanks_.with(static_cast<int>(n)).model;
    out.now = {
        at_.x, at_.y, at_.c, at_.s, at_.vx, at_.vy, at_.omega, at_.covered, static_cast<int>(n)};
    out.module = at_.module, out.dx = at_.dx, out.dy = at_.dy, out.dtheta = at_.dtheta;
    out.sd_x = at_.sd_x, out.sd_theta = at_.sd_theta, out.contact = at_.contact;
    out.gain_x = at_.gain_x, out.gain_v = at_.gain_v;
    out.gain_theta = at_.gain_theta, out.gain_omega = at_.gain_omega, out.usable = at_.usable;
    out.frame = frame;
    seen_.clear();
    for (CarriedAssembly& a : assemblies_.all()) {
      seen_.push_back(assemblies_.seen(a, out, dt_, options_.start));
    }
    out.assemblies = seen_;
    return out;
  }

  void correct() {
    for (std::size_t i = 0; i < carried_.size(); ++i) {
      Carried& c = carried_[i];
      if (std::isnan(at_.dx[i]) || c.assembly >= 0) continue;
      c.x += at_.gain_x[i] * at_.dx[i], c.y += at_.gain_x[i] * at_.dy[i];
      c.vx += at_.gain_v[i] * at_.dx[i], c.vy += at_.gain_v[i] * at_.dy[i];
      c.theta += at_.gain_theta[i] * at_.dtheta[i], c.omega += at_.gain_omega[i] * at_.dtheta[i];
      c.place.see(at_.gain_x[i], at_.gain_v[i]), c.turn.see(at_.gain_theta[i], at_.gain_omega[i]);
    }
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      assemblies_.correct(assemblies_.all()[k], seen_[k].innovation, carried_);
    }
  }

  static constexpr double kPush = 0.05;  // m/s in a frame: more than drag changes
  const PredictorOptions& options_;
  const Model& model_;
  double dt_;
  Tanks tanks_;
  ModuleNoise noise_;
  CarriedAssemblies assemblies_;
  std::vector<Carried> carried_;
  std::vector<PredictedAssembly> seen_;
  Scratch at_;
};

}  // namespace

PredictorOptions predictor_options(const Model& model, const std::vector<Recording>& recordings) {
  PredictorOptions out;
  for (const Recording& one : recordings) {
    const MotionModel place = fit_position(one), turn = fit_heading(one);
    const double share = 1 / static_cast<double>(recordings.size());
    out.position.noise += share * place.noise, out.heading.noise += share * turn.noise;
    out.position.jolts += share * place.jolts, out.heading.jolts += share * turn.jolts;
  }
  out.position.noise = std::max(out.position.noise, 1e-6);
  out.heading.noise = std::max(out.heading.noise, 1e-5);
  out.position.jolts = std::max(out.position.jolts, kLeastJolts);
  out.heading.jolts = std::max(out.heading.jolts, kLeastTurns);
  std::vector<Recording> pieces;
  for (const Recording& one : recordings) {
    pieces.push_back(one);
    pieces.back().frames = std::min(one.frames, static_cast<int>(kFitted * one.rate));
  }
  for (int round = 0; round < kFittingRounds; ++round) {
    double place = 0, turn = 0, count = 0;
    predict(model, pieces, out, [&](const PredictedFrame& f) {
      for (std::size_t i = 0; i < f.dx.size(); ++i) {
        if (f.usable[i] == 0 || std::isnan(f.dx[i]) || f.contact[i] > kPushed) continue;
        const double x = f.dx[i] / f.sd_x[i], y = f.dy[i] / f.sd_x[i],
                     t = f.dtheta[i] / f.sd_theta[i];
        if (std::max({std::fabs(x), std::fabs(y), std::fabs(t)}) > kOdd) continue;
        place += 0.5 * (x * x + y * y), turn += t * t, count += 1;
      }
    });
    if (count < 100) break;
    // The variance is that of the noise and of the jolts; it rises more slowly than these.
    out.position.jolts *= std::clamp(place / count, 0.3, 3.0);
    out.heading.jolts *= std::clamp(turn / count, 0.3, 3.0);
    out.position.jolts = std::max(out.position.jolts, kLeastJolts);
    out.heading.jolts = std::max(out.heading.jolts, kLeastTurns);
  }
  return out;
}

void predict(const Model& model, const std::vector<Recording>& recordings,
             const PredictorOptions& options,
             const std::function<void(const PredictedFrame&)>& visit) {
  std::map<std::int64_t, int> modules;  // ids in their order, over all recordings
  for (const Recording& one : recordings) {
    for (const Track& track : one.tracks) modules.emplace(track.id, 0);
  }
  int number = 0;
  for (auto& [id, module] : modules) module = number++;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& one = recordings[r];
    if (one.body != BodyKind::lily || !one.has_heading()) {
      throw InputError(one.name + " has no headings of modules: a prediction needs them");
    }
    Filter(model, options, one.rate).run(one, static_cast<int>(r), modules, visit);
  }
}

}  // namespace lilytank
