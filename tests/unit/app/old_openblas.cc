// Preloaded into a program, makes OpenBLAS say what it says on a processor whose model it does not
// know: that it took its oldest kernel, unless OPENBLAS_CORETYPE names another.
#include <dlfcn.h>

#include <cstdlib>

extern "C" char* openblas_get_corename() {
  static char oldest[] = "Prescott";
  if (std::getenv("OPENBLAS_CORETYPE") == nullptr) return oldest;
  using Function = char*();
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "openblas_get_corename"))();
}
