#pragma once

#include <cstddef>
#include <vector>

#include "simulator/scene/scene.h"

namespace faultsim {

/// The two values around a place of a table, and how far it is from the first to the second.
struct Between {
  std::size_t first = 0, second = 0;  ///< the same at its ends and beyond.
  double share = 0;
};
Between between(const std::vector<double>& x, double at);

/// Linear between points, constant outside. @pre there is one.
double value_at(const std::vector<double>& x, const std::vector<double>& y, double at);

/// Δp(t) = scale · h(t − lag), Pa; h is linear between its points, 0 at and before time 0 and
/// constant after the last point.
double pressure_change_at(const PressureHistory& history, double time);

/// factor(t) of a table: linear between its points, constant outside, 1 when empty.
double factor_at(const TimeTable& table, double time);

}  // namespace faultsim
