#pragma once

#include <nlohmann/json_fwd.hpp>
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

  bool is_whole() const;         ///< covered, but for rounding.
  double assumed_share() const;  ///< [0, 1], of `size`; 0 where nothing changes.
};

/// Of all compartments together, [0, 1]; of pressure and temperature the larger one.
double assumed_share(const std::vector<FieldIntegral>& integrals);

/// Rows with the keys of schemas/result.schema.json, "field_integrals".
nlohmann::json field_integrals_to_json(const std::vector<FieldIntegral>& integrals);

/// What is assumed, a line for each compartment that is not covered whole; "" where all are.
/// @param plane_strain  integrals are per metre of strike.
std::string field_integrals_to_text(const std::vector<FieldIntegral>& integrals,
                                    bool plane_strain = false);

}  // namespace faultsim
