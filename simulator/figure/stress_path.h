#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// How the traction at one point of a fault moves in the plane of effective normal stress
/// (compression positive) and shear stress, MPa, against the line of its strength.
struct StressPath {
  std::string title, remark;
  std::vector<double> normal, shear;  ///< MPa, per load step.
  struct Mark {
    std::size_t step = 0;  ///< index in normal and shear.
    std::string word;
  };
  std::vector<Mark> marks;         ///< places that are named: ends of stages.
  double cohesion = 0;             ///< MPa.
  double friction = 0;             ///< tan φ_s.
  std::optional<double> weakened;  ///< tan φ_d, where friction weakens.
  /// The circle of the rock around the point before production; principal stresses of the plane
  /// across the fault, effective as those of the path are, MPa, compression positive.
  struct Circle {
    double largest = 0, smallest = 0;
  };
  std::optional<Circle> circle;
  /// What it was before a change: a thin, paler path, and the line of strength where it was
  /// another.
  struct Before {
    std::vector<double> normal, shear;  ///< MPa, per load step.
    double cohesion = 0, friction = 0;  ///< as above.
  };
  std::optional<Before> before = {};
};
std::string draw(const StressPath& path);

}  // namespace faultsim::figure
