// What the product lives from, as quotients of two CPU times: ours and that of a yardstick which is
// not ours (BLAS, LAPACK, SQLite, the system) or is the plain way to do the same. Both are taken in
// turn in one process, one thread, so that the machine's speed cancels; the median quotient of
// several turns counts. tests/benchmarks/regression runs it. Prints a line "metric ratio spread"
// per metric; spread is (largest − smallest) / median.

#include <cblas.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "simulator/cache/operator_cache.h"
#include "simulator/loading/run_case.h"
#include "simulator/result/result_json.h"
#include "tests/benchmarks/clocks.h"
#include "tests/benchmarks/instant_workers.h"
#include "tests/benchmarks/plain_bulk.h"
#include "tests/benchmarks/scenes.h"
#include "tests/campaign/made_up_result.h"

extern "C" void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* pivots,
                        int* info);

namespace faultsim::benchmarks {
namespace {

constexpr int kTurns = 9;

/// CPU seconds of one call, over `calls` of them.
template <typename Work>
double seconds_of_call(int calls, const Work& work) {
  const double start = cpu_seconds();
  for (int i = 0; i < calls; ++i) work();
  return (cpu_seconds() - start) / calls;
}

/// The quotients of one metric, a turn each.
class Quotients {
 public:
  explicit Quotients(std::string metric) : metric_(std::move(metric)) {}
  void add(double ours, double yardstick) { values_.push_back(ours / yardstick); }
  void print() {
    std::sort(values_.begin(), values_.end());
    const double median = values_[values_.size() / 2];
    std::printf("%s %.4g %.2f\n", metric_.c_str(), median,
                (values_.back() - values_.front()) / median);
    std::fflush(stdout);
  }

 private:
  std::string metric_;
  std::vector<double> values_;
};

/// A folder that goes with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ratios-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Yardsticks --------------------------------------------------------------------------------------

/// C = A B, n x n, by BLAS.
void matrix_product(int n) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(n, n, 0.5);
  Eigen::MatrixXd c(n, n);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1.0, a.data(), n, a.data(), n,
              0.0, c.data(), n);
}

/// LU = H by LAPACK.
void dense_lu(const FaultOperator& op) {
  Eigen::MatrixXd h = op.h();
  const int n = static_cast<int>(h.rows());
  std::vector<int> pivots(static_cast<std::size_t>(n));
  int info = 0;
  dgetrf_(&n, &n, h.data(), &n, pivots.data(), &info);
  if (info != 0) throw std::runtime_error("dgetrf failed");
}

/// Reads the file into memory with one read().
void read_plainly(const std::filesystem::path& path) {
  std::vector<char> bytes(std::filesystem::file_size(path));
  const int file = open(path.c_str(), O_RDONLY);
  const ssize_t got = read(file, bytes.data(), bytes.size());
  close(file);
  if (got != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("short read");
}

/// Has SQLite write the same tables, rows and indexes to another file, in one transaction.
void copy_database(const std::filesystem::path& from, const std::filesystem::path& to) {
  sqlite3* db = nullptr;
  const std::string copy = "VACUUM INTO '" + to.string() + "'";
  if (sqlite3_open(from.c_str(), &db) != SQLITE_OK ||
      sqlite3_exec(db, copy.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error(sqlite3_errmsg(db));
  }
  sqlite3_close(db);
}

// What is measured --------------------------------------------------------------------------------

PreparedOperator prepared(const PlannedScene& planned_scene) {
  SilentMonitor monitor;
  return prepare_operator(planned_scene.scene, planned_scene.plan, {}, false, monitor);
}

CaseResult solved(const PlannedScene& planned_scene, const PreparedOperator& op) {
  SilentMonitor monitor;
  return run_case(planned_scene.scene, op, monitor);
}

/// Writes the operator under a new name and returns what it takes to read it and to read its file.
std::pair<double, double> read_seconds(FaultOperator op, int turn,
                                       const std::filesystem::path& folder) {
  constexpr int kFiles = 3;  // a checksum is verified once per file: each is read once
  const auto name = [&](int k) { return fingerprint(std::to_string(kFiles * turn + k)); };
  for (int k = 0; k < kFiles; ++k) {
    op.fingerprint = name(k);
    write_operator(op, folder);
  }
  int next = 0;
  const double ours = seconds_of_call(kFiles, [&] {
    if (!read_operator(folder, name(next++))) throw std::runtime_error("operator not read");
  });
  next = 0;
  const double plainly =
      seconds_of_call(kFiles, [&] { read_plainly(folder / (name(next++) + ".h5")); });
  return {ours, plainly};
}

/// A coarse 3D mesh of the reference field: 74 thousand unknowns, 1296 jumps.
void bulk() {
  const PlannedScene scene = planned("rotliegend.json", {{"/mesh/growth", "2"},
                                                         {"/mesh/strike", "150 m"},
                                                         {"/mesh/dip", "30 m"},
                                                         {"/friction/friction_angle", "20 deg"}});
  const BulkProblem problem = bulk_problem(scene.scene, scene.plan);
  const TemporaryFolder folder;
  Quotients factor("factorisation"), build("operator"), condensed("condensed_case"), read("read");
  for (int turn = 0; turn < kTurns; ++turn) {
    const double product = seconds_of_call(1, [] { matrix_product(2000); });
    double factorisation = 0;
    const double plain = seconds_of_call(1, [&] {
      const PlainBulk bulk = plain_bulk(problem);
      factorisation = seconds_of_call(1, [&] { bulk.factorised(); });
    });
    PreparedOperator op;
    const double built = seconds_of_call(1, [&] { op = prepared(scene); });
    CaseResult result;
    const double solve = seconds_of_call(20, [&] { result = solved(scene, op); });
    factor.add(factorisation, product);
    build.add(built, plain);
    condensed.add(solve, result.counts.newton_iterations * factorisation);
    const auto [ours, plainly] = read_seconds(*op.op, turn, folder.path());
    read.add(ours, plainly);
  }
  factor.print();
  build.print();
  condensed.print();
  read.print();
}

/// Cases in plane strain, where campaigns have most of theirs.
void cases() {
  const PlannedScene elastic = planned("rotliegend.json", {{"/tier", "custom"},
                                                           {"/mesh", kEven10},
                                                           {"/numerics/plane_strain", "on"},
                                                           {"/mesh/dip", "7 m"},
                                                           {"/geometry/blocks/1/offset", "200 m"},
                                                           {"/friction/friction_angle", "18 deg"}});
  const PlannedScene weakening =
      planned("rotliegend-weakening.json", {{"/tier", "custom"},
                                            {"/mesh", kEven10},
                                            {"/numerics/plane_strain", "on"},
                                            {"/mesh/dip", "7 m"},
                                            {"/geometry/blocks/1/offset", "200 m"},
                                            {"/friction/friction_angle", "25 deg"}});
  const PreparedOperator op = prepared(elastic);
  Quotients plain("elastic_case"), events("weakening_case"), json("result_json");
  for (int turn = 0; turn < kTurns; ++turn) {
    const double lu = seconds_of_call(20, [&] { dense_lu(*op.op); });
    CaseResult result;
    const double elastic_case = seconds_of_call(100, [&] { result = solved(elastic, op); });
    const double text = seconds_of_call(100, [&] { (void)result_to_json(result).dump(); });
    plain.add(elastic_case, lu);
    json.add(text, elastic_case);
    events.add(seconds_of_call(1, [&] { result = solved(weakening, op); }), lu);
    if (result.events.empty()) throw std::runtime_error("the weakening case has no slip event");
  }
  plain.print();
  events.print();
  json.print();
}

/// Creeping salt in plane strain. No triangular solves for a yardstick: their time doubles with
/// what other processes leave of the memory's speed.
void creep() {
  const PlannedScene scene =
      planned("rotliegend-salt.json", {{"/tier", "custom"},
                                       {"/mesh", kEven10},
                                       {"/numerics/plane_strain", "on"},
                                       {"/geometry/blocks/1/offset", "200 m"},
                                       {"/friction/friction_angle", "20 deg"}});
  const PreparedOperator op = prepared(scene);
  Quotients time_step("creep_time_step");
  for (int turn = 0; turn < kTurns; ++turn) {
    const double lu = seconds_of_call(100, [&] { dense_lu(*op.op); });
    CaseResult result;
    const double history = seconds_of_call(1, [&] { result = solved(scene, op); });
    int accepted = 0;
    for (const StepResult& step : result.steps) accepted += step.creep ? step.creep->time_steps : 0;
    time_step.add(history / accepted, lu);
  }
  time_step.print();
}

/// The manager's work for a result with 25 load steps: receive, decode, plan, commit.
void manager() {
  constexpr int kCases = 2000;
  faultsweep::ProgressDisplay silent(faultsweep::ProgressDisplay::Style::silent);
  Quotients results("manager");
  for (int turn = 0; turn < kTurns; ++turn) {
    const TemporaryFolder folder;
    faultsweep::Store store = faultsweep::Store::open_owner(folder.path());
    faultsweep::benchmarks::submit(store, kCases);
    faultsweep::benchmarks::InstantWorkers workers(faultsweep::testing::made_up_result(0.9, 25),
                                                   cpu_seconds);
    const double ours = seconds_of_call(1, [&] {
      faultsweep::Manager manager(store, workers, silent, {});
      while (manager.turn()) {
      }
      if (manager.status() != ExitCode::done) throw std::runtime_error("not all cases done");
    });
    store.checkpoint();
    const double copied = seconds_of_call(1, [&] {
      copy_database(folder.path() / "campaign.sqlite", folder.path() / "copy.sqlite");
    });
    results.add(ours - workers.seconds(), copied);
  }
  results.print();
}

}  // namespace
}  // namespace faultsim::benchmarks

int main() {
  faultsim::set_blas_threads(1);
  faultsim::benchmarks::bulk();
  faultsim::benchmarks::cases();
  faultsim::benchmarks::creep();
  faultsim::benchmarks::manager();
}
