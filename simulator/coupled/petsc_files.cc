#include "simulator/coupled/petsc_files.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <ostream>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr long kPetscMatrix = 1211216, kPetscVector = 1211214;  // MAT_FILE_CLASSID, VEC_…

template <typename Bits>
void write_big_endian(std::ostream& to, Bits bits) {
  char bytes[sizeof bits];
  for (int i = static_cast<int>(sizeof bits) - 1; i >= 0; --i, bits >>= 8)
    bytes[i] = static_cast<char>(bits & 0xff);
  to.write(bytes, sizeof bytes);
}

void write_count(std::ostream& to, long count) {
  if (count > std::numeric_limits<std::int32_t>::max())
    throw ResourceError(concat("PETSc's files count with 32 bits, but this is ", count));
  write_big_endian(to, static_cast<std::uint32_t>(count));
}

void write_value(std::ostream& to, double value) {
  write_big_endian(to, std::bit_cast<std::uint64_t>(value));
}

/// Of compressed rows or, for the transpose, columns.
template <typename Matrix>
void write_outer(std::ostream& to, const Matrix& matrix) {
  FAULTSIM_DEMAND(matrix.isCompressed(), "gaps among the entries");
  const long n_outer = matrix.outerSize(), n_entries = matrix.nonZeros();
  for (const long header :
       {kPetscMatrix, n_outer, static_cast<long>(matrix.innerSize()), n_entries})
    write_count(to, header);
  const auto* const begin = matrix.outerIndexPtr();
  for (long i = 0; i < n_outer; ++i) write_count(to, begin[i + 1] - begin[i]);
  for (long k = 0; k < n_entries; ++k) write_count(to, matrix.innerIndexPtr()[k]);
  for (long k = 0; k < n_entries; ++k) write_value(to, matrix.valuePtr()[k]);
}

}  // namespace

void write_petsc(std::ostream& to, const Eigen::SparseMatrix<double, Eigen::RowMajor, long>& rows) {
  write_outer(to, rows);
}

void write_petsc_transposed(std::ostream& to, const SparseMatrix& matrix) {
  write_outer(to, matrix);
}

void write_petsc(std::ostream& to, const Eigen::Ref<const Eigen::VectorXd>& vector) {
  write_count(to, kPetscVector);
  write_count(to, vector.size());
  for (const double value : vector) write_value(to, value);
}

}  // namespace faultsim
