// How well operators at few values of one parameter give those in between. Arguments: SCENE TIER
// NAME SCALE UNIT FROM TO POINTER... Prints rows of results/surfaces.

#include <algorithm>
#include <cstdio>
#include <random>

#include "simulator/linalg/blas_start.h"
#include "simulator/loading/run_case.h"
#include "simulator/scene/read_scene.h"
#include "simulator/surface/sparse_grid.h"
#include "simulator/surface/surface_axis.h"

namespace faultsim {
namespace {

FaultOperator operator_at(JsonDocument document, const SurfaceAxis& axis, double x) {
  axis.set(document, x);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  if (!problems.empty()) throw InputError(axis.name, problems);
  SilentMonitor monitor;
  CondensedBulk bulk(bulk_problem(scene, plan), {}, monitor);
  return bulk.condense();
}

/// (A_i A_j)^-power on every entry.
Eigen::MatrixXd scaled(const FaultOperator& op, double power) {
  const Eigen::VectorXd d = op.geometry.dof_area.array().pow(-power);
  return d.asDiagonal() * op.h() * d.asDiagonal();
}

void study(const JsonDocument& base, const SurfaceAxis& axis) {
  constexpr int kNodes = 9, kChecks = 5;
  std::vector<FaultOperator> nodes, checks;
  for (int k = 0; k < kNodes; ++k) nodes.push_back(operator_at(base, axis, leja_point(k)));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> at;
  for (int k = 0; k < kChecks; ++k) at.push_back(uniform(random));
  for (const double x : at) checks.push_back(operator_at(base, axis, x));

  for (const double power : {0.0, 0.5, 1.0}) {
    for (const int n : {3, 5, 7, 9}) {
      SparseGrid grid(1);
      for (int k = 1; k < n; ++k) grid.add({k});
      double worst_h = 0, worst_l = 0, worst_u = 0;
      for (int c = 0; c < kChecks; ++c) {
        const Eigen::VectorXd w = grid.weights(Eigen::VectorXd::Constant(1, at[c]));
        const FaultOperator& exact = checks[c];
        Eigen::MatrixXd h = Eigen::MatrixXd::Zero(exact.h().rows(), exact.h().cols());
        Eigen::MatrixXd l = Eigen::MatrixXd::Zero(exact.loads.traction.rows(), exact.loads.traction.cols());
        Eigen::MatrixXd u = Eigen::MatrixXd::Zero(exact.observed.per_jump.rows(), exact.observed.per_jump.cols());
        for (int k = 0; k < n; ++k) {
          h += w[k] * scaled(nodes[k], power);
          l += w[k] * nodes[k].loads.traction;
          u += w[k] * nodes[k].observed.per_jump;
        }
        worst_h = std::max(worst_h, (h - scaled(exact, power)).norm() / scaled(exact, power).norm());
        for (Eigen::Index k = 0; k < l.cols(); ++k)
          worst_l = std::max(worst_l, (l.col(k) - exact.loads.traction.col(k)).norm() /
                                          exact.loads.traction.col(k).norm());
        if (u.size() > 0)
          worst_u = std::max(worst_u, (u - exact.observed.per_jump).norm() / exact.observed.per_jump.norm());
      }
      std::printf("%s power %.1f, %d operators: H %.1e, locked %.1e, observed %.1e\n",
                  axis.name.c_str(), power, n, worst_h, worst_l, worst_u);
    }
  }
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  using namespace faultsim;
  start_blas(argv);
  take_blas_buffer();
  try {
    JsonDocument base = read_json_file(argv[1]);
    set_value(base, "/tier", argv[2]);
    SurfaceAxis axis;
    axis.name = argv[3];
    axis.scale = argv[4][0] == 'l' && argv[4][1] == 'o' ? SurfaceAxis::Scale::logarithm
                 : argv[4][0] == 't'                    ? SurfaceAxis::Scale::tangent
                                                        : SurfaceAxis::Scale::linear;
    axis.unit = argv[5];
    axis.from = std::stod(argv[6]);
    axis.to = std::stod(argv[7]);
    for (int i = 8; i < argc; ++i) {
      const std::string one = argv[i];
      const auto equal = one.find('=');
      if (equal == std::string::npos) axis.pointers.push_back(one);
      else set_value(base, one.substr(0, equal), one.substr(equal + 1));
    }
    study(base, axis);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "surface_study: %s\n", error.what());
    return 70;
  }
}
