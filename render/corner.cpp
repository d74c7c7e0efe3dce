// Corner plots: parameters in pairs below the diagonal, one by one on it.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/atomic_file.hpp"
#include "page_fit.hpp"
#include "palette.hpp"
#include "plot_area.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kLeftRoom = 84, kRightRoom = 18, kTopRoom = 18, kBottomRoom = 82, kCellGap = 10;
constexpr double kCellAlone = 150;            // units, off paper
constexpr double kEveryX = 42, kEveryY = 30;  // units from a number to the next
constexpr int kHistogramBins = 20;
const TextStyle kCornerNumber{12, palette::ink, false, Align::centre};
const TextStyle kCornerLabel{14, palette::ink, false, Align::centre};
const TextStyle kPriorText{12, palette::muted, false, Align::centre};
const TextStyle kCornerEntry{13, palette::ink, false, Align::left};

// The axis of a parameter over all that is drawn of it; the prior's bounds only where they are
// near.
Axis axis_over(const Corner& corner, std::size_t k, double length, double every) {
  const CornerAxis& of = corner.axes[k];
  Range range;
  for (const auto& draw : corner.draws) range.add(draw[k], of.log);
  for (const double v : {of.estimate, of.from, of.to, of.truth}) range.add(v, of.log);
  double low = range.empty() ? of.low : range.low(), high = range.empty() ? of.high : range.high();
  constexpr double kRoom = 0.06;
  if (of.log && low > 0) {
    const double by = std::pow(high / low, kRoom);
    low /= by, high *= by;
  } else {
    const double room = kRoom * (high - low);
    low -= room, high += room;
  }
  return make_axis(low, high, of.log, static_cast<int>(length / every), false);
}

class CornerPainter {
 public:
  CornerPainter(const Canvas& canvas, const Corner& corner, double left, double top, double cell)
      : canvas_(canvas), corner_(corner), left_(left), top_(top), cell_(cell) {
    for (std::size_t k = 0; k < corner.axes.size(); ++k) {
      x_.push_back(axis_over(corner, k, cell, kEveryX));
      y_.push_back(axis_over(corner, k, cell, kEveryY));
    }
  }

  void draw() {
    for (std::size_t row = 0; row < corner_.axes.size(); ++row) {
      for (std::size_t column = 0; column <= row; ++column) draw_cell(row, column);
    }
    legend();
  }

 private:
  PlotArea area_of(std::size_t row, std::size_t column) const {
    PlotArea area;
    area.left = left_ + static_cast<double>(column) * (cell_ + kCellGap);
    area.top = top_ + static_cast<double>(row) * (cell_ + kCellGap);
    area.width = area.height = cell_;
    area.x = x_[column];
    if (row != column) area.y = y_[row];
    return area;
  }

  void draw_cell(std::size_t row, std::size_t column) const {
    const PlotArea area = area_of(row, column);
    {
      const Saved saved(canvas_);
      cairo_rectangle(canvas_.get(), area.left, area.top, cell_, cell_);
      cairo_clip(canvas_.get());
      outside_prior(area, corner_.axes[column], true);
      if (row != column) outside_prior(area, corner_.axes[row], false);
      row == column ? histogram(area, column) : scatter(area, row, column);
    }
    cairo_rectangle(canvas_.get(), area.left, area.top, cell_, cell_);
    canvas_.stroke(palette::ink, 1.1);
    const bool bottom = row + 1 == corner_.axes.size();
    ticks(area, true, bottom);
    if (row != column) ticks(area, false, column == 0);
    if (bottom) x_label(area, column);
    if (column == 0 && row > 0) {
      const auto [name, style] = label_of(row);
      canvas_.upright_text(20, area.top + cell_ / 2, name, style);
    }
  }

  // What the prior excludes, and its bounds.
  void outside_prior(const PlotArea& area, const CornerAxis& of, bool across) const {
    for (const bool upper : {false, true}) {
      const double bound = upper ? of.high : of.low;
      if (std::isnan(bound)) continue;
      const double at = across ? area.at_x(bound) : area.at_y(bound);
      if (std::isnan(at)) continue;
      if (across) {
        const double from = upper ? at : area.left, to = upper ? area.right() : at;
        if (to > from) cairo_rectangle(canvas_.get(), from, area.top, to - from, cell_);
      } else {
        const double from = upper ? area.top : at, to = upper ? at : area.bottom();
        if (to > from) cairo_rectangle(canvas_.get(), area.left, from, cell_, to - from);
      }
      canvas_.fill_keep(mixed(palette::hairline, palette::paper, 0.3));
      canvas_.stroke(palette::rim_line, 1);
    }
  }

  void line(const PlotArea& area, double value, bool across, const Colour& colour,
            bool dashed) const {
    const double at = std::isnan(value) ? NAN : across ? area.at_x(value) : area.at_y(value);
    if (std::isnan(at)) return;
    const Saved saved(canvas_);
    constexpr double kDash[] = {5, 3.5};
    if (dashed) cairo_set_dash(canvas_.get(), kDash, 2, 0);
    if (across)
      canvas_.line(at, area.top, at, area.bottom(), colour, 1.4);
    else
      canvas_.line(area.left, at, area.right(), at, colour, 1.4);
  }

  void histogram(const PlotArea& area, std::size_t k) const {
    std::array<int, kHistogramBins> counts{};
    for (const auto& draw : corner_.draws) {
      const double share = area.x.share(draw[k]);
      if (share >= 0 && share < 1) ++counts[static_cast<std::size_t>(share * kHistogramBins)];
    }
    const double most = *std::max_element(counts.begin(), counts.end());
    const CornerAxis& of = corner_.axes[k];
    const double width = cell_ / kHistogramBins;
    for (std::size_t i = 0; i < counts.size() && most > 0; ++i) {
      const double height = 0.8 * cell_ * counts[i] / most;
      cairo_rectangle(canvas_.get(), area.left + static_cast<double>(i) * width,
                      area.bottom() - height, width, height);
    }
    canvas_.fill(faded(colour_of_curve(0), 0.45));
    if (!std::isnan(of.from) && !std::isnan(of.to)) {
      const double y = area.top + 0.1 * cell_;
      canvas_.line(area.at_x(of.from), y, area.at_x(of.to), y, colour_of_curve(1), 2.6);
    }
    line(area, of.estimate, true, colour_of_curve(1), false);
    line(area, of.truth, true, palette::ink, true);
  }

  void scatter(const PlotArea& area, std::size_t row, std::size_t column) const {
    const double radius = std::clamp(cell_ / 60, 1.2, 2.4);
    for (const auto& draw : corner_.draws) {
      const PagePoint p = page_point(area, draw[column], draw[row]);
      if (p.known() && area.holds(p)) canvas_.circle(p.x, p.y, radius);
    }
    canvas_.fill(faded(colour_of_curve(0), 0.45));
    const CornerAxis &x = corner_.axes[column], &y = corner_.axes[row];
    line(area, x.truth, true, palette::ink, true);
    line(area, y.truth, false, palette::ink, true);
    const PagePoint p = page_point(area, x.estimate, y.estimate);
    if (p.known()) estimate_mark(p.x, p.y);
  }

  void estimate_mark(double x, double y) const {
    canvas_.circle(x, y, 4);
    canvas_.fill_keep(colour_of_curve(1));
    canvas_.stroke(palette::paper, 1.2);
  }

  // Labels that would touch the one before, or lie in the next cell, are left out.
  void ticks(const PlotArea& area, bool across, bool labels) const {
    double free_from = -1e9;
    for (const AxisTick& t : (across ? area.x : area.y).ticks) {
      const double x = across ? area.at_x(t.value) : area.left;
      const double y = across ? area.bottom() : area.at_y(t.value), size = t.major ? 5 : 2.5;
      canvas_.line(x, y, across ? x : x + size, across ? y - size : y, palette::ink, 1);
      if (!labels || t.label.empty()) continue;
      const double half = across ? canvas_.width_of(t.label, kCornerNumber) / 2 : 7;
      const double at = across ? x - area.left : area.bottom() - y;
      if (at - half < free_from || at - half < -kCellGap || at + half > cell_ + kCellGap) continue;
      free_from = at + half + 6;
      if (across) {
        canvas_.text(x, y + 16, t.label, kCornerNumber);
      } else {
        TextStyle right = kCornerNumber;
        right.align = Align::right;
        canvas_.text(x - 6, y + 4.4, t.label, right);
      }
    }
  }

  // The name with its unit where they fit, or the name alone in small letters.
  std::pair<std::string, TextStyle> label_of(std::size_t k) const {
    const CornerAxis& of = corner_.axes[k];
    const double room = cell_ + kCellGap - 2;
    const std::string whole = of.name + (of.unit.empty() ? "" : " (" + of.unit + ")");
    if (canvas_.width_of(whole, kCornerLabel) <= room) return {whole, kCornerLabel};
    return {canvas_.fitted(of.name, room, kCornerNumber), kCornerNumber};
  }

  // The name, the power of ten of the numbers, and the prior's bounds.
  void x_label(const PlotArea& area, std::size_t k) const {
    const CornerAxis& of = corner_.axes[k];
    const double x = area.left + cell_ / 2;
    const auto [name, style] = label_of(k);
    canvas_.text(x, area.bottom() + 38, name + (area.x.note.empty() ? "" : ", " + area.x.note),
                 style);
    if (std::isnan(of.low) || std::isnan(of.high)) return;
    const auto line = [&](double below, const std::string& text) {
      canvas_.text(x, area.bottom() + below, canvas_.fitted(text, cell_ + kCellGap - 2, kPriorText),
                   kPriorText);
    };
    line(56, "prior " + prior_number(of.low));
    line(72, "to " + prior_number(of.high) + (of.unit.empty() ? "" : " " + of.unit));
  }
  static std::string prior_number(double value) {
    std::string text = significant(value, 3);
    if (text[0] == '-') text.replace(0, 1, "−");
    return text;
  }

  void legend() const {
    const std::size_t n = corner_.axes.size();
    if (n < 2) return;
    constexpr double kRow = 21, kSample = 24;
    const double right = left_ + static_cast<double>(n) * (cell_ + kCellGap) - kCellGap;
    const bool truth = std::any_of(corner_.axes.begin(), corner_.axes.end(),
                                   [](const CornerAxis& a) { return !std::isnan(a.truth); });
    std::vector<std::string> names{"estimate", "95 % interval", corner_.draws_name,
                                   "outside the prior"};
    if (truth) names.emplace_back("planted truth");
    double widest = 0;
    for (const auto& name : names) widest = std::max(widest, canvas_.width_of(name, kCornerEntry));
    const double x = std::max(right - widest - kSample - 12, left_ + cell_ + 14);
    double y = top_ + 10;
    for (std::size_t i = 0; i < names.size(); ++i, y += kRow) {
      legend_sample(i, x, y, kSample);
      canvas_.text(x + kSample + 8, y + 4.5,
                   canvas_.fitted(names[i], right - x - kSample, kCornerEntry), kCornerEntry);
    }
  }
  void legend_sample(std::size_t i, double x, double y, double width) const {
    if (i == 0) estimate_mark(x + width / 2, y);
    if (i == 1) canvas_.line(x, y, x + width, y, colour_of_curve(1), 2.6);
    if (i == 2) {
      canvas_.circle(x + width / 2, y, 2.4);
      canvas_.fill(faded(colour_of_curve(0), 0.7));
    }
    if (i == 3) {
      cairo_rectangle(canvas_.get(), x, y - 6, width, 12);
      canvas_.fill_keep(mixed(palette::hairline, palette::paper, 0.3));
      canvas_.stroke(palette::rim_line, 1);
    }
    if (i == 4) {
      const Saved saved(canvas_);
      constexpr double kDash[] = {5, 3.5};
      cairo_set_dash(canvas_.get(), kDash, 2, 0);
      canvas_.line(x, y, x + width, y, palette::ink, 1.4);
    }
  }

  const Canvas& canvas_;
  const Corner& corner_;
  double left_, top_, cell_;
  std::vector<Axis> x_, y_;
};

}  // namespace

void draw_corner(const Corner& corner, const std::string& file, const FigureStyle& style) {
  const PictureFormat format = format_of(file);
  const auto n = static_cast<double>(std::max<std::size_t>(1, corner.axes.size()));
  const double gaps = (n - 1) * kCellGap, beside = kLeftRoom + kRightRoom + gaps;
  const double width = style.on_paper() ? paper_width(style) : beside + n * kCellAlone;
  const double cell = std::min((width - beside) / n, 2 * kCellAlone);
  if (cell < 40) {
    throw InputError("a corner plot of " + significant(n, 3) +
                     " parameters has no room in this width");
  }
  std::vector<std::string> title;
  if (!style.untitled) title = title_lines(Canvas::raster(8, 8), corner.title, width);
  const double top = kTopRoom + (title.empty() ? 0 : 28 + further_lines(title));
  const double height = top + n * cell + gaps + kBottomRoom;
  Canvas canvas = Canvas::page(format, width, height, style.on_paper());
  draw_title(canvas, title, width / 2, 28);
  CornerPainter(canvas, corner, kLeftRoom, top, cell).draw();
  write_atomically(file, canvas.encoded());
}

}  // namespace lilytank
