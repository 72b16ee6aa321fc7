#include "simulator/result_files/field_recorder.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

StoredFault surface_of(const std::string& name, const FaultPoints& points) {
  StoredFault fault;
  fault.name = name;
  fault.split = points.split;
  fault.points = Eigen::Map<const Eigen::Matrix3Xd>(
      points.position.data(), 3, static_cast<Eigen::Index>(points.position.size() / 3));
  for (auto first = points.cells.begin(); first != points.cells.end();) {
    const auto end = first + static_cast<std::ptrdiff_t>(points.points_per_cell);
    fault.faces.emplace_back(first, end);
    first = end;
  }
  return fault;
}

}  // namespace

FieldRecorder::FieldRecorder(const FaultGeometry& geometry) {
  for (const OperatorFault& fault : geometry.faults) {
    FaultPoints points = collect_points(fault, geometry);
    if (points.cells.empty()) continue;  // nothing to draw
    faults_.push_back(surface_of(fault.name, points));
    points_.push_back(std::move(points));
  }
}

void FieldRecorder::add_step(const StepResult& step, const FaultFields& fields) {
  steps_.push_back(step.step);
  times_.push_back(step.time);
  kept_.push_back(fields);
}

StoredFields FieldRecorder::fields(std::size_t fault, std::size_t entry) const {
  FAULTSIM_DEMAND(fault < points_.size() && entry < kept_.size(), fault, " ", entry);
  const FaultPoints& points = points_[fault];
  const FaultFields& all = kept_[entry];
  const auto n = static_cast<Eigen::Index>(points.source.size());
  StoredFields here{
      .traction = Eigen::Matrix3Xd::Zero(3, n),
      .slip = Eigen::Matrix3Xd::Zero(3, n),
      .critical_index = Eigen::VectorXd::Zero(n),
      .fault_pressure_change = Eigen::VectorXd::Zero(n),
      .state = std::vector<int>(points.source.size(), static_cast<int>(FaultState::stick))};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int k = points.source[at];
    if (k < 0) continue;
    const bool mirrored = points.mirrored[at] != 0;
    here.traction.col(i) = as_seen(all.traction.col(k), mirrored);
    here.critical_index[i] = all.critical_index[k];
    here.fault_pressure_change[i] = all.fault_pressure_change[k];
    if (points.split[at] == 0) continue;
    here.slip.col(i) = as_seen(all.jump.col(k), mirrored);
    here.state[at] = all.state[k];
  }
  return here;
}

Eigen::VectorXd FieldRecorder::critical_index(std::size_t fault, std::size_t entry) const {
  FAULTSIM_DEMAND(fault < points_.size() && entry < kept_.size(), fault, " ", entry);
  const std::vector<int>& source = points_[fault].source;
  Eigen::VectorXd chi = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(source.size()));
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source[i] >= 0) chi[static_cast<Eigen::Index>(i)] = kept_[entry].critical_index[source[i]];
  }
  return chi;
}

}  // namespace faultsim
