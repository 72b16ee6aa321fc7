#pragma once

#include <string>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Reads a table of flow cells, in either of two forms, told by the header:
///
///   x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 1995-01-01 [bar]
///   date, x [m], y [m], depth [m], dx [m], dy [m], dz [m], pressure [bar]
///
/// x, y, depth: centre of the cell, depth downwards; dx, dy, dz: its size. Units are those of the
/// header (METRIC: m and bar, FIELD: ft and psi); pressures are absolute. Temperatures likewise, in
/// K, degC or degF, the column of the long form being temperature. In the long form every date has
/// every cell once, and dates come in order. Empty lines and lines that begin with # are skipped.
/// @param given  its name for messages.
/// @throws InputError with the first 20 problems found, each with its line and cure: columns,
/// units, numbers that are none, sizes and pressures below zero, dates that go backwards, cells
/// that are missing at a date or there twice.
FlowField parse_flow_csv(const std::string& text, const std::string& given,
                         FlowQuantity quantity = FlowQuantity::pressure);

}  // namespace faultsim
