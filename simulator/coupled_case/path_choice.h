#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/words.h"
#include "simulator/plan/plan.h"

namespace faultsim {

/// How a case is to be solved: on a condensed operator, or with both sides of the faults and
/// multipliers in one system.
enum class SolutionPath { condensed, coupled };
constexpr auto words(SolutionPath) { return std::array{"condensed", "coupled"}; }

struct PathChoice {
  SolutionPath path = SolutionPath::condensed;
  std::string reason;  ///< a sentence with the numbers that decide, for the screen and plan.json.
};

/// Predicted peak of the coupled path with AMG, bytes: by multipliers with RAC (see
/// results/solver-study), or by columns of H, of which a share of the jumps is taken to move.
double coupled_bytes(const Plan& plan, bool by_columns);

/// The path for scenes that leave the choice: condensed wherever its operator fits, because every
/// load step is then nearly free; coupled where only that fits.
/// @param available    bytes; none = not known, taken as enough.
/// @param hindrances   unsupported_by_coupled() of the scene.
/// @param by_columns   takes_columns() of it.
PathChoice choose_path(const Plan& plan, std::optional<double> available,
                       const std::vector<Problem>& hindrances, bool by_columns = false);

}  // namespace faultsim
