#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulator/model/fault_operator.h"

namespace faultsim {

/// A FaultOperator without H as flat tables: what an operator file holds. Tables of Eigen vectors
/// are row by row, one row per node, point, ...; lists of varying length are one after the other.
struct OperatorTables {
  std::vector<std::string> fingerprint, blas, fault_names, observation_names;
  std::vector<int> header;         ///< n_dofs, plane_strain, half_domain, n_unknowns
  std::vector<double> provenance;  ///< build_seconds, factor_bytes
  std::vector<double> node_position, node_normal, node_strike, node_dip;  ///< n x 3
  std::vector<double> node_numbers;  ///< n x 5: area, G_eff, ν, edge_strike, edge_dip
  std::vector<int> node_dof;         ///< n x 3
  std::vector<int> node_n_pairs;     ///< pressure pairs of each node
  std::vector<int> pair_regions;     ///< x 2: minus, plus
  std::vector<double> pair_numbers;  ///< x 3: minus_fraction, plus_fraction, weight
  std::vector<int> fault_numbers;    ///< x 4: first node, nodes, points, faces
  std::vector<double> points;        ///< x 3
  std::vector<int> node_of_point;
  std::vector<int> faces;                ///< x 4
  std::vector<double> locked_positions;  ///< x 3
  std::vector<double> dof_area;
  std::vector<int> load_keys;                        ///< x 3: kind, index, material
  std::vector<double> locked;                        ///< column-major
  std::vector<double> observation_position;          ///< x 3
  std::vector<double> observed_load, observed_jump;  ///< column-major
};

OperatorTables to_tables(const FaultOperator& op);

/// Rebuilds the operator without H; every length and index is checked. Throws StorageError.
FaultOperator from_tables(const OperatorTables& tables);

/// H in the files of operators and surfaces, N/m.
inline constexpr const char* kStiffnessTable = "/h";

/// The file of an operator or surface in a cache.
inline std::filesystem::path cached_file(const std::filesystem::path& folder,
                                         const std::string& fingerprint) {
  return folder / (fingerprint + ".h5");
}

/// Calls archive(path, values, columns, units, long_name) for every table: the one list that
/// writing, reading and comparing share.
template <typename Tables, typename Archive>
void for_each_table(Tables& t, Archive&& archive) {
  archive("/fingerprint", t.fingerprint, 1, "", "");
  archive("/made_with/blas", t.blas, 1, "", "");
  archive("/made_with/cost", t.provenance, 1, "s, B", "build time, bytes of the factor");
  archive("/sizes", t.header, 1, "", "n_dofs, plane_strain, half_domain, n_unknowns");
  archive("/nodes/position", t.node_position, 3, "m", "position");
  archive("/nodes/normal", t.node_normal, 3, "1", "normal, from the minus to the plus side");
  archive("/nodes/strike", t.node_strike, 3, "1", "strike direction");
  archive("/nodes/dip", t.node_dip, 3, "1", "dip direction, normal x strike");
  archive("/nodes/numbers", t.node_numbers, 5, "m2, Pa, 1, m, m",
          "area, effective shear modulus, Poisson ratio, edge along strike, edge down dip");
  archive("/nodes/dof", t.node_dof, 3, "", "index of the jump in normal, strike, dip; -1 removed");
  archive("/nodes/n_pairs", t.node_n_pairs, 1, "", "number of pressure pairs of the node");
  archive("/pairs/regions", t.pair_regions, 2, "", "pressure region minus, plus; -1 none");
  archive("/pairs/numbers", t.pair_numbers, 3, "1", "fraction minus, fraction plus, weight");
  archive("/faults/names", t.fault_names, 1, "", "");
  archive("/faults/numbers", t.fault_numbers, 4, "", "first node, nodes, points, faces");
  archive("/faults/points", t.points, 3, "m", "points of all faults");
  archive("/faults/node_of_point", t.node_of_point, 1, "", "node at the point; -1 not split");
  archive("/faults/faces", t.faces, 4, "", "points at the faces' corners");
  archive("/locked_positions", t.locked_positions, 3, "m", "nodes held closed by a boundary");
  archive("/dof_area", t.dof_area, 1, "m2", "A per dof");
  archive("/loads/keys", t.load_keys, 3, "",
          "0 pressure, 1 boundary; region or boundary condition; material of the region, -1 none");
  archive("/loads/locked", t.locked, 1, "Pa per unit of load", "L, column by column");
  archive("/observations/names", t.observation_names, 1, "", "");
  archive("/observations/position", t.observation_position, 3, "m", "nodes observed");
  archive("/observations/load", t.observed_load, 1, "m per unit of load", "U, column by column");
  archive("/observations/jump", t.observed_jump, 1, "m per m", "V, column by column");
}

}  // namespace faultsim
