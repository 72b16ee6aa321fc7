#include <dmumps_c.h>
#include <metis.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/peers/study_system.h"

namespace faultsim {
namespace {

/// The lower triangle of J, one-based.
struct LowerTriangle {
  int n = 0;
  std::vector<MUMPS_INT> row, column;
  std::vector<double> value;

  void add(PetscInt i, PetscInt j, double entry) {
    row.push_back(i + 1);
    column.push_back(j + 1);
    value.push_back(entry);
  }
};

/// Visits the entries of a matrix of PETSc's and destroys it.
template <typename Visit>
PetscInt take(Mat& matrix, const Visit& visit) {
  PetscInt n = 0, n_restored = 0;
  const PetscInt *begin = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  const PetscScalar* values = nullptr;
  MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &n, &begin, &columns, &done);
  MatSeqAIJGetArrayRead(matrix, &values);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = begin[i]; k < begin[i + 1]; ++k) visit(i, columns[k], values[k]);
  MatSeqAIJRestoreArrayRead(matrix, &values);
  MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &n_restored, &begin, &columns, &done);
  MatDestroy(&matrix);
  return n;
}

/// Unknowns that are ordered as one: the three of a node, and with a multiplier all nodes of its
/// row, so that it is eliminated after what gives it a pivot.
struct Groups {
  explicit Groups(int n_displacements) : parent((n_displacements + 2) / 3) {
    std::iota(parent.begin(), parent.end(), 0);
  }
  int root(int group) {
    while (parent[group] != group) group = parent[group] = parent[parent[group]];
    return group;
  }
  std::vector<int> parent;
};

/// Per unknown its group, 0 … n_groups − 1.
std::vector<int> groups_of(const LowerTriangle& lower, int n_u, int& n_groups) {
  Groups groups(n_u);
  std::vector<int> of(lower.n, -1);
  for (int i = 0; i < n_u; ++i) of[i] = i / 3;
  for (std::size_t k = 0; k < lower.row.size(); ++k) {
    const int i = lower.row[k] - 1, j = lower.column[k] - 1;
    if (i < n_u) continue;
    if (of[i] < 0) of[i] = of[j];
    groups.parent[groups.root(of[j])] = groups.root(of[i]);
  }
  std::vector<int> number(groups.parent.size(), -1);
  n_groups = 0;
  for (int& group : of) {
    int& named = number[groups.root(group)];
    if (named < 0) named = n_groups++;
    group = named;
  }
  return of;
}

/// Place of each unknown in METIS' nested dissection of the groups, one-based.
std::vector<MUMPS_INT> metis_places(const LowerTriangle& lower, int n_u) {
  int n_groups = 0;
  const std::vector<int> group = groups_of(lower, n_u, n_groups);
  std::vector<std::pair<int, int>> edges;
  for (std::size_t k = 0; k < lower.row.size(); ++k) {
    const int a = group[lower.row[k] - 1], b = group[lower.column[k] - 1];
    if (a == b) continue;
    edges.emplace_back(a, b);
    edges.emplace_back(b, a);
    if (edges.size() > 64'000'000) {  // entries of a block of nine make one edge
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<idx_t> begin(n_groups + 1, 0), neighbours, weight(n_groups, 0);
  for (const auto& [a, b] : edges) {
    ++begin[a + 1];
    neighbours.push_back(b);
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (const int g : group) ++weight[g];
  std::vector<idx_t> order(n_groups), place(n_groups);
  idx_t n = n_groups;
  METIS_NodeND(&n, begin.data(), neighbours.data(), weight.data(), nullptr, order.data(),
               place.data());
  std::vector<MUMPS_INT> by_place(lower.n), places(lower.n);
  std::iota(by_place.begin(), by_place.end(), 0);
  std::stable_sort(by_place.begin(), by_place.end(),
                   [&](int a, int b) { return place[group[a]] < place[group[b]]; });
  for (int k = 0; k < lower.n; ++k) places[by_place[k]] = k + 1;
  return places;
}

LowerTriangle take_lower(StudySystem& system, int& n_u) {
  LowerTriangle lower;
  n_u = take(system.leading, [&](PetscInt i, PetscInt j, double entry) {
    if (j <= i) lower.add(i, j, entry);
  });
  MatDestroy(&system.coupling);
  for (Vec& motion : system.near_null) VecDestroy(&motion);
  const int first = n_u;
  lower.n = n_u + take(system.constraint, [&](PetscInt i, PetscInt j, double entry) {
              lower.add(first + i, j, entry);
            });
  return lower;
}

void call(DMUMPS_STRUC_C& mumps, int job, PeerRow& row) {
  if (!row.failure.empty()) return;
  mumps.job = job;
  dmumps_c(&mumps);
  if (mumps.infog[0] < 0) row.failure = "MUMPS' error " + std::to_string(mumps.infog[0]);
}

double relative_residual(const LowerTriangle& lower, const std::vector<double>& b,
                         const std::vector<double>& x) {
  std::vector<double> r = b;
  for (std::size_t k = 0; k < lower.row.size(); ++k) {
    const int i = lower.row[k] - 1, j = lower.column[k] - 1;
    r[i] -= lower.value[k] * x[j];
    if (i != j) r[j] -= lower.value[k] * x[i];
  }
  const double zero = 0;
  return std::sqrt(std::inner_product(r.begin(), r.end(), r.begin(), zero) /
                   std::inner_product(b.begin(), b.end(), b.begin(), zero));
}

std::vector<double> values_of(Vec vector) {
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  VecGetLocalSize(vector, &n);
  VecGetArrayRead(vector, &values);
  std::vector<double> copy(values, values + n);
  VecRestoreArrayRead(vector, &values);
  return copy;
}

/// Control parameters by the numbers of MUMPS' manual.
int& icntl(DMUMPS_STRUC_C& mumps, int number) { return mumps.icntl[number - 1]; }

}  // namespace

PeerRow mumps_row(StudySystem& system, double memory_limit) {
  int n_u = 0;
  LowerTriangle lower = take_lower(system, n_u);
  PeerRow row;
  DMUMPS_STRUC_C mumps{};
  mumps.sym = 2;  // symmetric, not definite
  mumps.par = 1;
  mumps.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(MPI_COMM_SELF));
  call(mumps, -1, row);
  for (const int stream : {1, 2, 3, 4}) icntl(mumps, stream) = stream < 4 ? -1 : 0;  // silent
  double start = processor_seconds();
  std::vector<MUMPS_INT> places = metis_places(lower, n_u);
  icntl(mumps, 7) = 1;    // an ordering that is given: Debian builds MUMPS without METIS
  icntl(mumps, 12) = 1;   // and nothing beside it
  icntl(mumps, 14) = 50;  // per cent more space than foreseen, for pivots that are put off
  mumps.perm_in = places.data();
  mumps.n = lower.n;
  mumps.nnz = static_cast<MUMPS_INT8>(lower.row.size());
  mumps.irn = lower.row.data();
  mumps.jcn = lower.column.data();
  mumps.a = lower.value.data();
  call(mumps, 1, row);
  if (row.failure.empty() && mumps.infog[15] > memory_limit)
    row.failure = "wants " + std::to_string(mumps.infog[15]) + " MB";
  call(mumps, 2, row);
  row.setup_seconds = processor_seconds() - start;
  for (const Vec b : {system.random, system.physical}) {
    const std::vector<double> right = values_of(b);
    std::vector<double> x = right;
    mumps.rhs = x.data();
    start = processor_seconds();
    call(mumps, 3, row);
    if (b == system.random) row.solve_seconds = processor_seconds() - start;
    if (row.failure.empty())
      row.true_residual = std::max(row.true_residual, relative_residual(lower, right, x));
  }
  if (row.failure.empty()) row.random = row.physical = {1, 1};
  mumps.job = -2;
  dmumps_c(&mumps);
  return row;
}

}  // namespace faultsim
