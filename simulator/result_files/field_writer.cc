#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "simulator/common/errors.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/result_files/fault_points.h"
#include "simulator/result_files/field_writer.h"
#include "simulator/result_files/file_pair.h"

namespace faultsim {
namespace {

/// A fault in the file.
struct WrittenFault : FaultPoints {
  std::string group;     ///< "/faults/NAME"
  std::string topology;  ///< "Quadrilateral", plane strain: "Polyline".
};

/// A name that HDF5 paths, XDMF references and ParaView all take.
std::string plain_name(const std::string& name, std::set<std::string>& taken) {
  std::string plain;
  for (const char c : name) {
    plain += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' ? c : '_';
  }
  if (plain.empty()) plain = "fault";
  std::string unique = plain;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = concat(plain, '_', i);
  return unique;
}

struct FieldInfo {
  const char* name;
  std::size_t n_components;
  const char* units;
  const char* long_name;
};

constexpr FieldInfo kFields[] = {
    {"traction_fault", 3, "Pa",
     "effective traction (normal, strike, dip); tension positive, acts on the minus side"},
    {"traction_global", 3, "Pa", "effective traction (x, y, z); acts on the minus side"},
    {"slip_fault", 3, "m", "jump plus minus minus side (opening, slip along strike, down dip)"},
    {"slip_global", 3, "m", "jump plus minus minus side (x, y, z)"},
    {"critical_index", 1, "1", "shear traction over current limit shear traction; 1 where open"},
    {"static_critical_index", 1, "1", "shear traction over static limit shear traction"},
    {"fault_pressure_change", 1, "Pa", "pressure change in the fault; positive when it rises"},
    {"creep_traction_fault", 3, "Pa",
     "traction beyond what pressure and slip alone would give (normal, strike, dip)"},
};
/// The last field is there only where salt creeps.
std::span<const FieldInfo> field_infos(bool creep) {
  return std::span(kFields).first(std::size(kFields) - (creep ? 0 : 1));
}
constexpr const char* kState = "state";
constexpr const char* kStateLegend = "0 = stick, 1 = slip, 2 = open";

/// The values of the fields at a node, in the order of kFields, all components.
/// @param node  its frame: of a mirrored point that of the image.
std::vector<double> values_at(const OperatorNode& node, const FaultFields& fields, int k,
                              bool is_split, bool mirrored) {
  const auto seen = [&](const Eigen::Vector3d& local) { return as_seen(local, mirrored); };
  const auto to_global = [&](const Eigen::Vector3d& local) -> Eigen::Vector3d {
    return local[0] * node.normal + local[1] * node.strike + local[2] * node.dip;
  };
  const Eigen::Vector3d traction = seen(fields.traction.col(k));
  const Eigen::Vector3d jump =
      is_split ? seen(fields.jump.col(k)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  std::vector<double> values;
  for (const auto& vector : {traction, to_global(traction), jump, to_global(jump)}) {
    values.insert(values.end(), vector.data(), vector.data() + 3);
  }
  values.insert(values.end(), {fields.critical_index[k], fields.static_critical_index[k],
                               fields.fault_pressure_change[k]});
  if (fields.creep_traction.cols() > 0) {
    const Eigen::Vector3d creep = seen(fields.creep_traction.col(k));
    values.insert(values.end(), creep.data(), creep.data() + 3);
  }
  return values;
}

}  // namespace

struct FieldWriter::Impl {
  std::filesystem::path folder;
  std::vector<OperatorNode> nodes;
  std::optional<hdf5::Handle> file;
  std::span<const FieldInfo> infos;
  std::vector<WrittenFault> faults;
  std::vector<std::string> names;
  std::vector<std::vector<hdf5::GrowingArray>> fields;  ///< per fault: infos, then the state.
  std::vector<double> times;
  std::vector<int> steps;
  std::vector<std::string> stages, outcomes;

  void write_geometry(const WrittenFault& fault, const std::string& name);
  void open_fields(const WrittenFault& fault);
  void append(std::size_t f, const FaultFields& step);
  XdmfGrid grid(std::size_t f) const;
};

void FieldWriter::Impl::write_geometry(const WrittenFault& fault, const std::string& name) {
  const std::size_t n = fault.source.size();
  std::vector<double> normal(3 * n, 0.0), strike = normal, dip = normal, area(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (fault.source[i] < 0) continue;
    const OperatorNode node = node_of(nodes, fault, i);
    for (std::size_t c = 0; c < 3; ++c) {
      normal[3 * i + c] = node.normal[c];
      strike[3 * i + c] = node.strike[c];
      dip[3 * i + c] = node.dip[c];
    }
    if (fault.split[i] != 0) area[i] = fault.share[i] * node.area;
  }
  const std::string at = fault.group + "/geometry/";
  hdf5::write_array(*file, at + "points", {n, 3}, fault.position.data(), {"m", "grid points"});
  hdf5::write_array(*file, at + "cells",
                    {fault.cells.size() / fault.points_per_cell, fault.points_per_cell},
                    fault.cells.data(), {"", "points of the faces"});
  hdf5::write_array(*file, at + "split", {n}, fault.split.data(),
                    {"",
                     "1: the sides can move apart; 0: fault edge, values of the nearest "
                     "split point and no slip"});
  hdf5::write_array(*file, at + "normal", {n, 3}, normal.data(),
                    {"1", "normal, from the minus to the plus side"});
  hdf5::write_array(*file, at + "strike", {n, 3}, strike.data(), {"1", "strike direction"});
  hdf5::write_array(*file, at + "dip", {n, 3}, dip.data(), {"1", "dip direction"});
  hdf5::write_array(*file, at + "area", {n}, area.data(), {"m2", "area of the node"});
  hdf5::write_text_attribute(*file, fault.group, "name", name);
}

void FieldWriter::Impl::open_fields(const WrittenFault& fault) {
  std::vector<hdf5::GrowingArray>& arrays = fields.emplace_back();
  for (const FieldInfo& info : infos) {
    arrays.emplace_back(*file, fault.group + "/steps/" + info.name, H5T_IEEE_F64LE,
                        fault.source.size(), info.n_components,
                        hdf5::About{info.units, info.long_name});
  }
  arrays.emplace_back(*file, fault.group + "/steps/" + kState, H5T_STD_I32LE, fault.source.size(),
                      1, hdf5::About{"", "contact state"});
  hdf5::write_text_attribute(arrays.back().id(), "legend", kStateLegend);
}

void FieldWriter::Impl::append(std::size_t f, const FaultFields& step) {
  const FaultPoints& fault = faults[f];
  const std::size_t n = fault.source.size();
  std::vector<std::vector<double>> tables;
  for (const FieldInfo& info : infos) tables.emplace_back(n * info.n_components, 0.0);
  std::vector<int> state(n, static_cast<int>(FaultState::stick));
  for (std::size_t i = 0; i < n; ++i) {
    const int k = fault.source[i];
    if (k < 0) continue;
    const std::vector<double> values =
        values_at(node_of(nodes, fault, i), step, k, fault.split[i] != 0, fault.mirrored[i] != 0);
    auto value = values.begin();
    for (std::size_t t = 0; t < tables.size(); ++t) {
      for (std::size_t c = 0; c < infos[t].n_components; ++c) {
        tables[t][i * infos[t].n_components + c] = *value++;
      }
    }
    if (fault.split[i] != 0) state[i] = step.state[k];
  }
  for (std::size_t t = 0; t < tables.size(); ++t) {
    fields[f][t].append(H5T_NATIVE_DOUBLE, tables[t].data());
  }
  fields[f].back().append(H5T_NATIVE_INT, state.data());
}

XdmfGrid FieldWriter::Impl::grid(std::size_t f) const {
  const WrittenFault& fault = faults[f];
  const std::size_t n = fault.source.size();
  const std::string at = fault.group + "/geometry/";
  XdmfGrid grid{
      names[f],
      fault.topology,
      {at + "cells", {fault.cells.size() / fault.points_per_cell, fault.points_per_cell}, true},
      {at + "points", {n, 3}},
      {}};
  grid.attributes.push_back({"split", {at + "split", {n}, true}});
  grid.attributes.push_back({"area", {at + "area", {n}}});
  for (const char* direction : {"normal", "strike", "dip"}) {
    grid.attributes.push_back({direction, {at + direction, {n, 3}}, false, true});
  }
  if (times.empty()) return grid;
  auto array = fields[f].begin();
  for (const FieldInfo& info : infos) {
    std::vector<std::size_t> shape = {n};
    if (info.n_components > 1) shape.push_back(info.n_components);
    grid.attributes.push_back({info.name,
                               {.path = fault.group + "/steps/" + info.name,
                                .shape = shape,
                                .offsets = (array++)->offsets()},
                               false,
                               info.n_components > 1});
  }
  grid.attributes.push_back({kState,
                             {.path = fault.group + "/steps/" + kState,
                              .shape = {n},
                              .integer = true,
                              .offsets = array->offsets()}});
  return grid;
}

FieldWriter::FieldWriter(const std::filesystem::path& folder, const FaultGeometry& geometry,
                         bool creep)
    : impl_(std::make_unique<Impl>()) {
  const hdf5::Session session;
  impl_->folder = folder;
  impl_->nodes = geometry.nodes;
  impl_->infos = field_infos(creep);
  impl_->file.emplace(hdf5::create_in_memory());
  std::set<std::string> taken;
  for (const OperatorFault& fault : geometry.faults) {
    WrittenFault points{collect_points(fault, geometry), "/faults/" + plain_name(fault.name, taken),
                        geometry.plane_strain ? "Polyline" : "Quadrilateral"};
    if (points.cells.empty()) continue;  // nothing to draw
    impl_->write_geometry(points, fault.name);
    impl_->open_fields(points);
    impl_->names.push_back(fault.name);
    impl_->faults.push_back(std::move(points));
  }
}

FieldWriter::~FieldWriter() {
  const hdf5::Session session;
  impl_.reset();
}

void FieldWriter::add_step(const StepResult& step, const FaultFields& fields) {
  const auto n = static_cast<Eigen::Index>(impl_->nodes.size());
  FAULTSIM_DEMAND(impl_->file.has_value(), "a step after finish()");
  const Eigen::Index n_creep = impl_->infos.size() == std::size(kFields) ? n : 0;
  FAULTSIM_DEMAND(
      fields.traction.cols() == n && fields.jump.cols() == n && fields.critical_index.size() == n &&
          fields.static_critical_index.size() == n && fields.state.size() == n &&
          fields.fault_pressure_change.size() == n && fields.creep_traction.cols() == n_creep,
      "fields of ", n, " nodes");
  FAULTSIM_DEMAND(fields.traction.allFinite() && fields.jump.allFinite() &&
                      fields.critical_index.allFinite() &&
                      fields.static_critical_index.allFinite() &&
                      fields.fault_pressure_change.allFinite() && fields.creep_traction.allFinite(),
                  "a field of step ", step.step, " is not finite");
  const hdf5::Session session;
  for (std::size_t f = 0; f < impl_->faults.size(); ++f) impl_->append(f, fields);
  impl_->times.push_back(step.time);
  impl_->steps.push_back(step.step);
  impl_->stages.push_back(step.stage);
  impl_->outcomes.emplace_back(to_string(step.outcome));
}

void FieldWriter::finish() {
  FAULTSIM_DEMAND(impl_->file.has_value(), "finish() twice");
  const hdf5::Session session;
  Impl& impl = *impl_;
  const std::size_t n_steps = impl.times.size();
  hdf5::write_array(*impl.file, "/time", {n_steps}, impl.times.data(), {"s", "time"});
  hdf5::write_array(*impl.file, "/step", {n_steps}, impl.steps.data(), {"", "load step"});
  hdf5::write_texts(*impl.file, "/stage", impl.stages);
  hdf5::write_texts(*impl.file, "/outcome", impl.outcomes);
  std::vector<XdmfGrid> grids;
  for (std::size_t f = 0; f < impl.faults.size(); ++f) grids.push_back(impl.grid(f));
  write_file_pair(impl.folder, "faults", *impl.file, grids, impl.times);
  impl.fields.clear();
  impl.file.reset();
}

}  // namespace faultsim
