#pragma once

#include <optional>

#include "simulator/grid_scene/model_lines.h"

/// What becomes of the end of a trace: each takes a trace whose last point is that end.
namespace faultsim::grid_scene {

/// Where a line crosses another first beyond a place along it.
struct LineCrossing {
  Eigen::Vector2d at = {0, 0};
  double along = 0;       ///< m on the line.
  double angle = 0;       ///< rad, [0, π/2]: the least with the other's pieces at hand.
  std::size_t piece = 0;  ///< of the other.
};
std::optional<LineCrossing> crossing_beyond(const Polyline& line, const Polyline& other,
                                            double along);

/// The trace up to a place along it.
Polyline cut_at(const Polyline& line, double along);

/// A trace that crosses `other` near its end, or that is led there, at 35 degrees or more, and then
/// goes on by `beyond`; where it would be flatter its last pieces go straight to the nearest place.
/// The last piece reaches at most 4 cells. Nothing where that is not near enough.
std::optional<Polyline> led_across(const Polyline& trace, const Polyline& other, double cell,
                                   double beyond);

/// A trace that ends on `other`, within a tenth of a cell, at 35 degrees or more. Otherwise its end
/// is moved there by up to a cell, or its last pieces go straight to the nearest place. Unchanged
/// where even that is too flat.
Polyline led_to(const Polyline& trace, const Polyline& other, double cell);

/// The trace prolonged at its end in the direction of its last piece.
Polyline prolonged(Polyline trace, double by);

}  // namespace faultsim::grid_scene
