#pragma once

#include <cholmod.h>

#include <functional>
#include <vector>

#include "simulator/common/unknown_groups.h"

namespace faultsim {

/// CHOLMOD's settings and workspace (64-bit indices), silent.
class CholmodCommon {
 public:
  CholmodCommon() {
    cholmod_l_start(&common_);
    common_.print = 0;
  }
  ~CholmodCommon() { cholmod_l_finish(&common_); }
  CholmodCommon(const CholmodCommon&) = delete;
  CholmodCommon& operator=(const CholmodCommon&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_{};
};

struct GroupGraph;
/// As CHOLMOD sees it, while the graph is there: a lower triangle without values.
cholmod_sparse pattern_of(GroupGraph& graph);

/// A fill-reducing order of the unknowns of `a` (lower triangle) that leaves the unknowns from
/// n_bulk on at the end, in their order: order[i] = unknown at place i.
///
/// The groups (nodes) of the bulk unknowns are ordered by METIS (small graphs: AMD; those with
/// nodes in the middle of sides: corner_dissection); the unknowns are then postordered by the
/// elimination tree of the bulk alone. CHOLMOD's own postordering would move trailing unknowns when
/// the matrix falls into several parts, and its supernodes need one.
std::vector<SuiteSparse_long> trailing_order(cholmod_sparse& a, SuiteSparse_long n_bulk,
                                             const UnknownGroups& groups, CholmodCommon& common,
                                             const std::function<bool()>& stop);

}  // namespace faultsim
