#include "simulator/loads/field_history.h"

#include "simulator/common/errors.h"
#include "simulator/initial_state/pressure_history.h"

namespace faultsim {

Eigen::VectorXd at_time(const std::vector<double>& time, const Eigen::MatrixXd& table, double at) {
  FAULTSIM_DEMAND(!time.empty() && std::ssize(time) == table.cols(), time.size(), " reports");
  const auto [first, second, share] = between(time, at);
  if (first == second) return table.col(first);
  return table.col(first) + share * (table.col(second) - table.col(first));
}

void FieldHistory::add(double at, StepLoads& loads) const {
  const Eigen::VectorXd by_cells = at_time(time, locked, at);
  loads.locked += by_cells;
  if (has_forces()) loads.locked_by_forces = by_cells;
  loads.fault_pressure_change += at_time(time, fault_pressure, at);
  const Eigen::VectorXd regions = at_time(time, region_change, at);
  for (std::size_t r = 0; r < loads.pressure_change.size(); ++r)
    loads.pressure_change[r] += regions[static_cast<Eigen::Index>(r)];
  if (region_heating.size() > 0) {
    const Eigen::VectorXd heating = at_time(time, region_heating, at);
    for (std::size_t r = 0; r < loads.temperature_change.size(); ++r)
      loads.temperature_change[r] += heating[static_cast<Eigen::Index>(r)];
  }
  if (observed.size() > 0) loads.observed = at_time(time, observed, at);
  loads.beside.resize(beside_minus.rows(), 2);
  loads.beside.col(0) = at_time(time, beside_minus, at);
  loads.beside.col(1) = at_time(time, beside_plus, at);
}

void FieldHistory::add_forces(double at, Eigen::VectorXd& forces) const {
  const Eigen::VectorXd cells = at_time(time, stress, at);
  for (std::size_t c = 0; c < cell_forces.size(); ++c) {
    for (const auto& [unknown, force] : cell_forces[c])
      forces[unknown] += cells[static_cast<Eigen::Index>(c)] * force;
  }
}

}  // namespace faultsim
