// A surface of small operators that are known in closed form.
#include "simulator/surface/surface_builder.h"

#include <gmock/gmock.h>

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using testing::HasSubstr;

constexpr double kSoft = 1e-6;  // N/m, of the second jump; that of the first is 1

/// H = diag(1, kSoft (1 + x²/2)), one load on both jumps: what the soft jump does to the norm of H
/// is far below any tolerance, and its slip is nearly all that there is.
std::shared_ptr<const FaultOperator> with_soft_jump(const Eigen::VectorXd& x) {
  auto op = std::make_shared<FaultOperator>();
  op->geometry.n_dofs = 2;
  op->geometry.dof_area = Eigen::Vector2d::Ones();
  const double soft = kSoft * (1 + 0.5 * x[0] * x[0]);
  op->compliance =
      std::make_shared<DenseCompliance>(Eigen::MatrixXd(Eigen::Vector2d(1, soft).asDiagonal()));
  op->loads.keys.resize(1);
  op->loads.traction = Eigen::MatrixXd::Ones(2, 1);
  op->observed.per_load = Eigen::MatrixXd::Zero(0, 1);
  op->observed.per_jump = Eigen::MatrixXd::Zero(0, 2);
  return op;
}

SurfaceRequest over_one_parameter(double tolerance, int most) {
  SurfaceRequest request;
  request.over.resize(1);
  request.tolerance = tolerance;
  request.most_operators = most;
  return request;
}

TEST(SurfaceBuilder, GoesOnUntilTheSlipWithoutFrictionIsRight) {
  constexpr double kTolerance = 1e-3;
  const StoredSurface surface =
      build_surface(over_one_parameter(kTolerance, 20), "name", with_soft_jump, {});
  EXPECT_LE(surface.accuracy.slip, kTolerance);
  EXPECT_GE(surface.accuracy.n_operators, 3) << "a parabola has three values";
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 0.7);
  SparseGrid grid(1);
  for (std::size_t k = 1; k < surface.basis->nodes.size(); ++k) grid.add(surface.basis->nodes[k]);
  FaultOperator op;
  OperatorBasis::put(surface.basis, grid.weights(x).tail(grid.n_nodes() - 1), op);
  const double soft = with_soft_jump(x)->h()(1, 1);
  EXPECT_NEAR(op.h()(1, 1), soft, kTolerance * soft);
}

TEST(SurfaceBuilder, RefusesWhenTheSlipStaysWrong) {
  try {
    build_surface(over_one_parameter(1e-3, 2), "name", with_soft_jump, {});
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("does not reach its tolerance: with 2 operators"));
  }
}

}  // namespace
}  // namespace faultsim
