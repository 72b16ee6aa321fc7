#include "simulator/operators/cell_changes.h"

#include "simulator/loads/field_history.h"
#include "simulator/loads/history.h"
#include "simulator/plan/field_bodies.h"

namespace faultsim {

CellChanges::CellChanges(const Scene& scene, const Mesh& mesh) : scene_(scene), mesh_(mesh) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.region[c] >= 0) cells_.push_back(static_cast<int>(c));
  }
  pressure_ = mapped_onto_cells(scene.pressure_field);
  temperature_ = mapped_onto_cells(scene.temperature_field);
}

CellChanges::OfCells CellChanges::mapped_onto_cells(const FlowLoad& load) const {
  if (!load.is_given()) return {};
  std::vector<MappedCell> bodies;
  for (const int cell : cells_) {
    MappedCell body{.corners = corners_of_cell(mesh_, cell),
                    .region = mesh_.region[cell],
                    .fraction = mesh_.region_fraction[cell]};
    if (mesh_.plane_strain) body.corners = at_section(body.corners, load.y);
    bodies.push_back(body);
  }
  const FlowMapping mapping =
      map_flow(*field_in_scene(load), bodies, region_names(scene_), load.outside);
  return {&load, mapped_change(mapping, *load.field, load.reference, load.reports)};
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
