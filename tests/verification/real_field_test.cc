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
#include "simulator/corner_point/column_map.h"
#include "simulator/corner_point/corner_point_grid.h"
#include "simulator/corner_point/grid_structure.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/horizons/levels.h"
#include "simulator/horizons/traces.h"
#include "simulator/operators/cell_changes.h"
#include "simulator/plan/field_check.h"
#include "simulator/reading/read_layered_body.h"
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

/// Throw along one fault: its place along the trace, m, and how much deeper the top is to the
/// right.
struct ThrowAt {
  double along;
  double down;
};

/// Of the model: between both sides of each pillar of its trace, without its ends.
std::vector<ThrowAt> throws_of(const horizons::LayeredBody& body, int fault, std::size_t horizon) {
  std::vector<Problem> problems;
  const horizons::MapLines lines = horizons::meeting_lines(body, problems);
  const horizons::MapMesh map = horizons::mesh_map(body, lines, problems);
  const std::vector<horizons::MapSide> sides = horizons::sides_of(map.triangles);
  const horizons::CutMap cut = horizons::cut_map(map);
  const horizons::Pillars pillars(body, map);
  const auto surfaces = horizons::depth_surfaces(body, problems);
  const horizons::Levels levels =
      horizons::find_levels(body, map, cut, pillars, surfaces, problems);
  EXPECT_TRUE(problems.empty());
  std::vector<ThrowAt> found;
  const std::vector<int>& line = map.lines[static_cast<std::size_t>(fault)];
  double along = 0;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    along += (map.vertices[line[k]] - map.vertices[line[k - 1]]).norm();
    const auto* side = horizons::find_side(sides, line[k], line[k + 1]);
    const bool is_turned = side->a != line[k];
    const auto z = [&](int triangle) {
      return levels.horizons[horizons::place_at(map, cut, triangle, line[k])][horizon];
    };
    const double left = z(is_turned ? side->right : side->left),
                 right = z(is_turned ? side->left : side->right);
    found.push_back({along, left - right});
  }
  return found;
}

/// Of the grid, by its corners alone: at each pillar between the tops of columns on either side.
std::vector<ThrowAt> throws_of(const corner_point::CornerPointGrid& grid,
                               const corner_point::Fault& fault, const std::vector<Vector2d>& trace,
                               double reference_z) {
  const corner_point::ColumnMap map(grid);
  const auto top = [&](int column, int pillar) {
    return grid.z(column, map.top_layer(column), map.corner_at(column, pillar));
  };
  std::vector<ThrowAt> found;
  for (std::size_t e = 0; e + 1 < fault.edges.size(); ++e) {
    const corner_point::FaultEdge &before = fault.edges[e], &after = fault.edges[e + 1];
    const int pillar = before.to;
    const double down = (top(before.left, pillar) - top(before.right, pillar) +
                         top(after.left, pillar) - top(after.right, pillar)) /
                        2;
    const auto on = corner_point::nearest_on_line(trace, grid.pillars[pillar].at(reference_z));
    found.push_back({on.along, down});
  }
  return found;
}

double throw_at(const std::vector<ThrowAt>& all, double along) {
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    if (all[k].along > along || all[k + 1].along < along) continue;
    const double part = (along - all[k].along) / (all[k + 1].along - all[k].along);
    return all[k].down + part * (all[k + 1].down - all[k].down);
  }
  return NAN;
}

/// At every pillar of the grid's faults with a throw of 0.12 of a cell or more: less is joined.
TEST_F(RealField, HasAboutTheThrowOfItsCells) {
  const corner_point::CornerPointGrid grid = corner_point::read_corner_point_grid(grid_);
  const corner_point::GridStructure structure = recognise_structure(grid, {});
  std::vector<Problem> problems;
  SceneReader reader(document_, problems);
  const horizons::LayeredBody body = read_layered_body(reader, scene_).body;
  ASSERT_TRUE(problems.empty());
  std::size_t top = 0;  // the reservoir's
  while (body.compartments.front().region[top + 1] < 0) ++top;
  constexpr double kFoot = 0.3048;
  for (std::size_t f = 0; f < body.faults.size(); ++f) {
    const int source = std::stoi(body.faults[f].name.substr(1)) - 1;
    const std::vector<ThrowAt> in_model = throws_of(body, static_cast<int>(f), top);
    std::vector<double> off;
    for (const ThrowAt& one : throws_of(grid, structure.faults[static_cast<std::size_t>(source)],
                                        body.faults[f].trace, body.trace_depth)) {
      const double model = throw_at(in_model, one.along);
      if (std::isnan(model) || std::abs(one.down) < 0.12 * body.cells.at_faults) continue;
      off.push_back(std::abs(model - one.down) / kFoot);
    }
    std::ranges::sort(off);
    if (off.empty()) continue;
    std::cout << body.faults[f].name << ": " << off.size() << " pillars, throw off by "
              << off[off.size() / 2] << " ft in the median, " << off[off.size() * 9 / 10]
              << " ft at nine of ten, " << off.back() << " ft at most\n";
    // Not the foot that is wanted: depths of both sides are joined where they differ by less than
    // 0.12 of a cell, and pillars are moved to a straight trace along slopes that differ by side.
    EXPECT_LE(off[off.size() / 2], 10);
    EXPECT_LE(off[off.size() * 9 / 10], 20);
  }
}

}  // namespace
}  // namespace faultsim
