#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/common/words.h"

namespace faultsim {

/// Why a search for equilibrium on one sub-step stopped.
enum class SearchEnd {
  balanced,             ///< the residual is within the tolerance.
  singular_tangent,     ///< no direction to go.
  no_progress,          ///< the residual no longer falls, and a smaller sub-step may follow.
  too_many_sets,        ///< ContactOptions::max_active_set_passes.
  set_does_not_settle,  ///< ContactOptions::max_newton_iterations with one active set.
  too_many_iterations,  ///< both together.
  set_comes_back,       ///< plane strain's quick way: an active set seen before.
  opens,                ///< plane strain's quick way: a node would open.
};
constexpr auto words(SearchEnd) {
  return std::array{"balanced",
                    "singular tangent",
                    "no progress",
                    "too many active sets",
                    "too many iterations on one active set",
                    "too many iterations",
                    "active set comes back",
                    "a node opens"};
}

/// Where a search stands after an iteration.
struct SearchIteration {
  double residual = 0;  ///< largest over the nodes, in units of their tolerance; NaN: not formed.
  double length = 1;    ///< share of the step along its direction that was gone.
  int n_slip = 0, n_open = 0;  ///< nodes; the others stick.
  int n_changed = 0;           ///< nodes that changed state.
  int krylov = -1;             ///< iterations of GMRES; −1: a direct solve.
};

/// A search, iteration by iteration. Of a long one the last are kept, so that its size is bounded.
struct SearchHistory {
  static constexpr std::size_t kMost = 64;  ///< shows any cycle of active sets that was ever met.
  SearchEnd end = SearchEnd::too_many_iterations;
  int iterations = 0;                 ///< linear solves.
  int passes = 0;                     ///< active sets tried.
  std::vector<SearchIteration> last;  ///< of the iterations; at most 2 kMost.
  double best = 0;                    ///< lowest residual that was formed; 0: none was.
  int best_at = 0;                    ///< and the iteration it belongs to, from 1.

  bool converged() const { return end == SearchEnd::balanced; }
  void add(const SearchIteration& iteration);
};

/// Active sets of a search, told apart by a number each: one that comes back is a cycle.
class SeenSets {
 public:
  void clear() { seen_.clear(); }
  /// Whether this set, an entry per node, was there before; it is from now on.
  template <typename States>
  bool has_seen(const States& states) {
    std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
    for (const auto state : states)
      hash = (hash ^ static_cast<std::uint64_t>(state)) * 1099511628211ULL;
    if (std::ranges::find(seen_, hash) != seen_.end()) return true;
    seen_.push_back(hash);
    return false;
  }

 private:
  std::vector<std::uint64_t> seen_;
};

/// All searches on one sub-step and what became of them.
struct SubStepTrace {
  double from = 0, to = 1;  ///< load factors.
  double duration = 0;      ///< s, Δt of a damped sub-step; 0 = static.
  int n_nodes = 0;
  struct Search {
    const char* way;  ///< "plane strain", "newton", "relaxed": of SubStepSolver::solve_motion.
    SearchHistory history;
  };
  std::vector<Search> searches;  ///< empty: nothing moved.
  const char* verdict = "";      ///< how the sub-step ended: "accepted", "not shown stable", ...
};

/// Who looks on while a contact problem is solved, and who helps. The answer does not depend on it.
struct ContactWatch {
  StopToken stop;  ///< asked per linear solve: Interrupted.
  std::function<void(const SubStepTrace&)> tried = nullptr;  ///< after each try at a sub-step.
  ThreadTeam* team = nullptr;  ///< that shares the work; null: one thread.
};

/// "38 iterations over 12 active sets, residual 7.1 tolerances at the end and 1.4 at best
/// (iteration 9), no progress" of the last search; empty if there was none.
std::string trace_summary(const SubStepTrace& trace);

}  // namespace faultsim
