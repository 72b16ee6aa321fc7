#include "simulator/coupled/coupled_solver.h"

#include <malloc.h>

#include <ctime>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/coupled/augmented.h"

namespace faultsim {
namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

/// J with multiplier rows and columns times `scale`, and its preconditioner.
struct ScaledSystem {
  const SaddlePoint& j;
  BlockForm form;
  double scale;
  LinearMap leading = nullptr;
  LinearMap schur = nullptr;     ///< none: RAC, `leading` is of S_u.
  Eigen::VectorXd springs = {};  ///< D of RAC.

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const int n_u = j.n_displacements(), n_l = j.n_multipliers();
    y.resize(n_u + n_l);
    y.head(n_u) = j.leading() * x.head(n_u);
    y.head(n_u) += scale * (j.coupling * x.tail(n_l));
    y.tail(n_l) = scale * (j.constraint.transpose() * x.head(n_u));
  }

  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    const int n_u = j.n_displacements(), n_l = j.n_multipliers();
    const Eigen::VectorXd r_u = r.head(n_u), r_l = r.tail(n_l) / scale;
    Eigen::VectorXd u, lambda, correction;
    if (!schur) {
      leading(r_u + j.coupling * springs.cwiseProduct(r_l), u);
      lambda = springs.cwiseProduct(j.constraint.transpose() * u - r_l);
    } else if (form == BlockForm::full) {
      leading(r_u, u);
      schur(j.constraint.transpose() * u - r_l, lambda);
      leading(j.coupling * lambda, correction);
      u -= correction;
    } else {
      schur(-r_l, lambda);
      leading(r_u - j.coupling * lambda, u);
    }
    z.resize(n_u + n_l);
    z << u, lambda / scale;
  }
};

/// The kind of that name; none becomes a problem.
template <typename Kind>
Kind kind_of(const std::string& name, const char* option, std::vector<Problem>& problems) {
  if (const auto kind = named<Kind>(name)) return *kind;
  problems.push_back({"", 0, concat(option, " ", name, " is not known"),
                      "choose of " + joined(words(Kind()), ", ")});
  return Kind();
}

}  // namespace

SolverChoice solver_of(const std::string& leading, const std::string& schur) {
  std::vector<Problem> problems;
  SolverChoice choice;
  choice.leading = kind_of<LeadingKind>(leading, "--leading", problems);
  choice.schur = kind_of<SchurKind>(schur, "--schur", problems);
  if (!problems.empty()) throw InputError("coupled path", std::move(problems));
  return choice;
}

double scale_of_multipliers(const SaddlePoint& j) {
  if (j.n_multipliers() == 0) return 1;
  return j.leading().diagonal().cwiseAbs().mean() / j.gram().cwiseSqrt().mean();
}

int CoupledReport::iterations_to(double tolerance) const {
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i) {
    if (residuals[i] <= tolerance) return i;
  }
  return -1;
}

struct CoupledSolver::Impl {
  Impl(const SaddlePoint& j, const SolverChoice& choice)
      : system{j, choice.form, scale_of_multipliers(j)} {
    const double start = processor_seconds(), before = heap_bytes();
    if (choice.schur == SchurKind::rac) {
      AugmentedJacobian augmented = augment(j);
      system.springs = std::move(augmented.springs);
      system.leading =
          leading_block(choice.leading, std::move(augmented.regular), choice.fsai, choice.ilu);
    } else {
      system.leading = leading_block(choice.leading, j, choice.fsai, choice.ilu);
      system.schur = schur_complement(choice.schur, j, choice.fsai);
    }
    setup_seconds = processor_seconds() - start;
    bytes = heap_bytes() - before;
  }

  ScaledSystem system;
  double setup_seconds = 0, bytes = 0;
};

CoupledSolver::CoupledSolver(const SaddlePoint& j, const SolverChoice& choice)
    : impl_(std::make_unique<Impl>(j, choice)) {}

CoupledSolver::~CoupledSolver() = default;

double CoupledSolver::setup_seconds() const { return impl_->setup_seconds; }
double CoupledSolver::preconditioner_bytes() const { return impl_->bytes; }
double CoupledSolver::multiplier_scale() const { return impl_->system.scale; }

CoupledReport CoupledSolver::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g,
                                   double tolerance, int max_iterations, Eigen::VectorXd& u,
                                   Eigen::VectorXd& lambda) {
  const ScaledSystem& system = impl_->system;
  const int n_u = system.j.n_displacements(), n_l = system.j.n_multipliers();
  FAULTSIM_DEMAND(f.size() == n_u && g.size() == n_l, f.size(), " and ", g.size());
  const double start = processor_seconds();
  Eigen::VectorXd b(n_u + n_l), x;
  b << f, system.scale * g;
  const GmresReport done =
      gmres([&](const Eigen::VectorXd& v, Eigen::VectorXd& w) { system.multiply(v, w); },
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& w) { system.precondition(v, w); }, b,
            tolerance, max_iterations, x);
  u = x.head(n_u);
  lambda = system.scale * x.tail(n_l);
  return {done.converged, done.residuals, processor_seconds() - start};
}

}  // namespace faultsim
