#include "tests/peers/siconos_solvers.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "simulator/common/errors.h"
#include "simulator/common/stopwatch.h"

extern "C" {
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>
}

namespace faultsim {
namespace {

/// W in Siconos' storage; belongs to the problem that takes it.
NumericsMatrix* siconos_matrix(const FrictionalContactProblem& problem, bool sparse_block) {
  const auto n = static_cast<int>(problem.w.rows());
  NumericsMatrix* dense = NM_create(NM_DENSE, n, n);
  std::memcpy(dense->matrix0, problem.w.data(),
              sizeof(double) * static_cast<std::size_t>(problem.w.size()));
  if (!sparse_block) return dense;
  NumericsMatrix* sparse = NM_create(NM_SPARSE, n, n);
  NM_triplet_alloc(sparse, static_cast<CS_INT>(problem.w.size()));
  NM_copy_to_sparse(dense, sparse, 0);
  NumericsMatrix* blocks = NM_create(NM_SPARSE_BLOCK, n, n);
  SBM_from_csparse(problem.dimension, NM_csc(sparse), blocks->matrix1);
  NM_clear(sparse);
  NM_clear(dense);
  return blocks;
}

using Options = std::unique_ptr<SolverOptions, void (*)(SolverOptions*)>;

Options options_of(const SiconosSolver& solver, const SiconosLimits& limits) {
  Options options(solver_options_create(solver.id), solver_options_delete);
  if (!options) throw ResourceError("Siconos has no solver " + solver.name);
  options->dparam[SICONOS_DPARAM_TOL] = limits.accuracy;
  options->iparam[SICONOS_IPARAM_MAX_ITER] = limits.max_iterations;
  if (solver.local_id != 0) solver_options_update_internal(options.get(), 0, solver.local_id);
  constexpr int kSweepsBetweenVisits = 10;
  if (solver.freezes) {
    options->iparam[SICONOS_FRICTION_3D_NSGS_FREEZING_CONTACT] = kSweepsBetweenVisits;
  }
  return options;
}

}  // namespace

std::vector<SiconosSolver> siconos_solvers(int dimension) {
  if (dimension == 2) {
    return {{"NSGS", SICONOS_FRICTION_2D_NSGS},
            {"CPG", SICONOS_FRICTION_2D_CPG},
            {"Lemke", SICONOS_FRICTION_2D_LEMKE}};
  }
  constexpr int kNewton = SICONOS_FRICTION_3D_ONECONTACT_NSN_GP;
  constexpr int kProjection = SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnConeWithLocalIteration;
  return {{"NSGS, local Newton", SICONOS_FRICTION_3D_NSGS, kNewton},
          {"NSGS, local Newton, blocks", SICONOS_FRICTION_3D_NSGS, kNewton, true},
          {"NSGS, local Newton, blocks, freezing", SICONOS_FRICTION_3D_NSGS, kNewton, true, true},
          {"NSGS, local projection", SICONOS_FRICTION_3D_NSGS, kProjection},
          {"NSGS, local projection, blocks", SICONOS_FRICTION_3D_NSGS, kProjection, true},
          {"NSN_AC", SICONOS_FRICTION_3D_NSN_AC},
          {"NSN_AC (test)", SICONOS_FRICTION_3D_NSN_AC_TEST},
          {"NSN_FB", SICONOS_FRICTION_3D_NSN_FB},
          {"NSN_NM", SICONOS_FRICTION_3D_NSN_NM},
          {"VI extragradient", SICONOS_FRICTION_3D_VI_EG},
          {"VI fixed point", SICONOS_FRICTION_3D_VI_FPP},
          {"ADMM", SICONOS_FRICTION_3D_ADMM},
          {"Tresca fixed point", SICONOS_FRICTION_3D_TFP},
          {"ACLM fixed point", SICONOS_FRICTION_3D_ACLMFP},
          {"proximal", SICONOS_FRICTION_3D_PROX}};
}

SiconosRun run_siconos(const SiconosSolver& solver, const FrictionalContactProblem& problem,
                       const Eigen::VectorXd& start, const SiconosLimits& limits) {
  numerics_set_verbose(0);
  // Siconos takes pointers that are not const: it gets copies of its own.
  Eigen::VectorXd q = problem.q, friction = problem.friction;
  FrictionContactProblem siconos;
  siconos.dimension = problem.dimension;
  siconos.numberOfContacts = problem.n_contacts();
  siconos.M = siconos_matrix(problem, solver.sparse_block);
  siconos.q = q.data();
  siconos.mu = friction.data();
  SiconosRun best;
  for (int i = 0; i < limits.repetitions; ++i) {
    const Options options = options_of(solver, limits);
    Eigen::VectorXd r = start;
    Eigen::VectorXd u = problem.w * r + problem.q;
    const Stopwatch watch;
    const int info = problem.dimension == 3
                         ? fc3d_driver(&siconos, r.data(), u.data(), options.get())
                         : fc2d_driver(&siconos, r.data(), u.data(), options.get());
    const double seconds = watch.seconds();
    if (i == 0 || seconds < best.seconds) best.seconds = seconds;
    best.claims = info == 0;
    best.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
    best.r = r;
    if (seconds > limits.long_run || info != 0) break;
  }
  NM_clear(siconos.M);
  return best;
}

}  // namespace faultsim
