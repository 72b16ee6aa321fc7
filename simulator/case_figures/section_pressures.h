#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulator/figure/svg.h"
#include "simulator/flow/flow_mapping.h"
#include "simulator/scene/scene.h"

/// Inside of the module: what a flow result says of a section.
namespace faultsim {

/// The flow result that sections are painted with: of pressure, else of temperature.
const FlowLoad& painted_load(const Scene& scene);

/// By how much the pressures of a flow result, or its temperatures where a scene has a field of
/// those alone, have changed in the reservoirs of a section across a field, as the simulation takes
/// them, before integrals are kept (keep_integrals): conservative means over pieces of the section
/// (map_flow, mapped_change), linear in time
/// between the reports that the scene takes. Each reservoir is cut into the same number of columns
/// and rows, at most kMostPieces.
class SectionPressures {
 public:
  static constexpr int kMostPieces = 200;

  /// @param y  m, of the section. @pre the scene is a field with a painted_load().
  /// Throws InputError as map_flow() does.
  SectionPressures(const Scene& scene, double y);

  std::size_t n_blocks() const { return n_blocks_; }
  std::size_t n_pieces() const { return corners_.size() / n_blocks_; }  ///< of each block.
  /// Around a piece of a block, the upper western one first: m across, m depth.
  const std::array<figure::Point, 4>& corners(std::size_t block, std::size_t piece) const {
    return corners_[block * n_pieces() + piece];
  }
  /// Δp or ΔT of the block's pieces at a time, Pa or K; NaN where less than half of a piece is
  /// covered.
  std::vector<double> at(std::size_t block, double time) const;
  double y() const { return y_; }
  /// Whether a block does not end along the faults before it comes to the section.
  bool reaches(std::size_t block) const { return reaches_[block]; }
  double width() const { return width_; }    ///< of the widest piece, m.
  double height() const { return height_; }  ///< of the highest one, m.
  /// How many pieces are covered by half of them or more, of blocks that reach the section.
  std::size_t n_covered() const;
  std::size_t n_all() const;  ///< pieces of blocks that reach the section.

 private:
  void cut(const Scene& scene, std::size_t block, int n_columns, int n_rows,
           std::vector<MappedCell>& cells);

  std::size_t n_blocks_;
  double y_, width_ = 0, height_ = 0;
  std::vector<bool> reaches_;  ///< per block.
  std::vector<double> time_;   ///< s, of the reports.
  std::vector<std::array<figure::Point, 4>> corners_;
  std::vector<double> covered_;  ///< share, per piece of all blocks.
  Eigen::MatrixXd change_;       ///< Pa or K, pieces x reports.
};

}  // namespace faultsim
