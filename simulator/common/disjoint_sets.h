#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace faultsim {

/// Numbers 0 … n−1 in sets that can be joined; the smallest of a set stands for it.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[i] != i) {
      int& up = parent_[i];
      up = parent_[up];
      i = up;
    }
    return i;
  }
  void join(int i, int j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// The set of each number, from 0 on, in the order of their smallest.
  std::vector<int> numbered() {
    std::vector<int> set_of(parent_.size());
    int n_sets = 0;
    for (int i = 0; i < static_cast<int>(parent_.size()); ++i) {
      const int smallest = find(i);
      set_of[i] = smallest == i ? n_sets++ : set_of[smallest];
    }
    return set_of;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace faultsim
