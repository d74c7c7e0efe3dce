// A diagnosis step by step: what `diagnose` does with one experiment, and `prove` with many of one
// tank.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "finder/joint.hpp"
#include "finder/model_selection.hpp"
#include "finder/score_sensitivity.hpp"
#include "lilytank/diagnosis.hpp"

namespace lilytank {

/// Simulations of each kind; ten minutes on two cores by default.
struct DiagnosisBudget {
  int flow_draws, centre, nulls, experiments, round, comparisons;
  explicit DiagnosisBudget(double minutes);
};

/// What recordings said, before anything is fitted to it.
struct Judged {
  Vectors observed;
  ScoreDetails details;
  SelectedModel selected;
  std::string tag;  ///< for the names of what is kept of these recordings
};

class Diagnoser {
 public:
  Diagnoser(const Experiment& experiment, const DiagnosisOptions& options);

  /// Of the recordings, the model and the options that results depend on.
  std::string identity() const;
  /// Flow, baseline, nulls and fingerprints; kept in the directory, which must be claimed. `after`:
  /// simulated experiments that follow, for the progress. Throws Stopped, InputError.
  void prepare(double after = 0);
  /// Simulated experiments of a model that is fitted and shown.
  double model_cost() const;
  /// Which effects recordings of the same kind as the experiment's ask for: verdict, findings,
  /// maps, ranking, smallest sizes.
  Judged judge(const std::vector<Recording>& recordings, Diagnosis& out);
  /// The same where the recordings' vector is known already.
  Judged judge(Judged measured, const std::vector<Recording>& recordings, Diagnosis& out);
  /// The baseline's parameters: where nothing is missing with intervals, by nulls. Returns all that
  /// are calibrated, as the baseline alone has them.
  std::vector<double> report_baseline(const Judged& judged, Diagnosis& out) const;
  /// Fits what was found and shows it on recordings that had no part in it.
  void model_and_show(const Judged& judged, const std::vector<Recording>& held_out, Diagnosis& out);
  /// All of it.
  void run(Diagnosis& out);

  ReferenceEnsemble& ensemble() { return *ensemble_; }
  const ModelSelection& selection() const { return *selection_; }
  const CalibrationSetup& setup() const { return setup_; }
  Stages& stages() { return stages_; }

 private:
  /// The baseline's parameters, their errors, and whether the estimate lay among the simulated
  /// points.
  struct Centre {
    Eigen::VectorXd point, deviation;
    bool settled = false;
  };
  Centre centre_of(const Centre& before, int round, const FlowMaps& maps, const FitBounds& bounds);
  ScorePlan plan(const Eigen::VectorXd& centre) const;
  SelectedModel explained(ModelSelection& selection, ScoreSensitivity& sensitivity,
                          const Eigen::VectorXd& residual);
  bool plain(const ModelSelection& selection, const SelectedModel& e,
             const Eigen::VectorXd& residual) const;
  /// A selection for one experiment's recordings and what it rests on.
  struct Refined {
    SelectedModel model;
    ModelSelection selection;
    ScoreDetails details;
  };
  /// The selection by experiments of its own where `start` asks for them. Throws Stopped.
  Refined refined(Refined start, ScoreSensitivity& sensitivity, const Vectors& observed,
                  const Eigen::VectorXd& residual);
  class Refinement;
  const Effect& effect(const EffectFit& fit) const;
  /// Direct estimates of an effect from recordings: a stream at its place, with its speed,
  /// a force between modules of its range, vortices of their frequency.
  struct Scanned {
    std::vector<HeldParameter> held;
    std::optional<JointAmplitudes> amplitudes;
  };
  std::optional<Scanned> scanned(const Effect& effect, const ScoreDetails& details) const;
  /// With direct estimates from recordings: the line of pumps, the module that differs, what is
  /// scanned.
  Effect found_effect(const EffectFit& fit, const ScoreDetails& details) const;
  std::string stage_name(const EffectFit& fit, const ScoreDetails& details) const;
  /// Learned at the first call.
  const Fingerprint& shape_fingerprint(int shape);
  void report_ranking(const ModelSelection& selection, const Eigen::VectorXd& residual,
                      const SelectedModel& e, Diagnosis& out) const;
  FoundCurve curve(const Eigen::VectorXd& residual, std::size_t s, double z) const;
  void report_detectable(const ModelSelection& selection, Diagnosis& out) const;
  bool is_reported(const SelectedModel& e, const Effect& one) const;
  const FoundCurve* map_of(const std::string& variable, const Diagnosis& out) const;
  void report_where(const FoundCurve& curve, DiagnosisFinding& f) const;
  void report_findings(const ModelSelection& selection, const Eigen::VectorXd& residual,
                       const SelectedModel& e, Diagnosis& out) const;
  static void disown(const SelectedModel& e, Diagnosis& out);
  void warn_of_rest(const SelectedModel& e, Diagnosis& out) const;
  void blame_camera(const SelectedModel& e, Diagnosis& out) const;
  void report_camera(const std::vector<double>& values, Diagnosis& out) const;
  void report_parameters(const JointFit& fit, const std::vector<JointEffect>& found,
                         Diagnosis& out) const;
  Model baseline_at(const Eigen::VectorXd& scaled) const;
  void show(const JointFit& fit, const std::vector<double>& before, const Eigen::VectorXd& baseline,
            const std::vector<Recording>& recordings, Diagnosis& out);

  DiagnosisOptions options_;
  DiagnosisBudget budget_;
  CalibrationSetup setup_;
  Stages stages_;
  std::optional<FlowMaps> maps_;
  Eigen::MatrixXd spread_;
  Eigen::VectorXd deviation_;  ///< of the baseline's parameters
  std::unique_ptr<ReferenceEnsemble> ensemble_;
  std::unique_ptr<ModelSelection> selection_;
  std::map<int, Fingerprint> shape_fingerprints_;  ///< those learned so far, by the plan's index
};

}  // namespace lilytank
