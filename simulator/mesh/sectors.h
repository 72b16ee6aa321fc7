#pragma once

#include <array>
#include <span>
#include <vector>

namespace faultsim {

/// A face between two cells, of any kind of cell.
struct SharedFace {
  std::array<int, 4> nodes;  ///< of its corners; -1 behind the last.
  std::array<int, 2> cells;  ///< of a fault: on its minus side, on its plus side.
  int fault = -1;            ///< -1 = rock.
};

/// What displacements on both sides of a fault at a node differ by: the mean of the plus side less
/// that of the minus side. Where later jumps cut a side, its mean is that of their two sides.
struct NodeJump {
  int fault;
  std::vector<int> minus, plus;  ///< copies of the node, numbers into SplitNode::sectors.
};

/// A node that faults cut into copies: one for each part of the rock around it that they leave
/// connected (a sector). Copy s moves with u_s = ū + Σ w_sj g_j: w_sj > 0 where jump j has s on its
/// plus side, < 0 where on its minus side; both sides together move of it by 1 (NodeCopy). Jumps
/// are one fewer than copies, so that (ū, g) ↔ (u_s) is a bijection: where faults meet, the jump of
/// one that goes on is between whole sides of it, that of one that ends there or crosses is within
/// a side.
struct SplitNode {
  int node;
  std::vector<std::vector<int>> sectors;  ///< cells, ascending; the first has the lowest of all.
  std::vector<NodeJump> jumps;            ///< outer ones first.
};

/// A node where the jump between sectors belongs to no single fault: faults that both end there cut
/// the rock only together (a V), or one touches itself.
struct UndecidedNode {
  int node;
  std::vector<int> faults;  ///< ascending.
};

struct SplitNodes {
  std::vector<SplitNode> split;  ///< by node, ascending; tips and rock are not among them.
  std::vector<UndecidedNode> undecided;
};

/// Splits the nodes of faces that belong to a fault. Tips, ends at another fault (T) and crossings
/// (X) are found from which cells share a face; of faults that cut alike the lowest number goes on.
///
/// faces: all that two cells share, at least around these nodes; each once.
/// Time O(faces of these nodes), beside one pass over all of them.
SplitNodes split_nodes(int n_nodes, std::span<const SharedFace> faces);

}  // namespace faultsim
