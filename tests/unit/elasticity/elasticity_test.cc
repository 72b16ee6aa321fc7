#include "simulator/elasticity/elasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "simulator/elasticity/element.h"
#include "tests/unit/elasticity/test_box.h"

namespace faultsim {
namespace {

using test::all_sides;
using test::make_box;
using test::solve;

const std::vector<ElasticMaterial> kRock = {{11e9, 0.15}};

Eigen::Matrix3d hooke(const ElasticMaterial& material, const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = shear_modulus(material);
  const double lambda = 2 * mu * material.poisson_ratio / (1 - 2 * material.poisson_ratio);
  return lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * mu * strain;
}

Eigen::Matrix3d some_gradient() {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.7, 0.2, 0.9, -0.4, 1.6;
  return 1e-4 * gradient;
}

Mesh distorted_box() {
  Mesh mesh = make_box({4, 3, 3}, {40, 30, 30}, {}, test::shear_to_dip(65));
  test::distort(mesh, 10, 0.15);
  return mesh;
}

Element hexahedron(const Mesh& mesh, std::size_t cell) {
  std::array<Eigen::Vector3d, 8> nodes;
  for (std::size_t a = 0; a < 8; ++a)
    nodes[a] = mesh.nodes[static_cast<std::size_t>(mesh.cells[cell][a])];
  return make_hexahedron(nodes);
}

TEST(Element, RigidMotionHasNoEnergy) {
  const Mesh mesh = distorted_box();
  for (bool b_bar : {true, false}) {
    const ElementMatrix k = element_stiffness(hexahedron(mesh, 13), kRock[0], b_bar);
    EXPECT_EQ(k, k.transpose());
    Eigen::Matrix<double, 24, 6> rigid;
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3d x =
          mesh.nodes[static_cast<std::size_t>(mesh.cells[13][static_cast<std::size_t>(a)])];
      rigid.block<3, 3>(3 * a, 0).setIdentity();
      for (int i = 0; i < 3; ++i) {
        rigid.block<3, 1>(3 * a, 3 + i) = Eigen::Vector3d::Unit(i).cross(x) / 10;
      }
    }
    EXPECT_LT((k * rigid).norm(), 1e-12 * k.norm() * rigid.norm());
    const Eigen::SelfAdjointEigenSolver<ElementMatrix> eigen(k);
    EXPECT_GT(eigen.eigenvalues()[6], 1e-4 * eigen.eigenvalues()[23]) << "a spurious mode";
  }
}

TEST(Element, BBarChangesNothingForUniformStrain) {
  const Mesh mesh = distorted_box();
  const Element element = hexahedron(mesh, 20);
  Eigen::Matrix<double, 24, 1> u;
  for (int a = 0; a < 8; ++a) {
    const int node = mesh.cells[20][static_cast<std::size_t>(a)];
    u.segment<3>(3 * a) = some_gradient() * mesh.nodes[static_cast<std::size_t>(node)];
  }
  const Eigen::Matrix<double, 24, 1> plain = element_stiffness(element, kRock[0], false) * u;
  const Eigen::Matrix<double, 24, 1> averaged = element_stiffness(element, kRock[0], true) * u;
  EXPECT_LT((plain - averaged).norm(), 1e-11 * plain.norm());
  const Eigen::Matrix3d stress = hooke(kRock[0], some_gradient());
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d force =
        element.volume * stress * element.mean_gradient.row(a).transpose();
    EXPECT_LT((averaged.segment<3>(3 * a) - force).norm(), 1e-11 * plain.norm());
  }
}

TEST(Elasticity, UniformStressOnAPinnedBodyGivesALinearField) {
  const Mesh mesh = distorted_box();
  const DofMap dofs(mesh, {}, 1);
  EXPECT_TRUE(dofs.pinned());
  EXPECT_EQ(dofs.n_unknowns(), 3 * static_cast<int>(mesh.nodes.size()) - 6);
  const Eigen::Matrix3d strain = 0.5 * (some_gradient() + some_gradient().transpose());
  const Eigen::Matrix3d stress = hooke(kRock[0], strain);
  const SparseMatrix k = assemble_stiffness(mesh, kRock, dofs, true);
  const Eigen::VectorXd x = solve(k, stress_load(mesh, dofs, all_sides(), stress));
  const Eigen::Matrix3Xd u = nodal_displacement(mesh, dofs, x, {});
  // The displacement gradient of each cell has the strain as its symmetric part.
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const Element element = hexahedron(mesh, cell);
    for (const auto& gradient : element.gradient) {
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      for (int a = 0; a < 8; ++a) {
        h += u.col(mesh.cells[cell][static_cast<std::size_t>(a)]) * gradient.row(a);
      }
      EXPECT_LT((0.5 * (h + h.transpose()) - strain).norm(), 1e-10 * strain.norm());
    }
  }
}

TEST(Elasticity, AffineDisplacementOnTheSidesIsExactInside) {
  for (bool b_bar : {true, false}) {
    const Mesh mesh = distorted_box();
    const Eigen::Vector3d translation(1e-3, 2e-3, -3e-3);
    const DofMap dofs(mesh, test::affine(translation, some_gradient()), 1);
    EXPECT_FALSE(dofs.pinned());
    const SparseMatrix k = assemble_stiffness(mesh, kRock, dofs, b_bar);
    const double factor = 0.5;
    const Eigen::VectorXd f = displacement_load(mesh, kRock, dofs, 0, b_bar);
    const Eigen::Matrix3Xd u = nodal_displacement(mesh, dofs, factor * solve(k, f), {factor});
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Eigen::Vector3d exact = factor * (translation + some_gradient() * mesh.nodes[i]);
      EXPECT_LT((u.col(static_cast<Eigen::Index>(i)) - exact).norm(), 1e-12);
    }
  }
}

// V2: a laterally confined column with free top shortens by α|Δp| c_m h.
TEST(Elasticity, ConfinedLayerCompactsExactly) {
  Mesh mesh = make_box({2, 2, 6}, {100, 100, 600}, {});
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const double z = mesh.nodes[static_cast<std::size_t>(mesh.cells[cell][0])].z();
    if (z >= -400.1 && z < -250) {  // two rows of 100 m
      mesh.region[cell] = 0;
      mesh.region_fraction[cell] = 1;
    }
  }
  const DofMap dofs(
      mesh, test::rollers({Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min}), 1);
  for (const auto& [biot, shortening] : {std::pair(1.0, 0.34438503), {0.6, 0.20663102}}) {
    const SparseMatrix k = assemble_stiffness(mesh, kRock, dofs, true);
    const Eigen::VectorXd f = biot * -20e6 * pressure_load(mesh, dofs, 0);
    const Eigen::Matrix3Xd u = nodal_displacement(mesh, dofs, solve(k, f), {});
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const double z = mesh.nodes[i].z();
      const double share = z > -201 ? 1 : z > -301 ? 0.5 : 0;
      EXPECT_NEAR(u(2, static_cast<Eigen::Index>(i)), -share * shortening, 5e-9);
    }
  }
}

TEST(Elasticity, PressureLoadsACellByTheShareOfItThatLiesInTheRegion) {
  Mesh mesh = distorted_box();
  const DofMap dofs(mesh, {}, 1);
  mesh.region[13] = 0;
  mesh.region_fraction[13] = 1;
  const Eigen::VectorXd whole = pressure_load(mesh, dofs, 0);
  mesh.region_fraction[13] = 0.25;
  const Eigen::VectorXd quarter = pressure_load(mesh, dofs, 0);
  EXPECT_GT(whole.norm(), 0);
  EXPECT_LT((quarter - 0.25 * whole).norm(), 1e-12 * whole.norm());
}

// Front and back of a slice are not the outside of the body: what its neighbours pull is not a
// load.
TEST(Elasticity, NothingPullsAtFrontAndBackOfASlice) {
  Mesh mesh = make_box({4, 1, 4}, {40, 5, 40}, {}, test::shear_to_dip(70));
  const Eigen::Matrix3d stress = hooke(kRock[0], some_gradient());
  const std::vector<BoundaryGroup> sides = {Side::y_min, Side::y_max};
  EXPECT_GT(nodal_stress_forces(mesh, sides, stress).norm(), 0) << "a body of its own";
  test::make_plane_strain(mesh, 5);
  EXPECT_EQ(nodal_stress_forces(mesh, sides, stress).norm(), 0);
  EXPECT_GT(nodal_stress_forces(mesh, {Side::x_max}, stress).norm(), 0);
}

TEST(Elasticity, BBarDoesNotLockWhenNearlyIncompressible) {
  // Bending of a cantilever: plain elements lock at ν → ½, mean dilatation does not.
  const Mesh mesh = make_box({10, 1, 3}, {10, 1, 1.5}, {});
  std::vector<DisplacementCondition> clamp = {
      {Side::x_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}};
  const DofMap dofs(mesh, clamp, 1);
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(2, 0) = shear(0, 2) = 1e3;
  const auto deflection = [&](double nu, bool b_bar) {
    const std::vector<ElasticMaterial> material = {{1e9, nu}};
    const SparseMatrix k = assemble_stiffness(mesh, material, dofs, b_bar);
    const Eigen::VectorXd x = solve(k, stress_load(mesh, dofs, {Side::x_max}, shear));
    return nodal_displacement(mesh, dofs, x, {}).row(2).maxCoeff();
  };
  EXPECT_GT(deflection(0.4999, true), 0.8 * deflection(0.3, true));
  EXPECT_LT(deflection(0.4999, false), 0.5 * deflection(0.3, false));
}

TEST(Elasticity, PlaneStrainIsPerMetreWhateverTheThickness) {
  const auto run = [](double thickness) {
    Mesh mesh = make_box({4, 1, 4}, {40, thickness, 40}, {}, test::shear_to_dip(70));
    test::make_plane_strain(mesh, thickness);
    mesh.region[5] = 0;
    mesh.region_fraction[5] = 0.5;
    const DofMap dofs(mesh, test::rollers({Side::z_min, Side::x_min}), 2);
    const SparseMatrix k = assemble_stiffness(mesh, kRock, dofs, true);
    Eigen::VectorXd f = pressure_load(mesh, dofs, 0);
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress(0, 0) = 2;
    stress(1, 1) = 5;
    f += stress_load(mesh, dofs, all_sides(), stress);
    return std::pair(Eigen::MatrixXd(k), Eigen::MatrixXd(f));
  };
  const auto [k_thin, f_thin] = run(1);
  const auto [k_thick, f_thick] = run(8);
  EXPECT_LT((k_thin - k_thick).norm(), 1e-12 * k_thin.norm());
  EXPECT_LT((f_thin - f_thick).norm(), 1e-12 * f_thin.norm());
}

TEST(Elasticity, AssemblyEqualsThePlainSumOverCells) {
  const std::array<int, 3> n = {4, 3, 3};
  Mesh mesh = make_box(n, {40, 30, 30}, {{2, 1, 3, 0, 2}}, test::shear_to_dip(60));
  test::distort(mesh, 10, 0.1);
  const DofMap dofs(mesh, test::rollers({Side::z_min, Side::x_min, Side::y_min}), 0);
  Eigen::MatrixXd p =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()), dofs.n_unknowns());
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    for (int c = 0; c < 3; ++c) {
      for (const DofMap::Term& t : dofs.terms(node, c)) p(3 * node + c, t.unknown) = t.coefficient;
    }
  }
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(p.rows(), p.rows());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const ElementMatrix k_e = element_stiffness(hexahedron(mesh, cell), kRock[0], true);
    for (int a = 0; a < 8; ++a) {
      for (int b = 0; b < 8; ++b) {
        full.block<3, 3>(3 * mesh.cells[cell][static_cast<std::size_t>(a)],
                         3 * mesh.cells[cell][static_cast<std::size_t>(b)]) +=
            k_e.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  const SparseMatrix k = assemble_stiffness(mesh, kRock, dofs, true);
  const Eigen::MatrixXd expected = (p.transpose() * full * p).triangularView<Eigen::Lower>();
  EXPECT_LT((Eigen::MatrixXd(k) - expected).norm(), 1e-14 * expected.norm());
  EXPECT_GT(dofs.n_jump(), 0);
  const SparseMatrix again = assemble_stiffness(mesh, kRock, dofs, true);
  EXPECT_TRUE(std::equal(k.valuePtr(), k.valuePtr() + k.nonZeros(), again.valuePtr()));
}

}  // namespace
}  // namespace faultsim
