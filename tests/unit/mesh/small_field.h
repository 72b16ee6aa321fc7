#pragma once

#include "simulator/mesh/mesh_spec.h"

namespace faultsim::testing_mesh {

inline constexpr int kSideburden = 4;

/// Two blocks of 2 km, the east one 50 m lower, in few cells.
inline FieldMeshSpec small_field() {
  FieldMeshSpec spec;
  spec.width = 20e3, spec.length = 20e3, spec.depth = 5e3;
  spec.layers = {{"", "", 0}, {"", "", 1500}, {"reservoir", "", 2000}, {"", "", 2200}};
  spec.layer_materials = {0, 1, 2, 3};
  spec.reservoir_layer = "reservoir";
  spec.sideburden_material = kSideburden;
  spec.blocks = {{"west", -2000, 0, 0}, {"east", 0, 2000, 50}};
  spec.block_length = 2000, spec.fault_length = 2400;
  spec.fault_overshoot = 150, spec.pivot_depth = 2100;
  spec.fault_names = {"F1", "F2", "F3"};
  spec.fault_dips = {0, 0, 0};
  spec.sizes = {.strike = 400, .dip = 60, .normal = 200, .growth = 1.8};
  return spec;
}

}  // namespace faultsim::testing_mesh
