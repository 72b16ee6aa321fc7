#pragma once

#include <Eigen/Core>
#include <iosfwd>

#include "simulator/elasticity/elasticity.h"

/// Matrices and vectors as PETSc's binary files (manual pages of MatLoad and VecLoad), for solvers
/// of others on our systems: big-endian, 32-bit counts and indices, doubles. A file may hold
/// several objects, one after another.
namespace faultsim {

/// Header 1211216, rows, columns, entries; entries of each row; their columns; their values.
/// Throws ResourceError where a count does not fit into 32 bits.
void write_petsc(std::ostream& to, const Eigen::SparseMatrix<double, Eigen::RowMajor, long>& rows);
/// The transpose of a matrix: its columns are the rows that are written, nothing is copied.
void write_petsc_transposed(std::ostream& to, const SparseMatrix& matrix);
/// Header 1211214, size, values.
void write_petsc(std::ostream& to, const Eigen::Ref<const Eigen::VectorXd>& vector);

}  // namespace faultsim
