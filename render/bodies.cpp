#include "bodies.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

constexpr Colour kBall{0.992, 0.988, 0.976};
constexpr Colour kBallLine{0.471, 0.443, 0.400};

FaceLook face_look(const Markings& m, int face, bool latches) {
  const int bit = 1 << face;
  if (m.bonded & bit) return FaceLook::bonded;
  if (m.latched & bit) return FaceLook::latched;
  return latches ? FaceLook::free : FaceLook::off;
}

constexpr double kCorner = 0.14;  // radius of a module's corners, in sides

// Brings a module's frame into place: origin in its centre, one unit a side, y up.
void enter(const Canvas& canvas, const ModulePlace& place) {
  cairo_translate(canvas.get(), place.x, place.y);
  cairo_rotate(canvas.get(), -place.theta);
  cairo_scale(canvas.get(), place.side, -place.side);
}

// In the frame of a face: +x outwards, the face at x = 1/2.
void draw_face(const Canvas& canvas, FaceLook look, const Colour& fill, double line) {
  cairo_t* c = canvas.get();
  switch (look) {
    case FaceLook::bonded:  // half of a bridge; the neighbour draws the other half
      cairo_rectangle(c, 0.5 - 0.13, -0.15, 0.13 + 0.01, 0.30);
      canvas.fill(palette::ink);
      break;
    case FaceLook::latched:  // half of an open ring
      cairo_arc(c, 0.5, 0, 0.115, kPi / 2, 1.5 * kPi);
      canvas.fill_keep(palette::paper);
      canvas.stroke(palette::ink, 1.6 * line);
      break;
    case FaceLook::free:  // a notch
      cairo_arc(c, 0.5 - line, 0, 0.06, kPi / 2, 1.5 * kPi);
      canvas.fill(faded(readable_on(fill), 0.55));
      break;
    case FaceLook::off:  // a dead face: a pale dash
      cairo_move_to(c, 0.5 - 0.055, -0.10);
      cairo_line_to(c, 0.5 - 0.055, 0.10);
      canvas.stroke(faded(readable_on(fill), 0.35), 1.2 * line);
      break;
  }
}

// The mark of the connector engaged last: a bar along the face.
void draw_last(const Canvas& canvas, const Colour& fill, double line) {
  cairo_move_to(canvas.get(), 0.5 - 0.085, -0.29);
  cairo_line_to(canvas.get(), 0.5 - 0.085, 0.29);
  cairo_set_line_cap(canvas.get(), CAIRO_LINE_CAP_ROUND);
  const bool dark = readable_on(fill).r < 0.5;
  canvas.stroke(dark ? palette::accent : palette::paper, std::max(0.062, 1.5 * line));
}

}  // namespace

Colour colour_of_module(int state, bool complete) {
  const Colour full = colour_of_state(state);
  return complete ? full : mixed(full, palette::paper, 0.28);
}

void module_path(const Canvas& canvas, const ModulePlace& place) {
  const Saved saved(canvas);
  enter(canvas, place);
  canvas.rounded(-0.5, -0.5, 1, 1, kCorner);
}

void draw_halo(const Canvas& canvas) {
  canvas.colour(faded(palette::halo, 0.30));
  cairo_set_line_width(canvas.get(), 24);
  cairo_stroke_preserve(canvas.get());
  canvas.stroke(palette::halo, 11);
}

void draw_module(const Canvas& canvas, const ModulePlace& place, const ModuleLook& look) {
  module_path(canvas, place);
  canvas.fill(look.fill);
  // The outline lies inside, so that the square has its exact size.
  const double line = 1.6;
  ModulePlace inner = place;
  inner.side -= line;
  module_path(canvas, inner);
  canvas.stroke(mixed(look.fill, palette::ink, 0.55), line);
}

void draw_connectors(const Canvas& canvas, const ModulePlace& place, const ModuleLook& look) {
  {
    const Saved saved(canvas);
    enter(canvas, place);
    for (int face = 0; face < 4; ++face) {
      const Saved turned(canvas);
      cairo_rotate(canvas.get(), face * kPi / 2);
      if (look.last == face) draw_last(canvas, look.fill, 1 / place.side);
      draw_face(canvas, look.faces[static_cast<std::size_t>(face)], look.fill, 1 / place.side);
    }
  }
  if (look.label.empty()) return;
  const bool few = look.label.size() < 3;
  const double size = std::max((few ? 0.42 : 0.34) * place.side, look.least_text);
  if (size > (few ? 0.62 : 0.42) * place.side) return;
  canvas.moving_text(place.x, place.y, look.label, {size, readable_on(look.fill), true});
}

BodyPainter::BodyPainter(const Model& model, const View& view, bool labels, double least_text)
    : model_(model), view_(view), labels_(labels), least_text_(least_text) {}

ModulePlace BodyPainter::place(const BodyPose& pose) const {
  return {view_.x(pose.x), view_.y(pose.y), pose.theta, view_.scale * model_.module.side};
}

ModuleLook BodyPainter::look(const Snapshot& now, int i) const {
  ModuleLook look;
  look.fill = palette::isolated;
  look.faces.fill(FaceLook::off);
  if (now.marks.empty()) return look;
  const Markings& m = now.marks[static_cast<std::size_t>(i)];
  look.fill = colour_of_module(m.label, m.complete != 0);
  for (int face = 0; face < 4; ++face) {
    look.faces[static_cast<std::size_t>(face)] = face_look(m, face, model_.control.latches);
  }
  if (labels_) {
    look.label = std::to_string(m.label), look.least_text = least_text_;
    look.last = m.last;
  }
  return look;
}

void BodyPainter::shadows(const Canvas& canvas, const Snapshot& now) const {
  for (std::size_t i = 0; i < now.poses.size(); ++i) {
    ModulePlace p = place(now.poses[i]);
    p.x += 2.5, p.y += 4;
    if (static_cast<int>(i) < now.modules)
      module_path(canvas, p);
    else
      canvas.circle(p.x, p.y, view_.scale * model_.ball.radius);
  }
  canvas.fill(faded(palette::ink, 0.13));
}

void BodyPainter::halo(const Canvas& canvas, const Snapshot& now) const {
  bool any = false;
  for (int i = 0; i < now.modules; ++i) {
    if (!now.complete(i)) continue;
    module_path(canvas, place(now.poses[static_cast<std::size_t>(i)]));
    any = true;
  }
  if (any) draw_halo(canvas);
}

void BodyPainter::balls(const Canvas& canvas, const Snapshot& now) const {
  const double radius = view_.scale * model_.ball.radius, line = 1.8;
  for (std::size_t i = static_cast<std::size_t>(now.modules); i < now.poses.size(); ++i) {
    const double x = view_.x(now.poses[i].x), y = view_.y(now.poses[i].y);
    canvas.circle(x, y, radius);
    canvas.fill(kBall);
    canvas.circle(x, y, radius - line / 2);
    canvas.stroke(kBallLine, line);
    cairo_new_sub_path(canvas.get());  // a gleam, so that a ball does not look like a hole
    cairo_arc(canvas.get(), x, y, 0.66 * radius, 1.12 * kPi, 1.42 * kPi);
    canvas.stroke(faded(kBallLine, 0.45), line);
  }
}

void BodyPainter::bodies(const Canvas& canvas, const Snapshot& now) const {
  shadows(canvas, now);
  balls(canvas, now);
  halo(canvas, now);
  for (int i = 0; i < now.modules; ++i) {
    draw_module(canvas, place(now.poses[static_cast<std::size_t>(i)]), look(now, i));
  }
  for (int i = 0; i < now.modules; ++i) {
    draw_connectors(canvas, place(now.poses[static_cast<std::size_t>(i)]), look(now, i));
  }
}

void BodyPainter::collect_trail(const Trajectory& trajectory, const Snapshot& now, double seconds,
                                int body) {
  trail_.clear();
  const auto b = static_cast<std::size_t>(body);
  const auto bodies = static_cast<std::size_t>(trajectory.bodies);
  trail_.push_back({{start_.poses[b].x, start_.poses[b].y}, now.time - start_.time});
  for (int f = start_.frame + 1; f <= now.frame; ++f) {
    const std::size_t i = static_cast<std::size_t>(f) * bodies + b;
    const double age = now.time - trajectory.time[static_cast<std::size_t>(f)];
    if (age > 0 && age < seconds) trail_.push_back({{trajectory.x[i], trajectory.y[i]}, age});
  }
  trail_.push_back({{now.poses[b].x, now.poses[b].y}, 0});
}

// Straight pieces between stored frames would show corners: a Catmull-Rom spline rounds them.
void BodyPainter::draw_trail(const Canvas& canvas, const Colour& colour, double seconds) const {
  constexpr int kTones = 12;
  cairo_t* c = canvas.get();
  const std::size_t n = trail_.size();
  const auto tone = [&](std::size_t i) {
    const double age = 0.5 * (trail_[i].age + trail_[i + 1].age);
    return std::clamp(static_cast<int>(kTones * (1 - age / seconds)), 0, kTones - 1);
  };
  for (std::size_t i = 0; i + 1 < n;) {
    const int now = tone(i);
    cairo_move_to(c, view_.x(trail_[i].at.x()), view_.y(trail_[i].at.y()));
    for (; i + 1 < n && tone(i) == now; ++i) {
      const Vec2 &p = trail_[i].at, &q = trail_[i + 1].at;
      const Vec2 before = i > 0 ? trail_[i - 1].at : p, after = i + 2 < n ? trail_[i + 2].at : q;
      const Vec2 k1 = p + (q - before) / 6, k2 = q - (after - p) / 6;
      cairo_curve_to(c, view_.x(k1.x()), view_.y(k1.y()), view_.x(k2.x()), view_.y(k2.y()),
                     view_.x(q.x()), view_.y(q.y()));
    }
    const double share = (now + 0.5) / kTones;
    canvas.stroke(faded(colour, 0.62 * std::pow(share, 1.4)), (1.6 + 3.2 * share));
  }
}

void BodyPainter::trails(const Canvas& canvas, const Trajectory& trajectory, const Snapshot& now,
                         double seconds) {
  if (!(seconds > 0)) return;
  interpolate(trajectory, model_.module.side, std::max(trajectory.time.front(), now.time - seconds),
              start_);
  const Saved saved(canvas);
  cairo_set_line_cap(canvas.get(), CAIRO_LINE_CAP_BUTT);
  cairo_set_tolerance(canvas.get(), 0.3);
  for (int body = 0; body < trajectory.bodies; ++body) {
    collect_trail(trajectory, now, seconds, body);
    const bool labelled = body < now.modules && !now.marks.empty();
    const int label = labelled ? now.marks[static_cast<std::size_t>(body)].label : 0;
    // Neutral trails are darker, to stand out from the water.
    draw_trail(canvas, mixed(colour_of_state(label), palette::ink, label > 0 ? 0.28 : 0.48),
               seconds);
  }
}

}  // namespace lilytank
