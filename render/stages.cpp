// The stages of an assembly as a figure: squares with states, hops and the connector engaged last.
#include <algorithm>
#include <array>
#include <cmath>

#include "canvas.hpp"
#include "cut_text.hpp"
#include "lilytank/math.hpp"
#include "lilytank/render.hpp"
#include "page_fit.hpp"
#include "palette.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr double kSide = 54, kPitch = 62;             // units, of a module
constexpr double kStageCaption = 30, kStageGap = 46;  // above a stage, between two
constexpr double kPageMargin = 24, kFoot = 34, kHead = 40;
constexpr double kWidestPage = 1290, kHighestPage = 900;
constexpr double kHop = 16;  // of the hop numbers from a module's centre
constexpr double kKeySample = 30, kKeyLine = 17;
constexpr std::array<int, 4> kX = {1, 0, -1, 0}, kY = {0, 1, 0, -1};
const TextStyle kRuleName{15, palette::ink, true, Align::left};
const TextStyle kSmall{12, palette::muted, false, Align::left};

constexpr char kSigns[] = "connector engaged last (hop 1); at the faces: hops; bold: control state";

// Where the stages lie on the page.
struct Grid {
  int columns = 1, rows = 1;
  double width = 0, height = 0;  // of a stage with its caption
};

Grid grid_of(const Canvas& canvas, const Target& target, const std::vector<Stage>& stages,
             const FigureStyle& style) {
  Cell high;
  for (const Cell& cell : target.cells) high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  Grid grid;
  grid.width = (high.x + 1) * kPitch;
  for (const Stage& stage : stages)
    grid.width = std::max(grid.width, 26 + canvas.width_of(stage.text, kSmall));
  grid.height = (high.y + 1) * kPitch + kStageCaption;
  const int n = static_cast<int>(stages.size());
  const double across = grid.width + kStageGap;
  const double widest =
      style.on_paper() ? paper_width(style) - 2 * kPageMargin + kStageGap : kWidestPage;
  if (n * across <= widest)
    grid.columns = n;
  else if (style.on_paper() || n * (grid.height + kStageGap) > kHighestPage)
    grid.columns = std::max(1, static_cast<int>(widest / across));
  grid.rows = (n + grid.columns - 1) / grid.columns;
  return grid;
}

void draw_arrow(const Canvas& canvas, double x, double y, bool down) {
  const Saved saved(canvas);
  cairo_translate(canvas.get(), x, y);
  if (down) cairo_rotate(canvas.get(), kPi / 2);
  canvas.line(-15, 0, 10, 0, palette::muted, 2);
  cairo_move_to(canvas.get(), 16, 0);
  cairo_line_to(canvas.get(), 6, -5);
  cairo_line_to(canvas.get(), 6, 5);
  cairo_close_path(canvas.get());
  canvas.fill(palette::muted);
}

// A cell that is still to be filled.
void draw_absent(const Canvas& canvas, double x, double y) {
  const Saved saved(canvas);
  constexpr double kDash[] = {3, 4};
  cairo_set_dash(canvas.get(), kDash, 2, 0);
  canvas.rounded(x - kSide / 2, y - kSide / 2, kSide, kSide, 6);
  canvas.stroke(palette::hairline, 1);
}

void draw_bonds(const Canvas& canvas, double x, double y, unsigned bonds) {
  for (int d = 0; d < 2; ++d) {  // each bond once
    if ((bonds >> d & 1u) == 0) continue;
    const auto k = static_cast<std::size_t>(d);
    const double from = kSide / 2 - 3, to = kPitch - kSide / 2 + 3;
    canvas.line(x + kX[k] * from, y - kY[k] * from, x + kX[k] * to, y - kY[k] * to, palette::ink,
                13);
  }
}

void draw_square(const Canvas& canvas, double x, double y, const StageModule& module) {
  const Colour fill = module.engaged ? mixed(palette::accent, palette::paper, 0.82)
                                     : mixed(palette::isolated, palette::paper, 0.45);
  canvas.rounded(x - kSide / 2, y - kSide / 2, kSide, kSide, 6);
  canvas.fill_keep(fill);
  canvas.stroke(palette::ink, 1.4);
  if (module.last >= 0) {
    const auto k = static_cast<std::size_t>(module.last);
    const double out = kSide / 2 - 3.4, along = 17;
    const Saved saved(canvas);
    cairo_set_line_cap(canvas.get(), CAIRO_LINE_CAP_ROUND);
    canvas.line(x + kX[k] * out - kY[k] * along, y - kY[k] * out - kX[k] * along,
                x + kX[k] * out + kY[k] * along, y - kY[k] * out + kX[k] * along, palette::accent,
                4.6);
  }
  const std::string label = std::to_string(module.label);
  const double size = label.size() == 1 ? 19 : label.size() == 2 ? 14.5 : 12;
  canvas.moving_text(x, y, label, {size, palette::ink, true, Align::centre});
  if (module.last < 0) return;
  for (int d = 0; d < 4; ++d) {
    const auto k = static_cast<std::size_t>(d);
    canvas.moving_text(x + kHop * kX[k], y - kHop * kY[k], std::to_string(hop_of(module.last, d)),
                       {12, palette::muted, false, Align::centre});
  }
}

void draw_stage(const Canvas& canvas, const Target& target, const Stage& stage, double left,
                double top, double width) {
  const std::string text = [&] {
    std::string shown = stage.text;
    const std::size_t arrow = shown.find("->");
    if (arrow != std::string::npos) shown.replace(arrow, 2, "→");
    return shown;
  }();
  const std::string name = stage.rule.empty() ? "start" : stage.rule;
  canvas.text(left, top + 16, name, kRuleName);
  canvas.text(left + canvas.width_of(name, kRuleName) + 9, top + 16, text, kSmall);
  Cell high;
  for (const Cell& cell : target.cells) high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
  const double x0 = left + std::max(0.0, (width - (high.x + 1) * kPitch) / 2) + kPitch / 2;
  const double y0 = top + kStageCaption + high.y * kPitch + kPitch / 2;
  const auto x = [&](int cell) {
    return x0 + kPitch * target.cells[static_cast<std::size_t>(cell)].x;
  };
  const auto y = [&](int cell) {
    return y0 - kPitch * target.cells[static_cast<std::size_t>(cell)].y;
  };
  std::vector<bool> present(target.cells.size(), false);
  for (const StageModule& module : stage.modules)
    present[static_cast<std::size_t>(module.cell)] = true;
  for (int k = 0; k < static_cast<int>(present.size()); ++k)
    if (!present[static_cast<std::size_t>(k)]) draw_absent(canvas, x(k), y(k));
  for (const StageModule& module : stage.modules)
    draw_bonds(canvas, x(module.cell), y(module.cell), module.bonds);
  for (const StageModule& module : stage.modules)
    draw_square(canvas, x(module.cell), y(module.cell), module);
}

// What the signs mean, below the stages.
void draw_key(const Canvas& canvas, const std::vector<std::string>& lines, double x, double y) {
  y -= kKeyLine * static_cast<double>(lines.size() - 1);
  canvas.line(x, y - 4, x + 22, y - 4, palette::accent, 4.6);
  for (const std::string& line : lines) canvas.text(x + kKeySample, y, line, kSmall), y += kKeyLine;
}

double width_on_paper(double stages_width, const FigureStyle& style) {
  const double least = (stages_width + 2 * kPageMargin) / kUnitsPerMm;
  if (least <= style.width) return paper_width(style);
  throw InputError("the stages of this target need a figure " + significant(std::ceil(least), 4) +
                   " mm wide, not " + significant(style.width, 4));
}

}  // namespace

std::string stages_caption(const Target& target, const std::vector<Stage>& stages) {
  Figure figure;
  figure.caption = "Stages of the assembly of " + target.name +
                   ", one after each join, with the rule above. Bold: control state; blue bar: "
                   "connector engaged last (hop 1); at the faces: hops.";
  figure.n = std::to_string(stages.size()) + " stages; drawn from the plan, not simulated";
  return caption_text(figure, {});
}

std::string stages_picture(const Target& target, const std::vector<Stage>& stages,
                           const std::string& given_title, const std::string& file,
                           const FigureStyle& style) {
  const std::string title = style.untitled ? "" : given_title;
  const PictureFormat format = format_of(file);
  const Canvas ruler = Canvas::raster(8, 8);
  const Grid grid = grid_of(ruler, target, stages, style);
  const double head = title.empty() ? 0 : kHead;
  const double stages_width = grid.columns * (grid.width + kStageGap) - kStageGap;
  const double key_width = kKeySample + ruler.width_of(kSigns, kSmall);
  double width = std::ceil(2 * kPageMargin + std::max(key_width, stages_width));
  if (style.on_paper()) width = width_on_paper(stages_width, style);
  const auto key = lines_within(kSigns, width - 2 * kPageMargin - kKeySample,
                                [&](const std::string& s) { return ruler.width_of(s, kSmall); });
  const double height = 2 * kPageMargin + head + kFoot +
                        kKeyLine * static_cast<double>(key.size() - 1) +
                        grid.rows * (grid.height + kStageGap) - kStageGap;
  Canvas canvas = Canvas::page(format, width, height, style.on_paper());
  if (!title.empty())
    canvas.text(kPageMargin, kPageMargin + 18, title, {18, palette::ink, true, Align::left});
  for (int k = 0; k < static_cast<int>(stages.size()); ++k) {
    const double left = kPageMargin + k % grid.columns * (grid.width + kStageGap);
    const double top = kPageMargin + head + k / grid.columns * (grid.height + kStageGap);
    draw_stage(canvas, target, stages[static_cast<std::size_t>(k)], left, top, grid.width);
    const bool last = k + 1 == static_cast<int>(stages.size());
    if (last) continue;
    if (grid.columns == 1)
      draw_arrow(canvas, left + grid.width / 2, top + grid.height + kStageGap / 2, true);
    else if (k % grid.columns + 1 < grid.columns)
      draw_arrow(canvas, left + grid.width + kStageGap / 2, top + (grid.height + kStageCaption) / 2,
                 false);
  }
  draw_key(canvas, key, kPageMargin, height - kPageMargin);
  return std::string(canvas.encoded());
}

}  // namespace lilytank
