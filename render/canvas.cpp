#include "canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "cut_text.hpp"
#include "lilytank/error.hpp"
#include "lilytank/math.hpp"
#include "palette.hpp"
#include "text/number.hpp"
#include "text/printable.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

// DejaVu is in every distribution and has all signs that the pictures use; where it is missing,
// the system's sans serif steps in.
constexpr char kFamily[] = "DejaVu Sans";

constexpr const char* kEndings[] = {".png", ".svg", ".pdf"};  // by PictureFormat

// Called from C, so no exception may leave it.
cairo_status_t append(void* sink, const unsigned char* data, unsigned length) {
  try {
    static_cast<std::string*>(sink)->append(reinterpret_cast<const char*>(data), length);
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

// Cairo's SVG knows text as outlines only. A stroke with a miter limit that numbers it holds a
// text's place in the order of drawing and under its clip, until with_texts() puts the text there.
constexpr int kFirst = 1000;  // miter limit of the first place; lines of figures have Cairo's, 10

std::string hex_of(const Colour& c) {
  const auto byte = [](double channel) {
    return static_cast<unsigned>(std::lround(255 * channel));
  };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(c.r) & 255, byte(c.g) & 255,
                byte(c.b) & 255);
  return text;
}

std::string attribute(const std::string& name, double value) {
  return " " + name + "=\"" + significant(value, 7) + "\"";
}

// The place's number; none: -1. Cairo 1.16 writes "stroke-miterlimit:1000;", later ones an
// attribute.
int place_of(const std::string& path) {
  const std::string mark = "stroke-miterlimit";
  const auto at = path.find(mark);
  if (at == std::string::npos) return -1;
  const auto digits = path.find_first_of("0123456789", at + mark.size());
  return digits == std::string::npos ? -1 : std::atoi(path.c_str() + digits) - kFirst;
}

// The stroke is as wide as the text, which has that width in every font.
void hold_text_place(const Canvas& canvas, double x, double y, double width, const std::string& s,
                     const TextStyle& style, std::vector<std::string>& texts) {
  if (s.empty()) return;
  const Saved saved(canvas);
  cairo_set_miter_limit(canvas.get(), kFirst + static_cast<double>(texts.size()));
  canvas.line(x, y, x + width, y, style.colour, style.size);
  cairo_matrix_t m;
  cairo_get_matrix(canvas.get(), &m);
  cairo_matrix_translate(&m, x, y);
  std::string text = "<text transform=\"matrix(";
  for (const double v : {m.xx, m.yx, m.xy, m.yy, m.x0, m.y0}) text += significant(v, 7) + " ";
  text.back() = ')';
  text += "\" fill=\"" + hex_of(style.colour) + "\"" + attribute("font-size", style.size);
  if (style.colour.a < 1) text += attribute("fill-opacity", style.colour.a);
  if (style.bold) text += " font-weight=\"bold\"";
  text += attribute("textLength", width) + " lengthAdjust=\"spacingAndGlyphs\">";
  texts.push_back(text + escaped(printable(s)) + "</text>");
}

// The SVG with those strokes replaced by their texts, in the font family.
std::string with_texts(const std::string& svg, const std::vector<std::string>& texts) {
  std::string out;
  std::size_t done = 0;
  const auto copy_to = [&](std::size_t end) { out.append(svg, done, end - done), done = end; };
  const std::string root = "<svg", path = "<path";
  copy_to(svg.find(root) + root.size());
  // Cairo sets glyph beside glyph, without kerning and ligatures.
  out += " font-family=\"'" + std::string(kFamily) +
         "', Verdana, sans-serif\" xml:space=\"preserve\""
         " style=\"font-kerning:none;font-variant-ligatures:none\"";
  for (auto at = svg.find(path, done); at != std::string::npos; at = svg.find(path, done)) {
    const auto end = svg.find("/>", at) + 2;
    const int place = place_of(svg.substr(at, end - at));
    copy_to(place < 0 ? end : at);
    if (place >= 0) out += texts.at(static_cast<std::size_t>(place)), done = end;
  }
  copy_to(svg.size());
  return out;
}

}  // namespace

PictureFormat format_of(const std::string& file, std::initializer_list<PictureFormat> allowed) {
  const std::string low = in_small_letters(file);
  std::string names;
  for (const PictureFormat f : allowed) {
    const std::string ending = kEndings[static_cast<int>(f)];
    if (low.ends_with(ending) && low.size() > ending.size()) return f;
    names += (names.empty() ? "" : f == *(allowed.end() - 1) ? " or " : ", ") + ending;
  }
  throw InputError("cannot determine the picture's format from '" + file +
                   "': its name must end in " + names);
}

Canvas::Canvas(cairo_surface_t* surface, std::unique_ptr<Sink> sink)
    : sink_(std::move(sink)), surface_(surface), context_(cairo_create(surface)) {
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
    throw InputError(std::string("cannot make the picture: ") +
                     cairo_status_to_string(cairo_surface_status(surface)));
  }
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  // Without hinting a text has the same proportions at every size of the picture.
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(get(), options);
  cairo_font_options_destroy(options);
  cairo_set_line_join(get(), CAIRO_LINE_JOIN_ROUND);
}

Canvas Canvas::raster(int width, int height) {
  return Canvas(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), nullptr);
}

Canvas Canvas::vector(PictureFormat format, double width, double height, double points) {
  auto sink = std::make_unique<Sink>(format);
  const bool pixels = points <= 0;
  const double scale = pixels ? 1 : points, w = scale * width, h = scale * height;
  cairo_surface_t* surface = format == PictureFormat::pdf
                                 ? cairo_pdf_surface_create_for_stream(append, &sink->bytes, w, h)
                                 : cairo_svg_surface_create_for_stream(append, &sink->bytes, w, h);
  if (format == PictureFormat::svg) {
    cairo_svg_surface_set_document_unit(surface, pixels ? CAIRO_SVG_UNIT_PX : CAIRO_SVG_UNIT_PT);
  } else {
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  }
  Canvas canvas(surface, std::move(sink));
  cairo_scale(canvas.get(), scale, scale);
  return canvas;
}

Canvas Canvas::page(PictureFormat format, double width, double height, bool print) {
  if (format != PictureFormat::png) {
    const bool points = print || format == PictureFormat::pdf;
    Canvas canvas = vector(format, width, height, points ? kPointsPerUnit : 0);
    canvas.clear();
    return canvas;
  }
  const double pixels = print ? 600 * kPointsPerUnit / 72 : 2;
  Canvas canvas = raster(static_cast<int>(std::lround(width * pixels)),
                         static_cast<int>(std::lround(height * pixels)));
  cairo_scale(canvas.get(), pixels, pixels);
  canvas.clear();
  return canvas;
}

void Canvas::clear() const {
  colour(palette::paper);
  cairo_paint(get());
}

void Canvas::colour(const Colour& c) const {
  cairo_set_source_rgba(get(), c.r, c.g, c.b, c.a);
}

void Canvas::fill(const Colour& c) const {
  colour(c);
  cairo_fill(get());
}

void Canvas::fill_keep(const Colour& c) const {
  colour(c);
  cairo_fill_preserve(get());
}

void Canvas::stroke(const Colour& c, double width) const {
  colour(c);
  cairo_set_line_width(get(), width);
  cairo_stroke(get());
}

void Canvas::rounded(double x, double y, double width, double height, double radius) const {
  const double r = std::min({radius, width / 2, height / 2});
  cairo_new_sub_path(get());
  cairo_arc(get(), x + width - r, y + r, r, -kPi / 2, 0);
  cairo_arc(get(), x + width - r, y + height - r, r, 0, kPi / 2);
  cairo_arc(get(), x + r, y + height - r, r, kPi / 2, kPi);
  cairo_arc(get(), x + r, y + r, r, kPi, 1.5 * kPi);
  cairo_close_path(get());
}

void Canvas::line(double x0, double y0, double x1, double y1, const Colour& c, double width) const {
  cairo_move_to(get(), x0, y0);
  cairo_line_to(get(), x1, y1);
  stroke(c, width);
}

void Canvas::circle(double x, double y, double radius) const {
  cairo_new_sub_path(get());
  cairo_arc(get(), x, y, radius, 0, 2 * kPi);
  cairo_close_path(get());
}

void Canvas::font(const TextStyle& style) const {
  cairo_select_font_face(get(), kFamily, CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(get(), style.size);
}

double Canvas::width_of(const std::string& s, const TextStyle& style) const {
  font(style);
  cairo_text_extents_t box;
  cairo_text_extents(get(), s.c_str(), &box);
  return box.x_advance;
}

void Canvas::text(double x, double y, const std::string& s, const TextStyle& style) const {
  const double width = width_of(s, style);
  const double left = x - (style.align == Align::right    ? width
                           : style.align == Align::centre ? width / 2
                                                          : 0);
  if (sink_ && sink_->format == PictureFormat::svg) {
    return hold_text_place(*this, left, y, width, s, style, sink_->texts);
  }
  colour(style.colour);
  cairo_move_to(get(), left, y);
  cairo_show_text(get(), s.c_str());
  cairo_new_path(get());
}

void Canvas::upright_text(double x, double y, const std::string& s, const TextStyle& style) const {
  const Saved saved(*this);
  cairo_translate(get(), x, y);
  cairo_rotate(get(), -kPi / 2);
  text(0, 0, s, style);
}

void Canvas::moving_text(double x, double y, const std::string& s, const TextStyle& style) const {
  constexpr double kDigitHeight = 0.729;  // of DejaVu Sans, in font sizes
  const double base = y + kDigitHeight / 2 * style.size;
  if (sink_) return text(x, base, s, {style.size, style.colour, style.bold, Align::centre});
  cairo_move_to(get(), x - width_of(s, style) / 2, base);
  cairo_text_path(get(), s.c_str());
  fill(style.colour);
}

std::string Canvas::fitted(const std::string& s, double width, const TextStyle& style) const {
  return begin_within(s, width, [&](const std::string& text) { return width_of(text, style); });
}

std::span<unsigned char> Canvas::pixels() const {
  cairo_surface_t* s = surface_.get();
  cairo_surface_flush(s);
  const auto bytes = static_cast<std::size_t>(cairo_image_surface_get_stride(s)) *
                     static_cast<std::size_t>(cairo_image_surface_get_height(s));
  return {cairo_image_surface_get_data(s), bytes};
}

std::string Canvas::encoded() {
  std::string bytes;
  cairo_status_t status = cairo_status(get());
  if (status == CAIRO_STATUS_SUCCESS) {
    if (sink_) {
      cairo_surface_finish(surface_.get());
      status = cairo_surface_status(surface_.get());
      bytes = std::move(sink_->bytes);
      if (sink_->format == PictureFormat::svg) bytes = with_texts(bytes, sink_->texts);
    } else {
      cairo_surface_flush(surface_.get());
      status = cairo_surface_write_to_png_stream(surface_.get(), append, &bytes);
    }
  }
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InputError(std::string("cannot make the picture: ") + cairo_status_to_string(status));
  }
  return bytes;
}

}  // namespace lilytank
