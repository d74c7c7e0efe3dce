#include <algorithm>
#include <cmath>
#include <set>

#include "cut_text.hpp"
#include "palette.hpp"
#include "plot_area.hpp"

namespace lilytank {
namespace {

constexpr double kBoxRow = 23, kBoxPad = 9, kSample = 30, kBoxGap = 9, kBoxMargin = 10;
constexpr double kWidest = 320;  // longer names are cut
const TextStyle kName{14, palette::ink, false, Align::left};
const TextStyle kBoxTitle{14, palette::ink, true, Align::left};

bool within(const LegendBox& box, const PagePoint& p) {
  constexpr double kRoom = 4;
  return p.x > box.x - kRoom && p.x < box.x + box.width + kRoom && p.y > box.y - kRoom &&
         p.y < box.y + box.height + kRoom;
}

// Points every few units along the visible parts of all curves; bands count by their edges. A
// marker counts as much as a stretch of line: hidden, it is a datum lost.
std::vector<PagePoint> ink_of(const Plot& plot, const PlotArea& area) {
  constexpr double kEvery = 5;
  constexpr std::size_t kMarkerWeight = 8;
  std::vector<PagePoint> ink;
  const auto trace = [&](const std::vector<double>& xs, const std::vector<double>& ys, bool steps) {
    PagePoint before{NAN, NAN};
    const std::size_t n = std::min(xs.size(), ys.size());
    const auto line = [&](const PagePoint& a, const PagePoint& b) {
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      const int parts = std::clamp(static_cast<int>(length / kEvery), 1, 2000);
      for (int k = 1; k <= parts; ++k) {
        const double w = static_cast<double>(k) / parts;
        ink.push_back({a.x + w * (b.x - a.x), a.y + w * (b.y - a.y)});
      }
    };
    for (std::size_t i = 0; i < n; ++i) {
      const PagePoint p = page_point(area, xs[i], ys[i]);
      if (p.known() && before.known()) {
        // Crowded points say no more than a few of them.
        if (std::hypot(p.x - before.x, p.y - before.y) < kEvery && i + 1 < n) continue;
        const PagePoint corner{p.x, before.y};
        if (steps)
          line(before, corner), line(corner, p);
        else
          line(before, p);
      } else if (p.known()) {
        ink.push_back(p);
      }
      before = p;
    }
  };
  for (const Curve& curve : plot.curves) {
    const std::size_t n = points_of(curve);
    for (std::size_t i = 0; (curve.markers || n == 1) && i < n; ++i) {
      const PagePoint p = page_point(area, curve.x[i], curve.y[i]);
      if (p.known()) ink.insert(ink.end(), kMarkerWeight, p);
    }
    if (curve.line) trace(curve.x, curve.y, curve.steps);
    trace(curve.x, curve.low, curve.steps);
    trace(curve.x, curve.high, curve.steps);
  }
  return ink;
}

// The curves that the legend names, as many as fit the plot's height.
struct Names {
  std::vector<std::size_t> shown;
  std::size_t more = 0;
  std::vector<std::string> texts;  // of those shown, no wider than a legend may be
};

Names names_of(const Canvas& canvas, const Plot& plot) {
  Names names;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    if (!plot.curves[i].name.empty()) names.shown.push_back(i);
  }
  // Shades are named in their order.
  std::stable_sort(names.shown.begin(), names.shown.end(), [&](std::size_t a, std::size_t b) {
    const auto place = [](double shade) { return std::isnan(shade) ? -1 : shade; };
    return place(plot.curves[a].shade) < place(plot.curves[b].shade);
  });
  // Three are never cut: a legend that says less than it could is no help in a low plot either.
  const auto most = static_cast<std::size_t>(std::max(3.0, (plot.height - 90) / kBoxRow));
  if (names.shown.size() > most) {
    names.more = names.shown.size() - (most - 1);
    names.shown.resize(most - 1);
  }
  std::vector<std::string> whole;
  for (const std::size_t i : names.shown) whole.push_back(plot.curves[i].name);
  names.texts = cut_apart(whole, kWidest + 1,
                          [&](const std::string& text) { return canvas.width_of(text, kName); });
  return names;
}

}  // namespace

LegendBox legend_size(const Canvas& canvas, const Plot& plot) {
  LegendBox box;
  const Names names = names_of(canvas, plot);
  if (names.shown.empty()) return box;
  for (const std::string& text : names.texts) {
    box.width = std::max(box.width, std::min(kWidest, canvas.width_of(text, kName)));
  }
  const bool titled = !plot.legend_title.empty();
  const double title = std::min(kWidest, canvas.width_of(plot.legend_title, kBoxTitle));
  const auto rows =
      static_cast<double>(names.shown.size() + (names.more > 0 ? 1 : 0) + (titled ? 1 : 0));
  box.width = std::max(box.width + kSample + kBoxGap, title) + 2 * kBoxPad;
  box.height = rows * kBoxRow + 2 * kBoxPad - 6;
  return box;
}

LegendBox place_legend(const LegendBox& size, const Plot& plot, const PlotArea& area,
                       std::size_t& hidden) {
  const std::vector<PagePoint> ink = ink_of(plot, area);
  const double x0 = area.left + kBoxMargin, x1 = area.right() - kBoxMargin - size.width;
  const double y0 = area.top + kBoxMargin, y1 = area.bottom() - kBoxMargin - size.height;
  LegendBox best = size;
  bool first = true;
  // Corners before edges, the top right before all, where equally free.
  for (const auto& [u, v] : {std::pair{1.0, 0.0},
                             {0.0, 0.0},
                             {1.0, 1.0},
                             {0.0, 1.0},
                             {1.0, 0.5},
                             {0.5, 0.0},
                             {0.5, 1.0},
                             {0.0, 0.5},
                             {0.5, 0.5}}) {
    LegendBox box = size;
    box.x = x0 + u * (x1 - x0), box.y = y0 + v * (y1 - y0);
    std::size_t count = 0;
    for (const PagePoint& p : ink) count += within(box, p);
    if (first || count < hidden) best = box, hidden = count;
    first = false;
  }
  return best;
}

PageKey page_key(const Canvas& canvas, const PlotPage& page, double width) {
  constexpr double kLeft = 26, kBetween = 22;
  PageKey key;
  for (const Plot& plot : page.plots) {
    if (key.title.empty()) key.title = plot.legend_title;
  }
  double x = kLeft, y = kBoxRow / 2;
  if (!key.title.empty()) x += canvas.width_of(key.title, kBoxTitle) + kBetween;
  std::set<std::pair<std::string, int>> known;
  for (const Plot& plot : page.plots) {
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      const std::string& name = plot.curves[i].name;
      if (name.empty() || !known.emplace(name, static_cast<int>(i)).second) continue;
      const double room = width - 2 * kLeft - kSample - kBoxGap;
      const std::string text = canvas.fitted(name, room, kName);
      const double wide = kSample + kBoxGap + canvas.width_of(text, kName);
      if (x > kLeft && x + wide > width - kLeft) x = kLeft, y += kBoxRow;
      key.entries.push_back({&plot.curves[i], static_cast<int>(i), text, x, y});
      x += wide + kBetween;
    }
  }
  if (!key.entries.empty()) key.height = y + kBoxRow;
  return key;
}

void draw_page_key(const Canvas& canvas, const PageKey& key, double top) {
  for (const PageKey::Entry& e : key.entries) {
    draw_sample(canvas, *e.curve, e.index, e.x, top + e.y, kSample);
    canvas.text(e.x + kSample + kBoxGap, top + e.y + 5, e.text, kName);
  }
  if (!key.title.empty()) canvas.text(26, top + kBoxRow / 2 + 5, key.title, kBoxTitle);
}

void draw_legend_box(const Canvas& canvas, const LegendBox& box, const Plot& plot) {
  if (box.height <= 0) return;
  if (box.inside) {
    canvas.rounded(box.x, box.y, box.width, box.height, 4);
    canvas.fill_keep(faded(palette::paper, 0.86));
    canvas.stroke(palette::hairline, 1);
  }
  double y = box.y + kBoxPad - 3 + kBoxRow / 2;
  const double x = box.x + kBoxPad + kSample + kBoxGap;
  if (!plot.legend_title.empty()) {
    canvas.text(box.x + kBoxPad, y + 5, canvas.fitted(plot.legend_title, kWidest + 1, kBoxTitle),
                kBoxTitle);
    y += kBoxRow;
  }
  const Names names = names_of(canvas, plot);
  for (std::size_t k = 0; k < names.shown.size(); ++k) {
    const std::size_t i = names.shown[k];
    draw_sample(canvas, plot.curves[i], static_cast<int>(i), box.x + kBoxPad, y, kSample);
    canvas.text(x, y + 5, names.texts[k], kName);
    y += kBoxRow;
  }
  if (names.more > 0) canvas.text(x, y + 5, "… " + std::to_string(names.more) + " more", kName);
}

}  // namespace lilytank
