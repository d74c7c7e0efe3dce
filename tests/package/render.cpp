// Draws a plot with the installed renderer.
#include <lilytank/render.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  lilytank::Plot plot;
  plot.title = "A line";
  plot.curves.push_back({"y = x", {0, 1, 2}, {0, 1, 2}, {}, {}});
  lilytank::draw_plot(plot, argv[1]);
}
