#include "simulator/grid_scene/fault_columns.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::ColumnMap;

constexpr int kFar = 6;  // columns from a fault

/// How many columns lie between each column and one side of a fault, as others are gone through
/// without crossing barriers; more than kFar: far.
std::vector<int> steps_from(const ColumnMap& map, const std::set<int>& barriers,
                            const std::vector<int>& begin) {
  std::vector<int> steps(static_cast<std::size_t>(map.grid().n_columns()), kFar + 1);
  std::vector<int> queue;
  for (const int column : begin) {
    if (steps[column] == 0) continue;
    steps[column] = 0;
    queue.push_back(column);
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const int column = queue[next];
    if (steps[column] == kFar) continue;
    for (const int other : map.columns_beside(column)) {
      if (!map.is_inside(other) || steps[other] <= kFar) continue;
      if (barriers.contains(map.edge_between_columns(column, other))) continue;
      steps[other] = steps[column] + 1;
      queue.push_back(other);
    }
  }
  return steps;
}

}  // namespace

std::set<int> edges_of_faults(const ColumnMap& map, const corner_point::GridStructure& structure,
                              const ModelLines& lines) {
  std::set<int> edges;
  for (const ModelFault& fault : lines.faults) {
    for (const corner_point::FaultEdge& edge : structure.faults[fault.source].edges)
      edges.insert(map.edge_between(edge.from, edge.to));
  }
  return edges;
}

std::vector<std::vector<int>> sides_of_columns(const ColumnMap& map,
                                               const corner_point::GridStructure& structure,
                                               const ModelLines& lines) {
  const std::set<int> barriers = edges_of_faults(map, structure, lines);
  std::vector<std::vector<int>> sides;
  for (const ModelFault& fault : lines.faults) {
    std::vector<int> left, right, side;
    for (const corner_point::FaultEdge& edge : structure.faults[fault.source].edges) {
      left.push_back(edge.left);
      right.push_back(edge.right);
    }
    const std::vector<int> from_left = steps_from(map, barriers, left),
                           from_right = steps_from(map, barriers, right);
    for (std::size_t c = 0; c < from_left.size(); ++c)
      side.push_back((from_left[c] < from_right[c] ? 1 : 0) -
                     (from_right[c] < from_left[c] ? 1 : 0));
    sides.push_back(std::move(side));
  }
  return sides;
}

}  // namespace faultsim::grid_scene
