// The cases of results/python/make by the library: "loop many N" or "loop 3d N"; prints seconds and
// what became of them.
#include <faultsim/simulation.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

int main(int argc, char** argv) try {
  if (argc < 4) return 2;
  const bool is_3d = std::string(argv[1]) == "3d";
  const int n_cases = std::atoi(argv[2]);
  auto field = faultsim::Simulation::from_file(
      argv[3], is_3d ? faultsim::Changes{{"/tier", "demonstration"}}
                     : faultsim::Changes{{"/tier", "screening"}, {"/numerics/plane_strain", "on"}});
  faultsim::RunContext context;
  context.n_threads = 2;
  field.prepare(context);
  int n_slide = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < (is_3d ? 1 : n_cases); ++i) {
    char angle[40];
    std::snprintf(angle, sizeof angle, "%.17g rad", 0.3 + 0.3 * i / n_cases);
    n_slide += field.run({{"friction_angle", is_3d ? "18 deg" : angle}}).whole.activated;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%.6f %d\n", took.count(), n_slide);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
