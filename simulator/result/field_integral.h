#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace faultsim {

/// What a flow result does to a compartment at the last report that is taken, and how much of that
/// it has itself. Of the modelled part of the compartment (half of it in a half domain), in plane
/// strain per metre of strike.
struct FieldIntegral {
  std::string field;   ///< "pressure" or "temperature".
  std::string region;  ///< the compartment.
  double volume = 0;   ///< m3 (plane strain: m2).
  double covered = 0;  ///< of it, within flow cells.
  int n_cells = 0;
  int n_outside = 0;          ///< cells of which nothing is covered.
  int n_partly = 0;           ///< cells that take the mean of the part that is covered.
  bool takes_nearest = true;  ///< cells outside take what the nearest flow cell has, else nothing.
  double acts = 0;            ///< ∫ Δp dV or ∫ ΔT dV over all of it, Pa m3 or K m3.
  double has = 0;             ///< the same over what is covered: that of the flow cells there.
  double size = 0;            ///< ∫ |Δp| dV or ∫ |ΔT| dV over all of it.
  double assumed = 0;         ///< of `size`, over what is not covered.

  /// Where the flow cells' own integral was kept ("integral": "flow_grid").
  struct Whole {
    double flow_grid = 0;        ///< of the flow cells that count with it: what `acts` is.
    double mapped = 0;           ///< what would act without scaling.
    double largest_scaling = 0;  ///< of the changes at any report, [0, 1).
    double flow_volume = 0;      ///< of these flow cells, m3.
  };
  std::optional<Whole> whole = {};

  bool is_whole() const;         ///< covered, but for rounding.
  double assumed_share() const;  ///< [0, 1], of `size`; 0 where nothing changes.
};

/// Of all compartments together, [0, 1]; of pressure and temperature the larger one.
double assumed_share(const std::vector<FieldIntegral>& integrals);

/// Rows with the keys of schemas/result.schema.json, "field_integrals".
nlohmann::json field_integrals_to_json(const std::vector<FieldIntegral>& integrals);

/// What is assumed, a line for each compartment that is not covered whole, and how the integral of
/// the flow cells was kept; "" where all are covered and that is not asked for.
/// @param plane_strain  integrals are per metre of strike.
std::string field_integrals_to_text(const std::vector<FieldIntegral>& integrals,
                                    bool plane_strain = false);

}  // namespace faultsim
