#pragma once

#include <string>
#include <vector>

#include "simulator/documents/json_document.h"

namespace faultsim {

/// A parameter of scenes in which a surface of operators is continuous.
struct SurfaceAxis {
  /// The coordinate in which the operator is smoothest: the logarithm of a modulus, the tangent of
  /// a dip, any other value itself.
  enum class Scale { linear, logarithm, tangent };

  std::string name;                   ///< for messages and files.
  std::vector<std::string> pointers;  ///< what it sets in a scene document, all to its value.
  std::string unit;                   ///< SI, of from, to and the value; "" = a number.
  double from = 0, to = 0;            ///< from < to.
  Scale scale = Scale::linear;

  /// The value at x in [-1, 1], and back.
  double value(double x) const;
  double coordinate(double value) const;
  /// Puts the value at x into the document, with 15 digits.
  void set(JsonDocument& document, double x) const;

 private:
  double scaled(double value) const;
};

}  // namespace faultsim
