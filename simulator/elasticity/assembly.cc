#include <algorithm>
#include <span>
#include <type_traits>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/elasticity/element.h"

namespace faultsim {
namespace {

/// The unknowns of each cell, sorted, without repetition.
struct CellUnknowns {
  std::vector<long> begin;
  std::vector<int> unknowns;
};

/// @param wanted  per cell; others have none.
CellUnknowns cell_unknowns(const Mesh& mesh, const DofMap& dofs, const std::vector<char>& wanted) {
  CellUnknowns result;
  result.begin.push_back(0);
  std::vector<int> list;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    list.clear();
    for (const int node : mesh.cells[cell]) {
      for (int c = 0; c < 3 && (wanted.empty() || wanted[cell]); ++c) {
        for (const DofMap::Term& term : dofs.terms(node, c)) list.push_back(term.unknown);
      }
    }
    std::ranges::sort(list);
    drop_repeated(list);
    result.unknowns.insert(result.unknowns.end(), list.begin(), list.end());
    result.begin.push_back(static_cast<long>(result.unknowns.size()));
  }
  return result;
}

/// Cells of each unknown, ascending.
CellUnknowns transposed(const CellUnknowns& cells, int n_unknowns) {
  CellUnknowns result;
  result.begin.assign(static_cast<std::size_t>(n_unknowns) + 1, 0);
  for (int unknown : cells.unknowns) ++result.begin[static_cast<std::size_t>(unknown) + 1];
  for (std::size_t i = 1; i < result.begin.size(); ++i) result.begin[i] += result.begin[i - 1];
  result.unknowns.resize(cells.unknowns.size());
  std::vector<long> next(result.begin.begin(), result.begin.end() - 1);
  for (std::size_t cell = 0; cell + 1 < cells.begin.size(); ++cell) {
    for (long k = cells.begin[cell]; k < cells.begin[cell + 1]; ++k) {
      long& at = next[cells.unknowns[k]];
      result.unknowns[at++] = static_cast<int>(cell);
    }
  }
  return result;
}

/// The lower triangle's pattern with zero values.
SparseMatrix make_pattern(const CellUnknowns& cells, int n_unknowns, bool may_lack_cells) {
  const CellUnknowns cells_of = transposed(cells, n_unknowns);
  std::vector<int> seen_by(static_cast<std::size_t>(n_unknowns), -1);
  std::vector<int> rows;
  const auto rows_of = [&](int column) {
    rows.clear();
    const std::size_t j = static_cast<std::size_t>(column);
    for (long c = cells_of.begin[j]; c < cells_of.begin[j + 1]; ++c) {
      const std::size_t cell = static_cast<std::size_t>(cells_of.unknowns[c]);
      for (long k = cells.begin[cell]; k < cells.begin[cell + 1]; ++k) {
        const int row = cells.unknowns[k];
        if (row < column || seen_by[row] == column) continue;
        seen_by[row] = column;
        rows.push_back(row);
      }
    }
    std::ranges::sort(rows);
  };
  SparseMatrix k(n_unknowns, n_unknowns);
  long n_entries = 0;
  for (int column = 0; column < n_unknowns; ++column) {
    rows_of(column);
    n_entries += static_cast<long>(rows.size());
  }
  k.resizeNonZeros(n_entries);
  std::ranges::fill(seen_by, -1);
  k.outerIndexPtr()[0] = 0;
  for (int column = 0; column < n_unknowns; ++column) {
    rows_of(column);
    FAULTSIM_DEMAND(rows.empty() ? may_lack_cells : rows.front() == column, "unknown ", column,
                    " has no cell");
    long at = k.outerIndexPtr()[column];
    for (int row : rows) k.innerIndexPtr()[at++] = row;
    k.outerIndexPtr()[column + 1] = at;
  }
  std::fill(k.valuePtr(), k.valuePtr() + n_entries, 0.0);
  return k;
}

/// Adds Tᵀ K_e T for one cell. `local` (by unknown: place in the cell's list) and `matrix` are
/// workspace.
template <int Nodes>
void add_cell(std::span<const int> nodes, const CellMatrix<Nodes>& k_e, double scale,
              const DofMap& dofs, const int* unknowns, int n, std::vector<int>& local,
              Eigen::MatrixXd& matrix, SparseMatrix& k) {
  for (int i = 0; i < n; ++i) local[unknowns[i]] = i;
  matrix.setZero(n, n);
  for (int q = 0; q < 3 * Nodes; ++q) {
    for (const DofMap::Term& b : dofs.terms(nodes[q / 3], q % 3)) {
      const int column = local[b.unknown];
      for (int p = 0; p < 3 * Nodes; ++p) {
        for (const DofMap::Term& a : dofs.terms(nodes[p / 3], p % 3)) {
          matrix(local[a.unknown], column) += a.coefficient * b.coefficient * k_e(p, q);
        }
      }
    }
  }
  for (int j = 0; j < n; ++j) {
    const long first = k.outerIndexPtr()[unknowns[j]], last = k.outerIndexPtr()[unknowns[j] + 1];
    const long* at = k.innerIndexPtr() + first;
    const long* end = k.innerIndexPtr() + last;
    for (int i = j; i < n; ++i) {
      at = std::lower_bound(at, end, static_cast<long>(unknowns[i]));
      k.valuePtr()[at - k.innerIndexPtr()] += scale * matrix(i, j);
    }
  }
}

}  // namespace

SparseMatrix assemble_stiffness(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                                const DofMap& dofs, bool mean_dilatation,
                                const std::vector<char>& wanted) {
  const CellUnknowns cells = cell_unknowns(mesh, dofs, wanted);
  SparseMatrix k = make_pattern(cells, dofs.n_unknowns(), !wanted.empty());
  const double scale = mesh.plane_strain ? 1 / mesh.thickness : 1;
  std::vector<int> local(static_cast<std::size_t>(dofs.n_unknowns()));
  Eigen::MatrixXd matrix;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto& material = materials.at(mesh.material[cell]);
    const int n = static_cast<int>(cells.begin[cell + 1] - cells.begin[cell]);
    if (n == 0) continue;
    with_element(mesh, static_cast<int>(cell), [&](const auto& element) {
      constexpr int kNodes = std::remove_cvref_t<decltype(element)>::kNodes;
      add_cell<kNodes>(mesh.cells[cell], element_stiffness(element, material, mean_dilatation),
                       scale, dofs, cells.unknowns.data() + cells.begin[cell], n, local, matrix, k);
    });
  }
  return k;
}

}  // namespace faultsim
