#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/flow/flow_mapping.h"

/// IntegralRule::flow_grid: the flow grid's own integrals, whatever our cells cover of it.
namespace faultsim {

/// The compartment that each flow cell counts with: the one that holds most of it (the first of
/// equals), else the one that has the cell of ours whose centre is nearest.
/// @param overlaps  per cell of ours, V(c ∩ f), m3.
std::vector<int> compartments_of_flow_cells(
    const FlowField& field, const std::vector<MappedCell>& cells,
    const std::vector<std::vector<FlowMapping::Weight>>& overlaps);

/// Volume of the part of a flow cell within from <= y <= to, m3.
double volume_between(const FlowCell& cell, const std::array<double, 2>& y_range);

/// What was done to a compartment so that ∫Δp dV is the flow grid's.
struct IntegralBalance {
  double flow_grid = 0;  ///< at the last report, Pa m3 (or K m3).
  double mapped = 0;     ///< of the means at the last report, before anything was done.
  /// Largest |flow_grid − mapped| of all reports over the largest Σ V_c |Δp_c| of all, [0, 0.5].
  double largest_scaling = 0;
};

/// Scales the changes of each compartment in proportion to their size, report by report,
///
///   Δp_c + κ |Δp_c|,    κ = (Σ_f V_f Δp_f − Σ_c V_c Δp_c) / Σ_c V_c |Δp_c|,
///
/// so that their integral is that of the flow cells that count with it, to rounding: what does not
/// change still does not, and no sign changes. Where that wants |κ| > 1/2 (a report at which only
/// flow cells beside the compartment have changed) the rest is spread evenly over its volume. So is
/// what is left of changes of a compartment that are tiny against the field's, whatever κ they
/// want.
/// @param change  of mapped_change() with the same arguments.
/// @throws InputError where the largest_scaling would be above 1/2 and the difference is more than
/// a thousandth of the field's largest change all over the compartment, with the compartment: the
/// grids do not belong together.
std::vector<IntegralBalance> keep_integrals(const FlowMapping& mapping, const FlowField& field,
                                            int reference, const std::vector<int>& reports,
                                            const std::vector<std::string>& region_names,
                                            Eigen::MatrixXd& change);

}  // namespace faultsim
