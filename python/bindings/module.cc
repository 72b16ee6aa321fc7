#include "python/bindings/bindings.h"
#include "python/bindings/blas_choice.h"
#include "python/bindings/watched_work.h"
#include "simulator/common/fingerprint.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_kernel.h"

PYBIND11_MODULE(_core, core) {
  namespace python = faultsim::python;
  core.doc() = "The compiled part of faultsim; what is for users stands in the package.";
  core.attr("version") = FAULTSIM_VERSION;
  core.attr("numerics_version") = faultsim::kNumericsVersion;
  core.def("blas", &faultsim::blas_description);
  core.def("blas_reason", &faultsim::blas_kernel_reason);
  pybind11::module_::import("atexit").attr("register")(
      pybind11::cpp_function(&python::end_watched_works));
  python::choose_blas_kernel_in_place();
  python::bind_errors(core);
  python::bind_scene(core);
  python::bind_geometry(core);
  python::bind_operator(core);
  python::bind_result(core);
  python::bind_simulation(core);
  python::bind_many_runs(core);
  python::bind_campaign(core);
}
