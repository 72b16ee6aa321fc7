#include "simulator/corner_point/fault_edges.h"

#include <algorithm>
#include <map>

#include "simulator/common/ranges.h"
#include "simulator/corner_point/edge_graph.h"

namespace faultsim::corner_point {
namespace {

/// How many edges there are at each pillar.
std::map<int, int> degrees_of(const std::vector<FaultEdge>& edges) {
  std::map<int, int> degree;
  for (const FaultEdge& edge : edges) {
    degree[edge.from] += 1;
    degree[edge.to] += 1;
  }
  return degree;
}

/// Whether edges are one line from a tip to another, away from all faults between.
bool is_bridge(const std::vector<FaultEdge>& edges, const std::map<int, int>& degree_of_faults) {
  int n_tips = 0;
  for (const auto& [pillar, degree] : degrees_of(edges)) {
    const auto at = degree_of_faults.find(pillar);
    const int faulted = at == degree_of_faults.end() ? 0 : at->second;
    if (degree > 2 || faulted != (degree == 1 ? 1 : 0)) return false;
    n_tips += faulted;
  }
  return n_tips == 2;
}

/// Small edges that are bridges become faulted.
void bridge_gaps(SteppingEdges& edges) {
  const std::map<int, int> degree = degrees_of(edges.faulted);
  std::vector<FaultEdge> small;
  for (const std::vector<int>& set : connected_edges(edges.small)) {
    const std::vector<FaultEdge> gap = mapped(set, [&](int e) { return edges.small[e]; });
    const bool bridges = is_bridge(gap, degree);
    std::vector<FaultEdge>& into = bridges ? edges.faulted : small;
    into.insert(into.end(), gap.begin(), gap.end());
    if (bridges) edges.n_bridged += static_cast<int>(gap.size());
  }
  edges.small = std::move(small);
}

}  // namespace

SteppingEdges find_stepping_edges(const ColumnMap& map, const StructureOptions& options) {
  SteppingEdges edges;
  const int n_columns = map.grid().n_columns();
  for (const std::array<int, 2>& pair : map.grid().connections) {
    const int edge = map.edge_between_columns(pair[0] % n_columns, pair[1] % n_columns);
    if (edge >= 0) edges.connected.push_back(edge);
  }
  std::ranges::sort(edges.connected);
  for (int pillar = 0; pillar < map.n_pillars(); ++pillar) {
    for (const int next : map.neighbours(pillar)) {
      if (next < pillar) continue;
      const std::array<int, 2> columns = map.sides(pillar, next);
      if (!map.is_inside(columns[0]) || !map.is_inside(columns[1])) continue;
      const FaultEdge edge = map.measured(pillar, next);
      if (edge.largest() < options.negligible_offset) continue;
      const bool is_faulted =
          edge.largest() >= options.least_offset ||
          (options.faults_by_connections &&
           std::ranges::binary_search(edges.connected, map.edge_between(pillar, next)));
      (is_faulted ? edges.faulted : edges.small).push_back(edge);
    }
  }
  if (options.bridge_gaps) bridge_gaps(edges);
  return edges;
}

}  // namespace faultsim::corner_point
