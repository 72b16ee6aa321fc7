#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace faultsim {

/// Finds nodes by their tags. Takes memory in proportion to the number of nodes, whatever tags are:
/// a table where they are dense, else a sorted list.
class NodeIndex {
 public:
  /// @param tags  0 = none. Of equal ones the first is found.
  explicit NodeIndex(const std::vector<std::int64_t>& tags);

  /// Index of the node with a tag; -1 if there is none.
  int find(std::int64_t tag) const;
  /// Indices of nodes whose tag a node before them has, and of that node; ascending.
  const std::vector<std::pair<int, int>>& repeated() const { return repeated_; }

 private:
  void fill_table(const std::vector<std::int64_t>& tags, std::int64_t largest);
  void sort(const std::vector<std::int64_t>& tags);

  std::vector<int> table_;                            // by tag; -1 = none
  std::vector<std::pair<std::int64_t, int>> sorted_;  // tag, index
  std::vector<std::pair<int, int>> repeated_;
};

}  // namespace faultsim
