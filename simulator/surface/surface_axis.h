#pragma once

namespace faultsim {

/// A parameter of scenes in which a surface of operators is continuous.
struct SurfaceAxis {
  /// The coordinate in which the operator is smoothest: the logarithm of a modulus, the tangent of
  /// a dip, any other value itself.
  enum class Scale { linear, logarithm, tangent };

  double from = 0, to = 0;  ///< SI; from < to.
  Scale scale = Scale::linear;

  /// The value at x in [-1, 1], and back.
  double value(double x) const;
  double coordinate(double value) const;

 private:
  double scaled(double value) const;
};

}  // namespace faultsim
