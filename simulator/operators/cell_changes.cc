#include "simulator/operators/cell_changes.h"

#include "simulator/loads/field_history.h"
#include "simulator/loads/history.h"
#include "simulator/operators/mapped_load.h"

namespace faultsim {

CellChanges::CellChanges(const Scene& scene, const Mesh& mesh, bool half_domain)
    : scene_(scene), mesh_(mesh) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.region[c] >= 0) cells_.push_back(static_cast<int>(c));
  }
  pressure_ = mapped_onto_cells(scene.pressure_field, half_domain);
  temperature_ = mapped_onto_cells(scene.temperature_field, half_domain);
}

CellChanges::OfCells CellChanges::mapped_onto_cells(const FlowLoad& load, bool half_domain) const {
  if (!load.is_given()) return {};
  std::vector<CellOfRegion> cells;
  for (const int cell : cells_)
    cells.push_back({cell, mesh_.region[cell], mesh_.region_fraction[cell]});
  return {&load, map_load(load, mesh_, cells, region_names(scene_), half_domain).change};
}

Eigen::VectorXd CellChanges::all_cells(const OfCells& field, double time) const {
  const Eigen::VectorXd there = at_time(field.load->time, field.change, time);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(std::ssize(mesh_.cells));
  for (std::size_t i = 0; i < cells_.size(); ++i)
    all[cells_[i]] = there[static_cast<Eigen::Index>(i)];
  return all;
}

Eigen::VectorXd CellChanges::of_regions(const std::vector<double>& change) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(std::ssize(mesh_.cells));
  for (const int cell : cells_) all[cell] = change[mesh_.region[cell]];
  return all;
}

Eigen::VectorXd CellChanges::pressure(double time) const {
  return pressure_.load != nullptr ? all_cells(pressure_, time)
                                   : of_regions(pressure_changes(scene_, time));
}

Eigen::VectorXd CellChanges::temperature(double time) const {
  return temperature_.load != nullptr ? all_cells(temperature_, time)
                                      : of_regions(temperature_changes(scene_, time));
}

bool CellChanges::has_pressure() const { return !cells_.empty(); }

bool CellChanges::has_temperature() const { return scene_.has_temperatures(); }

}  // namespace faultsim
