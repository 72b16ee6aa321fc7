#include "simulator/corner_point/edge_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"

namespace faultsim::corner_point {
namespace {

/// A branch's end at a junction.
struct BranchEnd {
  int branch = -1;
  bool is_last = false;  ///< the end at its last pillar.

  bool operator==(const BranchEnd&) const = default;
  bool operator<(const BranchEnd& other) const {
    return std::tie(branch, is_last) < std::tie(other.branch, other.is_last);
  }
};

/// Joins edges to chains: see join_edges.
class EdgeJoiner {
 public:
  EdgeJoiner(const std::vector<FaultEdge>& edges, const std::vector<Eigen::Vector2d>& place,
             int fewest_edges)
      : edges_(edges), place_(place), fewest_(fewest_edges) {
    for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
      at_[edges[e].from].push_back(e);
      at_[edges[e].to].push_back(e);
    }
  }

  EdgeChains join() {
    find_branches();
    while (cut_spurs()) find_branches();
    find_junctions();
    for (auto& [junction, ends] : ends_at_) pair_ends(ends);
    follow_pairs();
    leave_out_rest();
    return std::move(result_);
  }

 private:
  int degree(int pillar) const { return static_cast<int>(at_.at(pillar).size()); }
  int other_pillar(int edge, int pillar) const {
    return edges_[edge].from == pillar ? edges_[edge].to : edges_[edge].from;
  }
  bool is_short(const EdgeChain& branch) const { return std::ssize(branch.edges) < fewest_; }

  /// From a pillar along an edge to where the chain ends, branches or comes back.
  EdgeChain branch_from(int pillar, int edge) const {
    EdgeChain branch{{pillar}, {}};
    while (true) {
      branch.edges.push_back(edge);
      branch.pillars.push_back(other_pillar(edge, branch.pillars.back()));
      const int here = branch.pillars.back();
      if (degree(here) != 2 || here == pillar) return branch;
      const std::vector<int>& both = at_.at(here);
      edge = both[0] == edge ? both[1] : both[0];
    }
  }

  void find_branches() {
    branches_.clear();
    std::set<int> taken;
    for (const bool in_rings : {false, true}) {  // rings have no pillar to begin at
      for (const auto& [pillar, edges] : at_) {
        if ((edges.size() == 2) != in_rings) continue;
        for (const int edge : edges) {
          if (taken.contains(edge)) continue;
          branches_.push_back(branch_from(pillar, edge));
          taken.insert(branches_.back().edges.begin(), branches_.back().edges.end());
        }
      }
    }
  }

  double largest_offset(const EdgeChain& branch) const {
    double largest = 0;
    for (const int edge : branch.edges) largest = std::max(largest, edges_[edge].largest());
    return largest;
  }

  /// Takes away the shortest spur at each junction; of equal ones that of less offset.
  bool cut_spurs() {
    std::vector<std::tuple<std::size_t, double, int>> spurs;
    for (int b = 0; b < static_cast<int>(branches_.size()); ++b) {
      const EdgeChain& branch = branches_[b];
      const int first = degree(branch.pillars.front()), last = degree(branch.pillars.back());
      if (is_short(branch) && std::min(first, last) == 1 && std::max(first, last) > 2)
        spurs.emplace_back(branch.edges.size(), largest_offset(branch), b);
    }
    std::ranges::sort(spurs);
    std::set<int> changed;
    for (const auto& spur : spurs) {
      const EdgeChain& branch = branches_[std::get<2>(spur)];
      const int junction =
          degree(branch.pillars.front()) == 1 ? branch.pillars.back() : branch.pillars.front();
      if (!changed.insert(junction).second) continue;
      for (const int edge : branch.edges) remove(edge);
      result_.short_chains.push_back(branch.edges);
    }
    return !spurs.empty();
  }

  void remove(int edge) {
    for (const int pillar : {edges_[edge].from, edges_[edge].to}) {
      std::vector<int>& here = at_[pillar];
      std::erase(here, edge);
      if (here.empty()) at_.erase(pillar);
    }
  }

  /// Junctions with the short branches between them are one, by the smallest of their pillars.
  void find_junctions() {
    std::map<int, int> number;
    std::vector<int> pillars;
    for (const auto& [pillar, edges] : at_) {
      if (edges.size() <= 2) continue;
      number[pillar] = static_cast<int>(pillars.size());
      pillars.push_back(pillar);
    }
    DisjointSets sets(pillars.size());
    for (const EdgeChain& branch : branches_) {
      const bool joins = number.contains(branch.pillars.front()) &&
                         number.contains(branch.pillars.back()) && !branch.is_closed();
      is_link_.push_back(joins && static_cast<int>(branch.edges.size()) < 2 * fewest_ ? 1 : 0);
      if (is_link_.back() != 0)
        sets.join(number[branch.pillars.front()], number[branch.pillars.back()]);
    }
    for (const auto& [pillar, n] : number) junction_of_[pillar] = pillars[sets.find(n)];
    for (int b = 0; b < static_cast<int>(branches_.size()); ++b) {
      if (is_link_[b] != 0) {
        for (const int edge : branches_[b].edges) link_edges_.insert(edge);
        continue;
      }
      for (const bool is_last : {false, true}) {
        const auto found = junction_of_.find(pillar_at({b, is_last}));
        if (found != junction_of_.end()) ends_at_[found->second].push_back({b, is_last});
      }
    }
  }

  int pillar_at(const BranchEnd& end) const {
    const std::vector<int>& pillars = branches_[end.branch].pillars;
    return end.is_last ? pillars.back() : pillars.front();
  }

  /// Away from the junction, over some edges, so that stairs do not matter.
  Eigen::Vector2d direction(const BranchEnd& end) const {
    constexpr int kReach = 6;  // edges
    const std::vector<int>& pillars = branches_[end.branch].pillars;
    const int last = static_cast<int>(pillars.size()) - 1, reach = std::min(kReach, last);
    const int there = end.is_last ? pillars[last - reach] : pillars[reach];
    return (place_[there] - place_[pillar_at(end)]).normalized();
  }

  /// How far the end of one branch is from the line on which another arrives, in edges.
  double distance_aside(const BranchEnd& of, const BranchEnd& from) const {
    const Eigen::Vector2d gap = place_[pillar_at(of)] - place_[pillar_at(from)];
    const std::vector<int>& pillars = branches_[from.branch].pillars;
    const Eigen::Vector2d along = direction(from);
    const double edge = (place_[pillars[1]] - place_[pillars[0]]).norm();
    return (gap - gap.dot(along) * along).norm() / edge;
  }

  void pair(const BranchEnd& a, const BranchEnd& b) {
    partner_[a] = b;
    partner_[b] = a;
  }

  void pair_ends(std::vector<BranchEnd>& ends) {
    constexpr double kLargestTurn = std::numbers::pi / 3;
    constexpr double kFarthestAside = 2;  // edges: a stair more than stairs have
    std::vector<std::tuple<double, BranchEnd, BranchEnd>> pairs;
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        if (ends[a].branch == ends[b].branch) continue;
        const double cosine = std::clamp(-direction(ends[a]).dot(direction(ends[b])), -1.0, 1.0);
        pairs.emplace_back(std::acos(cosine), ends[a], ends[b]);
      }
    }
    std::ranges::sort(pairs);
    bool has_pair = false;
    for (const auto& [turn, a, b] : pairs) {
      const bool is_free = !partner_.contains(a) && !partner_.contains(b);
      if (!is_free || turn > kLargestTurn || distance_aside(a, b) > kFarthestAside) continue;
      pair(a, b);
      has_pair = true;
    }
    if (!has_pair && !pairs.empty()) pair(std::get<1>(pairs[0]), std::get<2>(pairs[0]));
  }

  void append(EdgeChain& chain, const EdgeChain& branch, bool backwards) const {
    const int n = static_cast<int>(branch.edges.size());
    for (int e = 0; e < n; ++e) {
      chain.edges.push_back(branch.edges[backwards ? n - 1 - e : e]);
      chain.pillars.push_back(branch.pillars[backwards ? n - 1 - e : e + 1]);
    }
  }

  /// Along links, the shortest way from the chain's last pillar to one that is wanted.
  template <typename Wanted>
  void append_links(EdgeChain& chain, const Wanted& is_wanted) {
    std::map<int, int> came_by = {{chain.pillars.back(), -1}};
    std::vector<int> queue = {chain.pillars.back()};
    for (std::size_t q = 0; q < queue.size(); ++q) {
      if (is_wanted(queue[q])) return append_way(chain, came_by, queue[q]);
      for (const int edge : at_[queue[q]]) {
        const int next = other_pillar(edge, queue[q]);
        if (link_edges_.contains(edge) && came_by.try_emplace(next, edge).second)
          queue.push_back(next);
      }
    }
  }

  void append_way(EdgeChain& chain, const std::map<int, int>& came_by, int pillar) {
    std::vector<int> way;
    for (int at = pillar; came_by.at(at) >= 0; at = other_pillar(came_by.at(at), at))
      way.push_back(came_by.at(at));
    for (auto edge = way.rbegin(); edge != way.rend(); ++edge) {
      chain.edges.push_back(*edge);
      chain.pillars.push_back(other_pillar(*edge, chain.pillars.back()));
      used_links_.insert(*edge);
    }
  }

  /// The chain that begins at a branch's end.
  EdgeChain chain_from(BranchEnd begin) {
    EdgeChain chain{{pillar_at(begin)}, {}};
    BranchEnd at = begin;
    while (true) {
      visited_.insert(at.branch);
      append(chain, branches_[at.branch], at.is_last);
      const auto next = partner_.find({at.branch, !at.is_last});
      if (next == partner_.end()) return chain;
      const int goal = pillar_at(next->second);
      append_links(chain, [&](int pillar) { return pillar == goal; });
      if (visited_.contains(next->second.branch)) return chain;  // a ring
      at = next->second;
    }
  }

  void follow_pairs() {
    for (const bool in_rings : {false, true}) {
      for (int b = 0; b < static_cast<int>(branches_.size()); ++b) {
        for (const bool is_last : {false, true}) {
          const bool is_taken = is_link_[b] != 0 || visited_.contains(b);
          if (is_taken || (!in_rings && partner_.contains({b, is_last}))) continue;
          keep(chain_from({b, is_last}));
        }
      }
    }
    for (EdgeChain& chain : result_.chains) reach_junctions(chain);
  }

  void keep(EdgeChain chain) {
    if (is_short(chain)) {
      result_.short_chains.push_back(chain.edges);
    } else {
      result_.chains.push_back(std::move(chain));
    }
  }

  /// A chain that ends in a junction of several pillars goes on to a chain that runs through it.
  void reach_junctions(EdgeChain& chain) {
    if (chain.is_closed()) return;
    for (int end = 0; end < 2; ++end) {
      std::ranges::reverse(chain.pillars);
      std::ranges::reverse(chain.edges);
      if (!junction_of_.contains(chain.pillars.back())) continue;
      append_links(chain, [&](int pillar) {
        return std::ranges::any_of(result_.chains, [&](const EdgeChain& other) {
          return &other != &chain && contains(other.pillars, pillar);
        });
      });
    }
  }

  /// Short branches between junctions that no chain took: chains of their own if long enough.
  void leave_out_rest() {
    for (int b = 0; b < static_cast<int>(branches_.size()); ++b) {
      if (is_link_[b] == 0) continue;
      std::vector<int> unused;
      for (const int edge : branches_[b].edges) {
        if (!used_links_.contains(edge)) unused.push_back(edge);
      }
      if (unused.size() == branches_[b].edges.size() && !is_short(branches_[b])) {
        result_.chains.push_back(branches_[b]);
      } else if (!unused.empty()) {
        result_.in_junctions.push_back(unused);
      }
    }
  }

  const std::vector<FaultEdge>& edges_;
  const std::vector<Eigen::Vector2d>& place_;
  int fewest_;
  std::map<int, std::vector<int>> at_;  ///< edges at each pillar.
  std::vector<EdgeChain> branches_;
  std::vector<char> is_link_;       ///< per branch.
  std::map<int, int> junction_of_;  ///< pillars where branches meet.
  std::map<int, std::vector<BranchEnd>> ends_at_;
  std::map<BranchEnd, BranchEnd> partner_;
  std::set<int> visited_;  ///< branches.
  std::set<int> link_edges_, used_links_;
  EdgeChains result_;
};

}  // namespace

EdgeChains join_edges(const std::vector<FaultEdge>& edges,
                      const std::vector<Eigen::Vector2d>& place, int fewest_edges) {
  return EdgeJoiner(edges, place, fewest_edges).join();
}

std::vector<std::vector<int>> connected_edges(const std::vector<FaultEdge>& edges) {
  std::map<int, int> first_at;
  DisjointSets sets(edges.size());
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    for (const int pillar : {edges[e].from, edges[e].to})
      sets.join(e, first_at.try_emplace(pillar, e).first->second);
  }
  const std::vector<int> set_of = sets.numbered();
  std::vector<std::vector<int>> all;
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    if (set_of[e] == static_cast<int>(all.size())) all.emplace_back();
    all[set_of[e]].push_back(e);
  }
  return all;
}

}  // namespace faultsim::corner_point
