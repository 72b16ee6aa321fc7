#include "simulator/mesh/sectors.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

/// A face of a fault between two sectors of a node.
struct Border {
  std::array<int, 2> sectors;  ///< minus, plus.
  int fault;
};

using Group = std::vector<int>;  ///< of sectors, ascending.

/// Items by set, in the order in which they lie.
std::vector<Group> by_set(const std::vector<int>& items, const std::vector<int>& set_of) {
  std::vector<Group> sets;
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (set_of[k] == std::ssize(sets)) sets.emplace_back();
    sets[set_of[k]].push_back(items[k]);
  }
  return sets;
}

/// The parts of a group that borders hold together, but for those of one fault.
std::vector<Group> parts_without(int fault, const Group& group, std::span<const Border> borders) {
  const auto place = [&](int sector) {
    const auto at = std::ranges::lower_bound(group, sector);
    return at != group.end() && *at == sector ? static_cast<int>(at - group.begin()) : -1;
  };
  DisjointSets sets(group.size());
  for (const Border& border : borders) {
    const int a = place(border.sectors[0]), b = place(border.sectors[1]);
    if (border.fault != fault && a >= 0 && b >= 0) sets.join(a, b);
  }
  return by_set(group, sets.numbered());
}

bool holds(const Group& group, int sector) { return std::ranges::binary_search(group, sector); }

/// The sectors around one node, and the jumps between them.
class NodeSplitter {
 public:
  NodeSplitter(int node, std::span<const SharedFace> faces, std::span<const int> own)
      : node_{node, {}, {}} {
    find_sectors(faces, own);
    find_borders(faces, own);
  }
  bool is_split() const { return node_.sectors.size() > 1; }
  /// False where no single fault separates some sectors.
  bool find_jumps() {
    Group all(node_.sectors.size());
    std::iota(all.begin(), all.end(), 0);
    return cut(all);
  }
  std::vector<int> faults() const {
    std::vector<int> found;
    for (const Border& border : borders_) found.push_back(border.fault);
    std::ranges::sort(found);
    drop_repeated(found);
    return found;
  }
  SplitNode result() { return std::move(node_); }

 private:
  int place(int cell) const {
    return static_cast<int>(std::ranges::lower_bound(cells_, cell) - cells_.begin());
  }

  void find_sectors(std::span<const SharedFace> faces, std::span<const int> own) {
    for (const int face : own)
      cells_.insert(cells_.end(), faces[face].cells.begin(), faces[face].cells.end());
    std::ranges::sort(cells_);
    drop_repeated(cells_);
    DisjointSets sets(cells_.size());
    for (const int face : own)
      if (faces[face].fault < 0)
        sets.join(place(faces[face].cells[0]), place(faces[face].cells[1]));
    sector_of_ = sets.numbered();
    node_.sectors = by_set(cells_, sector_of_);
  }

  /// Faces with the same sector on both sides are those of a fault that ends near the node.
  void find_borders(std::span<const SharedFace> faces, std::span<const int> own) {
    for (const int face : own) {
      const auto& [minus, plus] = faces[face].cells;
      const std::array<int, 2> sectors = {sector_of_[place(minus)], sector_of_[place(plus)]};
      if (faces[face].fault >= 0 && sectors[0] != sectors[1])
        borders_.push_back({sectors, faces[face].fault});
    }
  }

  /// Cuts a group by the first fault that separates it alone, then its two sides.
  bool cut(const Group& group) {
    if (group.size() == 1) return true;
    for (const int fault : faults()) {
      const std::vector<Group> parts = parts_without(fault, group, borders_);
      if (parts.size() == 1) continue;
      if (parts.size() > 2) return false;
      const auto minus = minus_part(fault, parts);
      if (minus < 0) return false;
      const Group &below = parts[minus], &above = parts[1 - minus];
      node_.jumps.push_back({fault, below, above});
      return cut(below) && cut(above);
    }
    return false;
  }

  /// Which of both parts is on the minus side of all faces between them; -1 = neither.
  int minus_part(int fault, const std::vector<Group>& parts) const {
    int minus = -1;
    for (const Border& border : borders_) {
      if (border.fault != fault) continue;
      for (const int k : {0, 1}) {
        if (!holds(parts[k], border.sectors[0]) || !holds(parts[1 - k], border.sectors[1]))
          continue;
        if (minus == 1 - k) return -1;
        minus = k;
      }
    }
    return minus;
  }

  SplitNode node_;
  std::vector<int> cells_;      ///< around the node, ascending.
  std::vector<int> sector_of_;  ///< these.
  std::vector<Border> borders_;
};

/// Faces by node, of nodes that lie on a fault.
struct FacesOfNodes {
  std::vector<int> nodes;
  std::vector<std::vector<int>> faces;
};

FacesOfNodes faces_of_fault_nodes(int n_nodes, std::span<const SharedFace> faces) {
  std::vector<int> place(static_cast<std::size_t>(n_nodes), -1);
  constexpr int kOnFault = 0;
  for (const SharedFace& face : faces) {
    for (const int node : face.nodes) {
      FAULTSIM_DEMAND(node < n_nodes, node);
      if (face.fault >= 0 && node >= 0) place[node] = kOnFault;
    }
  }
  FacesOfNodes found;
  for (int node = 0; node < n_nodes; ++node) {
    if (place[node] < 0) continue;
    place[node] = static_cast<int>(found.nodes.size());
    found.nodes.push_back(node);
  }
  found.faces.resize(found.nodes.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const int node : faces[f].nodes)
      if (node >= 0 && place[node] >= 0) found.faces[place[node]].push_back(static_cast<int>(f));
  }
  return found;
}

}  // namespace

SplitNodes split_nodes(int n_nodes, std::span<const SharedFace> faces) {
  const FacesOfNodes of = faces_of_fault_nodes(n_nodes, faces);
  SplitNodes all;
  for (std::size_t k = 0; k < of.nodes.size(); ++k) {
    NodeSplitter splitter(of.nodes[k], faces, of.faces[k]);
    if (!splitter.is_split()) continue;
    if (splitter.find_jumps()) {
      all.split.push_back(splitter.result());
    } else {
      all.undecided.push_back({of.nodes[k], splitter.faults()});
    }
  }
  return all;
}

}  // namespace faultsim
