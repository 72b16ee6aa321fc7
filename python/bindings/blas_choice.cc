#include "python/bindings/blas_choice.h"

#include <dlfcn.h>

#include <cctype>
#include <cstdlib>
#include <string>

#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_kernel.h"

namespace faultsim::python {
namespace {

constexpr const char* kCoreType = "OPENBLAS_CORETYPE";

void* symbol(const std::string& name) { return dlsym(RTLD_DEFAULT, name.c_str()); }

bool library_has(const std::string& kernel) {
  std::string name = "gotoblas_";
  for (const char c : kernel)
    name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return symbol(name) != nullptr;
}

}  // namespace

void choose_blas_kernel_in_place() {
  if (std::getenv(kCoreType) != nullptr) return;
  const auto wanted = wider_kernel(blas_info().kernel, vector_set_of_processor(), library_has);
  // What the library itself calls as it is loaded and as it is closed; both read the variable.
  auto* const forget = reinterpret_cast<void (*)()>(symbol("gotoblas_dynamic_quit"));
  auto* const choose = reinterpret_cast<void (*)()>(symbol("gotoblas_dynamic_init"));
  if (!wanted || forget == nullptr || choose == nullptr) return;
  setenv(kCoreType, wanted->c_str(), 1);
  forget();
  choose();
  unsetenv(kCoreType);
}

}  // namespace faultsim::python
