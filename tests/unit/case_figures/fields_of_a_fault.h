#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "simulator/result_files/field_writer.h"
#include "tests/unit/case_figures/small_case.h"

namespace faultsim {

/// A fault of two faces down dip in plane strain, written as a run writes it.
class FieldsOfAFault : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void SetUp() override {
    std::string name = testing::TempDir() + "case_figures_XXXXXX";
    folder_ = mkdtemp(name.data());
    FaultGeometry geometry;
    geometry.plane_strain = true;
    OperatorFault fault;
    fault.name = "F2";
    for (int k = 0; k < 3; ++k) {
      OperatorNode node;
      node.position = {0, 0.5, -2000.0 - 50 * k};
      node.normal = {1, 0, 0};
      node.strike = {0, 1, 0};
      node.dip = {0, 0, -1};
      node.area = 50;
      geometry.nodes.push_back(node);
      fault.points.push_back(node.position);
      fault.node_of_point.push_back(k);
    }
    fault.faces = {{0, 1, 1, 0}, {1, 2, 2, 1}};
    fault.n_nodes = 3;
    geometry.faults = {fault};
    FieldWriter writer(folder_, geometry);
    for (const StepResult& step : small_result().steps) writer.add_step(step, fields(step.step));
    writer.finish();
  }
  static FaultFields fields(int step) {
    FaultFields fields;
    fields.traction = Eigen::Matrix3Xd::Zero(3, 3);
    fields.traction.row(0).setConstant(-2e7);
    fields.traction(2, 1) = 3e6 * step;
    fields.jump = Eigen::Matrix3Xd::Zero(3, 3);
    fields.jump(2, 1) = 0.01 * step;
    fields.critical_index = Eigen::Vector3d(0.1 * step, 0.4 * step, 0);
    fields.static_critical_index = fields.critical_index;
    fields.state = Eigen::Vector3i(0, step, 0);
    fields.fault_pressure_change = Eigen::Vector3d::Constant(-1e6 * step);
    return fields;
  }
  std::filesystem::path folder_;
};

}  // namespace faultsim
