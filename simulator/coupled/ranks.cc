#include "simulator/coupled/ranks.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <iostream>

#include "simulator/common/errors.h"
#include "simulator/coupled/rank_job.h"
#include "simulator/coupled/start_hypre.h"

namespace faultsim {
namespace {

/// The parts of all ranks, one after another.
template <typename Part>
Part all_parts(const Ranks::Job& job, const Part& part, MPI_Datatype type) {
  std::vector<int> counts(static_cast<std::size_t>(job.size)), begin(counts.size() + 1, 0);
  const int own = static_cast<int>(part.size());
  MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, job.all);
  for (std::size_t r = 0; r < counts.size(); ++r) begin[r + 1] = begin[r] + counts[r];
  Part all(begin.back());
  MPI_Allgatherv(part.data(), own, type, all.data(), counts.data(), begin.data(), type, job.all);
  return all;
}

/// Of the first of these variables that says one; 0 where none does.
int number_of(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const char* const text = std::getenv(name);
    int number = 0;
    if (text == nullptr) continue;
    const char* const end = text + std::strlen(text);
    if (std::from_chars(text, end, number).ptr == end && number >= 0) return number;
  }
  return 0;
}

}  // namespace

Ranks::Ranks() = default;

Ranks Ranks::of_the_job() {
  start_hypre();
  Job job;
  job.all = MPI_COMM_WORLD;
  MPI_Comm_rank(job.all, &job.rank);
  MPI_Comm_size(job.all, &job.size);
  Ranks ranks;
  if (job.size > 1) ranks.job_ = std::make_shared<const Job>(job);
  return ranks;
}

int Ranks::rank() const { return job_ ? job_->rank : 0; }
int Ranks::size() const { return job_ ? job_->size : 1; }

void Ranks::sum(Eigen::Ref<Eigen::VectorXd> values) const {
  if (!job_) return;
  const Eigen::VectorXd own = values;
  Eigen::MatrixXd all(own.size(), job_->size);
  const int n = static_cast<int>(own.size());
  MPI_Allgather(own.data(), n, MPI_DOUBLE, all.data(), n, MPI_DOUBLE, job_->all);
  values.setZero();
  for (int r = 0; r < job_->size; ++r) values += all.col(r);
}

double Ranks::sum(double value) const {
  sum(Eigen::Map<Eigen::VectorXd>(&value, 1));
  return value;
}

int Ranks::largest(int value) const {
  if (job_) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, job_->all);
  return value;
}

Eigen::VectorXd Ranks::gathered(const Eigen::VectorXd& part) const {
  return job_ ? all_parts(*job_, part, MPI_DOUBLE) : part;
}

std::vector<int> Ranks::gathered(const std::vector<int>& part) const {
  return job_ ? all_parts(*job_, part, MPI_INT) : part;
}

void Ranks::abort(const char* word, int code) const {
  if (size() > 1) {
    std::cerr << concat("rank ", rank(), " of ", size(), " ends the job: ", word, "\n")
              << std::flush;
    MPI_Abort(job_->all, code);
  }
  std::cerr << word << "\n";
  std::_Exit(code);
}

int started_with() {
  return std::max(1, number_of({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS",
                                "SLURM_STEP_NUM_TASKS"}));
}

int started_as() {
  return number_of({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "MPI_LOCALRANKID", "SLURM_PROCID"});
}

}  // namespace faultsim
