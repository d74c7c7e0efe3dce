// A drawing surface that frees itself, and the few strokes that the pictures are made of.
#pragma once
#include <cairo.h>

#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "colour.hpp"

namespace lilytank {

enum class PictureFormat { png, svg, pdf };

/// Points per unit on paper: texts of 12 units, the smallest of figures, have 6 pt.
inline constexpr double kPointsPerUnit = 0.5;
/// Units per millimetre on paper.
inline constexpr double kUnitsPerMm = 72 / 25.4 / kPointsPerUnit;

/// The format of a file by its ending (.png, .svg, .pdf; case does not matter). Throws InputError
/// naming the endings of those `allowed` where it is none of them.
PictureFormat format_of(const std::string& file,
                        std::initializer_list<PictureFormat> allowed = {
                            PictureFormat::png, PictureFormat::svg, PictureFormat::pdf});

enum class Align { left, centre, right };

/// How text is set: size in user units, weight, colour and where `x` lies in it.
struct TextStyle {
  double size = 20;
  Colour colour;
  bool bold = false;
  Align align = Align::left;
};

/// A Cairo surface with its context. y grows downwards, as everywhere in Cairo. Throws
/// InputError where the surface cannot be made (too large a picture).
class Canvas {
 public:
  /// Pixels in memory, 4 bytes each: blue, green, red, unused.
  static Canvas raster(int width, int height);
  /// A page of `width` x `height` units; `format` is svg or pdf. A unit is as many points, or, of
  /// an SVG where that is 0, a pixel. A PDF has no date: equal figures have equal bytes.
  static Canvas vector(PictureFormat format, double width, double height, double points = 0);
  /// White paper, raster or vector by `format`. A PDF has kPointsPerUnit; so has an SVG if `print`,
  /// else a pixel a unit; a raster has 600 pixels an inch if `print`, else two a unit.
  static Canvas page(PictureFormat format, double width, double height, bool print = false);
  /// Paints all of it white.
  void clear() const;

  /// The context, for paths.
  cairo_t* get() const { return context_.get(); }

  void colour(const Colour& c) const;
  /// Fills the path and forgets it.
  void fill(const Colour& c) const;
  void fill_keep(const Colour& c) const;
  /// Strokes the path and forgets it; width in user units.
  void stroke(const Colour& c, double width) const;
  /// Adds a rectangle with round corners to the path.
  void rounded(double x, double y, double width, double height, double radius) const;
  void line(double x0, double y0, double x1, double y1, const Colour& c, double width) const;
  /// Adds a full circle to the path, as a figure of its own.
  void circle(double x, double y, double radius) const;

  /// Writes text with its baseline at y; in SVG as text that can be selected and searched.
  void text(double x, double y, const std::string& s, const TextStyle& style) const;
  /// Text along a vertical line, upwards.
  void upright_text(double x, double y, const std::string& s, const TextStyle& style) const;
  /// Text centred at (x, y), the middle of its digits' height. In a raster an outline: a little
  /// slower, but it may lie between two pixels, so that text on a moving body moves with it.
  void moving_text(double x, double y, const std::string& s, const TextStyle& style) const;
  /// Width of a text in user units.
  double width_of(const std::string& s, const TextStyle& style) const;
  /// The text cut to `width` with an ellipsis, if it is longer.
  std::string fitted(const std::string& s, double width, const TextStyle& style) const;

  /// The rows of a raster, top first, `stride` bytes each (stride = 4 * width).
  std::span<unsigned char> pixels() const;
  /// Ends the drawing and returns the file's bytes: PNG for a raster, else SVG or PDF.
  std::string encoded();

 private:
  // Where a vector surface writes to.
  struct Sink {
    explicit Sink(PictureFormat f) : format(f) {}
    PictureFormat format;
    std::string bytes;
    std::vector<std::string> texts;  // of an SVG, in the order of drawing
  };
  Canvas(cairo_surface_t* surface, std::unique_ptr<Sink> sink);
  void font(const TextStyle& style) const;
  struct SurfaceEnd {
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
  };
  struct ContextEnd {
    void operator()(cairo_t* c) const { cairo_destroy(c); }
  };
  std::unique_ptr<Sink> sink_;  // outlives the surface, which writes to it; null: raster
  std::unique_ptr<cairo_surface_t, SurfaceEnd> surface_;
  std::unique_ptr<cairo_t, ContextEnd> context_;
};

/// Keeps a context's settings for the length of a block.
class Saved {
 public:
  explicit Saved(const Canvas& canvas) : context_(canvas.get()) { cairo_save(context_); }
  ~Saved() { cairo_restore(context_); }
  Saved(const Saved&) = delete;
  Saved& operator=(const Saved&) = delete;

 private:
  cairo_t* context_;
};

}  // namespace lilytank
