#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/grid_scene/model_lines.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::grid_scene {

/// The lines as the builder of bodies takes them: a plane reservoir where traces are, no
/// compartments.
horizons::LayeredBody body_of_lines(const ModelLines& lines);

/// Why lines do not fit.
struct Misfit {
  int fault = -1;  ///< the one to leave out; −1: none of them alone.
  std::string what;
  bool is_in_depth = false;  ///< by how it dips; else by its line.
};

/// Which fault is to blame where the builder names none.
enum class Blame {
  of_all,        ///< the last without which all lines fit.
  of_the_first,  ///< else the last without which something else is wrong first.
};

/// What the builder says of the lines, of cells between them and of faults in depth, before it
/// looks at horizons; of faults that cross flatly the later one is to blame. Those that end at a
/// fault which is tried to be left out end in the rock then.
std::optional<Misfit> first_misfit(const ModelLines& lines, Blame blame = Blame::of_all);

}  // namespace faultsim::grid_scene
