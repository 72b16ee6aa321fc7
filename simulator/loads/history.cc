#include "simulator/loads/history.h"

#include <algorithm>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/loads/fault_pressure_table.h"

namespace faultsim {
namespace {

/// Piecewise linear through (x, y), constant beyond the last point; before the first: `before`.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at,
                   double before) {
  if (at < x.front()) return before;
  if (at >= x.back()) return y.back();
  const auto next = std::ranges::upper_bound(x, at) - x.begin();
  const auto i = static_cast<std::size_t>(next);
  const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + share * (y[i] - y[i - 1]);
}

double history_value(const PressureHistory& history, double time) {
  if (history.time.empty() || time <= 0) return 0;
  if (time < history.time.front()) {  // the history starts from 0 at t = 0
    return history.pressure_change.front() * time / history.time.front();
  }
  return interpolate(history.time, history.pressure_change, time, 0);
}

/// Of one region's value beside a node: its share, 0 where there is none.
double share_of(const std::vector<int>& region_of_load, const std::vector<double>& per_region,
                int load, double fraction) {
  if (load < 0) return 0;
  const int region = region_of_load[load];
  return fraction * per_region[region];
}

bool has_region(const PressurePair& pair) {
  return pair.minus_region >= 0 || pair.plus_region >= 0;
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
  return mapped(scene.pressure, [&](const PressureHistory& history) {
    return history.scale * history_value(history, time - history.lag);
  });
}

std::vector<double> temperature_changes(const Scene& scene, double time) {
  std::vector<double> changes(scene.pressure.size(), 0);
  for (const TemperatureHistory& history : scene.temperature)
    changes[static_cast<std::size_t>(history.region)] =
        interpolate(history.time, history.change, time, 0);
  return changes;
}

double table_value(const TimeTable& table, double time) {
  if (table.time.empty()) return 1;
  return interpolate(table.time, table.factor, time, table.factor.front());
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
      factors.push_back(table_value(scene_.box.boundary[key.index].table, time));
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
  std::vector<double> per_region(scene.pressure.size());
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const FaultPressure& law = scene.faults[f].pressure;
    const OperatorFault& fault = geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      if (std::ranges::none_of(node.pressure, has_region)) continue;
      for (std::size_t r = 0; r < per_region.size(); ++r) {
        per_region[r] = own_pressure_excess(scene, r, node.position.z());
      }
      for (const PressurePair& pair : node.pressure) {
        excess[k] +=
            pair.weight *
            pressure_by_rule(
                law, share_of(region_of_load, per_region, pair.minus_region, pair.minus_fraction),
                share_of(region_of_load, per_region, pair.plus_region, pair.plus_fraction));
      }
    }
  }
  return excess;
}

Eigen::VectorXd fault_pressure_change(const Scene& scene, const FaultGeometry& geometry,
                                      const std::vector<int>& region_of_load, double time,
                                      const std::vector<double>& pressure_change) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(geometry.nodes.size()));
  const auto cell_change = [&](int load, double fraction) {
    return share_of(region_of_load, pressure_change, load, fraction);
  };
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const FaultPressure& law = scene.faults[f].pressure;
    if (law.rule == FaultPressureRule::none) continue;
    const bool prescribed = law.rule == FaultPressureRule::prescribed;
    const double given = prescribed ? prescribed_pressure_change(scene, law, time) : 0;
    const OperatorFault& fault = geometry.faults[f];
    if (law.rule == FaultPressureRule::table) {
      for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
        const TablePlace at = place_in_table(scene, f, geometry.nodes[k]);
        change[k] = table_pressure(law.profile, at.dip, at.strike, time);
      }
      continue;
    }
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const OperatorNode& node = geometry.nodes[k];
      double sum = 0;
      for (const PressurePair& pair : node.pressure) {
        if (!prescribed && !has_region(pair)) continue;  // every rule of 0 and 0 is 0
        const double value =
            prescribed ? (in_window(law, node, pair) ? given : 0.0)
                       : pressure_by_rule(law, cell_change(pair.minus_region, pair.minus_fraction),
                                          cell_change(pair.plus_region, pair.plus_fraction));
        sum += pair.weight * value;
      }
      change[k] = sum;
    }
  }
  return change;
}

}  // namespace faultsim
