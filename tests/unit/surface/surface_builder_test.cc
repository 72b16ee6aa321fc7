// A surface of small operators that are known in closed form.
#include "simulator/surface/surface_builder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/surface/sparse_grid.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kSoft = 1e-6;  // N/m, of the second jump; that of the first is 1

/// H = diag(1, kSoft (1 + x²/2)), one load on both jumps: what the soft jump does to the norm of H
/// is far below any tolerance, and its slip is nearly all that there is.
std::shared_ptr<const FaultOperator> with_soft_jump(const Eigen::VectorXd& x, const RunContext&) {
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
      build_surface(over_one_parameter(kTolerance, 20), "name", with_soft_jump, {}, {});
  EXPECT_LE(surface.accuracy.slip, kTolerance);
  EXPECT_GE(surface.accuracy.n_operators, 3) << "a parabola has three values";
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 0.7);
  SparseGrid grid(1);
  for (std::size_t k = 1; k < surface.basis->nodes.size(); ++k) grid.add(surface.basis->nodes[k]);
  FaultOperator op;
  OperatorBasis::put(surface.basis, grid.weights(x).tail(grid.n_nodes() - 1), op);
  const double soft = with_soft_jump(x, {})->h()(1, 1);
  EXPECT_NEAR(op.h()(1, 1), soft, kTolerance * soft);
}

TEST(SurfaceBuilder, RefusesWhenTheSlipStaysWrong) {
  try {
    build_surface(over_one_parameter(1e-3, 2), "name", with_soft_jump, {}, {});
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("does not reach its tolerance: with 2 operators"));
  }
}

/// Half of the check points decide; a case that ends early at one of the others has no error that
/// could be said either.
TEST(SurfaceBuilder, RefusesWhereAProbingCaseEndsEarlyOnInterpolatedOperators) {
  const SurfaceRequest request = over_one_parameter(1e-3, 4);
  const double last = check_points(1, n_surface_checks(request)).back()[0];
  std::vector<std::shared_ptr<const FaultOperator>> asked;
  const auto exact = [&](const Eigen::VectorXd& x, const RunContext& context) {
    return asked.emplace_back(with_soft_jump(x, context));
  };
  bool ends_early = false;
  const ProbingCases cases = {1, 0.003, [&](int, const Eigen::VectorXd& x, const auto& op) {
                                const bool is_exact = std::ranges::find(asked, op) != asked.end();
                                CaseResult result;
                                result.outcome = Outcome::converged;
                                result.steps.resize(2);
                                for (StepResult& step : result.steps) step.faults.resize(1);
                                if (!ends_early || is_exact || x[0] != last) return result;
                                result.outcome = Outcome::unstable;
                                result.steps.pop_back();
                                return result;
                              }};
  EXPECT_EQ(build_surface(request, "name", exact, cases, {}).accuracy.chi_bar, 0);
  ends_early = true;
  try {
    build_surface(request, "name", exact, cases, {});
    ADD_FAILURE() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ends early"));
  }
}

struct Listener final : Monitor {
  std::vector<std::string> said;
  void progress(double fraction, const std::string& what) override {
    EXPECT_TRUE(fraction >= 0 && fraction <= 1) << fraction;
    said.push_back(what);
  }
  void note(const std::string&) override {}
};

/// At full size each of these takes minutes.
TEST(SurfaceBuilder, TellsWhatItIsDoing) {
  Listener listener;
  const ProbingCases cases = {1, 0.003, [](int, const Eigen::VectorXd&, const auto&) {
                                CaseResult result;
                                result.outcome = Outcome::converged;
                                return result;
                              }};
  build_surface(over_one_parameter(1e-3, 4), "name", with_soft_jump, cases, listener);
  EXPECT_THAT(listener.said,
              testing::IsSupersetOf({"compressing a surface", "cases at check point 1 of a surface",
                                     "errors at check point 6 of a surface"}));
}

/// Which part of an operator bends with the parameter; the others are constant.
enum class Bends { stiffness, first_load, last_load, per_load, per_jump };

std::shared_ptr<const FaultOperator> bending(Bends part, const Eigen::VectorXd& x) {
  const double bend = 1 + 0.4 * std::sin(3 * x[0]);
  const auto at = [&](Bends one) { return one == part ? bend : 1.0; };
  auto op = std::make_shared<FaultOperator>();
  op->geometry.n_dofs = 3;
  op->geometry.dof_area = Eigen::Vector3d(20, 30, 50);
  Eigen::Matrix3d h;
  h << 5, 1, 0.5, 1, 4, 1, 0.5, 1, 6;
  op->compliance = std::make_shared<DenseCompliance>(Eigen::MatrixXd(at(Bends::stiffness) * h));
  op->loads.keys.resize(2);
  op->loads.traction.resize(3, 2);
  op->loads.traction.col(0) = at(Bends::first_load) * Eigen::Vector3d(1e6, 2e6, -1e6);
  op->loads.traction.col(1) = at(Bends::last_load) * Eigen::Vector3d(3, -1, 2);
  op->observed.per_load = at(Bends::per_load) * Eigen::MatrixXd::Constant(2, 2, 1e-9);
  op->observed.per_jump = at(Bends::per_jump) * Eigen::MatrixXd::Constant(2, 3, 0.3);
  return op;
}

/// Whatever part bends, and however small its numbers are beside those of the others.
TEST(SurfaceBuilder, HasEveryPartOfAnOperatorWithinItsTolerance) {
  constexpr double kTolerance = 1e-4;
  for (const Bends part :
       {Bends::stiffness, Bends::first_load, Bends::last_load, Bends::per_load, Bends::per_jump}) {
    const auto exact = [&](const Eigen::VectorXd& x, const RunContext&) {
      return bending(part, x);
    };
    const StoredSurface surface =
        build_surface(over_one_parameter(kTolerance, 30), "name", exact, {}, {});
    SparseGrid grid(1);
    for (std::size_t k = 1; k < surface.basis->nodes.size(); ++k) grid.add(surface.basis->nodes[k]);
    EXPECT_EQ(surface.accuracy.n_operators, grid.n_nodes());
    for (const double place : {-0.95, -0.4, 0.11, 0.77}) {
      const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, place);
      FaultOperator op;
      OperatorBasis::put(surface.basis, grid.weights(x).tail(grid.n_nodes() - 1), op);
      const auto truth = exact(x, {});
      const auto expect_near = [&](const auto& value, const auto& wanted) {
        EXPECT_LT((value - wanted).norm(), 3 * kTolerance * wanted.norm())
            << static_cast<int>(part) << " at " << place;
      };
      expect_near(Eigen::MatrixXd(op.h()), Eigen::MatrixXd(truth->h()));
      for (int k = 0; k < 2; ++k)
        expect_near(op.loads.traction.col(k).eval(), truth->loads.traction.col(k).eval());
      expect_near(op.observed.per_load, truth->observed.per_load);
      expect_near(op.observed.per_jump, truth->observed.per_jump);
    }
  }
}

/// Two operators say nothing of a bend: each part is refused by its own name.
TEST(SurfaceBuilder, RefusesWhateverPartStaysWrong) {
  const std::pair<Bends, const char*> kParts[] = {{Bends::stiffness, "H is off by 0,"},
                                                  {Bends::first_load, "tractions by 0,"},
                                                  {Bends::last_load, "tractions by 0,"},
                                                  {Bends::per_load, "observations by 0,"},
                                                  {Bends::per_jump, "observations by 0,"}};
  for (const auto& [part, nothing] : kParts) {
    const auto exact = [one = part](const Eigen::VectorXd& x, const RunContext&) {
      return bending(one, x);
    };
    try {
      build_surface(over_one_parameter(1e-2, 2), "name", exact, {}, {});
      ADD_FAILURE() << "no refusal of " << static_cast<int>(part);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr(nothing)));
      EXPECT_THAT(error.what(), HasSubstr("does not reach its tolerance: with 2 operators"));
    }
  }
}

/// A case's accuracy is the worst of all check points and of all loads.
TEST(SurfaceBuilder, ReportsTheErrorOfThePartThatBends) {
  for (const Bends part : {Bends::first_load, Bends::last_load}) {
    const auto exact = [&](const Eigen::VectorXd& x, const RunContext&) {
      return bending(part, x);
    };
    const CaseSurface found =
        build_surface(over_one_parameter(1e-2, 30), "name", exact, {}, {}).accuracy;
    EXPECT_GT(found.traction, 1e-6);
    EXPECT_LE(found.traction, 1e-2);
    EXPECT_LT(found.stiffness, 1e-6);
    EXPECT_EQ(found.observation, 0);
    EXPECT_NEAR(found.slip, found.traction, 1e-6) << "H⁻¹ of what is in proportion";
  }
}

}  // namespace
}  // namespace faultsim
