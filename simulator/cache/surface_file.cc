#include "simulator/cache/surface_file.h"

#include "simulator/cache/operator_tables.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

constexpr double CaseSurface::*kNumbers[] = {&CaseSurface::tolerance, &CaseSurface::stiffness,
                                             &CaseSurface::traction, &CaseSurface::observation,
                                             &CaseSurface::slip};

/// Tolerance and errors as a vector, whose last entry may be missing.
template <typename Archive>
void accuracy_table(auto& accuracy, const Archive& archive) {
  std::vector<double> numbers;
  for (const auto number : kNumbers) numbers.push_back(accuracy.*number);
  if (accuracy.stability) numbers.push_back(*accuracy.stability);
  archive.list("/surface/accuracy", numbers, std::identity(),
               {"1",
                "tolerance; relative errors of H, L, U and V, slip without friction, stability "
                "limits"});
  if constexpr (Archive::kReads) {
    if (numbers.size() < std::size(kNumbers)) throw StorageError("/surface/accuracy ends early");
    for (std::size_t i = 0; i < std::size(kNumbers); ++i) accuracy.*kNumbers[i] = numbers[i];
    if (numbers.size() > std::size(kNumbers)) accuracy.stability = numbers.back();
  }
}

/// What cases said; nothing without.
template <typename Archive>
void cases_table(auto& accuracy, const Archive& archive) {
  std::vector<double> numbers;
  if (accuracy.chi_bar) {
    numbers = {static_cast<double>(accuracy.n_cases), *accuracy.chi_tolerance, *accuracy.chi_bar,
               *accuracy.largest_slip, static_cast<double>(*accuracy.flags_that_differ)};
  }
  archive.list(
      "/surface/cases", numbers, std::identity(),
      {"1", "cases, tolerance of χ̄, errors of χ̄ and of the largest slip, flags that differ"});
  if constexpr (Archive::kReads) {
    if (numbers.empty()) return;
    if (numbers.size() != 5) throw StorageError("/surface/cases ends early");
    accuracy.n_cases = static_cast<int>(numbers[0]);
    accuracy.chi_tolerance = numbers[1];
    accuracy.chi_bar = numbers[2];
    accuracy.largest_slip = numbers[3];
    accuracy.flags_that_differ = static_cast<int>(numbers[4]);
  }
}

/// All but the centre's operator and the matrices of H.
template <typename Archive>
void basis_tables(const FaultOperator& centre, auto& basis, auto& accuracy,
                  const Archive& archive) {
  auto n_nodes = static_cast<int>(basis.nodes.size()), k = static_cast<int>(basis.size());
  auto n_axes = n_nodes > 0 ? static_cast<int>(basis.nodes.front().size()) : 0;
  archive.values("/surface/fingerprint", cells(basis.fingerprint));
  archive.values("/surface/sizes", cells(n_nodes, n_axes, k, accuracy.n_checks),
                 {"", "nodes, axes, K, check points"});
  if (n_nodes < 1 || n_axes < 1 || k < 0) throw StorageError("the tables disagree: /surface/sizes");
  if constexpr (Archive::kReads) {
    length(basis.nodes) = n_nodes;
    for (auto& index : basis.nodes) length(index) = n_axes;
    accuracy.n_operators = n_nodes;
    accuracy.n_basis = basis.stiffness.count = k;
  }
  archive.rows("/surface/nodes", items_of(basis.nodes, std::identity()), std::identity(),
               {"", "multi-indices of the grid"});
  accuracy_table(accuracy, archive);
  cases_table(accuracy, archive);
  const Eigen::Index m = n_nodes - 1;
  archive.matrix("/surface/weights", basis.weights, k, m,
                 {"1", "K x nodes but the centre, column by column"});
  archive.matrix("/surface/traction", basis.traction, centre.loads.traction.size(), m,
                 {"Pa per unit of load", "differences of L to the centre, by columns"});
  archive.matrix("/surface/load", basis.per_load, centre.observed.per_load.size(), m,
                 {"m per unit of load", "of U, by columns"});
  archive.matrix("/surface/jump", basis.per_jump, centre.observed.per_jump.size(), m,
                 {"m per m", "of V, by columns"});
}

/// B, of which all but the sizes stays in the file.
template <typename Archive>
void block_tables(int n, auto& blocks, const Archive& archive) {
  archive.list("/surface/runs", blocks.begin, std::identity(),
               {"", "first of each run of jumps, and their number"});
  archive.list("/surface/ranks", blocks.ranks, std::identity(),
               {"", "columns of the two bases of each pair of runs"});
  if (!blocks.is_partition_of(n)) throw StorageError("the tables disagree: /surface/runs");
  archive.array("/surface/near", blocks.near, blocks.near_size(), 1,
                {"N/m", "of each run: B_1 to B_K, by columns"});
  archive.array("/surface/far", blocks.far, blocks.far_size(), 1,
                {"N/m", "of each pair of runs: U, V (1) and the cores of B_1 to B_K, by columns"});
}

template <typename Archive>
void surface_tables(auto& centre, auto& basis, auto& accuracy, const Archive& archive) {
  operator_tables(centre, archive);
  basis_tables(centre, basis, accuracy, archive);
  stiffness_table(centre, archive, "H at the centre");
  block_tables(centre.geometry.n_dofs, basis.stiffness, archive);
}

struct SurfaceContent {
  static constexpr SealedFormat kFormat{.name = "operator surface", .version = 4};
  static constexpr const char* kName = "surface";
  static const std::string& fingerprint_of(const StoredSurface& surface) {
    return surface.basis->fingerprint;
  }

  template <typename Archive>
  void operator()(const StoredSurface& surface, const Archive& archive) const {
    surface_tables(*surface.basis->centre, *surface.basis, surface.accuracy, archive);
  }
  void operator()(StoredSurface& surface, const TableReader& archive) const {
    const auto centre = std::make_shared<FaultOperator>();
    const auto basis = std::make_shared<OperatorBasis>();
    surface_tables(*centre, *basis, surface.accuracy, archive);
    basis->centre = centre;
    surface.basis = basis;
  }
};

}  // namespace

void write_surface(const StoredSurface& surface, const std::filesystem::path& folder) {
  create_folders(folder);
  write_tables<SurfaceContent>(cached_file(folder, surface.basis->fingerprint), surface);
}

std::optional<StoredSurface> read_surface_file(const std::filesystem::path& folder,
                                               const std::string& fingerprint,
                                               std::string* remark) {
  return read_tables<StoredSurface, SurfaceContent>(cached_file(folder, fingerprint), fingerprint,
                                                    remark);
}

}  // namespace faultsim
