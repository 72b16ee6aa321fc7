// How well operators at few values of one parameter give those in between. Prints a row of the
// table of results/surfaces: for 3, 5, 7 and 9 operators the largest error over random values, of H
// / of the worst locked traction, relative to their norms (Frobenius, Euclid).

#include <algorithm>
#include <cstdio>
#include <random>

#include "simulator/linalg/blas_start.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/surface/sparse_grid.h"
#include "simulator/surface/surface_axis.h"

namespace faultsim {
namespace {

constexpr int kNodes = 9, kChecks = 5;

/// An axis, and what its value sets in a scene document.
struct StudiedAxis : SurfaceAxis {
  std::string name, unit;  ///< SI; "" = a number.
  std::vector<std::string> pointers = {};
};

FaultOperator operator_at(JsonDocument document, const StudiedAxis& axis, double x) {
  char text[64];
  std::snprintf(text, sizeof text, axis.unit.empty() ? "%.15g" : "%.15g %s", axis.value(x),
                axis.unit.c_str());
  for (const std::string& pointer : axis.pointers) set_value(document, pointer, text);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  if (!problems.empty()) throw InputError(axis.name, problems);
  SilentMonitor monitor;
  CondensedBulk bulk(bulk_problem(scene, plan), monitor);
  return bulk.condense();
}

struct Errors {
  double h = 0, locked = 0;
};

/// Of the first n nodes at x, against the exact operator.
Errors errors_of(const std::vector<FaultOperator>& nodes, int n, double x,
                 const FaultOperator& exact) {
  SparseGrid grid(1);
  for (int k = 1; k < n; ++k) grid.add({k});
  const Eigen::VectorXd w = grid.weights(Eigen::VectorXd::Constant(1, x));
  Eigen::MatrixXd h = -exact.h(), locked = -exact.loads.traction;
  for (int k = 0; k < n; ++k) {
    h += w[k] * nodes[k].h();
    locked += w[k] * nodes[k].loads.traction;
  }
  const auto relative =
      locked.colwise().norm().array() / exact.loads.traction.colwise().norm().array();
  return {h.norm() / exact.h().norm(), relative.maxCoeff()};
}

void study(const JsonDocument& base, const StudiedAxis& axis) {
  std::vector<FaultOperator> nodes;
  for (int k = 0; k < kNodes; ++k) nodes.push_back(operator_at(base, axis, leja_point(k)));
  std::vector<Errors> worst(4);
  std::mt19937 random(7);
  for (int check = 0; check < kChecks; ++check) {
    const double x = -1 + 2 * (static_cast<double>(random()) / 4294967296.0);
    const FaultOperator exact = operator_at(base, axis, x);
    for (int k = 0; k < 4; ++k) {
      const Errors one = errors_of(nodes, 3 + 2 * k, x, exact);
      worst[k] = {std::max(worst[k].h, one.h), std::max(worst[k].locked, one.locked)};
    }
  }
  std::printf("| %s |", axis.name.c_str());
  for (const Errors& one : worst) std::printf(" %.0e / %.0e |", one.h, one.locked);
  std::printf("\n");
}

/// SCENE TIER NAME SCALE UNIT FROM TO POINTER... [POINTER=VALUE...]
void run(int argc, char** argv) {
  JsonDocument base = read_json_file(argv[1]);
  set_value(base, "/tier", argv[2]);
  const std::string scale = argv[4];
  StudiedAxis axis{{std::stod(argv[6]), std::stod(argv[7])}, argv[3], argv[5]};
  if (scale == "logarithm") axis.scale = SurfaceAxis::Scale::logarithm;
  if (scale == "tangent") axis.scale = SurfaceAxis::Scale::tangent;
  for (int i = 8; i < argc; ++i) {
    const std::string one = argv[i];
    const std::size_t equal = one.find('=');
    if (equal == std::string::npos) {
      axis.pointers.push_back(one);
    } else {
      set_value(base, one.substr(0, equal), one.substr(equal + 1));
    }
  }
  study(base, axis);
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  faultsim::start_blas(argv);
  faultsim::take_blas_buffer();
  if (argc < 9) {
    std::fprintf(stderr,
                 "usage: surface_study SCENE TIER NAME linear|logarithm|tangent UNIT FROM TO "
                 "POINTER... [POINTER=VALUE...]\n");
    return 2;
  }
  try {
    faultsim::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surface_study: %s\n", error.what());
    return 70;
  }
}
