#pragma once

#include <string>

#include "simulator/horizons/drawn_surface.h"

namespace faultsim {

/// Reads the surface of a fault, m, z up. Either a GOCAD TSurf:
///
///   GOCAD TSurf 1
///   HEADER {
///   name:F1
///   }
///   GOCAD_ORIGINAL_COORDINATE_SYSTEM
///   AXIS_UNIT "m" "m" "m"
///   ZPOSITIVE Depth
///   END_ORIGINAL_COORDINATE_SYSTEM
///   TFACE
///   VRTX 1 0 -2000 1500
///   TRGL 1 2 3
///   END
///
/// (VRTX, PVRTX, ATOM, PATOM and TRGL count; z is upwards without ZPOSITIVE, as GOCAD has it; units
/// m or ft); of a file with several the one whose name is the fault's. Or sticks, rows of one stick
/// after the other, each from top to bottom or back (common/table_reader.h):
///
///   stick, x [m], y [m], depth [m]
///
/// with z [m] in place of depth, neighbours in order. What begins with "GOCAD", behind comments
/// (#), is a TSurf; objects of other kinds in its file do not count.
/// @param given  its name for messages. @param fault  the fault's name.
/// @throws InputError with all that is wrong, line by line.
horizons::DrawnSurface parse_fault_surface(const std::string& text, const std::string& given,
                                           const std::string& fault);

}  // namespace faultsim
