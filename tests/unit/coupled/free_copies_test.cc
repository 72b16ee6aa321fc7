#include "simulator/coupled/free_copies.h"

#include <gmock/gmock.h>

#include <map>

#include "simulator/common/errors.h"
#include "simulator/coupled/two_sided_bulk.h"
#include "tests/unit/condensation/junction_problem.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

/// Displacements of all copies from means and jumps drawn at random, as the mesh says it.
struct Moved {
  explicit Moved(const Mesh& mesh) {
    std::srand(7);
    for (const FaultSurface& fault : mesh.faults)
      jumps.push_back(Eigen::Matrix3Xd::Random(3, std::ssize(fault.nodes)));
    for (const NodeCopy& copy : mesh.copies) {
      const auto mean = means.try_emplace(copy.first, Eigen::Vector3d::Random()).first;
      Eigen::Vector3d& moved = u.emplace(copy.node, mean->second).first->second;
      for (const JumpShare& share : copy.shares)
        moved += share.weight * jumps[static_cast<std::size_t>(share.fault)].col(share.node);
    }
  }

  Eigen::Vector3d sum(const NodeTerms& terms) const {
    Eigen::Vector3d all = Eigen::Vector3d::Zero();
    for (const NodeTerm& term : terms) all += term.factor * u.at(term.node);
    return all;
  }

  std::vector<Eigen::Matrix3Xd> jumps;
  std::map<int, Eigen::Vector3d> means, u;
};

TEST(FreeCopies, AreTheInverseOfMeansAndJumps) {
  for (const BulkProblem& problem : {test::junction_problem(), test::mixed_problem()}) {
    const Moved moved(problem.mesh);
    Mesh mesh = problem.mesh;
    const FreeCopies copies(mesh, [](int, int) { return true; });
    for (int f = 0; f < static_cast<int>(problem.mesh.faults.size()); ++f) {
      const Eigen::Matrix3Xd& jumps = moved.jumps[static_cast<std::size_t>(f)];
      for (int k = 0; k < static_cast<int>(jumps.cols()); ++k)
        EXPECT_LT((moved.sum(copies.jump(f, k)) - jumps.col(k)).norm(), 1e-12);
    }
    std::size_t n_amid = 0;
    for (const auto& [node, u] : moved.u) {
      EXPECT_LT(
          (moved.sum(copies.displacement(mesh.tied_to[static_cast<std::size_t>(node)])) - u).norm(),
          1e-12);
      n_amid += !copies.is_free(node);
    }
    EXPECT_EQ(n_amid > 10, mesh.cells.shape() == CellShape::tetrahedron) << n_amid;
    EXPECT_TRUE(mesh.faults.empty() && mesh.copies.empty());
  }
}

TEST(FreeCopies, TieWhatStaysClosed) {
  const BulkProblem problem = test::junction_problem();
  Mesh mesh = problem.mesh;
  const FreeCopies copies(mesh, [](int fault, int) { return fault == 0; });
  for (const FaultNode& node : problem.mesh.faults[1].nodes) {
    const auto root = [&](int copy) { return mesh.tied_to[static_cast<std::size_t>(copy)]; };
    EXPECT_EQ(root(node.minus_node), root(node.plus_node));
  }
  EXPECT_THAT(copies.jump(1, 0), testing::IsEmpty());
  EXPECT_THAT(copies.jump(0, 0), testing::SizeIs(2));
  const FreeCopies none(mesh = problem.mesh, [](int, int) { return false; });
  for (const NodeCopy& copy : problem.mesh.copies)
    EXPECT_EQ(mesh.tied_to[static_cast<std::size_t>(copy.node)], copy.first);
}

/// A condition on a part of the top or the north side: `components` on faces whose middle passes.
template <typename Inside>
std::string refusal(Side side, const std::array<bool, 3>& components, const Inside& inside) {
  BulkProblem problem = test::junction_problem();
  const BoundaryGroup part(17);
  for (BoundaryFace& face : problem.mesh.boundary) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t v = 0; v < 3; ++v)
      middle += problem.mesh.nodes[static_cast<std::size_t>(face.places[v])] / 3;
    if (face.group == BoundaryGroup(side) && inside(middle)) face.group = part;
  }
  problem.conditions.push_back(
      {part, components, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1});
  try {
    const TwoSidedBulk bulk(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FreeCopies, RefuseWhatHoldsOneOfTwoFaultsThatMeet) {
  constexpr std::array kAll = {true, true, true};
  EXPECT_EQ(refusal(Side::z_max, kAll, [](const auto&) { return true; }), "");
  EXPECT_THAT(refusal(Side::z_max, kAll, [](const auto& x) { return x.x() < 200; }),
              testing::HasSubstr("closes one of the faults that meet there but not the other"));
}

TEST(FreeCopies, RefuseASideThatIsHeldBesideAFaultOnly) {
  constexpr std::array kNormal = {false, true, false};
  EXPECT_EQ(refusal(Side::y_max, kNormal, [](const auto&) { return true; }), "");
  int taken_out = 0;
  EXPECT_THAT(refusal(Side::y_max, kNormal,
                      [&](const auto& x) {
                        const bool beside = x.x() > 130 && x.x() < 200 && x.z() > -200;
                        return !(beside && taken_out++ == 0);
                      }),
              testing::HasSubstr("holds one side of a fault but not the other"));
}

}  // namespace
}  // namespace faultsim
