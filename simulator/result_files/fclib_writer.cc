#include <limits>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/result_files/fclib_writer.h"

namespace faultsim {
namespace {

/// FCLib keeps a single number as a vector of one entry.
void write_number(hid_t file, const std::string& path, int value) {
  hdf5::write_array(file, path, {1}, &value, {});
}

void write_number(hid_t file, const std::string& path, double value, const hdf5::About& about) {
  hdf5::write_array(file, path, {1}, &value, about);
}

void write_vector(hid_t file, const std::string& path, const Eigen::VectorXd& values,
                  const hdf5::About& about) {
  hdf5::write_array(file, path, {static_cast<hsize_t>(values.size())}, values.data(), about);
}

/// W by compressed columns, every entry stored: W is dense.
void write_matrix(hid_t file, const std::string& group, const Eigen::MatrixXd& w) {
  const auto n = static_cast<int>(w.rows());
  const int n_entries = n * n;
  constexpr int kCompressedColumns = -1;
  write_number(file, group + "/nzmax", n_entries);
  write_number(file, group + "/m", n);
  write_number(file, group + "/n", n);
  write_number(file, group + "/nz", kCompressedColumns);
  std::vector<int> start(static_cast<std::size_t>(n) + 1);
  for (std::size_t j = 0; j < start.size(); ++j) start[j] = static_cast<int>(j) * n;
  std::vector<int> row(static_cast<std::size_t>(n_entries));
  for (int j = 0; j < n; ++j)
    std::iota(row.begin() + start[j], row.begin() + start[static_cast<std::size_t>(j) + 1], 0);
  hdf5::write_array(file, group + "/p", {start.size()}, start.data(), {});
  hdf5::write_array(file, group + "/i", {row.size()}, row.data(), {});
  hdf5::write_array(file, group + "/x", {row.size()}, w.data(), {});
}

void require_sound(const FrictionalContactProblem& problem,
                   const FrictionalContactSolution* solution) {
  const Eigen::Index n = Eigen::Index{problem.n_contacts()} * problem.dimension;
  FAULTSIM_DEMAND(problem.dimension == 2 || problem.dimension == 3, problem.dimension);
  FAULTSIM_DEMAND(n > 0 && problem.w.rows() == n && problem.w.cols() == n && problem.q.size() == n,
                  "W ", problem.w.rows(), " x ", problem.w.cols(), ", q ", problem.q.size(), ", ",
                  problem.n_contacts(), " contacts");
  FAULTSIM_DEMAND(n * n <= std::numeric_limits<int>::max(), "W has ", n, " rows");
  FAULTSIM_DEMAND(problem.w.allFinite() && problem.q.allFinite() && problem.friction.allFinite(),
                  "the problem is not finite");
  if (solution == nullptr) return;
  FAULTSIM_DEMAND(solution->u.size() == n && solution->r.size() == n, "u ", solution->u.size(),
                  ", r ", solution->r.size(), " instead of ", n);
  FAULTSIM_DEMAND(solution->u.allFinite() && solution->r.allFinite(), "the solution is not finite");
}

}  // namespace

void write_fclib(const std::filesystem::path& path, const FrictionalContactProblem& problem,
                 const FrictionalContactInfo& info, const FrictionalContactSolution* solution) {
  require_sound(problem, solution);
  PendingFile target(path);
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::create_in_memory();
  const std::string metres = concat(problem.displacement_unit, " m");
  const std::string newtons = concat(problem.force_unit, " N");
  write_number(file, "/fclib_local/spacedim", problem.dimension);
  write_matrix(file, "/fclib_local/W", problem.w);
  write_vector(file, "/fclib_local/vectors/q", problem.q, {metres, "motion if nothing resists"});
  write_vector(file, "/fclib_local/vectors/mu", problem.friction, {"1", "friction coefficient"});
  hdf5::write_text(file, "/fclib_local/info/title", info.title);
  hdf5::write_text(file, "/fclib_local/info/description", info.description);
  hdf5::write_text(file, "/fclib_local/info/math_info", info.math_info);
  write_number(file, "/faultsim/displacement_unit", problem.displacement_unit,
               {"m", "u and q are in this many metres"});
  write_number(file, "/faultsim/force_unit", problem.force_unit,
               {"N", "r is in this many newtons"});
  if (solution != nullptr) {
    write_vector(file, "/solution/u", solution->u, {metres, "gap, and slip of the step"});
    write_vector(file, "/solution/r", solution->r, {newtons, "contact force"});
  }
  const std::vector<std::byte> bytes = hdf5::image(file);
  target.write(bytes.data(), bytes.size(), 0);
  target.commit();
}

}  // namespace faultsim
