#include "lilytank/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "smoothing/motion_model.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kPiece = 512;        // frames
constexpr std::size_t kFitFrames = 20480;  // frames that a model is fitted to, about
constexpr std::size_t kLeastFrames = 8;
constexpr double kPi = 3.14159265358979323846;

using AxesOf = Axes (*)(const Track&);
Axes places_of(const Track& t) {
  return {t.x, t.y};
}
Axes headings_of(const Track& t) {
  return {t.theta, {}};
}

std::span<const double> part(std::span<const double> all, std::size_t from, std::size_t to) {
  return all.empty() ? all : all.subspan(from, to - from);
}

// All tracks cut to pieces that begin with a measurement, or pieces spread evenly over them.
std::vector<Axes> pieces_of(const Recording& recording, AxesOf axes_of) {
  std::vector<Axes> pieces;
  for (const Track& track : recording.tracks) {
    const Axes axes = axes_of(track);
    for (std::size_t from = 0; from < axes.frames(); from += kPiece) {
      const std::size_t to = std::min(from + kPiece, axes.frames());
      std::size_t f = from;
      while (f < to && !axes.seen(f)) ++f;
      if (to - f < kLeastFrames) continue;
      pieces.push_back({part(axes.first, f, to), part(axes.second, f, to)});
    }
  }
  constexpr std::size_t kMost = kFitFrames / kPiece;
  std::size_t frames = 0;
  for (const Axes& piece : pieces) frames += piece.frames();
  if (frames <= 2 * kFitFrames) return pieces;
  std::vector<Axes> chosen;
  const double stride = static_cast<double>(pieces.size()) / kMost;
  for (std::size_t i = 0; i < kMost; ++i) {
    chosen.push_back(pieces[static_cast<std::size_t>((static_cast<double>(i) + 0.5) * stride)]);
  }
  return chosen;
}

void check(const SmoothingOptions& options, double rate) {
  if (!(rate > 0) || !std::isfinite(rate)) {
    throw InputError("a recording's rate must be above 0 frames per second, not " + shortest(rate));
  }
  if (options.degree < 2 || options.degree > 5) {
    throw InputError("the degree of a smoothing polynomial must be 2 .. 5, not " +
                     std::to_string(options.degree));
  }
  if (!(options.window > 0) || options.window * rate > 1e5) {
    throw InputError("a smoothing window of " + shortest(options.window) + " s cannot be used");
  }
}

// Where nothing could be fitted: sightings are exact to a millionth, accelerations of the order
// of 1.
MotionModel usable(const MotionModel& model) {
  if (model.samples > 0 || model.acceleration > 0 || model.jolts > 0) return model;
  return {model.noise > 0 ? model.noise : 1e-6, 1, 1};
}

AxesEstimate estimate(const Axes& axes, const SmoothingOptions& options, const MotionModel& model,
                      double interval) {
  if (options.method == SmoothingMethod::polynomial) {
    return smooth_polynomial(axes, options, model.noise, interval);
  }
  return smooth_kalman(axes, usable(model), interval);
}

SmoothTrack smooth_track(const Track& track, const SmoothRecording& all) {
  SmoothTrack out;
  out.id = track.id, out.assembly = track.assembly, out.first = track.first;
  out.seen.resize(track.x.size());
  for (std::size_t f = 0; f < track.x.size(); ++f) out.seen[f] = !std::isnan(track.x[f]);
  AxesEstimate place = estimate(places_of(track), all.options, all.position, 1 / all.rate);
  out.x = std::move(place.axis[0].value), out.y = std::move(place.axis[1].value);
  out.vx = std::move(place.axis[0].velocity), out.vy = std::move(place.axis[1].velocity);
  out.ax = std::move(place.axis[0].acceleration), out.ay = std::move(place.axis[1].acceleration);
  out.sd_x = std::move(place.sd_value), out.sd_v = std::move(place.sd_velocity);
  out.sd_a = std::move(place.sd_acceleration);
  if (track.theta.empty()) return out;
  AxesEstimate turn = estimate(headings_of(track), all.options, all.heading, 1 / all.rate);
  out.theta = std::move(turn.axis[0].value);
  out.spin = std::move(turn.axis[0].velocity);
  out.spin_rate = std::move(turn.axis[0].acceleration);
  out.sd_theta = std::move(turn.sd_value), out.sd_spin = std::move(turn.sd_velocity);
  out.sd_spin_rate = std::move(turn.sd_acceleration);
  return out;
}

double cutoff(const std::vector<double>& frequency, const std::vector<double>& gain) {
  const double level = std::sqrt(0.5);
  for (std::size_t i = 1; i < gain.size(); ++i) {
    if (gain[i] >= level || !(gain[i - 1] >= level)) continue;
    const double share = (gain[i - 1] - level) / (gain[i - 1] - gain[i]);
    return frequency[i - 1] + share * (frequency[i] - frequency[i - 1]);
  }
  return frequency.back();
}

double norm(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum);
}

// Amplitude of the estimate of a motion exp(i w t), over w^order, from the estimate's answer to one
// frame that is off.
std::vector<double> gain_of(const std::vector<double>& answer, const std::vector<double>& frequency,
                            double rate, int order) {
  const auto middle = static_cast<double>(answer.size() / 2);
  std::vector<double> gain;
  for (const double f : frequency) {
    const double w = 2 * kPi * f / rate;  // per frame
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < answer.size(); ++i) {
      sum += answer[i] * std::polar(1.0, -w * (static_cast<double>(i) - middle));
    }
    // At rest the ratio is 0 / 0; every smoother here keeps steady motion and acceleration.
    gain.push_back(f > 0 ? std::abs(sum) / std::pow(2 * kPi * f, order) : 1);
  }
  return gain;
}

}  // namespace

MotionModel fit_position(const Recording& recording, double noise) {
  check({}, recording.rate);
  return fit_motion(pieces_of(recording, places_of), 1 / recording.rate, noise);
}

MotionModel fit_heading(const Recording& recording, double noise) {
  check({}, recording.rate);
  return fit_motion(pieces_of(recording, headings_of), 1 / recording.rate, noise);
}

SmoothRecording smooth(const Recording& recording, const SmoothingOptions& options) {
  check(options, recording.rate);
  SmoothRecording out;
  out.rate = recording.rate;
  out.options = options;
  // Of a model polynomials use only the noise.
  const bool kalman = options.method == SmoothingMethod::kalman;
  out.position.noise = options.noise, out.heading.noise = options.heading_noise;
  if (kalman || !(options.noise > 0)) out.position = fit_position(recording, options.noise);
  if (recording.has_heading() && (kalman || !(options.heading_noise > 0))) {
    out.heading = fit_heading(recording, options.heading_noise);
  }
  out.tracks.reserve(recording.tracks.size());
  for (const Track& track : recording.tracks) out.tracks.push_back(smooth_track(track, out));
  return out;
}

TransferFunction transfer_function(const SmoothingOptions& options, const MotionModel& model,
                                   double rate, int points) {
  check(options, rate);
  // Long enough that the ends are not felt in the middle.
  const double reach = options.method == SmoothingMethod::polynomial ? options.window : 20;
  const auto half = static_cast<std::size_t>(std::clamp(2 * reach * rate, 200.0, 4000.0));
  std::vector<double> blip(2 * half + 1, 0.0);
  blip[half] = 1;
  const AxesEstimate answer = estimate({blip, {}}, options, model, 1 / rate);
  TransferFunction t;
  for (int i = 0; i < points; ++i) t.frequency.push_back(rate / 2 * i / (points - 1));
  std::vector<double> parts[3] = {answer.axis[0].value, answer.axis[0].velocity,
                                  answer.axis[0].acceleration};
  std::vector<double>* gains[3] = {&t.position, &t.velocity, &t.acceleration};
  double* cutoffs[3] = {&t.position_cutoff, &t.velocity_cutoff, &t.acceleration_cutoff};
  double* noise[3] = {&t.position_noise_gain, &t.velocity_noise_gain, &t.acceleration_noise_gain};
  for (int order = 0; order < 3; ++order) {
    for (double& v : parts[order]) v = std::isnan(v) ? 0 : v;
    *gains[order] = gain_of(parts[order], t.frequency, rate, order);
    *cutoffs[order] = cutoff(t.frequency, *gains[order]);
    *noise[order] = norm(parts[order]);
  }
  return t;
}

}  // namespace lilytank
