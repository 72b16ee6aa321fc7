#include "simulator/coupled/hypre_objects.h"

#include <_hypre_parcsr_mv.h>
#include <mpi.h>

#include <cstdlib>
#include <limits>

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

HypreMatrix::HypreMatrix(const SparseMatrix& symmetric) {
  start_hypre();
  const long n_entries = symmetric.nonZeros();
  FAULTSIM_DEMAND(symmetric.rows() == symmetric.cols() && symmetric.isCompressed() &&
                      n_entries <= std::numeric_limits<HYPRE_Int>::max(),
                  symmetric.rows(), " rows, ", symmetric.cols(), " columns, ", n_entries,
                  " entries");
  const auto n = static_cast<HYPRE_Int>(symmetric.rows());
  HYPRE_BigInt range[] = {0, n};
  matrix_ = hypre_ParCSRMatrixCreate(MPI_COMM_SELF, n, n, range, range, 0,
                                     static_cast<HYPRE_Int>(n_entries), 0);
  hypre_ParCSRMatrixInitialize(matrix_);
  hypre_CSRMatrix* const local = hypre_ParCSRMatrixDiag(matrix_);
  HYPRE_Int *begin = hypre_CSRMatrixI(local), *columns = hypre_CSRMatrixJ(local), at = 0;
  HYPRE_Complex* const values = hypre_CSRMatrixData(local);
  for (HYPRE_Int row = 0; row < n; ++row) {  // its diagonal first, as hypre's smoothers want it
    HYPRE_Int next = at + 1;
    for (SparseMatrix::InnerIterator it(symmetric, row); it; ++it) {
      const HYPRE_Int place = it.row() == row ? at : next++;
      columns[place] = static_cast<HYPRE_Int>(it.row());
      values[place] = it.value();
    }
    begin[row] = at;
    at = next;
  }
  begin[n] = at;
  FAULTSIM_DEMAND(at == n_entries, "a row without its diagonal");
  hypre_ParCSRMatrixSetNumNonzeros(matrix_);
  hypre_ParCSRMatrixSetDNumNonzeros(matrix_);
  check_hypre("copying a matrix");
}

HypreMatrix::~HypreMatrix() { hypre_ParCSRMatrixDestroy(matrix_); }

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
