#include "simulator/corner_point/structure_finder.h"

#include <algorithm>
#include <map>
#include <set>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/compartments.h"
#include "simulator/corner_point/edge_graph.h"
#include "simulator/corner_point/fault_description.h"
#include "simulator/corner_point/fault_edges.h"
#include "simulator/corner_point/fault_ends.h"
#include "simulator/corner_point/horizons.h"
#include "simulator/corner_point/structure_report.h"

namespace faultsim::corner_point {
namespace {

/// Of regions that are asked for.
void check_region(const CornerPointGrid& grid, const std::string& name,
                  const std::vector<int>& region, std::vector<Problem>& problems) {
  if (!region.empty()) return;
  const auto misfit = grid.region_misfits.find(name);
  const bool is_there = misfit != grid.region_misfits.end();
  problems.push_back(
      {"/compartments", 0, is_there ? misfit->second : name + " is missing",
       concat(is_there ? "keep the files of one run together" : "put the INIT file beside the grid",
              ", or let the faults bound compartments")});
}

void check_options(const CornerPointGrid& grid, const StructureOptions& options) {
  std::vector<Problem> problems;
  const auto need = [&](bool holds, const char* name, const auto& value, const char* what,
                        const char* cure) {
    if (!holds) problems.push_back({concat("/", name), 0, concat(value, what), cure});
  };
  need(options.negligible_offset > 0, "negligible_offset", options.negligible_offset,
       " m is not positive", "write the noise of the grid's depths, 0.1 m");
  need(options.least_offset >= options.negligible_offset, "least_offset", options.least_offset,
       " m is below negligible_offset", "write an offset that counts as a fault, 6 m");
  need(options.fewest_edges >= 1, "fewest_edges", options.fewest_edges, " is below 1",
       "write 1 or more");
  need(options.straightening > 0, "straightening", options.straightening, " cells is not positive",
       "write half a cell, 0.5");
  need(options.no_thickness >= 0, "no_thickness", options.no_thickness, " m is negative",
       "write 0 or more");
  if (options.compartments == CompartmentRule::equilibrium_regions)
    check_region(grid, "EQLNUM", grid.equilibrium_region, problems);
  if (options.compartments == CompartmentRule::fluid_regions)
    check_region(grid, "FIPNUM", grid.fluid_region, problems);
  if (!problems.empty()) throw InputError("options of the grid's structure", problems);
}

class StructureFinder {
 public:
  StructureFinder(const CornerPointGrid& grid, const StructureOptions& options)
      : grid_(grid), options_(options), map_(grid) {}

  GridStructure find() {
    count();
    stepping_ = find_stepping_edges(map_, options_);
    found_.n_bridged = stepping_.n_bridged;
    find_faults();
    leave_out_small_steps();
    count_connections();
    std::ranges::stable_sort(found_.left_out, std::ranges::greater(), &LeftOut::largest_offset);
    find_rest();
    found_.report = structure_report(grid_, found_, options_);
    return std::move(found_);
  }

 private:
  void count() {
    found_.n_active_cells = static_cast<int>(std::ranges::count(grid_.is_active, 1));
    for (int column = 0; column < grid_.n_columns(); ++column) {
      const bool is_active = grid_.has_active_cell(column);
      found_.n_active_columns += is_active ? 1 : 0;
      found_.n_hole_columns += map_.is_inside(column) && !is_active ? 1 : 0;
    }
    found_.layers = find_layers(map_, options_.no_thickness);
    for (const Layer& layer : found_.layers) found_.n_collapsed_cells += layer.n_collapsed;
  }

  /// The mean height of the reservoir's top beside the edges, or of all of it without any.
  double reference_z() const {
    double sum = 0;
    int n = 0;
    const auto add = [&](int column, int pillar) {
      sum += grid_.z(column, map_.top_layer(column), map_.corner_at(column, pillar));
      n += 1;
    };
    for (const FaultEdge& edge : stepping_.faulted) {
      for (const int column : {edge.left, edge.right}) {
        for (const int pillar : {edge.from, edge.to}) add(column, pillar);
      }
    }
    for (int column = 0; n == 0 && column < grid_.n_columns(); ++column) {
      if (map_.is_inside(column)) add(column, grid_.pillar_of(column, {}));
    }
    return sum / n;
  }

  void find_faults() {
    found_.reference_z = options_.reference_z.value_or(reference_z());
    const std::vector<Eigen::Vector2d> place =
        mapped(grid_.pillars, [&](const Pillar& pillar) { return pillar.at(found_.reference_z); });
    const EdgeChains joined = join_edges(stepping_.faulted, place, options_.fewest_edges);
    for (const EdgeChain& chain : joined.chains)
      found_.faults.push_back(
          described_fault(map_, chain, found_.reference_z, options_.straightening));
    std::ranges::stable_sort(found_.faults, std::ranges::greater(),
                             [](const Fault& fault) { return fault.edges.size(); });
    found_.junctions = meet_faults(map_, found_.faults);
    if (options_.extend_faults) extend_tips(map_, found_.faults, found_.reference_z);
    for (const std::vector<int>& edges : joined.short_chains)
      leave_out(stepping_.faulted, edges, LeftOutReason::short_chain);
    for (const std::vector<int>& edges : joined.in_junctions)
      leave_out(stepping_.faulted, edges, LeftOutReason::in_junction);
  }

  void leave_out(const std::vector<FaultEdge>& all, const std::vector<int>& edges,
                 LeftOutReason reason) {
    LeftOut left{reason, static_cast<int>(edges.size())};
    bool is_first = true;
    for (const int e : edges) {
      left.largest_offset = std::max(left.largest_offset, all[e].largest());
      for (const int pillar : {all[e].from, all[e].to}) {
        const Eigen::Vector2d at = grid_.pillars[pillar].at(found_.reference_z);
        left.low = is_first ? at : Eigen::Vector2d(left.low.cwiseMin(at));
        left.high = is_first ? at : Eigen::Vector2d(left.high.cwiseMax(at));
        is_first = false;
        for (std::size_t f = 0; f < found_.faults.size(); ++f) {
          const Fault& fault = found_.faults[f];
          for (const FaultEnd* end : {&fault.begin, &fault.end}) {
            if (end->kind == EndKind::tip && end->pillar == pillar)
              left.continues = static_cast<int>(f);
          }
        }
      }
    }
    found_.left_out.push_back(left);
  }

  void leave_out_small_steps() {
    for (const std::vector<int>& edges : connected_edges(stepping_.small))
      leave_out(stepping_.small, edges, LeftOutReason::small_offset);
  }

  std::set<int> barriers(bool with_extensions) const {
    std::set<int> all;
    for (const Fault& fault : found_.faults) {
      for (const FaultEdge& edge : fault.edges) all.insert(map_.edge_between(edge.from, edge.to));
      for (const FaultEdge& edge : fault.extension) {
        if (with_extensions) all.insert(map_.edge_between(edge.from, edge.to));
      }
    }
    return all;
  }

  void count_connections() {
    const std::set<int> on_faults = barriers(false);
    found_.n_connections = static_cast<int>(grid_.connections.size());
    for (const int edge : stepping_.connected)
      found_.n_connections_on_faults += on_faults.contains(edge) ? 1 : 0;
  }

  void find_rest() {
    const std::set<int> separating = barriers(true);
    Compartments compartments = find_compartments(map_, separating, options_.compartments);
    found_.compartments = std::move(compartments.all);
    found_.compartment_of_cell = std::move(compartments.of_cell);
    Horizons horizons =
        find_horizons(map_, separating, found_.compartment_of_cell, options_.no_thickness);
    found_.horizons = std::move(horizons.all);
    found_.largest_gap = horizons.largest_gap;
  }

  const CornerPointGrid& grid_;
  const StructureOptions& options_;
  ColumnMap map_;
  SteppingEdges stepping_;
  GridStructure found_;
};

}  // namespace

GridStructure recognise_structure(const CornerPointGrid& grid, const StructureOptions& options) {
  check_options(grid, options);
  return StructureFinder(grid, options).find();
}

}  // namespace faultsim::corner_point
