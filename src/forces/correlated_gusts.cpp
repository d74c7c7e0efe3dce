// Eddies that live for a while and are felt by all bodies near them.
#include <algorithm>
#include <cmath>

#include "library.hpp"
#include "lilytank/model.hpp"
#include "lilytank/random.hpp"

namespace lilytank {
namespace {

constexpr Parameter kParameters[] = {
    {"deviation", "m/s", 0, 0, 2, "of the eddies' velocity per axis"},
    {"time", "s", 0.5, 0.01, 100, "over which they fade by e"},
    {"length", "m", 0.06, 0.005, 10, "over which the velocity of neighbours is alike"},
    {"share", "1", 0, 0, 1, "of the variance of the flow's own gusts that are such eddies"},
};

constexpr int kWaves = 32;

// Waves u = amplitude (-sin a, cos a) cos(k . x + w t + phase), k along a, so the flow is free of
// divergence. Normal k gives a correlation exp(-r^2 / (2 length^2)) of the stream function's
// gradient, Cauchy-distributed w one of exp(-t / time) [random Fourier features].
struct Waves {
  double kx[kWaves], ky[kWaves];  // turns/m
  double offset[kWaves];          // turns, w t + phase
  double ax[kWaves], ay[kWaves];  // direction of the velocity, times sqrt(2 / waves)
  double bx[kWaves], by[kWaves];  // 1/m, what a turns into over a side: a_y along x, a_x along y
};

Waves waves_of(std::uint64_t seed, double time, double length, double now, double half_side) {
  Waves out;
  for (std::uint32_t m = 0; m < kWaves; ++m) {
    const auto z = normal_pair({seed, Stream::eddies, 0, m, 0});
    const double turn = uniform({seed, Stream::eddies, 0, m, 1}) - 0.5;
    const double size = std::sqrt(z[0] * z[0] + z[1] * z[1]);
    const Rot half = rotation(kPi * turn);
    // Both axes have half of the square of the amplitude each, on average over directions.
    const double share = size > 0 ? std::sqrt(4.0 / kWaves) / size : 0;
    out.kx[m] = z[0] / (2 * kPi * length), out.ky[m] = z[1] / (2 * kPi * length);
    out.offset[m] =
        half.s / half.c / (2 * kPi * time) * now + uniform({seed, Stream::eddies, 0, m, 2});
    out.ax[m] = -z[1] * share, out.ay[m] = z[0] * share;
    out.bx[m] = out.ay[m] * rotation(2 * kPi * out.kx[m] * half_side).s / half_side;
    out.by[m] = out.ax[m] * rotation(2 * kPi * out.ky[m] * half_side).s / half_side;
  }
  return out;
}

// Cosine and sine of 2 pi turns: Chebyshev's interpolations in the square, 1e-12. Without branches
// or functions, so that a loop of them becomes vectors.
inline Rot turned(double turns) {
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to whole numbers
  const double nearest = (turns + kRound) - kRound;
  const double r = turns - nearest, y = r * r;
  double c = 0.24375128746032715;
  c = c * y - 1.6968635453118217;
  c = c * y + 7.899155350608958;
  c = c * y - 26.425615548583057;
  c = c * y + 60.24458610668403;
  c = c * y - 85.45681452729417;
  c = c * y + 64.93939395753274;
  c = c * y - 19.739208801568648;
  c = c * y + 0.9999999999990584;
  double s = 0.0915075937906901;
  s = s * y - 0.7122859292560153;
  s = s * y + 3.8184935351212816;
  s = s * y - 15.094429101691476;
  s = s * y + 42.05867555939282;
  s = s * y - 76.70585886256858;
  s = s * y + 81.60524925445621;
  s = s * y - 41.3417022401976;
  s = s * y + 6.283185307179273;
  return {c, r * s};
}

// The eddies at `kLanes` places: velocity, of deviation 1 per axis, and how it differs across a
// module, u_y along x and u_x along y (1/m).
constexpr int kLanes = 8;
struct Eddies {
  double x[kLanes] = {}, y[kLanes] = {}, y_by_x[kLanes] = {}, x_by_y[kLanes] = {};
};
Eddies eddies_at(const Waves& w, const double* x, const double* y) {
  Eddies out;
  for (int m = 0; m < kWaves; ++m) {
    for (int i = 0; i < kLanes; ++i) {
      const Rot swing = turned(w.kx[m] * x[i] + w.ky[m] * y[i] + w.offset[m]);
      out.x[i] += swing.c * w.ax[m], out.y[i] += swing.c * w.ay[m];
      out.y_by_x[i] -= swing.s * w.bx[m], out.x_by_y[i] -= swing.s * w.by[m];
    }
  }
  return out;
}

class CorrelatedGusts final : public ForceTerm {
 public:
  std::string_view name() const override { return "correlated_gusts"; }
  std::string_view summary() const override {
    return "eddies: gusts that last, and that bodies near each other share";
  }
  std::string_view equation() const override {
    return "u += (deviation + K_v sqrt(share) sigma) e, sigma the flow's own deviation, which is "
           "left with sqrt(1 - share) of itself; e a random flow without divergence, of deviation "
           "1 per axis, correlated over `time` (exponentially) and `length`: a sum of 32 waves, "
           "whose curl turns modules along";
  }
  std::span<const Parameter> parameters() const override { return kParameters; }
  bool stirs() const override { return true; }
  void stir(const Model& model, const Kinematics& k, const Moment& now, std::span<const double> p,
            Stirring& water) const override {
    if (!now.gusts || (p[0] == 0 && p[3] == 0)) return;
    const Waves waves = waves_of(now.seed, p[1], p[2], now.time, model.module.side / 2);
    const double own = std::sqrt(p[3]) * model.flow.K_v * water.gain;
    for (int first = 0; first < k.size(); first += kLanes) {
      const int count = std::min(kLanes, k.size() - first);
      double x[kLanes] = {}, y[kLanes] = {};
      for (int i = 0; i < count; ++i) x[i] = k.x[first + i], y[i] = k.y[first + i];
      const Eddies e = eddies_at(waves, x, y);
      for (int j = 0; j < count; ++j) {
        const int i = first + j;
        const FlowSample f = p[3] > 0 ? field_now(model, now).at(k.x[i], k.y[i]) : FlowSample{};
        const double along_x = p[0] + own * f.sigma_x, along_y = p[0] + own * f.sigma_y;
        water.ux[i] += along_x * e.x[j], water.uy[i] += along_y * e.y[j];
        water.turning[i] += 0.5 * (along_y * e.y_by_x[j] - along_x * e.x_by_y[j]);
      }
    }
    water.gust_gain *= std::sqrt(1 - p[3]);
  }
};

}  // namespace

const ForceTerm& correlated_gusts() {
  static const CorrelatedGusts term;
  return term;
}

}  // namespace lilytank
