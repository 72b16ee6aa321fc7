#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/kept_result.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/result/result_json.h"
#include "simulator/result/result_sentences.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

using Kept = std::shared_ptr<KeptResult>;

/// A field of a case: n_steps x n_nodes x components, in the memory of the result.
template <typename T>
py::array field(const py::object& self, std::vector<T> KeptFields::*member,
                py::ssize_t components) {
  const auto& fields = self.cast<const KeptFields&>();
  const std::vector<T>& all = fields.*member;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(fields.steps().size()),
                                    fields.n_nodes()};
  if (components > 1) shape.push_back(components);
  if (all.empty()) shape[0] = 0;  // no creep
  return view(all.data(), std::move(shape), self);
}

void bind_fields(py::module_& core) {
  const auto vectors = [](std::vector<double> KeptFields::*member) {
    return [member](const py::object& self) { return field(self, member, 3); };
  };
  const auto numbers = [](std::vector<double> KeptFields::*member) {
    return [member](const py::object& self) { return field(self, member, 1); };
  };
  py::class_<KeptFields, std::shared_ptr<KeptFields>>(core, "Fields", "The fields of a case.")
      .def_property_readonly(
          "steps",
          [](const py::object& self) -> py::array {
            const auto& steps = self.cast<const KeptFields&>().steps();
            return view(steps.data(), {static_cast<py::ssize_t>(steps.size())}, self);
          },
          "Load steps that it has fields of (n_steps).")
      .def_property_readonly(
          "times",
          [](const py::object& self) -> py::array {
            const auto& times = self.cast<const KeptFields&>().times();
            return view(times.data(), {static_cast<py::ssize_t>(times.size())}, self);
          },
          "Their times, s (n_steps).")
      .def_property_readonly(
          "traction", vectors(&KeptFields::traction),
          "Effective traction (normal, strike, dip), Pa, tension positive (n_steps, n_nodes, 3).")
      .def_property_readonly("slip", vectors(&KeptFields::jump),
                             "Jump of displacement (opening, along strike, down dip), m, plus side "
                             "minus minus side (n_steps, n_nodes, 3).")
      .def_property_readonly("creep_traction", vectors(&KeptFields::creep_traction),
                             "What creep of salt changed of the traction, Pa (n_steps, n_nodes, "
                             "3); (0, n_nodes, 3) without creep.")
      .def_property_readonly("critical_index", numbers(&KeptFields::critical_index),
                             "chi: shear traction over strength; 1 = slides (n_steps, n_nodes).")
      .def_property_readonly("static_critical_index", numbers(&KeptFields::static_critical_index),
                             "The same over the static strength (n_steps, n_nodes).")
      .def_property_readonly("fault_pressure_change", numbers(&KeptFields::fault_pressure_change),
                             "Of the fluid in the fault since the start, Pa (n_steps, n_nodes).")
      .def_property_readonly(
          "state", [](const py::object& self) { return field(self, &KeptFields::state, 1); },
          "0 = sticks, 1 = slips, 2 = is open (n_steps, n_nodes).");
}

/// Alone: of a short case all values take longer than the case.
py::object whole_of(const CaseResult& result) {
  CaseResult alone;
  alone.whole = result.whole;
  return to_python(result_to_json(alone)["whole"]);
}

std::vector<std::string> sentences(const CaseResult& result) {
  std::vector<std::string> all = {sliding_sentence(result)};
  for (const std::string& one : unresolved_sentences(result)) all.push_back(one);
  if (const std::string one = unexpected_sentence(result); !one.empty()) all.push_back(one);
  return all;
}

}  // namespace

void bind_result(py::module_& core) {
  bind_fields(core);
  py::class_<KeptResult, Kept>(core, "KeptResult", "A case that was run.")
      .def_property_readonly("outcome",
                             [](const KeptResult& self) { return to_string(self.result.outcome); })
      .def_property_readonly("identity",
                             [](const KeptResult& self) { return self.result.identity; })
      .def_property_readonly("geometry",
                             [](const KeptResult& self) {
                               return std::const_pointer_cast<FaultGeometry>(self.geometry);
                             })
      .def_property_readonly(
          "fields",
          [](const Kept& self) {
            return self->fields ? std::shared_ptr<KeptFields>(self, &*self->fields) : nullptr;
          })
      .def("value", [](const KeptResult& self) { return to_python(result_to_json(self.result)); })
      .def("whole", [](const KeptResult& self) { return whole_of(self.result); })
      .def("sentences", [](const KeptResult& self) { return sentences(self.result); })
      .def("history", &KeptResult::history)
      .def("drawn", &KeptResult::drawn);
  core.def("charts", [] {
    std::vector<std::pair<std::string, std::string>> all;
    for (const CaseChartInfo& info : case_charts()) all.emplace_back(info.name, info.meaning);
    return all;
  });
}

}  // namespace faultsim::python
