#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/loading/run_case.h"
#include "simulator/surface/operator_values.h"
#include "simulator/surface/sparse_grid.h"
#include "simulator/surface/surface_axis.h"

namespace faultsim {

/// The operators of all scenes that differ in the parameters of /numerics/surface alone
/// (docs/model.md, 12): H, L, U and V interpolated on a sparse grid of exact operators,
///
///   y(θ) = y_0 + Σ_k c_k(θ) B_k,      c(θ) = Vᵀ w(θ),
///
/// w the weights of the nodes, B = D V the leading directions of D = [y_i − y_0] (method of
/// snapshots; Sirovich 1987). Positions, frames, areas and pressure shares of a sample are those of
/// its own mesh. A pure function of the scene's family: whatever case asks for it first, and
/// whatever is in the cache, it has the same bits.
class OperatorSurface {
 public:
  /// Reads or builds the operators of the nodes, which go to the cache as any other, until the
  /// errors at check points, which are drawn by a fixed seed, are within the tolerance. Throws
  /// InputError where it is not reached with most_operators, or where the mesh changes its topology
  /// over the ranges; ResourceError where the nodes do not fit into memory; Interrupted.
  /// @pre scene.numerics.surface.wanted()
  OperatorSurface(const Scene& scene, const CachePolicy& cache, const RunContext& context);
  ~OperatorSurface();

  /// The operator of a scene of the surface's family. Throws InputError where its mesh has another
  /// topology, or its H is not positive definite.
  /// @param plan  of the scene.
  PreparedOperator at(const Scene& scene, const Plan& plan) const;

  const CaseSurface& accuracy() const { return accuracy_; }

 private:
  struct Frame;  ///< mesh and unknowns of the centre.
  Scene scene_at(const Eigen::VectorXd& x) const;
  PreparedOperator exact_at(const Eigen::VectorXd& x, const CachePolicy& cache,
                            const RunContext& context) const;
  FaultGeometry geometry_of(const Scene& scene, const Plan& plan) const;
  void compress(const std::vector<Eigen::VectorXd>& values, double tolerance);
  FaultOperator interpolated(const Eigen::VectorXd& x) const;
  void measure(const std::vector<Eigen::VectorXd>& points,
               const std::vector<std::shared_ptr<const FaultOperator>>& exact);

  Scene centre_;  ///< exact: without a surface.
  SurfaceRequest request_;
  std::vector<SurfaceAxis> axes_;
  std::unique_ptr<Frame> frame_;
  std::shared_ptr<const FaultOperator> centre_operator_;
  std::unique_ptr<OperatorValues> values_;
  SparseGrid grid_;
  Eigen::VectorXd mean_;     ///< y_0.
  Eigen::MatrixXd basis_;    ///< B.
  Eigen::MatrixXd weights_;  ///< Vᵀ, of the nodes but the centre.
  CaseSurface accuracy_;
  bool all_from_cache_ = true;
};

/// A coordinate of a scene on each axis, [-1, 1].
Eigen::VectorXd surface_coordinates(const std::vector<SurfaceAxis>& axes,
                                    const SurfaceRequest& request, const Scene& scene);
/// The axes of a request.
std::vector<SurfaceAxis> surface_axes(const SurfaceRequest& request, const Scene& scene);

}  // namespace faultsim
