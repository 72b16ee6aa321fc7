#include "simulator/linalg/blas_kernel.h"

#include <dlfcn.h>
#include <strings.h>
#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

/// The kernels of each set, the widest set first, as openblas_get_corename spells them. The first
/// of a set is the one to ask for: the widest that is built in everywhere.
const std::pair<VectorSet, std::vector<const char*>> kKernels[] = {
    {VectorSet::avx512, {"SkylakeX", "Cooperlake", "SapphireRapids"}},
    {VectorSet::avx2, {"Haswell", "Zen", "Excavator"}},
    {VectorSet::avx, {"Sandybridge", "Bulldozer", "Piledriver", "Steamroller"}},
    {VectorSet::sse,
     {"Nehalem", "Prescott", "Core2", "Penryn", "Dunnington", "Atom", "Nano", "Athlon", "Opteron",
      "Opteron_SSE3", "Barcelona", "Bobcat", "Katmai", "Coppermine", "Northwood", "Banias"}}};

constexpr const char* kCoreType = "OPENBLAS_CORETYPE";  // read by OpenBLAS as it is loaded
// Set by us beside kCoreType: "Prescott" = what the library had taken. Tells our own choice from
// the user's, also in children and on hosts to which a batch system carries the environment.
constexpr const char* kInsteadOf = "FAULTSIM_BLAS_KERNEL_INSTEAD_OF";

bool same_name(const std::string& a, const std::string& b) {
  return strcasecmp(a.c_str(), b.c_str()) == 0;  // OpenBLAS, too, ignores the case
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The tables of kernels are symbols of the library: gotoblas_SKYLAKEX.
bool library_has(const std::string& kernel) {
  std::string symbol = "gotoblas_";
  for (const char c : kernel)
    symbol += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return dlsym(RTLD_DEFAULT, symbol.c_str()) != nullptr;
}

/// Throws where the user asks for what the processor cannot execute: it would end in SIGILL.
void require_executable(const std::string& asked) {
  const std::optional<VectorSet> needed = vector_set_of_kernel(asked);
  if (!needed || *needed <= vector_set_of_processor()) return;
  throw ResourceError(concat(kCoreType, "=", asked, " needs ", to_string(*needed),
                             ", which this processor does not have (it has ",
                             to_string(vector_set_of_processor()), "); run: unset ", kCoreType));
}

}  // namespace

VectorSet vector_set_of_processor() {
  __builtin_cpu_init();
  // The extensions that OpenBLAS compiles these kernels with (-march=skylake-avx512, -mavx2 -mfma).
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return VectorSet::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return VectorSet::avx2;
  return __builtin_cpu_supports("avx") ? VectorSet::avx : VectorSet::sse;
}

std::optional<VectorSet> vector_set_of_kernel(const std::string& name) {
  for (const auto& [set, kernels] : kKernels) {
    for (const char* kernel : kernels) {
      if (same_name(kernel, name)) return set;
    }
  }
  return std::nullopt;
}

std::optional<std::string> wider_kernel(const std::string& taken, VectorSet processor,
                                        const std::function<bool(const std::string&)>& has) {
  const std::optional<VectorSet> now = vector_set_of_kernel(taken);
  if (!now) return std::nullopt;
  for (const auto& [set, kernels] : kKernels) {  // widest first
    if (set <= *now) return std::nullopt;
    for (const char* kernel : kernels) {
      if (set <= processor && has(kernel)) return kernel;
    }
  }
  return std::nullopt;
}

void start_anew(char** argv) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) execv(program.c_str(), argv);
  execv("/proc/self/exe", argv);  // the file has another name by now, or none
}

void choose_blas_kernel(char** argv) {
  std::string asked = variable(kCoreType);
  const std::string instead_of = variable(kInsteadOf);
  if (!asked.empty() && instead_of.empty()) return require_executable(asked);  // the user's
  // Ours, set here or on a host with another processor: what the library would take counts anew.
  const std::string taken = asked.empty() ? blas_info().kernel : instead_of;
  const std::string wanted =
      wider_kernel(taken, vector_set_of_processor(), library_has).value_or("");
  if (same_name(wanted, asked)) return;
  if (wanted.empty()) {
    unsetenv(kCoreType);
    unsetenv(kInsteadOf);
  } else {
    setenv(kCoreType, wanted.c_str(), 1);
    setenv(kInsteadOf, taken.c_str(), 1);
  }
  start_anew(argv);
  unsetenv(kCoreType);  // not started anew: what was taken stays, and the reason says so
  unsetenv(kInsteadOf);
}

std::string blas_kernel_reason() {
  const std::string asked = variable(kCoreType), instead_of = variable(kInsteadOf);
  const BlasInfo info = blas_info();
  if (!asked.empty() && !same_name(asked, info.kernel))
    return concat(kCoreType, "=", asked, " is not a kernel of this library, which chose this one");
  if (!instead_of.empty())
    return concat("chosen by faultsim: ", info.library,
                  " does not know this processor and would use ", instead_of, ", which leaves its ",
                  to_string(vector_set_of_processor()), " unused");
  if (!asked.empty()) return concat("set by ", kCoreType);
  const std::optional<std::string> wider =
      wider_kernel(info.kernel, vector_set_of_processor(), library_has);
  if (wider)
    return concat("chosen by OpenBLAS, which does not know this processor: runs are several times ",
                  "slower than with ", kCoreType, "=", *wider);
  return "chosen by OpenBLAS";
}

}  // namespace faultsim
