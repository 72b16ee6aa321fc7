#pragma once

#include <Eigen/Core>
#include <string>

namespace faultsim {

/// The BLAS in use.
struct BlasInfo {
  std::string library;  ///< "OpenBLAS 0.3.21".
  std::string kernel;   ///< what it chose for this processor, or OPENBLAS_CORETYPE: "SkylakeX".
  int n_threads = 0;
};
BlasInfo blas_info();
/// The same in words: "OpenBLAS 0.3.21 SkylakeX, 1 thread".
std::string blas_description();
/// Empty if the process computes with OpenBLAS; otherwise a loud sentence on how to get it.
std::string blas_complaint();
/// Threads of OpenBLAS from now on, for the whole process. The bits of a result depend on it.
void set_blas_threads(int n_threads);

/// L Lᵀ, exactly symmetric.
/// @param lower  L (n x n); what stands above the diagonal must be zero.
Eigen::MatrixXd lower_times_transpose(const Eigen::MatrixXd& lower);

}  // namespace faultsim
