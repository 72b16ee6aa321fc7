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
/// Threads of ours that may call the BLAS at once, 1 to `wanted`: as many as find room for a work
/// buffer each under the limits of the process.
int threads_with_blas_room(int wanted);

/// L Lᵀ, exactly symmetric; the bits do not depend on the number of threads.
/// @param lower  L (n x n); what stands above the diagonal must be zero.
/// @pre BLAS computes with one thread where there are several of ours.
Eigen::MatrixXd lower_times_transpose(const Eigen::MatrixXd& lower, int n_threads = 1);

}  // namespace faultsim
