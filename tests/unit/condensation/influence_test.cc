#include "simulator/model/influence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "simulator/common/errors.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

/// The mixed problem (offset regions, ties, a moving side, observed points on and off faults) and
/// the influence of all its cells.
class Influence : public testing::Test {
 protected:
  Influence() : problem_(test::mixed_problem()), bulk_(problem_, monitor_) {
    op_ = bulk_.condense();
    cells_.resize(problem_.mesh.cells.size());
    std::iota(cells_.begin(), cells_.end(), 0);
    block_ = bulk_.influence(cells_, monitor_);
  }
  /// Share of the cells that a region's load acts on.
  Eigen::VectorXd region(int load) const {
    Eigen::VectorXd field = Eigen::VectorXd::Zero(block_.traction.view().cols());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (problem_.mesh.region[c] == load) field[c] = block_.cells[c].fraction;
    }
    return field;
  }

  /// L of the load whose region in the mesh is `load`.
  Eigen::VectorXd column_of(int load) const {
    for (std::size_t k = 0; k < problem_.loads.size(); ++k) {
      if (problem_.loads[k].region == load) return op_.loads.traction.col(k);
    }
    throw std::out_of_range("load");
  }

  BulkProblem problem_;
  SilentMonitor monitor_;
  CondensedBulk bulk_;
  FaultOperator op_;
  std::vector<int> cells_;
  InfluenceBlock block_;
};

TEST_F(Influence, AUniformFieldIsTheColumnOfItsRegion) {
  for (const int load : {0, 1}) {
    const Eigen::VectorXd field = region(load);
    ASSERT_GT(field.sum(), 1);
    const Eigen::VectorXd column = column_of(load);
    EXPECT_LT((locked_change(block_, field) - column).norm(), 1e-12 * column.norm());
  }
  const Eigen::VectorXd observed = block_.observed * region(0);
  EXPECT_LT((observed - op_.observed.per_load.col(0)).norm(), 1e-12 * observed.norm());
}

TEST_F(Influence, ARandomFieldIsItsOwnDirectSolve) {
  const DofMap dofs(problem_.mesh, problem_.conditions, static_cast<int>(problem_.loads.size()));
  const Eigen::VectorXd field = Eigen::VectorXd::Random(cells_.size());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(dofs.n_unknowns());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    Mesh one = problem_.mesh;  // by the load of a whole region, which is another function
    std::fill(one.region.begin(), one.region.end(), -1);
    one.region[c] = 0;
    one.region_fraction[c] = 1;
    force += field[c] * pressure_load(one, dofs, 0);
  }
  const Eigen::VectorXd half = bulk_.forward(force);
  const Eigen::VectorXd direct = bulk_.locked_traction(half);
  EXPECT_LT((locked_change(block_, field) - direct).norm(), 1e-12 * direct.norm());

  const std::vector<double> no_loads(problem_.loads.size(), 0);
  const Eigen::Matrix3Xd u =
      bulk_.displacement(half, no_loads, Eigen::VectorXd::Zero(op_.geometry.n_dofs));
  const Eigen::VectorXd observed = block_.observed * field;
  Eigen::Index row = 0;
  for (const auto& [name, point] : problem_.observation_points) {
    for (int c = 0; c < 3; ++c, ++row) {
      EXPECT_NEAR(observed[row], u(c, observed_node(problem_.mesh, point)), 1e-12 * u.norm())
          << name << c;
    }
  }
}

TEST_F(Influence, ACellHasTheSameBitsWhateverElseIsAsked) {
  const auto p = block_.traction.view();
  for (const std::vector<int>& few : {std::vector<int>{17}, {90, 3, 44}}) {
    const InfluenceBlock again = bulk_.influence(few, monitor_);
    for (std::size_t k = 0; k < few.size(); ++k) {
      EXPECT_EQ(Eigen::VectorXd(again.traction.view().col(k)), Eigen::VectorXd(p.col(few[k])));
      EXPECT_EQ(again.observed.col(k), block_.observed.col(few[k]));
      EXPECT_EQ(again.cells[k].cell, few[k]);
    }
  }
}

/// More fields than meet P at once, on more threads than there are tiles for.
TEST(LockedChange, HasTheSameBitsAloneOrAmongOthersOnAnyThreads) {
  constexpr int kDofs = 1300, kCells = 27, kFields = 19;
  InfluenceBlock block;
  const Eigen::MatrixXd p = Eigen::MatrixXd::Random(kDofs, kCells);
  block.traction = StoredMatrix(p);
  const Eigen::MatrixXd stress = Eigen::MatrixXd::Random(kCells, kFields);
  const Eigen::MatrixXd all = locked_change(block, stress);
  EXPECT_LT((all - p * stress).cwiseAbs().maxCoeff(), 1e-13);
  for (const int threads : {2, 5}) EXPECT_EQ(all, locked_change(block, stress, threads));
  for (int f = 0; f < kFields; ++f)
    EXPECT_EQ(all.col(f), locked_change(block, stress.col(f), 2)) << f;
}

TEST_F(Influence, TellsWhatItsCellsAre) {
  double volume = 0;
  for (const InfluenceCell& cell : block_.cells) {
    volume += cell.volume;
    EXPECT_EQ(cell.material, problem_.mesh.material[cell.cell]);
    EXPECT_EQ(cell.region, problem_.mesh.region[cell.cell]);
    EXPECT_EQ(cell.fraction, cell.region < 0 ? 0 : problem_.mesh.region_fraction[cell.cell]);
  }
  EXPECT_NEAR(volume, 60.0 * 40 * 40, 0.01 * volume);  // a distorted box
  EXPECT_THROW(bulk_.influence({-1}, monitor_), InternalError);
  EXPECT_THROW(bulk_.influence({static_cast<int>(cells_.size())}, monitor_), InternalError);
  EXPECT_THROW(locked_change(block_, Eigen::VectorXd::Zero(2)), InternalError);
}

}  // namespace
}  // namespace faultsim
