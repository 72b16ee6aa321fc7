#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/elasticity/elasticity.h"
#include "simulator/elasticity/rigid_modes.h"
#include "tests/unit/mesh/cut_body.h"
#include "tests/unit/mesh/random_faults.h"

/// Bodies that random faults cut: what must hold of their unknowns and of their stiffness.
namespace faultsim {
namespace {

using Eigen::MatrixXd;
using test::Simplices;

/// The faults of the cube's faces, from the first to the last or in another order.
UncutMesh body_with_faults(const Simplices& cube, int n, int n_faults, std::mt19937& random) {
  UncutMesh body = test::body_of(cube, n, {});
  body.faults.resize(static_cast<std::size_t>(n_faults));
  for (const SharedFace& face : cube.faces)
    if (face.fault >= 0)
      body.faults[static_cast<std::size_t>(face.fault)].facets.push_back(face.nodes);
  std::erase_if(body.faults, [](const FacetGroup& fault) { return fault.facets.empty(); });
  for (std::size_t f = 0; f < body.faults.size(); ++f)
    body.faults[f].name = "F" + std::to_string(f);
  std::shuffle(body.faults.begin(), body.faults.end(), random);
  return body;
}

/// P without the pins, 3 n_nodes x 3 n_nodes: u = ū + Σ weight R g at every node.
MatrixXd all_motions(const Mesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.nodes.size());
  MatrixXd p = MatrixXd::Zero(n, n);
  std::vector<int> first(mesh.nodes.size()), column(mesh.nodes.size(), -1);
  std::iota(first.begin(), first.end(), 0);
  for (const NodeCopy& copy : mesh.copies) first[static_cast<std::size_t>(copy.node)] = copy.first;
  int next = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    int& at = column[static_cast<std::size_t>(first[k])];
    if (at < 0) at = next++;
    p(static_cast<Eigen::Index>(k), at) = 1;
  }
  std::vector<int> begin;
  for (const FaultSurface& fault : mesh.faults) {
    begin.push_back(next);
    next += static_cast<int>(fault.nodes.size());
  }
  for (const NodeCopy& copy : mesh.copies)
    for (const JumpShare& share : copy.shares)
      p(copy.node, begin[static_cast<std::size_t>(share.fault)] + share.node) = share.weight;
  return p.leftCols(next);
}

/// How many eigenvalues of a symmetric matrix, whose lower triangle is given, are below a bound.
Eigen::Index n_below(const SparseMatrix& lower, double bound) {
  Eigen::SparseMatrix<double> shifted = lower;
  for (Eigen::Index k = 0; k < shifted.cols(); ++k) shifted.coeffRef(k, k) -= bound;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor(shifted);
  EXPECT_EQ(factor.info(), Eigen::Success);
  return (factor.vectorD().array() < 0).count();
}

void expect_sound(const Mesh& mesh) {
  // No displacement of the copies is said in two ways.
  const MatrixXd p = all_motions(mesh);
  EXPECT_EQ(Eigen::ColPivHouseholderQR<MatrixXd>(p).rank(), p.cols());
  // What is pinned holds one piece; each other one moves freely in six ways, and nothing else does.
  const DofMap dofs(mesh, {}, 0);
  const SparseMatrix k = assemble_stiffness(mesh, {{1, 0.2}}, dofs, true);
  const double largest = k.diagonal().maxCoeff();
  const Eigen::Index n_free = 6 * (find_pieces(mesh).n_pieces - 1);
  EXPECT_EQ(n_below(k, 1e-11 * largest), n_free);
  EXPECT_EQ(n_below(k, 1e-6 * largest), n_free);
}

struct Found {
  int cut = 0, refused = 0, most_copies = 0, loose = 0;
};

/// Random sets of faults, in random order; those of which no single one separates the rock
/// somewhere are refused.
Found try_sets(int n_sets, int dimensions) {
  std::mt19937 random(17);
  Found found;
  for (int set = 0; set < n_sets; ++set) {
    const int n = 2 + set % 2, n_faults = 1 + set % 4;
    Simplices cube = test::made_of(n, 3);
    // One that goes through all makes loose pieces, which few of the others do.
    if (set % 4 == 0) test::add_fault(cube, n_faults, {1, 0, -1}, 0, test::everywhere);
    test::add_random_faults(cube, n, n_faults, dimensions, random);
    const UncutMesh body = body_with_faults(cube, n, n_faults + 1, random);
    try {
      const Mesh mesh = cut(body, "");
      expect_sound(mesh);
      ++found.cut;
      std::map<int, int> copies;
      for (const NodeCopy& copy : mesh.copies)
        found.most_copies = std::max(found.most_copies, ++copies[copy.first]);
      found.loose += find_pieces(mesh).n_pieces > 1;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cut the rock only together"), std::string::npos)
          << error.what();
      ++found.refused;
    }
  }
  return found;
}

void expect_all_kinds(const Found& found, int n_sets) {
  EXPECT_GT(found.cut, n_sets / 2);
  EXPECT_GT(found.refused, 0);
  EXPECT_GE(found.most_copies, 4);
  EXPECT_GT(found.loose, n_sets / 10);
}

TEST(RandomFaults, LeaveEachPieceItsRigidMotionsAndNothingElse) {
  expect_all_kinds(try_sets(100, 3), 100);
  expect_all_kinds(try_sets(100, 2), 100);
}

TEST(RandomFaults, SlowManyMoreDoSoToo) {
  expect_all_kinds(try_sets(1000, 3), 1000);
  expect_all_kinds(try_sets(1000, 2), 1000);
}

}  // namespace
}  // namespace faultsim
