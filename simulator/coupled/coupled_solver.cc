#include "simulator/coupled/coupled_solver.h"

#include <malloc.h>

#include <ctime>
#include <exception>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/coupled/augmented.h"
#include "simulator/coupled/hypre_objects.h"

namespace faultsim {
namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

double scale_of(const SaddlePoint& j) {
  if (j.n_multipliers() == 0) return 1;
  return j.leading.diagonal().cwiseAbs().mean() / j.gram().cwiseSqrt().mean();
}

/// J with multiplier rows and columns times `scale`.
SparseMatrix scaled_jacobian(const SaddlePoint& j, double scale) {
  const int n_u = j.n_displacements(), n = n_u + j.n_multipliers();
  std::vector<Eigen::Triplet<double, long>> entries;
  entries.reserve(j.leading.nonZeros() + j.coupling.nonZeros() + j.constraint.nonZeros());
  const auto add = [&](const SparseMatrix& block, double factor, int row, int column,
                       bool transposed) {
    for (int k = 0; k < block.outerSize(); ++k) {
      for (SparseMatrix::InnerIterator it(block, k); it; ++it) {
        const long r = transposed ? it.col() : it.row(), c = transposed ? it.row() : it.col();
        entries.emplace_back(row + r, column + c, factor * it.value());
      }
    }
  };
  add(j.leading, 1, 0, 0, false);
  add(j.coupling, scale, 0, n_u, false);
  add(j.constraint, scale, n_u, 0, true);
  SparseMatrix jacobian(n, n);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return jacobian;
}

/// What hypre's FlexGMRES calls back: the preconditioner, and the residual before each iteration.
struct Preconditioner {
  const SaddlePoint& j;
  BlockForm form;
  double scale;
  LinearMap leading;
  LinearMap schur;               ///< none: RAC, `leading` is of S_u.
  Eigen::VectorXd springs = {};  ///< D of RAC.
  std::vector<double> residuals = {};
  std::exception_ptr error = {};  ///< exceptions must not cross hypre's C.

  void apply(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Ref<Eigen::VectorXd> z) {
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
    z.head(n_u) = u;
    z.tail(n_l) = lambda / scale;
  }
};

Preconditioner& self_of(HYPRE_Solver solver) { return *reinterpret_cast<Preconditioner*>(solver); }

HYPRE_Int nothing_to_set_up(HYPRE_Solver, HYPRE_ParCSRMatrix, HYPRE_ParVector, HYPRE_ParVector) {
  return 0;
}

HYPRE_Int precondition(HYPRE_Solver solver, HYPRE_ParCSRMatrix, HYPRE_ParVector r,
                       HYPRE_ParVector z) {
  Preconditioner& self = self_of(solver);
  values_of(z) = values_of(r);
  if (self.error) return 0;
  try {
    self.apply(Eigen::VectorXd(values_of(r)), values_of(z));
  } catch (...) {
    self.error = std::current_exception();
  }
  return 0;
}

HYPRE_Int record_residual(HYPRE_Solver solver, HYPRE_Int, HYPRE_Real relative_residual) {
  self_of(solver).residuals.push_back(relative_residual);
  return 0;
}

/// A FlexGMRES without restart.
class FlexibleGmres {
 public:
  FlexibleGmres(Preconditioner& preconditioner, double tolerance, int max_iterations) {
    HYPRE_ParCSRFlexGMRESCreate(MPI_COMM_SELF, &solver_);
    HYPRE_ParCSRFlexGMRESSetKDim(solver_, max_iterations);
    HYPRE_ParCSRFlexGMRESSetMaxIter(solver_, max_iterations);
    HYPRE_ParCSRFlexGMRESSetTol(solver_, tolerance);
    HYPRE_ParCSRFlexGMRESSetPrecond(solver_, precondition, nothing_to_set_up,
                                    reinterpret_cast<HYPRE_Solver>(&preconditioner));
    HYPRE_ParCSRFlexGMRESSetModifyPC(solver_, record_residual);
  }
  ~FlexibleGmres() { HYPRE_ParCSRFlexGMRESDestroy(solver_); }
  FlexibleGmres(const FlexibleGmres&) = delete;
  FlexibleGmres& operator=(const FlexibleGmres&) = delete;

  void solve(const HypreMatrix& matrix, const HypreVector& b, const HypreVector& x) {
    HYPRE_ParCSRFlexGMRESSetup(solver_, matrix.get(), b.get(), x.get());
    HYPRE_ParCSRFlexGMRESSolve(solver_, matrix.get(), b.get(), x.get());
    check_hypre("solving");
  }
  int iterations() const {
    HYPRE_Int n = 0;
    HYPRE_ParCSRFlexGMRESGetNumIterations(solver_, &n);
    return n;
  }
  double residual() const {
    HYPRE_Real value = 0;
    HYPRE_ParCSRFlexGMRESGetFinalRelativeResidualNorm(solver_, &value);
    return value;
  }

 private:
  HYPRE_Solver solver_ = nullptr;
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

int CoupledReport::iterations_to(double tolerance) const {
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i) {
    if (residuals[i] <= tolerance) return i;
  }
  return -1;
}

struct CoupledSolver::Impl {
  Impl(const SaddlePoint& saddle_point, const SolverChoice& choice)
      : j(saddle_point),
        scale(scale_of(j)),
        jacobian(scaled_jacobian(j, scale)),
        preconditioner{j, choice.form, scale, nullptr, nullptr} {
    const double start = processor_seconds(), before = heap_bytes();
    if (choice.schur == SchurKind::rac) {
      const AugmentedJacobian augmented = augment(j);
      preconditioner.springs = augmented.springs;
      preconditioner.leading =
          leading_block(choice.leading, augmented.regular, choice.fsai, choice.ilu);
    } else {
      preconditioner.leading = leading_block(choice.leading, j, choice.fsai, choice.ilu);
      preconditioner.schur = schur_complement(choice.schur, j, choice.fsai);
    }
    setup_seconds = processor_seconds() - start;
    bytes = heap_bytes() - before;
  }

  const SaddlePoint& j;
  double scale;
  HypreMatrix jacobian;
  Preconditioner preconditioner;
  double setup_seconds = 0, bytes = 0;
};

CoupledSolver::CoupledSolver(const SaddlePoint& j, const SolverChoice& choice)
    : impl_(std::make_unique<Impl>(j, choice)) {}

CoupledSolver::~CoupledSolver() = default;

double CoupledSolver::setup_seconds() const { return impl_->setup_seconds; }
double CoupledSolver::preconditioner_bytes() const { return impl_->bytes; }
double CoupledSolver::multiplier_scale() const { return impl_->scale; }

CoupledReport CoupledSolver::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g,
                                   double tolerance, int max_iterations, Eigen::VectorXd& u,
                                   Eigen::VectorXd& lambda) {
  Impl& self = *impl_;
  const SaddlePoint& j = self.j;
  const int n_u = j.n_displacements(), n_l = j.n_multipliers();
  FAULTSIM_DEMAND(f.size() == n_u && g.size() == n_l, f.size(), " and ", g.size());
  const double start = processor_seconds();
  HypreVector b(n_u + n_l), x(n_u + n_l);
  b.values() << f, self.scale * g;
  self.preconditioner.residuals.clear();
  FlexibleGmres gmres(self.preconditioner, tolerance, max_iterations);
  gmres.solve(self.jacobian, b, x);
  if (self.preconditioner.error) {
    std::rethrow_exception(std::exchange(self.preconditioner.error, nullptr));
  }
  u = x.values().head(n_u);
  lambda = self.scale * x.values().tail(n_l);
  CoupledReport report;
  report.residuals = self.preconditioner.residuals;
  report.converged = gmres.residual() <= tolerance;
  report.residuals.push_back(gmres.residual());
  FAULTSIM_DEMAND(static_cast<int>(report.residuals.size()) == gmres.iterations() + 1,
                  report.residuals.size(), " residuals of ", gmres.iterations(), " iterations");
  report.seconds = processor_seconds() - start;
  return report;
}

}  // namespace faultsim
