#include "simulator/initial_state/on_fault.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/initial_state.h"

namespace faultsim {
namespace {

/// What blocks beside the fault have of their own, by its rule; 0 without such.
double own_pressure(const Scene& scene, std::size_t fault, double depth, DepthSide side) {
  if (scene.geometry_kind != GeometryKind::field) return 0;
  if (side == DepthSide::mean) {
    return 0.5 * (own_pressure(scene, fault, depth, DepthSide::above) +
                  own_pressure(scene, fault, depth, DepthSide::below));
  }
  const std::vector<Block>& blocks = scene.field.blocks;
  const auto excess = [&](std::size_t block) {
    if (block >= blocks.size()) return 0.0;
    const DepthInterval reservoir = reservoir_range(scene.field, blocks[block]);
    return reservoir.holds(depth, side) ? own_pressure_excess(scene, block, -depth, side) : 0.0;
  };
  const double west = fault > 0 ? excess(fault - 1) : 0.0;
  return pressure_by_rule(scene.faults[fault].pressure, west, excess(fault));
}

/// The depths on a fault between which its initial traction is linear.
std::vector<double> depths_of_kinks(const Scene& scene, std::size_t fault) {
  const DepthInterval reach = depths_of_fault(scene, fault);
  std::vector<double> depths = {reach.top, reach.bottom};
  const auto add = [&](double depth) {
    if (depth > reach.top && depth < reach.bottom) depths.push_back(depth);
  };
  for (const Layer& layer : layers_of(scene)) add(layer.top_depth);
  if (scene.geometry_kind != GeometryKind::field) return depths;
  for (const Block& block : blocks_beside(scene.field, fault)) {
    const DepthInterval reservoir = reservoir_range(scene.field, block);
    add(reservoir.top);
    add(reservoir.bottom);
  }
  return depths;
}

}  // namespace

std::array<double, 3> fault_normal(const Scene& scene, std::size_t fault) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  const double dip =
      is_field ? scene.faults[fault].dip_from_vertical : scene.box.patches[fault].dip_from_vertical;
  const double strike = is_field ? 0 : scene.box.patches[fault].strike;
  const std::array<double, 3> normal = {std::cos(dip) * std::cos(strike),
                                        -std::cos(dip) * std::sin(strike), std::sin(dip)};
  return normal;
}

InitialOnFault initial_on_fault(const Scene& scene, std::size_t fault, double depth,
                                DepthSide side) {
  const std::array<double, 3> normal = fault_normal(scene, fault);
  StressAtDepth at = initial_state(scene, -depth, side);
  at.pressure += own_pressure(scene, fault, depth, side);
  std::array<double, 3> traction = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) traction[i] += at.sigma[3 * i + j] * normal[j];
  InitialOnFault found;
  found.pressure = at.pressure;
  double total = 0, along = 0;
  for (std::size_t i = 0; i < 3; ++i) total += traction[i] * normal[i];
  for (std::size_t i = 0; i < 3; ++i) along += std::pow(traction[i] - total * normal[i], 2);
  found.normal = total + scene.faults[fault].fault_biot * at.pressure;
  found.shear = std::sqrt(along);
  return found;
}

double initial_opening(const Scene& scene, std::size_t fault) {
  constexpr double kRounded = 1;  // Pa
  double largest = 0;
  for (const double depth : depths_of_kinks(scene, fault)) {
    for (const DepthSide side : {DepthSide::above, DepthSide::below})
      largest = std::max(largest, initial_on_fault(scene, fault, depth, side).normal);
  }
  return largest > kRounded ? largest : 0;
}

std::vector<std::size_t> regions_beside(const Scene& scene, std::size_t fault) {
  std::vector<std::size_t> regions;
  if (scene.geometry_kind == GeometryKind::field) {
    for (const Block& block : blocks_beside(scene.field, fault)) {
      for (std::size_t r = 0; r < scene.pressure.size(); ++r)
        if (scene.pressure[r].region == block.name) regions.push_back(r);
    }
    return regions;
  }
  for (std::size_t r = 0; r < scene.pressure.size(); ++r) regions.push_back(r);
  return regions;
}

}  // namespace faultsim
