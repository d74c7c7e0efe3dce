// The baseline model as a predictor: where it expects every module one frame later, and how far off
// that was.
//
// A filter carries each module's place, velocity, heading and spin. From frame to frame all modules
// of a recording are moved by the simulator itself, with every random force at its expectation
// (Model::expected), so that contacts push in a prediction as they do in a simulation; what the
// camera then saw corrects the filter [Kalman 1960]. Innovations, the differences of the two, know
// nothing of the future: whatever is correlated with them was left out of the model.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "lilytank/model.hpp"
#include "lilytank/recording.hpp"
#include "lilytank/smoothing.hpp"

namespace lilytank {

struct PredictorOptions {
  int substeps = 4;  ///< steps of the simulator from frame to frame
  /// Tracking noise and random forces, of positions and headings: what the gains are made of.
  MotionModel position, heading;
  double start = 1;     ///< s at the begin of a track that are not used: the filter settles
  double forget = 0.5;  ///< s unseen after which a module is no longer carried along
};

/// Options of the filter for recordings: their noise by fit_position and fit_heading, and jolts
/// that give the model's innovations the variance that the filter predicts.
PredictorOptions predictor_options(const Model& model, const std::vector<Recording>& recordings);

/// Place and heading of a body in the next frame, measured minus predicted.
struct Innovation {
  double dx = 0, dy = 0, dtheta = 0;      ///< m, rad; NaN where not seen
  double sd_x = 0, sd_theta = 0;          ///< their deviations by the filter
  double gain_x = 0, gain_v = 0;          ///< shares of it that correct x (1) and v (1/s)
  double gain_theta = 0, gain_omega = 0;  ///< likewise of headings
};

/// Latched modules that are predicted as one rigid body.
struct PredictedAssembly {
  std::span<const int> members;  ///< numbers in the frame
  int first = 0;                 ///< identity of the first member
  int begun = 0;                 ///< frame from which it has had these members
  double x = 0, y = 0;           ///< m, centre of mass at `frame`
  double mass = 0, inertia = 0;  ///< kg; kg m^2, about the centre of mass
  Innovation innovation;         ///< of the centre of mass; NaN unless all members were seen
  double contact = 0;            ///< as PredictedFrame::contact
  bool usable = false;           ///< the filter has settled
};

/// What the filter knows at one frame, from this frame and earlier ones only, and what the next
/// frame then showed. Arrays have a value for each module that is carried along.
struct PredictedFrame {
  int recording = 0, frame = 0;  ///< the frame that was predicted from
  double time = 0;               ///< s since the recording's begin
  double interval = 0;           ///< s to the next frame
  const Model* model = nullptr;  ///< of these modules
  Kinematics now;                ///< filtered, at `frame`
  std::span<const int> module;   ///< number of the identity, the same over all recordings
  /// Next frame: place (m) and heading (rad) measured minus predicted; NaN where not seen.
  std::span<const double> dx, dy, dtheta;
  std::span<const double> sd_x, sd_theta;  ///< their deviations by the filter
  /// Change of velocity by contacts in the prediction, m/s; its size.
  std::span<const double> contact;
  std::span<const double> gain_x, gain_v;  ///< of positions: shares of an innovation that correct
  std::span<const double> gain_theta, gain_omega;  ///< x (1), v (1/s); likewise of headings
  /// 1: the filter has settled, and the module is in no assembly.
  std::span<const std::uint8_t> usable;
  /// Of recordings with latches on. Innovations of their members are relative to their motion as
  /// one body.
  std::span<const PredictedAssembly> assemblies;
  /// Of module number i.
  Innovation innovation(std::size_t i) const {
    return {dx[i],     dy[i],     dtheta[i],     sd_x[i],      sd_theta[i],
            gain_x[i], gain_v[i], gain_theta[i], gain_omega[i]};
  }
};

/// Runs the filter through recordings of modules and calls `visit` frame by frame. `model` is the
/// baseline; its number of modules and latches do not count. Recordings without headings are
/// refused, as the faces' drag needs them. Throws InputError.
void predict(const Model& model, const std::vector<Recording>& recordings,
             const PredictorOptions& options,
             const std::function<void(const PredictedFrame&)>& visit);

}  // namespace lilytank
