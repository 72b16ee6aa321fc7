// How likely does a fault slide where friction, stress and the pressure in the faults are
// uncertain?
#include <faultsim/simulation.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

int main(int argc, char** argv) try {
  const int n_cases = argc > 2 ? std::atoi(argv[2]) : 10000;
  auto field = faultsim::Simulation::from_file(
      argc > 1 ? argv[1] : "field.json", {{"/tier", "screening"}, {"fault_pressure", "fraction"}});
  field.prepare();  // the one operator of all cases

  std::mt19937 random(1);
  const auto within = [&](double low, double high, const char* unit) {
    return std::to_string(low + (high - low) * random() / 4294967296.0) + unit;
  };
  int n_slide = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < n_cases; ++i) {
    const faultsim::CaseResult result = field.run({{"friction_angle", within(20, 35, " deg")},
                                                   {"fault_pressure_fraction", within(0, 1, "")},
                                                   {"ratio_across", within(0.65, 0.85, "")}});
    n_slide += result.whole.activated;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("a fault slides in %.1f %% of %d cases; %.0f cases/s\n", 100.0 * n_slide / n_cases,
              n_cases, n_cases / took.count());

  const auto points = field.points();  // where the entries of fields lie
  double largest = -1;
  std::size_t place = 0;
  faultsim::RunWatch watch;
  watch.step = [&](const faultsim::StepResult&, const faultsim::FaultFields& fields) {
    Eigen::Index k = 0;
    const double chi = fields.critical_index.maxCoeff(&k);
    if (chi > largest) largest = chi, place = static_cast<std::size_t>(k);
  };
  field.run(faultsim::Changes(), {}, watch);
  std::printf("the scene as it is comes closest to sliding on %s at %.0f m of depth: chi %.2f\n",
              points[place].fault.c_str(), -points[place].position.z(), largest);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
