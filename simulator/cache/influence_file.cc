#include "simulator/cache/influence_file.h"

#include <cmath>

#include "simulator/cache/sealed_file.h"
#include "simulator/cache/table_archive.h"

namespace faultsim {
namespace {

constexpr SealedFormat kInfluenceFile{.name = "influence", .version = 1};
constexpr const char* kTraction = "/traction";
constexpr const char* kDisplacement = "/displacement";

/// What the file holds besides P and O. Rows are cells, nodes or observed components.
struct InfluenceTables {
  std::vector<std::string> names;  ///< fingerprint, operator
  std::vector<std::string> region_names, fault_names, observation_names;
  std::vector<double> build_seconds;
  std::vector<int> sizes;         ///< n_dofs
  std::vector<int> cell_numbers;  ///< x 3
  std::vector<double> volume, fraction, centroid;
  std::vector<int> node_fault, node_dof;
  std::vector<double> node_position, node_normal, node_strike, node_dip, node_area;
  std::vector<double> observation_position;
};

template <typename Tables, typename Archive>
void for_each_influence_table(Tables& t, Archive&& archive) {
  archive("/names", t.names, 1, "", "");
  archive("/build_seconds", t.build_seconds, 1, "s", "time taken, without the factor");
  archive("/sizes", t.sizes, 1, "", "n_dofs");
  archive("/cells/numbers", t.cell_numbers, 3, "", "cell of the mesh, region or -1, material");
  archive("/cells/volume", t.volume, 1, "m3", "volume (plane strain: m2)");
  archive("/cells/fraction", t.fraction, 1, "1", "share of the volume that is in the region");
  archive("/cells/centroid", t.centroid, 3, "m", "mean of the corners");
  archive("/regions/names", t.region_names, 1, "", "");
  archive("/faults/names", t.fault_names, 1, "", "");
  archive("/nodes/fault", t.node_fault, 1, "", "fault of the node");
  archive("/nodes/position", t.node_position, 3, "m", "position");
  archive("/nodes/normal", t.node_normal, 3, "1", "normal, from the minus to the plus side");
  archive("/nodes/strike", t.node_strike, 3, "1", "strike direction");
  archive("/nodes/dip", t.node_dip, 3, "1", "dip direction, normal x strike");
  archive("/nodes/area", t.node_area, 1, "m2", "area (plane strain: m)");
  archive("/nodes/dof", t.node_dof, 3, "", "column of /traction for normal, strike, dip; -1 none");
  archive("/observations/names", t.observation_names, 1, "", "");
  archive("/observations/position", t.observation_position, 3, "m", "nodes observed");
}

void push_row(std::vector<double>& table, const Eigen::Vector3d& row) {
  table.insert(table.end(), row.data(), row.data() + 3);
}

InfluenceTables influence_tables(const InfluenceBlock& block, const FaultOperator& op) {
  InfluenceTables t;
  t.names = {block.fingerprint, block.operator_fingerprint};
  t.region_names = block.region_names;
  t.build_seconds = {block.build_seconds};
  t.sizes = {op.geometry.n_dofs};
  for (const InfluenceCell& cell : block.cells) {
    t.cell_numbers.insert(t.cell_numbers.end(), {cell.cell, cell.region, cell.material});
    t.volume.push_back(cell.volume);
    t.fraction.push_back(cell.fraction);
    push_row(t.centroid, cell.centroid);
  }
  const auto& faults = op.geometry.faults;
  for (int f = 0; f < static_cast<int>(faults.size()); ++f) {
    t.fault_names.push_back(faults[f].name);
    for (int k = faults[f].first_node; k < faults[f].first_node + faults[f].n_nodes; ++k) {
      const OperatorNode& node = op.geometry.nodes[k];
      t.node_fault.push_back(f);
      push_row(t.node_position, node.position);
      push_row(t.node_normal, node.normal);
      push_row(t.node_strike, node.strike);
      push_row(t.node_dip, node.dip);
      t.node_area.push_back(node.area);
      t.node_dof.insert(t.node_dof.end(), node.dof.begin(), node.dof.end());
    }
  }
  for (const ObservationRow& row : op.observed.rows) {
    t.observation_names.push_back(row.name);
    push_row(t.observation_position, row.position);
  }
  return t;
}

void require_agreement(bool holds, const char* what) {
  if (!holds) throw StorageError(concat("the tables of an influence block disagree: ", what));
}

InfluenceBlock decode_influence(const SealedContent& content) {
  InfluenceTables t;
  for_each_influence_table(t, ReadTables{content.file()});
  const std::size_t n_cells = t.volume.size();
  require_agreement(
      t.names.size() == 2 && t.build_seconds.size() == 1 && t.sizes.size() == 1 && t.sizes[0] >= 0,
      "names");
  require_agreement(t.cell_numbers.size() == 3 * n_cells && t.fraction.size() == n_cells &&
                        t.centroid.size() == 3 * n_cells,
                    "cells");
  InfluenceBlock block{.fingerprint = t.names[0],
                       .operator_fingerprint = t.names[1],
                       .region_names = std::move(t.region_names),
                       .build_seconds = t.build_seconds[0]};
  for (std::size_t c = 0; c < n_cells; ++c) {
    const int* number = &t.cell_numbers[3 * c];
    require_agreement(number[1] >= -1 && number[1] < static_cast<int>(block.region_names.size()),
                      "regions");
    block.cells.push_back({.cell = number[0],
                           .region = number[1],
                           .fraction = t.fraction[c],
                           .material = number[2],
                           .volume = t.volume[c],
                           .centroid = Eigen::Vector3d::Map(&t.centroid[3 * c])});
  }
  const int n_dofs = t.sizes[0];
  const double* p = content.mapped(kTraction, n_cells, static_cast<hsize_t>(n_dofs));
  const auto columns = static_cast<Eigen::Index>(n_cells);
  block.traction = StoredMatrix(p, n_dofs, columns, content.mapping());
  const std::size_t n_rows = t.observation_names.size();
  block.observed = Eigen::Map<const Eigen::MatrixXd>(content.mapped(kDisplacement, n_cells, n_rows),
                                                     static_cast<Eigen::Index>(n_rows), columns);
  return block;
}

std::string digest(const InfluenceBlock& block, const FaultOperator& op) {
  const InfluenceTables tables = influence_tables(block, op);
  std::vector<std::string> digests;
  for_each_influence_table(tables, DigestTables{digests});
  const auto p = block.traction.view();
  std::string all = fingerprint(p.data(), p.size() * sizeof(double));
  all += fingerprint(block.observed.data(), block.observed.size() * sizeof(double));
  for (const std::string& each : digests) all += each;
  return all;
}

}  // namespace

void write_influence(const InfluenceBlock& block, const FaultOperator& op,
                     const std::filesystem::path& path) {
  const auto p = block.traction.view();
  const auto n_cells = static_cast<hsize_t>(block.cells.size());
  const auto n_dofs = static_cast<hsize_t>(op.geometry.n_dofs);
  FAULTSIM_DEMAND(block.operator_fingerprint == op.fingerprint && p.rows() == op.geometry.n_dofs &&
                      p.cols() == static_cast<Eigen::Index>(n_cells) &&
                      block.observed.rows() == static_cast<Eigen::Index>(op.observed.rows.size()),
                  "a block of ", p.rows(), " x ", p.cols(), " for ", n_dofs, " dofs");
  const InfluenceTables tables = influence_tables(block, op);
  write_sealed(
      path, kInfluenceFile,
      [&](hid_t file) {
        for_each_influence_table(tables, WriteTables{file});
        hdf5::write_array(file, kTraction, {n_cells, n_dofs}, p.data(),
                          {"Pa/Pa", "P, cell by cell: locked traction per b dp + 3 K alpha_T dT"});
        hdf5::write_array(
            file, kDisplacement, {n_cells, static_cast<hsize_t>(block.observed.rows())},
            block.observed.data(), {"m/Pa", "O, cell by cell: observed displacement"});
      },
      [&](const SealedContent& content) {
        if (digest(decode_influence(content), op) != digest(block, op)) {
          throw StorageError("what was read is not what was written");
        }
      });
}

std::optional<InfluenceBlock> read_influence(const std::filesystem::path& path,
                                             const std::string& fingerprint, std::string* remark) {
  std::optional<InfluenceBlock> block;
  const auto decode = [&](const SealedContent& content) {
    InfluenceBlock found = decode_influence(content);
    if (found.fingerprint != fingerprint) {
      throw StorageError("it holds the influence block " + found.fingerprint);
    }
    block = std::move(found);
  };
  read_sealed(path, kInfluenceFile, decode, remark);
  return block;
}

}  // namespace faultsim
