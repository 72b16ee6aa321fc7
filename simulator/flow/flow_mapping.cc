#include "simulator/flow/flow_mapping.h"

#include <algorithm>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/flow/flow_cell_search.h"

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
  constexpr double kHalf = 0.5;  // m
  const double middle = centre_of(corners).y();
  for (Eigen::Vector3d& corner : corners) corner.y() = y + (corner.y() < middle ? -kHalf : kHalf);
  return corners;
}

FlowMapping map_flow(const FlowField& field, const std::vector<MappedCell>& cells,
                     const std::vector<std::string>& region_names, OutsideRule rule) {
  FlowMapping mapping;
  mapping.weights.resize(cells.size());
  mapping.covered.resize(cells.size());
  mapping.coverage.resize(region_names.size());
  const FlowCellSearch search(field.cells);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const MappedCell& cell = cells[c];
    auto& weights = mapping.weights[c];
    const double volume = cell_volume(cell.corners);
    const double covered = overlaps_of(cell, field, search, weights);
    if (covered > (1 + kTwice) * volume) {
      throw InputError("flow field", "flow cells lie over each other at " + where(cell),
                       "give every place one cell, without refined parents");
    }
    for (FlowMapping::Weight& weight : weights) weight.value /= covered;
    RegionCoverage& region = mapping.coverage.at(cell.region);
    region.volume += cell.fraction * volume;
    mapping.covered[c] = std::min(covered / volume, 1.0);
    region.covered += cell.fraction * std::min(covered, volume);
    ++region.n_cells;
    if (covered == 0)
      ++region.n_outside;
    else if (covered < (1 - kWhole) * volume)
      ++region.n_partly;
    if (covered == 0 && rule == OutsideRule::nearest)
      weights.push_back({.flow_cell = search.nearest(centre_of(cell.corners)), .value = 1});
  }
  return mapping;
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
