// Parameters of baseline and effects as one vector, and conversions between the two.
#pragma once
#include <vector>

#include "finder/joint.hpp"

namespace lilytank {

/// Centre and width of the first design, and prior deviations of the effects' amplitudes about the
/// centre (infinity: no prior).
struct Beginning {
  std::vector<double> at, wide, known;
  void add(double centre, double width, double deviation) {
    at.push_back(centre), wide.push_back(width), known.push_back(deviation);
  }
};
/// The first design, from the baseline's estimate and the selection's amplitudes; sets the model
/// with the effects and the list of fitted parameters in `fit`.
Beginning begin(const Stages& stages, const std::vector<JointEffect>& effects,
                const JointStart& baseline, JointFit& fit);

/// The effect after the first, strongest one that the data support least, by Wald's distance of its
/// amplitudes from 0; the list's size if the data support all. `point` then becomes the estimate
/// without it.
std::size_t least_supported(const Stages& stages, const std::vector<JointEffect>& effects,
                            const Eigen::MatrixXd& covariance, double keep, Eigen::VectorXd& point);

/// Sets amplitudes (relative to their sizes) and refined parameters of the effects from a point.
void read_point(const Stages& stages, const Eigen::VectorXd& point,
                std::vector<JointEffect>& effects);

/// Indices of the parameters of effects that have a place.
std::vector<Eigen::Index> placed_parameters(const Stages& stages,
                                            const std::vector<JointEffect>& effects);

FitBounds bounds_of(const JointFit& fit);

}  // namespace lilytank
