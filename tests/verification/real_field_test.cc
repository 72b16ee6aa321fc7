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
#include "simulator/corner_point/straight_trace.h"
#include "simulator/corner_point/structure_finder.h"
#include "simulator/horizons/levels.h"
#include "simulator/horizons/map_locator.h"
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

/// A depth on one side of a fault: its place along the trace, m, and z.
struct DepthAt {
  double along, z;
};
/// A horizon on the left and on the right of a fault, in order along it.
using BothSides = std::array<std::vector<DepthAt>, 2>;

double z_at(const std::vector<DepthAt>& side, double along) {
  for (std::size_t k = 0; k + 1 < side.size(); ++k) {
    if (side[k].along > along || side[k + 1].along < along) continue;
    const double way = side[k + 1].along - side[k].along;
    const double part = way > 0 ? (along - side[k].along) / way : 0;
    return side[k].z + part * (side[k + 1].z - side[k].z);
  }
  return NAN;
}

/// How much deeper the right side is in the section across the fault at a place along it.
double throw_at(const BothSides& sides, double along) {
  return z_at(sides[0], along) - z_at(sides[1], along);
}

/// The horizons of a body on the pillars of its map.
class BuiltHorizons {
 public:
  explicit BuiltHorizons(const horizons::LayeredBody& body)
      : body_(body),
        map_(horizons::mesh_map(body, horizons::meeting_lines(body, problems_), problems_)),
        sides_(horizons::sides_of(map_.triangles)),
        cut_(horizons::cut_map(map_)),
        pillars_(body, map_),
        levels_(horizons::find_levels(body, map_, cut_, pillars_,
                                      horizons::depth_surfaces(body, problems_), problems_)),
        locator_(body, map_, sides_, pillars_) {
    EXPECT_TRUE(problems_.empty());
  }

  /// At each pillar of a trace, without its ends.
  BothSides beside(std::size_t fault, std::size_t horizon) const {
    BothSides found;
    const std::vector<int>& line = map_.lines[fault];
    double along = 0;
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      along += (map_.vertices[line[k]] - map_.vertices[line[k - 1]]).norm();
      const auto* side = horizons::find_side(sides_, line[k], line[k + 1]);
      const bool is_turned = side->a != line[k];
      for (const bool is_right : {false, true}) {
        const int triangle = is_turned == is_right ? side->left : side->right;
        const int place = horizons::place_at(map_, cut_, triangle, line[k]);
        found[is_right ? 1 : 0].push_back({along, levels_.horizons[place][horizon]});
      }
    }
    return found;
  }

  /// How far along a trace the section is in which a place of the rock lies.
  double along(std::size_t fault, const Vector3d& at) const {
    return corner_point::nearest_on_line(body_.faults[fault].trace, locator_.find(at).at).along;
  }

 private:
  const horizons::LayeredBody& body_;
  std::vector<Problem> problems_;
  horizons::MapMesh map_;
  std::vector<horizons::MapSide> sides_;
  horizons::CutMap cut_;
  horizons::Pillars pillars_;
  horizons::Levels levels_;
  horizons::MapLocator locator_;
};

/// A surface beside a fault of the grid, by its corners alone: of the columns on either side of
/// each pillar but the last ones. Where columns of one side step themselves by more than a metre
/// there is a fault that is not in the model.
struct GridSides {
  BothSides sides;
  std::vector<double> steps;  ///< where along the trace.
};

GridSides grid_sides(const corner_point::CornerPointGrid& grid, const corner_point::Fault& source,
                     bool is_base, const BuiltHorizons& model, std::size_t fault) {
  const corner_point::ColumnMap map(grid);
  const auto corner_z = [&](int column, int pillar) {
    corner_point::CornerPlace place = map.corner_at(column, pillar);
    place.bottom = is_base;
    return grid.z(column, is_base ? map.base_layer(column) : map.top_layer(column), place);
  };
  GridSides found;
  for (std::size_t e = 0; e + 1 < source.edges.size(); ++e) {
    const corner_point::FaultEdge &before = source.edges[e], &after = source.edges[e + 1];
    const int pillar = before.to;
    for (const bool is_right : {false, true}) {
      const double one = corner_z(is_right ? before.right : before.left, pillar);
      const double other = corner_z(is_right ? after.right : after.left, pillar);
      const double z = (one + other) / 2;
      const Vector2d at = grid.pillars[pillar].at(z);
      const double along = model.along(fault, {at.x(), at.y(), z});
      found.sides[is_right ? 1 : 0].push_back({along, z});
      if (std::abs(one - other) > 1) found.steps.push_back(along);
    }
  }
  for (std::vector<DepthAt>& side : found.sides)
    std::ranges::stable_sort(side, {}, &DepthAt::along);
  return found;
}

/// How far throws are off, ft, of all corners of the grid and of those further than a cell from a
/// step of one side.
struct ThrowsOff {
  std::vector<double> all, clear;
};

/// Both sides at one place along the fault, wherever a corner of the grid lies on it and the grid
/// has its reservoir on both sides: pillars of the grid lean along the fault too, and the two
/// corners of one are up to 200 m apart along it. Throws of less than 0.03 of a cell are none in
/// the model.
ThrowsOff throws_off(const BothSides& model, const std::array<GridSides, 2>& top_and_base,
                     bool is_base, double cell, double least) {
  constexpr double kFoot = 0.3048;
  ThrowsOff off;
  const GridSides &own = top_and_base[is_base ? 1 : 0], &other = top_and_base[is_base ? 0 : 1];
  for (const std::vector<DepthAt>& side : own.sides)
    for (const DepthAt& one : side) {
      const double grids = throw_at(own.sides, one.along);
      const double difference = std::abs(throw_at(model, one.along) - grids) / kFoot;
      if (std::isnan(difference) || std::isnan(throw_at(other.sides, one.along))) continue;
      if (std::abs(grids) < least) continue;
      off.all.push_back(difference);
      const auto is_far = [&](double step) { return std::abs(step - one.along) > cell; };
      if (std::ranges::all_of(own.steps, is_far) && std::ranges::all_of(other.steps, is_far))
        off.clear.push_back(difference);
    }
  return off;
}

/// The middle one, that which nine of ten do not exceed, and the largest.
std::array<double, 3> median_most_largest(std::vector<double> all) {
  std::ranges::sort(all);
  return {all[all.size() / 2], all[all.size() * 9 / 10], all.back()};
}

std::array<double, 3> say(const char* of, const std::vector<double>& off) {
  const std::array<double, 3> some = median_most_largest(off);
  std::cout << of << off.size() << " corners, throw off by " << some[0] << " ft in the median, "
            << some[1] << " ft at nine of ten, " << some[2] << " ft at most\n";
  return some;
}

TEST_F(RealField, HasTheThrowOfItsCells) {
  const corner_point::CornerPointGrid grid = corner_point::read_corner_point_grid(grid_);
  const corner_point::GridStructure structure = recognise_structure(grid, {});
  std::vector<Problem> problems;
  SceneReader reader(document_, problems);
  const horizons::LayeredBody body = read_layered_body(reader, scene_).body;
  ASSERT_TRUE(problems.empty());
  std::size_t top = 0;  // the reservoir's
  while (body.compartments.front().region[top + 1] < 0) ++top;
  const BuiltHorizons model(body);
  for (std::size_t f = 0; f < body.faults.size(); ++f) {
    const corner_point::Fault& source =
        structure.faults[std::stoul(body.faults[f].name.substr(1)) - 1];
    const std::array<GridSides, 2> in_grid = {grid_sides(grid, source, false, model, f),
                                              grid_sides(grid, source, true, model, f)};
    for (const bool is_base : {false, true}) {
      const ThrowsOff off = throws_off(model.beside(f, is_base ? top + 1 : top), in_grid, is_base,
                                       source.cell, 0.03 * body.cells.at_faults);
      if (off.clear.empty()) continue;
      std::cout << body.faults[f].name << (is_base ? ", base\n" : ", top\n");
      const auto all = say("  ", off.all), clear = say("  away from steps: ", off.clear);
      EXPECT_LE(clear[0], 0.6);
      EXPECT_LE(clear[1], 1.1);
      // Beside a trough of one side, 10 m deep and two cells of the grid wide, which is about as
      // wide as a cell of the model.
      EXPECT_LE(all[0], 0.6);
      EXPECT_LE(all[1], 4);
    }
  }
}

}  // namespace
}  // namespace faultsim
