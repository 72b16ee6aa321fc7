#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulator/elasticity/elasticity.h"
#include "simulator/elasticity/rigid_modes.h"
#include "tests/unit/condensation/junction_problem.h"
#include "tests/unit/elasticity/test_box.h"

namespace faultsim {
namespace {

using test::make_box;

const std::array<int, 3> kCells = {4, 2, 3};

/// Jump components left per node of fault 0, as "n", "ns", "nsd", ...
std::string components(const DofMap& dofs, int node) {
  std::string text;
  for (int c = 0; c < 3; ++c) {
    if (dofs.jump_dof(0, node, c) >= 0) text += "nsd"[c];
  }
  return text;
}

TEST(DofMap, NodesAmidSidesKnowTheGroupsAtTheirEnds) {
  const BulkProblem problem = test::junction_problem();
  const Mesh& mesh = problem.mesh;
  const DofMap dofs(mesh, problem.conditions, 3);
  const UnknownGroups& groups = dofs.bulk_groups();
  const auto group_of = [&](int node) {
    const auto terms = dofs.terms(node, 0);
    return terms.empty() ? -1 : groups.of[static_cast<std::size_t>(terms[0].unknown)];
  };
  ASSERT_EQ(std::ssize(groups.ends), groups.n);
  int n_between = 0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells[cell];
    for (std::size_t side = 0; side < 6; ++side) {
      const int middle = group_of(nodes[4 + side]);
      if (middle < 0) continue;
      const auto [a, b] = kTetrahedronSides[side];
      std::array<int, 2> ends = {group_of(nodes[a]), group_of(nodes[b])};
      std::array<int, 2> said = groups.ends[static_cast<std::size_t>(middle)];
      std::ranges::sort(ends);
      std::ranges::sort(said);
      EXPECT_EQ(said, ends);
      n_between += ends[0] >= 0;
    }
    for (const int corner : mesh.cells.corners(cell)) {
      const int group = group_of(corner);
      if (group < 0) continue;
      EXPECT_EQ(groups.ends[static_cast<std::size_t>(group)], (std::array<int, 2>{-1, -1}));
    }
  }
  EXPECT_GT(n_between, 100);
  EXPECT_TRUE(DofMap(make_box(kCells, {4, 2, 3}, {}), {}, 0).bulk_groups().ends.empty());
}

TEST(DofMap, UnknownsAreMeansAndLocalJumps) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {{2, 0, 2, 0, 2}}, test::shear_to_dip(60));
  const DofMap dofs(mesh, test::rollers({Side::x_min}), 0);
  EXPECT_EQ(dofs.n_unknowns(), dofs.n_bulk() + dofs.n_jump());
  EXPECT_EQ(dofs.n_jump(), 3 * static_cast<int>(mesh.faults[0].nodes.size()));
  EXPECT_EQ(static_cast<int>(dofs.bulk_groups().of.size()), dofs.n_bulk());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(dofs.n_unknowns());
  const Eigen::Matrix3Xd u = nodal_displacement(mesh, dofs, x, {});
  for (std::size_t k = 0; k < mesh.faults[0].nodes.size(); ++k) {
    const FaultNode& node = mesh.faults[0].nodes[k];
    const Eigen::Vector3d jump = u.col(node.plus_node) - u.col(node.minus_node);
    const std::array<Eigen::Vector3d, 3> axes = {node.normal, node.strike, node.dip};
    for (int c = 0; c < 3; ++c) {
      const int dof = dofs.n_bulk() + dofs.jump_dof(0, static_cast<int>(k), c);
      EXPECT_NEAR(axes[static_cast<std::size_t>(c)].dot(jump), x[dof], 1e-14);
    }
    const Eigen::Vector3d mean = 0.5 * (u.col(node.plus_node) + u.col(node.minus_node));
    const int first = dofs.terms(node.minus_node, 0)[0].unknown;
    EXPECT_EQ(first, dofs.terms(node.plus_node, 0)[0].unknown);
    EXPECT_NEAR(mean.x(), x[first], 1e-14);
  }
}

TEST(DofMap, JumpsOfOneDepthFollowEachOtherAlongStrike) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {test::through(2, kCells)});
  const DofMap dofs(mesh, test::rollers({Side::y_min, Side::z_min, Side::x_min}), 0);
  std::vector<int> node_of(static_cast<std::size_t>(dofs.n_jump()), -1);
  for (std::size_t k = 0; k < mesh.faults[0].nodes.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (const int dof = dofs.jump_dof(0, static_cast<int>(k), c); dof >= 0)
        node_of[static_cast<std::size_t>(dof)] = static_cast<int>(k);
  const auto place = [&](int node) {
    return mesh.nodes[static_cast<std::size_t>(
        mesh.faults[0].nodes[static_cast<std::size_t>(node)].minus_node)];
  };
  ASSERT_EQ(std::ranges::count(node_of, -1), 0);
  for (std::size_t dof = 1; dof < node_of.size(); ++dof) {
    const Eigen::Vector3d step = place(node_of[dof]) - place(node_of[dof - 1]);
    const double along = step.dot(mesh.faults[0].nodes[0].strike);
    EXPECT_TRUE(step.z() < 0 || (step.z() == 0 && along >= 0 && along <= 1)) << step.transpose();
  }
}

TEST(DofMap, RollerAlongStrikeOrDipRemovesThatJump) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {test::through(2, kCells)});
  const DofMap dofs(mesh, test::rollers({Side::y_min, Side::z_min, Side::x_min}), 0);
  EXPECT_TRUE(dofs.locked_positions().empty());
  for (std::size_t k = 0; k < mesh.faults[0].nodes.size(); ++k) {
    const Eigen::Vector3d x =
        mesh.nodes[static_cast<std::size_t>(mesh.faults[0].nodes[k].minus_node)];
    const std::string expected =
        std::string("n") + (x.y() == 0 ? "" : "s") + (x.z() == -3 ? "" : "d");
    EXPECT_EQ(components(dofs, static_cast<int>(k)), expected) << x.transpose();
  }
}

TEST(DofMap, RollerAcrossADippingFaultLocksItsNodes) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {test::through(2, kCells)}, test::shear_to_dip(60));
  const DofMap dofs(mesh, test::rollers({Side::y_min, Side::z_min}), 0);
  EXPECT_EQ(dofs.locked_positions().size(), 3u);
  for (std::size_t k = 0; k < mesh.faults[0].nodes.size(); ++k) {
    const FaultNode& node = mesh.faults[0].nodes[k];
    const Eigen::Vector3d x = mesh.nodes[static_cast<std::size_t>(node.minus_node)];
    const std::string expected = x.z() == -3 ? "" : x.y() == 0 ? "nd" : "nsd";
    EXPECT_EQ(components(dofs, static_cast<int>(k)), expected) << x.transpose();
    if (x.z() != -3) continue;
    const auto minus = dofs.terms(node.minus_node, 0), plus = dofs.terms(node.plus_node, 0);
    ASSERT_EQ(minus.size(), 1U);
    EXPECT_EQ(minus[0].unknown, plus[0].unknown);
  }
}

TEST(DofMap, FixedNormalLocks) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {test::through(2, kCells)});
  const std::vector<DisplacementCondition> fixed = {
      {Side::z_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}};
  EXPECT_EQ(DofMap(mesh, fixed, 0).locked_positions().size(), 3u);
}

TEST(DofMap, PrescribedValuesComeFromTheFirstConditionOnAnEdge) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {});
  std::vector<DisplacementCondition> conditions = test::rollers({Side::x_min});
  conditions.push_back(
      {Side::z_max, {true, false, true}, Eigen::Vector3d(7, 8, 9), Eigen::Matrix3d::Identity(), 1});
  const DofMap dofs(mesh, conditions, 2);
  EXPECT_FALSE(dofs.has_prescribed(0));
  EXPECT_TRUE(dofs.has_prescribed(1));
  const Eigen::Matrix3Xd u =
      nodal_displacement(mesh, dofs, Eigen::VectorXd::Constant(dofs.n_unknowns(), 55), {3, 2});
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Eigen::Vector3d& x = mesh.nodes[i];
    const Eigen::Index n = static_cast<Eigen::Index>(i);
    EXPECT_EQ(u(0, n), x.x() == 0 ? 0 : x.z() == 0 ? 2 * (7 + x.x()) : 55);
    EXPECT_EQ(u(1, n), 55);
    EXPECT_EQ(u(2, n), x.z() == 0 ? 2 * (9 + x.z()) : 55);
  }
}

TEST(DofMap, PlaneStrainTiesAndRemovesTheJumpAlongY) {
  const std::array<int, 3> n = {4, 1, 3};
  Mesh mesh = make_box(n, {4, 5, 3}, {test::through(2, n)}, test::shear_to_dip(70));
  test::make_plane_strain(mesh, 5);
  ASSERT_EQ(mesh.faults[0].nodes.size(), 4u);
  const DofMap dofs(mesh, test::rollers({Side::x_min}), 0);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(components(dofs, k), "nd");
  const Eigen::Matrix3Xd u =
      nodal_displacement(mesh, dofs, Eigen::VectorXd::Random(dofs.n_unknowns()), {});
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    EXPECT_EQ(u.col(static_cast<Eigen::Index>(i)), u.col(mesh.tied_to[i]));
    EXPECT_EQ(u(1, static_cast<Eigen::Index>(i)), 0);
  }
}

TEST(DofMap, PinsAsManyMotionsAsTheBodyHas) {
  Mesh mesh = make_box({4, 1, 3}, {4, 1, 3}, {});
  EXPECT_EQ(DofMap(mesh, {}, 0).n_unknowns(), 3 * 40 - 6);
  Mesh tied = mesh;  // x sides move alike: it can neither turn about y nor about z
  for (std::size_t i = 0; i < tied.nodes.size(); ++i) {
    if (tied.nodes[i].x() == 4) tied.tied_to[i] = static_cast<int>(i) - 4;
  }
  EXPECT_EQ(DofMap(tied, {}, 0).n_unknowns(), 3 * 32 - 4);
  test::make_plane_strain(mesh, 1);
  EXPECT_EQ(DofMap(mesh, {}, 0).n_unknowns(), 2 * 20 - 3);
}

TEST(Pieces, FaultsCutTheBodyAndHoldItTogether) {
  const Mesh mesh =
      make_box(kCells, {4, 2, 3}, {test::through(1, kCells), test::through(3, kCells)});
  const Pieces pieces = find_pieces(mesh);
  EXPECT_EQ(pieces.n_pieces, 3);
  EXPECT_EQ(pieces.n_bodies, 1);
  EXPECT_EQ(pieces.n_cells, (std::vector<int>{6, 12, 6}));
  EXPECT_EQ(find_pieces(test::without_faults(mesh)).n_bodies, 3);
  const Mesh patch = make_box(kCells, {4, 2, 3}, {{2, 0, 2, 1, 3}});
  EXPECT_EQ(find_pieces(patch).n_pieces, 1);
}

TEST(RigidModes, AreDescribedInWords) {
  const Mesh mesh = make_box(kCells, {4, 2, 3}, {});
  const auto words = [&](const std::vector<BoundaryGroup>& sides) {
    const DofMap dofs(mesh, test::rollers(sides), 0);
    const auto fixed = [&](int node, int c) { return dofs.terms(node, c).empty(); };
    return describe(rigid_modes(
        mesh, [](int) { return true; }, fixed));
  };
  EXPECT_EQ(words({Side::z_min}), "move along x, move along y, turn about z");
  EXPECT_EQ(words({Side::z_min, Side::y_min}), "move along x");
  EXPECT_EQ(words({Side::z_min, Side::y_min, Side::x_max}), "");
}

}  // namespace
}  // namespace faultsim
