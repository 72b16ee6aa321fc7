#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/held_simulation.h"
#include "python/bindings/watched_work.h"
#include "simulator/common/near_miss.h"
#include "simulator/operators/influence.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

using Operator = std::shared_ptr<FaultOperator>;
using Block = std::shared_ptr<InfluenceBlock>;

/// A matrix stored column by column.
py::array matrix(const double* data, Eigen::Index n_rows, Eigen::Index n_columns,
                 const py::object& owner) {
  return view(data, {n_rows, n_columns}, owner, {kNumberBytes, n_rows * kNumberBytes});
}

py::array matrix(const Eigen::MatrixXd& values, const py::object& owner) {
  return matrix(values.data(), values.rows(), values.cols(), owner);
}

void bind_fault_operator(py::module_& core) {
  py::class_<FaultOperator, Operator>(core, "Operator", "The rock condensed onto its faults.")
      .def_readonly("fingerprint", &FaultOperator::fingerprint,
                    "Of what it depends on; also the name of its file.")
      .def_property_readonly(
          "geometry",
          [](const Operator& self) {
            return std::shared_ptr<FaultGeometry>(self, &self->geometry);
          },
          "Where its jumps are.")
      .def_property_readonly(
          "stiffness",
          [](const py::object& self) {
            const auto h = self.cast<const FaultOperator&>().h();
            return matrix(h.data(), h.rows(), h.cols(), self);
          },
          "H: column j has the forces on all jumps for a unit jump j, N/m, in plane strain per "
          "metre (n_dofs, n_dofs).")
      .def_property_readonly(
          "load_names",
          [](const FaultOperator& self) {
            std::vector<std::string> names;
            for (const LoadKey& key : self.loads.keys) names.push_back(to_string(key));
            return names;
          },
          "Of its columns: pressure:REGION:MATERIAL or boundary:NUMBER.")
      .def_property_readonly(
          "load_traction",
          [](const py::object& self) {
            return matrix(self.cast<const FaultOperator&>().loads.traction, self);
          },
          "What a unit of each load adds to the traction of closed faults, Pa per unit (n_dofs, "
          "n_loads).")
      .def_property_readonly(
          "observed_names",
          [](const FaultOperator& self) {
            std::vector<std::string> names;
            for (const ObservationRow& row : self.observed.rows) names.push_back(row.name);
            return names;
          },
          "Of observed components of displacement, POINT.AXIS.")
      .def_property_readonly(
          "observed_per_load",
          [](const py::object& self) {
            return matrix(self.cast<const FaultOperator&>().observed.per_load, self);
          },
          "Their displacement for a unit of each load, m per unit (n_observed, n_loads).")
      .def_property_readonly(
          "observed_per_jump",
          [](const py::object& self) {
            return matrix(self.cast<const FaultOperator&>().observed.per_jump, self);
          },
          "Their displacement for a unit of each jump, m per m (n_observed, n_dofs).");
}

/// A member of all cells, in the memory of the block.
template <typename T>
py::array cells(const py::object& self, const T InfluenceCell::*member) {
  const auto& all = self.cast<const InfluenceBlock&>().cells;
  return view(all.empty() ? nullptr : &(all[0].*member), {static_cast<py::ssize_t>(all.size())},
              self, {static_cast<py::ssize_t>(sizeof(InfluenceCell))});
}

py::array centroids(const py::object& self) {
  const auto& all = self.cast<const InfluenceBlock&>().cells;
  return view(all.empty() ? nullptr : all[0].centroid.data(),
              {static_cast<py::ssize_t>(all.size()), 3}, self,
              {static_cast<py::ssize_t>(sizeof(InfluenceCell)), kNumberBytes});
}

void bind_influence(py::module_& core) {
  py::class_<InfluenceBlock, Block>(core, "Influence",
                                    "What stress in single cells does to faults.")
      .def_readonly("fingerprint", &InfluenceBlock::fingerprint, "Of the operator and the cells.")
      .def_readonly("operator_fingerprint", &InfluenceBlock::operator_fingerprint,
                    "Of the operator whose jumps these are.")
      .def_readonly("region_names", &InfluenceBlock::region_names,
                    "Names of compartments, by their number.")
      .def_property_readonly(
          "cell", [](const py::object& self) { return cells(self, &InfluenceCell::cell); },
          "Number in the mesh (n_cells).")
      .def_property_readonly(
          "region", [](const py::object& self) { return cells(self, &InfluenceCell::region); },
          "Number of the compartment; -1 = none (n_cells).")
      .def_property_readonly(
          "fraction", [](const py::object& self) { return cells(self, &InfluenceCell::fraction); },
          "Share of the cell in it (n_cells).")
      .def_property_readonly(
          "material", [](const py::object& self) { return cells(self, &InfluenceCell::material); },
          "Number of the material in the scene (n_cells).")
      .def_property_readonly(
          "volume", [](const py::object& self) { return cells(self, &InfluenceCell::volume); },
          "m3, in plane strain m2 (n_cells).")
      .def_property_readonly("centroid", &centroids, "m (n_cells, 3).")
      .def_property_readonly(
          "traction",
          [](const py::object& self) {
            const auto p = self.cast<const InfluenceBlock&>().traction.view();
            return matrix(p.data(), p.rows(), p.cols(), self);
          },
          "P: what a unit of stress in each cell adds to the traction of closed faults, Pa per Pa "
          "(n_dofs, n_cells).")
      .def_property_readonly(
          "observed",
          [](const py::object& self) {
            return matrix(self.cast<const InfluenceBlock&>().observed, self);
          },
          "The same of observed displacements, m per Pa (n_observed, n_cells).")
      .def(
          "locked_change",
          [](const InfluenceBlock& self, const Eigen::MatrixXd& stress, int threads) {
            const py::gil_scoped_release released;
            return locked_change(self, stress, threads);
          },
          py::arg("stress"), py::arg("threads") = 1,
          "P s of fields of stress s = biot dp + 3 K alpha dT, Pa (n_cells, n_fields): Pa (n_dofs, "
          "n_fields), the same bits for any threads.");
}

Block influence_of(HeldSimulation& self, const std::vector<std::string>& names,
                   const py::object& told, int threads) {
  const HeldAlone alone(self.is_busy, "simulation");
  const LoadedScene& loaded = Inside::scene(self.simulation);
  if (loaded.plan.creep.active)
    throw InputError("influence", "salt creeps: an influence is of an elastic operator",
                     "switch creep off");
  std::vector<int> regions;
  const std::vector<std::string> known = region_names(loaded.scene);
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw InputError("regions", concat("there is no compartment \"", name, "\""),
                       suggest(name, known));
    regions.push_back(static_cast<int>(found - known.begin()));
  }
  ToldMonitor monitor(told);
  PreparedInfluence made;
  run_watched(
      [&](StopToken stop) {
        made = prepare_influence({loaded.scene, loaded.plan, loaded.mesh}, regions, self.cache,
                                 {monitor, stop, threads});
      },
      [&] { monitor.hand_over(); });
  return std::const_pointer_cast<InfluenceBlock>(made.block);
}

}  // namespace

void bind_operator(py::module_& core) {
  bind_fault_operator(core);
  bind_influence(core);
  core.def("operator_of", [](HeldSimulation& self) {
    const HeldAlone alone(self.is_busy, "simulation");
    return std::const_pointer_cast<FaultOperator>(Inside::prepared(self.simulation).op);
  });
  core.def("influence_of", &influence_of);
}

}  // namespace faultsim::python
