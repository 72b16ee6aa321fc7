#include "simulator/surface/surface_axis.h"

#include <cmath>

namespace faultsim {

double SurfaceAxis::scaled(double value) const {
  if (scale == Scale::logarithm) return std::log(value);
  return scale == Scale::tangent ? std::tan(value) : value;
}

double SurfaceAxis::value(double x) const {
  const double low = scaled(from), high = scaled(to);
  const double at = 0.5 * (low + high) + 0.5 * (high - low) * x;
  if (scale == Scale::logarithm) return std::exp(at);
  return scale == Scale::tangent ? std::atan(at) : at;
}

double SurfaceAxis::coordinate(double value) const {
  const double low = scaled(from), high = scaled(to);
  return (2 * scaled(value) - low - high) / (high - low);
}

}  // namespace faultsim
