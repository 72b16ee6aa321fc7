#include "simulator/coupled/coupled_solver.h"

#include <malloc.h>

#include <cmath>
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
  const SaddlePoint* jacobian;
  BlockForm form;
  double scale;
  LinearMap leading = nullptr;
  LinearMap schur = nullptr;     ///< none: RAC, `leading` is of S_u.
  Eigen::VectorXd springs = {};  ///< D of RAC.

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    const SaddlePoint& j = *jacobian;
    const int n_u = j.n_displacements(), n_l = j.n_multipliers();
    y.resize(n_u + n_l);
    y.head(n_u) = j.times_leading(x.head(n_u));
    y.head(n_u) += scale * (j.coupling * x.tail(n_l));
    y.tail(n_l) = scale * (j.constraint.transpose() * x.head(n_u));
  }

  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    const SaddlePoint& j = *jacobian;
    const int n_u = j.n_displacements(), n_l = j.n_multipliers();
    const Eigen::VectorXd r_u = r.head(n_u), r_l = r.tail(n_l) / scale;
    Eigen::VectorXd u, lambda, correction;
    if (!schur) {
      leading(r_u + j.constraint * springs.cwiseProduct(r_l), u);
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
                      "choose from " + joined(words(Kind()), ", ")});
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
  Eigen::Vector4d sums(j.leading_diagonal().cwiseAbs().sum(), j.n_displacements(),
                       j.gram().cwiseSqrt().sum(), j.n_multipliers());
  j.ranks().sum(sums);
  return sums[3] == 0 ? 1 : sums[0] / sums[1] / (sums[2] / sums[3]);
}

int CoupledReport::iterations_to(double tolerance) const {
  for (int i = 0; i < static_cast<int>(residuals.size()); ++i) {
    if (residuals[i] <= tolerance) return i;
  }
  return -1;
}

bool runs_on_ranks(const SolverChoice& choice) {
  const bool leading = choice.leading == LeadingKind::ilu || choice.leading == LeadingKind::amg ||
                       choice.leading == LeadingKind::amg_by_component;
  return leading && (choice.schur == SchurKind::rac || choice.schur == SchurKind::lsc);
}

void require_runs_on_ranks(const SolverChoice& choice, int n_ranks) {
  if (n_ranks == 1 || runs_on_ranks(choice)) return;
  throw InputError("coupled path",
                   concat(to_string(choice.leading), " with ", to_string(choice.schur),
                          " runs on one rank, but was started on ", n_ranks),
                   "use amg, amg-u or ilu with rac or lsc, or start it without mpirun");
}

struct CoupledSolver::Impl {
  Impl(const SaddlePoint& j, const SolverChoice& choice)
      : system{&j, choice.form, scale_of_multipliers(j)}, is_rac(choice.schur == SchurKind::rac) {
    require_runs_on_ranks(choice, j.ranks().size());
    const double start = processor_seconds(), before = heap_bytes();
    if (is_rac) system.springs = augmenting_springs(j);
    on_engine = runs_on_ranks(choice);
    if (on_engine) {
      find_added();
      system.leading = leading_block(choice.leading, j.engine().with(added), j, choice.ilu);
    } else if (is_rac) {
      system.leading =
          leading_block(choice.leading, augmented(j, system.springs), choice.fsai, choice.ilu);
    } else {
      system.leading = leading_block(choice.leading, j, choice.fsai, choice.ilu);
    }
    if (!is_rac) system.schur = schur_complement(choice.schur, j, choice.fsai);
    setup_seconds = processor_seconds() - start;
    bytes = heap_bytes() - before;
  }

  /// The preconditioner is of the matrix that is there anyway, with what it lacks added.
  void find_added() {
    const SaddlePoint& j = *system.jacobian;
    added = nullptr;
    if (is_rac || j.slip.cols() > 0)
      added = std::make_shared<const SparseMatrix>(added_to_bulk(j, system.springs));
  }

  ScaledSystem system;
  bool is_rac, on_engine = false;
  std::shared_ptr<const SparseMatrix> added;  ///< to K, for the preconditioner.
  double setup_seconds = 0, bytes = 0;
};

CoupledSolver::CoupledSolver(const SaddlePoint& j, const SolverChoice& choice)
    : impl_(std::make_unique<Impl>(j, choice)) {}

CoupledSolver::~CoupledSolver() = default;

void CoupledSolver::relinearise(const SaddlePoint& j) {
  Impl& self = *impl_;
  FAULTSIM_DEMAND(self.on_engine, "a preconditioner of a matrix of its own");
  self.system.jacobian = &j;
  if (self.is_rac) self.system.springs = augmenting_springs(j);
  if (!self.is_rac) self.system.schur = schur_complement(SchurKind::lsc, j, {});
  self.find_added();
}

double CoupledSolver::norm(const Eigen::VectorXd& f, const Eigen::VectorXd& g) const {
  const double scale = impl_->system.scale;
  return std::sqrt(
      impl_->system.jacobian->ranks().sum(f.squaredNorm() + scale * scale * g.squaredNorm()));
}

double CoupledSolver::setup_seconds() const { return impl_->setup_seconds; }
double CoupledSolver::preconditioner_bytes() const { return impl_->bytes; }
double CoupledSolver::multiplier_scale() const { return impl_->system.scale; }

CoupledReport CoupledSolver::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g,
                                   double tolerance, int max_iterations, Eigen::VectorXd& u,
                                   Eigen::VectorXd& lambda, StopToken stop) {
  const ScaledSystem& system = impl_->system;
  const SaddlePoint& j = *system.jacobian;
  const int n_u = j.n_displacements(), n_l = j.n_multipliers();
  FAULTSIM_DEMAND(f.size() == n_u && g.size() == n_l, f.size(), " and ", g.size());
  const double start = processor_seconds();
  if (impl_->on_engine) j.engine().with(impl_->added);
  Eigen::VectorXd b(n_u + n_l), x;
  b << f, system.scale * g;
  const GmresReport done =
      gmres([&](const Eigen::VectorXd& v, Eigen::VectorXd& w) { system.multiply(v, w); },
            [&](const Eigen::VectorXd& v, Eigen::VectorXd& w) { system.precondition(v, w); }, b,
            tolerance, max_iterations, x, sum_over(j.ranks()),
            [&] {
              if (j.ranks().largest(stop.requested() ? 1 : 0) > 0)  // all or none
                throw Interrupted("stopped while solving a linear step of the coupled path");
            });
  u = x.head(n_u);
  lambda = system.scale * x.tail(n_l);
  return {done.converged, done.residuals, processor_seconds() - start};
}

}  // namespace faultsim
