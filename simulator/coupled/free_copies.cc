#include "simulator/coupled/free_copies.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Place = FreeCopies::Place;

/// In the order of their first copies. Corners of cells have jumps, middles of sides none.
std::vector<Place> places_of(const Mesh& mesh, DisjointSets& ties) {
  std::map<int, Place> by_first;
  std::map<int, int> first_at;  // of a node with copies
  for (const NodeCopy& copy : mesh.copies) {
    by_first[copy.first].copies.push_back(&copy);
    first_at[copy.node] = copy.first;
  }
  for (int f = 0; f < static_cast<int>(mesh.faults.size()); ++f) {
    const std::vector<FaultNode>& nodes = mesh.faults[f].nodes;
    for (int k = 0; k < static_cast<int>(nodes.size()); ++k)
      by_first.at(first_at.at(ties.find(nodes[k].minus_node))).jumps.emplace_back(f, k);
  }
  std::vector<Place> places;
  for (auto& [first, place] : by_first) places.push_back(std::move(place));
  return places;
}

/// Of the jumps at each copy.
Eigen::MatrixXd weights_of(const Place& place) {
  Eigen::MatrixXd weights =
      Eigen::MatrixXd::Zero(std::ssize(place.copies), std::ssize(place.jumps));
  for (Eigen::Index s = 0; s < weights.rows(); ++s) {
    for (const JumpShare& share : place.copies[s]->shares) {
      const auto jump = std::ranges::find(place.jumps, std::pair(share.fault, share.node));
      if (jump != place.jumps.end()) weights(s, jump - place.jumps.begin()) += share.weight;
    }
  }
  return weights;
}

/// Ties copies that move alike. @returns of each kind the lowest.
std::vector<int> tie_alike(const Place& place, const Eigen::MatrixXd& weights, DisjointSets& ties) {
  std::vector<int> lowest;
  for (int s = 0; s < static_cast<int>(weights.rows()); ++s) {
    const auto same = std::ranges::find_if(
        lowest, [&](int other) { return weights.row(other) == weights.row(s); });
    if (same == lowest.end()) {
      lowest.push_back(s);
    } else {
      ties.join(place.copies[s]->node, place.copies[*same]->node);
    }
  }
  return lowest;
}

[[noreturn]] void refuse(const Eigen::Vector3d& x) {
  throw InputError(
      "coupled path",
      {{"/geometry/boundary", 0,
        concat("a condition at (", x.x(), ", ", x.y(), ", ", x.z(),
               ") m closes one of the faults that meet there but not the other"),
        "let it hold the rock on all sides of both faults, or use the condensed path"}});
}

/// Terms of several sums by node.
class Sum {
 public:
  void add(double factor, const NodeTerms& terms) {
    for (const NodeTerm& term : terms) by_node_[term.node] += factor * term.factor;
  }
  NodeTerms terms() const {
    constexpr double kRounding = 1e-12;  // factors are of the order of 1
    NodeTerms all;
    for (const auto& [node, factor] : by_node_)
      if (std::abs(factor) > kRounding) all.push_back({node, factor});
    return all;
  }

 private:
  std::map<int, double> by_node_;
};

}  // namespace

FreeCopies::FreeCopies(Mesh& mesh, const MayJump& may_jump) : moved_(mesh.nodes.size()) {
  DisjointSets ties(mesh.nodes.size());
  for (int i = 0; i < static_cast<int>(mesh.tied_to.size()); ++i) ties.join(i, mesh.tied_to[i]);
  for (const FaultSurface& fault : mesh.faults) jumps_.emplace_back(fault.nodes.size());
  const std::vector<Place> places = places_of(mesh, ties);
  for (const Place& place : places)
    if (!place.jumps.empty()) free_corners(place, mesh, may_jump, ties);
  for (const Place& place : places)
    if (place.jumps.empty()) move_amid(place, ties);
  mesh.tied_to.resize(mesh.nodes.size());
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) mesh.tied_to[i] = ties.find(i);
  mesh.copies.clear();
  faults_.swap(mesh.faults);
}

void FreeCopies::free_corners(Place place, const Mesh& mesh, const MayJump& may_jump,
                              DisjointSets& ties) {
  std::erase_if(place.jumps, [&](const auto& at) { return !may_jump(at.first, at.second); });
  const Eigen::MatrixXd weights = weights_of(place);
  const std::vector<int> free = tie_alike(place, weights, ties);
  const Eigen::Index n = std::ssize(free);
  if (n != 1 + weights.cols()) refuse(mesh.nodes[place.copies[0]->node]);
  Eigen::MatrixXd map(n, n);  // from ū and jumps to displacements
  map << Eigen::VectorXd::Ones(n), weights(free, Eigen::all);
  const Eigen::MatrixXd inverse = map.inverse();
  for (Eigen::Index j = 1; j < n; ++j) {
    Sum jump;
    for (Eigen::Index s = 0; s < n; ++s)
      jump.add(inverse(j, s), {{place.copies[free[s]]->node, 1}});
    const auto& [fault, node] = place.jumps[j - 1];
    jumps_[fault][node] = jump.terms();
  }
}

/// u_s = u_0 + Σ (weight_sj − weight_0j) d_j.
void FreeCopies::move_amid(const Place& place, DisjointSets& ties) {
  const NodeCopy& first = *place.copies[0];
  for (std::size_t s = 1; s < place.copies.size(); ++s) {
    const NodeCopy& copy = *place.copies[s];
    Sum moved;
    for (const JumpShare& share : copy.shares)
      moved.add(share.weight, jump(share.fault, share.node));
    for (const JumpShare& share : first.shares)
      moved.add(-share.weight, jump(share.fault, share.node));
    NodeTerms terms = moved.terms();
    if (terms.empty()) {
      ties.join(copy.node, first.node);
    } else {
      terms.insert(terms.begin(), {first.node, 1});
      moved_[copy.node] = std::move(terms);
    }
  }
}

NodeTerms FreeCopies::displacement(int node) const {
  return is_free(node) ? NodeTerms{{node, 1}} : moved_[node];
}

}  // namespace faultsim
