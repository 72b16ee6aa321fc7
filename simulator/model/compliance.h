#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>

#include "simulator/model/stored_matrix.h"

namespace faultsim {

class ThreadTeam;  // common/thread_team.h

/// Rows first … first + n − 1.
struct RowRange {
  int first, n;
};

/// The condensed stiffness H (docs/model.md, 8): column j holds the forces on all jumps for a unit
/// jump j with all others locked. n x n, symmetric, N/m (plane strain: per metre of thickness). All
/// that contact asks of the rock; whether columns are stored or solved for is not its business.
class Compliance {
 public:
  using Column = Eigen::Map<const Eigen::VectorXd>;

  virtual ~Compliance() = default;
  virtual int size() const = 0;  ///< n.
  /// H e_j, by symmetry also row j. Valid as long as this object; where columns are solved for, as
  /// long as that says. Ask for none that does not matter: it may have to be made.
  virtual Column column(int j) const = 0;
  virtual double diagonal(int j) const = 0;
  /// At least H_jj, at next to no cost: for what needs its order of magnitude alone.
  virtual double diagonal_bound(int j) const { return diagonal(j); }
  /// Whether a column or a diagonal entry costs the solution of a large system when it is first
  /// asked for. Then only what moves is worth it.
  virtual bool is_solved_for() const { return false; }
  /// traction −= A⁻¹ Σ_j H e_j g_j over the jumps listed, summed in their order; the others count
  /// as 0. In the rows given only, with the bits that they have when all are.
  /// @param team  shares the rows where they are many; the bits are the same with any, or none.
  void subtract_product(std::span<const int> active, const Eigen::VectorXd& jump,
                        const Eigen::VectorXd& inverse_area, std::span<const RowRange> rows,
                        Eigen::VectorXd& traction, ThreadTeam* team = nullptr) const;
  /// All of H as a matrix, n x n, for files, diagnosis and tests: null where it cannot be had.
  virtual const double* matrix_entries() const { return nullptr; }
};

/// H as a matrix, both triangles stored, column-major.
class DenseCompliance final : public Compliance {
 public:
  /// Throws InternalError when h is not square.
  explicit DenseCompliance(StoredMatrix h);
  explicit DenseCompliance(Eigen::MatrixXd h) : DenseCompliance(StoredMatrix(std::move(h))) {}

  Eigen::Map<const Eigen::MatrixXd> matrix() const { return h_.view(); }

  int size() const override { return static_cast<int>(matrix().rows()); }
  Column column(int j) const override { return {matrix().col(j).data(), matrix().rows()}; }
  double diagonal(int j) const override { return matrix()(j, j); }
  const double* matrix_entries() const override { return matrix().data(); }

 private:
  StoredMatrix h_;
};

}  // namespace faultsim
