// What a case costs whose faults slide in 3D, on an operator that is there: the reference field
// with its east block displaced by 200 m, over friction angles of a normal distribution, and what
// the solver did for it.  Usage: sliding_cases TIER SAMPLES [--cache FOLDER] [--figures FILE]
// [/pointer=value ...] Prints a line per case and the means; --figures writes all that faults did
// in every load step, all digits, for a comparison of two programs (results/contact-speed/make).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "simulator/linalg/blas_start.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/clocks.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;

struct Request {
  std::string tier;
  int samples = 0;
  std::string cache, figures;
  Changes changes;
};

Request read_request(int argc, char** argv) {
  if (argc < 3)
    throw std::runtime_error(
        "sliding_cases TIER SAMPLES [--cache FOLDER] [--figures FILE] [/pointer=value]");
  Request request{argv[1], std::atoi(argv[2]), "", "", {}};
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    if (word == "--cache" && i + 1 < argc) {
      request.cache = argv[++i];
    } else if (word == "--figures" && i + 1 < argc) {
      request.figures = argv[++i];
    } else if (word.front() == '/' && equals != std::string::npos) {
      request.changes.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    } else {
      throw std::runtime_error("what is " + word + "?");
    }
  }
  return request;
}

/// The x with Φ(x) = p, by bisection.
double normal_quantile(double p) {
  double low = -10, high = 10;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(-x / std::sqrt(2.0)) < p ? low : high) = x;
  }
  return low;
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

void write_figures(std::ostream& out, double angle, const CaseResult& result) {
  out << std::setprecision(17);
  for (const StepResult& step : result.steps) {
    for (std::size_t f = 0; f < step.faults.size(); ++f) {
      const FaultMetrics& m = step.faults[f];
      out << angle << ' ' << step.step << ' ' << f << ' ' << to_string(step.outcome) << ' '
          << m.activated << ' ' << step.n_slip << ' ' << step.n_open << ' ' << m.chi_bar << ' '
          << m.chi_max << ' ' << m.max_slip << ' ' << m.mean_slip << ' ' << m.activated_length
          << ' ' << m.activated_area << ' ' << m.moment << ' ' << m.moment_step << '\n';
    }
  }
}

void run(const Request& request) {
  Changes changes = {{"/tier", request.tier}, {"/geometry/blocks/1/offset", "200 m"}};
  changes.insert(changes.end(), request.changes.begin(), request.changes.end());
  SilentMonitor monitor;
  PreparedOperator prepared;
  std::ofstream figures;
  if (!request.figures.empty()) figures.open(request.figures);
  double seconds = 0;
  Work all;
  std::printf("angle, deg  CPU, ms  Newton  factored  GMRES  slipping  largest slip, m  outcome\n");
  for (int i = 0; i < request.samples; ++i) {
    const double angle = 25 + 4 * normal_quantile((i + 0.5) / request.samples);
    changes.resize(2 + request.changes.size());
    changes.emplace_back("/friction/friction_angle", std::to_string(angle) + " deg");
    const PlannedScene scene = planned("rotliegend.json", changes);
    if (!prepared.op)
      prepared =
          prepare_operator(scene.scene, scene.plan, {.folder = request.cache}, false, monitor);
    Work work;
    CaseProbe probe;
    probe.tried = [&](int, const SubStepTrace& trace) { work.add(trace); };
    const double start = cpu_seconds();
    const CaseResult result = run_case(scene.scene, prepared, monitor, probe);
    const double taken = cpu_seconds() - start;
    double slip = 0;
    for (const FaultStageMetrics& fault : result.whole.faults)
      slip = std::max(slip, fault.max_slip);
    std::printf("%10.3f  %7.1f  %6d  %8d  %5d  %8d  %15.4f  %s\n", angle, 1e3 * taken,
                work.iterations, work.factored, work.krylov, work.most_slipping, slip,
                to_string(result.outcome));
    std::fflush(stdout);
    if (figures.is_open()) write_figures(figures, angle, result);
    seconds += taken;
    all.iterations += work.iterations;
    all.factored += work.factored;
    all.krylov += work.krylov;
    all.most_slipping = std::max(all.most_slipping, work.most_slipping);
  }
  const double n = request.samples;
  std::printf("mean        %7.1f  %6.1f  %8.1f  %5.1f  %8d\n", 1e3 * seconds / n,
              all.iterations / n, all.factored / n, all.krylov / n, all.most_slipping);
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
