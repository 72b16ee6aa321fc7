#include "simulator/mesh/sectors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "tests/unit/mesh/random_faults.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using test::add_fault;
using test::add_random_faults;
using test::everywhere;
using test::kNormals;
using test::made_of;
using test::Simplices;
using ::testing::ElementsAre;

/// The copies that the corners of cells are of: those of a node are one where a way from cell to
/// cell leads around it that meets no fault. Judges the splitter, by all corners at once.
struct Corners {
  explicit Corners(const Simplices& mesh) : corners_of(mesh.cells.front().size()) {
    root.resize(mesh.cells.size() * corners_of);
    std::iota(root.begin(), root.end(), 0);
    for (const SharedFace& face : mesh.faces) {
      if (face.fault >= 0) continue;
      for (const int node : face.nodes)
        if (node >= 0) root[of(mesh, face.cells[0], node)] = of(mesh, face.cells[1], node);
    }
  }
  int of(const Simplices& mesh, int cell, int node) {
    int k = cell * static_cast<int>(corners_of) +
            static_cast<int>(std::ranges::find(mesh.cells[cell], node) - mesh.cells[cell].begin());
    while (root[k] != k) k = root[k];
    return k;
  }
  std::size_t corners_of;
  std::vector<int> root;
};

std::vector<int> copies_of_nodes(const Simplices& mesh) {
  Corners corners(mesh);
  std::vector<std::set<int>> copies(mesh.nodes.size());
  for (int c = 0; c < std::ssize(mesh.cells); ++c)
    for (const int node : mesh.cells[c]) copies[node].insert(corners.of(mesh, c, node));
  std::vector<int> n;
  for (const auto& of : copies) n.push_back(static_cast<int>(of.size()));
  return n;
}

int copy_of(const SplitNode& node, int cell) {
  for (int s = 0; s < std::ssize(node.sectors); ++s)
    if (std::ranges::binary_search(node.sectors[s], cell)) return s;
  return -1;
}

/// u_s = ū + Σ ±½ g_j of the copies of a node: a row per copy.
Eigen::MatrixXd weights(const SplitNode& node) {
  const auto m = std::ssize(node.sectors);
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(m, 1 + std::ssize(node.jumps));
  w.col(0).setOnes();
  for (int j = 0; j < std::ssize(node.jumps); ++j) {
    for (const int s : node.jumps[j].minus) w(s, j + 1) = -0.5;
    for (const int s : node.jumps[j].plus) w(s, j + 1) = 0.5;
  }
  return w;
}

/// What must hold of any mesh whatever its faults are.
void expect_sound(const Simplices& mesh, const SplitNodes& found) {
  const std::vector<int> copies = copies_of_nodes(mesh);
  std::map<int, std::size_t> expected, seen;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (copies[node] > 1) expected[node] = static_cast<std::size_t>(copies[node]);
  for (const UndecidedNode& node : found.undecided) seen[node.node] = expected[node.node];
  for (const SplitNode& node : found.split) {
    seen[node.node] = node.sectors.size();
    const Eigen::MatrixXd w = weights(node);
    ASSERT_EQ(w.rows(), w.cols()) << "one jump fewer than copies";
    EXPECT_EQ(w.fullPivLu().rank(), w.rows());
  }
  EXPECT_EQ(seen, expected);
  // A face of a fault is between copies that a jump of this fault, and no other one, has apart.
  std::map<int, const SplitNode*> by_node;
  for (const SplitNode& node : found.split) by_node[node.node] = &node;
  for (const SharedFace& face : mesh.faces) {
    for (const int node : face.nodes) {
      if (face.fault < 0 || !by_node.contains(node)) continue;
      const SplitNode& split = *by_node[node];
      const int minus = copy_of(split, face.cells[0]), plus = copy_of(split, face.cells[1]);
      if (minus == plus) continue;  // it ends there, and others cut
      int n_between = 0;
      for (const NodeJump& jump : split.jumps) {
        const auto holds = [](const std::vector<int>& all, int s) {
          return std::ranges::find(all, s) != all.end();
        };
        if (holds(jump.minus, minus) && holds(jump.plus, plus)) {
          ++n_between;
          EXPECT_EQ(jump.fault, face.fault);
        }
        EXPECT_FALSE(holds(jump.minus, plus) && holds(jump.plus, minus)) << "sides swapped";
      }
      EXPECT_EQ(n_between, 1);
    }
  }
}

std::vector<int> sizes(const SplitNodes& found, int node) {
  for (const SplitNode& split : found.split) {
    if (split.node != node) continue;
    std::vector<int> of_faults;
    for (const NodeJump& jump : split.jumps) of_faults.push_back(jump.fault);
    return of_faults;
  }
  return {};
}

/// 4 × 4 squares of two triangles; node (i, j) is i + 5 j.
class SplitNodesOfSquares : public ::testing::Test {
 protected:
  SplitNodes split() const {
    SplitNodes found = split_nodes(mesh_.n_nodes(), mesh_.faces);
    expect_sound(mesh_, found);
    return found;
  }
  Simplices mesh_ = made_of(4, 2);
  static constexpr int kMiddle = 2 + 5 * 2;
};

TEST_F(SplitNodesOfSquares, AFaultEndsAtItsTip) {
  add_fault(mesh_, 0, Vector3d::UnitX(), 2, [](const Vector3d& x) { return x.y() > 2; });
  const SplitNodes found = split();
  ASSERT_EQ(found.split.size(), 2u) << "above the middle, which is the tip";
  EXPECT_EQ(found.split[0].node, 2 + 5 * 3);
  EXPECT_EQ(found.split[1].node, 2 + 5 * 4);
  const NodeJump& jump = found.split[0].jumps.at(0);
  for (const int cell : found.split[0].sectors[jump.plus.at(0)])
    EXPECT_GT(mesh_.centre_of_cell(cell).x(), 2);
}

TEST_F(SplitNodesOfSquares, AFaultThatEndsAtAnotherIsWithinItsSide) {
  add_fault(mesh_, 0, Vector3d::UnitY(), 2, [](const Vector3d& x) { return x.x() > 2; });
  add_fault(mesh_, 1, Vector3d::UnitX(), 2, everywhere);
  const SplitNodes found = split();
  EXPECT_THAT(sizes(found, kMiddle), ElementsAre(1, 0)) << "whichever was named first";
  EXPECT_THAT(sizes(found, 3 + 5 * 2), ElementsAre(0));
}

TEST_F(SplitNodesOfSquares, ACrossingHasThreeJumps) {
  add_fault(mesh_, 0, Vector3d::UnitY(), 2, everywhere);
  add_fault(mesh_, 1, Vector3d::UnitX(), 2, everywhere);
  EXPECT_THAT(sizes(split(), kMiddle), ElementsAre(0, 1, 1));
}

TEST_F(SplitNodesOfSquares, FaultsThatBothEndCutOnlyTogether) {
  add_fault(mesh_, 0, Vector3d::UnitY(), 2, [](const Vector3d& x) { return x.x() > 2; });
  add_fault(mesh_, 3, Vector3d::UnitX(), 2, [](const Vector3d& x) { return x.y() > 2; });
  const SplitNodes found = split();
  ASSERT_EQ(found.undecided.size(), 1u);
  EXPECT_EQ(found.undecided[0].node, kMiddle);
  EXPECT_THAT(found.undecided[0].faults, ElementsAre(0, 3));
}

TEST_F(SplitNodesOfSquares, AFaultWithTurnedFacesIsUndecided) {
  add_fault(mesh_, 0, Vector3d::UnitX(), 2, everywhere);
  for (SharedFace& face : mesh_.faces)
    if (face.fault == 0 && mesh_.centre(face.nodes).y() > 2)
      std::swap(face.cells[0], face.cells[1]);
  const SplitNodes found = split();
  ASSERT_EQ(found.undecided.size(), 1u);
  EXPECT_EQ(found.undecided[0].node, kMiddle);
}

std::vector<int> nodes_of(const std::vector<UndecidedNode>& undecided) {
  std::vector<int> nodes;
  for (const UndecidedNode& one : undecided) nodes.push_back(one.node);
  return nodes;
}

/// Random faults of any order and direction.
class RandomFaults : public ::testing::TestWithParam<int> {};

TEST_P(RandomFaults, HaveOneJumpFewerThanCopies) {
  const int dimensions = GetParam(), n_sets = dimensions == 2 ? 500 : 200;
  const int size = dimensions == 2 ? 12 : 5;
  std::mt19937 random(11);
  int most_copies = 0;
  std::size_t n_split = 0, n_undecided = 0;
  for (int set = 0; set < n_sets; ++set) {
    Simplices mesh = made_of(size, dimensions);
    const int n_faults = 2 + set % 5;
    add_random_faults(mesh, size, n_faults, dimensions, random);
    const SplitNodes found = split_nodes(mesh.n_nodes(), mesh.faces);
    expect_sound(mesh, found);
    for (SharedFace& face : mesh.faces)
      if (face.fault >= 0) face.fault = n_faults - 1 - face.fault;
    const SplitNodes other_order = split_nodes(mesh.n_nodes(), mesh.faces);
    expect_sound(mesh, other_order);
    EXPECT_EQ(nodes_of(other_order.undecided), nodes_of(found.undecided));
    n_split += found.split.size();
    n_undecided += found.undecided.size();
    for (const SplitNode& node : found.split)
      most_copies = std::max(most_copies, static_cast<int>(node.sectors.size()));
    if (::testing::Test::HasFailure()) FAIL() << "set " << set;
  }
  EXPECT_GE(most_copies, 4);
  EXPECT_GT(n_split, 30 * n_undecided) << "where tips meet by chance";
}

INSTANTIATE_TEST_SUITE_P(Dimensions, RandomFaults, ::testing::Values(2, 3));

}  // namespace
}  // namespace faultsim
