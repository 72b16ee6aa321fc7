#pragma once

#include <Eigen/Core>
#include <memory>

#include "simulator/coupled/ranks.h"
#include "simulator/elasticity/elasticity.h"

namespace faultsim {

class HypreMatrix;

/// K in the solver's own format, the only copy of it that there is, its rows divided between ranks.
/// A preconditioner may borrow it with something added where fault nodes are; K x is K x meanwhile.
class EngineMatrix {
 public:
  /// Collective.
  /// @param rows  n x own rows: column k is row first + k of the symmetric K.
  /// @param room  own rows x own columns: where something may be added.
  EngineMatrix(const SparseMatrix& rows, const RowRanges& ranges, const Ranks& ranks,
               const SparseMatrix& room);
  ~EngineMatrix();
  EngineMatrix(const EngineMatrix&) = delete;
  EngineMatrix& operator=(const EngineMatrix&) = delete;

  const Ranks& ranks() const;
  const RowRanges& ranges() const;
  int n_own() const;
  /// K x in own rows, of the own part of x. Collective.
  Eigen::VectorXd times(const Eigen::VectorXd& x);
  /// Of own rows of K.
  Eigen::VectorXd diagonal() const;
  /// Of K, an own row and an own column, counted from the first; 0 where there is none.
  double entry(int row, int column) const;

  /// K + `added`, until something else is added; what is taken away again leaves the bits of K.
  /// @param added  own rows x own columns, with entries in `room` or the pattern of K only; null:
  ///               nothing.
  std::shared_ptr<HypreMatrix> with(const std::shared_ptr<const SparseMatrix>& added);

 private:
  template <typename Visit>
  void for_each_added(const Visit& visit);

  std::shared_ptr<HypreMatrix> matrix_;
  std::shared_ptr<const SparseMatrix> added_;
  Eigen::VectorXd before_;  ///< K's values there, entry by entry.
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace faultsim
