#include <cmath>
#include <limits>

#include "flow/grid.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "statistics/quantiles.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

const std::string kShort = "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps";

// Differences, and how many lie within a 95 % interval (1.96 standard errors).
struct Tally {
  double half_width = normal_half_width();
  double squares = 0;
  int count = 0, judged = 0, within = 0;
  void add(double difference, double error) {
    squares += difference * difference;
    ++count;
    if (std::isnan(error)) return;
    ++judged;
    if (std::fabs(difference) <= half_width * error) ++within;
  }
  double rms() const { return count > 0 ? std::sqrt(squares / count) : 0; }
  double coverage() const { return judged > 0 ? static_cast<double>(within) / judged : 0; }
};

FlowSample difference(const FlowSample& a, const FlowSample& b) {
  return {a.mu_x - b.mu_x, a.mu_y - b.mu_y, a.sigma_x - b.sigma_x, a.sigma_y - b.sigma_y};
}

}  // namespace

FlowTruth read_flow_truth(const std::string& file, int cells) {
  const std::string text = read_whole(file);
  CsvReader rows(text, file, {kShort, kShort + ",measured"});
  FlowTruth truth;
  truth.cells = cells;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  truth.sample.assign(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells),
                      {nan, nan, nan, nan});
  while (rows.next()) {
    const auto ix = rows.whole(0, 0, cells - 1), iy = rows.whole(1, 0, cells - 1);
    if (rows.header() == 1 && rows.whole(8, 0, 1) == 0) continue;
    truth.sample[iy * cells + ix] = {rows.number(4), rows.number(5), rows.number(6),
                                     rows.number(7)};
  }
  return truth;
}

FlowError compare_flow(const FlowEstimate& estimate, const FlowTruth& truth, bool measured_only) {
  FlowError out;
  Tally mean, deviation;
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    const FlowCell& cell = estimate.cell[i];
    if (std::isnan(truth.sample[i].mu_x) || (measured_only && !cell.measured)) continue;
    const FlowSample d = difference(cell.flow, truth.sample[i]);
    mean.add(d.mu_x, cell.error.mu_x), mean.add(d.mu_y, cell.error.mu_y);
    deviation.add(d.sigma_x, cell.error.sigma_x), deviation.add(d.sigma_y, cell.error.sigma_y);
    const double x = estimate.x(static_cast<int>(i)), y = estimate.y(static_cast<int>(i));
    const double r = std::sqrt(x * x + y * y);
    if (r > 0) {
      out.mean_radial += (d.mu_x * x + d.mu_y * y) / r;
      out.mean_around += (d.mu_y * x - d.mu_x * y) / r;
    }
    out.deviation_bias += (d.sigma_x + d.sigma_y) / 2;
    ++out.cells;
  }
  if (out.cells > 0) {
    out.mean_radial /= out.cells, out.mean_around /= out.cells, out.deviation_bias /= out.cells;
  }
  out.mean_rms = mean.rms(), out.deviation_rms = deviation.rms();
  out.mean_coverage = mean.coverage(), out.deviation_coverage = deviation.coverage();
  return out;
}

std::string flow_errors_csv(const FlowEstimate& estimate, const FlowTruth& truth) {
  std::string out =
      "ix,iy,x_m,y_m,measured,mean_vx_error_mps,mean_vy_error_mps,"
      "std_vx_error_mps,std_vy_error_mps\n";
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    if (std::isnan(truth.sample[i].mu_x)) continue;
    const int at = static_cast<int>(i);
    const FlowSample d = difference(estimate.cell[i].flow, truth.sample[i]);
    out += std::to_string(at % estimate.cells) + "," + std::to_string(at / estimate.cells) + ",";
    out += without_rounding(estimate.x(at)) + "," + without_rounding(estimate.y(at));
    out += estimate.cell[i].measured ? ",1" : ",0";
    for (const double v : {d.mu_x, d.mu_y, d.sigma_x, d.sigma_y}) {
      out += "," + without_rounding(v);
    }
    out += "\n";
  }
  return out;
}

}  // namespace lilytank
