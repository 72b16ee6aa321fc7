#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// G, what motion does to those who move: the rows of H at all dofs of some nodes and its columns
/// at some dofs of theirs, side by side in memory and in single precision, N/m. It grows as nodes
/// begin to move and is read many times for each entry of H gathered. Single precision will do for
/// a tangent, whose equations are measured in double precision.
class MovingBlock {
 public:
  static constexpr int kRows = 3;  ///< per node: those of dofs that a node has not are 0.

  explicit MovingBlock(const ContactProblem& problem);

  void clear();
  int n_rows() const { return static_cast<int>(row_dof_.size()); }
  int n_columns() const { return static_cast<int>(dofs_.size()); }
  /// The first row of a node; −1: it is not in the block.
  int row(int node) const { return row_[problem_.nodes[node].dof[0]]; }
  /// The column of a dof; −1: it is not in the block.
  int column(int dof) const { return column_[dof]; }
  /// n_rows() entries.
  const float* entries(int column) const { return g_.col(column).data(); }

  /// Adds nodes and dofs to what is in the block. @pre none of them is in it, and no twins.
  void add(const std::vector<int>& nodes, const std::vector<int>& dofs);
  /// z := G x. x: n_columns(), z: n_rows(). Columns whose entry of x is 0 are not read.
  void multiply(const Eigen::VectorXf& x, Eigen::VectorXf& z);

 private:
  void reserve(int rows, int columns);
  void gather(int column, int dof);
  void add_rows(int first_row, int n_columns);

  const ContactProblem& problem_;
  std::vector<int> row_dof_;           ///< dof of each row, −1 where the node has none.
  std::vector<int> dofs_;              ///< of columns, in the order they came.
  std::vector<int> row_, column_;      ///< per dof of the operator.
  Eigen::MatrixXf g_;                  ///< of which n_rows() x n_columns() are in use.
  std::vector<const float*> columns_;  ///< that a product needs, and what of each.
  std::vector<float> factors_;
};

}  // namespace faultsim
