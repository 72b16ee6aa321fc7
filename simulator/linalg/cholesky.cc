#include "simulator/linalg/cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <string>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/large_pages.h"
#include "simulator/common/stopwatch.h"
#include "simulator/linalg/ordering.h"
#include "simulator/linalg/supernodal_factor.h"

namespace faultsim {
namespace {

using Index = SuiteSparse_long;
static_assert(sizeof(Index) == sizeof(long), "Eigen's and CHOLMOD's indices must agree");

// A pivot this small against the diagonal it came from is taken for rounding: the matrix is
// singular (a regular one needs a condition number of 1e12 to get here).
constexpr double kSingularPivot = 1e-12;

/// A view of an Eigen matrix as CHOLMOD sees it (lower triangle).
cholmod_sparse view_of(const TrailingCholesky::SparseMatrix& k) {
  // CHOLMOD's structure has no const, but none of the functions used here writes to its input.
  cholmod_sparse a{};
  a.nrow = static_cast<std::size_t>(k.rows());
  a.ncol = static_cast<std::size_t>(k.cols());
  a.nzmax = static_cast<std::size_t>(k.nonZeros());
  a.p = const_cast<long*>(k.outerIndexPtr());
  a.i = const_cast<long*>(k.innerIndexPtr());
  a.x = const_cast<double*>(k.valuePtr());
  a.stype = -1;
  a.itype = CHOLMOD_LONG;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = 1;
  a.packed = 1;
  return a;
}

/// Of all that order and structure depend on.
std::string pattern_text(const cholmod_sparse& a, const UnknownGroups& groups, Index n_bulk) {
  const auto* begin = static_cast<const Index*>(a.p);
  const auto n_entries = static_cast<std::size_t>(begin[a.ncol]);
  return concat(a.ncol, ' ', n_bulk, ' ', fingerprint(begin, (a.ncol + 1) * sizeof(Index)),
                fingerprint(a.i, n_entries * sizeof(Index)),
                fingerprint(groups.of.data(), groups.of.size() * sizeof(int)),
                fingerprint(groups.ends.data(), groups.ends.size() * sizeof(groups.ends[0])));
}

struct FreeSparse {
  cholmod_common* common;
  void operator()(cholmod_sparse* a) const { cholmod_l_free_sparse(&a, common); }
};
/// A matrix that CHOLMOD made.
using SparseHandle = std::unique_ptr<cholmod_sparse, FreeSparse>;

}  // namespace

struct FactorAnalysis::Impl {
  CholmodCommon common;
  std::string pattern;       ///< fingerprint of the matrix it is of; "" = none yet.
  std::vector<Index> order;  ///< order[i] = unknown at place i of the factor.
  cholmod_factor* structure = nullptr;
  int n_made = 0;

  ~Impl() { clear(); }
  void clear() {
    if (structure != nullptr) cholmod_l_free_factor(&structure, common.get());
  }
};

FactorAnalysis::FactorAnalysis() : impl_(std::make_unique<Impl>()) {}
FactorAnalysis::~FactorAnalysis() = default;
int FactorAnalysis::n_made() const { return impl_->n_made; }

struct TrailingCholesky::Impl {
  CholmodCommon common;
  cholmod_factor* factor = nullptr;
  cholmod_dense* workspace = nullptr;
  Index n = 0;
  Index n_bulk = 0;
  std::vector<Index> order;  // order[i] = unknown at place i of the factor
  int failed = -1;
  FactorStatistics statistics;

  ~Impl() {
    if (workspace != nullptr) cholmod_l_free_dense(&workspace, common.get());
    if (factor != nullptr) cholmod_l_free_factor(&factor, common.get());
  }

  void check(const char* doing) {
    const int status = common.get()->status;
    if (status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE) {
      throw ResourceError(concat("not enough memory for ", doing, " of ", n, " unknowns (",
                                 common.get()->lnz * sizeof(double) / 1e9,
                                 " GB for the factor alone)"));
    }
    FAULTSIM_DEMAND(status >= CHOLMOD_OK, "CHOLMOD status ", status, " in ", doing);
  }

  /// Takes what is known of the pattern, or learns it.
  void analyse(cholmod_sparse* a, const UnknownGroups& groups, const FactorRun& run) {
    if (run.analysis == nullptr) return analyse_anew(a, groups, run);
    FactorAnalysis::Impl& known = *run.analysis->impl_;
    const std::string pattern = pattern_text(*a, groups, n_bulk);
    if (known.pattern == pattern) {
      order = known.order;
      factor = cholmod_l_copy_factor(known.structure, common.get());
      return check("the analysis");
    }
    analyse_anew(a, groups, run);
    known.clear();
    known.structure = cholmod_l_copy_factor(factor, known.common.get());
    known.pattern = known.structure == nullptr ? "" : pattern;
    known.order = order;
    ++known.n_made;
  }

  void analyse_anew(cholmod_sparse* a, const UnknownGroups& groups, const FactorRun& run) {
    order = trailing_order(*a, n_bulk, groups, common, run.stop);
    check("the ordering");
    cholmod_common* c = common.get();
    c->nmethods = 1;
    c->method[0].ordering = CHOLMOD_GIVEN;
    c->postorder = 0;  // `order` is postordered already, with the trailing unknowns left in place
    c->supernodal = CHOLMOD_SUPERNODAL;
    factor = cholmod_l_analyze_p(a, order.data(), nullptr, 0, c);
    check("the analysis");
    const Index* used = static_cast<const Index*>(factor->Perm);
    FAULTSIM_DEMAND(std::equal(order.begin(), order.end(), used), "CHOLMOD changed the order");
  }

  void factorise(cholmod_sparse* a, const FactorRun& run) {
    cholmod_common* c = common.get();
    const SparseHandle lower = in_order_of_factor(a);
    const FactorOutcome outcome = factorise_supernodes(*lower.get(), factor, c, run);
    check("the factorisation");
    if (outcome.end == FactorEnd::stopped) {
      throw Interrupted("stopped while condensing the bulk");
    }
    statistics.bytes = static_cast<double>(factor->xsize) * sizeof(double) +
                       static_cast<double>(factor->ssize) * sizeof(Index);
    if (outcome.end == FactorEnd::not_positive_definite) {
      failed = static_cast<int>(order[outcome.column]);
      return;
    }
    FAULTSIM_DEMAND(factor->is_super && factor->is_ll, "not a supernodal LLᵀ factor");
    workspace = cholmod_l_allocate_dense(1, factor->maxesize, 1, CHOLMOD_REAL, c);
    check("the workspace");
  }

  /// The lower triangle of P A Pᵀ, sorted: the transpose of a symmetric lower one is upper.
  SparseHandle in_order_of_factor(cholmod_sparse* a) {
    cholmod_common* c = common.get();
    const SparseHandle upper(cholmod_l_ptranspose(a, 1, order.data(), nullptr, 0, c), {c});
    check("the permutation");
    SparseHandle lower(cholmod_l_ptranspose(upper.get(), 1, nullptr, nullptr, 0, c), {c});
    check("the permutation");
    return lower;
  }

  /// Calls visit(column, rows, values, count) for each column of L in [from, n) : its rows from the
  /// diagonal down.
  template <typename Visit>
  void for_each_column(Index from, const Visit& visit) const {
    const Supernodes l = supernodes_of(*factor);
    for (Index s = 0; s < l.count; ++s) {
      const Index height = l.height(s);
      for (Index column = std::max(l.begin[s], from); column < l.begin[s + 1]; ++column) {
        const Index skip = column - l.begin[s];
        visit(column, l.rows_of(s) + skip, l.values + l.value_begin[s] + skip * (height + 1),
              height - skip);
      }
    }
  }

  void find_singular_pivot(const SparseMatrix& k) {
    for_each_column(0, [&](Index column, const Index*, const double* values, Index) {
      const Index unknown = order[column];
      const double diagonal = k.valuePtr()[k.outerIndexPtr()[unknown]];
      if (failed < 0 && !(values[0] * values[0] > kSingularPivot * diagonal)) {
        failed = static_cast<int>(unknown);
      }
    });
  }

  /// x ← L⁻¹ x or L⁻ᵀ x, in the order of the factor.
  void substitute(Eigen::VectorXd& x, bool transposed) {
    cholmod_dense dense{};
    dense.nrow = dense.d = dense.nzmax = static_cast<std::size_t>(n);
    dense.ncol = 1;
    dense.x = x.data();
    dense.xtype = CHOLMOD_REAL;
    dense.dtype = CHOLMOD_DOUBLE;
    const int done = transposed ? cholmod_l_super_ltsolve(factor, &dense, workspace, common.get())
                                : cholmod_l_super_lsolve(factor, &dense, workspace, common.get());
    FAULTSIM_DEMAND(done == 1 && failed < 0, "substitution failed");
  }

  Eigen::VectorXd unpermuted(const Eigen::VectorXd& x) const {
    Eigen::VectorXd result(n);
    for (Index i = 0; i < n; ++i) result[order[i]] = x[i];
    return result;
  }
};

TrailingCholesky::TrailingCholesky(const SparseMatrix& k, int n_last, const UnknownGroups& groups,
                                   const FactorRun& run)
    : impl_(std::make_unique<Impl>()) {
  FAULTSIM_DEMAND(k.rows() == k.cols() && k.rows() >= 1 && k.isCompressed(), k.rows(), k.cols());
  FAULTSIM_DEMAND(std::ssize(groups.of) + n_last == k.rows(), groups.of.size(), n_last);
  Impl& self = *impl_;
  self.n = k.rows();
  self.n_bulk = self.n - n_last;
  for (Index j = 0; j < self.n; ++j) {
    const long first = k.outerIndexPtr()[j];
    FAULTSIM_DEMAND(first < k.outerIndexPtr()[j + 1] && k.innerIndexPtr()[first] == j,
                    "no diagonal in column ", j);
  }
  cholmod_sparse a = view_of(k);
  self.analyse(&a, groups, run);
  Stopwatch factorisation;
  self.factorise(&a, run);
  self.statistics.factor_seconds = factorisation.seconds();
  if (self.failed < 0) self.find_singular_pivot(k);
}

TrailingCholesky::~TrailingCholesky() = default;

int TrailingCholesky::failed_column() const { return impl_->failed; }

const FactorStatistics& TrailingCholesky::statistics() const { return impl_->statistics; }

Eigen::MatrixXd TrailingCholesky::trailing_factor() const {
  FAULTSIM_DEMAND(impl_->failed < 0, "no factor");
  const Index n_bulk = impl_->n_bulk;
  Eigen::MatrixXd l(impl_->n - n_bulk, impl_->n - n_bulk);
  ask_for_large_pages(l.data(), l.size() * sizeof(double));
  l.setZero();
  impl_->for_each_column(n_bulk,
                         [&](Index column, const Index* rows, const double* values, Index count) {
                           for (Index i = 0; i < count; ++i)
                             l(rows[i] - n_bulk, column - n_bulk) = values[i];
                         });
  return l;
}

Eigen::VectorXd TrailingCholesky::forward(const Eigen::VectorXd& f) {
  FAULTSIM_DEMAND(f.size() == impl_->n && impl_->failed < 0, f.size(), " of ", impl_->n);
  Eigen::VectorXd y(impl_->n);
  for (Index i = 0; i < impl_->n; ++i) y[i] = f[impl_->order[i]];
  impl_->substitute(y, false);
  return y;
}

Eigen::VectorXd TrailingCholesky::condensed(const Eigen::VectorXd& y) const {
  FAULTSIM_DEMAND(y.size() == impl_->n && impl_->failed < 0, y.size(), " of ", impl_->n);
  const Index n_bulk = impl_->n_bulk;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(impl_->n - n_bulk);
  impl_->for_each_column(n_bulk,
                         [&](Index column, const Index* rows, const double* values, Index count) {
                           for (Index i = 0; i < count; ++i)
                             result[rows[i] - n_bulk] += values[i] * y[column];
                         });
  return result;
}

Eigen::MatrixXd TrailingCholesky::condense(const std::vector<SparseLoad>& loads,
                                           const std::function<void(double)>& progress) const {
  const Impl& self = *impl_;
  FAULTSIM_DEMAND(self.failed < 0, "no factor");
  std::vector<long> place(self.n);
  for (Index i = 0; i < self.n; ++i) place[self.order[i]] = i;
  return condense_sparse(supernodes_of(*self.factor), place, self.n_bulk, loads, progress);
}

Eigen::VectorXd TrailingCholesky::expand(const Eigen::VectorXd& f, const Eigen::VectorXd& g) {
  return expand_forward(forward(f), g);
}

Eigen::VectorXd TrailingCholesky::expand_forward(Eigen::VectorXd y, const Eigen::VectorXd& g) {
  const Index n_bulk = impl_->n_bulk;
  FAULTSIM_DEMAND(g.size() == impl_->n - n_bulk && y.size() == impl_->n, g.size(), " of ",
                  impl_->n - n_bulk);
  // The backward substitution yields g in the tail when it starts from L_ggᵀ g there.
  impl_->for_each_column(n_bulk,
                         [&](Index column, const Index* rows, const double* values, Index count) {
                           double sum = 0;
                           for (Index i = 0; i < count; ++i) sum += values[i] * g[rows[i] - n_bulk];
                           y[column] = sum;
                         });
  impl_->substitute(y, true);
  Eigen::VectorXd x = impl_->unpermuted(y);
  x.tail(g.size()) = g;  // the same up to rounding; now the same
  return x;
}

Eigen::VectorXd TrailingCholesky::solve(const Eigen::VectorXd& f) {
  Eigen::VectorXd y = forward(f);
  impl_->substitute(y, true);
  return impl_->unpermuted(y);
}

std::string cholmod_version_text() {
  int version[3] = {};
  cholmod_version(version);
  return concat(version[0], ".", version[1], ".", version[2]);
}

}  // namespace faultsim
