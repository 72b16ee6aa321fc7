#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "simulator/cache/surface_file.h"
#include "simulator/common/run_context.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The exact operator at a point of [-1, 1]^d. One that lies in a mapped file costs no memory.
using ExactOperator = std::function<std::shared_ptr<const FaultOperator>(const Eigen::VectorXd& x)>;

/// Throws InputError about the scene's surface.
[[noreturn]] void refuse_surface(const std::string& what, const std::string& cure);

/// Asks for operators until the errors at check points, which are drawn by a fixed seed, are within
/// the tolerance (docs/model.md, 12). A pure function of the request and the operators. Throws
/// InputError where the tolerance is not reached with most_operators, ResourceError where it does
/// not fit into memory, Interrupted.
/// @param fingerprint  of the surface, which becomes its name.
StoredSurface build_surface(const SurfaceRequest& request, const std::string& fingerprint,
                            const ExactOperator& exact, const RunContext& context);

/// Points of the cube, none of them a node: the same for every surface of as many axes.
std::vector<Eigen::VectorXd> check_points(int n_axes, int n_points);

/// The largest relative error of a column.
double worst_column(const Eigen::MatrixXd& value, const Eigen::MatrixXd& exact);

}  // namespace faultsim
