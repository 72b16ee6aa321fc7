#include <pybind11/stl.h>

#include <memory>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "simulator/model/fault_geometry.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

/// pybind11 hands out what is not const; nothing bound here writes.
using Geometry = std::shared_ptr<FaultGeometry>;
using Fault = std::shared_ptr<OperatorFault>;
using Line = std::shared_ptr<Profile>;

constexpr auto kNodeBytes = static_cast<py::ssize_t>(sizeof(OperatorNode));
/// A member of all nodes, in the memory of the operator.
template <int kRows>
py::array nodes(const py::object& self,
                const Eigen::Matrix<double, kRows, 1> OperatorNode::*member) {
  const auto& geometry = self.cast<const FaultGeometry&>();
  const auto n = static_cast<py::ssize_t>(geometry.nodes.size());
  return view(n == 0 ? nullptr : (geometry.nodes[0].*member).data(), {n, kRows}, self,
              {kNodeBytes, kNumberBytes});
}

py::array numbers(const py::object& self, const double OperatorNode::*member) {
  const auto& geometry = self.cast<const FaultGeometry&>();
  const auto n = static_cast<py::ssize_t>(geometry.nodes.size());
  return view(n == 0 ? nullptr : &(geometry.nodes[0].*member), {n}, self, {kNodeBytes});
}

py::array dofs(const py::object& self) {
  const auto& geometry = self.cast<const FaultGeometry&>();
  const auto n = static_cast<py::ssize_t>(geometry.nodes.size());
  return view(n == 0 ? nullptr : geometry.nodes[0].dof.data(), {n, 3}, self,
              {kNodeBytes, sizeof(int)});
}

/// Of vectors of fixed size that lie one after the other.
template <typename T, typename Row>
py::array rows(const std::vector<Row>& of, py::ssize_t n_columns, const py::object& owner) {
  const auto n = static_cast<py::ssize_t>(of.size());
  return view(n == 0 ? nullptr : of[0].data(), {n, n_columns}, owner,
              {static_cast<py::ssize_t>(sizeof(Row)), sizeof(T)});
}

template <typename T>
py::array list(const std::vector<T>& of, const py::object& owner) {
  return view(of.data(), {static_cast<py::ssize_t>(of.size())}, owner);
}

void bind_profile(py::module_& core) {
  constexpr auto kBytes = static_cast<py::ssize_t>(sizeof(ProfileSample));
  const auto sample_numbers = [](const double ProfileSample::*member) {
    return [member](const py::object& self) -> py::array {
      const auto& samples = self.cast<const Profile&>().samples;
      return view(&(samples[0].*member), {static_cast<py::ssize_t>(samples.size())}, self,
                  {kBytes});
    };
  };
  py::class_<Profile, Line>(core, "Profile", "A line down the dip of a fault.")
      .def_readonly("width", &Profile::width, "m along strike that it stands for; plane strain: 1.")
      .def_readonly("tip_before", &Profile::tip_before,
                    "m down the line, of the end above at which the sides cannot move apart; NaN = "
                    "the body ends there.")
      .def_readonly("tip_after", &Profile::tip_after, "The same of the end below, m.")
      .def_property_readonly("length", &Profile::length,
                             "The longest extent that slip could reach, m.")
      .def_property_readonly("position", sample_numbers(&ProfileSample::position),
                             "Of its samples, m down the line from its first point (n_samples).")
      .def_property_readonly("moving", sample_numbers(&ProfileSample::moving),
                             "Slip of a sample is this times the weighted sum of its nodes, < 1 "
                             "beside ends (n_samples).")
      .def_property_readonly(
          "edge",
          [](const py::object& self) { return list(self.cast<const Profile&>().edge, self); },
          "Ends of the parts of the line that samples stand for, m down the line (n_samples + 1).")
      .def_property_readonly(
          "node",
          [](const py::object& self) -> py::array {
            const auto& all = self.cast<const Profile&>().samples;
            return view(all[0].node.data(), {static_cast<py::ssize_t>(all.size()), 2}, self,
                        {kBytes, sizeof(int)});
          },
          "The two nodes of each sample, the heavier first (n_samples, 2).")
      .def_property_readonly(
          "weight",
          [](const py::object& self) -> py::array {
            const auto& all = self.cast<const Profile&>().samples;
            return view(all[0].weight.data(), {static_cast<py::ssize_t>(all.size()), 2}, self,
                        {kBytes, kNumberBytes});
          },
          "Of the values of these nodes; they sum to 1 (n_samples, 2).");
}

void bind_fault(py::module_& core) {
  py::class_<OperatorFault, Fault>(core, "Fault", "A fault as a surface.")
      .def_readonly("name", &OperatorFault::name, "Its name.")
      .def_readonly("first_node", &OperatorFault::first_node,
                    "The first of its nodes, which are consecutive.")
      .def_readonly("n_nodes", &OperatorFault::n_nodes, "How many nodes it has.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return rows<double>(self.cast<const OperatorFault&>().points, 3, self);
          },
          "Corners of faces, m (n_points, 3).")
      .def_property_readonly(
          "faces",
          [](const py::object& self) {
            return rows<int>(self.cast<const OperatorFault&>().faces, 4, self);
          },
          "Points at the corners of each face; a triangle has its last twice, a face of plane "
          "strain is (a, b, b, a) (n_faces, 4).")
      .def_property_readonly(
          "node_of_point",
          [](const py::object& self) {
            return list(self.cast<const OperatorFault&>().node_of_point, self);
          },
          "The node of each point; -1 = the sides cannot move apart there (n_points).")
      .def_property_readonly(
          "profiles",
          [](const Fault& self) {
            std::vector<Line> all;
            for (Profile& one : self->profiles) all.emplace_back(self, &one);
            return all;
          },
          "Lines down its dip, on which its measures are taken, from south to north or west to "
          "east.");
}

}  // namespace

void bind_geometry(py::module_& core) {
  bind_profile(core);
  bind_fault(core);
  const auto vectors = [](const Eigen::Vector3d OperatorNode::*member) {
    return [member](const py::object& self) { return nodes<3>(self, member); };
  };
  const auto scalars = [](const double OperatorNode::*member) {
    return [member](const py::object& self) { return numbers(self, member); };
  };
  py::class_<FaultGeometry, Geometry>(core, "Geometry", "Where the faults of a model are.")
      .def_property_readonly(
          "n_nodes", [](const FaultGeometry& self) { return self.nodes.size(); },
          "How many nodes all faults have.")
      .def_readonly("n_dofs", &FaultGeometry::n_dofs, "How many components of jumps are unknown.")
      .def_readonly("plane_strain", &FaultGeometry::plane_strain,
                    "Whether it is a section; areas are then m2 per metre of strike.")
      .def_readonly("half_domain", &FaultGeometry::half_domain,
                    "Whether only the half y >= 0 is modelled; areas and moments of nodes are then "
                    "to be doubled.")
      .def_property_readonly("position", vectors(&OperatorNode::position), "m (n_nodes, 3).")
      .def_property_readonly("normal", vectors(&OperatorNode::normal),
                             "Unit vectors from the minus to the plus side (n_nodes, 3).")
      .def_property_readonly("strike", vectors(&OperatorNode::strike),
                             "Unit vectors along strike (n_nodes, 3).")
      .def_property_readonly("dip", vectors(&OperatorNode::dip),
                             "Unit vectors down dip (n_nodes, 3).")
      .def_property_readonly("area", scalars(&OperatorNode::area),
                             "m2, or m in plane strain (n_nodes).")
      .def_property_readonly("shear_modulus", scalars(&OperatorNode::effective_shear_modulus),
                             "Of both sides together, 2 G+ G- / (G+ + G-), Pa (n_nodes).")
      .def_property_readonly("dof", &dofs,
                             "Index of the jump of each node along normal, strike and dip in an "
                             "operator; -1 = none (n_nodes, 3).")
      .def_property_readonly(
          "dof_area",
          [](const py::object& self) -> py::array {
            const auto& area = self.cast<const FaultGeometry&>().dof_area;
            return view(area.data(), {area.size()}, self);
          },
          "The area of each component of jumps, m2 or m (n_dofs).")
      .def_property_readonly(
          "faults",
          [](const Geometry& self) {
            std::vector<Fault> all;
            for (OperatorFault& one : self->faults) all.emplace_back(self, &one);
            return all;
          },
          "The faults, in the order of their nodes.");
}

}  // namespace faultsim::python
