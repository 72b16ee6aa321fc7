#pragma once

#include <mpi.h>

#include "simulator/coupled/ranks.h"

namespace faultsim {

/// What of MPI stands behind Ranks.
struct Ranks::Job {
  MPI_Comm all = MPI_COMM_SELF;
  int rank = 0, size = 1;
};

/// For what takes a communicator: MPI_COMM_SELF of a process alone.
inline MPI_Comm communicator(const Ranks& ranks) {
  return ranks.job() == nullptr ? MPI_COMM_SELF : ranks.job()->all;
}

}  // namespace faultsim
