#include "simulator/cache/surface_file.h"

#include <algorithm>
#include <utility>

#include "simulator/cache/operator_tables.h"
#include "simulator/cache/sealed_file.h"
#include "simulator/cache/table_archive.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

constexpr SealedFormat kSurfaceFile{.name = "operator surface", .version = 2};
constexpr const char* kStiffness = "/surface/stiffness";

/// All but the centre's operator and the directions of H.
struct SurfaceTables {
  std::vector<std::string> fingerprint;
  std::vector<int> sizes;  ///< nodes, axes, K, check points.
  std::vector<int> nodes;  ///< row by row.
  std::vector<double> accuracy, weights, diagonal, traction, per_load, per_jump;
};

template <typename Tables, typename Archive>
void for_each_surface_table(Tables& t, Archive&& archive) {
  archive("/surface/fingerprint", t.fingerprint, 1, "", "");
  archive("/surface/sizes", t.sizes, 1, "", "nodes, axes, K, check points");
  archive("/surface/nodes", t.nodes, 1, "", "multi-indices of the grid");
  archive("/surface/accuracy", t.accuracy, 1, "1",
          "tolerance; relative errors of H, L, U and V, slip without friction, stability limits");
  archive("/surface/weights", t.weights, 1, "1", "K x nodes but the centre, column by column");
  archive("/surface/diagonal", t.diagonal, 1, "N/m", "of B, n x K, column by column");
  archive("/surface/traction", t.traction, 1, "Pa per unit of load",
          "differences of L to the centre, by columns");
  archive("/surface/load", t.per_load, 1, "m per unit of load", "of U, by columns");
  archive("/surface/jump", t.per_jump, 1, "m per m", "of V, by columns");
}

std::vector<double> values_of(const Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

SurfaceTables to_surface_tables(const StoredSurface& surface) {
  const OperatorBasis& basis = *surface.basis;
  const CaseSurface& a = surface.accuracy;
  SurfaceTables t;
  t.fingerprint = {basis.fingerprint};
  t.sizes = {static_cast<int>(basis.nodes.size()), static_cast<int>(basis.nodes.front().size()),
             static_cast<int>(basis.size()), a.n_checks};
  for (const auto& index : basis.nodes) t.nodes.insert(t.nodes.end(), index.begin(), index.end());
  t.accuracy = {a.tolerance, a.stiffness, a.traction, a.observation, a.slip};
  if (a.stability) t.accuracy.push_back(*a.stability);
  t.weights = values_of(basis.weights);
  t.diagonal = values_of(basis.diagonal);
  t.traction = values_of(basis.traction);
  t.per_load = values_of(basis.per_load);
  t.per_jump = values_of(basis.per_jump);
  return t;
}

Eigen::MatrixXd matrix_of(const std::vector<double>& values, Eigen::Index rows, Eigen::Index k) {
  if (static_cast<Eigen::Index>(values.size()) != rows * k)
    throw StorageError("a table of the surface has the wrong size");
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, k);
}

void take_tables(const SurfaceTables& t, StoredSurface& surface, OperatorBasis& basis) {
  const FaultOperator& centre = *basis.centre;
  if (t.fingerprint.size() != 1 || t.sizes.size() != 4 || t.accuracy.size() < 5 || t.sizes[0] < 1 ||
      t.sizes[1] < 1 || t.sizes[2] < 0 ||
      t.nodes.size() != static_cast<std::size_t>(t.sizes[0]) * static_cast<std::size_t>(t.sizes[1]))
    throw StorageError("the tables of the surface do not fit together");
  const Eigen::Index m = t.sizes[0] - 1, k = t.sizes[2];
  basis.fingerprint = t.fingerprint.front();
  for (auto one = t.nodes.begin(); one != t.nodes.end(); one += t.sizes[1])
    basis.nodes.emplace_back(one, one + t.sizes[1]);
  basis.weights = matrix_of(t.weights, k, m);
  basis.diagonal = matrix_of(t.diagonal, centre.geometry.n_dofs, k);
  basis.traction = matrix_of(t.traction, centre.loads.traction.size(), m);
  basis.per_load = matrix_of(t.per_load, centre.observed.per_load.size(), m);
  basis.per_jump = matrix_of(t.per_jump, centre.observed.per_jump.size(), m);
  surface.accuracy = {.n_operators = t.sizes[0],
                      .n_basis = t.sizes[2],
                      .n_checks = t.sizes[3],
                      .tolerance = t.accuracy[0],
                      .stiffness = t.accuracy[1],
                      .traction = t.accuracy[2],
                      .observation = t.accuracy[3],
                      .slip = t.accuracy[4]};
  if (t.accuracy.size() > 5) surface.accuracy.stability = t.accuracy[5];
}

StoredSurface decode_surface(const SealedContent& content) {
  OperatorTables tables;
  for_each_table(tables, ReadTables{content.file()});
  auto centre = std::make_shared<FaultOperator>(from_tables(tables));
  const int n = centre->geometry.n_dofs;
  const auto size = static_cast<hsize_t>(n);
  centre->compliance = std::make_shared<DenseCompliance>(
      StoredMatrix(content.mapped(kStiffnessTable, size, size), n, n, content.mapping()));
  SurfaceTables own;
  for_each_surface_table(own, ReadTables{content.file()});
  const auto basis = std::make_shared<OperatorBasis>();
  basis->centre = std::move(centre);
  StoredSurface surface;
  take_tables(own, surface, *basis);
  const Eigen::Index columns = n * basis->size();
  basis->stiffness =
      StoredFloats(content.mapped_floats(kStiffness, static_cast<hsize_t>(columns), size), n,
                   columns, content.mapping());
  surface.basis = basis;
  return surface;
}

/// Bit patterns of all that is in the file.
std::vector<std::string> digests_of(const StoredSurface& surface) {
  std::vector<std::string> result;
  const OperatorTables centre = to_tables(*surface.basis->centre);
  for_each_table(centre, DigestTables{result});
  const SurfaceTables own = to_surface_tables(surface);
  for_each_surface_table(own, DigestTables{result});
  const auto h = surface.basis->centre->h();
  result.push_back(fingerprint(h.data(), static_cast<std::size_t>(h.size()) * sizeof(double)));
  const auto b = surface.basis->stiffness.view();
  result.push_back(fingerprint(b.data(), static_cast<std::size_t>(b.size()) * sizeof(float)));
  return result;
}

}  // namespace

void write_surface(const StoredSurface& surface, const std::filesystem::path& folder) {
  const OperatorBasis& basis = *surface.basis;
  create_folders(folder);
  write_sealed(
      cached_file(folder, basis.fingerprint), kSurfaceFile,
      [&](hid_t file) {
        const OperatorTables centre = to_tables(*basis.centre);
        for_each_table(centre, WriteTables{file});
        const SurfaceTables own = to_surface_tables(surface);
        for_each_surface_table(own, WriteTables{file});
        const auto h = basis.centre->h();
        const auto n = static_cast<hsize_t>(h.rows());
        hdf5::write_array(file, kStiffnessTable, {n, n}, h.data(), {"N/m", "H at the centre"});
        const auto b = basis.stiffness.view();
        hdf5::write_array(file, kStiffness, {static_cast<hsize_t>(b.cols()), n}, b.data(),
                          {"N/m", "B of H: K vectors for each column of H"});
      },
      [&](const SealedContent& content) {
        if (digests_of(decode_surface(content)) != digests_of(surface))
          throw StorageError("what was read is not what was written");
      });
}

std::optional<StoredSurface> read_surface_file(const std::filesystem::path& folder,
                                               const std::string& fingerprint,
                                               std::string* remark) {
  std::optional<StoredSurface> surface;
  const auto decode = [&](const SealedContent& content) {
    StoredSurface found = decode_surface(content);
    if (found.basis->fingerprint != fingerprint)
      throw StorageError("it holds the surface " + found.basis->fingerprint);
    surface = std::move(found);
  };
  read_sealed(cached_file(folder, fingerprint), kSurfaceFile, decode, remark);
  return surface;
}

}  // namespace faultsim
