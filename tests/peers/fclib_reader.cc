#include "tests/peers/fclib_reader.h"

#include <hdf5.h>

#include <memory>

#include "simulator/common/errors.h"

extern "C" {
#include <fclib.h>
}

namespace faultsim {
namespace {

std::string text(const char* given) { return given != nullptr ? given : ""; }

/// A matrix of FCLib, which here must be stored by compressed columns.
Eigen::MatrixXd dense(const fclib_matrix& matrix) {
  constexpr int kCompressedColumns = -1;
  if (matrix.nz != kCompressedColumns) throw StorageError("W is not stored by compressed columns");
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(matrix.m, matrix.n);
  for (int j = 0; j < matrix.n; ++j) {
    for (int e = matrix.p[j]; e < matrix.p[j + 1]; ++e) out(matrix.i[e], j) += matrix.x[e];
  }
  return out;
}

/// FCLib ends the process when it is asked for a solution that is not there.
bool has_solution(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return false;
  const bool found = H5Lexists(file, "/solution", H5P_DEFAULT) > 0;
  H5Fclose(file);
  return found;
}

}  // namespace

FclibFile read_with_fclib(const std::filesystem::path& path) {
  const std::unique_ptr<fclib_local, void (*)(fclib_local*)> local(fclib_read_local(path.c_str()),
                                                                   fclib_delete_local);
  if (!local) throw StorageError("libfclib cannot read " + path.string());
  FclibFile file;
  FrictionalContactProblem& problem = file.problem;
  problem.dimension = local->spacedim;
  problem.w = dense(*local->W);
  problem.q = Eigen::Map<const Eigen::VectorXd>(local->q, problem.w.rows());
  problem.friction =
      Eigen::Map<const Eigen::VectorXd>(local->mu, problem.w.rows() / problem.dimension);
  if (local->info != nullptr) {
    file.info = {text(local->info->title), text(local->info->description),
                 text(local->info->math_info)};
  }
  if (!has_solution(path)) return file;
  if (fclib_solution* solution = fclib_read_solution(path.c_str())) {
    file.solution = {Eigen::Map<const Eigen::VectorXd>(solution->u, problem.q.size()),
                     Eigen::Map<const Eigen::VectorXd>(solution->r, problem.q.size())};
    if (problem.dimension == 3) file.merit = fclib_merit_local(local.get(), MERIT_1, solution);
    fclib_delete_solutions(solution, 1);
  }
  return file;
}

}  // namespace faultsim
