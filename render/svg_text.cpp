#include "svg_text.hpp"

#include <cmath>
#include <cstdlib>

#include "text/number.hpp"
#include "text/printable.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr int kFirst = 1000;  // miter limit of the first place; lines of figures have Cairo's, 10

std::string hex(const Colour& c) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "#";
  for (const double channel : {c.r, c.g, c.b}) {
    const auto byte = static_cast<unsigned>(std::lround(255 * channel));
    out += kDigits[byte / 16 % 16], out += kDigits[byte % 16];
  }
  return out;
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

}  // namespace

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
  text += "\" fill=\"" + hex(style.colour) + "\"" + attribute("font-size", style.size);
  if (style.colour.a < 1) text += attribute("fill-opacity", style.colour.a);
  if (style.bold) text += " font-weight=\"bold\"";
  text += attribute("textLength", width) + " lengthAdjust=\"spacingAndGlyphs\">";
  texts.push_back(text + escaped(printable(s)) + "</text>");
}

std::string with_texts(const std::string& svg, const std::vector<std::string>& texts,
                       const std::string& family) {
  std::string out;
  std::size_t done = 0;
  const auto copy_to = [&](std::size_t end) { out.append(svg, done, end - done), done = end; };
  const std::string root = "<svg", path = "<path";
  copy_to(svg.find(root) + root.size());
  // Cairo sets glyph beside glyph, without kerning and ligatures.
  out += " font-family=\"'" + family +
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

}  // namespace lilytank
