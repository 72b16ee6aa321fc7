#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/elasticity/elasticity.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {

/// Builds a DofMap in the order of the rules in its header. "Root" is the node whose displacement a
/// tied node shares, itself for others.
class DofMapBuilder {
 public:
  DofMapBuilder(const Mesh& mesh, DofMap& map)
      : mesh_(mesh),
        map_(map),
        n_nodes_(static_cast<int>(mesh.nodes.size())),
        fixed_(mesh.nodes.size(), {false, false, false}),
        copy_(mesh.nodes.size(), -1) {}

  void prescribe(const std::vector<DisplacementCondition>& conditions, int n_loads);
  void collect_jumps();
  void pin();
  void fix_y();
  void place_jumps();
  void number_jumps();
  void number_bulk();
  void find_group_ends();
  void write_terms();
  void share_prescribed();

 private:
  struct Jump {
    const FaultNode* node;
    std::array<int, 3> unknown = {-1, -1, -1};
  };
  /// Whether a component is fixed on the copies that a jump moves.
  struct Held {
    std::array<bool, 3> on_some = {false, false, false}, on_all = {true, true, true};
  };

  int root(int node) const { return mesh_.tied_to.empty() ? node : mesh_.tied_to[node]; }
  std::array<bool, 3>& fixed(int node) { return fixed_[node]; }
  bool fix(int node, std::size_t c);
  void write_share(const JumpShare& share, int c);
  Jump& jump(const JumpShare& share) { return jumps_[map_.jump_begin_[share.fault] + share.node]; }
  std::vector<Held> held() const;
  void share_fixed();
  bool may_pin(const Pieces& pieces, int piece, int node) const;
  std::vector<int> three_far_nodes(const Pieces& pieces, int piece) const;

  const Mesh& mesh_;
  DofMap& map_;
  int n_nodes_;
  std::vector<std::array<bool, 3>> fixed_;  // by root
  std::vector<int> copy_;                   // by root: index into Mesh::copies, -1 = not cut
  std::vector<Jump> jumps_;                 // fault by fault
  std::vector<std::array<int, 3>> bulk_;    // by root: unknowns of ū, -1 = prescribed
};

/// Fixes a component; false when it was fixed before.
bool DofMapBuilder::fix(int node, std::size_t c) {
  bool& flag = fixed(root(node))[c];
  const bool is_new = !flag;
  flag = true;
  return is_new;
}

void DofMapBuilder::prescribe(const std::vector<DisplacementCondition>& conditions, int n_loads) {
  map_.prescribed_.resize(n_loads);
  for (const DisplacementCondition& condition : conditions) {
    FAULTSIM_DEMAND(condition.load >= -1 && condition.load < n_loads, "load ", condition.load);
    std::vector<int> nodes;
    for (const BoundaryFace& face : mesh_.boundary) {
      if (face.group != condition.group) continue;
      for (const int node : face.nodes()) nodes.push_back(root(node));
    }
    std::ranges::sort(nodes);
    drop_repeated(nodes);
    for (int node : nodes) {
      const Eigen::Vector3d value = condition.translation + condition.gradient * mesh_.nodes[node];
      for (std::size_t c = 0; c < 3; ++c) {
        if (!condition.components[c] || !fix(node, c) || condition.load < 0) continue;
        map_.prescribed_[condition.load].emplace_back(3 * node + static_cast<int>(c),
                                                      value[static_cast<int>(c)]);
      }
    }
  }
  for (auto& list : map_.prescribed_) std::ranges::sort(list);
}

void DofMapBuilder::collect_jumps() {
  for (const FaultSurface& fault : mesh_.faults) {
    map_.jump_begin_.push_back(static_cast<int>(jumps_.size()));
    for (const FaultNode& node : fault.nodes) {
      FAULTSIM_DEMAND(root(node.minus_node) != root(node.plus_node), "node ", node.minus_node,
                      " is tied across a fault");
      jumps_.push_back({&node});
    }
  }
  for (std::size_t k = 0; k < mesh_.copies.size(); ++k) {
    const int node = mesh_.copies[k].node;
    FAULTSIM_DEMAND(root(node) == node && copy_[node] < 0, "node ", node,
                    " is tied or twice among the copies");
    copy_[node] = static_cast<int>(k);
  }
}

bool DofMapBuilder::may_pin(const Pieces& pieces, int piece, int node) const {
  return pieces.of_node[node] == piece && root(node) == node && copy_[node] < 0;
}

/// Three nodes of the piece, off the faults and far apart: from the centre, from the first, and
/// from the line through both.
std::vector<int> DofMapBuilder::three_far_nodes(const Pieces& pieces, int piece) const {
  const auto farthest = [&](const auto& distance) {
    int best = -1;
    double best_distance = -1;
    for (int i = 0; i < n_nodes_; ++i) {
      if (!may_pin(pieces, piece, i)) continue;
      const double d = distance(mesh_.nodes[i]);
      // The margin keeps rounding from choosing among the corners of a box.
      if (d > best_distance * (1 + 1e-9)) {
        best = i;
        best_distance = d;
      }
    }
    FAULTSIM_DEMAND(best >= 0, "no node of piece ", piece, " lies off the faults");
    return best;
  };
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int n = 0;
  for (int i = 0; i < n_nodes_; ++i) {
    if (!may_pin(pieces, piece, i)) continue;
    centre += mesh_.nodes[i];
    ++n;
  }
  centre /= std::max(n, 1);
  const int a = farthest([&](const Eigen::Vector3d& x) { return (x - centre).norm(); });
  const Eigen::Vector3d& at_a = mesh_.nodes[a];
  const int b = farthest([&](const Eigen::Vector3d& x) { return (x - at_a).norm(); });
  const Eigen::Vector3d line = (mesh_.nodes[b] - at_a).normalized();
  const int c = farthest([&](const Eigen::Vector3d& x) { return (x - at_a).cross(line).norm(); });
  return {a, b, c};
}

/// Pins the rigid motions of the body with the most cells when nothing at all is prescribed.
void DofMapBuilder::pin() {
  for (const auto& flags : fixed_) {
    if (flags[0] || flags[1] || flags[2]) return;
  }
  const Pieces pieces = find_pieces(mesh_);
  const auto largest = std::ranges::max_element(pieces.n_cells);
  const int piece = static_cast<int>(largest - pieces.n_cells.begin());
  const int body = pieces.body[piece];
  const auto in_body = [&](int node) {
    const int its_piece = pieces.of_node[node];
    return pieces.body[its_piece] == body;
  };
  const RigidModes modes = rigid_modes(mesh_, in_body, [](int, int) { return false; });
  const Eigen::Index n_free = modes.free.cols();
  const std::vector<int> nodes = three_far_nodes(pieces, piece);
  Eigen::MatrixXd motions(9, n_free);  // of the candidates' components
  for (Eigen::Index i = 0; i < 3; ++i) {
    const int node = nodes[i];
    motions.middleRows(3 * i, 3) = modes.at(mesh_.nodes[node]) * modes.free;
  }
  // The pivots of a QR factorisation are components that hold the motions, and well.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motions.transpose());
  FAULTSIM_DEMAND(qr.rank() == n_free, "rank ", qr.rank(), " of ", n_free);
  for (Eigen::Index m = 0; m < n_free; ++m) {
    const int row = qr.colsPermutation().indices()[m];
    fix(nodes[row / 3], static_cast<std::size_t>(row % 3));
  }
  map_.pinned_ = n_free > 0;
}

void DofMapBuilder::fix_y() {
  for (auto& flags : fixed_) flags[1] = true;
}

/// Per jump; copies in the middle of a side move with jumps of other places, which are not asked.
std::vector<DofMapBuilder::Held> DofMapBuilder::held() const {
  std::vector<Held> all(jumps_.size());
  for (const NodeCopy& copy : mesh_.copies) {
    for (const JumpShare& share : copy.shares) {
      const int k = map_.jump_begin_[share.fault] + share.node;
      const NodeCopy& own = mesh_.copies[copy_[root(jumps_[k].node->minus_node)]];
      if (own.first != copy.first) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        all[k].on_some[c] = all[k].on_some[c] || fixed_[copy.node][c];
        all[k].on_all[c] = all[k].on_all[c] && fixed_[copy.node][c];
      }
    }
  }
  return all;
}

/// One value serves all copies at a place; some of them may have been fixed alone.
void DofMapBuilder::share_fixed() {
  for (const NodeCopy& copy : mesh_.copies) {
    for (std::size_t c = 0; c < 3; ++c)
      fixed(copy.first)[c] = fixed(copy.first)[c] || fixed(copy.node)[c];
  }
  for (const NodeCopy& copy : mesh_.copies) fixed(copy.node) = fixed(copy.first);
}

void DofMapBuilder::place_jumps() {
  constexpr double kParallel = 1 - 1e-9;
  constexpr int kJumps = 0;  // until they are numbered
  const std::vector<Held> all_held = held();
  share_fixed();
  for (std::size_t k = 0; k < jumps_.size(); ++k) {
    const FaultNode& node = *jumps_[k].node;
    bool locked = false;
    std::array<bool, 3> removed = {false, false, false};
    for (std::size_t c = 0; c < 3; ++c) {
      if (!all_held[k].on_some[c]) continue;
      const auto along = [&](const Eigen::Vector3d& direction) {
        return std::abs(direction[static_cast<int>(c)]) > kParallel;
      };
      removed[1] = removed[1] || along(node.strike);
      removed[2] = removed[2] || along(node.dip);
      locked = locked || !all_held[k].on_all[c] || !(along(node.strike) || along(node.dip));
    }
    if (locked) map_.locked_.push_back(mesh_.nodes[node.minus_node]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (!locked && !removed[c]) jumps_[k].unknown[c] = kJumps;
    }
  }
  number_jumps();
}

/// Fault by fault from the top down, so that at one depth those along strike follow each other:
/// faults slip in bands along strike, and what is asked of their H is long parts of few columns.
void DofMapBuilder::number_jumps() {
  std::vector<Jump*> order;
  for (std::size_t f = 0; f < mesh_.faults.size(); ++f) {
    const auto first = std::ssize(order);
    for (std::size_t k = 0; k < mesh_.faults[f].nodes.size(); ++k)
      order.push_back(&jumps_[static_cast<std::size_t>(map_.jump_begin_[f]) + k]);
    std::stable_sort(order.begin() + first, order.end(), [&](const Jump* a, const Jump* b) {
      return mesh_.nodes[a->node->minus_node].z() > mesh_.nodes[b->node->minus_node].z();
    });
  }
  for (Jump* one : order)
    for (int& unknown : one->unknown)
      if (unknown >= 0) unknown = map_.n_jump_++;
  for (const Jump& one : jumps_) map_.jump_.push_back(one.unknown);
}

void DofMapBuilder::number_bulk() {
  bulk_.assign(mesh_.nodes.size(), {-1, -1, -1});
  for (int node = 0; node < n_nodes_; ++node) {
    if (root(node) != node) continue;
    if (copy_[node] >= 0 && mesh_.copies[copy_[node]].first < node) {
      bulk_[node] = bulk_[mesh_.copies[copy_[node]].first];
      continue;
    }
    auto& unknowns = bulk_[node];
    bool has_any = false;
    for (std::size_t c = 0; c < 3; ++c) {
      if (fixed(node)[c]) continue;
      unknowns[c] = map_.n_bulk_++;
      map_.groups_.of.push_back(map_.groups_.n);
      has_any = true;
    }
    if (has_any) ++map_.groups_.n;
  }
}

/// Of quadratic cells.
void DofMapBuilder::find_group_ends() {
  if (mesh_.cells.shape() != CellShape::tetrahedron) return;
  const auto group_of = [&](int node) {
    const auto& unknowns = bulk_[root(node)];
    const auto first = std::ranges::find_if(unknowns, [](int unknown) { return unknown >= 0; });
    return first == unknowns.end() ? -1 : map_.groups_.of[*first];
  };
  auto& ends = map_.groups_.ends;
  ends.assign(map_.groups_.n, {-1, -1});
  for (std::size_t cell = 0; cell < mesh_.cells.size(); ++cell) {
    const std::span<const int> nodes = mesh_.cells[cell];
    for (std::size_t side = 0; side < kTetrahedronSides.size(); ++side) {
      const int middle = group_of(nodes[mesh_.cells.n_corners() + side]);
      if (middle < 0) continue;
      const auto& [a, b] = kTetrahedronSides[side];
      ends[middle] = {group_of(nodes[a]), group_of(nodes[b])};
    }
  }
}

void DofMapBuilder::write_terms() {
  map_.begin_.push_back(0);
  const std::vector<JumpShare> none;
  for (int node = 0; node < n_nodes_; ++node) {
    const int own = root(node);
    const std::vector<JumpShare>& shares = copy_[own] < 0 ? none : mesh_.copies[copy_[own]].shares;
    for (std::size_t c = 0; c < 3; ++c) {
      const int unknown = bulk_[own][c];
      if (unknown >= 0) map_.terms_.push_back({unknown, 1});
      // A fixed component has no part in the jumps that are left; what rounding leaves goes.
      for (const JumpShare& share : shares) {
        if (!fixed(own)[c]) write_share(share, static_cast<int>(c));
      }
      map_.begin_.push_back(static_cast<int>(map_.terms_.size()));
    }
  }
}

/// Of component c of the displacement.
void DofMapBuilder::write_share(const JumpShare& share, int c) {
  const Jump& moved = jump(share);
  const FaultNode& node = *moved.node;
  const std::array<const Eigen::Vector3d*, 3> axes = {&node.normal, &node.strike, &node.dip};
  for (std::size_t j = 0; j < 3; ++j) {
    const double coefficient = share.weight * (*axes[j])[c];
    if (moved.unknown[j] < 0 || coefficient == 0) continue;
    map_.terms_.push_back({map_.n_bulk_ + moved.unknown[j], coefficient});
  }
}

/// Tied nodes and the other copies at a place have the same prescribed value.
void DofMapBuilder::share_prescribed() {
  for (auto& list : map_.prescribed_) {
    if (list.empty()) continue;
    std::map<int, double> given(list.begin(), list.end());
    for (const auto& [key, value] : list) {
      const int copy = copy_[key / 3];
      if (copy >= 0) given.emplace(3 * mesh_.copies[copy].first + key % 3, value);
    }
    std::vector<std::pair<int, double>> all;
    for (int node = 0; node < n_nodes_; ++node) {
      const int own = root(node);
      const int first = copy_[own] < 0 ? own : mesh_.copies[copy_[own]].first;
      for (int c = 0; c < 3; ++c) {
        auto value = given.find(3 * own + c);
        if (value == given.end()) value = given.find(3 * first + c);
        if (value != given.end()) all.emplace_back(3 * node + c, value->second);
      }
    }
    list = std::move(all);
  }
}

DofMap::DofMap(const Mesh& mesh, const std::vector<DisplacementCondition>& conditions,
               int n_loads) {
  DofMapBuilder builder(mesh, *this);
  builder.prescribe(conditions, n_loads);
  builder.collect_jumps();
  builder.pin();
  if (mesh.plane_strain) builder.fix_y();
  builder.place_jumps();
  builder.number_bulk();
  builder.find_group_ends();
  builder.write_terms();
  builder.share_prescribed();
}

std::span<const DofMap::Term> DofMap::terms(int node, int component) const {
  const std::size_t row = 3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(component);
  return {terms_.data() + begin_[row], terms_.data() + begin_[row + 1]};
}

double DofMap::prescribed(int load, int node, int component) const {
  const auto& list = prescribed_[load];
  const int key = 3 * node + component;
  const auto at = std::ranges::lower_bound(list, std::pair(key, -HUGE_VAL));
  return at != list.end() && at->first == key ? at->second : 0;
}

}  // namespace faultsim
