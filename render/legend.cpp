#include <algorithm>
#include <set>

#include "bodies.hpp"
#include "palette.hpp"
#include "panel.hpp"
#include "text/number.hpp"
#include "view/pumps.hpp"
#include "view/streamlines.hpp"

namespace lilytank {
namespace {

constexpr double kChip = 44;       // side of a drawn module
constexpr double kRow = 64;        // height of a row
constexpr std::size_t kMost = 11;  // states that fit a row
const TextStyle kText{20, palette::muted, false, Align::left};

bool has_rules(const Model& model) {
  return std::any_of(model.rulesets.begin(), model.rulesets.end(),
                     [](const Ruleset& r) { return !r.rules.empty(); });
}

// The control states that modules of this run can have or had.
std::vector<int> states_of(const StoredRun& run) {
  std::set<int> states;
  if (!run.scenario.model.control.latches) return {0};
  for (const Ruleset& rules : run.scenario.model.rulesets) {
    for (const Rule& rule : rules.rules) {
      for (const Label& l : rule.before) states.insert(l.state);
      for (const Label& l : rule.after) states.insert(l.state);
    }
  }
  for (const Markings& m : run.trajectory.markings) states.insert(m.label);
  return {states.begin(), states.end()};
}

// A module in a neutral colour, its faces off.
ModuleLook plain_look() {
  ModuleLook look;
  look.fill = mixed(palette::isolated, palette::paper, 0.3);
  look.faces.fill(FaceLook::off);
  return look;
}

void draw_states(const Canvas& canvas, const std::vector<int>& states, double x, double y,
                 double width) {
  canvas.text(x, y + 7, "state", kText);
  double at = x + 130 + kChip / 2;
  const std::size_t shown = std::min(states.size(), kMost);
  const double pitch = std::min(
      kChip + 10, (width - 130 - kChip) / static_cast<double>(std::max<std::size_t>(shown, 2) - 1));
  for (std::size_t i = 0; i < shown; ++i) {
    ModuleLook look = plain_look();
    look.fill = colour_of_module(states[i], false);
    look.label = std::to_string(states[i]);
    const ModulePlace place{at, y, 0, std::min(kChip, pitch - 5)};
    draw_module(canvas, place, look);
    canvas.moving_text(place.x, place.y, look.label,
                       {0.42 * place.side, readable_on(look.fill), true, Align::centre});
    at += pitch;
  }
  if (shown < states.size())
    canvas.text(at - pitch / 2 + 6, y + 7, "…", kText);
  else if (at + 160 < x + width)
    canvas.text(at - 8, y + 7, "0: isolated", kText);
}

// Two modules side by side whose common face looks like `face`.
void draw_pair(const Canvas& canvas, FaceLook face, double x, double y) {
  const double gap = face == FaceLook::free ? 7 : 0, half = kChip / 2;
  ModuleLook left = plain_look(), right = left;
  left.faces[0] = right.faces[2] = face;
  const ModulePlace a{x - half - gap / 2, y, 0, 2 * half}, b{x + half + gap / 2, y, 0, 2 * half};
  const Saved saved(canvas);
  const double shown = 1.3 * half + gap / 2;  // of each; the rest is cut off
  cairo_rectangle(canvas.get(), x - shown, y - half, 2 * shown, 2 * half);
  cairo_clip(canvas.get());
  draw_module(canvas, a, left);
  draw_module(canvas, b, right);
  draw_connectors(canvas, a, left);
  draw_connectors(canvas, b, right);
}

void draw_faces(const Canvas& canvas, bool rules, double x, double y) {
  struct Entry {
    FaceLook face;
    const char* name;
    double at;
  };
  canvas.text(x, y + 7, "faces", kText);
  for (const Entry& e :
       {Entry{FaceLook::free, "free", 130}, Entry{FaceLook::latched, "latched", 312},
        Entry{FaceLook::bonded, "bonded", 524}}) {
    if (e.face == FaceLook::bonded && !rules) continue;
    draw_pair(canvas, e.face, x + e.at + 32, y);
    canvas.text(x + e.at + 78, y + 7, e.name, kText);
  }
}

void draw_last(const Canvas& canvas, double x, double y) {
  ModuleLook look = plain_look();
  look.last = 0;
  const ModulePlace place{x + kChip / 2, y, 0, kChip};
  draw_module(canvas, place, look);
  draw_connectors(canvas, place, look);
  canvas.text(place.x + kChip / 2 + 14, y + 7, "engaged last", kText);
}

void draw_finished(const Canvas& canvas, double x, double y) {
  const ModulePlace place{x + kChip / 2, y, 0, kChip * 0.8};
  module_path(canvas, place);
  draw_halo(canvas);
  draw_module(canvas, place, plain_look());
  canvas.text(place.x + kChip / 2 + 14, y + 7, "part of a finished copy", kText);
}

void draw_flow(const Canvas& canvas, const Model& model, const FlowField& field, double x,
               double y) {
  canvas.text(x, y + 7, "water", kText);
  const std::string text = "mean flow, stronger where faster, up to " +
                           significant(model.flow.K_v * peak_speed(field, model.tank.radius), 2) +
                           " m/s";
  for (int i = 0; i < 3; ++i) {
    const double strength = 0.22 + 0.25 * i, top = y - 10 + 10 * i;
    canvas.line(x + 130, top, x + 174, top, faded(palette::stream, strength), 1 + 0.7 * i);
  }
  canvas.text(x + 188, y + 7, text, kText);
}

// What can appear on a run's frames, and so is explained.
struct Signs {
  std::vector<int> states;
  bool faces = false, last = false, finished = false, flow = false;
  int rows() const { return !states.empty() + faces + (last || finished) + flow; }
};

Signs signs_of(const StoredRun& run, const FrameStyle& style) {
  const Model& model = run.scenario.model;
  Signs out;
  out.flow = style.flow != FlowStyle::none && peak_of_all(model) > 0;
  if (run.trajectory.modules == 0 || run.trajectory.markings.empty()) return out;
  out.states = states_of(run);
  // One state alone is one colour for all, which says something only by its number.
  if (out.states.size() < 2 && !style.labels) out.states.clear();
  out.faces = model.control.latches;
  out.last = style.labels && out.faces && has_rules(model);
  out.finished = out.faces && std::any_of(model.rulesets.begin(), model.rulesets.end(),
                                          [](const Ruleset& r) { return !r.target.empty(); });
  return out;
}

}  // namespace

void draw_legend(const Canvas& canvas, const StoredRun& run, const FrameStyle& style, int field,
                 double x, double y, double width) {
  const Signs signs = signs_of(run, style);
  const Model& model = run.scenario.model;
  double row = y + kRow / 2;
  if (!signs.states.empty()) draw_states(canvas, signs.states, x, row, width), row += kRow;
  if (signs.faces) draw_faces(canvas, has_rules(model), x, row), row += kRow;
  if (signs.last) draw_last(canvas, x + 130, row);
  if (signs.finished) draw_finished(canvas, x + (signs.last ? 390 : 130), row);
  if (signs.last || signs.finished) row += kRow;
  const FlowField* in_force = field_of(model, field);
  if (signs.flow && in_force) draw_flow(canvas, model, *in_force, x, row);
}

double legend_height(const StoredRun& run, const FrameStyle& style) {
  return kRow * signs_of(run, style).rows();
}

}  // namespace lilytank
