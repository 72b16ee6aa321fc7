#pragma once

#include <string>

#include "simulator/contact/contact_problem.h"
#include "simulator/contact/stability.h"

namespace faultsim {

/// "fault 'main' at x = 12 m, y = 0 m, depth = 2000 m".
std::string place(const ContactProblem& problem, int node);

/// Why a sub-step is not in equilibrium: counts per reason and the worst node with its values.
/// @param from, to  load factors of the smallest sub-step tried.
std::string failure_text(const ContactProblem& problem, const SubStep& sub_step,
                         const SolveCounts& counts, double from, double to);

/// Where and between which load factors weakening outran the stiffness.
std::string instability_text(const ContactProblem& problem, const SubStep& sub_step,
                             const StabilityReport& stability, double from, double to);

/// Where and between which load factors slip ends cohesion: strength drops, and equilibrium jumps.
std::string lost_cohesion_text(const ContactProblem& problem, const SubStep& sub_step, double from,
                               double to);

/// More instabilities in one load step than are followed.
std::string too_many_jumps_text(std::size_t n_jumps, double from);

}  // namespace faultsim
