// What cases cost on an operator that is there, one after the other as they are asked for, so that
// two programs can be asked in turn (results/contact-speed/make).
//
//   sliding_cases SCENE [--cache FOLDER] [--threads N] [/pointer=value ...]
//
// reads a line per case, an object of further values: {"/friction/friction_angle": "24 deg"}; all
// are of one family. Answers with a line each: processor and wall time, what the solver did for it,
// and all that faults did in every load step, all digits.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "simulator/common/stopwatch.h"
#include "simulator/common/thread_team.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/clocks.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;

struct Request {
  std::string scene, cache;
  Changes changes;
  int threads = 1;
};

Request read_request(int argc, char** argv) {
  if (argc < 2)
    throw std::runtime_error("sliding_cases SCENE [--cache FOLDER] [--threads N] [/pointer=value]");
  Request request{argv[1], "", {}};
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    if (word == "--cache" && i + 1 < argc) {
      request.cache = argv[++i];
    } else if (word == "--threads" && i + 1 < argc) {
      request.threads = std::stoi(argv[++i]);
    } else if (word.front() == '/' && equals != std::string::npos) {
      request.changes.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    } else {
      throw std::runtime_error("what is " + word + "?");
    }
  }
  return request;
}

/// What the solver did, summed over all tries.
struct Work {
  int iterations = 0, factored = 0, krylov = 0, most_slipping = 0;
  void add(const SubStepTrace& trace) {
    for (const SubStepTrace::Search& search : trace.searches) {
      iterations += search.history.iterations;
      for (const SearchIteration& iteration : search.history.last) {
        factored += iteration.krylov < 0;
        krylov += std::max(iteration.krylov, 0);
        most_slipping = std::max(most_slipping, iteration.n_slip);
      }
    }
  }
};

/// Of a fault in a load step: what must be equal, then what may differ by rounding.
nlohmann::json figures(const CaseResult& result) {
  nlohmann::json rows = nlohmann::json::array();
  for (const StepResult& step : result.steps) {
    for (const FaultMetrics& m : step.faults) {
      rows.push_back({{to_string(step.outcome), m.activated, step.n_slip, step.n_open},
                      {m.chi_bar, m.chi_max, m.max_slip, m.mean_slip, m.activated_length,
                       m.activated_area, m.moment, m.moment_step}});
    }
  }
  return rows;
}

void run(const Request& request) {
  SilentMonitor monitor;
  ThreadTeam team(request.threads);
  RunContext context(monitor);
  context.team = &team;
  PreparedOperator prepared;
  for (std::string line; std::getline(std::cin, line);) {
    Changes changes = request.changes;
    const nlohmann::json wanted = nlohmann::json::parse(line);
    for (const auto& [pointer, value] : wanted.items())
      changes.emplace_back(pointer, value.is_string() ? value.get<std::string>() : value.dump());
    const PlannedScene scene = planned(request.scene, changes);
    if (!prepared.op)
      prepared =
          prepare_operator(scene.scene, scene.plan, {.folder = request.cache}, false, monitor);
    Work work;
    CaseProbe probe;
    probe.tried = [&](int, const SubStepTrace& trace) { work.add(trace); };
    const double start = cpu_seconds();
    const Stopwatch watch;
    const CaseResult result = run_case(scene.scene, prepared, context, probe);
    const double wall = watch.seconds();
    const double taken = cpu_seconds() - start;
    std::cout << nlohmann::json{{"ms", 1e3 * taken},
                                {"wall_ms", 1e3 * wall},
                                {"newton", work.iterations},
                                {"factored", work.factored},
                                {"gmres", work.krylov},
                                {"slipping", work.most_slipping},
                                {"outcome", to_string(result.outcome)},
                                {"figures", figures(result)}}
              << std::endl;
  }
}

}  // namespace
}  // namespace faultsim::benchmarks

int main(int argc, char** argv) {
  try {
    faultsim::start_blas(argv);
    faultsim::set_blas_threads(1);
    faultsim::benchmarks::run(faultsim::benchmarks::read_request(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
