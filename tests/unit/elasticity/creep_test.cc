#include "simulator/elasticity/creep.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <set>

#include "tests/unit/elasticity/test_box.h"

namespace faultsim {
namespace {

using test::all_sides;
using test::make_box;
using test::solve;

constexpr double kElastic = std::numeric_limits<double>::infinity();
const MaxwellStep kInstant{};  // decay 1, shear factor 1

/// Sheared and distorted cells of three materials in layers, two of them viscous, and a fault.
Mesh layered_mesh() {
  Mesh mesh = make_box({5, 3, 6}, {50, 30, 60}, {{2, 0, 3, 1, 5}}, test::shear_to_dip(70));
  test::distort(mesh, 10, 0.12);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const double z = mesh.nodes[static_cast<std::size_t>(mesh.cells[cell][0])].z();
    mesh.material[cell] = z > -25 ? 0 : z > -45 ? 1 : 2;
  }
  return mesh;
}
const std::vector<ElasticMaterial> kMaterials = {{40e9, 0.3}, {11e9, 0.15}, {8e9, 0.25}};
const std::vector<double> kViscosity = {1e17, kElastic, 1e15};

/// Unit steps of as many materials as creep.
std::vector<MaxwellStep> steps(const CreepCells& cells, const MaxwellStep& step) {
  return std::vector<MaxwellStep>(cells.materials().size(), step);
}

/// s = 2G e(u) makes the forces of the deviatoric half of the stiffness, of each material by
/// itself: K is linear in the shear factor.
TEST(CreepCells, ForcesOfAnInstantaneousDeviatorAreDeviatoricStiffness) {
  const Mesh mesh = layered_mesh();
  const DofMap dofs(mesh, test::rollers({Side::z_min}), 1);
  const CreepCells cells(mesh, kMaterials, kViscosity, dofs);
  ASSERT_EQ(cells.materials().size(), 2U);
  const Eigen::VectorXd x = 1e-3 * Eigen::VectorXd::Random(dofs.n_unknowns());
  CreepStress stress = cells.at_rest();
  cells.advance(nodal_displacement(mesh, dofs, x, {}), steps(cells, kInstant), stress);
  for (const bool b_bar : {true, false}) {
    const auto forces = [&](const std::vector<ElasticMaterial>& materials) {
      const SparseMatrix k = assemble_stiffness(mesh, materials, dofs, b_bar);
      return Eigen::VectorXd(k.selfadjointView<Eigen::Lower>() * x);
    };
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<ElasticMaterial> half = kMaterials;
      half[static_cast<std::size_t>(cells.materials()[i])].shear_factor = 0.5;
      const Eigen::VectorXd expected = 2 * (forces(kMaterials) - forces(half));
      const Eigen::VectorXd found = stress.force.col(static_cast<Eigen::Index>(i));
      EXPECT_LT((found - expected).norm(), 1e-13 * forces(kMaterials).norm()) << i;
      EXPECT_GT(expected.norm(), 0.01 * forces(kMaterials).norm());
    }
  }
}

/// A uniform deviator is in equilibrium with the tractions s n on the sides: all six components.
TEST(CreepCells, ForcesOfUniformShearAreTractionsOnTheSides) {
  Mesh mesh = make_box({4, 3, 3}, {40, 30, 30}, {}, test::shear_to_dip(65));
  test::distort(mesh, 10, 0.15);
  const std::vector<ElasticMaterial> salt = {{40e9, 0.3}};
  const DofMap dofs(mesh, {}, 1);
  const CreepCells cells(mesh, salt, {1e17}, dofs);
  EXPECT_EQ(cells.n_cells(), 36);
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.7, 0.2, 0.9, -0.4, 1.6;
  gradient *= 1e-4;
  Eigen::Matrix3Xd u(3, static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.col(static_cast<Eigen::Index>(i)) = gradient * mesh.nodes[i];
  }
  CreepStress stress = cells.at_rest();
  cells.advance(u, {{0.5, 0.5, 0.25}}, stress);
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const Eigen::Matrix3d s = 0.25 * 2 * shear_modulus(salt[0]) *
                            (strain - strain.trace() / 3 * Eigen::Matrix3d::Identity());
  for (Eigen::Index cell = 0; cell < stress.deviator.cols(); ++cell) {
    for (Eigen::Index g = 0; g < 8; ++g) {
      Eigen::Matrix<double, 6, 1> expected;
      expected << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
      const auto found = stress.deviator.col(cell).segment<6>(6 * g);
      EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
    }
  }
  const Eigen::VectorXd expected = stress_load(mesh, dofs, all_sides(), s);
  EXPECT_LT((stress.force.col(0) - expected).norm(), 1e-12 * expected.norm());
}

TEST(CreepCells, RigidMotionAndDilatationDoNothing) {
  const Mesh mesh = layered_mesh();
  const DofMap dofs(mesh, {}, 1);
  const CreepCells cells(mesh, kMaterials, kViscosity, dofs);
  Eigen::Matrix3d turn;
  turn << 1e-3, -2e-4, 3e-4, 2e-4, 1e-3, 5e-4, -3e-4, -5e-4, 1e-3;
  Eigen::Matrix3Xd u(3, static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3d(1, -2, 3) + turn * mesh.nodes[i];
  }
  CreepStress stress = cells.at_rest();
  cells.advance(u, steps(cells, kInstant), stress);
  EXPECT_LT(stress.deviator.cwiseAbs().maxCoeff(), 2 * 16e9 * 1e-3 * 1e-11);
}

/// Of each material with its own step; what does not creep has no part.
TEST(CreepCells, EachMaterialDecaysByItsOwnStep) {
  const Mesh mesh = layered_mesh();
  const DofMap dofs(mesh, test::rollers({Side::z_min}), 1);
  const CreepCells cells(mesh, kMaterials, kViscosity, dofs);
  EXPECT_EQ(cells.n_cells(),
            static_cast<int>(std::count_if(mesh.material.begin(), mesh.material.end(),
                                           [](int m) { return m != 1; })));
  const std::set<int> found(cells.materials().begin(), cells.materials().end());
  EXPECT_EQ(found, (std::set<int>{0, 2}));
  const Eigen::Matrix3Xd u =
      nodal_displacement(mesh, dofs, 1e-3 * Eigen::VectorXd::Random(dofs.n_unknowns()), {});
  CreepStress first = cells.at_rest();
  cells.advance(u, {{1, 0, 0.5}, {1, 0, 0.125}}, first);
  CreepStress second = first;
  cells.advance(Eigen::Matrix3Xd::Zero(3, u.cols()), {{0.25, 0.75, 0.9}, {0, 1, 0.7}}, second);
  EXPECT_LT((second.force.col(0) - 0.25 * first.force.col(0)).norm(),
            1e-14 * first.force.col(0).norm());
  EXPECT_EQ(second.force.col(1).norm(), 0);
  EXPECT_GT(first.force.col(1).norm(), 0);
  // Ten increments at decay 1 are one, to rounding.
  CreepStress whole = cells.at_rest(), parts = cells.at_rest();
  cells.advance(u, steps(cells, kInstant), whole);
  for (int i = 0; i < 10; ++i) cells.advance(0.1 * u, steps(cells, kInstant), parts);
  EXPECT_LT((parts.deviator - whole.deviator).norm(), 1e-14 * whole.deviator.norm());
  EXPECT_LT((parts.force - whole.force).norm(), 1e-14 * whole.force.norm());
}

TEST(CreepCells, PlaneStrainIsPerMetreWhateverTheThickness) {
  const auto forces = [](double thickness) {
    Mesh mesh = make_box({4, 1, 4}, {40, thickness, 40}, {}, test::shear_to_dip(70));
    test::make_plane_strain(mesh, thickness);
    const DofMap dofs(mesh, test::rollers({Side::z_min, Side::x_min}), 1);
    const std::vector<ElasticMaterial> salt = {{40e9, 0.3}};
    const CreepCells cells(mesh, salt, {1e17}, dofs);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(dofs.n_unknowns(), -1e-3, 2e-3);
    CreepStress stress = cells.at_rest();
    cells.advance(nodal_displacement(mesh, dofs, x, {}), {kInstant}, stress);
    std::vector<ElasticMaterial> half = salt;
    half[0].shear_factor = 0.5;
    const Eigen::VectorXd expected =
        2 * ((assemble_stiffness(mesh, salt, dofs, true).selfadjointView<Eigen::Lower>() * x) -
             (assemble_stiffness(mesh, half, dofs, true).selfadjointView<Eigen::Lower>() * x));
    EXPECT_LT((stress.force.col(0) - expected).norm(), 1e-12 * expected.norm()) << thickness;
    return Eigen::VectorXd(stress.force.col(0));
  };
  EXPECT_LT((forces(1) - forces(8)).norm(), 1e-12 * forces(1).norm());
}

/// Long steps leave rock that hardly shears: ν → ½. A uniform strain is exact in distorted cells.
TEST(RelaxedStiffness, PassesThePatchTestWhereNearlyIncompressible) {
  Mesh mesh = make_box({4, 3, 3}, {40, 30, 30}, {}, test::shear_to_dip(65));
  test::distort(mesh, 10, 0.15);
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.7, 0.2, 0.9, -0.4, 1.6;
  gradient *= 1e-4;
  const DofMap dofs(mesh, test::affine({1e-3, 2e-3, -3e-3}, gradient), 1);
  for (const ElasticMaterial& material :
       {ElasticMaterial{40e9, 0.4999}, {40e9, 0.3, 1e-3}, {40e9, 0.3, 1e-6}}) {
    for (const bool b_bar : {true, false}) {
      const SparseMatrix k = assemble_stiffness(mesh, {material}, dofs, b_bar);
      const Eigen::VectorXd x = solve(k, displacement_load(mesh, {material}, dofs, 0, b_bar));
      const Eigen::Matrix3Xd u = nodal_displacement(mesh, dofs, x, {1});
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        const Eigen::Vector3d exact = Eigen::Vector3d(1e-3, 2e-3, -3e-3) + gradient * mesh.nodes[i];
        EXPECT_LT((u.col(static_cast<Eigen::Index>(i)) - exact).norm(), 1e-9)
            << material.poisson_ratio << " " << material.shear_factor;
      }
    }
  }
}

/// Tip deflection of a clamped plane-strain beam under an end shear stress q, Timoshenko:
/// P L³/(3 E' I) + 6 P L/(5 G A), E' = E/(1 − ν²), per metre.
class Cantilever {
 public:
  /// Deflection on the mesh over the formula's.
  static double share(const ElasticMaterial& material, bool b_bar) {
    constexpr double kLength = 20, kHeight = 2, kShear = 1e3;
    Mesh mesh = make_box({80, 1, 8}, {kLength, 1, kHeight}, {});
    test::make_plane_strain(mesh, 1);
    const DofMap dofs(
        mesh,
        {{Side::x_min, {true, true, true}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1}},
        1);
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress(0, 2) = stress(2, 0) = kShear;
    const Eigen::VectorXd x = solve(assemble_stiffness(mesh, {material}, dofs, b_bar),
                                    stress_load(mesh, dofs, {Side::x_max}, stress));
    const double tip = nodal_displacement(mesh, dofs, x, {}).row(2).maxCoeff();
    // With a shear factor φ: G' = φ G at the same K, and E' = 4 G' (3K + G')/(3K + 4G').
    const double G = shear_modulus(material) * material.shear_factor;
    const double K = material.youngs_modulus / (3 * (1 - 2 * material.poisson_ratio));
    const double plane_modulus = 4 * G * (3 * K + G) / (3 * K + 4 * G);
    const double force = kShear * kHeight, inertia = kHeight * kHeight * kHeight / 12;
    return tip / (force * kLength * kLength * kLength / (3 * plane_modulus * inertia) +
                  1.2 * force * kLength / (G * kHeight));
  }
};

TEST(RelaxedStiffness, BendsWithoutLocking) {
  const ElasticMaterial easy{1e9, 0.3}, hard{1e9, 0.4999}, liquid{1e9, 0.3, 1e-4};
  EXPECT_NEAR(Cantilever::share(easy, true), 1, 0.01);
  EXPECT_NEAR(Cantilever::share(hard, true), 1, 0.02);
  EXPECT_NEAR(Cantilever::share(liquid, true), 1, 0.02);
  EXPECT_NEAR(Cantilever::share(easy, false), 1, 0.02);
  EXPECT_LT(Cantilever::share(hard, false), 0.5);
  EXPECT_LT(Cantilever::share(liquid, false), 0.5);
}

}  // namespace
}  // namespace faultsim
