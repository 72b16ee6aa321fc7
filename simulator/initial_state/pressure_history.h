#pragma once

#include "simulator/scene/scene.h"

namespace faultsim {

/// Δp(t) = scale · h(t − lag), Pa; h is linear between its points, 0 at and before time 0 and
/// constant after the last point.
double pressure_change_at(const PressureHistory& history, double time);

/// factor(t) of a table: linear between its points, constant outside, 1 when empty.
double factor_at(const TimeTable& table, double time);

}  // namespace faultsim
