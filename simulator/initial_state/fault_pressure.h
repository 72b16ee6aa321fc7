#pragma once

#include <cstddef>
#include <vector>

#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

/// The fluid pressure of faults, as far as the scene alone says it: no mesh, no operator.
namespace faultsim {

/// What a fault's rule makes of the pressure changes of the cells on either side, Pa; 0 for the
/// rules prescribed, table and none.
double pressure_by_rule(const FaultPressure& law, double minus, double plus);

/// The change that rule `prescribed` gives at time t, Pa, where it acts: without a table reached
/// linearly over the first stage and held.
double prescribed_pressure_change(const Scene& scene, const FaultPressure& law, double time);

/// Δp_f of a fault's table at a place and time, Pa: linear in between, constant beyond the places
/// and after the last time.
/// @param dip, strike  m, as the table counts them. @param time  s.
double table_pressure(const FaultPressureTable& table, double dip, double strike, double time);

/// Top and base of a fault, m, cut at those of a box.
DepthInterval depths_of_fault(const Scene& scene, std::size_t fault);
/// The extent of a fault as its table counts places, m: depths or distances down dip (low, high),
/// and along strike.
struct TableExtent {
  std::array<double, 2> dip = {0, 0}, strike = {0, 0};
};
TableExtent table_extent(const Scene& scene, std::size_t fault);

/// A place on a fault.
struct FaultPlace {
  double depth = 0;                  ///< m.
  DepthSide side = DepthSide::mean;  ///< p0 and stress may jump there.
  double dip = 0, strike = 0;        ///< m, in the fault's table.
};
/// The places of a fault between which its initial pressure and what rule `prescribed` or `table`
/// adds are linear, so that extremes are at one of them; none for other rules, and where the rule
/// acts nowhere.
std::vector<FaultPlace> given_pressure_places(const Scene& scene, std::size_t fault);
/// Δp_f of these rules at such a place, Pa.
double given_pressure_change(const Scene& scene, std::size_t fault, const FaultPlace& place,
                             double time);

}  // namespace faultsim
