#include "simulator/linalg/blas_start.h"

#include <cblas.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/process_memory.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_kernel.h"

namespace faultsim {
namespace {

constexpr double kWanted = kBlasBufferBytes + kLeastWorkingBytes;

/// Address space of the thread that builds an operator: its stack, and what malloc reserves for it.
constexpr double kThreadBytes = (8 + 64) * 1048576.0;

/// Throws if a limit of the process leaves less than `wanted` of what it counts.
void require_room(int resource, double used, double wanted, const char* option, const char* what) {
  struct rlimit limit = {};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const double bytes = static_cast<double>(limit.rlim_cur);
  if (bytes - used >= wanted) return;
  constexpr double kStep = 10000;  // kB, what ulimit counts in: a round number
  const double least = kStep * std::ceil((used + wanted) / 1024 / kStep);
  throw ResourceError(concat(
      "not enough memory: this process may have ", std::llround(bytes / 1e6), " MB of ", what,
      " (ulimit ", option, "), has ", std::llround(used / 1e6), " MB already, and needs ",
      std::llround(wanted / 1e6), " MB more for the linear algebra and a small scene; run: ulimit ",
      option, " ", std::llround(least), ", or more"));
}

/// The limits above say nothing of a machine that does not overcommit.
void require_mapping() {
  void* probe = mmap(nullptr, static_cast<std::size_t>(kWanted), PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (probe == MAP_FAILED) {
    throw ResourceError(concat("not enough memory: the system gives this process no ",
                               std::llround(kWanted / 1e6),
                               " MB, which the linear algebra and a small scene need; close other "
                               "programs"));
  }
  munmap(probe, static_cast<std::size_t>(kWanted));
}

}  // namespace

void start_blas(char** argv) {
  constexpr const char* kThreads = "OPENBLAS_NUM_THREADS";
  const char* given = std::getenv(kThreads);
  const bool was_one = given != nullptr && std::string(given) == "1";
  setenv(kThreads, "1", 1);
  choose_blas_kernel(argv);
  // A library that does not listen to the variable must not keep us from starting.
  if (!was_one && blas_info().n_threads != 1) start_anew(argv);
}

void take_blas_buffer() {
  static std::mutex mutex;
  static bool taken = false;
  const std::lock_guard lock(mutex);
  if (taken) return;
  const ProcessMemory used = process_memory();
  require_room(RLIMIT_AS, used.address_space, kWanted + kThreadBytes, "-v", "address space");
  require_room(RLIMIT_DATA, used.data, kWanted, "-d", "data");
  require_mapping();
  set_blas_threads(1);
  // Small products do without a buffer; this one, of a millisecond, does not.
  constexpr int kOrder = 128;
  const std::vector<double> a(std::size_t{kOrder} * kOrder, 1.0);
  std::vector<double> product(a.size());
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, kOrder, kOrder, 1.0, a.data(), kOrder, 0.0,
              product.data(), kOrder);
  taken = true;
}

}  // namespace faultsim
