#include "simulator/result_files/volume_writer.h"
#include <algorithm>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/result_files/file_pair.h"

namespace faultsim {

void write_file_pair(const std::filesystem::path& folder, const std::string& name, hid_t file,
                     const std::vector<XdmfGrid>& grids, const std::vector<double>& times) {
  const std::string h5_name = name + ".h5";
  PendingFile h5(folder / h5_name);
  PendingFile xmf(folder / (name + ".xmf"));
  const std::vector<std::byte> bytes = hdf5::image(file);
  h5.write(bytes.data(), bytes.size(), 0);
  const std::string text = xdmf_text(h5_name, name, grids, times);
  xmf.write(text.data(), text.size(), 0);
  xmf.sync();
  h5.commit();
  xmf.commit();
}

namespace {

/// A value per cell and snapshot, where the first snapshot has it.
void add_cell_changes(hid_t file, const std::vector<VolumeSnapshot>& snapshots, std::size_t n_cells,
                      Eigen::VectorXd VolumeSnapshot::*change, const std::string& name,
                      const hdf5::About& about, XdmfGrid& grid) {
  if ((snapshots.front().*change).size() == 0) return;
  hdf5::GrowingArray values(file, "/" + name, H5T_IEEE_F64LE, n_cells, 1, about);
  for (const VolumeSnapshot& snapshot : snapshots) {
    const Eigen::VectorXd& of_cells = snapshot.*change;
    FAULTSIM_DEMAND(static_cast<std::size_t>(of_cells.size()) == n_cells && of_cells.allFinite(),
                    name, " of ", of_cells.size(), " cells");
    values.append(H5T_NATIVE_DOUBLE, of_cells.data());
  }
  grid.attributes.push_back(
      {name, {.path = "/" + name, .shape = {n_cells}, .offsets = values.offsets()}, true});
}

}  // namespace

void write_volume(const std::filesystem::path& folder, const std::vector<Eigen::Vector3d>& nodes,
                  const VolumeCells& cells, const std::vector<int>& material,
                  const std::vector<VolumeSnapshot>& snapshots) {
  const std::size_t n_nodes = nodes.size();
  const std::size_t n_cells = material.size(), of_cell = cells.nodes_of_cell;
  FAULTSIM_DEMAND((of_cell == 8 || of_cell == 10) && cells.nodes.size() == n_cells * of_cell &&
                      n_nodes > 0 && n_cells > 0,
                  cells.nodes.size(), " nodes of cells, ", n_cells, " materials, ", n_nodes,
                  " nodes");
  FAULTSIM_DEMAND(std::ranges::all_of(nodes, [](const auto& node) { return node.allFinite(); }),
                  "a node's position is not finite");
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::create_in_memory();
  hdf5::write_array(file, "/mesh/nodes", {n_nodes, 3}, nodes[0].data(), {"m", "node positions"});
  const bool hexahedra = of_cell == 8;
  hdf5::write_array(file, "/mesh/cells", {n_cells, of_cell}, cells.nodes.data(),
                    {"", hexahedra ? "corners of hexahedra, VTK order"
                                   : "nodes of quadratic tetrahedra, VTK order"});
  hdf5::write_array(file, "/mesh/material", {n_cells}, material.data(), {"", "material"});
  std::vector<double> times;
  std::vector<std::string> names;
  for (const VolumeSnapshot& snapshot : snapshots) {
    times.push_back(snapshot.time);
    names.push_back(snapshot.name);
  }
  XdmfGrid grid{"volume",
                hexahedra ? "Hexahedron" : "Tetrahedron_10",
                {"/mesh/cells", {n_cells, of_cell}, true},
                {"/mesh/nodes", {n_nodes, 3}},
                {}};
  grid.attributes.push_back({"material", {"/mesh/material", {n_cells}, true}, true});
  if (!snapshots.empty()) {
    hdf5::write_array(file, "/time", {times.size()}, times.data(), {"s", "time"});
    hdf5::write_texts(file, "/name", names);
    hdf5::GrowingArray displacement(file, "/displacement", H5T_IEEE_F64LE, n_nodes, 3,
                                    {"m", "displacement since the initial equilibrium"});
    for (const VolumeSnapshot& snapshot : snapshots) {
      FAULTSIM_DEMAND(static_cast<std::size_t>(snapshot.displacement.cols()) == n_nodes &&
                          snapshot.displacement.allFinite(),
                      "snapshot ", snapshot.name, " of ", snapshot.displacement.cols(), " nodes");
      displacement.append(H5T_NATIVE_DOUBLE, snapshot.displacement.data());
    }
    grid.attributes.push_back(
        {"displacement",
         {.path = "/displacement", .shape = {n_nodes, 3}, .offsets = displacement.offsets()},
         false,
         true});
    add_cell_changes(file, snapshots, n_cells, &VolumeSnapshot::pressure_change, "pressure_change",
                     {"Pa", "pressure change in compartments since the initial state"}, grid);
    add_cell_changes(file, snapshots, n_cells, &VolumeSnapshot::temperature_change,
                     "temperature_change",
                     {"K", "temperature change in compartments since the initial state"}, grid);
  }
  write_file_pair(folder, "volume", file, {grid}, times);
}

}  // namespace faultsim
