#pragma once

#include <string>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Reads a table of flow cells, in either of two forms, told by the header:
///
///   x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 1995-01-01 [bar]
///   date, x [m], y [m], depth [m], dx [m], dy [m], dz [m], pressure [bar]
///
/// x, y, depth: centre of the cell, depth downwards; dx, dy, dz: its size. Sizes that are left out
/// are those of a regular grid (regular_cells.h); without depth a value holds at all depths. Units
/// are those of the header (METRIC: m and bar, FIELD: ft and psi); pressures are absolute.
/// Temperatures likewise, in K, degC or degF, the column of the long form being temperature. In the
/// long form every date has every cell once, and dates come in order.
/// @param given  its name for messages.
/// @throws InputError with what is wrong, each with its line and cure (common/table_reader.h):
/// columns, units, numbers that are none or out of range, dates that go backwards, cells that are
/// missing at a date or there twice, sizes that are neither given nor those of a regular grid.
FlowField parse_flow_csv(const std::string& text, const std::string& given,
                         FlowQuantity quantity = FlowQuantity::pressure);

}  // namespace faultsim
