#include "scores/scores.hpp"

#include <algorithm>
#include <cmath>

#include "effects/features.hpp"
#include "filter/sensitivity.hpp"
#include "forces/pairs.hpp"
#include "scores/bond_numbers.hpp"
#include "scores/nuisances.hpp"
#include "scores/residual_statistics.hpp"
#include "scores/shape_pushes.hpp"
#include "statistics/linear.hpp"

namespace lilytank {
namespace {

constexpr double kContactPush = 0.03;  // m/s: a prediction that was pushed by a contact
// Prior information that amplitudes (in sizes) are 0: of nuisance effects, of joint fits.
constexpr double kHardlyKnown = 1e-4, kJointKnown = 0.1;
constexpr double kKnotKnown = 10;  // information of a knot's value, in sizes, before any data
constexpr double kTouch = 1e-3;    // m: nearer ones may touch before the next frame
constexpr double kHaste = 1.5;     // of the way that a gap closes by until then
constexpr double kLost = 10;       // deviations: no innovation but a fault of the tracker
constexpr double kPlaceScale = 1e-3, kHeadingScale = 1e-2;  // m, rad
constexpr int kNever = -9;                                  // no frame
constexpr double kLoss = 1.5;  // 1/s, share of a velocity that drag takes at usual slips

// Log determinant of an innovation's covariance, by its standard deviations along both axes and of
// the heading relative to kPlaceScale and kHeadingScale. Without it the deviance would prefer
// models that expect more scatter.
double log_determinant(double sd_place, double sd_heading) {
  return 4 * std::log(sd_place / kPlaceScale) + 2 * std::log(sd_heading / kHeadingScale);
}

std::size_t components_of(const std::vector<Effect>& effects) {
  std::size_t count = 0;
  for (const Effect& effect : effects) count += effect.paths.size();
  return count;
}

// Prior information: none for the first amplitudes, then that of the nuisances.
Eigen::MatrixXd known_beside(std::size_t unknown, const Eigen::MatrixXd& nuisances) {
  const auto first = static_cast<Eigen::Index>(unknown);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(first + nuisances.rows(), first + nuisances.rows());
  out.topLeftCorner(first, first).diagonal().setConstant(kHardlyKnown);
  out.bottomRightCorner(nuisances.rows(), nuisances.rows()) = nuisances;
  return out;
}

class Scorer {
 public:
  explicit Scorer(const ScorePlan& plan, bool all_partners = false)
      : plan_(plan),
        modules_(static_cast<std::size_t>(plan.modules)),
        scored_(plan.first_of_effect(plan.effects.size())),
        total_(scored_ + plan.shapes.size() * kKnots),
        beside_(components_of(plan.beside)),
        known_(known_beside(beside_, plan.nuisances_known())),
        features_in_all_(total_ + static_cast<std::size_t>(known_.rows())),
        sensitivities_(features_in_all_, (plan.latched() ? 2 : 1) * modules_,
                       all_partners ? features_in_all_ : static_cast<std::size_t>(known_.rows())),
        shapes_(plan.shapes, scored_),
        pushes_(modules_, Pushes(features_in_all_)),
        last_(2 * modules_, kNever),
        reach_(plan.latched() ? std::max(kTouch, plan.model.control.capture_distance) : kTouch),
        together_(features_in_all_) {}

  // Statistics that values() needs besides the sums of scores.
  void measure_residuals() { parts_ = residual_statistics(plan_); }

  void run(const std::vector<Recording>& recordings) {
    predict(plan_.model, recordings, plan_.predictor,
            [this](const PredictedFrame& frame) { add(frame); });
    sensitivities_.finish();
    if (!parts_.empty() && plan_.latched()) bonds_ = bond_numbers(plan_, recordings);
  }

  std::vector<Sensitivities::Amplitude> amplitudes() const {
    return sensitivities_.amplitudes(known_);
  }

  // For each effect of the plan, its components jointly, without other effects.
  std::vector<JointAmplitudes> jointly() const {
    const auto each = sensitivities_.amplitudes(known_);
    const Eigen::MatrixXd normal = sensitivities_.informations(known_);
    std::vector<JointAmplitudes> out;
    std::size_t first = 0;
    for (const Effect& effect : plan_.effects) {
      const auto size = static_cast<Eigen::Index>(effect.paths.size());
      Eigen::VectorXd score(size);
      for (Eigen::Index k = 0; k < size; ++k) {
        const auto& one = each[first + static_cast<std::size_t>(k)];
        score(k) = one.estimate * one.information;
      }
      const auto at = static_cast<Eigen::Index>(first);
      Eigen::MatrixXd own = normal.block(at, at, size, size);
      own.diagonal().array() += kJointKnown;
      JointAmplitudes one{solve_symmetric(own, score)};
      one.gain = score.dot(one.estimate);
      out.push_back(std::move(one)), first += effect.paths.size();
    }
    return out;
  }

  double deviance() const { return deviance_ - sensitivities_.absorbed(known_); }

  Eigen::MatrixXd informations() const { return sensitivities_.informations(known_); }
  ScoreSums sums() const { return {sensitivities_.scores(), sensitivities_.products()}; }

  std::vector<double> values(ScoreDetails* details) const {
    std::vector<double> values;
    const auto amplitudes = sensitivities_.amplitudes(known_);
    for (std::size_t f = 0; f < scored_; ++f) values.push_back(amplitudes[f].drawn(kScoreKnown));
    for (const auto& part : parts_) part->append_to(values, details);
    values.insert(values.end(), bonds_.begin(), bonds_.end());
    for (std::size_t f = scored_; f < total_; ++f)
      values.push_back(amplitudes[f].drawn(kKnotKnown));
    for (double& value : values) {
      if (!std::isfinite(value)) value = 0;
    }
    return values;
  }

 private:
  void add(const PredictedFrame& frame) {
    const auto n = static_cast<std::size_t>(frame.now.size());
    // Recordings have models of their own; their addresses may repeat.
    if (frame.model != model_ || frame.recording != recording_) {
      model_ = frame.model, recording_ = frame.recording;
      features_ = std::make_unique<Features>(plan_.effects, plan_.beside, *model_);
      pushed_.clear();
    }
    const StepContext now{.time = frame.time, .gusts = false, .expected = true};
    slips_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      slips_[i] = slip_of(*model_, frame.now, now, static_cast<int>(i));
    }
    if (due(frame)) {
      features_->find(frame.now, now);
      for (std::size_t i = 0; i < n; ++i) push(frame, now, i);
      shapes_.push_pairs(*model_, frame.now, pushes_);
    }
    seen_.resize(n);
    find_touching(frame);
    for (std::size_t i = 0; i < n; ++i) seen_[i] = pass(frame, i);
    for (const PredictedAssembly& a : frame.assemblies) pass(frame, a);
    for (const auto& part : parts_) part->add(frame, seen_);
  }

  // Whether the forces are evaluated anew; `pushes_` are of the modules of the frame afterwards.
  bool due(const PredictedFrame& frame) {
    const int every = std::max(1, static_cast<int>(std::lround(plan_.held / frame.interval)));
    if (frame.frame % every != 0 && std::ranges::equal(pushed_, frame.module)) return false;
    pushed_.assign(frame.module.begin(), frame.module.end());
    return true;
  }

  void push(const PredictedFrame& frame, const StepContext& now, std::size_t i) {
    Pushes& to = pushes_[i];
    const int body = static_cast<int>(i);
    const double mass = model_->module.mass;
    push_effects(i, &Wrench::fx, mass, to.x), push_effects(i, &Wrench::fy, mass, to.y);
    push_effects(i, &Wrench::torque, model_->module.inertia(), to.turn);
    shapes_.push(*model_, frame.now, now, slips_[i], body, to);
    if (plan_.nuisances) {
      plan_.nuisances->push(*features_, frame.now, i, total_ + beside_, to);
    }
  }

  // Effects that are scored come first, those beside them after the shapes.
  void push_effects(std::size_t i, double Wrench::*part, double inertia, std::vector<float>& to) {
    std::vector<double>& forces = forces_;
    forces.resize(features_->size());
    for (std::size_t f = 0; f < forces.size(); ++f) forces[f] = features_->at(f, i).*part;
    scale_all(forces.data(), scored_, 1 / inertia, to.data());
    scale_all(forces.data() + scored_, beside_, 1 / inertia, to.data() + total_);
  }

  // Modules in contact with another or the wall, or that may be before the next frame at the
  // present closing speed: contact forces, and those of latches that pull two faces together, are
  // not part of the model here. The criterion uses past frames only, so excluding them does not
  // bias encounters. Members of one assembly always touch.
  void find_touching(const PredictedFrame& frame) {
    const Kinematics& k = frame.now;
    touching_.assign(static_cast<std::size_t>(k.size()), 0);
    assembly_.assign(touching_.size(), -1);
    for (std::size_t a = 0; a < frame.assemblies.size(); ++a) {
      for (const int member : frame.assemblies[a].members) {
        assembly_[static_cast<std::size_t>(member)] = static_cast<int>(a);
      }
    }
    const double side = model_->module.side;
    for_near_pairs(k, 1.6 * side, [&](const NearPair& pair) {
      const auto i = static_cast<std::size_t>(pair.i), j = static_cast<std::size_t>(pair.j);
      if (assembly_[i] >= 0 && assembly_[i] == assembly_[j]) return;
      const SquareGap at = square_gap(k, pair, side);
      const double jx = at.px - pair.dx, jy = at.py - pair.dy;
      const double closing = (k.vx[i] - k.omega[i] * at.py - k.vx[j] + k.omega[j] * jy) * at.nx +
                             (k.vy[i] + k.omega[i] * at.px - k.vy[j] - k.omega[j] * jx) * at.ny;
      const double way = kHaste * frame.interval * std::max(0.0, closing);
      if (at.gap > reach_ + way) return;
      touching_[i] = touching_[j] = 1;
    });
    for (std::size_t i = 0; i < touching_.size(); ++i) {
      if (at_wall(k, i, frame.interval)) touching_[i] = 1;
    }
  }

  // Judged by the outermost corner.
  bool at_wall(const Kinematics& k, std::size_t i, double interval) const {
    const double half = 0.5 * model_->module.side;
    const double u = std::copysign(half, k.c[i] * k.x[i] + k.s[i] * k.y[i]);
    const double v = std::copysign(half, k.c[i] * k.y[i] - k.s[i] * k.x[i]);
    const double px = k.c[i] * u - k.s[i] * v, py = k.s[i] * u + k.c[i] * v;
    const double x = k.x[i] + px, y = k.y[i] + py, radius = std::sqrt(x * x + y * y);
    const double closing =
        ((k.vx[i] - k.omega[i] * py) * x + (k.vy[i] + k.omega[i] * px) * y) / radius;
    const double way = kHaste * interval * std::max(0.0, closing);
    return model_->tank.radius - radius <= kTouch + way;
  }

  Seen pass(const PredictedFrame& frame, std::size_t i) {
    Seen out;
    out.module = static_cast<std::size_t>(frame.module[i]), out.index = i;
    out.slip_x = slips_[i].x(), out.slip_y = slips_[i].y();
    const Wrench& drag = features_->drag(i);
    out.drag_x = drag.fx / model_->module.mass, out.drag_y = drag.fy / model_->module.mass;
    const bool visible = !std::isnan(frame.dx[i]);
    if (visible) {
      out.zx = frame.dx[i] / frame.sd_x[i], out.zy = frame.dy[i] / frame.sd_x[i];
      out.zt = frame.dtheta[i] / frame.sd_theta[i];
    }
    const bool lost = std::max({std::fabs(out.zx), std::fabs(out.zy), std::fabs(out.zt)}) > kLost;
    const bool held = frame.contact[i] > kContactPush || touching_[i] != 0 || assembly_[i] >= 0;
    if (visible && frame.usable[i] != 0 && !held) {
      for (const double z : {out.zx, out.zy, out.zt}) {
        deviance_ += std::min(z * z, kLost * kLost) - 1;
      }
      deviance_ += log_determinant(frame.sd_x[i], frame.sd_theta[i]);
    }
    out.usable = visible && frame.usable[i] != 0 && !held && !lost;
    if (last_[out.module] + 1 != frame.frame || held || lost) sensitivities_.forget(out.module);
    last_[out.module] = frame.frame;
    if (!held && !lost) {
      sensitivities_.pass(out.module, pushes_[i], frame, frame.innovation(i), kLoss, out.usable);
    }
    return out;
  }

  void pass(const PredictedFrame& frame, const PredictedAssembly& a) {
    const std::size_t body = modules_ + static_cast<std::size_t>(a.first);
    const Innovation& e = a.innovation;
    const bool visible = !std::isnan(e.dx);
    double farthest = 0;
    for (const double z : {e.dx / e.sd_x, e.dy / e.sd_x, e.dtheta / e.sd_theta}) {
      if (visible) farthest = std::max(farthest, std::fabs(z));
    }
    bool held = a.contact > kContactPush;
    for (const int i : a.members) held = held || touching_[static_cast<std::size_t>(i)] != 0;
    const bool lost = farthest > kLost, usable = visible && a.usable && !held && !lost;
    if (usable) {
      const double x = e.dx / e.sd_x, y = e.dy / e.sd_x, t = e.dtheta / e.sd_theta;
      deviance_ += x * x + y * y + t * t - 3 + log_determinant(e.sd_x, e.sd_theta);
    }
    if (last_[body] + 1 != frame.frame || a.begun == frame.frame || held || lost) {
      sensitivities_.forget(body);
    }
    last_[body] = frame.frame;
    if (held || lost) return;
    together_.of_members(frame, a, pushes_);
    sensitivities_.pass(body, together_, frame, e, kLoss, usable);
  }

  const ScorePlan& plan_;
  std::size_t modules_;
  std::vector<std::unique_ptr<ResidualStatistic>> parts_;
  std::size_t scored_, total_;  // features that are amplitudes
  // Components of nuisance effects, and prior information of these and of nuisances.
  std::size_t beside_;
  Eigen::MatrixXd known_;
  std::size_t features_in_all_;
  Sensitivities sensitivities_;
  ShapePushes shapes_;
  std::vector<Pushes> pushes_;
  std::vector<int> pushed_;  // modules that these are of
  std::vector<double> forces_;
  std::vector<Vec2> slips_;
  std::vector<int> last_;  // frames, of modules, then of assemblies by their first modules
  double reach_;           // m
  std::vector<std::uint8_t> touching_;
  Pushes together_;            // of an assembly
  std::vector<int> assembly_;  // of each module of the frame; -1: none
  std::vector<double> bonds_;
  const Model* model_ = nullptr;
  int recording_ = -1;
  std::unique_ptr<Features> features_;
  std::vector<Seen> seen_;
  double deviance_ = 0;  // before nuisances absorb a part
};

}  // namespace

std::vector<Sensitivities::Amplitude> scored_amplitudes(const ScorePlan& plan,
                                                        const std::vector<Recording>& recordings) {
  Scorer scorer(plan);
  scorer.run(recordings);
  return scorer.amplitudes();
}

Eigen::MatrixXd score_informations(ScorePlan plan, const std::vector<Recording>& recordings,
                                   const std::vector<Effect>& further) {
  plan.shapes.clear();
  for (const Effect& effect : further) {
    plan.effects.push_back(effect);
    plan.effects.back().scored = true;
  }
  Scorer scorer(plan, true);
  scorer.run(recordings);
  return scorer.informations();
}

ScoreSums score_sums(ScorePlan plan, const std::vector<Recording>& recordings,
                     const std::vector<Effect>& effects) {
  plan.shapes.clear(), plan.beside.clear(), plan.effects = effects;
  for (Effect& effect : plan.effects) effect.scored = true;
  Scorer scorer(plan, true);
  scorer.run(recordings);
  return scorer.sums();
}

Eigen::MatrixXd correlations_of(const Eigen::MatrixXd& informations) {
  const Eigen::VectorXd size = informations.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd out = size.asDiagonal() * informations * size.asDiagonal();
  out.diagonal().setOnes();
  return out;
}

std::vector<JointAmplitudes> joint_amplitudes(ScorePlan plan,
                                              const std::vector<Recording>& recordings,
                                              const std::vector<Effect>& effects) {
  plan.shapes.clear(), plan.effects = effects;
  for (Effect& effect : plan.effects) effect.scored = true;
  Scorer scorer(plan, true);
  scorer.run(recordings);
  return scorer.jointly();
}

double deviance_of(ScorePlan plan, const std::vector<Recording>& recordings) {
  plan.shapes.clear(), plan.effects.clear();
  Scorer scorer(plan);
  scorer.run(recordings);
  return scorer.deviance();
}

std::vector<double> score(const ScorePlan& plan, const std::vector<Recording>& recordings,
                          ScoreDetails* details) {
  Scorer scorer(plan);
  scorer.measure_residuals();
  scorer.run(recordings);
  return scorer.values(details);
}

}  // namespace lilytank
