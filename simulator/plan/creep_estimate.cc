#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "simulator/common/ranges.h"
#include "simulator/flow/flow_field.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/initial_state/on_fault.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/plan/creep_plan.h"

namespace faultsim {
namespace {

/// The largest of some non-negative numbers, 0 of none.
template <typename List, typename Number>
double largest_of(const List& list, const Number& number) {
  double largest = 0;
  for (const auto& one : list) largest = std::max(largest, number(one));
  return largest;
}

double magnitude(double value) { return std::abs(value); }

/// Largest |factor| of a table.
double largest_factor(const TimeTable& table) {
  return table.factor.empty() ? 1 : largest_of(table.factor, magnitude);
}

/// Frobenius norm.
double norm(const std::array<double, 9>& tensor) {
  double sum = 0;
  for (const double component : tensor) sum += component * component;
  return std::sqrt(sum);
}

/// Largest |Δp| of a region within the history, which is linear between its points.
double largest_pressure_change(const PressureHistory& history, double duration) {
  const double turning = largest_of(history.time, [&](double time) {
    return std::abs(pressure_change_at(history, std::min(time + history.lag, duration)));
  });
  return std::max(turning, std::abs(pressure_change_at(history, duration)));
}

/// Largest change of a flow result's values among the reports that are taken.
double largest_field_change(const FlowLoad& load) {
  return largest_of(load.reports, [&](int report) {
    const auto change = load.field->value.col(report) - load.field->value.col(load.reference);
    return change.cwiseAbs().maxCoeff();
  });
}

/// Largest |Δp_f| that a fault is given rather than takes from its sides, wherever and whenever.
double largest_given_change(const FaultPressure& law) {
  if (law.rule == FaultPressureRule::table) return largest_of(law.profile.change, magnitude);
  if (law.rule != FaultPressureRule::prescribed) return 0;
  return std::abs(law.prescribed) * largest_factor(law.table);
}

double largest_pressure_change(const Scene& scene, double duration) {
  return std::max({largest_field_change(scene.pressure_field),
                   largest_of(scene.pressure,
                              [&](const PressureHistory& history) {
                                return largest_pressure_change(history, duration);
                              }),
                   largest_of(scene.faults, [](const Fault& fault) {
                     return largest_given_change(fault.pressure);
                   })});
}

/// Largest stress that heating or cooling brings, Pa.
double largest_thermal_stress(const Scene& scene) {
  const double by_regions = largest_of(scene.temperature, [](const TemperatureHistory& history) {
    return largest_of(history.change, magnitude);
  });
  return largest_of(used_materials(scene), thermal_stress) *
         std::max(largest_field_change(scene.temperature_field), by_regions);
}

double largest_stress_change(const Scene& scene) {
  return largest_of(scene.stages, [](const Stage& stage) {
    return stage.stress_change ? norm(*stage.stress_change) : 0;
  });
}

double shear_modulus(const Material& material) {
  return material.youngs_modulus / (2 * (1 + material.poisson_ratio));
}

/// E (1 − ν)/((1 + ν)(1 − 2ν)) of the stiffest material in use, Pa.
double largest_confined_modulus(const Scene& scene) {
  return largest_of(used_materials(scene), [](const Material& material) {
    const double nu = material.poisson_ratio;
    return material.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  });
}

/// Strain that a displaced face brings: its gradient, or its largest displacement over the
/// smallest extent of the box where a gradient about a distant origin amounts to a translation.
double boundary_strain(const BoxGeometry& box, const BoundaryCondition& condition) {
  std::array<double, 9> gradient = condition.gradient;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!condition.components[i]) std::fill_n(gradient.begin() + 3 * static_cast<long>(i), 3, 0.0);
  }
  double largest = 0;  // |u|², an affine displacement is largest at a corner
  for (unsigned corner = 0; corner < 8; ++corner) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double u = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        u += gradient[3 * i + j] * ((corner >> j & 1U) != 0 ? box.to[j] : box.from[j]);
      }
      square += u * u;
    }
    largest = std::max(largest, square);
  }
  double extent = box.to[0] - box.from[0];
  for (std::size_t j = 1; j < 3; ++j) extent = std::min(extent, box.to[j] - box.from[j]);
  return std::max(norm(gradient), std::sqrt(largest) / extent) * largest_factor(condition.table);
}

bool is_translated(const BoundaryCondition& condition) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (condition.components[i] && condition.translation[i] != 0) return true;
  }
  return false;
}

/// Stress that the faces of a box bring; nothing where one is translated: against what it would
/// push is not known here.
std::optional<double> boundary_stress(const Scene& scene) {
  double stress = 0, strain = 0;
  for (const BoundaryCondition& condition : scene.box.boundary) {
    if (condition.kind == BoundaryKind::stress) {
      stress = std::max(stress, norm(condition.stress) * largest_factor(condition.table));
    } else if (condition.kind == BoundaryKind::displacement) {
      if (is_translated(condition)) return std::nullopt;
      strain = std::max(strain, boundary_strain(scene.box, condition));
    }
  }
  return stress + (strain > 0 ? strain * largest_confined_modulus(scene) : 0);
}

/// At least the largest shear stress on any plane: |s|/√2 of the deviator s.
double shear_stress(std::array<double, 9> sigma) {
  const double mean = (sigma[0] + sigma[4] + sigma[8]) / 3;
  for (const std::size_t i : {0, 4, 8}) sigma[i] -= mean;
  return norm(sigma) / std::sqrt(2.0);
}

/// Largest initial shear stress in the model, which slip may release. Between the depths where
/// something changes the initial stress is linear.
double largest_initial_shear(const Scene& scene) {
  if (scene.faults.empty()) return 0;
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  std::vector<double> depths;
  for (const Layer& layer : layers_of(scene)) depths.push_back(layer.top_depth);
  if (depths.empty()) depths.push_back(-scene.box.to[2]);
  depths.push_back(is_field ? scene.field.depth : -scene.box.from[2]);
  double largest = 0;
  for (const double depth : depths) {
    for (const DepthSide side : {DepthSide::above, DepthSide::below}) {
      largest = std::max(largest, shear_stress(initial_state(scene, -depth, side).sigma));
    }
  }
  return largest;
}

/// Largest initial traction that opens a fault.
double largest_initial_opening(const Scene& scene) {
  double largest = 0;
  for (std::size_t fault = 0; fault < scene.faults.size(); ++fault)
    largest = std::max(largest, initial_opening(scene, fault));
  return largest;
}

double shortest_relaxation_time(const Scene& scene) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Material& material : used_materials(scene)) {
    if (material.viscosity)
      shortest = std::min(shortest, *material.viscosity / shear_modulus(material));
  }
  return shortest;
}

}  // namespace

CreepEstimate estimate_creep(const Scene& scene) {
  CreepEstimate estimate;
  estimate.relaxation_time = shortest_relaxation_time(scene);
  estimate.duration = end_time(scene);
  estimate.relaxed_share = -std::expm1(-estimate.duration / estimate.relaxation_time);
  const bool is_box = scene.geometry_kind == GeometryKind::box;
  const std::optional<double> boundary = is_box ? boundary_stress(scene) : 0;
  if (!boundary) return estimate;
  estimate.stress = largest_pressure_change(scene, estimate.duration) +
                    largest_thermal_stress(scene) + largest_stress_change(scene) + *boundary +
                    largest_initial_shear(scene) + largest_initial_opening(scene);
  estimate.bound = kCreepConcentration * *estimate.stress * estimate.relaxed_share;
  return estimate;
}

}  // namespace faultsim
