#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Total stress and pressure before any production.
struct StressAtDepth {
  std::array<double, 9> sigma =
      {};               ///< Pa, σ0, row-major in x (across), y (along), z; tension > 0.
  double pressure = 0;  ///< Pa, p0.
};

/// Initial state at height z (m, depth = −z), a function of depth only (docs/model.md, section 6):
///
///   column:   σ_v = −g ∫ ρ d(depth) − ρ_w g h over the layers at zero offset, h = water_depth;
///             p0 = ρ_w g (depth + h), plus the overpressure within the depth range of the
///             reservoir layer at zero offset
///   profile:  σ_v = σ_v0 + σ_v' depth,  p0 = p00 + p0' depth
///   σ_xx = M1 (σ_v + α_0 p0) − α_0 p0,  σ_yy = M2 (σ_v + α_0 p0) − α_0 p0,  σ_zz = σ_v
///
/// or the uniform tensor in place of the stress. With lithostatic viscous_layers σ_xx = σ_yy = σ_v
/// in the depth ranges of the layers of viscous material (of a box without layers: everywhere if
/// its material is viscous). Above the surface of a column both are zero.
/// @pre the scene comes from read_scene without problems.
StressAtDepth initial_state(const Scene& scene, double z, DepthSide side = DepthSide::mean);

/// A piece of a column, down to `bottom` from the piece above.
struct ColumnPiece {
  double bottom;   ///< m, depth.
  double density;  ///< kg/m3
};

/// initial_state() of one scene at many heights.
class InitialColumn {
 public:
  /// @pre scene outlives this.
  explicit InitialColumn(const Scene& scene);
  StressAtDepth at(double z, DepthSide side = DepthSide::mean) const;

 private:
  StressAtDepth one_sided(double depth, DepthSide side) const;

  const Scene& scene_;
  std::vector<ColumnPiece> pieces_;  ///< of a column; none for a profile.
  DepthInterval reservoir_;          ///< of a field.
};

/// Least compressive principal total stress at a depth, as a pressure, Pa.
double least_stress(const Scene& scene, double depth, DepthSide side = DepthSide::mean);

/// Of a pressure region: of a block's reservoir, or of a box's region as far as it is in the box.
DepthInterval depths_of_region(const Scene& scene, std::size_t region);

/// Depth of the top of a pressure region, m: of a block's reservoir at its offset, or of a box
/// region (cut at the top of the box).
double region_top(const Scene& scene, std::size_t region);

/// p0 of the fluid of a pressure region (index in Scene::pressure) referred to a depth, Pa: that of
/// its top, with a block's own overpressure if it has one, and from there the fluid's own gradient,
/// also above and below the region, so that pressures of one region are compared at one datum.
double initial_region_pressure(const Scene& scene, std::size_t region, double depth);

/// What a block's own overpressure adds to the pressure of the column at height z (m), Pa; 0 for
/// regions without one. It acts in the block's reservoir and on the faults beside it; the total
/// stress stays that of the column, so that the start stays in equilibrium.
double own_pressure_excess(const Scene& scene, std::size_t region, double z,
                           DepthSide side = DepthSide::mean);

/// The initial state of one pressure region, for reports.
struct InitialRegion {
  std::string name;
  double depth = 0;         ///< m, mid-depth of the region.
  double vertical = 0;      ///< σ_v, total, Pa, tension > 0.
  double across = 0;        ///< total horizontal stress across the faults (x), Pa.
  double along = 0;         ///< total horizontal stress along the faults (y), Pa.
  double pressure = 0;      ///< p0 of the region, Pa.
  std::string source = {};  ///< of p0: "report of 1990-01-01"; "" = the scene's own numbers.
};
/// Per pressure region; of a box without regions per fault, at its centre.
std::vector<InitialRegion> initial_regions(const Scene& scene);

/// Whether a layer at zero offset (of a box without layers: the box) is of a viscous material.
bool has_viscous_layer(const Scene& scene);

/// The largest |difference| over all depths between the weight of a real column of a field
/// (a block's, with the reservoir at its offset and sideburden in the gap, or the sideburden's) and
/// of the reference column, Pa: what a start in equilibrium leaves out. 0 for boxes and profiles.
double neglected_weight_difference(const Scene& scene);

}  // namespace faultsim
