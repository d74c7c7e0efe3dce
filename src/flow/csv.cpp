#include <cmath>

#include "lilytank/flow_estimate.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

// Seven digits are more than any flow is known to; unknown values are empty cells.
std::string number(double value) {
  if (std::isnan(value)) return "";
  return significant(value, 7);
}

std::string place(const FlowEstimate& e, int i) {
  return std::to_string(i % e.cells) + "," + std::to_string(i / e.cells) + "," + number(e.x(i)) +
         "," + number(e.y(i));
}

std::string sample(const FlowSample& s) {
  return number(s.mu_x) + "," + number(s.mu_y) + "," + number(s.sigma_x) + "," + number(s.sigma_y);
}

// Distance and probability; Lilliefors' where samples are independent, else Kolmogorov's.
std::string normality(const NormalityTest& t, double p) {
  return t.samples < 4 ? "," : number(t.distance) + "," + number(p);
}

}  // namespace

std::string flow_csv(const FlowEstimate& estimate) {
  std::string out = "ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured\n";
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    const FlowCell& c = estimate.cell[i];
    out += place(estimate, static_cast<int>(i)) + "," + sample(c.flow) +
           (c.measured ? ",1\n" : ",0\n");
  }
  return out;
}

std::string flow_cells_csv(const FlowEstimate& estimate) {
  std::string out =
      "ix,iy,x_m,y_m,measured,samples,stays,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,"
      "mean_vx_se,mean_vy_se,std_vx_se,std_vy_se,ks_all_x,ks_all_x_p,ks_all_y,ks_all_y_p,ks_x,"
      "ks_x_p,ks_y,ks_y_p\n";
  for (std::size_t i = 0; i < estimate.cell.size(); ++i) {
    const FlowCell& c = estimate.cell[i];
    out += place(estimate, static_cast<int>(i)) + (c.measured ? ",1," : ",0,");
    out += std::to_string(c.samples) + "," + std::to_string(c.stays) + ",";
    out += sample(c.flow) + "," + sample(c.error) + ",";
    out += normality(c.all_x, c.all_x.raw_p) + "," + normality(c.all_y, c.all_y.raw_p) + ",";
    out += normality(c.normal_x, c.normal_x.p) + "," + normality(c.normal_y, c.normal_y.p) + "\n";
  }
  return out;
}

}  // namespace lilytank
