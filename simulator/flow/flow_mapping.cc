#include "simulator/flow/flow_mapping.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/flow/flow_cell_search.h"
#include "simulator/flow/whole_cells.h"

namespace faultsim {
namespace {

Eigen::Vector3d centre_of(const CellCorners& corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) sum += corner;
  return sum / 8;
}

/// Overlaps in place of weights; their sum.
double overlaps_of(const MappedCell& cell, const FlowField& field, const FlowCellSearch& search,
                   std::vector<FlowMapping::Weight>& weights) {
  const FlowCell box = flow_cell_around(cell.corners);
  double sum = 0;
  for (const int f : search.overlapping(box.low, box.high)) {
    const double overlap = overlap_volume(cell.corners, field.cells[f]);
    if (overlap <= 0) continue;
    weights.push_back({.flow_cell = f, .value = overlap});
    sum += overlap;
  }
  return sum;
}

std::string where(const MappedCell& cell) {
  const Eigen::Vector3d c = centre_of(cell.corners);
  return formatted("x = %g m, y = %g m, depth %g m", c.x(), c.y(), -c.z());
}

/// Of a cell's volume: below it are rounding of the file's digits and the curved faces of
/// corner-point cells beside each other.
constexpr double kTwice = 0.01;
constexpr double kWhole = 1e-6;  ///< of a cell's volume: less than that is missing of one covered.

/// Overlaps become weights, and coverage.
void take_means(const MappedCell& cell, std::size_t c, FlowMapping& mapping) {
  const double volume = cell_volume(cell.corners);
  double covered = 0;
  for (const FlowMapping::Weight& overlap : mapping.weights[c]) covered += overlap.value;
  for (FlowMapping::Weight& weight : mapping.weights[c]) weight.value /= covered;
  RegionCoverage& region = mapping.coverage.at(static_cast<std::size_t>(cell.region));
  region.volume += cell.fraction * volume;
  mapping.covered.push_back(std::min(covered / volume, 1.0));
  region.covered += cell.fraction * std::min(covered, volume);
  ++region.n_cells;
  if (covered == 0)
    ++region.n_outside;
  else if (covered < (1 - kWhole) * volume)
    ++region.n_partly;
}

/// Flow cells are given to compartments, and overlaps with those of another one forgotten.
void divide_flow_cells(const FlowField& field, const std::vector<MappedCell>& cells,
                       const std::array<double, 2>& y_range, FlowMapping& mapping) {
  if (cells.empty()) return;
  const std::vector<int> owner = compartments_of_flow_cells(field, cells, mapping.weights);
  mapping.flow_cells.resize(mapping.coverage.size());
  for (std::size_t f = 0; f < owner.size(); ++f) {
    const double volume = volume_between(field.cells[f], y_range);
    if (volume > 0)
      mapping.flow_cells[static_cast<std::size_t>(owner[f])].push_back(
          {.flow_cell = static_cast<int>(f), .value = volume});
  }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::erase_if(mapping.weights[c], [&](const FlowMapping::Weight& overlap) {
      return owner[static_cast<std::size_t>(overlap.flow_cell)] != cells[c].region;
    });
  }
}

std::vector<FlowCell> cells_of(const FlowField& field,
                               const std::vector<FlowMapping::Weight>& own) {
  std::vector<FlowCell> cells;
  for (const FlowMapping::Weight& one : own)
    cells.push_back(field.cells[static_cast<std::size_t>(one.flow_cell)]);
  return cells;
}

/// Finds the nearest of the flow cells that count with one compartment.
class NearestOfRegion {
 public:
  NearestOfRegion(const FlowField& field, const std::vector<FlowMapping::Weight>& own)
      : own_(own), cells_(cells_of(field, own)), search_(cells_) {}
  NearestOfRegion(const NearestOfRegion&) = delete;  // the search looks at the cells
  int operator()(const Eigen::Vector3d& place) const {
    return own_[static_cast<std::size_t>(search_.nearest(place))].flow_cell;
  }

 private:
  const std::vector<FlowMapping::Weight>& own_;
  std::vector<FlowCell> cells_;
  FlowCellSearch search_;
};

/// Cells that take from none: the nearest flow cell, of their own compartment where those are
/// known.
void take_nearest(const FlowField& field, const std::vector<MappedCell>& cells,
                  FlowMapping& mapping) {
  const FlowCellSearch search(field.cells);
  std::map<std::size_t, NearestOfRegion> of_region;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!mapping.weights[c].empty()) continue;
    const Eigen::Vector3d at = centre_of(cells[c].corners);
    const auto region = static_cast<std::size_t>(cells[c].region);
    const bool has_own = !mapping.flow_cells.empty() && !mapping.flow_cells[region].empty();
    int nearest = -1;
    if (has_own)
      nearest = of_region.try_emplace(region, field, mapping.flow_cells[region]).first->second(at);
    else
      nearest = search.nearest(at);
    mapping.weights[c].push_back({.flow_cell = nearest, .value = 1});
  }
}

}  // namespace

CellCorners between_sides(const std::array<double, 2>& west, const std::array<double, 2>& east,
                          double top, double bottom, double half_length) {
  CellCorners corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const bool is_top = i >= 4, is_east = i % 4 == 1 || i % 4 == 2, is_north = i % 4 >= 2;
    corners[i] = {(is_east ? east : west)[is_top ? 0 : 1], is_north ? half_length : -half_length,
                  is_top ? -top : -bottom};
  }
  return corners;
}

CellCorners at_section(CellCorners corners, double y) {
  const double middle = centre_of(corners).y();
  for (Eigen::Vector3d& corner : corners)
    corner.y() = y + (corner.y() < middle ? -kHalfSection : kHalfSection);
  return corners;
}

FlowOverlaps flow_overlaps(const FlowField& field, const std::vector<MappedCell>& cells) {
  FlowOverlaps all;
  const FlowCellSearch search(field.cells);
  for (const MappedCell& cell : cells) {
    const double sum = overlaps_of(cell, field, search, all.emplace_back());
    if (sum > (1 + kTwice) * cell_volume(cell.corners)) {
      throw InputError("flow field", "flow cells overlap at " + where(cell),
                       "give every place one cell: grid layers (ZCORN) one below the other, no "
                       "refined parents; a "
                       "table of points of a grid with leaning pillars needs columns i, j and k");
    }
  }
  return all;
}

FlowMapping map_overlaps(const FlowField& field, const std::vector<MappedCell>& cells,
                         FlowOverlaps overlaps, const std::vector<std::string>& region_names,
                         const MappingRules& rules) {
  FlowMapping mapping;
  mapping.weights = std::move(overlaps);
  mapping.coverage.resize(region_names.size());
  for (const MappedCell& cell : cells) {
    mapping.region.push_back(cell.region);
    mapping.part.push_back(cell.fraction * cell_volume(cell.corners));
  }
  if (rules.integral == IntegralRule::flow_grid)
    divide_flow_cells(field, cells, rules.y_range, mapping);
  for (std::size_t c = 0; c < cells.size(); ++c) take_means(cells[c], c, mapping);
  if (rules.outside == OutsideRule::nearest) take_nearest(field, cells, mapping);
  return mapping;
}

FlowMapping map_flow(const FlowField& field, const std::vector<MappedCell>& cells,
                     const std::vector<std::string>& region_names, const MappingRules& rules) {
  return map_overlaps(field, cells, flow_overlaps(field, cells), region_names, rules);
}

Eigen::MatrixXd mapped_change(const FlowMapping& mapping, const FlowField& field, int reference,
                              std::vector<int> reports) {
  FAULTSIM_DEMAND(reference >= 0 && reference < field.value.cols(), "report ", reference);
  if (reports.empty()) {
    reports.resize(field.date.size());
    std::iota(reports.begin(), reports.end(), 0);
  }
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(std::ssize(mapping.weights), std::ssize(reports));
  for (Eigen::Index c = 0; c < change.rows(); ++c) {
    for (const FlowMapping::Weight& weight : mapping.weights[c]) {
      const int f = weight.flow_cell;
      for (Eigen::Index t = 0; t < change.cols(); ++t)
        change(c, t) += weight.value * (field.value(f, reports[t]) - field.value(f, reference));
    }
  }
  return change;
}

std::string coverage_text(const RegionCoverage& region, OutsideRule rule) {
  std::string text =
      formatted("%.4g %% of its volume covered", 100 * region.covered / region.volume);
  if (region.n_outside > 0) {
    text += concat(
        "; ", region.n_outside, " of ", region.n_cells, " cells outside ",
        rule == OutsideRule::nearest ? "take what the nearest flow cell has" : "do not change");
  }
  if (region.n_partly > 0)
    text += concat("; ", region.n_partly, " covered in part take that part's mean");
  return text;
}

}  // namespace faultsim
