#include "tank.hpp"

#include <algorithm>
#include <cmath>

#include "palette.hpp"
#include "text/number.hpp"
#include "view/pumps.hpp"
#include "view/streamlines.hpp"

namespace lilytank {
namespace {

constexpr double kRimWidth = 9;  // units

void draw_water(const Canvas& canvas, const View& view, double radius) {
  const double r = view.scale * radius;
  cairo_pattern_t* water = cairo_pattern_create_radial(view.centre_x, view.centre_y, 0.15 * r,
                                                       view.centre_x, view.centre_y, r);
  const Colour &in = palette::water_centre, &out = palette::water_edge;
  cairo_pattern_add_color_stop_rgb(water, 0, in.r, in.g, in.b);
  cairo_pattern_add_color_stop_rgb(water, 1, out.r, out.g, out.b);
  canvas.circle(view.centre_x, view.centre_y, r);
  cairo_set_source(canvas.get(), water);
  cairo_fill(canvas.get());
  cairo_pattern_destroy(water);
}

// A nozzle through the rim at `angle`, blowing inwards `turn` off the radius.
void draw_inlet(const Canvas& canvas, const View& view, double radius, double angle, double turn) {
  const Saved saved(canvas);
  cairo_t* c = canvas.get();
  cairo_translate(c, view.x(radius * std::cos(angle)), view.y(radius * std::sin(angle)));
  cairo_rotate(c, -(angle + kPi - turn));  // +x is now the way the water comes in
  canvas.rounded(-34, -8, 30, 16, 3);
  canvas.fill_keep(palette::rim);
  canvas.stroke(palette::rim_line, 1.6);
  // The mouth narrows towards the water.
  cairo_move_to(c, -6, -8);
  cairo_line_to(c, 13, -4.5);
  cairo_line_to(c, 13, 4.5);
  cairo_line_to(c, -6, 8);
  cairo_close_path(c);
  canvas.fill_keep(mixed(palette::rim, palette::paper, 0.35));
  canvas.stroke(palette::rim_line, 1.6);
}

void draw_rim(const Canvas& canvas, const View& view, double radius) {
  const double r = view.scale * radius, w = kRimWidth;
  canvas.circle(view.centre_x, view.centre_y, r + w / 2);
  canvas.stroke(palette::rim, w);
  canvas.circle(view.centre_x, view.centre_y, r);
  canvas.stroke(palette::rim_line, 1.6);
  canvas.circle(view.centre_x, view.centre_y, r + w);
  canvas.stroke(palette::rim_line, 1.2);
}

// An arrow head with its tip at `tip`, pointing along `way` (metres, y up).
void arrow_head(const Canvas& canvas, const View& view, const Vec2& tip, const Vec2& way,
                double size, const Colour& colour) {
  const Vec2 aside(-way.y(), way.x());
  const double s = size / view.scale;
  const Vec2 left = tip - s * way + 0.42 * s * aside, right = tip - s * way - 0.42 * s * aside;
  const Vec2 notch = tip - 0.75 * s * way;
  cairo_t* c = canvas.get();
  cairo_move_to(c, view.x(tip.x()), view.y(tip.y()));
  cairo_line_to(c, view.x(left.x()), view.y(left.y()));
  cairo_line_to(c, view.x(notch.x()), view.y(notch.y()));
  cairo_line_to(c, view.x(right.x()), view.y(right.y()));
  cairo_close_path(c);
  canvas.fill(colour);
}

// Faster water is drawn stronger; the peak speed of all flows gives 1.
Colour stream_colour(double share) {
  return faded(palette::stream, 0.16 + 0.44 * share);
}

void draw_line(const Canvas& canvas, const View& view, const Streamline& line, double peak) {
  constexpr int kTones = 12;  // few, so that long pieces can be drawn at once
  cairo_t* c = canvas.get();
  const std::size_t n = line.points.size();
  const auto tone = [&](std::size_t i) {
    return std::min(kTones - 1, static_cast<int>(kTones * line.speed[i] / peak));
  };
  for (std::size_t i = 0; i + 1 < n;) {
    const int now = tone(i);
    cairo_move_to(c, view.x(line.points[i].x()), view.y(line.points[i].y()));
    do {
      ++i;
      cairo_line_to(c, view.x(line.points[i].x()), view.y(line.points[i].y()));
    } while (i + 1 < n && tone(i) == now);
    const double share = (now + 0.5) / kTones;
    canvas.stroke(stream_colour(share), 0.9 + 1.3 * share);
  }
  constexpr double kHeadEvery = 0.16;  // m, about one head a line; long lines get more
  const double length = (line.points[1] - line.points[0]).norm() * static_cast<double>(n - 1);
  const int heads = std::max(1, static_cast<int>(length / kHeadEvery));
  for (int k = 0; k < heads; ++k) {
    const std::size_t i = std::max<std::size_t>(
        1, static_cast<std::size_t>((k + 0.5) / heads * static_cast<double>(n - 1)));
    const double share = std::min(1.0, line.speed[i] / peak);
    const Vec2 way = (line.points[i] - line.points[i - 1]).normalized();
    arrow_head(canvas, view, line.points[i] + 5 / view.scale * way, way, (9 + 4 * share),
               stream_colour(share));
  }
}

void draw_streamlines(const Canvas& canvas, const View& view, double radius, const FlowField& field,
                      double peak) {
  StreamlineSettings settings;
  settings.radius = 0.985 * radius;
  settings.separation = 0.055 * radius;
  settings.step = 0.0065 * radius;
  settings.shortest = 0.12 * radius;
  for (const Streamline& line : streamlines(field, settings)) {
    draw_line(canvas, view, line, peak);
  }
}

void draw_arrows(const Canvas& canvas, const View& view, double radius, const FlowField& field,
                 double peak) {
  const double pitch = radius / 11;
  for (int iy = -11; iy <= 11; ++iy) {
    for (int ix = -11; ix <= 11; ++ix) {
      const Vec2 at(ix * pitch, iy * pitch);
      if (at.norm() > 0.95 * radius) continue;
      const FlowSample f = field.at(at.x(), at.y());
      const Vec2 u(f.mu_x, f.mu_y);
      const double share = std::min(1.0, u.norm() / peak);
      if (share < 0.02) continue;
      const Vec2 way = u.normalized();
      const Vec2 tail = at - 0.46 * pitch * share * way, tip = at + 0.46 * pitch * share * way;
      const double head = std::min((8 + 4 * share), 0.9 * view.scale * pitch * share);
      const Vec2 neck = tip - 0.7 * head / view.scale * way;
      const Colour colour = stream_colour(share);
      canvas.line(view.x(tail.x()), view.y(tail.y()), view.x(neck.x()), view.y(neck.y()), colour,
                  1.8);
      arrow_head(canvas, view, tip, way, head, colour);
    }
  }
}

}  // namespace

void draw_tank(const Canvas& canvas, const View& view, const Model& model, FlowStyle flow,
               int number) {
  const double radius = model.tank.radius, peak = peak_of_all(model);
  const FlowField* field = field_of(model, number);
  draw_water(canvas, view, radius);
  if (field && peak > 0 && flow != FlowStyle::none) {
    const Saved saved(canvas);
    canvas.circle(view.centre_x, view.centre_y, view.scale * radius);
    cairo_clip(canvas.get());
    if (flow == FlowStyle::streamlines)
      draw_streamlines(canvas, view, radius, *field, peak);
    else
      draw_arrows(canvas, view, radius, *field, peak);
  }
  draw_rim(canvas, view, radius);
  if (peak <= 0) return;
  // Measured flows come without their inlets; all are of the tank described in the paper.
  const AnalyticTank standard;
  for (int k = 0; k < standard.inlets; ++k) {
    draw_inlet(canvas, view, radius, 2 * kPi * k / standard.inlets, standard.inlet_angle);
  }
}

void draw_scale_bar(const Canvas& canvas, const View& view, const Model& model, double x, double y,
                    double least_text) {
  // In steps of 1, 2 and 5, about a third of the radius: 10 cm in the tank of 30 cm.
  const double wanted = model.tank.radius / 2.6;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  const double length = wanted >= 5 * decade   ? 5 * decade
                        : wanted >= 2 * decade ? 2 * decade
                                               : decade;
  const double end = x + view.scale * length;
  canvas.line(x, y, end, y, palette::ink, 3);
  for (const double at : {x, end}) {
    canvas.line(at, y - 7, at, y + 7, palette::ink, 3);
  }
  const std::string text =
      length < 1 ? significant(100 * length, 6) + " cm" : significant(length, 6) + " m";
  canvas.text((x + end) / 2, y - 14, text,
              {std::max(22.0, least_text), palette::ink, false, Align::centre});
}

}  // namespace lilytank
