#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/held_simulation.h"
#include "python/bindings/scene_document.h"
#include "python/bindings/watched_work.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

using Held = std::shared_ptr<HeldSimulation>;
using Values = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kSimulation = "simulation";

Held held_of(const SceneDocument& scene, const std::string& cache) {
  auto self = std::make_shared<HeldSimulation>();
  Inside::hold(self->simulation, scene.document);
  self->cache.folder = cache;
  self->simulation.keep_operators(self->cache);
  return self;
}

bool prepare_held(HeldSimulation& self, const py::object& told, int threads) {
  const HeldAlone alone(self.is_busy, kSimulation);
  ToldMonitor monitor(told);
  bool is_new = false;
  run_watched(
      [&](StopToken stop) {
        is_new = self.simulation.prepare({monitor, stop, threads});
      },
      [&] { monitor.hand_over(); });
  return is_new;
}

/// What the work of run() leaves.
KeptResult kept_case(Simulation& simulation, const Changes& changes, bool with_fields,
                     const RunContext& context) {
  KeptResult kept;
  if (with_fields) kept.fields.emplace();
  RunWatch watch;
  if (with_fields) {
    watch.step = [&](const StepResult& step, const FaultFields& fields) {
      kept.fields->add_step(step, fields);
    };
  }
  simulation.change(changes);
  kept.result = simulation.run(context, watch);
  kept.geometry = simulation.geometry();
  kept.scene = std::make_shared<const Scene>(Inside::scene(simulation).scene);
  return kept;
}

std::shared_ptr<KeptResult> run_held(HeldSimulation& self, const Values& values, bool with_fields,
                                     const py::object& told, int threads) {
  const HeldAlone alone(self.is_busy, kSimulation);
  ToldMonitor monitor(told);
  auto kept = std::make_shared<KeptResult>();
  run_watched(
      [&](StopToken stop) {
        *kept =
            kept_case(self.simulation, changes_of(values), with_fields, {monitor, stop, threads});
      },
      [&] { monitor.hand_over(); });
  return kept;
}

}  // namespace

void bind_simulation(py::module_& core) {
  py::class_<HeldSimulation, Held>(core, "HeldSimulation",
                                   "A scene that is held, and its operator.")
      .def(py::init(&held_of))
      .def("twin",
           [](HeldSimulation& self) {
             const HeldAlone alone(self.is_busy, kSimulation);
             auto other = std::make_shared<HeldSimulation>();
             other->simulation = self.simulation.twin();
             other->cache = self.cache;
             return other;
           })
      .def("change",
           [](HeldSimulation& self, const Values& values) {
             const HeldAlone alone(self.is_busy, kSimulation);
             self.simulation.change(changes_of(values));
           })
      .def("needs_operator",
           [](HeldSimulation& self) {
             const HeldAlone alone(self.is_busy, kSimulation);
             return self.simulation.needs_operator();
           })
      .def("plan_text",
           [](HeldSimulation& self) {
             const HeldAlone alone(self.is_busy, kSimulation);
             return self.simulation.plan_text();
           })
      .def("identity",
           [](HeldSimulation& self) {
             const HeldAlone alone(self.is_busy, kSimulation);
             return self.simulation.identity();
           })
      .def("fault_names",
           [](HeldSimulation& self) {
             const HeldAlone alone(self.is_busy, kSimulation);
             std::vector<std::string> names;
             for (const auto& fault : Inside::scene(self.simulation).scene.faults)
               names.push_back(fault.name);
             return names;
           })
      .def("prepare", &prepare_held)
      .def("run", &run_held)
      .def("geometry", [](HeldSimulation& self) {
        const HeldAlone alone(self.is_busy, kSimulation);
        return std::const_pointer_cast<FaultGeometry>(self.simulation.geometry());
      });
}

}  // namespace faultsim::python
