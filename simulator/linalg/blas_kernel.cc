#include "simulator/linalg/blas_kernel.h"

#include <dlfcn.h>
#include <strings.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "simulator/common/errors.h"
#include "simulator/linalg/blas.h"

namespace faultsim {
namespace {

struct Kernel {
  const char* name;  // as OpenBLAS spells it in openblas_get_corename
  VectorSet set;
};
// The first of each set is the one to ask for: the widest that is built in everywhere.
constexpr std::array kKernels = {Kernel{"SkylakeX", VectorSet::avx512},
                                 Kernel{"Cooperlake", VectorSet::avx512},
                                 Kernel{"SapphireRapids", VectorSet::avx512},
                                 Kernel{"Haswell", VectorSet::avx2},
                                 Kernel{"Zen", VectorSet::avx2},
                                 Kernel{"Excavator", VectorSet::avx2},
                                 Kernel{"Sandybridge", VectorSet::avx},
                                 Kernel{"Bulldozer", VectorSet::avx},
                                 Kernel{"Piledriver", VectorSet::avx},
                                 Kernel{"Steamroller", VectorSet::avx},
                                 Kernel{"Nehalem", VectorSet::sse},
                                 Kernel{"Prescott", VectorSet::sse},
                                 Kernel{"Core2", VectorSet::sse},
                                 Kernel{"Penryn", VectorSet::sse},
                                 Kernel{"Dunnington", VectorSet::sse},
                                 Kernel{"Atom", VectorSet::sse},
                                 Kernel{"Nano", VectorSet::sse},
                                 Kernel{"Athlon", VectorSet::sse},
                                 Kernel{"Opteron", VectorSet::sse},
                                 Kernel{"Opteron_SSE3", VectorSet::sse},
                                 Kernel{"Barcelona", VectorSet::sse},
                                 Kernel{"Bobcat", VectorSet::sse},
                                 Kernel{"Katmai", VectorSet::sse},
                                 Kernel{"Coppermine", VectorSet::sse},
                                 Kernel{"Northwood", VectorSet::sse},
                                 Kernel{"Banias", VectorSet::sse}};

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
  const auto* found =
      std::ranges::find_if(kKernels, [&](const Kernel& k) { return same_name(k.name, name); });
  if (found == kKernels.end()) return std::nullopt;
  return found->set;
}

std::optional<std::string> wider_kernel(const std::string& taken, VectorSet processor,
                                        const std::function<bool(const std::string&)>& has) {
  const std::optional<VectorSet> now = vector_set_of_kernel(taken);
  if (!now) return std::nullopt;
  for (const Kernel& kernel : kKernels) {  // widest first
    if (kernel.set <= *now) return std::nullopt;
    if (kernel.set <= processor && has(kernel.name)) return kernel.name;
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
                  " does not know this processor and would take ", instead_of,
                  ", which leaves its ", to_string(vector_set_of_processor()), " unused");
  if (!asked.empty()) return concat("set by ", kCoreType);
  const std::optional<std::string> wider =
      wider_kernel(info.kernel, vector_set_of_processor(), library_has);
  if (wider)
    return concat("chosen by OpenBLAS, which does not know this processor: runs are several times ",
                  "slower than with ", kCoreType, "=", *wider);
  return "chosen by OpenBLAS";
}

}  // namespace faultsim
