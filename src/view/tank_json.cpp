#include "view/tank_json.hpp"

#include <algorithm>
#include <cmath>

#include "view/pumps.hpp"
#include "view/streamlines.hpp"

namespace lilytank {
namespace {

using WholeNumbers = std::vector<std::int32_t>;

/// The frames of a trajectory that a page keeps: every k-th one and the last.
std::vector<std::size_t> kept_frames(const Trajectory& t, double rate) {
  const auto frames = static_cast<std::size_t>(t.frames());
  const double poses = static_cast<double>(t.frames()) * t.bodies;
  double every = std::ceil(poses / static_cast<double>(kViewPoses));
  if (rate > 0 && frames > 1) {
    every = std::round(static_cast<double>(frames - 1) / (t.time.back() - t.time.front()) / rate);
  }
  const auto step = static_cast<std::size_t>(std::clamp(every, 1.0, 1e9));
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < frames; f += step) out.push_back(f);
  if (out.back() + 1 != frames) out.push_back(frames - 1);
  return out;
}

/// Times as whole numbers of 31 bits.
class TimeGrid {
 public:
  explicit TimeGrid(double longest) {
    while (longest * ticks_ > 2e9) ticks_ /= 10;
  }
  double ticks() const { return ticks_; }
  std::int32_t operator()(double time) const {
    return static_cast<std::int32_t>(std::llround(time * ticks_));
  }

 private:
  double ticks_ = 1e6;  // a second
};

/// Values of one body after the other, in the kept frames.
template <class ValueAt>
Json body_column(ViewPack& pack, const std::vector<std::size_t>& frames, int bodies,
                 std::size_t stride, ValueAt&& value_at) {
  WholeNumbers out;
  out.reserve(frames.size() * static_cast<std::size_t>(bodies));
  for (std::size_t b = 0; b < static_cast<std::size_t>(bodies); ++b) {
    std::int32_t before = 0;
    for (const std::size_t f : frames) out.push_back(before = value_at(f * stride + b, before));
  }
  return pack.add(out, frames.size());
}

std::int32_t on_grid(double value, double step) {
  return static_cast<std::int32_t>(std::lround(value / step));
}

/// The heading on its grid, less than half a turn from the one before.
std::int32_t unwound(double heading, std::int32_t before) {
  constexpr int kTurn = 3600;
  const std::int32_t at = on_grid(heading, kViewHeadingStep);
  return at + kTurn * static_cast<std::int32_t>(std::lround((before - at) / double{kTurn}));
}

void add_poses(const ViewTank& tank, const std::vector<std::size_t>& frames, ViewPack& pack,
               Json& out) {
  const Trajectory& t = tank.run.trajectory;
  const auto bodies = static_cast<std::size_t>(t.bodies);
  const auto seen = [&](std::size_t i) { return tank.seen.empty() || tank.seen[i] != 0; };
  const auto places = [&](const std::vector<float>& values) {
    return body_column(pack, frames, t.bodies, bodies, [&](std::size_t i, std::int32_t before) {
      return seen(i) ? on_grid(values[i], kViewPositionStep) : before;
    });
  };
  out["x"] = places(t.x), out["y"] = places(t.y);
  if (tank.headings) {
    out["theta"] =
        body_column(pack, frames, t.bodies, bodies, [&](std::size_t i, std::int32_t before) {
          return seen(i) ? unwound(t.theta[i], before) : before;
        });
  }
  if (tank.seen.empty()) return;
  out["seen"] = body_column(pack, frames, t.bodies, bodies,
                            [&](std::size_t i, std::int32_t) { return tank.seen[i]; });
}

void add_markings(const Trajectory& t, const std::vector<std::size_t>& frames, ViewPack& pack,
                  Json& out) {
  if (t.markings.empty() || t.modules == 0) return;
  const std::size_t stride = t.markings.size() / t.time.size();
  const auto add = [&](const char* name, const auto& of) {
    out[name] = body_column(pack, frames, t.modules, stride, [&](std::size_t i, std::int32_t) {
      return std::int32_t{of(t.markings[i])};
    });
  };
  add("label", [](const Markings& m) { return m.label; });
  add("last", [](const Markings& m) { return m.last; });
  add("faces", [](const Markings& m) { return m.latched | m.bonded << 4 | m.complete << 8; });
}

Json events_json(const std::vector<StoredEvent>& events, const TimeGrid& grid, ViewPack& pack) {
  Json out{{"kinds", event_words()}};
  std::vector<std::string> rules;
  for (const StoredEvent& e : events) {
    if (std::find(rules.begin(), rules.end(), e.rule) == rules.end()) rules.push_back(e.rule);
  }
  out["rules"] = rules;
  const auto add = [&](const char* name, const auto& of) {
    WholeNumbers values;
    for (const StoredEvent& e : events) values.push_back(of(e));
    out[name] = pack.add(values, std::max<std::size_t>(1, values.size()));
  };
  add("time", [&](const StoredEvent& e) { return grid(e.time); });
  add("kind", [](const StoredEvent& e) { return e.kind; });
  add("a", [](const StoredEvent& e) { return e.a; });
  add("b", [](const StoredEvent& e) { return e.b; });
  add("face_a", [](const StoredEvent& e) { return e.face_a; });
  add("face_b", [](const StoredEvent& e) { return e.face_b; });
  add("label_a", [](const StoredEvent& e) { return e.label_a; });
  add("label_b", [](const StoredEvent& e) { return e.label_b; });
  add("copies", [](const StoredEvent& e) { return e.copies; });
  add("rule", [&](const StoredEvent& e) {
    return static_cast<std::int32_t>(std::find(rules.begin(), rules.end(), e.rule) - rules.begin());
  });
  return out;
}

/// Streamlines of one flow, points about 6 mm apart in a tank of 30 cm; tone: speed of 255.
Json flow_json(const FlowField& field, double radius, double peak, ViewPack& pack) {
  constexpr std::size_t kEvery = 3;
  StreamlineSettings settings;
  settings.radius = 0.985 * radius, settings.separation = 0.055 * radius;
  settings.step = 0.0065 * radius, settings.shortest = 0.12 * radius;
  WholeNumbers lengths, x, y, tones;
  for (const Streamline& line : streamlines(field, settings)) {
    const std::size_t before = x.size(), last = line.points.size() - 1;
    for (std::size_t i = 0; i <= last; i = i == last ? last + 1 : std::min(i + kEvery, last)) {
      x.push_back(on_grid(line.points[i].x(), kViewPositionStep));
      y.push_back(on_grid(line.points[i].y(), kViewPositionStep));
      tones.push_back(static_cast<std::int32_t>(std::lround(255 * line.speed[i] / peak)));
    }
    lengths.push_back(static_cast<std::int32_t>(x.size() - before));
  }
  const auto add = [&](const WholeNumbers& v) {
    return pack.add(v, std::max<std::size_t>(1, v.size()));
  };
  return {{"lengths", add(lengths)}, {"x", add(x)}, {"y", add(y)}, {"tone", add(tones)}};
}

void add_flows(const StoredRun& run, ViewPack& pack, Json& out) {
  const Model& model = run.scenario.model;
  const double peak = peak_of_all(model);
  out["flows"] = Json::array(), out["flow_changes"] = Json::array();
  if (peak <= 0) return;
  const Pumps pumps(run);
  for (int i = 0; i <= static_cast<int>(model.other_fields.size()); ++i) {
    Json flow = flow_json(*field_of(model, i), model.tank.radius, peak, pack);
    flow["power"] = pumps.power_of(i);
    out["flows"].push_back(std::move(flow));
  }
  for (const Pumps::Since& change : pumps.changes()) {
    out["flow_changes"].push_back({change.time, change.field});
  }
}

int most_copies(const Model& model) {
  int most = 0;
  for (const Ruleset& rules : model.rulesets) {
    most = std::max(most, possible_copies(rules, model.module.count));
  }
  return most;
}

}  // namespace

Json tank_json(const ViewTank& tank, double rate, ViewPack& pack) {
  const Trajectory& t = tank.run.trajectory;
  const Model& model = tank.run.scenario.model;
  const std::vector<std::size_t> frames = kept_frames(t, rate);
  const TimeGrid grid(std::max(std::fabs(t.time.front()), std::fabs(t.time.back())));
  Json out{{"name", tank.name},
           {"note", tank.note},
           {"radius", model.tank.radius},
           {"side", model.module.side},
           {"ball", model.ball.radius},
           {"bodies", t.bodies},
           {"modules", t.modules},
           {"frames", frames.size()},
           {"stored", t.frames()},
           {"latches", model.control.latches},
           {"possible", t.markings.empty() ? 0 : most_copies(model)},
           {"ticks", grid.ticks()}};
  out["ids"] = Json::array();
  for (const std::int64_t id : tank.ids) out["ids"].push_back(std::to_string(id));
  WholeNumbers times;
  for (const std::size_t f : frames) times.push_back(grid(t.time[f]));
  out["time"] = pack.add(times, times.size());
  add_poses(tank, frames, pack, out);
  add_markings(t, frames, pack, out);
  if (!tank.events.empty()) out["events"] = events_json(tank.events, grid, pack);
  add_flows(tank.run, pack, out);
  return out;
}

}  // namespace lilytank
