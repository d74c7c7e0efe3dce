#include "bodies/filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "lilytank/random.hpp"

namespace lilytank::bodies {
namespace {

constexpr int kMost = 32;  // states: positions, velocities, pushes, biases of eight coordinates
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;

// Covariance that the pushes gather in T, by their rate b = 1/memory: xx, xv, xa, vv, va, aa.
struct Gathered {
  double xx, xv, xa, vv, va, aa;
};

Gathered gathered(double push, double b, double T) {
  const double u = b * T, q = 2 * b * push * push;
  if (u < 0.02) {  // series: the closed form cancels there
    return {q * std::pow(T, 5) / 20 * (1 - 5 * u / 9),
            q * std::pow(T, 4) / 8 * (1 - 2 * u / 3),
            q * T * T * T / 6 * (1 - u),
            q * T * T * T / 3 * (1 - 0.75 * u),
            q * T * T / 2 * (1 - u),
            q * T * (1 - u)};
  }
  const double e = std::exp(-u), e2 = e * e;
  const double b2 = b * b, b3 = b2 * b, b4 = b3 * b;
  return {q / (2 * b4 * b) * (1 - e2 + 2 * u + 2 * u * u * u / 3 - 2 * u * u - 4 * u * e),
          q / (2 * b4) * (e2 + 1 - 2 * e + 2 * u * e - 2 * u + u * u),
          q / (2 * b3) * (1 - e2 - 2 * u * e),
          q / (2 * b3) * (4 * e - 3 - e2 + 2 * u),
          q / (2 * b2) * (e2 + 1 - 2 * e),
          q / (2 * b) * (1 - e2)};
}

// Moves positions, velocities and pushes of one run.
class Mover {
 public:
  Mover(const BodyModel& model, const Typical& typical, const BodyRun& run)
      : model_(&model),
        typical_(&typical),
        run_(&run),
        dimensions_(typical.dimensions),
        n_(static_cast<int>(run.bodies.size()) * typical.dimensions) {
    for (const Term& t : model.terms) pairs_ = pairs_ || t.law->variable == "pair";
  }
  int coordinates() const { return n_; }

  // Increments of a position and a velocity for derivatives over a time T.
  std::pair<double, double> increments(double T) const {
    return {1e-4 * std::max(1e-12, std::min(typical_->speed * T, typical_->high - typical_->low)),
            1e-4 * typical_->speed};
  }

  // z: positions, velocities, pushes at sample k; moved to sample k + 1 by calls of `part(time,
  // h)`, which step z. NaN where the law's rate takes more parts than kMostParts: Runge and Kutta
  // lose 0.02 % of a velocity that turns by kPart in a part, and are unstable beyond 2.8.
  template <class Part>
  void advance(std::size_t k, Vector& z, const Part& part) const {
    constexpr double kPart = 0.5, kMostParts = 200;
    const double end = run_->time[k + 1];
    double t = run_->time[k];
    for (int done = 0; t < end; ++done) {
      const double parts = std::max(std::ceil(rate(k, t, end - t, z) * (end - t) / kPart),
                                    done == 0 && pairs_ ? 2.0 : 1.0);
      if (!(done + parts <= kMostParts)) {
        z.setConstant(NAN);
        return;
      }
      const double h = (end - t) / parts;
      part(t, h);
      t = parts > 1 ? t + h : end;
    }
  }

  void move(std::size_t k, Vector& z) const {
    advance(k, z, [&](double time, double h) { step(k, time, h, z); });
  }

  void step(std::size_t k, double time, double h, Vector& z) const {
    double x[kMost] = {}, v[kMost] = {}, a1[kMost], a2[kMost], a3[kMost], a4[kMost], w[4][kMost];
    const double half = std::exp(-h / 2 / model_->memory), full = half * half;
    const int n = n_;
    const auto at = [&](double part, const double* dx, const double* dv, double* a, double* keep) {
      const double decay = part == 0 ? 1 : part == 0.5 ? half : full;
      for (int i = 0; i < n; ++i) {
        x[i] = z[i] + (dx != nullptr ? part * h * dx[i] : 0);
        v[i] = z[n + i] + (dv != nullptr ? part * h * dv[i] : 0);
        keep[i] = v[i];
      }
      slopes(k, time + part * h, x, v, a);
      for (int i = 0; i < n; ++i) a[i] += z[2 * n + i] * decay;
      for (int i = 3 * n; i < z.size(); ++i) a[i - 3 * n] += z[i];
    };
    at(0, nullptr, nullptr, a1, w[0]);
    at(0.5, w[0], a1, a2, w[1]);
    at(0.5, w[1], a2, a3, w[2]);
    at(1, w[2], a3, a4, w[3]);
    for (int i = 0; i < n; ++i) {
      z[i] += h / 6 * (w[0][i] + 2 * w[1][i] + 2 * w[2][i] + w[3][i]);
      z[n + i] += h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
      z[2 * n + i] *= full;
    }
    if (model_->restitution >= 0) collide(z);
  }

 private:
  // Fastest rate (1/s) at which the laws change velocities: bounds of the derivatives of
  // accelerations by velocities, and of those by positions: the root of the latter is a frequency.
  double rate(std::size_t k, double time, double T, const Vector& z) const {
    if (model_->terms.empty()) return 0;
    double x[kMost], v[kMost], a[kMost], moved[kMost], of_x[kMost] = {}, of_v[kMost] = {};
    std::copy(z.data(), z.data() + n_, x), std::copy(z.data() + n_, z.data() + 2 * n_, v);
    slopes(k, time, x, v, a);
    const auto [dx, dv] = increments(T);
    const auto derive = [&](double& at, double by, double* sum) {
      const double before = at;
      at += by;
      slopes(k, time, x, v, moved);
      at = before;
      for (int j = 0; j < n_; ++j) sum[j] += std::fabs(moved[j] - a[j]) / by;
    };
    for (int i = 0; i < n_; ++i) derive(x[i], dx, of_x), derive(v[i], dv, of_v);
    double out = 0, all = 0;
    for (int j = 0; j < n_; ++j) {
      out = std::max({out, of_v[j], std::sqrt(of_x[j])}), all += of_v[j] + of_x[j];
    }
    return std::isfinite(all) ? out : NAN;
  }

  void slopes(std::size_t k, double time, const double* x, const double* v, double* a) const {
    accelerate(*model_, scene_of(*run_, dimensions_, k, time, x, v), a);
  }

  // Bodies on a line that overlap and approach bounce.
  void collide(Vector& z) const {
    if (dimensions_ != 1) return;
    for (int a = 0; a < n_; ++a) {
      for (int b = a + 1; b < n_; ++b) {
        const auto ia = static_cast<std::size_t>(a), ib = static_cast<std::size_t>(b);
        const double side = z[b] > z[a] ? 1 : -1;
        const double gap = side * (z[b] - z[a]) - run_->radius[ia] - run_->radius[ib];
        const double closing = -side * (z[n_ + b] - z[n_ + a]);
        if (gap > 0 || closing <= 0) continue;
        const double ma = run_->mass[ia], mb = run_->mass[ib];
        const double kick = (1 + model_->restitution) * closing * ma * mb / (ma + mb);
        z[n_ + a] -= side * kick / ma, z[n_ + b] += side * kick / mb;
      }
    }
  }

  const BodyModel* model_;
  const Typical* typical_;
  const BodyRun* run_;
  int dimensions_, n_;
  bool pairs_ = false;
};

struct StateEstimate {
  Vector z;
  Matrix P;
};

// Initial estimate from the first samples: their positions and mean velocity, with a wide
// covariance.
StateEstimate first_estimate(const BodyModel& model, const Typical& typical, const BodyRun& run,
                             int n) {
  const int states = (model.bias > 0 ? 4 : 3) * n;
  StateEstimate out{Vector::Zero(states), Matrix::Zero(states, states)};
  const auto row = static_cast<std::size_t>(n);
  const std::size_t to = std::min<std::size_t>(4, run.samples() - 1);
  for (int i = 0; i < n; ++i) {
    const auto c = static_cast<std::size_t>(i);
    std::size_t a = 0, b = to;
    while (a + 1 < run.samples() && std::isnan(run.position[a * row + c])) ++a;
    b = std::max(b, a + 1);
    while (b + 1 < run.samples() && std::isnan(run.position[b * row + c])) ++b;
    const double x = run.position[a * row + c],
                 u = run.position[std::min(b, run.samples() - 1) * row + c];
    out.z[i] = std::isnan(x) ? 0 : x;
    // A body with a single sample has no velocity.
    const bool moves = b < run.samples() && !std::isnan(u - x);
    out.z[n + i] = moves ? (u - x) / (run.time[b] - run.time[a]) : 0;
    const double dt = run.time[to] - run.time[0], noise = model.noise_of(i % typical.dimensions);
    out.P(i, i) = std::pow(typical.speed * dt, 2) + 100 * noise * noise;
    out.P(n + i, n + i) = typical.speed * typical.speed;
    out.P(2 * n + i, 2 * n + i) = model.push * model.push;
    if (model.bias > 0) out.P(3 * n + i, 3 * n + i) = model.bias * model.bias;
  }
  return out;
}

class Filter {
 public:
  Filter(const BodyModel& model, const Typical& typical, const BodyRun& run)
      : model_(&model),
        typical_(&typical),
        run_(&run),
        mover_(model, typical, run),
        n_(mover_.coordinates()),
        now_(first_estimate(model, typical, run, n_)) {
    F_.setIdentity(now_.z.size(), now_.z.size());
  }

  void run(BodyResiduals& out, Believed* believed) {
    for (std::size_t k = 0; k < run_->samples(); ++k) {
      if (k > 0) advance(k - 1);
      for (int i = 0; i < n_; ++i) update(k, i, out);
      if (believed != nullptr) keep(*believed);
    }
  }

 private:
  void advance(std::size_t k) {
    mover_.advance(k, now_.z, [&](double time, double h) { part(k, time, h); });
  }

  // One step of the mean and of the covariance.
  void part(std::size_t k, double time, double T) {
    const Vector before = now_.z;
    mover_.step(k, time, T, now_.z);
    const auto [dx, dv] = mover_.increments(T);
    for (int i = 0; i < 2 * n_; ++i) {
      const double d = i < n_ ? dx : dv;
      Vector moved = before;
      moved[i] += d;
      mover_.step(k, time, T, moved);
      F_.col(i).head(2 * n_) = (moved.head(2 * n_) - now_.z.head(2 * n_)) / d;
    }
    const double b = 1 / model_->memory, e = std::exp(-b * T), u = b * T;
    const double to_v = u < 1e-4 ? T * (1 - u / 2) : (1 - e) / b;
    const double to_x = u < 1e-3 ? T * T / 2 * (1 - u / 3) : (u - 1 + e) / (b * b);
    for (int i = 0; i < n_; ++i) {
      F_(i, 2 * n_ + i) = to_x, F_(n_ + i, 2 * n_ + i) = to_v, F_(2 * n_ + i, 2 * n_ + i) = e;
    }
    if (model_->bias > 0) {
      for (int i = 0; i < n_; ++i) F_(i, 3 * n_ + i) = T * T / 2, F_(n_ + i, 3 * n_ + i) = T;
    }
    const Matrix half = F_ * now_.P;
    now_.P.noalias() = half * F_.transpose();
    if (T != last_) noise_ = gathered(model_->push, b, T), last_ = T;
    for (int i = 0; i < n_; ++i) add_noise(i, noise_);
  }

  void add_noise(int i, const Gathered& g) {
    const int v = n_ + i, a = 2 * n_ + i;
    Matrix& P = now_.P;
    P(i, i) += g.xx, P(v, v) += g.vv, P(a, a) += g.aa;
    P(i, v) += g.xv, P(v, i) += g.xv;
    P(i, a) += g.xa, P(a, i) += g.xa;
    P(v, a) += g.va, P(a, v) += g.va;
  }

  void update(std::size_t k, int i, BodyResiduals& out) {
    const double seen =
        run_->position[k * static_cast<std::size_t>(n_) + static_cast<std::size_t>(i)];
    if (std::isnan(seen)) return;
    const Vector column = now_.P.col(i);
    const double noise = model_->noise_of(i % typical_->dimensions);
    const double S = std::max(now_.P(i, i), 0.0) + noise * noise;
    const double nu = seen - now_.z[i];
    if (!std::isfinite(nu) || !std::isfinite(S)) {  // the law has run away: as bad as can be
      now_ = first_estimate(*model_, *typical_, *run_, n_);
      out.value.push_back(1e3), out.variance.push_back(1);
      ++out.lost;
      return;
    }
    out.value.push_back(nu), out.variance.push_back(S);
    now_.z += column * (nu / S);
    now_.P.noalias() -= column * column.transpose() / S;
  }

  void keep(Believed& b) const {
    for (int i = 0; i < n_; ++i) {
      b.x.push_back(now_.z[i]), b.v.push_back(now_.z[n_ + i]), b.push.push_back(now_.z[2 * n_ + i]);
    }
  }

  const BodyModel* model_;
  const Typical* typical_;
  const BodyRun* run_;
  Mover mover_;
  int n_;
  StateEstimate now_;
  Matrix F_;
  Gathered noise_{};
  double last_ = -1;
};

}  // namespace

void filter_run(const BodyModel& model, const Typical& typical, const BodyRun& run,
                BodyResiduals& out) {
  Filter(model, typical, run).run(out, nullptr);
}

Believed believed(const BodyModel& model, const Typical& typical, const BodyRun& run) {
  Believed out;
  BodyResiduals residuals;
  Filter(model, typical, run).run(residuals, &out);
  return out;
}

std::vector<double> predicted(const BodyModel& model, const Typical& typical, const BodyRun& run,
                              const Believed& believed, std::size_t from, std::size_t to) {
  const Mover mover(model, typical, run);
  const int n = mover.coordinates();
  Vector z = Vector::Zero(3 * n);
  for (int i = 0; i < n; ++i) {
    const std::size_t at = from * static_cast<std::size_t>(n) + static_cast<std::size_t>(i);
    z[i] = believed.x[at], z[n + i] = believed.v[at];
  }
  for (std::size_t k = from; k < to; ++k) mover.move(k, z);
  return {z.data(), z.data() + n};
}

namespace {

// A root of the covariance of position, velocity and push.
Eigen::Matrix3d root_of(const Gathered& g) {
  Eigen::Matrix3d C;
  C << g.xx, g.xv, g.xa, g.xv, g.vv, g.va, g.xa, g.va, g.aa;
  // Scaled to a unit diagonal: powers of T would spoil the test for positive definiteness.
  const Eigen::Vector3d size = C.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::Matrix3d R = size.cwiseInverse().asDiagonal() * C * size.cwiseInverse().asDiagonal();
  const Eigen::Matrix3d L = (R + 1e-10 * Eigen::Matrix3d::Identity()).llt().matrixL();
  return size.asDiagonal() * L;
}

}  // namespace

BodyRun simulated(const BodyModel& model, const Typical& typical, const BodyRun& run,
                  std::uint64_t seed, std::uint32_t number) {
  constexpr std::uint32_t kPart = 4096;  // numbers of a part's draws; the first has 0 to 2100
  const Mover mover(model, typical, run);
  const int n = mover.coordinates();
  BodyRun out = run;
  Vector z = first_estimate(model, typical, run, n).z;
  const auto draw = [&](std::size_t k, int i, std::uint32_t what) {
    return normal_pair({seed, Stream::bodies, static_cast<std::int64_t>(k), number,
                        static_cast<std::uint32_t>(2 * i) + what});
  };
  for (int i = 0; i < n; ++i) z[2 * n + i] = model.push * draw(0, i, 2000)[0];
  for (std::size_t k = 0; k < run.samples(); ++k) {
    std::uint32_t parts = 0;
    const auto part = [&](double time, double h) {
      mover.step(k - 1, time, h, z);
      const Eigen::Matrix3d root = root_of(gathered(model.push, 1 / model.memory, h));
      for (int i = 0; i < n; ++i) {
        const auto a = draw(k, i, kPart * parts), b = draw(k, i, kPart * parts + 1);
        const Eigen::Vector3d w = root * Eigen::Vector3d(a[0], a[1], b[0]);
        z[i] += w[0], z[n + i] += w[1], z[2 * n + i] += w[2];
      }
      ++parts;
    };
    if (k > 0) mover.advance(k - 1, z, part);
    for (int i = 0; i < n; ++i) {
      double& x = out.position[k * static_cast<std::size_t>(n) + static_cast<std::size_t>(i)];
      if (!std::isnan(x)) x = z[i] + model.noise_of(i % typical.dimensions) * draw(k, i, 1000)[0];
    }
  }
  return out;
}

}  // namespace lilytank::bodies
