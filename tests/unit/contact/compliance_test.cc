#include "simulator/model/compliance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "tests/unit/contact/depleted_fault.h"

namespace faultsim {
namespace {

/// H whose columns are made when they are asked for, as a solver of the bulk would.
class ColumnsOnDemand final : public Compliance {
 public:
  explicit ColumnsOnDemand(Eigen::MatrixXd h) : h_(std::move(h)), columns_(h_.cols()) {}
  int size() const override { return static_cast<int>(h_.rows()); }
  Column column(int j) const override {
    if (columns_[j].size() == 0) columns_[j] = h_.col(j);
    return {columns_[j].data(), h_.rows()};
  }
  double diagonal(int j) const override { return column(j)[j]; }
  double diagonal_bound(int j) const override { return 3 * h_(j, j); }
  bool is_solved_for() const override { return true; }
  bool is_made(int j) const { return columns_[j].size() > 0; }
  int n_made() const {
    return static_cast<int>(std::count_if(columns_.begin(), columns_.end(),
                                          [](const auto& column) { return column.size() > 0; }));
  }

 private:
  Eigen::MatrixXd h_;
  mutable std::vector<Eigen::VectorXd> columns_;
};

TEST(DenseCompliance, KeepsTheMatrixAliveInCopies) {
  FaultOperator copy;
  {
    FaultOperator op;
    Eigen::MatrixXd h(2, 2);
    h << 1, 2, 2, 5;
    op.compliance = std::make_shared<DenseCompliance>(h);
    copy = op;
    EXPECT_EQ(copy.h().data(), op.h().data());
  }
  EXPECT_EQ(copy.h()(1, 1), 5);
  EXPECT_EQ(copy.compliance->column(1)[0], 2);
  EXPECT_EQ(copy.compliance->diagonal(0), 1);
  EXPECT_THROW(DenseCompliance(Eigen::MatrixXd(2, 3)), InternalError);
}

TEST(DenseCompliance, SubtractsTheColumnsListedAndNoOthers) {
  const int n = 11;
  const Eigen::MatrixXd h = Eigen::MatrixXd::Random(n, n);
  Eigen::VectorXd jump = Eigen::VectorXd::Random(n);
  const Eigen::VectorXd inverse_area = Eigen::VectorXd::LinSpaced(n, 1, 2);
  for (const std::vector<int>& active : {std::vector<int>{}, {3}, {0, 4, 7, 8}, {10, 1, 2, 5, 9}}) {
    Eigen::VectorXd expected = Eigen::VectorXd::Ones(n), computed = expected;
    for (const int j : active) expected -= (h.col(j) * jump[j]).cwiseProduct(inverse_area);
    const DenseCompliance stored(h);
    stored.subtract_product(active, jump, inverse_area, std::vector<RowRange>{{0, n}}, computed);
    EXPECT_LT((computed - expected).norm(), 1e-14 * n);
    Eigen::VectorXd part = Eigen::VectorXd::Ones(n);
    stored.subtract_product(active, jump, inverse_area, std::vector<RowRange>{{1, 2}, {6, 4}},
                            part);
    for (int r = 0; r < n; ++r) {
      const bool asked = (r >= 1 && r < 3) || (r >= 6 && r < 10);
      EXPECT_EQ(part[r], asked ? computed[r] : 1) << r;
    }
  }
}

TEST(FaultOperator, HasNoMatrixWhereNoneIsStored) {
  FaultOperator op;
  EXPECT_EQ(op.h().size(), 0);
  op.compliance = std::make_shared<ColumnsOnDemand>(Eigen::MatrixXd::Identity(2, 2));
  EXPECT_THROW(op.h(), InternalError);
}

TEST(ContactSolver, AsksForTheColumnsOfMovingNodesOnly) {
  for (const int n_shear : {1, 2}) {
    DepletedFault stored = depleted_fault(60, n_shear, n_shear == 2);
    DepletedFault solved = depleted_fault(60, n_shear, n_shear == 2);
    const auto columns = std::make_shared<ColumnsOnDemand>(stored.op.h());
    solved.op.compliance = columns;
    ContactState at = initial_state(stored.op), same = initial_state(solved.op);
    ContactSolver first(stored.op, stored.laws, {}), second(solved.op, solved.laws, {});
    for (std::size_t i = 1; i < 6; ++i) {
      first.solve_step(stored.locked[i - 1], stored.locked[i], at);
      const ContactReport report = second.solve_step(solved.locked[i - 1], solved.locked[i], same);
      ASSERT_EQ(report.outcome, Outcome::converged);
    }
    EXPECT_GT(at.jump.norm(), 0);
    EXPECT_LT((same.jump - at.jump).norm(), 1e-7 * at.jump.norm());
    EXPECT_GT(columns->n_made(), 0);
    EXPECT_LT(columns->n_made(), columns->size());
  }
}

/// Three sliders of which one jumps: of the others only the stiffest is asked, for Δt.
TEST(ContactSolver, FollowsAJumpByTheColumnsOfWhatMoves) {
  FaultOperator stored = make_operator(3, 1, Eigen::VectorXd::Constant(3, 2.5));
  Eigen::VectorXd stiffness(6);
  stiffness << 1, 1, 1, 1, 2, 2;
  set_h(stored, 2.5 * 1e7 * Eigen::MatrixXd(stiffness.asDiagonal()));
  FaultOperator solved = stored;
  const auto columns = std::make_shared<ColumnsOnDemand>(stored.h());
  solved.compliance = columns;
  ContactLaws laws = same_law(stored, linear_weakening(0.2));
  for (CoulombLaw& law : laws) law.damping = 2e6;
  const auto pulled = [](double u) {
    Eigen::VectorXd locked = Eigen::VectorXd::Zero(6);
    locked << -2e7, 1e7 * u, -2e7, 0, -2e7, 0;
    return locked;
  };
  ContactState at = initial_state(stored), same = at;
  ContactSolver first(stored, laws, {}), second(solved, laws, {});
  Eigen::VectorXd last = Eigen::VectorXd::Zero(6);
  for (const double u : {1.1, 1.3}) {
    const ContactReport a = first.solve_step(last, pulled(u), at);
    const ContactReport b = second.solve_step(last, pulled(u), same);
    last = pulled(u);
    EXPECT_EQ(b.outcome, a.outcome) << b.reason;
    ASSERT_EQ(b.jumps.size(), u > 1.2 ? 1u : 0u);
  }
  EXPECT_NEAR(at.jump[1], 0.5, 1e-7);
  EXPECT_EQ(same.jump, at.jump);
  EXPECT_TRUE(columns->is_made(1) && columns->is_made(5));
  for (const int j : {2, 3, 4}) EXPECT_FALSE(columns->is_made(j)) << j;
}

}  // namespace
}  // namespace faultsim
