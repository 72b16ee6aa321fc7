#include "simulator/coupled/engine_matrix.h"

#include <_hypre_parcsr_mv.h>

#include <algorithm>

#include "simulator/common/errors.h"
#include "simulator/coupled/hypre_objects.h"

namespace faultsim {

struct EngineMatrix::Work {
  Work(const RowRanges& ranges, const Ranks& ranks) : x(ranges, ranks), y(ranges, ranks) {}
  HypreVector x, y;
};

EngineMatrix::EngineMatrix(const SparseMatrix& rows, const RowRanges& ranges, const Ranks& ranks,
                           const SparseMatrix& room)
    : matrix_(std::make_shared<HypreMatrix>(rows, ranges, ranks, room)),
      work_(std::make_unique<Work>(ranges, ranks)) {}

EngineMatrix::~EngineMatrix() = default;

const Ranks& EngineMatrix::ranks() const { return matrix_->ranks(); }
const RowRanges& EngineMatrix::ranges() const { return matrix_->ranges(); }
int EngineMatrix::n_own() const { return matrix_->n_own(); }

Eigen::VectorXd EngineMatrix::times(const Eigen::VectorXd& x) {
  work_->x.values() = x;
  hypre_ParCSRMatrixMatvec(1, matrix_->get(), work_->x.get(), 0, work_->y.get());
  check_hypre("multiplying");
  Eigen::VectorXd y = work_->y.values();
  if (added_) y -= *added_ * x;
  return y;
}

Eigen::VectorXd EngineMatrix::diagonal() const {
  Eigen::VectorXd diagonal(n_own());
  for (int i = 0; i < n_own(); ++i) diagonal[i] = entry(i, i);
  return diagonal;
}

double EngineMatrix::entry(int row, int column) const {
  const double* const at = matrix_->entry(row, column);
  if (at == nullptr) return 0;
  if (!added_) return *at;
  const long* const rows = added_->innerIndexPtr();
  const long *const begin = rows + added_->outerIndexPtr()[column],
                    *const end = rows + added_->outerIndexPtr()[column + 1],
                    *const found = std::lower_bound(begin, end, static_cast<long>(row));
  return found != end && *found == row ? before_[found - rows] : *at;
}

/// visit(entry of the matrix, what is added there, K's value).
template <typename Visit>
void EngineMatrix::for_each_added(const Visit& visit) {
  if (!added_) return;
  Eigen::Index k = 0;
  for (int column = 0; column < static_cast<int>(added_->cols()); ++column) {
    for (SparseMatrix::InnerIterator it(*added_, column); it; ++it) {
      double* const at = matrix_->entry(static_cast<int>(it.row()), column);
      FAULTSIM_DEMAND(at != nullptr, "no place for row ", it.row(), ", column ", column);
      visit(*at, it.value(), before_[k++]);
    }
  }
}

std::shared_ptr<HypreMatrix> EngineMatrix::with(const std::shared_ptr<const SparseMatrix>& added) {
  if (added == added_) return matrix_;
  for_each_added([](double& entry, double, double before) { entry = before; });
  added_ = added;
  before_.resize(added ? added->nonZeros() : 0);
  for_each_added([](double& entry, double value, double& before) {
    before = entry;
    entry += value;
  });
  return matrix_;
}

}  // namespace faultsim
