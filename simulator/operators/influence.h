#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulator/model/influence.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/plan/cost.h"

namespace faultsim {

/// The cells of a mesh that lie in one of the pressure regions, in the mesh's order: a cell of
/// which only a part does is one.
/// @param regions  of the scene; empty = all.
std::vector<int> reservoir_cells(const BulkProblem& problem, const std::vector<int>& regions);

/// An influence block and the operator that it belongs to.
struct PreparedInfluence {
  std::shared_ptr<const FaultOperator> op;
  std::shared_ptr<const InfluenceBlock> block;
  std::shared_ptr<CreepLadder> bulk;  ///< its factor, where that was to be kept.
  bool from_cache = false;            ///< the block.
  InfluenceCost predicted;            ///< of the block alone, by the plan.
  std::string remark;                 ///< "damaged file moved aside", "not kept", ...
};

/// The influence of the regions' cells: from the cache, beside the operator, if it is there and
/// sound; else the bulk is factorised, and operator and block are cached. Throws ResourceError as
/// prepare_operator() does. @pre no creep in the plan.
PreparedInfluence prepare_influence(const SceneBulk& of, const std::vector<int>& regions,
                                    const CachePolicy& cache, const RunContext& context = {},
                                    bool keep_bulk = false);

/// The cells of all compartments, as a block that has no influences yet.
InfluenceBlock cells_of_compartments(const Scene& scene, const BulkProblem& problem);

}  // namespace faultsim
