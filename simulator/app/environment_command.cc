#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "simulator/app/program.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/machine.h"
#include "simulator/files/json_text.h"
#include "simulator/flow/eclipse_result.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_kernel.h"
#include "simulator/linalg/cholesky.h"

namespace faultsim {
namespace {

using Fields = nlohmann::ordered_json;

struct EnvironmentArguments {
  bool json = false;
};

std::string machine() {
  struct utsname names = {};
  uname(&names);
  return names.machine;
}

/// The C library, too, chooses its functions by the processor.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

/// The compiler's flags without those that name files.
std::string flags() {
  std::istringstream words(FAULTSIM_FLAGS);
  std::string kept;
  for (std::string word; words >> word;) {
    if (word.find('/') == std::string::npos) kept += (kept.empty() ? "" : " ") + word;
  }
  return kept;
}

/// Whatever may change bits.
Fields environment() {
  const BlasInfo blas = blas_info();
  return {
      {"processor", processor()},
      {"machine", machine()},
      {"blas", blas_complaint().empty() ? blas.library : "not OpenBLAS"},
      {"blas_kernel", blas.kernel},
      {"cholmod", cholmod_version_text()},
      {"eigen", concat(EIGEN_WORLD_VERSION, ".", EIGEN_MAJOR_VERSION, ".", EIGEN_MINOR_VERSION)},
      {"libc", concat("glibc ", gnu_get_libc_version())},
      {"compiler", concat("g++ ", __VERSION__)},
      {"build_type", FAULTSIM_BUILD_TYPE},
      {"flags", flags()}};
}

/// What this program was built with, and what it has here: none of it changes bits.
Fields built_in() {
  return {{"egrid_files", reads_eclipse()},
          {"hdf5", FAULTSIM_HDF5},
          {"hypre", FAULTSIM_HYPRE},
          {"mpi", FAULTSIM_MPI},
          {"usable_cores", usable_cores()}};
}

std::string in_words(const std::string& name, const Fields& value) {
  if (name == "egrid_files") {
    return value.get<bool>() ? "read, by opm-common"
                             : "not read: built without opm-common; install libopm-common-dev and "
                               "build again, or give tables of cells as CSV";
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Prints what the bits of results depend on besides the scene, and its fingerprint. No names of
/// machines, no paths.
ExitCode environment_command(const EnvironmentArguments& arguments) {
  const std::string complaint = blas_complaint();
  if (!complaint.empty()) std::cerr << complaint << "\n";
  const Fields fields = environment();
  // Part of every identity, or set by scenes: not of the fingerprint.
  const Fields others = {{"version", FAULTSIM_VERSION},
                         {"numerics_version", kNumericsVersion},
                         {"blas_kernel_reason", blas_kernel_reason()},
                         {"blas_threads_at_start", blas_info().n_threads}};
  const Fields programs = built_in();
  const std::string hash = fingerprint(fields.dump());
  if (arguments.json) {
    Fields document = {{"fingerprint", hash}, {"environment", fields}, {"built_in", programs}};
    document.update(others);
    std::cout << json_text(std::move(document));
    return ExitCode::done;
  }
  for (const Fields& part : {fields, others, programs}) {
    for (const auto& [name, value] : part.items()) {
      std::cout << name << std::string(name.size() < 24 ? 24 - name.size() : 1, ' ')
                << in_words(name, value) << "\n";
    }
  }
  std::cout << "fingerprint             " << hash << "\n";
  return ExitCode::done;
}

}  // namespace

void add_environment(Program& program) {
  auto [command, a] = program.add(
      "environment", "what the last digits depend on: processor, BLAS, libraries; what is built in",
      environment_command);
  add_json(command, a.json);
  command->footer("Example: faultsim environment --json");
}

}  // namespace faultsim
