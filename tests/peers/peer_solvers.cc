// Solves a system of `faultsim solver-study --export` with PETSc or MUMPS and prints a row as JSON.
// Usage: peer_solvers FOLDER petsc MAX_ITERATIONS OPTIONS_OF_PETSC…
//        peer_solvers FOLDER mumps MOST_MEGABYTES
#include <petscsys.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/peers/study_system.h"

namespace {

nlohmann::ordered_json to_json(const faultsim::PeerRow& row) {
  const auto counts = [](const faultsim::PeerRow::Counts& found) {
    const auto count = [](int n) {
      return n < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(n);
    };
    return nlohmann::ordered_json{{"1e-6", count(found.to_1e6)}, {"1e-8", count(found.to_1e8)}};
  };
  nlohmann::ordered_json out = {{"random", counts(row.random)},
                                {"physical", counts(row.physical)},
                                {"setup_s", row.setup_seconds},
                                {"solve_s", row.solve_seconds},
                                {"true_residual", row.true_residual}};
  if (!row.failure.empty()) out["failure"] = row.failure;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: peer_solvers FOLDER petsc MAX_ITERATIONS OPTIONS | mumps MEGABYTES\n",
               stderr);
    return 2;
  }
  const std::string folder = argv[1], which = argv[2];
  const double limit = std::strtod(argv[3], nullptr);
  int n_options = argc - 3;
  char** options = argv + 3;
  if (PetscInitialize(&n_options, &options, nullptr, nullptr) != 0) return 4;
  faultsim::StudySystem system = faultsim::load_study(folder);
  const faultsim::PeerRow row = which == "mumps"
                                    ? faultsim::mumps_row(system, limit)
                                    : faultsim::petsc_row(system, static_cast<int>(limit));
  std::cout << to_json(row).dump() << '\n';
  PetscFinalize();
  return row.failure.empty() ? 0 : 3;
}
