#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

#include "simulator/linalg/gmres.h"

namespace faultsim {

/// The processes that solve one case together (ranks of MPI). All of them know scene, mesh and the
/// state of the faults, and come to the same decisions from the same bits; what is divided between
/// them are the rows of K and whatever is as long as its columns.
///
/// Every member function that says so is collective: all ranks call it, in the same order.
class Ranks {
 public:
  Ranks();  ///< this process alone; starts nothing.
  /// All processes that mpirun or srun started together. Starts MPI.
  static Ranks of_the_job();

  int rank() const;  ///< 0 … size() − 1.
  int size() const;

  /// Collective. Sums over ranks, entry by entry, in the order of the ranks: same bits on each.
  void sum(Eigen::Ref<Eigen::VectorXd> values) const;
  double sum(double value) const;
  /// Collective. The largest of all ranks.
  int largest(int value) const;
  /// Collective. The parts of all ranks, one after another.
  Eigen::VectorXd gathered(const Eigen::VectorXd& part) const;
  std::vector<int> gathered(const std::vector<int>& part) const;
  /// Ends all ranks at once, with a word on stderr: for an error that others do not know of and
  /// would wait for. @param code  of the job.
  [[noreturn]] void abort(const char* word, int code) const;

  struct Job;  ///< MPI's communicator (hypre_objects.h); null: alone.
  const Job* job() const { return job_.get(); }

 private:
  std::shared_ptr<const Job> job_;
};

/// Its sum as linear algebra takes it; none where there is nothing to add. @pre ranks outlive it.
inline SumOverRanks sum_over(const Ranks& ranks) {
  if (ranks.size() == 1) return nullptr;
  // A view, by which the values change. NOLINTNEXTLINE(performance-unnecessary-value-param)
  return [&ranks](Eigen::Ref<Eigen::VectorXd> values) { ranks.sum(values); };
}

/// Which rows of a matrix belong to which rank: begin[r] … begin[r + 1] − 1.
struct RowRanges {
  std::vector<int> begin;

  static RowRanges whole(int n) { return {{0, n}}; }
  int first(const Ranks& ranks) const { return begin[static_cast<std::size_t>(ranks.rank())]; }
  int count(const Ranks& ranks) const {
    return begin[static_cast<std::size_t>(ranks.rank()) + 1] - first(ranks);
  }
  int n_rows() const { return begin.back(); }
  int owner_of(int row) const {
    return static_cast<int>(std::ranges::upper_bound(begin, row) - begin.begin()) - 1;
  }
};

/// How many processes mpirun or srun started this one with, by its environment: 1 for one that was
/// started alone. Starts nothing.
int started_with();
int started_as();  ///< which of them, from 0 on.

}  // namespace faultsim
