#include "modules.hpp"

#include <algorithm>
#include <cmath>

#include "lilytank/math.hpp"
#include "palette.hpp"

namespace lilytank {
namespace {

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
  const double size = (look.label.size() < 3 ? 0.42 : 0.34) * place.side;
  canvas.moving_text(place.x, place.y, look.label, {size, readable_on(look.fill), true});
}

}  // namespace lilytank
