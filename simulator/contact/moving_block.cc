#include "simulator/contact/moving_block.h"

#include <algorithm>

#include "simulator/linalg/blas.h"

namespace faultsim {

MovingBlock::MovingBlock(const ContactProblem& problem)
    : problem_(problem),
      row_(static_cast<std::size_t>(problem.n_nodes()), -1),
      column_(static_cast<std::size_t>(problem.n_dofs()), -1) {}

void MovingBlock::clear() {
  for (const int node : nodes_) row_[node] = -1;
  for (const int dof : dofs_) column_[dof] = -1;
  nodes_.clear();
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

/// New rows of the columns that were there, read by symmetry from the columns of their own dofs: a
/// few of them, and again from dofs next to each other.
void MovingBlock::add_rows(int first_row, int n_columns) {
  std::vector<const double*> rows;
  for (std::size_t r = static_cast<std::size_t>(first_row); r < row_dof_.size(); ++r) {
    rows.push_back(row_dof_[r] < 0 ? nullptr : problem_.compliance.column(row_dof_[r]).data());
  }
  for (int c = 0; c < n_columns; ++c) {
    const int dof = dofs_[c];
    float* g = g_.col(c).data() + first_row;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      g[r] = rows[r] == nullptr ? 0 : static_cast<float>(rows[r][dof]);
    }
  }
}

void MovingBlock::add(const std::vector<int>& nodes, const std::vector<int>& dofs) {
  const int old_rows = n_rows();
  const int old_columns = n_columns();
  reserve(old_rows + kRows * static_cast<int>(nodes.size()),
          old_columns + static_cast<int>(dofs.size()));
  for (const int k : nodes) {
    row_[k] = n_rows();
    nodes_.push_back(k);
    const ContactNode& node = problem_.nodes[k];
    row_dof_.insert(row_dof_.end(), node.dof.begin(), node.dof.end());
  }
  add_rows(old_rows, old_columns);
  for (const int dof : dofs) {
    column_[dof] = n_columns();
    dofs_.push_back(dof);
    gather(n_columns() - 1, dof);
  }
}

void MovingBlock::multiply(const Eigen::VectorXf& x, Eigen::VectorXf& z) const {
  multiply_leading(g_, n_rows(), n_columns(), x, z);
}

}  // namespace faultsim
