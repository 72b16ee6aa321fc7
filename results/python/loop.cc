// The cases of results/python/make by the library: "loop KIND N FIELD", KIND "plane" or "3d".
// Prints seconds, then per case what became of it, 17 digits.
#include <faultsim/simulation.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

void print(double value) {
  if (std::isnan(value)) {
    std::printf("nan ");
  } else {
    std::printf("%.17g ", value);
  }
}

}  // namespace

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
  field.run({{"friction_angle", "0.3 rad"}});  // memory and caches are warm
  std::vector<faultsim::StageMetrics> wholes;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < n_cases; ++i) {
    char angle[40];
    std::snprintf(angle, sizeof angle, "%.17g rad", 0.3 + 0.3 * i / n_cases);
    wholes.push_back(field.run({{"friction_angle", angle}}).whole);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%.6f\n", took.count());
  for (const auto& whole : wholes) {
    for (const double value : {whole.chi_bar, whole.max_slip, whole.moment}) print(value);
    std::printf("%d\n", whole.activated ? 1 : 0);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
