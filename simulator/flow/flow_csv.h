#pragma once

#include <string>
#include <string_view>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Reads a table of flow cells, in either of two forms, told by the header:
///
///   x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 1995-01-01 [bar]
///   date, x [m], y [m], depth [m], dx [m], dy [m], dz [m], pressure [bar]
///
/// x, y, depth: centre of the cell, depth downwards, or z, upwards from 0 and so never above it;
/// dx, dy, dz: its size. Sizes that are left out are found as point_cells.h says; without depth a
/// value holds at all depths. Units are those of the header (METRIC: m and bar, FIELD: ft and psi);
/// pressures are absolute. Temperatures likewise, in K, degC or degF, the column of the long form
/// being temperature. In the long form, which a column date or time tells, columns and rows come in
/// any order, every date has every cell once, pressure and temperature may both be there, and
/// columns of other properties are not used, which a note says. In the wide form dates come in
/// order. Names of columns may be in capitals.
/// @param given  its name for messages.
/// @throws InputError with what is wrong, each with its line and cure (common/table_reader.h):
/// columns, units, numbers that are none or out of range, dates of columns that go backwards, cells
/// that are missing at a date or there twice, sizes that are neither given nor can be told.
FlowField parse_flow_csv(std::string_view text, const std::string& given,
                         FlowQuantity quantity = FlowQuantity::pressure);

}  // namespace faultsim
