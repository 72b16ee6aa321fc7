#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/figure/face_colours.h"
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
    /// A part of a reservoir with a value that is painted; not finite = none is known: hatched.
    struct Piece {
      std::array<Point, 4> corners;  ///< m across, m depth, around it.
      double value = 0;
    };
    std::vector<Piece> pieces = {};  ///< of Section::painted.
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
  /// What the pieces of reservoirs are painted with, and words below its scale; none = no pieces.
  struct Painted {
    FaceColours colours;  ///< of amounts or changes; without a label there is no scale.
    std::vector<std::string> words;
  };
  std::optional<Painted> painted = {};
  double width = 860;  ///< px, of the drawing.
  double stretch = 1;  ///< of depths; 1 = to scale.
  /// A fault (index, with points) that is told from the others, without χ, title and remark: a
  /// picture of where it is.
  std::optional<std::size_t> marked = {};
};
/// Of the scale that pieces are painted with: so a page can paint them by the number of a part.
inline constexpr std::size_t kPaintedParts = 32;
/// Faults stand in groups with the attribute data-fault, their number; pieces in groups with
/// data-painted, their rock's name; their scale, with the words below it, in one with data-scale.
std::string draw(const Section& section);

}  // namespace faultsim::figure
