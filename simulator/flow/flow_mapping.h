#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "simulator/flow/cell_overlap.h"
#include "simulator/flow/flow_field.h"
#include "simulator/flow/mapping_rules.h"

namespace faultsim {

/// A cell of ours that is to get a pressure.
struct MappedCell {
  CellCorners corners;
  int region = -1;      ///< compartment, >= 0.
  double fraction = 1;  ///< share of its volume in the compartment, [0, 1].
};

/// A hexahedron between two sides that may lean. @param west, east  x of each at the top and at the
/// bottom, m.  @param top, bottom  depths, m.  @param half_length  it covers |y| <= half_length, m.
CellCorners between_sides(const std::array<double, 2>& west, const std::array<double, 2>& east,
                          double top, double bottom, double half_length);

inline constexpr double kHalfSection = 0.5;  ///< m.
/// A cell of the one row that plane strain has, as the section at y that it stands for: from half a
/// metre before y to half a metre behind, m, so that flow cells that meet at y count alike.
CellCorners at_section(CellCorners corners, double y);

/// How much of a compartment the flow grid covers.
struct RegionCoverage {
  double volume = 0;   ///< Σ fraction · V_c, m3.
  double covered = 0;  ///< Σ fraction · Σ_f V(c ∩ f), m3; of flow_grid by the flow cells that
                       ///< count with it.
  int n_cells = 0;
  int n_outside = 0;  ///< cells of which nothing is covered: OutsideRule decides for them.
  int n_partly = 0;   ///< cells covered in part: the mean of the part holds for all of the cell.
};

/// Means over our cells as weights of flow cells.
struct FlowMapping {
  struct Weight {
    int flow_cell;
    double value;  ///< > 0; those of one cell add up to 1.
  };
  std::vector<std::vector<Weight>> weights;  ///< per cell; empty: unchanged.
  std::vector<double> covered;               ///< per cell, share of all of it, [0, 1].
  std::vector<RegionCoverage> coverage;      ///< per compartment.
  std::vector<int> region;                   ///< per cell.
  std::vector<double> part;                  ///< per cell, fraction · V_c, m3.
  /// Of IntegralRule::flow_grid, per compartment: the flow cells that count with it, and the volume
  /// of each, m3. Else none.
  std::vector<std::vector<Weight>> flow_cells = {};
};

/// V(c ∩ f) in place of the weights, m3, per cell of ours, f ascending.
using FlowOverlaps = std::vector<std::vector<FlowMapping::Weight>>;

/// @throws InputError where flow cells lie over each other (a cell is covered more than once, by
/// 1 % of its volume), with the place.
FlowOverlaps flow_overlaps(const FlowField& field, const std::vector<MappedCell>& cells);

/// The weights V(c ∩ f) / Σ_f V(c ∩ f), f ascending, so that ∫p dV over what both grids cover is
/// conserved to rounding. A cell half outside of its compartment takes the mean over all of it.
/// By IntegralRule::flow_grid a cell takes from flow cells that count with its compartment only, so
/// that none of the other side's reaches across a fault which is straighter here than there.
/// @param overlaps  flow_overlaps() of the same.
FlowMapping map_overlaps(const FlowField& field, const std::vector<MappedCell>& cells,
                         FlowOverlaps overlaps, const std::vector<std::string>& region_names,
                         const MappingRules& rules);

/// Both of these. @throws as flow_overlaps() does.
FlowMapping map_flow(const FlowField& field, const std::vector<MappedCell>& cells,
                     const std::vector<std::string>& region_names, const MappingRules& rules);

/// Δp of reports since another one in our cells, Pa (n_cells x n_reports): Σ_f w (p_f −
/// p_f(reference)). By IntegralRule::flow_grid see keep_integrals().
/// @pre reference and reports are reports of the field.
/// @param reports  empty = all.
Eigen::MatrixXd mapped_change(const FlowMapping& mapping, const FlowField& field, int reference,
                              std::vector<int> reports = {});

/// What is covered of a compartment: "98.2 % of its volume covered; 3 of 120 cells outside take
/// what the nearest flow cell has; 5 covered in part take that part's mean".
std::string coverage_text(const RegionCoverage& region, OutsideRule rule);

}  // namespace faultsim
