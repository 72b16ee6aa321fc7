#include "python/bindings/bindings.h"
#include "simulator/common/errors.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

py::object class_of(const char* name) { return py::module_::import("faultsim.errors").attr(name); }

void raise(const char* name, const std::exception& error) {
  const py::object type = class_of(name);
  PyErr_SetObject(type.ptr(), type(error.what()).ptr());
}

void raise_problems(const InputError& error) {
  const py::object problem_type = class_of("Problem"), type = class_of("InputError");
  py::list problems;
  for (const Problem& one : error.problems())
    problems.append(problem_type(one.pointer, one.line, one.what, one.cure));
  PyErr_SetObject(type.ptr(), type(error.what(), error.source(), problems).ptr());
}

}  // namespace

/// Errors of ours as those of faultsim.errors, kind by kind.
void bind_errors(py::module_&) {
  py::register_local_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      raise_problems(error);
    } catch (const ResourceError& error) {
      raise("ResourceError", error);
    } catch (const StorageError& error) {
      raise("StorageError", error);
    } catch (const Interrupted& error) {
      raise("Interrupted", error);
    } catch (const Error& error) {
      raise("Error", error);
    } catch (const InternalError& error) {
      raise("InternalError", error);
    }
  });
}

}  // namespace faultsim::python
