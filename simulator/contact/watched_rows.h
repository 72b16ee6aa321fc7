#pragma once

#include <vector>

#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// The nodes to look at while an active set is sought: all, or those that move and those whose
/// traction is so near its limit that they may begin to. The others' tractions then wait until a
/// set has been found, and what they say is heard before anything is accepted. Only speed depends
/// on the choice: what is computed at a watched node is what is computed when all are.
class WatchedRows {
 public:
  explicit WatchedRows(const ContactProblem& problem);

  void watch_all();
  /// @pre the tractions of all nodes are those of the increment.
  void watch_near_limit(const SubStep& sub_step);
  bool all() const { return all_; }
  const std::vector<int>& nodes() const { return all_ ? every_node_ : near_; }  ///< ascending.
  const std::vector<RowRange>& rows() const { return rows_; }                   ///< of these nodes.

 private:
  bool is_near(const SubStep& sub_step, int k) const;

  const ContactProblem& problem_;
  bool all_ = true;
  std::vector<int> every_node_, near_;
  std::vector<RowRange> rows_;
};

}  // namespace faultsim
