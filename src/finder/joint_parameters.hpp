// Baseline and effects as one list of parameters: which stand where, and what a point of them says.
#pragma once
#include <vector>

#include "finder/joint.hpp"

namespace lilytank {

/// Where the first design is and how wide, and to which deviation effects' amplitudes are known
/// about its centre (infinity: not at all).
struct Beginning {
  std::vector<double> at, wide, known;
  void add(double centre, double width, double deviation) {
    at.push_back(centre), wide.push_back(width), known.push_back(deviation);
  }
};
/// The first design, from the baseline's answer and what the selection said of the effects; fills
/// `fit` with the model that has the effects and the list of what is fitted.
Beginning begin(const Stages& stages, const std::vector<JointEffect>& effects,
                const JointStart& baseline, JointFit& fit);

/// The effect after the first, strongest one that the data support least, by Wald's distance of its
/// amplitudes from 0; the list's size if the data support all. `point` then becomes the estimate
/// without it.
std::size_t needless(const Stages& stages, const std::vector<JointEffect>& effects,
                     const Eigen::MatrixXd& covariance, double keep, Eigen::VectorXd& point);

/// What a point says of the effects: their amplitudes by their sizes, and what is refined of them.
void read_point(const Stages& stages, const Eigen::VectorXd& point,
                std::vector<JointEffect>& effects);

FitBounds bounds_of(const JointFit& fit);

}  // namespace lilytank
