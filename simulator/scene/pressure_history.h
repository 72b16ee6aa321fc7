#pragma once

#include <vector>

#include "simulator/scene/scene.h"

namespace faultsim {

/// Δp(t) = scale · h(t − lag), Pa; h is linear between its points, 0 at and before time 0 and
/// constant after the last point.
double pressure_change_at(const PressureHistory& history, double time);

/// factor(t) of a table: linear between its points, constant outside, 1 when empty.
double factor_at(const TimeTable& table, double time);

/// Times of the ends of all load steps, s, of all stages in order.
std::vector<double> step_times(const Scene& scene);

/// The stage (index) that a load step (from 0, over all stages) belongs to.
std::size_t stage_of_step(const Scene& scene, std::size_t step);

}  // namespace faultsim
