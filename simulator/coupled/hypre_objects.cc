#include "simulator/coupled/hypre_objects.h"

#include <_hypre_parcsr_mv.h>
#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/coupled/rank_job.h"

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
    // Containers forbid process_vm_readv, by which ranks on one host would read each other's
    // memory.
    setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
    if (has_mpi == 0 && MPI_Init(nullptr, nullptr) != MPI_SUCCESS) {
      throw ResourceError("MPI, which the coupled path needs, does not start");
    }
    HYPRE_Init();
    std::atexit(end_hypre);
    return true;
  }();
  FAULTSIM_DEMAND(started, "hypre");
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

namespace {

/// Columns of other ranks in own rows, ascending.
std::vector<HYPRE_BigInt> foreign_columns(const SparseMatrix& rows, int first, int n_own) {
  std::vector<HYPRE_BigInt> columns;
  for (int row = 0; row < n_own; ++row)
    for (SparseMatrix::InnerIterator it(rows, row); it; ++it)
      if (it.row() < first || it.row() >= first + n_own)
        columns.push_back(static_cast<HYPRE_BigInt>(it.row()));
  std::ranges::sort(columns);
  drop_repeated(columns);
  return columns;
}

double diagonal_of(const SparseMatrix& rows, int first, int row) {
  for (SparseMatrix::InnerIterator it(rows, row); it; ++it)
    if (it.row() == first + row) return it.value();
  FAULTSIM_DEMAND(false, "row ", first + row, " without its diagonal");
}

/// Fills a block of hypre's row by row.
class BlockFiller {
 public:
  explicit BlockFiller(hypre_CSRMatrix* block)
      : begin_(hypre_CSRMatrixI(block)),
        columns_(hypre_CSRMatrixJ(block)),
        values_(hypre_CSRMatrixData(block)) {}
  void begin_row(HYPRE_Int row) { begin_[row] = at_; }
  void append(HYPRE_Int column, double value) {
    columns_[at_] = column;
    values_[at_++] = value;
  }
  bool has(HYPRE_Int row, HYPRE_Int column) const {
    return std::find(columns_ + begin_[row], columns_ + at_, column) != columns_ + at_;
  }
  HYPRE_Int n_entries() const { return at_; }

 private:
  HYPRE_Int *begin_, *columns_, at_ = 0;
  HYPRE_Complex* values_;
};

}  // namespace

HypreMatrix::HypreMatrix(const SparseMatrix& symmetric)
    : HypreMatrix(symmetric, RowRanges::whole(static_cast<int>(symmetric.cols())), Ranks()) {}

HypreMatrix::HypreMatrix(const SparseMatrix& rows, const RowRanges& ranges, const Ranks& ranks,
                         const SparseMatrix& room)
    : ranks_(ranks), ranges_(ranges) {
  start_hypre();
  const int first = ranges.first(ranks), n_own = ranges.count(ranks);
  FAULTSIM_DEMAND(rows.rows() == ranges.n_rows() && rows.cols() == n_own && rows.isCompressed() &&
                      rows.nonZeros() + room.nonZeros() <= std::numeric_limits<HYPRE_Int>::max(),
                  rows.rows(), " rows, ", rows.cols(), " of them own, ", rows.nonZeros(),
                  " entries");
  const std::vector<HYPRE_BigInt> foreign = foreign_columns(rows, first, n_own);
  const auto place = [&](long column) {  // among the foreign ones
    return std::ranges::lower_bound(foreign, column) - foreign.begin();
  };
  const auto is_own = [&](long column) { return column >= first && column < first + n_own; };
  long n_foreign = 0;
  for (long k = 0; k < rows.nonZeros(); ++k) n_foreign += !is_own(rows.innerIndexPtr()[k]);
  const HYPRE_BigInt n = ranges.n_rows();
  HYPRE_BigInt range[] = {first, first + n_own};
  matrix_ = hypre_ParCSRMatrixCreate(
      communicator(ranks), n, n, range, range, static_cast<HYPRE_Int>(foreign.size()),
      static_cast<HYPRE_Int>(rows.nonZeros() - n_foreign + room.nonZeros()),
      static_cast<HYPRE_Int>(n_foreign));
  hypre_ParCSRMatrixInitialize(matrix_);
  std::ranges::copy(foreign, hypre_ParCSRMatrixColMapOffd(matrix_));
  BlockFiller own(hypre_ParCSRMatrixDiag(matrix_)), other(hypre_ParCSRMatrixOffd(matrix_));
  for (HYPRE_Int row = 0; row < n_own; ++row) {
    own.begin_row(row);
    other.begin_row(row);
    own.append(row, diagonal_of(rows, first, row));  // first, as hypre's smoothers want it
    for (SparseMatrix::InnerIterator it(rows, row); it; ++it) {
      if (it.row() == first + row) continue;
      if (is_own(it.row())) {
        own.append(static_cast<HYPRE_Int>(it.row() - first), it.value());
      } else {
        other.append(static_cast<HYPRE_Int>(place(it.row())), it.value());
      }
    }
    if (room.cols() == 0) continue;
    for (SparseMatrix::InnerIterator it(room, row); it; ++it)
      if (!own.has(row, static_cast<HYPRE_Int>(it.row())))
        own.append(static_cast<HYPRE_Int>(it.row()), 0);
  }
  own.begin_row(n_own);
  other.begin_row(n_own);
  hypre_CSRMatrixNumNonzeros(hypre_ParCSRMatrixDiag(matrix_)) = own.n_entries();
  hypre_ParCSRMatrixSetNumNonzeros(matrix_);
  hypre_ParCSRMatrixSetDNumNonzeros(matrix_);
  hypre_MatvecCommPkgCreate(matrix_);
  check_hypre("copying a matrix");
}

double* HypreMatrix::entry(int row, int column) const {
  hypre_CSRMatrix* const own = hypre_ParCSRMatrixDiag(matrix_);
  const HYPRE_Int *const columns = hypre_CSRMatrixJ(own), *const begin = hypre_CSRMatrixI(own);
  const HYPRE_Int* const at = std::find(columns + begin[row], columns + begin[row + 1], column);
  return at == columns + begin[row + 1] ? nullptr : hypre_CSRMatrixData(own) + (at - columns);
}

HypreMatrix::~HypreMatrix() { hypre_ParCSRMatrixDestroy(matrix_); }

HypreVector::HypreVector(const RowRanges& ranges, const Ranks& ranks) {
  start_hypre();
  const int first = ranges.first(ranks);
  HYPRE_IJVectorCreate(communicator(ranks), first, first + ranges.count(ranks) - 1, &owner_);
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
