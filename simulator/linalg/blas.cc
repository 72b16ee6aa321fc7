#include "simulator/linalg/blas.h"

#include <cblas.h>
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "simulator/common/errors.h"
#include "simulator/common/large_pages.h"
#include "simulator/common/process_memory.h"
#include "simulator/common/thread_team.h"

namespace faultsim {

BlasInfo blas_info() {
  std::istringstream config(openblas_get_config());  // "OpenBLAS 0.3.21 NO_LAPACKE ..."
  std::string name, version;
  config >> name >> version;
  return {name + " " + version, openblas_get_corename(), openblas_get_num_threads()};
}

std::string blas_description() {
  const BlasInfo info = blas_info();
  return concat(info.library, " ", info.kernel, ", ", counted(info.n_threads, "thread", "threads"));
}

std::string blas_complaint() {
  // CHOLMOD asks for dgemm_ by name, so the one that the process finds first is what it gets.
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  Dl_info info;
  if (dgemm == nullptr || dladdr(dgemm, &info) == 0) {
    return "no BLAS (dgemm_) found in this process; install libopenblas0-pthread";
  }
  const std::string file = info.dli_fname;
  char* real = realpath(file.c_str(), nullptr);
  const std::string path = real == nullptr ? file : std::string(real);
  free(real);
  if (path.find("openblas") != std::string::npos) return "";
  return concat("the linear algebra in use is ", path,
                ", not OpenBLAS: expect runs that are ten times slower and different last digits; "
                "run: sudo update-alternatives --config libblas.so.3-x86_64-linux-gnu");
}

void set_blas_threads(int n_threads) {
  FAULTSIM_DEMAND(n_threads >= 1, n_threads);
  // Not while another thread computes: to set what is set already is a change, too.
  if (openblas_get_num_threads() != n_threads) openblas_set_num_threads(n_threads);
}

int threads_with_blas_room(int wanted) {
  const std::optional<double> left = left_in_limits();
  if (wanted == 1 || !left) return wanted;
  const double more = std::floor((*left - kLeastWorkingBytes) / kBlasBufferBytes);
  return static_cast<int>(std::clamp(1 + more, 1.0, static_cast<double>(wanted)));
}

Eigen::MatrixXd lower_times_transpose(const Eigen::MatrixXd& lower, int n_threads) {
  FAULTSIM_DEMAND(lower.rows() == lower.cols(), lower.rows(), " x ", lower.cols());
  constexpr int kBlock = 128;  // wide enough for dgemm's speed, narrow enough to skip most zeros
  const int n = static_cast<int>(lower.rows()), n_blocks = (n + kBlock - 1) / kBlock;
  Eigen::MatrixXd product(n, n);
  ask_for_large_pages(product.data(), product.size() * sizeof(double));
  const auto make_block = [&](int block) {
    const int j = block * kBlock, width = std::min(kBlock, n - j);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n - j, width, j + width, 1.0,
                lower.data() + j, n, lower.data() + j, n, 0.0,
                product.data() + j + static_cast<std::ptrdiff_t>(j) * n, n);
  };
  constexpr int kBlocksPerThread = 4;  // fewer are made before a thread has started
  const int n_useful = std::clamp(n_blocks / kBlocksPerThread, 1, n_threads);
  ThreadTeam(threads_with_blas_room(n_useful)).for_each(n_blocks, make_block);
  product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
  return product;
}

}  // namespace faultsim
