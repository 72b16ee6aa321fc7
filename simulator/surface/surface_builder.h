#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "simulator/cache/surface_file.h"
#include "simulator/common/run_context.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The exact operator at a point of [-1, 1]^d. One that lies in a mapped file costs no memory.
using ExactOperator = std::function<std::shared_ptr<const FaultOperator>(
    const Eigen::VectorXd& x, const RunContext& context)>;

/// Cases that are run on operators at check points, exact and interpolated ones
/// (/numerics/surface/probes).
struct ProbingCases {
  int n = 0;             ///< none: not asked for.
  double tolerance = 0;  ///< CaseErrors::within.
  /// The i-th case with the surface's parameters at x. @param op  there.
  std::function<CaseResult(int i, const Eigen::VectorXd& x,
                           const std::shared_ptr<const FaultOperator>& op)>
      run;
};

/// Throws InputError about the scene's surface.
[[noreturn]] void refuse_surface(const std::string& what, const std::string& cure);

/// Asks for operators until the errors at check points, which are drawn by a fixed seed, are within
/// the tolerance (docs/model.md, 12): those of operators at all of them, or those of cases at the
/// first half, after which the other half says how large they are. A pure function of the request,
/// the operators and the cases. Throws InputError where the tolerance is not reached with
/// most_operators, ResourceError where it does not fit into memory, Interrupted.
/// @param fingerprint  of the surface, which becomes its name.
StoredSurface build_surface(const SurfaceRequest& request, const std::string& fingerprint,
                            const ExactOperator& exact, const ProbingCases& cases,
                            const RunContext& context);

/// Points of the cube, none of them a node: the same for every surface of as many axes.
std::vector<Eigen::VectorXd> check_points(int n_axes, int n_points);

/// The largest relative error of a column.
double worst_column(const Eigen::MatrixXd& value, const Eigen::MatrixXd& exact);

}  // namespace faultsim
