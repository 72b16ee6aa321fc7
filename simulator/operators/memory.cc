#include "simulator/operators/memory.h"

#include <string>

#include "simulator/common/errors.h"

namespace faultsim {
void require_memory(const Plan& plan, std::optional<double> available, bool may_go_without) {
  if (!available || plan.memory_bytes <= *available) return;
  const bool creeps = plan.creep.active;
  const std::string what =
      creeps ? concat("the ", 1 + plan.creep.rungs.size(),
                      " operators of this scene, one per step length of creep and the elastic one, "
                      "need about ",
                      size_to_text(plan.memory_bytes), " together (")
             : concat("the operator of this scene needs about ", size_to_text(plan.memory_bytes),
                      " while it is built (");
  throw ResourceError(
      concat("not enough memory: ", what, plan.n_unknowns, " unknowns, ", plan.n_jump,
             " of them jumps), ", size_to_text(*available), " are available; ",
             plan.plane_strain ? "choose larger cells (/mesh)"
                               : "choose a coarser tier or larger cells (/mesh), or plane strain "
                                 "(for a field the tier \"screening\")",
             creeps ? ", or fewer step lengths (/numerics/creep_refinements, or fixed steps by "
                      "/numerics/creep_time_step)"
             : may_go_without ? ", or go without an operator (faultsim run --path automatic)"
                              : ""));
}

}  // namespace faultsim
