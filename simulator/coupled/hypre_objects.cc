#include "simulator/coupled/hypre_objects.h"

#include <_hypre_parcsr_mv.h>
#include <mpi.h>

#include <cstdlib>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

void end_hypre() {
  HYPRE_Finalize();
  int ended = 0;
  MPI_Finalized(&ended);
  if (ended == 0) MPI_Finalize();
}

}  // namespace

void start_hypre() {
  static const bool started = [] {
    int has_mpi = 0;
    MPI_Initialized(&has_mpi);
    // Open MPI: alone, without mpirun, start no daemon that could spawn others. Half a second less.
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    if (has_mpi == 0 && MPI_Init(nullptr, nullptr) != MPI_SUCCESS) {
      throw ResourceError("MPI does not start, which the coupled path needs");
    }
    HYPRE_Init();
    std::atexit(end_hypre);
    return true;
  }();
  FAULTSIM_DEMAND(started, "hypre");
}

void require_one_rank() {
  start_hypre();
  int n_ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks == 1) return;
  throw InputError("coupled path", concat("it was started on ", n_ranks, " ranks"),
                   "start it without mpirun: it runs on one rank so far");
}

void check_hypre(const char* doing) {
  const HYPRE_Int error = HYPRE_GetError();
  if (error == 0) return;
  HYPRE_ClearAllErrors();
  if (error == HYPRE_ERROR_CONV) return;
  char text[1024] = "";
  HYPRE_DescribeError(error, text);
  throw ResourceError(concat("hypre failed while ", doing, ": ", text));
}

HypreMatrix::HypreMatrix(const SparseMatrix& matrix) {
  FAULTSIM_DEMAND(matrix.rows() == matrix.cols(), matrix.rows(), " rows, ", matrix.cols());
  start_hypre();
  const Eigen::SparseMatrix<double, Eigen::RowMajor, int> rows = matrix;
  const int n = static_cast<int>(rows.rows());
  std::vector<int> count(n), index(n);
  for (int i = 0; i < n; ++i) {
    index[i] = i;
    count[i] = rows.outerIndexPtr()[i + 1] - rows.outerIndexPtr()[i];
  }
  HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, n - 1, 0, n - 1, &owner_);
  HYPRE_IJMatrixSetObjectType(owner_, HYPRE_PARCSR);
  HYPRE_IJMatrixSetRowSizes(owner_, count.data());
  HYPRE_IJMatrixInitialize(owner_);
  HYPRE_IJMatrixSetValues(owner_, n, count.data(), index.data(), rows.innerIndexPtr(),
                          rows.valuePtr());
  HYPRE_IJMatrixAssemble(owner_);
  void* object = nullptr;
  HYPRE_IJMatrixGetObject(owner_, &object);
  matrix_ = static_cast<HYPRE_ParCSRMatrix>(object);
  check_hypre("copying a matrix");
}

HypreMatrix::~HypreMatrix() { HYPRE_IJMatrixDestroy(owner_); }

HypreVector::HypreVector(int size) {
  start_hypre();
  HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, size - 1, &owner_);
  HYPRE_IJVectorSetObjectType(owner_, HYPRE_PARCSR);
  HYPRE_IJVectorInitialize(owner_);
  HYPRE_IJVectorAssemble(owner_);
  void* object = nullptr;
  HYPRE_IJVectorGetObject(owner_, &object);
  vector_ = static_cast<HYPRE_ParVector>(object);
  values().setZero();
  check_hypre("making a vector");
}

HypreVector::~HypreVector() { HYPRE_IJVectorDestroy(owner_); }

Eigen::Map<Eigen::VectorXd> HypreVector::values() { return values_of(vector_); }

Eigen::Map<Eigen::VectorXd> values_of(HYPRE_ParVector vector) {
  hypre_Vector* local = hypre_ParVectorLocalVector(vector);
  return {hypre_VectorData(local), hypre_VectorSize(local)};
}

}  // namespace faultsim
