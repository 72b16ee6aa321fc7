#pragma once

#include <string>
#include <vector>

#include "campaign/spec/spec.h"

namespace faultsweep {

/// By the spec's `operators`: asks in the group's scene for surfaces of operators over the
/// parameters that change the operator and are drawn from ranges with ends, with probing cases that
/// are drawn from the group's designs by another seed (or, of a file, are rows of it). What is kept
/// exact under `automatic`: all where rows are fewer than operators of a surface, and intervals of
/// an offset with fewer rows than that. Does nothing under `exact`. For comparison (`rank
/// --certify`) the same scenes take exact operators on the same cells.
/// @param group  drawn (draw_sampled_rows).
/// @param notes  what was chosen, a sentence for each group.
/// @param problems  under `surface`: nothing to be over.
void choose_operators(const CampaignSpec& spec, Group& group, std::vector<std::string>& notes,
                      std::vector<Problem>& problems);

}  // namespace faultsweep
