#pragma once

#include <pybind11/pybind11.h>

#include <nlohmann/json_fwd.hpp>

/// The parts of the module faultsim._core, a function and a file each. What users see of them is in
/// python/faultsim, with types and documentation.
namespace faultsim::python {

void bind_errors(pybind11::module_& core);
void bind_scene(pybind11::module_& core);
void bind_geometry(pybind11::module_& core);
void bind_operator(pybind11::module_& core);
void bind_result(pybind11::module_& core);
void bind_simulation(pybind11::module_& core);
void bind_many_runs(pybind11::module_& core);
void bind_campaign(pybind11::module_& core);

/// A JSON value as dict, list, str, bool, int, float or None.
pybind11::object to_python(const nlohmann::json& value);
pybind11::object to_python(const nlohmann::ordered_json& value);

}  // namespace faultsim::python
