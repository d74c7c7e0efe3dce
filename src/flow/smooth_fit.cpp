#include "flow/smooth_fit.hpp"

#include <cmath>

namespace lilytank {
namespace {

constexpr double kLeastVariance = 1e-6;  // m^2/s^2, of a gust

// Position of node b among the nine around node a.
int neighbour(const NodeGrid& nodes, const FlowGrid& grid, int a, int b) {
  const int ca = nodes.cell(a), cb = nodes.cell(b);
  return (cb / grid.cells - ca / grid.cells + 1) * 3 + cb % grid.cells - ca % grid.cells + 1;
}

struct Water {
  double ux, uy, s2;
};

Water water_at(const Stencil& s, const FlowUnknowns& now) {
  Water w{0, 0, 0};
  double log_s2 = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const int n = s.node[k];
    w.ux += s.weight[k] * now.mean[2 * n], w.uy += s.weight[k] * now.mean[2 * n + 1];
    log_s2 += s.weight[k] * now.log_s2[n];
  }
  w.s2 = std::exp(log_s2);
  return w;
}

// Sum over the two axes of (J P J^T) for a symmetric Jacobian J and a covariance P.
double quadratic(const GustedDrag::Mean& j, double xx, double xy, double yy) {
  const double a = j.xx * j.xx + j.xy * j.xy, b = j.xy * (j.xx + j.yy);
  const double c = j.xy * j.xy + j.yy * j.yy;
  return a * xx + 2 * b * xy + c * yy;
}

}  // namespace

FlowSums::FlowSums(int nodes)
    : mean(Eigen::VectorXd::Zero(2 * nodes)),
      log_s2(Eigen::VectorXd::Zero(nodes)),
      blocks_(static_cast<std::size_t>(nodes) * 81, 0.0) {}

// What is computed for one balance.
struct SmoothFit::Work {
  double wander = 0;   // variance that a velocity in the balance differs from its measurement by
  double blurred = 0;  // the same for the velocity before, as seen from the balance's middle
  // At the motion before.
  Stencil where{};
  Water water{};
  double wx = 0, wy = 0;  // relative velocity, m/s
  GustedDrag::Mean before{};
  GustedDrag::Covariance weight{};
  // In the balance, averaged.
  GustedDrag::Mean drag{};
  GustedDrag::Covariance gusts{};
  double rx = 0, ry = 0;  // acceleration, measured less expected
  double pull = 0;        // squared expected acceleration, both axes
  // Scales.
  double kappa = 0, mean_weight = 0, square_weight = 0, gust_share = 0, expected = 0;
  double kick_share = 0, noise_part = 0, variance = 0;
};

SmoothFit::SmoothFit(std::span<const BalanceSet> sets, const BallPhysics& ball,
                     const FlowGrid& grid, const NodeGrid& nodes)
    : sets_(sets), ball_(ball), grid_(grid), nodes_(nodes) {}

// Predicts the relative velocity in the middle of the balance from the motion before it.
void SmoothFit::instrument(const Balance& b, const BalanceSet& set, const FlowUnknowns& now,
                           Work& w) const {
  const double lag = set.shape.lag();
  const Water start = water_at(nodes_.stencil(b.x0, b.y0), now);
  const auto pull = drag_.mean(start.ux - b.vx0, start.uy - b.vy0, start.s2 + w.wander);
  const double vx = b.vx0 + lag * (w.kappa * pull.x - ball_.damping * b.vx0);
  const double vy = b.vy0 + lag * (w.kappa * pull.y - ball_.damping * b.vy0);
  w.where = nodes_.stencil(b.x0 + lag * (b.vx0 + vx) / 2, b.y0 + lag * (b.vy0 + vy) / 2);
  w.water = water_at(w.where, now);
  w.wx = w.water.ux - vx, w.wy = w.water.uy - vy;
  const auto moments = drag_.moments(w.wx, w.wy, w.water.s2 + w.blurred);
  w.before = moments.mean, w.weight = moments.covariance;
}

void SmoothFit::inside(const Balance& b, const BalanceSet& set, const FlowUnknowns& now,
                       Work& w) const {
  const BalanceShape& shape = set.shape;
  const Track& t = *set.tracks[b.track];
  w.drag = {}, w.gusts = {};
  double mx = 0, my = 0;
  for (int j = 0; j <= shape.length; ++j) {
    const double share = (j == 0 || j == shape.length ? 0.5 : 1.0) / shape.length;
    const auto i = static_cast<std::size_t>(b.at + j), h = static_cast<std::size_t>(shape.half);
    const double vx = (t.x[i + h] - t.x[i - h]) / shape.box();
    const double vy = (t.y[i + h] - t.y[i - h]) / shape.box();
    const Water u = water_at(nodes_.stencil(t.x[i], t.y[i]), now);
    const double s2 = std::max(kLeastVariance, u.s2 + w.wander);
    const auto [m, c] = drag_.moments(u.ux - vx, u.uy - vy, s2);
    // The derivatives are by the log of all variance, of which gusts are a part.
    const double part = u.s2 / s2;
    w.drag.x += share * m.x, w.drag.y += share * m.y;
    w.drag.xx += share * m.xx, w.drag.xy += share * m.xy, w.drag.yy += share * m.yy;
    w.drag.sx += share * part * m.sx, w.drag.sy += share * part * m.sy;
    w.gusts.xx += share * c.xx, w.gusts.xy += share * c.xy, w.gusts.yy += share * c.yy;
    w.gusts.sxx += share * part * c.sxx, w.gusts.sxy += share * part * c.sxy;
    w.gusts.syy += share * part * c.syy;
    mx += share * vx, my += share * vy;
  }
  const double px = w.kappa * w.drag.x - ball_.damping * mx;
  const double py = w.kappa * w.drag.y - ball_.damping * my;
  w.pull = px * px + py * py;
  w.rx = b.ax - px, w.ry = b.ay - py;
}

// Half the derivative, by log s^2, of what the mean flow's uncertainty adds to the fit: with a
// larger s the drag answers more to the mean flow, and a fitted flow follows the noise better.
double SmoothFit::uncertainty(const Work& w, const MeanCovariance& covariance) const {
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      const double share = w.where.weight[a] * w.where.weight[b];
      if (share == 0) continue;
      const int at = neighbour(nodes_, grid_, w.where.node[a], w.where.node[b]);
      const auto& p = covariance.block[w.where.node[a] * 9 + at];
      xx += share * p[0], xy += share * p[1], yy += share * p[2];
    }
  }
  constexpr double kStep = 0.05;  // of log s^2
  const auto more = drag_.mean(w.wx, w.wy, w.water.s2 * std::exp(kStep) + w.blurred);
  const double change = quadratic(more, xx, xy, yy) - quadratic(w.before, xx, xy, yy);
  return 0.5 * w.kappa * w.kappa * w.mean_weight * change / kStep;
}

void SmoothFit::spread(const Work& w, FlowSums& out) const {
  const double part = w.water.s2 / (w.water.s2 + w.blurred);
  const double k = w.kappa, m = w.mean_weight * k * k;
  // Derivatives of the x and y drag by u_x, u_y and log s^2, before and inside.
  const double px[3] = {w.before.xx, w.before.xy, part * w.before.sx};
  const double py[3] = {w.before.xy, w.before.yy, part * w.before.sy};
  const double ix[3] = {w.drag.xx, w.drag.xy, w.drag.sx};
  const double iy[3] = {w.drag.xy, w.drag.yy, w.drag.sy};
  double block[3][3], right[3];
  for (int p = 0; p < 3; ++p) {
    right[p] = w.mean_weight * k * (px[p] * w.rx + py[p] * w.ry);
    for (int q = 0; q < 3; ++q) {
      block[p][q] = 0.5 * m * (px[p] * ix[q] + py[p] * iy[q] + ix[p] * px[q] + iy[p] * py[q]);
    }
  }
  // The squares of the differences, of which gusts make those along w larger.
  const double g = w.gust_share, zxx = part * w.weight.sxx, zxy = part * w.weight.sxy,
               zyy = part * w.weight.syy;
  const double exx = w.rx * w.rx - w.expected - g * w.gusts.xx, exy = w.rx * w.ry - g * w.gusts.xy;
  const double eyy = w.ry * w.ry - w.expected - g * w.gusts.yy;
  const double q = 0.5 * w.square_weight * g;
  right[2] += q * (zxx * exx + 2 * zxy * exy + zyy * eyy);
  block[2][2] += q * g * (zxx * w.gusts.sxx + 2 * zxy * w.gusts.sxy + zyy * w.gusts.syy);
  for (std::size_t a = 0; a < 4; ++a) {
    const double wa = w.where.weight[a];
    if (wa == 0) continue;
    const int n = w.where.node[a];
    out.mean[2 * n] += wa * right[0], out.mean[2 * n + 1] += wa * right[1];
    out.log_s2[n] += wa * right[2];
    for (std::size_t b = 0; b < 4; ++b) {
      const double wb = wa * w.where.weight[b];
      if (wb == 0) continue;
      const int at = neighbour(nodes_, grid_, n, w.where.node[b]);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) out.block(n, at, i, j) += wb * block[i][j];
      }
    }
  }
}

void SmoothFit::free_of_uncertainty(const Work& w, const MeanCovariance& covariance,
                                    FlowSums& out) const {
  const double change = uncertainty(w, covariance);
  for (std::size_t k = 0; k < 4; ++k) out.log_s2[w.where.node[k]] -= w.where.weight[k] * change;
}

void SmoothFit::scale(const BalanceSet& set, const FlowUnknowns& now, Work& w) const {
  const BalanceShape& shape = set.shape;
  w.kappa = ball_.drag_rate();
  w.kick_share = shape.kick_share(ball_.gust_interval);
  w.noise_part = shape.noise_share() * set.variance;
  w.wander =
      shape.velocity_wander(now.kick, ball_.gust_interval) - shape.velocity_noise(set.variance);
  w.blurred = now.kick * shape.lag() / 2 + shape.velocity_noise(set.variance);
  w.gust_share = w.kappa * w.kappa * ball_.gust_interval * w.kick_share;
  w.expected = w.kick_share * now.random_kick + w.noise_part;
  // Successive balances share kicks: over many of them only the kicks' own strength counts.
  w.mean_weight = shape.duration() / now.kick;
  w.variance = w.kick_share * now.kick + w.noise_part;
  w.square_weight = 1 / (w.variance * w.variance);
}

FlowSums SmoothFit::sum(const FlowUnknowns& now, int stride,
                        const MeanCovariance* covariance) const {
  FlowSums out(nodes_.size());
  out.per_cell.assign(grid_.size(), 0);
  Work w;
  for (const BalanceSet& set : sets_) {
    scale(set, now, w);
    for (std::size_t i = 0; i < set.balances.size(); i += static_cast<std::size_t>(stride)) {
      const Balance& b = set.balances[i];
      instrument(b, set, now, w);
      inside(b, set, now, w);
      const double square = w.rx * w.rx + w.ry * w.ry;
      if (now.outlier > 0 && square > now.outlier * w.variance) continue;
      spread(w, out);
      if (covariance != nullptr) free_of_uncertainty(w, *covariance, out);
      out.squares += square - 2 * w.noise_part;
      out.gusts += w.gust_share * (w.gusts.xx + w.gusts.yy);
      out.shares += 2 * w.kick_share;
      out.pulls += w.pull / 2;
      ++out.count;
      const int cell = grid_.cell_at(b.x0, b.y0);
      if (cell >= 0) ++out.per_cell[cell];
    }
  }
  if (out.count > 0) out.pulls /= static_cast<double>(out.count);
  return out;
}

}  // namespace lilytank
