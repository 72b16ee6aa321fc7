#include "simulator/contact/moving_block.h"

#include <algorithm>

#include "simulator/linalg/column_sum.h"

namespace faultsim {

MovingBlock::MovingBlock(const ContactProblem& problem)
    : problem_(problem),
      row_(static_cast<std::size_t>(problem.n_dofs()), -1),
      column_(static_cast<std::size_t>(problem.n_dofs()), -1) {}

void MovingBlock::clear() {
  for (const int dof : row_dof_)
    if (dof >= 0) row_[dof] = -1;
  for (const int dof : dofs_) column_[dof] = -1;
  dofs_.clear();
  row_dof_.clear();
}

void MovingBlock::reserve(int rows, int columns) {
  if (rows <= g_.rows() && columns <= g_.cols()) return;
  const auto grown = [](Eigen::Index now, int wanted) {
    return wanted <= now ? now : std::max<Eigen::Index>(wanted, 2 * now);
  };
  Eigen::MatrixXf larger(grown(g_.rows(), rows), grown(g_.cols(), columns));
  larger.topLeftCorner(n_rows(), n_columns()) = g_.topLeftCorner(n_rows(), n_columns());
  g_.swap(larger);
}

/// All rows of a new column.
void MovingBlock::gather(int column, int dof) {
  const double* h = problem_.compliance.column(dof).data();
  float* g = g_.col(column).data();
  for (std::size_t r = 0; r < row_dof_.size(); ++r) {
    g[r] = row_dof_[r] < 0 ? 0 : static_cast<float>(h[row_dof_[r]]);
  }
}

/// New rows of the columns that were there, by symmetry: of a dof that has a column now, what that
/// column holds; else from the dof's own column of H, again and again from dofs next to each other.
void MovingBlock::add_rows(int first_row, int n_columns) {
  for (int r = first_row; r < n_rows(); ++r) {
    const int dof = row_dof_[r];
    if (dof < 0) {
      for (int c = 0; c < n_columns; ++c) g_(r, c) = 0;
    } else if (column_[dof] >= 0) {
      const float* g = entries(column_[dof]);
      for (int c = 0; c < n_columns; ++c) g_(r, c) = g[row_[dofs_[c]]];
    } else {
      const double* h = problem_.compliance.column(dof).data();
      for (int c = 0; c < n_columns; ++c) g_(r, c) = static_cast<float>(h[dofs_[c]]);
    }
  }
}

void MovingBlock::add(const std::vector<int>& nodes, const std::vector<int>& dofs) {
  const int old_rows = n_rows();
  const int old_columns = n_columns();
  reserve(old_rows + kRows * static_cast<int>(nodes.size()),
          old_columns + static_cast<int>(dofs.size()));
  for (const int k : nodes) {
    const ContactNode& node = problem_.nodes[k];
    for (const int dof : node.dof) {
      if (dof >= 0) row_[dof] = n_rows();
      row_dof_.push_back(dof);
    }
  }
  for (const int dof : dofs) {
    column_[dof] = n_columns();
    dofs_.push_back(dof);
    gather(n_columns() - 1, dof);
  }
  add_rows(old_rows, old_columns);
}

void MovingBlock::multiply(const Eigen::VectorXf& x, Eigen::VectorXf& z) {
  columns_.clear();
  factors_.clear();
  for (int c = 0; c < n_columns(); ++c) {
    if (x[c] == 0) continue;
    columns_.push_back(entries(c));
    factors_.push_back(x[c]);
  }
  z.setZero(n_rows());
  add_columns<float>(columns_, factors_, 0, {z.data(), static_cast<std::size_t>(n_rows())});
}

}  // namespace faultsim
