#include "simulator/linalg/shared_bases.h"

#include <cblas.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// A Aᵀ, the lower triangle.
Eigen::MatrixXd gram_of(const Eigen::MatrixXd& a) {
  const int n = static_cast<int>(a.rows()), depth = static_cast<int>(a.cols());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, depth, 1, a.data(), n, 0, gram.data(), n);
  return gram;
}

/// Aᵀ B.
Eigen::MatrixXd transpose_times(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const int n = static_cast<int>(a.cols()), m = static_cast<int>(b.cols()),
            depth = static_cast<int>(a.rows());
  Eigen::MatrixXd product(n, m);
  if (product.size() == 0) return product;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, m, depth, 1, a.data(), depth, b.data(),
              depth, 0, product.data(), n);
  return product;
}

/// The fewest leading eigenvectors of a Gram matrix, the others' eigenvalues adding up to no more
/// than `left_out`.
Eigen::MatrixXd leading_directions(const Eigen::MatrixXd& gram, double left_out) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);  // ascending; lower triangle
  Eigen::Index n_left_out = 0;
  double sum = 0;
  while (n_left_out < gram.rows() &&
         sum + std::max(0.0, solver.eigenvalues()[n_left_out]) <= left_out)
    sum += std::max(0.0, solver.eigenvalues()[n_left_out++]);
  return solver.eigenvectors().rightCols(gram.rows() - n_left_out);
}

/// Matrices side by side become their transposes side by side.
Eigen::MatrixXd each_transposed(const Eigen::MatrixXd& side_by_side, Eigen::Index n_columns) {
  const Eigen::Index count = side_by_side.cols() / n_columns, n_rows = side_by_side.rows();
  Eigen::MatrixXd transposed(n_columns, n_rows * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    transposed.middleCols(k * n_rows, n_rows) =
        side_by_side.middleCols(k * n_columns, n_columns).transpose();
  }
  return transposed;
}

}  // namespace

Eigen::MatrixXd times_transpose(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  FAULTSIM_DEMAND(a.cols() == b.cols(), a.cols(), " and ", b.cols(), " columns");
  const int n = static_cast<int>(a.rows()), m = static_cast<int>(b.rows()),
            depth = static_cast<int>(a.cols());
  if (depth == 0) return Eigen::MatrixXd::Zero(n, m);
  Eigen::MatrixXd product(n, m);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n, m, depth, 1, a.data(), n, b.data(), m, 0,
              product.data(), n);
  return product;
}

SharedBases shared_bases(const Eigen::MatrixXd& side_by_side, Eigen::Index n_columns,
                         double left_out) {
  FAULTSIM_DEMAND(n_columns > 0 && side_by_side.cols() % n_columns == 0, side_by_side.cols(),
                  " columns of matrices of ", n_columns);
  SharedBases bases;
  bases.u = leading_directions(gram_of(side_by_side), left_out / 2);
  const Eigen::MatrixXd projected =
      each_transposed(transpose_times(bases.u, side_by_side), n_columns);
  bases.v = leading_directions(gram_of(projected), left_out / 2);
  bases.cores = transpose_times(bases.v, projected);
  return bases;
}

}  // namespace faultsim
