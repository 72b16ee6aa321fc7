#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/held_simulation.h"
#include "python/bindings/many_runs.h"
#include "python/bindings/watched_work.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// name, unit, and an array of doubles or a list of texts, for as many cases as the others.
VariedParameter parameter_of(const py::tuple& given, std::vector<Column>& kept) {
  VariedParameter one = {given[0].cast<std::string>(), given[1].cast<std::string>()};
  if (py::isinstance<py::list>(given[2])) {
    one.texts = given[2].cast<std::vector<std::string>>();
  } else {
    kept.push_back(given[2].cast<Column>());
    one.values = kept.back().data();
  }
  return one;
}

py::array_t<double> histories_of(const ManyResults& results, py::ssize_t n_cases,
                                 py::ssize_t n_histories) {
  py::array_t<double> all({n_cases, static_cast<py::ssize_t>(results.n_steps),
                           static_cast<py::ssize_t>(results.n_faults), n_histories});
  const double* values = results.histories.data();
  std::copy(values, values + results.histories.size(), all.mutable_data());
  return all;
}

py::tuple run_rows(HeldSimulation& self, const std::vector<py::tuple>& parameters,
                   py::ssize_t n_cases, const std::vector<std::string>& outputs,
                   const std::vector<std::string>& histories, bool keeps_going, int threads,
                   const py::object& progress) {
  const HeldAlone alone(self.is_busy, "simulation");
  ManyRequest request = {{}, n_cases, outputs, histories, keeps_going};
  std::vector<Column> kept;
  for (const py::tuple& one : parameters) request.parameters.push_back(parameter_of(one, kept));
  ManyResults results;
  std::atomic<long> done = 0;
  long told = -1;
  run_watched(
      [&](StopToken stop) { results = run_many(self.simulation, request, threads, stop, done); },
      [&] {
        if (progress.is_none() || done == told) return;
        told = done;
        progress(told, n_cases);
      });
  std::vector<int> outcomes;
  for (const Outcome one : results.outcomes) outcomes.push_back(static_cast<int>(one));
  return py::make_tuple(std::move(results.outputs), outcomes, results.refused, results.times,
                        histories_of(results, n_cases, static_cast<py::ssize_t>(histories.size())));
}

}  // namespace

void bind_many_runs(py::module_& core) {
  core.def("run_many", &run_rows);
  core.def("output_names", &OutputColumn::names_of_case);
  core.def("outcome_names", [] {
    std::vector<std::string> names;
    for (const char* word : words(Outcome())) names.emplace_back(word);
    return names;
  });
}

}  // namespace faultsim::python
