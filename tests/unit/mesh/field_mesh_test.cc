#include <map>

#include "simulator/common/units.h"
#include "tests/unit/mesh/mesh_checks.h"

namespace faultsim {
namespace {

using namespace testing_mesh;
using ::testing::Test;

enum Kind { overburden, salt, reservoir, underburden, sideburden };

/// The reference scene, coarse along strike and away from the reservoir.
FieldMeshSpec reference(double offset) {
  FieldMeshSpec spec;
  spec.width = 20e3, spec.length = 20e3, spec.depth = 5e3;
  spec.layers = {{"", "", 0}, {"", "", 1500}, {"reservoir", "", 2000}, {"", "", 2200}};
  spec.layer_materials = {overburden, salt, reservoir, underburden};
  spec.reservoir_layer = "reservoir";
  spec.sideburden_material = sideburden;
  spec.blocks = {{"west", -2000, 0, 0}, {"east", 0, 2000, offset}};
  spec.block_length = 2000, spec.fault_length = 2400;
  spec.fault_overshoot = 150, spec.pivot_depth = 2100;
  spec.fault_names = {"F1", "F2", "F3"};
  spec.fault_dips = {0, 0, 0};
  spec.sizes = {400, 20, 100, 1.8, 0, 0};
  spec.half_domain = false;
  spec.plane_strain = false;
  return spec;
}

FieldMeshSpec plane_strain(double offset) {
  FieldMeshSpec spec = reference(offset);
  spec.plane_strain = true;
  spec.sizes = {200, 10, 20, 1.3, 0, 0};
  return spec;
}

std::set<int> kinds_at(const Mesh& mesh, double x, double y, double depth_from, double depth_to) {
  std::set<int> kinds;
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Vector3d centre = cell_centre(mesh, static_cast<int>(cell));
    double low = 1e9, high = -1e9, low_y = 1e9, high_y = -1e9;
    for (const int n : mesh.cells[cell]) {
      low = std::min(low, node(mesh, n).x());
      high = std::max(high, node(mesh, n).x());
      low_y = std::min(low_y, node(mesh, n).y());
      high_y = std::max(high_y, node(mesh, n).y());
    }
    if (x > low && x < high && y > low_y && y < high_y && -centre.z() > depth_from &&
        -centre.z() < depth_to)
      kinds.insert(mesh.material[cell]);
  }
  return kinds;
}

std::vector<double> sorted_depths(const Mesh& mesh) {
  std::set<double> depths;
  for (const Eigen::Vector3d& one : mesh.nodes) depths.insert(one.z());
  return {depths.begin(), depths.end()};
}

TEST(FieldMesh, IsSoundForAllOffsetsAndDips) {
  for (const double offset : {-100.0, 0.0, 37.0, 200.0, 250.0})
    for (const double dip : {-25.0, 0.0, 25.0}) {
      SCOPED_TRACE(::testing::Message() << "offset " << offset << " dip " << dip);
      FieldMeshSpec spec = reference(offset);
      spec.fault_dips[1] = dip * kDegree;
      const Mesh mesh = make_mesh(spec);
      check_mesh(mesh);
      EXPECT_NEAR(total_volume(mesh), 20e3 * 20e3 * 5e3, 1e-9 * 2e12);
      EXPECT_NEAR(volume_by_boundary(mesh), 20e3 * 20e3 * 5e3, 1e-9 * 2e12);
      const double shift_each = std::tan(dip * kDegree);
      const double west =
          2000 * (2000.0 * 200 + shift_each * 0);  // pivot in the middle of the layer
      EXPECT_NEAR(region_volume(mesh, 0), west, 1e-9 * west);
      // East block: its fault side lies offset below the pivot on average.
      const double east = 2000 * (2000 - offset * shift_each) * 200;
      EXPECT_NEAR(region_volume(mesh, 1), east, 1e-9 * east);
      ASSERT_EQ(mesh.faults.size(), 3u);
      const double cos_dip = std::cos(dip * kDegree);
      const double height = 500 + std::abs(offset);
      EXPECT_NEAR(face_area(mesh.faults[0]), 2400 * 500, 1e-6);
      EXPECT_NEAR(face_area(mesh.faults[1]), 2400 * height / cos_dip, 1e-6);
      EXPECT_NEAR(face_area(mesh.faults[2]), 2400 * 500, 1e-6);
    }
}

TEST(FieldMesh, BendsTheFaultAboutThePivot) {
  FieldMeshSpec spec = reference(100);
  spec.fault_dips = {-10 * kDegree, 25 * kDegree, 5 * kDegree};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const double x[3] = {-2000, 0, 2000};
  for (size_t i = 0; i < 3; ++i)
    for (const Eigen::Vector3d& p : mesh.faults[i].points)
      EXPECT_NEAR(p.x(), x[i] + (-p.z() - 2100) * std::tan(spec.fault_dips[i]), 1e-9);
  const FaultNode& one = mesh.faults[1].nodes[0];
  EXPECT_NEAR(one.normal.x(), std::cos(25 * kDegree), 1e-14);
  EXPECT_NEAR(one.normal.z(), std::sin(25 * kDegree), 1e-14);
  EXPECT_NEAR(one.dip.x(), std::sin(25 * kDegree), 1e-14);
}

TEST(FieldMesh, EachFaultHasItsOwnDepthRange) {
  const Mesh mesh = make_mesh(reference(137));
  const double top[3] = {-1850, -1850, -1987}, bottom[3] = {-2350, -2487, -2487};
  for (size_t i = 0; i < 3; ++i) {
    const FaultSurface& fault = mesh.faults[i];
    EXPECT_NEAR(fault.points.front().z(), top[i], 1e-6);  // rows go down dip
    EXPECT_NEAR(fault.points.back().z(), bottom[i], 1e-6);
    EXPECT_NEAR(fault.points.front().y(), -1200, 1e-9);
    EXPECT_NEAR(fault.points.back().y(), 1200, 1e-9);
    for (size_t k = 0; k < fault.points.size(); ++k) {  // all but those on the edge split
      const Eigen::Vector3d& p = fault.points[k];
      EXPECT_EQ(fault.node_of_point[k] >= 0,
                std::abs(p.y()) < 1199 && p.z() < top[i] - 1e-6 && p.z() > bottom[i] + 1e-6);
    }
  }
}

TEST(FieldMesh, FillsTheGapAboveAShiftedReservoirWithCaprock) {
  const Mesh mesh = make_mesh(reference(100));
  const std::set<int> only_salt = {salt}, only_reservoir = {reservoir}, only_under = {underburden};
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 1500, 2100), only_salt);
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2100, 2300), only_reservoir);
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2300, 5000), only_under);
  EXPECT_EQ(kinds_at(mesh, -1000, 50, 2000, 2200), only_reservoir);
  const std::set<int> only_side = {sideburden};
  EXPECT_EQ(kinds_at(mesh, 1000, 1100, 2000, 2200), only_side);
  EXPECT_EQ(kinds_at(mesh, 1000, 1100, 2200, 5000), only_under);
  EXPECT_EQ(kinds_at(mesh, 3000, 50, 2000, 2200), only_side);
  EXPECT_EQ(kinds_at(mesh, 3000, 50, 1500, 2000), only_salt);
}

TEST(FieldMesh, OffsetBeyondTheThicknessLeavesCaprockDownToTheReservoir) {
  const Mesh mesh = make_mesh(reference(250));
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 1500, 2250), std::set<int>{salt});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2250, 2450), std::set<int>{reservoir});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2450, 5000), std::set<int>{underburden});
}

TEST(FieldMesh, AnUpwardOffsetPullsUpTheUnderburden) {
  const Mesh mesh = make_mesh(reference(-100));
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 1500, 1900), std::set<int>{salt});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 1900, 2100), std::set<int>{reservoir});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2100, 5000), std::set<int>{underburden});
}

TEST(FieldMesh, ABlockMayHaveAThicknessOfItsOwn) {
  FieldMeshSpec spec = reference(100);
  spec.blocks[1].thickness = 80;
  spec.blocks[0].thickness = 260;
  const Mesh mesh = make_mesh(spec);
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2000, 2100), std::set<int>{salt});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2100, 2180), std::set<int>{reservoir});
  EXPECT_EQ(kinds_at(mesh, 1000, 50, 2180, 5000), std::set<int>{underburden});
  EXPECT_EQ(kinds_at(mesh, -1000, 50, 2000, 2260), std::set<int>{reservoir});
  EXPECT_EQ(kinds_at(mesh, -1000, 50, 2260, 5000), std::set<int>{underburden});
  EXPECT_NEAR(mesh.faults[0].points.back().z(), -2260 - 150, 1e-6);
  EXPECT_NEAR(mesh.faults[1].points.back().z(), -2260 - 150, 1e-6);
  EXPECT_NEAR(mesh.faults[2].points.back().z(), -2180 - 150, 1e-6);
}

/// Heights of the cells next to a depth: two above, two below.
std::vector<double> heights_around(const std::vector<double>& z, double depth) {
  const auto at =
      std::find_if(z.begin(), z.end(), [&](double x) { return std::abs(x + depth) < 1e-6; });
  EXPECT_NE(at, z.end()) << depth;
  if (at == z.end()) return {};
  return {at[2] - at[1], at[1] - at[0], at[0] - at[-1], at[-1] - at[-2]};
}

TEST(FieldMesh, CornersHaveEqualCellHeightsThroughAnOffsetSweep) {
  for (const double dip : {10.0, 20.0})
    for (const double offset : {0.0, 10.0, 37.0, 100.0, 150.0, 200.0, 250.0, 400.0, -100.0}) {
      FieldMeshSpec spec = plane_strain(offset);
      spec.sizes.dip = dip;
      std::vector<Problem> problems;
      const GridLines lines = grid_lines(spec, problems);
      ASSERT_TRUE(problems.empty());
      const std::set<double> edges = {2000, 2200, 2000 + offset, 2200 + offset};
      for (const double edge : edges) {
        const std::vector<double> heights = heights_around(lines[2], edge);
        ASSERT_EQ(heights.size(), 4u);
        for (int side = 0; side < 2; ++side) {
          // The nearest other edge (or tip of F1 or F3 that differs) bounds the room.
          double room = 150;
          for (const double other : {2000.0, 2200.0, 2000 + offset, 2200 + offset, 1850.0, 2350.0,
                                     1850 + offset, 2350 + offset}) {
            const double distance = side == 0 ? edge - other : other - edge;
            if (distance > 1e-6) room = std::min(room, distance);
          }
          SCOPED_TRACE(::testing::Message() << "dip " << dip << " offset " << offset << " edge "
                                            << edge << " room " << room);
          if (room >= 4 * dip) {
            for (int k = 0; k < 2; ++k)
              EXPECT_NEAR(heights[static_cast<size_t>(2 * side + k)], dip, 1e-9);
          } else {
            EXPECT_LE(heights[static_cast<size_t>(2 * side)], 1.1 * dip);
            EXPECT_LE(heights[static_cast<size_t>(2 * side + 1)], 1.1 * dip);
          }
        }
      }
    }
}

TEST(FieldMesh, GradedCornersAreTheSameThroughAnOffsetSweep) {
  for (const double offset : {0.0, 20.0, 37.0, 100.0, 150.0, 200.0, 250.0, -100.0}) {
    FieldMeshSpec spec = plane_strain(offset);
    spec.sizes.dip = 20;
    spec.sizes.corner = 5;
    spec.sizes.corner_growth = 1.5;
    std::vector<Problem> problems;
    const std::vector<double> z = grid_lines(spec, problems)[2];
    ASSERT_TRUE(problems.empty());
    SCOPED_TRACE(offset);
    for (const double edge : {2000.0, 2200.0, 2000 + offset, 2200 + offset}) {
      const std::vector<double> heights = heights_around(z, edge);
      ASSERT_EQ(heights.size(), 4u);
      EXPECT_NEAR(heights[1], 5, 1e-9);
      EXPECT_NEAR(heights[2], 5, 1e-9);
    }
    const double top = std::min(1850.0, 1850 + offset), bottom = std::max(2350.0, 2350 + offset);
    double largest = 0;
    for (size_t k = 1; k < z.size(); ++k) {
      if (z[k - 1] < -bottom - 1e-6 || z[k] > -top + 1e-6) continue;
      const double height = z[k] - z[k - 1];
      largest = std::max(largest, height);
      if (z[k + 1] > -top + 1e-6) continue;
      const double ratio = (z[k + 1] - z[k]) / height;
      EXPECT_LE(std::max(ratio, 1 / ratio), 1.5 + 1e-9) << z[k];
    }
    EXPECT_LE(largest, 20 + 1e-9);
    EXPECT_GT(largest, 15);
  }
}

TEST(FieldMesh, CornersNotBelowDipChangeNothing) {
  FieldMeshSpec spec = plane_strain(37);
  std::vector<Problem> problems;
  const std::vector<double> z = grid_lines(spec, problems)[2];
  for (const double corner : {spec.sizes.dip, 2 * spec.sizes.dip}) {
    spec.sizes.corner = corner;
    EXPECT_EQ(grid_lines(spec, problems)[2], z);
  }
}

TEST(FieldMesh, BeginsWithTheNormalSizeBesideEachFaultAndGrows) {
  FieldMeshSpec spec = plane_strain(50);
  std::vector<Problem> problems;
  const std::vector<double> x = grid_lines(spec, problems)[0];
  for (const double fault : {-2000.0, 0.0, 2000.0})
    for (const double near : {fault - 20, fault, fault + 20})
      EXPECT_TRUE(std::any_of(x.begin(), x.end(), [&](double v) {
        return std::abs(v - near) < 1e-9;
      })) << near;
  for (size_t k = 1; k + 1 < x.size(); ++k) {
    const double ratio = (x[k + 1] - x[k]) / (x[k] - x[k - 1]);
    EXPECT_LE(std::max(ratio, 1 / ratio), 1.3 + 1e-9);
  }
}

TEST(FieldMesh, HalfDomainIsHalfOfTheFullOne) {
  FieldMeshSpec spec = reference(100);
  spec.fault_dips[1] = 20 * kDegree;
  const Mesh full = make_mesh(spec);
  spec.half_domain = true;
  const Mesh half = make_mesh(spec);
  check_mesh(half);
  EXPECT_EQ(2 * half.cells.size(), full.cells.size());
  EXPECT_NEAR(2 * total_volume(half), total_volume(full), 1e-9 * total_volume(full));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(2 * node_area(half.faults[i]), node_area(full.faults[i]), 1e-6);
    EXPECT_NEAR(half.faults[i].points[0].y(), 0, 1e-12);
    // The nodes on the symmetry plane stand for half.
    const size_t n_on_plane = std::count_if(
        half.faults[i].nodes.begin(), half.faults[i].nodes.end(),
        [&](const FaultNode& one) { return std::abs(node(half, one.minus_node).y()) < 1e-9; });
    const std::vector<FaultNode>& nodes = full.faults[i].nodes;
    EXPECT_NEAR(2 * half.faults[i].nodes[3].area,
                nodes[nodes.size() / 2 / n_on_plane * n_on_plane + 3].area, 1e-9);
  }
}

TEST(FieldMesh, PlaneStrainTiesTheBackToTheFrontAndHasOneColumn) {
  FieldMeshSpec spec = plane_strain(100);
  spec.fault_dips[1] = -15 * kDegree;
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_TRUE(mesh.plane_strain);
  EXPECT_EQ(mesh.thickness, 1);
  for (size_t n = 0; n < mesh.nodes.size(); ++n) {
    const int root = mesh.tied_to[n];
    EXPECT_EQ(node(mesh, root).y(), 0);
    EXPECT_EQ(node(mesh, root).x(), mesh.nodes[n].x());
    EXPECT_EQ(node(mesh, root).z(), mesh.nodes[n].z());
    EXPECT_EQ(root == static_cast<int>(n), mesh.nodes[n].y() == 0);
  }
  const FaultSurface& fault = mesh.faults[1];
  EXPECT_EQ(fault.nodes.size(), fault.points.size() - 2);
  EXPECT_EQ(fault.faces.size(), fault.points.size() - 1);
  // Per metre of strike: the down-dip length that a node stands for.
  const double along = (fault.points[3] - fault.points[1]).norm() / 2;
  EXPECT_NEAR(fault.nodes[1].area, along, 1e-9);
  EXPECT_NEAR(face_area(fault), 600 / std::cos(15 * kDegree), 1e-9);
}

/// A spec whose lines are laid out for an offset of 100 m.
FieldMeshSpec laid_out_for_100(double offset) {
  FieldMeshSpec spec = plane_strain(offset);
  spec.sizes.corner = 2, spec.sizes.corner_growth = 1.5;
  spec.blocks[1].mesh_offset = 100;
  return spec;
}

TEST(FieldMesh, CellsCorrespondOverARangeOfOffsetsWithTheSameMeshOffset) {
  const Mesh at_100 = make_mesh(laid_out_for_100(100));
  FieldMeshSpec own = laid_out_for_100(100);
  own.blocks[1].mesh_offset.reset();
  EXPECT_EQ(make_mesh(own).nodes, at_100.nodes);
  for (const double offset : {60.0, 124.0}) {
    const Mesh mesh = make_mesh(laid_out_for_100(offset));
    EXPECT_EQ(mesh.cells, at_100.cells);
    EXPECT_EQ(mesh.material, at_100.material);
    EXPECT_EQ(mesh.region, at_100.region);
    for (std::size_t f = 0; f < mesh.faults.size(); ++f)
      EXPECT_EQ(mesh.faults[f].node_of_point, at_100.faults[f].node_of_point);
    const std::vector<double> z = sorted_depths(mesh);
    for (const double edge : {-2000.0, -2200.0, -2000 - offset, -2200 - offset}) {
      const auto at = std::min_element(z.begin(), z.end(), [&](double a, double b) {
        return std::abs(a - edge) < std::abs(b - edge);
      });
      EXPECT_NEAR(*at, edge, 1e-9) << offset;
      EXPECT_NEAR(*(at + 1) - *at, 2, 0.2) << offset << " " << edge;  // corner cells, to a tenth
      EXPECT_NEAR(*at - *(at - 1), 2, 0.2) << offset << " " << edge;
    }
  }
}

TEST(FieldMesh, RefusesToMoveLinesPastEachOther) {
  for (const double offset : {0.0, -50.0, 40.0, 200.0, 260.0}) {
    std::vector<Problem> problems;
    grid_lines(laid_out_for_100(offset), problems);
    ASSERT_EQ(problems.size(), 1u) << offset;
    EXPECT_EQ(problems[0].pointer, "/geometry/blocks/1/mesh_offset");
  }
}

TEST(FieldMesh, SplitsEveryNodeOfAFaultThatPassesBeyondTheModel) {
  FieldMeshSpec spec = reference(0);
  spec.fault_length = 30e3, spec.block_length = 30e3;
  spec.sizes.strike = 1000;
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const FaultSurface& fault = mesh.faults[1];
  const auto is_end = [&](double z) {
    return std::min(std::abs(z - fault.points.front().z()), std::abs(z - fault.points.back().z())) <
           1e-6;
  };
  for (size_t k = 0; k < fault.points.size(); ++k)
    EXPECT_EQ(fault.node_of_point[k] >= 0, !is_end(fault.points[k].z()));
  EXPECT_NEAR(fault.points[0].y(), -10e3, 1e-9);
}

TEST(FieldMesh, WorksForOneBlockAndForMany) {
  FieldMeshSpec spec = reference(0);
  spec.blocks = {{"", -500, 700, 80}};
  spec.fault_names = {"a", "b"};
  spec.fault_dips = {0.1, -0.2};
  check_mesh(make_mesh(spec));
  spec.blocks = {
      {"", -3000, -1000, 0}, {"", -1000, 500, 120}, {"", 500, 2500, -60}, {"", 2500, 3500, 300}};
  spec.fault_names = {"a", "b", "c", "d", "e"};
  spec.fault_dips = {0.1, -0.2, 0.3, 0, 0.4};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_EQ(mesh.faults.size(), 5u);
  for (int region = 0; region < 4; ++region) EXPECT_GT(region_volume(mesh, region), 0);
}

TEST(FieldMesh, IsTheSameTwice) {
  FieldMeshSpec spec = plane_strain(37);
  spec.fault_dips[1] = 0.3;
  const Mesh a = make_mesh(spec), b = make_mesh(spec);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.region_fraction, b.region_fraction);
}

TEST(FieldMesh, RefusesImpossibleGeometryWithItsPlace) {
  const auto pointers = [](auto change) {
    FieldMeshSpec spec = plane_strain(0);
    change(spec);
    return problem_pointers(spec);
  };
  EXPECT_EQ(pointers([](FieldMeshSpec&) {}), List{});
  EXPECT_EQ(pointers([](FieldMeshSpec& s) { s.blocks[1].offset = 2700; }),
            List{"/geometry/blocks/1/offset"});
  EXPECT_EQ(pointers([](FieldMeshSpec& s) { s.blocks[1].offset = -1900; }),
            List{"/geometry/blocks/1/offset"});
  EXPECT_EQ(pointers([](FieldMeshSpec& s) { s.blocks[1].to = 1e-5; }),
            List{"/geometry/blocks/1/to"});
  EXPECT_EQ(pointers([](FieldMeshSpec& s) { s.sizes.dip = 1e-3; }), List{"/mesh"});
  EXPECT_EQ(pointers([](FieldMeshSpec& s) { s.fault_dips[2] = 1; }),
            List{"/faults/2/dip_from_vertical"});
  // Two faults 100 m apart that lean towards each other meet within the reservoir.
  EXPECT_EQ(pointers([](FieldMeshSpec& s) {
              s.blocks = {{"", -2000, 0, 0}, {"", 0, 100, 0}};
              s.fault_dips = {0, 0.4, -0.4};
            }),
            List{"/faults/2/dip_from_vertical"});
}

TEST(FieldMesh, ReportsAllProblemsAtOnce) {
  FieldMeshSpec spec = plane_strain(2700);
  spec.blocks[0].offset = -2100;
  spec.fault_dips[0] = 2;
  EXPECT_EQ(problem_pointers(spec).size(), 3u);
}

}  // namespace
}  // namespace faultsim
