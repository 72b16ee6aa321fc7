#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// A vertical cut through a field, to scale unless stretched: what lies where, and how near to
/// sliding its faults are.
struct Section {
  std::string title, remark;
  struct Rock {
    std::string name;
    double from = 0, to = 0;            ///< m, across, at its top;
    double from_base = 0, to_base = 0;  ///< at its base: its sides may lean.
    double top = 0, base = 0;           ///< m, depth.
    bool is_reservoir = false;
    std::string note = {};  ///< beside the name: "−200 bar".
  };
  struct FaultLine {
    std::string name;
    /// Corners from the top down: m across, m depth.
    std::vector<Point> points;
    std::vector<double> chi;  ///< per piece between points; one value = of the whole fault.
  };
  std::vector<Rock> rocks;  ///< later ones over earlier ones.
  std::vector<FaultLine> faults;
  double from = 0, to = 1;   ///< m, across, that is shown.
  double top = 0, base = 1;  ///< m, depth, that is shown.
  double width = 860;        ///< px, of the drawing.
  double stretch = 1;        ///< of depths; 1 = to scale.
  /// A fault (index, with points) that is told from the others, without χ, title and remark: a
  /// picture of where it is.
  std::optional<std::size_t> marked = {};
};
/// Faults stand in groups with the attribute data-fault, their number.
std::string draw(const Section& section);

}  // namespace faultsim::figure
