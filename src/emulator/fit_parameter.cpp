#include "lilytank/fit_parameter.hpp"

#include "lilytank/math.hpp"

namespace lilytank {

double FitParameter::to_scale(double value) const {
  return logarithmic ? log_portable(value) : value;
}
double FitParameter::from_scale(double value) const {
  return logarithmic ? exp_portable(value) : value;
}

}  // namespace lilytank
