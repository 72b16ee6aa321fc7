#include "simulator/initial_state/initial_state.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulator/common/dates.h"

namespace faultsim {
namespace {

/// The reference column: layers at zero offset, or the box's layers from z = 0 down.
std::vector<ColumnPiece> reference_column(const Scene& scene) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  const double base = is_field ? scene.field.depth : -scene.box.from[2];
  const std::vector<Layer>& layers = layers_of(scene);
  if (layers.empty()) return {{base, material_named(scene, scene.box.material).density}};
  std::vector<ColumnPiece> column;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const double bottom = i + 1 < layers.size() ? layers[i + 1].top_depth : base;
    column.push_back({bottom, material_named(scene, layers[i].material).density});
  }
  return column;
}

/// ∫ ρ g from the surface to depth, Pa.
double weight(const std::vector<ColumnPiece>& column, double gravity, double depth) {
  double sum = 0;
  double top = 0;
  for (const ColumnPiece& piece : column) {
    sum += piece.density * std::max(0.0, std::min(depth, piece.bottom) - top);
    top = piece.bottom;
  }
  return sum * gravity;
}

bool is_viscous(const Scene& scene, const std::string& material) {
  return material_named(scene, material).viscosity.has_value();
}

/// Whether the layer at that depth is viscous; beyond the model the nearest layer counts.
bool is_viscous_at(const Scene& scene, double depth, DepthSide side) {
  const std::vector<Layer>& layers = layers_of(scene);
  if (is_meshed(scene)) return false;  // it has no layers, and lithostatic ones are refused
  if (layers.empty()) return is_viscous(scene, scene.box.material);
  std::size_t i = 0;
  while (i + 1 < layers.size()) {
    const double top = layers[i + 1].top_depth;
    if (depth < top || (depth == top && side == DepthSide::above)) break;
    ++i;
  }
  return is_viscous(scene, layers[i].material);
}

/// A block's column: reservoir at its offset, sideburden where the layer is left empty.
std::vector<ColumnPiece> block_column(const Scene& scene,
                                      const std::optional<DepthInterval>& reservoir) {
  const DepthInterval layer = reservoir_range(scene.field);
  const Layer& filled = scene.field.layers[reservoir_index(scene.field)];
  const double reservoir_density = material_named(scene, filled.material).density;
  const double side_density = material_named(scene, scene.field.sideburden).density;
  const std::vector<ColumnPiece> reference = reference_column(scene);
  std::vector<double> cuts = {layer.top, layer.bottom};
  if (reservoir) cuts = {reservoir->top, reservoir->bottom};
  for (const ColumnPiece& piece : reference) cuts.push_back(piece.bottom);
  std::ranges::sort(cuts);
  std::vector<ColumnPiece> column;
  double top = 0;
  for (const double bottom : cuts) {
    const double middle = 0.5 * (top + bottom);
    const auto piece = std::ranges::find_if(
        reference, [&](const ColumnPiece& each) { return middle < each.bottom; });
    double density = piece == reference.end() ? 0.0 : piece->density;
    if (middle > layer.top && middle < layer.bottom) density = side_density;
    if (reservoir && middle > reservoir->top && middle < reservoir->bottom) {
      density = reservoir_density;
    }
    column.push_back({bottom, density});
    top = bottom;
  }
  return column;
}

/// What a block's own overpressure has beyond the column's at that depth, Pa; 0 without one.
double own_excess(const Scene& scene, std::size_t region, double depth, DepthSide side) {
  const std::vector<Block>& blocks = scene.field.blocks;
  if (scene.geometry_kind != GeometryKind::field || region >= blocks.size()) return 0;
  const std::optional<double>& own = blocks[region].overpressure;
  if (!own) return 0;
  const bool is_column = scene.initial.kind == InitialStressKind::column;
  const bool column_has = is_column && reservoir_range(scene.field).holds(depth, side);
  return *own - (column_has ? scene.initial.overpressure : 0);
}

/// p0 at z = 0, Pa: of a column the weight of the sea above it.
double surface_pressure(const InitialState& state) {
  if (state.kind == InitialStressKind::profile) return state.pressure;
  return state.water_density * state.gravity * state.water_depth;
}

/// InitialRegion::source of a field's blocks.
std::string source_of_pressure(const Scene& scene) {
  const FlowLoad& load = scene.pressure_field;
  if (scene.initial.pressure_from == InitialPressure::given || !load.is_given()) return "";
  return "report of " + date_text(load.field->date[static_cast<std::size_t>(load.reference)]);
}

}  // namespace

InitialColumn::InitialColumn(const Scene& scene) : scene_(scene) {
  if (scene.initial.kind == InitialStressKind::column) pieces_ = reference_column(scene);
  if (scene.geometry_kind == GeometryKind::field) reservoir_ = reservoir_range(scene.field);
}

StressAtDepth InitialColumn::one_sided(double depth, DepthSide side) const {
  const InitialState& state = scene_.initial;
  StressAtDepth result;
  double vertical = 0;
  if (state.kind == InitialStressKind::column) {
    depth = std::max(depth, 0.0);
    vertical = -weight(pieces_, state.gravity, depth) - surface_pressure(state);
    result.pressure = state.water_density * state.gravity * depth + surface_pressure(state);
    if (scene_.geometry_kind == GeometryKind::field && reservoir_.holds(depth, side))
      result.pressure += state.overpressure;
  } else {
    vertical = state.vertical_stress + state.vertical_stress_gradient * depth;
    result.pressure = state.pressure + state.pressure_gradient * depth;
  }
  if (state.tensor) {
    result.sigma = *state.tensor;
    return result;
  }
  result.sigma[8] = vertical;
  if (state.viscous_layers == ViscousLayers::lithostatic && is_viscous_at(scene_, depth, side)) {
    result.sigma[0] = result.sigma[4] = vertical;
    return result;
  }
  const double pore = state.initial_biot * result.pressure;
  result.sigma[0] = state.ratio_across * (vertical + pore) - pore;
  result.sigma[4] = state.ratio_along * (vertical + pore) - pore;
  return result;
}

StressAtDepth InitialColumn::at(double z, DepthSide side) const {
  if (side != DepthSide::mean) return one_sided(-z, side);
  const StressAtDepth above = one_sided(-z, DepthSide::above);
  const StressAtDepth below = one_sided(-z, DepthSide::below);
  const bool is_equal = above.pressure == below.pressure && above.sigma == below.sigma;
  if (is_equal) return above;  // (a + a)/2 is a, but say so
  StressAtDepth mean;
  for (std::size_t i = 0; i < 9; ++i) mean.sigma[i] = 0.5 * (above.sigma[i] + below.sigma[i]);
  mean.pressure = 0.5 * (above.pressure + below.pressure);
  return mean;
}

StressAtDepth initial_state(const Scene& scene, double z, DepthSide side) {
  return InitialColumn(scene).at(z, side);
}

double least_stress(const Scene& scene, double depth, DepthSide side) {
  const StressAtDepth at = initial_state(scene, -depth, side);
  const Eigen::Matrix3d sigma =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at.sigma.data());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sigma, Eigen::EigenvaluesOnly);
  return -solver.eigenvalues()[2];
}

DepthInterval depths_of_region(const Scene& scene, std::size_t region) {
  if (scene.geometry_kind == GeometryKind::field)
    return reservoir_range(scene.field, scene.field.blocks[region]);
  const auto [low, high] = bounds_of(scene.box.regions[region]);
  return {-std::min(high[2], scene.box.to[2]), -std::max(low[2], scene.box.from[2])};
}

double region_top(const Scene& scene, std::size_t region) {
  if (scene.geometry_kind == GeometryKind::field) {
    return reservoir_range(scene.field, scene.field.blocks[region]).top;
  }
  const PressureRegion& box = scene.box.regions[region];
  if (box.shape == RegionShape::disc) return -(box.center[2] + 0.5 * box.thickness);
  return -std::min(box.to[2], scene.box.to[2]);
}

double initial_region_pressure(const Scene& scene, std::size_t region, double depth) {
  const InitialState& state = scene.initial;
  const bool is_profile = state.kind == InitialStressKind::profile;
  const double gradient =
      is_profile ? state.pressure_gradient : state.water_density * state.gravity;
  if (is_profile || scene.geometry_kind == GeometryKind::box) {
    return surface_pressure(state) + gradient * depth +
           own_excess(scene, region, depth, DepthSide::below);
  }
  const double top = region_top(scene, region);
  return initial_state(scene, -top, DepthSide::below).pressure +
         own_excess(scene, region, top, DepthSide::below) + gradient * (depth - top);
}

double own_pressure_excess(const Scene& scene, std::size_t region, double z, DepthSide side) {
  if (side != DepthSide::mean) return own_excess(scene, region, -z, side);
  return 0.5 * (own_excess(scene, region, -z, DepthSide::above) +
                own_excess(scene, region, -z, DepthSide::below));
}

std::vector<InitialRegion> initial_regions(const Scene& scene) {
  std::vector<InitialRegion> rows;
  const auto add = [&](const std::string& name, double depth, double excess) {
    const StressAtDepth at = initial_state(scene, -depth);
    rows.push_back({name, depth, at.sigma[8], at.sigma[0], at.sigma[4], at.pressure + excess, ""});
  };
  if (scene.geometry_kind == GeometryKind::field) {
    for (std::size_t i = 0; i < scene.field.blocks.size(); ++i) {
      const Block& block = scene.field.blocks[i];
      const DepthInterval reservoir = reservoir_range(scene.field, block);
      const double depth = 0.5 * (reservoir.top + reservoir.bottom);
      add(block.name, depth, own_pressure_excess(scene, i, -depth));
      rows.back().source = source_of_pressure(scene);
    }
    return rows;
  }
  for (const PressureRegion& region : scene.box.regions) {
    const bool disc = region.shape == RegionShape::disc;
    const double top = std::min(region.to[2], scene.box.to[2]);
    const double base = std::max(region.from[2], scene.box.from[2]);
    add(region.name, disc ? -region.center[2] : -0.5 * (top + base), 0);
  }
  if (!rows.empty()) return rows;
  for (std::size_t i = 0; i < scene.box.patches.size(); ++i) {
    add(scene.faults[i].name, -scene.box.patches[i].center[2], 0);
  }
  return rows;
}

bool has_viscous_layer(const Scene& scene) {
  const std::vector<Layer>& layers = layers_of(scene);
  if (is_meshed(scene)) return has_viscous_material(scene);
  if (layers.empty()) return is_viscous(scene, scene.box.material);
  return std::ranges::any_of(layers,
                             [&](const Layer& layer) { return is_viscous(scene, layer.material); });
}

double neglected_weight_difference(const Scene& scene) {
  const bool has_columns =
      scene.geometry_kind == GeometryKind::field && scene.initial.kind == InitialStressKind::column;
  if (!has_columns) return 0;
  const std::vector<ColumnPiece> reference = reference_column(scene);
  std::vector<std::vector<ColumnPiece>> columns = {block_column(scene, std::nullopt)};
  for (const Block& block : scene.field.blocks) {
    columns.push_back(block_column(scene, reservoir_range(scene.field, block)));
  }
  double largest = 0;
  for (const auto& column : columns) {
    for (const ColumnPiece& piece : column) {  // weights are linear between the cuts
      const double difference = weight(column, scene.initial.gravity, piece.bottom) -
                                weight(reference, scene.initial.gravity, piece.bottom);
      largest = std::max(largest, std::abs(difference));
    }
  }
  return largest;
}

}  // namespace faultsim
