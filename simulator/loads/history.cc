#include "simulator/loads/history.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/initial_state/pressure_history.h"

namespace faultsim {
namespace {

/// What a fault's rule makes of the values of the regions beside a node: per pair of neighbouring
/// cells, then the mean over their areas.
double mean_by_rule(const FaultPressure& law, const OperatorNode& node,
                    const std::vector<int>& region_of_load, const std::vector<double>& per_region) {
  const auto beside = [&](int load, double fraction) {
    return load < 0 ? 0 : fraction * per_region[region_of_load[load]];
  };
  double mean = 0;
  for (const PressurePair& pair : node.pressure) {
    if (pair.minus_region < 0 && pair.plus_region < 0) continue;  // every rule of 0 and 0 is 0
    mean += pair.weight * pressure_by_rule(law, beside(pair.minus_region, pair.minus_fraction),
                                           beside(pair.plus_region, pair.plus_fraction));
  }
  return mean;
}

/// e of every block at a height, (10a). At an edge it is that within the block: the weights of
/// pairs leave out already what of a node lies beside it.
std::vector<double> own_excess_within(const Scene& scene, double z) {
  constexpr double kInside = 2e-6;  // m, beyond what meshes take for one line
  std::vector<double> excess;
  for (std::size_t r = 0; r < scene.pressure.size(); ++r) {
    const DepthSide side = depths_of_region(scene, r).inner_side(-z);
    const double down = side == DepthSide::below   ? kInside
                        : side == DepthSide::above ? -kInside
                                                   : 0;
    excess.push_back(own_pressure_excess(scene, r, z - down, side));
  }
  return excess;
}

bool in_window(const FaultPressure& law, const OperatorNode& node, const PressurePair& pair) {
  if (!law.depth_window) {
    return pair.minus_fraction > 0 || pair.plus_fraction > 0;
  }
  const double depth = -node.position.z();
  return depth >= (*law.depth_window)[0] && depth <= (*law.depth_window)[1];
}

}  // namespace

std::vector<LoadStep> load_steps(const Scene& scene) {
  std::vector<LoadStep> steps{{0, "initial", 0}};
  for (const StepEnd& end : step_ends(scene)) {
    steps.push_back({static_cast<int>(steps.size()), scene.stages[end.stage].name, end.time});
  }
  return steps;
}

bool is_stage_end(const std::vector<LoadStep>& steps, std::size_t i) {
  FAULTSIM_DEMAND(i < steps.size(), i, " of ", steps.size());
  return i + 1 == steps.size() || steps[i + 1].stage != steps[i].stage;
}

std::vector<double> pressure_changes(const Scene& scene, double time) {
  std::vector<double> changes;
  changes.reserve(scene.pressure.size());
  for (const PressureHistory& history : scene.pressure)
    changes.push_back(pressure_change_at(history, time));
  return changes;
}

std::vector<double> temperature_changes(const Scene& scene, double time) {
  std::vector<double> changes(scene.pressure.size(), 0);
  for (const TemperatureHistory& history : scene.temperature) {
    if (time >= history.time.front())
      changes[static_cast<std::size_t>(history.region)] =
          value_at(history.time, history.change, time);
  }
  return changes;
}

LoadFactors::LoadFactors(const Scene& scene, const FaultOperator& op)
    : scene_(scene), keys_(op.loads.keys) {
  const auto demand = [](const LoadKey& key, int number, std::size_t size) {
    FAULTSIM_DEMAND(number >= 0 && static_cast<std::size_t>(number) < size, "load ",
                    to_string(key));
  };
  for (const LoadKey& key : keys_) {
    const bool pressure = key.kind == LoadKey::Kind::pressure;
    if (pressure) demand(key, key.material, scene.materials.size());
    demand(key, key.index, pressure ? scene.pressure.size() : scene.box.boundary.size());
    region_of_load_.push_back(pressure ? key.index : -1);
  }
}

std::vector<double> LoadFactors::at(double time, const std::vector<double>& pressure_change) const {
  const std::vector<double> temperature_change = temperature_changes(scene_, time);
  std::vector<double> factors;
  for (const LoadKey& key : keys_) {
    if (key.kind == LoadKey::Kind::boundary) {
      factors.push_back(factor_at(scene_.box.boundary[key.index].table, time));
      continue;
    }
    const Material& material = scene_.materials[key.material];
    double stress = material.biot * pressure_change[key.index];
    if (temperature_change[key.index] != 0)
      stress += thermal_stress(material) * temperature_change[key.index];
    factors.push_back(stress);
  }
  return factors;
}

std::vector<SideRegions> side_regions(const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load) {
  std::vector<SideRegions> sides(geometry.nodes.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    double most_minus = 0, most_plus = 0;
    for (const PressurePair& pair : geometry.nodes[k].pressure) {
      const double minus = pair.weight * pair.minus_fraction;
      const double plus = pair.weight * pair.plus_fraction;
      if (pair.minus_region >= 0 && minus > most_minus) {
        most_minus = minus;
        sides[k].minus = region_of_load[static_cast<std::size_t>(pair.minus_region)];
      }
      if (pair.plus_region >= 0 && plus > most_plus) {
        most_plus = plus;
        sides[k].plus = region_of_load[static_cast<std::size_t>(pair.plus_region)];
      }
    }
  }
  return sides;
}

bool prescribed_pressure_acts(const Scene& scene, const FaultGeometry& geometry,
                              std::size_t fault) {
  const FaultPressure& law = scene.faults[fault].pressure;
  const OperatorFault& grid = geometry.faults[fault];
  for (int k = grid.first_node; k < grid.first_node + grid.n_nodes; ++k) {
    const OperatorNode& node = geometry.nodes[k];
    for (const PressurePair& pair : node.pressure) {
      if (in_window(law, node, pair)) return true;
    }
  }
  return false;
}

Eigen::VectorXd initial_pressure_excess(const Scene& scene, const FaultGeometry& geometry,
                                        const std::vector<int>& region_of_load) {
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(geometry.nodes.size()));
  const std::vector<Block>& blocks = scene.field.blocks;
  if (std::ranges::none_of(blocks,
                           [](const Block& block) { return block.overpressure.has_value(); }))
    return excess;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const FaultPressure& law = scene.faults[f].pressure;
    const OperatorFault& fault = geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      excess[k] =
          mean_by_rule(law, node, region_of_load, own_excess_within(scene, node.position.z()));
    }
  }
  return excess;
}

TablePlace place_in_table(const Scene& scene, std::size_t fault, const OperatorNode& node) {
  const bool by_depth =
      scene.faults[fault].pressure.profile.place == FaultPressureTable::Place::depth;
  TablePlace place{-node.position.z(), node.position.y()};
  if (scene.geometry_kind == GeometryKind::field) return place;
  const PatchGeometry& patch = scene.box.patches[fault];
  const double s = std::sin(patch.strike), c = std::cos(patch.strike);
  const double dip = patch.dip_from_vertical;
  const Eigen::Vector3d down(c * std::sin(dip), -s * std::sin(dip), -std::cos(dip));
  const Eigen::Vector3d from =
      node.position - Eigen::Vector3d(patch.center[0], patch.center[1], patch.center[2]);
  place.strike = from.dot(Eigen::Vector3d(s, c, 0));
  if (!by_depth) place.dip = from.dot(down);
  return place;
}

Eigen::VectorXd fault_pressure_change(const Scene& scene, const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load, double time,
                                      const std::vector<double>& pressure_change) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(geometry.nodes.size()));
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const FaultPressure& law = scene.faults[f].pressure;
    const bool prescribed = law.rule == FaultPressureRule::prescribed;
    const double given = prescribed ? prescribed_pressure_change(scene, law, time) : 0;
    const OperatorFault& fault = geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      if (law.rule == FaultPressureRule::table) {
        const TablePlace at = place_in_table(scene, f, node);
        change[k] = table_pressure(law.profile, at.dip, at.strike, time);
      } else if (prescribed) {
        for (const PressurePair& pair : node.pressure) {
          if (in_window(law, node, pair)) change[k] += pair.weight * given;
        }
      } else {
        change[k] = mean_by_rule(law, node, region_of_load, pressure_change);
      }
    }
  }
  return change;
}

}  // namespace faultsim
