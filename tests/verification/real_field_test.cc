// A field that is not ours, from its grid without handwork: FAULTSIM_REAL_FIELD names an EGRID with
// its reports beside it. Nothing here knows which field it is, and no operator is made.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "simulator/app/commands.h"
#include "simulator/corner_point/corner_point_grid.h"
#include "simulator/corner_point/grid_structure.h"
#include "simulator/operators/cell_changes.h"
#include "simulator/plan/field_check.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/files/scratch_folder.h"

namespace faultsim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Of the surface of a flow cell: twelve triangles, the diagonals of its faces through corner 0
/// or 6.
double volume_inside(const CellCorners& c) {
  constexpr int kTriangles[12][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4},
                                     {0, 4, 7}, {0, 7, 3}, {6, 1, 2}, {6, 5, 1},
                                     {6, 4, 5}, {6, 7, 4}, {6, 3, 7}, {6, 2, 3}};
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& corner : c) middle += corner / 8;
  double sum = 0;
  for (const auto& t : kTriangles) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = c[static_cast<std::size_t>(t[k])] - middle;
    sum += edges.determinant() / 6;
  }
  return std::abs(sum);
}

double distance_to(const std::vector<std::array<double, 2>>& line, const Vector2d& at) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vector2d a(line[k].data()), way = Vector2d(line[k + 1].data()) - a;
    const double share = std::clamp((at - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + share * way - at).norm());
  }
  return least;
}

class RealField : public testing::Test {
 protected:
  void SetUp() override {
    const char* const file = std::getenv("FAULTSIM_REAL_FIELD");
    if (file == nullptr) GTEST_SKIP() << "FAULTSIM_REAL_FIELD names no EGRID";
    grid_ = file;
    FromGridArguments arguments;
    arguments.grid = grid_;
    arguments.output = folder_.path() / "field.json";
    ASSERT_EQ(init_from_grid_command(arguments), ExitCode::done);
    document_ = read_json_file(arguments.output);
    scene_ = read_scene(document_);
    std::vector<Problem> problems;
    plan_ = make_plan(scene_, problems);
    ASSERT_TRUE(problems.empty());
  }

  ScratchFolder folder_;
  std::filesystem::path grid_;
  JsonDocument document_;
  Scene scene_;
  Plan plan_;
};

TEST_F(RealField, KeepsTheIntegralOfItsPressuresAtEachReport) {
  const Mesh mesh = scene_mesh(scene_, plan_);
  const CellChanges changes(scene_, mesh, plan_.half_domain);
  const FlowLoad& load = scene_.pressure_field;
  Eigen::VectorXd part = Eigen::VectorXd::Zero(std::ssize(mesh.cells));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) = mesh.nodes[nodes[static_cast<std::size_t>(k) + 1]] - mesh.nodes[nodes[0]];
    if (mesh.region[c] >= 0)
      part[static_cast<Eigen::Index>(c)] =
          mesh.region_fraction[c] * std::abs(edges.determinant()) / 6;
  }
  Eigen::VectorXd volume(load.field->value.rows());
  for (std::size_t f = 0; f < load.field->cells.size(); ++f) {
    const FlowCell& cell = load.field->cells[f];
    volume[static_cast<Eigen::Index>(f)] =
        cell.corners ? volume_inside(*cell.corners) : (cell.high - cell.low).prod();
  }
  double worst = 0;
  for (std::size_t t = 0; t < load.time.size(); ++t) {
    const Eigen::VectorXd change =
        load.field->value.col(load.reports[t]) - load.field->value.col(load.reference);
    const double whole = volume.dot(change), size = volume.dot(change.cwiseAbs());
    const double acts = part.dot(changes.pressure(load.time[t]));
    EXPECT_NEAR(acts, whole, 1e-12 * size) << t;
    if (size > 0) worst = std::max(worst, std::abs(acts - whole) / size);
  }
  std::cout << load.time.size() << " reports, " << load.field->cells.size() << " flow cells, "
            << mesh.cells.size() << " cells: the integral of the change is off by " << worst
            << " of that of its size at most; volumes " << part.sum() << " of " << volume.sum()
            << " m3\n";
  for (const std::string& note : check_fields(scene_, plan_).notes) std::cout << note << "\n";
}

/// The middles of a fault's pillar edges lie within half a cell of the trace in the scene.
TEST_F(RealField, HasItsFaultsWithinHalfACell) {
  const corner_point::GridStructure structure =
      recognise_structure(corner_point::read_corner_point_grid(grid_), {});
  int n_faults = 0;
  for (const corner_point::Fault& fault : structure.faults) {
    double largest = 0;
    for (std::size_t e = 0; e + 1 < fault.pillars.size(); ++e) {
      const Vector2d middle = (fault.pillars[e] + fault.pillars[e + 1]) / 2;
      double least = HUGE_VAL;
      for (const auto& drawn : document_.value["faults"]) {
        std::vector<std::array<double, 2>> line;
        for (const auto& at : drawn["trace"])
          line.push_back(
              {std::stod(at[0].get<std::string>()), std::stod(at[1].get<std::string>())});
        least = std::min(least, distance_to(line, middle));
      }
      largest = std::max(largest, least);
    }
    std::cout << "fault of " << fault.edges.size() << " edges: " << largest << " m of cells of "
              << fault.cell << " m\n";
    EXPECT_LE(largest, fault.cell / 2);
    ++n_faults;
  }
  EXPECT_GT(n_faults, 0);
}

}  // namespace
}  // namespace faultsim
