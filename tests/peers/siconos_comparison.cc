// Our contact solver beside those of Siconos, on the same exported problems, one after the other in
// one process on one thread.  Usage: siconos_comparison [--json FILE] [--accuracy A] PROBLEM.hdf5
// ... Ends with 5 when a solution of the accuracy asked for has another slip than ours.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/common/errors.h"
#include "simulator/common/exit_code.h"
#include "simulator/common/stopwatch.h"
#include "simulator/linalg/cholesky.h"
#include "tests/peers/fclib_reader.h"
#include "tests/peers/siconos_solvers.h"
#include "tests/unit/contact/cone_fixture.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr double kSlipTolerance = 1e-7;  // of the largest slip

/// Natural-map error of reactions alone: u is taken as W r + q, so that equilibrium is exact for
/// everybody. Relative to |q|.
double error_of(const FrictionalContactProblem& problem, const Eigen::VectorXd& r) {
  return natural_map_error(problem, {problem.w * r + problem.q, r}) / problem.q.norm();
}

/// The slip of each contact, (d − 1) x n.
Eigen::MatrixXd slip_of(const FrictionalContactProblem& problem, const Eigen::VectorXd& u) {
  const Eigen::Map<const Eigen::MatrixXd> all(u.data(), problem.dimension, problem.n_contacts());
  return all.bottomRows(problem.dimension - 1);
}

/// Our solver on one problem. Each repetition is a new ContactSolver: what it keeps between the
/// steps of a case is built anew, and in the time.
class OurRun {
 public:
  explicit OurRun(const FrictionalContactProblem& problem) : given_(cone_step(problem)) {
    options_.max_step_cuts = 0;
  }
  void repeat() {
    end_ = given_.step.start;
    const Stopwatch watch;
    report_ = ContactSolver(given_.op, given_.laws, options_)
                  .solve_step(given_.step.before, given_.step.after, end_);
    seconds_ = std::min(seconds_, watch.seconds());
    if (report_.outcome != Outcome::converged) throw Error("no convergence: " + report_.reason);
  }
  void forget_times() { seconds_ = std::numeric_limits<double>::infinity(); }
  double seconds() const { return seconds_; }
  int iterations() const { return report_.counts.newton_iterations; }
  FrictionalContactSolution solution() const { return cone_solution(end_); }
  int count(FaultState state) const {
    return static_cast<int>(std::count(end_.state.begin(), end_.state.end(), state));
  }
  /// What our solver starts from: nothing moves. Projected on the cones.
  Eigen::VectorXd stuck_reactions(const FrictionalContactProblem& problem) const {
    Eigen::VectorXd r = -given_.step.after;
    const int d = problem.dimension;
    for (int k = 0; k < problem.n_contacts(); ++k) {
      r.segment(k * d, d) = project_on_friction_cone(r.segment(k * d, d), problem.friction[k]);
    }
    return r;
  }

 private:
  ConeStep given_;
  ContactOptions options_;
  ContactState end_;
  ContactReport report_;
  double seconds_ = std::numeric_limits<double>::infinity();
};

/// What the comparison of one problem found.
struct Comparison {
  json record;
  bool agrees = true;
};

/// What Siconos is asked for. Below the lowest, sums of rounding errors decide.
double accuracy_asked(const std::optional<double>& given, double our_error) {
  constexpr double kLowest = 1e-13;
  return given ? *given : std::max(our_error, kLowest);
}

/// A run of Siconos: which solver, from where, and what came of it.
struct Candidate {
  SiconosSolver solver;
  bool from_stick = false;
  bool reached = false;
  SiconosRun run;
  double error = 0, slip_difference = 0;

  json record() const {
    return {{"solver", solver.name},        {"start", from_stick ? "stick" : "zero"},
            {"says_converged", run.claims}, {"reached", reached},
            {"iterations", run.iterations}, {"seconds", run.seconds},
            {"natural_map_error", error},   {"slip_difference", slip_difference}};
  }
  void print() const {
    std::printf("  %-38s from %-5s %8.3f ms %6d iterations, error %.1e, slip differs by %.1e%s\n",
                solver.name.c_str(), from_stick ? "stick" : "zero", 1e3 * run.seconds,
                run.iterations, error, slip_difference, reached ? "" : "  not reached");
  }
};

Eigen::VectorXd start_of(const Candidate& candidate, const FrictionalContactProblem& problem,
                         const OurRun& ours) {
  if (candidate.from_stick) return ours.stuck_reactions(problem);
  return Eigen::VectorXd::Zero(problem.q.size());
}

/// Every solver from both starts, once or a few times: which are worth timing?
std::vector<Candidate> survey(const FrictionalContactProblem& problem, const OurRun& ours,
                              const SiconosLimits& limits) {
  const Eigen::MatrixXd slip = slip_of(problem, ours.solution().u);
  const double largest_slip = slip.colwise().norm().maxCoeff();
  std::vector<Candidate> candidates;
  for (const SiconosSolver& solver : siconos_solvers(problem.dimension)) {
    for (const bool from_stick : {false, true}) {
      Candidate candidate;
      candidate.solver = solver;
      candidate.from_stick = from_stick;
      candidate.run = run_siconos(solver, problem, start_of(candidate, problem, ours), limits);
      const Eigen::VectorXd& r = candidate.run.r;
      candidate.error = error_of(problem, r);
      const Eigen::MatrixXd difference = slip_of(problem, problem.w * r + problem.q) - slip;
      candidate.slip_difference = difference.colwise().norm().maxCoeff() / largest_slip;
      candidate.reached = candidate.error <= limits.accuracy;
      candidate.print();
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

/// The fastest runs again, in turns with ours and as often: what else the machine does hits both.
void time_in_turns(const FrictionalContactProblem& problem, const SiconosLimits& limits,
                   std::vector<Candidate>& fastest, OurRun& ours) {
  constexpr int kRounds = 5;
  ours.forget_times();
  for (Candidate& candidate : fastest) candidate.run.seconds = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < limits.repetitions; ++i) ours.repeat();
    for (Candidate& candidate : fastest) {
      const SiconosRun run =
          run_siconos(candidate.solver, problem, start_of(candidate, problem, ours), limits);
      candidate.run.seconds = std::min(candidate.run.seconds, run.seconds);
    }
  }
}

std::vector<Candidate> fastest_of(std::vector<Candidate> candidates) {
  constexpr std::size_t kMost = 3;
  std::erase_if(candidates, [](const Candidate& c) { return !c.reached; });
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.run.seconds < b.run.seconds; });
  if (candidates.size() > kMost) candidates.resize(kMost);
  return candidates;
}

Comparison compare(const std::filesystem::path& path, const std::optional<double>& accuracy) {
  const FrictionalContactProblem problem = read_with_fclib(path).problem;
  OurRun ours(problem);
  ours.repeat();
  const double our_error = error_of(problem, ours.solution().r);
  SiconosLimits limits;
  limits.accuracy = accuracy_asked(accuracy, our_error);
  std::printf("%s: %d contacts in %dD, %d slip, %d open\n", path.stem().c_str(),
              problem.n_contacts(), problem.dimension, ours.count(FaultState::slip),
              ours.count(FaultState::open));
  const std::vector<Candidate> candidates = survey(problem, ours, limits);
  std::vector<Candidate> fastest = fastest_of(candidates);
  time_in_turns(problem, limits, fastest, ours);
  std::sort(fastest.begin(), fastest.end(),
            [](const Candidate& a, const Candidate& b) { return a.run.seconds < b.run.seconds; });

  Comparison result;
  json all = json::array(), timed = json::array();
  for (const Candidate& candidate : candidates) {
    if (candidate.reached && !(candidate.slip_difference <= kSlipTolerance)) result.agrees = false;
    all.push_back(candidate.record());
  }
  for (const Candidate& candidate : fastest) timed.push_back(candidate.record());
  if (fastest.empty() || !(our_error <= limits.accuracy)) result.agrees = false;
  const double ratio = fastest.empty() ? 0 : fastest[0].run.seconds / ours.seconds();
  std::printf("  in turns:\n");
  if (!fastest.empty()) fastest[0].print();
  std::printf("  %-38s            %8.3f ms %6d iterations, error %.1e; ratio %.1f\n", "faultsim",
              1e3 * ours.seconds(), ours.iterations(), our_error, ratio);
  result.record = {{"problem", path.stem().string()},
                   {"dimension", problem.dimension},
                   {"n_contacts", problem.n_contacts()},
                   {"n_slip", ours.count(FaultState::slip)},
                   {"n_open", ours.count(FaultState::open)},
                   {"accuracy", limits.accuracy},
                   {"faultsim",
                    {{"seconds", ours.seconds()},
                     {"iterations", ours.iterations()},
                     {"natural_map_error", our_error}}},
                   {"siconos_in_turns", timed},
                   {"time_ratio", ratio},
                   {"siconos_survey", all}};
  return result;
}

ExitCode comparison_main(int argc, char** argv) {
  std::string output;
  std::optional<double> accuracy = SiconosLimits{}.accuracy;
  std::vector<std::filesystem::path> problems;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc) {
      output = argv[++i];
    } else if (argument == "--accuracy" && i + 1 < argc) {
      const std::string given = argv[++i];
      accuracy.reset();
      if (given != "ours") accuracy = std::stod(given);
    } else {
      problems.emplace_back(argument);
    }
  }
  set_blas_threads(1);
  json records = json::array();
  bool agrees = !problems.empty();
  for (const std::filesystem::path& problem : problems) {
    const Comparison comparison =
        with_context([&] { return "comparing " + problem.stem().string(); },
                     [&] { return compare(problem, accuracy); });
    agrees = agrees && comparison.agrees;
    records.push_back(comparison.record);
    std::fflush(stdout);
  }
  if (!output.empty()) {
    std::ofstream file(output);
    file << json{{"slip_tolerance", kSlipTolerance}, {"problems", records}}.dump(1) << "\n";
    if (!file.flush()) throw StorageError("cannot write " + output);
  }
  std::printf("%zu problems: %s\n", problems.size(),
              agrees ? "same slip wherever the accuracy was reached" : "NOT in agreement");
  return agrees ? ExitCode::done : ExitCode::regress;
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("siconos_comparison", faultsim::comparison_main, argc, argv));
}
