#include "bodies/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "statistics/linear.hpp"

namespace lilytank::bodies {
namespace {

constexpr double kImpossible = -1e300;  // log-likelihood where predictions are not finite
constexpr double kLoose = 3.0;  // deviation of the weak prior on logarithms of noise and pushes
constexpr double kCurve = 3.0;  // of knots, in sizes of the pushes that the baseline needs
constexpr double kWide = 100;   // of other amplitudes
constexpr double kRange = 1.5;  // of logarithms of exponents and ranges, about their start

BodyResiduals innovations(const Group& g, const BodyModel& m) {
  BodyResiduals out;
  out.value.reserve(g.fold.size()), out.variance.reserve(g.fold.size());
  for (const BodyRun* run : g.runs) filter_run(m, g.typical, *run, out);
  return out;
}

double term(double nu, double S) {
  return -0.5 * (nu * nu / S + std::log(2 * std::numbers::pi * S));
}

// Gradient and information of the log-likelihood without one fold.
class Hill {
 public:
  /// `held`: noise and pushes stay as they are.
  Hill(const Group& group, const BodyModel& model, int without, bool held)
      : group_(&group), model_(&model), without_(without), held_(held) {
    numbers_.assign(own_numbers(model), {kLoose, false, true});
    for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i].centre = group.penalty_at[i];
    for (const auto& [k, i] : fitted_parameters(model)) {
      const LawParameter& p = model.terms[k].parameters[i];
      if (p.kind == Kind::positive)
        numbers_.push_back({kRange, false, true, std::log(p.start)});
      else
        numbers_.push_back({model.terms[k].law->curve ? kCurve : kWide, p.kind == Kind::place});
    }
  }

  double prior(const std::vector<double>& q) const {
    double sum = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Number& n = numbers_[i];
      if (!n.free) sum -= std::pow((q[i] - n.centre) / n.deviation, 2) / 2;
    }
    return sum;
  }

  double height(const BodyResiduals& in, const std::vector<double>& q) const {
    double sum = prior(q);
    for (std::size_t k = 0; k < in.value.size(); ++k) {
      if (group_->fold[k] != without_ || without_ < 0) sum += term(in.value[k], in.variance[k]);
    }
    return std::isfinite(sum) ? sum : kImpossible;
  }

  BodyResiduals at(const std::vector<double>& q) const {
    return innovations(*group_, unpacked(*model_, q));
  }

  // Bounds a step by 2 in a logarithm; amplitudes act linearly and need no bound.
  Eigen::VectorXd step(const Eigen::MatrixXd& I, const Eigen::VectorXd& g, double damping) const {
    Eigen::MatrixXd A = I;
    for (Eigen::Index i = 0; i < A.rows(); ++i) A(i, i) += damping * I(i, i) + 1e-9;
    Eigen::VectorXd step = solve_symmetric(A, g);
    double largest = 0;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      if (numbers_[static_cast<std::size_t>(i)].logarithm)
        largest = std::max(largest, std::fabs(step[i]));
    }
    if (largest > 2) step *= 2 / largest;
    return step;
  }

  // Derivatives are taken over all samples once; any fold's share follows from them.
  void derive(const std::vector<double>& q, const BodyResiduals& here) {
    base_ = here;
    slopes_.clear();
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (held_ && i < own_numbers(*model_)) {
        slopes_.push_back({std::vector<double>(here.value.size(), 0.0),
                           std::vector<double>(here.value.size(), 0.0)});
        continue;
      }
      std::vector<double> moved = q;
      const double h = i < own_numbers(*model_) ? 1e-3 : 1e-4;
      moved[i] += h;
      BodyResiduals in = at(moved);
      for (std::size_t k = 0; k < in.value.size(); ++k) {
        in.value[k] = (in.value[k] - here.value[k]) / h;
        in.variance[k] = (in.variance[k] - here.variance[k]) / h;
      }
      slopes_.push_back(std::move(in));
    }
  }

  void gather(const std::vector<double>& q, Eigen::VectorXd& g, Eigen::MatrixXd& I) const {
    const auto n = static_cast<Eigen::Index>(q.size());
    g = Eigen::VectorXd::Zero(n), I = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < base_.value.size(); ++k) {
      if (without_ >= 0 && group_->fold[k] == without_) continue;
      const double S = base_.variance[k], nu = base_.value[k];
      for (Eigen::Index i = 0; i < n; ++i) {
        const BodyResiduals& a = slopes_[static_cast<std::size_t>(i)];
        g[i] += -nu * a.value[k] / S + 0.5 * a.variance[k] / S * (nu * nu / S - 1);
        for (Eigen::Index j = 0; j <= i; ++j) {
          const BodyResiduals& b = slopes_[static_cast<std::size_t>(j)];
          I(i, j) += a.value[k] * b.value[k] / S + 0.5 * a.variance[k] * b.variance[k] / (S * S);
        }
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Number& of = numbers_[at];
      if (of.free) continue;
      const double weight = 1 / (of.deviation * of.deviation);
      g[i] -= (q[at] - of.centre) * weight, I(i, i) += weight;
    }
    I = Eigen::MatrixXd(I.selfadjointView<Eigen::Lower>());
    if (held_) {
      for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(own_numbers(*model_)); ++i) {
        g[i] = 0, I.row(i).setZero(), I.col(i).setZero(), I(i, i) = 1;
      }
    }
  }

 private:
  // Weak priors: noise, pushes, exponents and ranges about their size, amplitudes about 0. They
  // determine knots without samples, and bound what the recordings do not determine.
  struct Number {
    double deviation;
    bool free;  // without a prior
    bool logarithm = false;
    double centre = 0;
  };
  const Group* group_;
  const BodyModel* model_;
  int without_;
  bool held_;
  std::vector<Number> numbers_;
  BodyResiduals base_;
  std::vector<BodyResiduals> slopes_;
};

struct Top {
  std::vector<double> q;
  BodyResiduals in;
  double height = 0;
  Eigen::MatrixXd information;
};

Top climb(Hill& hill, std::vector<double> q, int most) {
  constexpr double kEnough = 0.01;  // nat that a step must promise
  Top top{q, hill.at(q), 0, {}};
  top.height = hill.height(top.in, q);
  double damping = 1e-3;
  Eigen::VectorXd g;
  for (int round = 0; round < most; ++round) {
    hill.derive(top.q, top.in);
    hill.gather(top.q, g, top.information);
    bool better = false;
    double promise = 0, gained = 0;
    for (int tries = 0; tries < 8 && !better; ++tries) {
      const Eigen::VectorXd step = hill.step(top.information, g, damping);
      promise = step.dot(g) / 2;
      if (!(promise > kEnough)) break;
      std::vector<double> moved = top.q;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += step[static_cast<Eigen::Index>(i)];
      BodyResiduals in = hill.at(moved);
      const double height = hill.height(in, moved);
      better = height > top.height;
      damping = better ? damping / 5 : damping * 6;
      if (!better) continue;
      gained = height - top.height;
      top.q = std::move(moved), top.in = std::move(in), top.height = height;
    }
    if (!better || gained < kEnough) break;
  }
  return top;
}

// Whether the user marks held-out runs.
bool marks_runs(const BodyExperiment& e) {
  return std::any_of(e.runs.begin(), e.runs.end(), [](const BodyRun& r) { return r.held_out; });
}

}  // namespace

double Fitted::held_out_sum() const {
  double sum = 0;
  for (const double h : held_out) sum += h;
  return sum;
}

bool Fitted::usable() const {
  return likelihood > kImpossible / 2 && lost == 0;
}

Fitted fit_group(const Group& group, const BodyModel& from, bool held, int rounds) {
  Hill hill(group, from, -1, held);
  const Top top = climb(hill, packed(from), rounds);
  Fitted out;
  out.model = unpacked(from, top.q), out.numbers = top.q;
  out.likelihood = top.height - hill.prior(top.q), out.lost = top.in.lost;
  const auto n = static_cast<Eigen::Index>(top.q.size());
  Eigen::MatrixXd I = top.information;
  I.diagonal().array() += 1e-9;
  const Eigen::MatrixXd C = symmetric_inverse(I);
  for (Eigen::Index i = 0; i < n; ++i) out.deviation.push_back(std::sqrt(std::max(C(i, i), 0.0)));
  return out;
}

void leave_folds_out(const Group& g, Fitted& fitted) {
  // Noise and pushes are fixed: refitted without a fold, they would weight it by the agreement of
  // the few others.
  fitted.held_out.assign(static_cast<std::size_t>(g.blocks), 0);
  for (int fold = 0; fold < g.folds; ++fold) {
    Hill hill(g, fitted.model, fold, true);
    const Top without = climb(hill, fitted.numbers, 3);
    for (std::size_t k = 0; k < g.fold.size(); ++k) {
      if (g.fold[k] == fold) {
        fitted.held_out[static_cast<std::size_t>(g.block[k])] +=
            term(without.in.value[k], without.in.variance[k]);
      }
    }
  }
  // Where runs are marked as held out, only these are scored.
  std::set<int> scored;
  for (std::size_t k = 0; k < g.fold.size(); ++k) {
    if (g.fold[k] >= 0) scored.insert(g.block[k]);
  }
  if (std::find(g.fold.begin(), g.fold.end(), -1) == g.fold.end()) return;
  std::vector<double> kept;
  for (const int block : scored) kept.push_back(fitted.held_out[static_cast<std::size_t>(block)]);
  fitted.held_out = std::move(kept);
}

namespace {

// The median; 1 of an empty list.
double middle(std::vector<double>& v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 1.0 : v[v.size() / 2];
}

}  // namespace

Group make_group(const BodyExperiment& e, const std::string& name,
                 const std::vector<const BodyRun*>& runs) {
  constexpr int kQuarters = 4, kMostFolds = 6, kBlocks = 24;
  Group g;
  g.name = name, g.runs = runs, g.typical = typical_of(e, runs);
  const bool marked = marks_runs(e);
  const int n = static_cast<int>(runs.size());
  std::size_t all = 0;
  for (const BodyRun* r : runs) all += r->samples();
  int block = 0;
  for (int r = 0; r < n; ++r) {
    const BodyRun& run = *runs[static_cast<std::size_t>(r)];
    const std::size_t samples = run.samples(), row = run.coordinates();
    const int parts = std::max(
        n == 1 ? kQuarters : 2,
        static_cast<int>(kBlocks * static_cast<double>(samples) / static_cast<double>(all)));
    for (std::size_t k = 0; k < samples; ++k) {
      const int part = static_cast<int>(k * static_cast<std::size_t>(parts) / samples);
      const int fold = marked   ? (run.held_out ? 0 : -1)
                       : n == 1 ? part % kQuarters
                                : r % kMostFolds;
      for (std::size_t i = 0; i < row; ++i) {
        if (std::isnan(run.position[k * row + i])) continue;
        g.fold.push_back(fold), g.block.push_back(block + part);
        g.folds = std::max(g.folds, fold + 1);
      }
    }
    block += parts;
  }
  g.blocks = block;
  std::vector<double> steps;
  for (const BodyRun* r : runs) {
    for (std::size_t k = 1; k < r->samples(); ++k) steps.push_back(r->time[k] - r->time[k - 1]);
  }
  g.step = middle(steps);
  return g;
}

BodyModel first_model(const BodyExperiment& e, const Group& g) {
  BodyModel m;
  std::vector<double> bends, of_axis[2];
  for (const BodyRun* run : g.runs) {
    const std::size_t row = run->coordinates();
    for (std::size_t k = 2; k < run->samples(); ++k) {
      for (std::size_t i = 0; i < row; ++i) {
        const double bend = run->position[k * row + i] - 2 * run->position[(k - 1) * row + i] +
                            run->position[(k - 2) * row + i];
        if (!std::isfinite(bend)) continue;
        bends.push_back(std::fabs(bend));
        of_axis[i % static_cast<std::size_t>(e.dimensions)].push_back(std::fabs(bend));
      }
    }
  }
  const double dt = g.step, size = g.typical.speed * dt;
  const double bend = std::max(middle(bends), 1e-6 * size);
  m.noise_fitted = e.noise <= 0;
  m.noise = m.noise_fitted ? bend / 3 : e.noise;
  if (m.noise_fitted && e.dimensions == 2) {
    m.noise = std::max(middle(of_axis[0]), 1e-6 * size) / 3;
    m.noise_y = std::max(middle(of_axis[1]), 1e-6 * size) / 3;
  }
  m.least_noise = 1e-6 * size;
  m.push = std::max(bend / (dt * dt) / 3, 0.1 * g.typical.speed / g.typical.duration);
  m.least_push = 1e-7 * m.push, m.usual_push = m.push, m.most_push = 1e4 * m.push;
  m.memory = 10 * dt, m.least_memory = 0.2 * dt,
  m.most_memory = std::max(g.typical.duration / 20, 2 * dt);
  m.memory = std::min(m.memory, m.most_memory);
  return m;
}

}  // namespace lilytank::bodies
