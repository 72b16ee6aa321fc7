#include "simulator/cache/influence_file.h"

#include "simulator/cache/operator_tables.h"

namespace faultsim {
namespace {

/// The faults and observation points of an operator, as far as P and O belong to them: written for
/// whoever reads the file elsewhere.
template <typename Archive>
void target_tables(const FaultOperator& op, const Archive& archive) {
  const FaultGeometry& geometry = op.geometry;
  std::vector<int> fault_of_node;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f)
    fault_of_node.insert(fault_of_node.end(), geometry.faults[f].n_nodes, static_cast<int>(f));
  FAULTSIM_DEMAND(fault_of_node.size() == geometry.nodes.size(), geometry.nodes.size(), " nodes");
  archive.list("/faults/names", geometry.faults, &OperatorFault::name);
  archive.list("/nodes/fault", fault_of_node, std::identity(), {"", "fault of the node"});
  node_tables(geometry.nodes, archive);
  archive.rows("/nodes/area", geometry.nodes, &OperatorNode::area,
               {"m2", "area (plane strain: m)"});
  archive.rows("/nodes/dof", geometry.nodes, &OperatorNode::dof,
               {"", "column of /traction for normal, strike, dip; -1 none"});
  observation_tables(op.observed.rows, archive);
}

struct InfluenceContent {
  static constexpr SealedFormat kFormat{.name = "influence", .version = 1};
  static constexpr const char* kName = "influence block";
  static const std::string& fingerprint_of(const InfluenceBlock& block) {
    return block.fingerprint;
  }

  const FaultOperator* op = nullptr;  ///< whose block is written; reading leaves its tables alone.

  template <typename Block, typename Archive>
  void operator()(Block& block, const Archive& archive) const {
    auto n_dofs = static_cast<int>(block.traction.view().rows());
    auto& all = block.cells;
    archive.values("/names", cells(block.fingerprint, block.operator_fingerprint));
    archive.values("/build_seconds", cells(block.build_seconds),
                   {"s", "time taken, without the factor"});
    archive.values("/sizes", cells(n_dofs), {"", "n_dofs"});
    archive.list("/cells/numbers", all,
                 [](auto& cell) { return cells(cell.cell, cell.region, cell.material); },
                 {"", "cell of the mesh, region or -1, material"});
    archive.rows("/cells/volume", all, &InfluenceCell::volume, {"m3", "volume (plane strain: m2)"});
    archive.rows("/cells/fraction", all, &InfluenceCell::fraction,
                 {"1", "share of the volume that is in the region"});
    archive.rows("/cells/centroid", all, &InfluenceCell::centroid, {"m", "mean of the corners"});
    archive.list("/regions/names", block.region_names, std::identity());
    Eigen::Index n_rows = block.observed.rows();
    if constexpr (Archive::kReads) {
      std::vector<std::string> observed;
      archive.list("/observations/names", observed, std::identity());
      n_rows = static_cast<Eigen::Index>(observed.size());
      for (const InfluenceCell& cell : all) {
        if (cell.region < -1 || cell.region >= static_cast<int>(block.region_names.size()))
          throw StorageError("the tables of an influence block disagree: regions");
      }
    } else {
      target_tables(*op, archive);
    }
    const auto n_cells = static_cast<Eigen::Index>(all.size());
    StoredMatrix observed(block.observed.data(), n_rows, n_cells, nullptr);
    archive.array("/traction", block.traction, n_dofs, n_cells,
                  {"Pa/Pa", "P, cell by cell: locked traction per b dp + 3 K alpha_T dT"});
    archive.array("/displacement", observed, n_rows, n_cells,
                  {"m/Pa", "O, cell by cell: observed displacement"});
    if constexpr (Archive::kReads) block.observed = observed.view();
  }
};

}  // namespace

void write_influence(const InfluenceBlock& block, const FaultOperator& op,
                     const std::filesystem::path& path) {
  const auto p = block.traction.view();
  const auto n_cells = static_cast<Eigen::Index>(block.cells.size());
  FAULTSIM_DEMAND(block.operator_fingerprint == op.fingerprint && p.rows() == op.geometry.n_dofs &&
                      p.cols() == n_cells && block.observed.cols() == n_cells &&
                      block.observed.rows() == static_cast<Eigen::Index>(op.observed.rows.size()),
                  "a block of ", p.rows(), " x ", p.cols(), " for ", op.geometry.n_dofs, " dofs");
  write_tables(path, block, InfluenceContent{&op});
}

std::optional<InfluenceBlock> read_influence(const std::filesystem::path& path,
                                             const std::string& fingerprint, std::string* remark) {
  return read_tables<InfluenceBlock, InfluenceContent>(path, fingerprint, remark);
}

}  // namespace faultsim
