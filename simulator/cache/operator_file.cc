#include "simulator/cache/operator_cache.h"
#include "simulator/cache/operator_tables.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

void demand(bool holds, const char* what) {
  if (!holds) throw StorageError(concat("the tables of an operator disagree: ", what));
}

struct OperatorContent {
  static constexpr SealedFormat kFormat{.name = "operator", .version = 3};
  static constexpr const char* kName = "operator";
  static const std::string& fingerprint_of(const FaultOperator& op) { return op.fingerprint; }

  template <typename Op, typename Archive>
  void operator()(Op& op, const Archive& archive) const {
    operator_tables(op, archive);
    stiffness_table(op, archive, "H, condensed stiffness");
  }
};

void require_sound(const FaultOperator& op) {
  FAULTSIM_DEMAND(!op.fingerprint.empty() && op.fingerprint.find('/') == std::string::npos &&
                      op.fingerprint[0] != '.',
                  "fingerprint '", op.fingerprint, "'");
  FAULTSIM_DEMAND(op.compliance->size() == op.geometry.n_dofs, "H of size ", op.compliance->size(),
                  " for ", op.geometry.n_dofs, " dofs");
  OperatorContent()(
      op, TableGatherer([](const char* path, const auto& values, auto&&, auto&&) {
        if constexpr (std::is_floating_point_v<std::decay_t<decltype(values[0])>>) {
          FAULTSIM_DEMAND(
              std::ranges::all_of(values, [](double value) { return std::isfinite(value); }), path,
              " holds a value that is not finite");
        }
      }));
}

}  // namespace

void check_indices(const FaultOperator& op) {
  const int n_nodes = static_cast<int>(op.geometry.nodes.size());
  for (const OperatorNode& node : op.geometry.nodes) {
    for (const int dof : node.dof) demand(dof >= -1 && dof < op.geometry.n_dofs, "dof of a node");
  }
  for (const OperatorFault& fault : op.geometry.faults) {
    const int n_points = static_cast<int>(fault.points.size());
    demand(
        fault.first_node >= 0 && fault.n_nodes >= 0 && fault.first_node <= n_nodes - fault.n_nodes,
        "nodes of a fault");
    for (const int node : fault.node_of_point)
      demand(node >= -1 && node < n_nodes, "node of a point");
    for (const auto& face : fault.faces) {
      for (const int point : face) demand(point >= 0 && point < n_points, "corner of a face");
    }
  }
  for (const LoadKey& key : op.loads.keys)
    demand(key.kind == LoadKey::Kind::pressure || key.kind == LoadKey::Kind::boundary,
           "kind of a load");
}

void write_operator(const FaultOperator& op, const std::filesystem::path& folder) {
  require_sound(op);
  create_folders(folder);
  write_tables<OperatorContent>(cached_file(folder, op.fingerprint), op);
}

std::optional<FaultOperator> read_operator(const std::filesystem::path& folder,
                                           const std::string& fingerprint, std::string* remark) {
  return read_tables<FaultOperator, OperatorContent>(cached_file(folder, fingerprint), fingerprint,
                                                     remark);
}

}  // namespace faultsim
