#include "simulator/case_figures/section_pressures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "simulator/initial_state/pressure_history.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

namespace faultsim {
namespace {

constexpr double kLeastCovered = 0.5;

/// A number of rows that makes pieces of the reservoirs about as high as wide.
int rows_of(const Scene& scene) {
  const FieldGeometry& field = scene.field;
  double height = 0;
  for (const Block& block : field.blocks) {
    const DepthInterval depths = reservoir_range(field, block);
    height = std::max(height, depths.bottom - depths.top);
  }
  const double width = (field.blocks.back().to - field.blocks.front().from) /
                       static_cast<double>(field.blocks.size());
  const double rows = std::sqrt(SectionPressures::kMostPieces * height / width);
  constexpr int kFewest = 2, kMost = 20;
  return std::clamp(static_cast<int>(std::lround(rows)), kFewest, kMost);
}

/// The part of the flow result that reaches into the cells.
FlowField field_near(const FlowLoad& load, const std::vector<MappedCell>& cells) {
  Eigen::AlignedBox3d box;
  for (const MappedCell& cell : cells)
    for (const Eigen::Vector3d& corner : cell.corners) box.extend(corner);
  return placed_within(*load.field, load.origin, load.azimuth, box.min(), box.max());
}

}  // namespace

const FlowLoad& painted_load(const Scene& scene) {
  return scene.pressure_field.is_given() ? scene.pressure_field : scene.temperature_field;
}

SectionPressures::SectionPressures(const Scene& scene, double y)
    : n_blocks_(scene.field.blocks.size()), y_(y), time_(painted_load(scene).time) {
  const FlowLoad& load = painted_load(scene);
  const int n_rows = rows_of(scene), n_columns = kMostPieces / n_rows;
  std::vector<MappedCell> cells;
  for (std::size_t b = 0; b < n_blocks_; ++b) {
    cut(scene, b, n_columns, n_rows, cells);
    reaches_.push_back(faultsim::reaches(scene, b, y));
  }
  const FlowField near = field_near(load, cells);
  if (near.cells.empty()) {
    covered_.assign(cells.size(), 0);
    change_ = Eigen::MatrixXd::Zero(std::ssize(cells), std::ssize(time_));
    return;
  }
  FlowMapping mapping =
      map_flow(near, cells, region_names(scene), {.outside = OutsideRule::unchanged});
  change_ = mapped_change(mapping, near, load.reference, load.reports);
  covered_ = std::move(mapping.covered);
}

void SectionPressures::cut(const Scene& scene, std::size_t block, int n_columns, int n_rows,
                           std::vector<MappedCell>& cells) {
  const DepthInterval depths = reservoir_range(scene.field, scene.field.blocks[block]);
  const auto depth_of = [&](int row) {
    return depths.top + (depths.bottom - depths.top) * row / n_rows;
  };
  const auto x_of = [&](int column, double depth) {
    const double west = fault_x(scene, block, depth), east = fault_x(scene, block + 1, depth);
    return west + (east - west) * column / n_columns;
  };
  for (int row = 0; row < n_rows; ++row) {
    const double top = depth_of(row), base = depth_of(row + 1);
    for (int column = 0; column < n_columns; ++column) {
      const std::array west = {x_of(column, top), x_of(column, base)},
                       east = {x_of(column + 1, top), x_of(column + 1, base)};
      corners_.push_back({{{west[0], top}, {east[0], top}, {east[1], base}, {west[1], base}}});
      cells.push_back({.corners = at_section(between_sides(west, east, top, base, 1), y_),
                       .region = static_cast<int>(block)});
      width_ = std::max({width_, east[0] - west[0], east[1] - west[1]});
      height_ = std::max(height_, base - top);
    }
  }
}

std::vector<double> SectionPressures::at(std::size_t block, double time) const {
  const auto [first, second, share] = between(time_, time);
  std::vector<double> change(n_pieces(), NAN);
  for (std::size_t k = 0; k < change.size(); ++k) {
    const std::size_t piece = block * n_pieces() + k;
    if (covered_[piece] < kLeastCovered) continue;
    const auto row = change_.row(static_cast<Eigen::Index>(piece));
    const double before = row[static_cast<Eigen::Index>(first)],
                 after = row[static_cast<Eigen::Index>(second)];
    change[k] = before + share * (after - before);
  }
  return change;
}

std::size_t SectionPressures::n_covered() const {
  std::size_t n = 0;
  for (std::size_t piece = 0; piece < covered_.size(); ++piece)
    n += reaches_[piece / n_pieces()] && covered_[piece] >= kLeastCovered ? 1 : 0;
  return n;
}

std::size_t SectionPressures::n_all() const {
  return n_pieces() * static_cast<std::size_t>(std::ranges::count(reaches_, true));
}

}  // namespace faultsim
