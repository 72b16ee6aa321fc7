#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "python/bindings/bindings.h"
#include "python/bindings/scene_document.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

py::dict to_python(const ParameterInfo& one) {
  using namespace py::literals;
  return py::dict("pointer"_a = one.pointer, "alias"_a = one.alias,
                  "unit"_a = one.is_text ? "" : si_unit(one.dimension), "value"_a = one.value,
                  "default"_a = one.default_value, "range"_a = one.range,
                  "new_operator"_a = one.new_family, "is_text"_a = one.is_text,
                  "description"_a = one.description);
}

/// What `faultsim plan` prints, as text and as values.
py::tuple plan_of(const SceneDocument& scene) {
  LoadedScene loaded = load_scene(scene.document);
  const FieldCheck fields = check_geometry(loaded);
  add_savings(loaded.scene, loaded.plan);
  std::string text = plan_to_text(loaded.plan);
  for (const std::string& note : fields.notes) text += note + "\n";
  return py::make_tuple(text, python::to_python(plan_to_json(loaded.plan)));
}

}  // namespace

void bind_scene(py::module_& core) {
  py::class_<SceneDocument>(core, "SceneDocument", "The document of a scene.")
      .def_static("from_file",
                  [](const std::string& file) { return SceneDocument{read_scene_file(file, {})}; })
      .def_static("from_text",
                  [](const std::string& text, const std::string& source) {
                    return SceneDocument{parse_json(text, source)};
                  })
      .def_static("starter",
                  [](const std::string& kind) {
                    return SceneDocument{parse_json(starter_scene(kind), kind)};
                  })
      .def("copy", [](const SceneDocument& self) { return self; })
      .def("put",
           [](SceneDocument& self, const std::vector<std::pair<std::string, std::string>>& values) {
             JsonDocument changed = self.document;
             faultsim::apply(changes_of(values), changed);
             self.document = std::move(changed);
           })
      .def("check",
           [](const SceneDocument& self) {
             LoadedScene loaded = load_scene(self.document);
             check_geometry(loaded);
           })
      .def("plan", &plan_of)
      .def("identity", [](const SceneDocument& self) { return load_scene(self.document).identity; })
      .def("text", [](const SceneDocument& self) { return self.document.value.dump(2); })
      .def("value", [](const SceneDocument& self) { return to_python(self.document.value); })
      .def("source", [](const SceneDocument& self) { return self.document.source; })
      .def("parameters", [](const SceneDocument& self) {
        py::list all;
        for (const ParameterInfo& one : parameters(self.document)) all.append(to_python(one));
        return all;
      });
  core.def("aliases", [](const SceneDocument& scene) { return parameter_aliases(scene.document); });
}

}  // namespace faultsim::python
