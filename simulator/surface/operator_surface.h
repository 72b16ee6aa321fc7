#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/cache/surface_file.h"
#include "simulator/loading/run_case.h"
#include "simulator/surface/case_runner.h"
#include "simulator/surface/sparse_grid.h"
#include "simulator/surface/surface_axis.h"

namespace faultsim {

/// The operators of all scenes that differ in the parameters of /numerics/surface alone
/// (docs/model.md, 12): H, L, U and V interpolated on a sparse grid of exact operators and
/// compressed (OperatorBasis). Positions, frames, areas and pressure shares of a sample are those
/// of its own mesh. Observation points take the nearest nodes in the middle of the ranges, and
/// stay with them as the mesh moves. A pure function of the scene's family: whatever case asks for
/// it first, and whatever is in the cache, it has the same bits.
class OperatorSurface {
 public:
  /// Reads the surface from the cache, where processes share it, or builds it and keeps it there;
  /// the operators of its nodes go to the cache as any other. Throws InputError where the tolerance
  /// is not reached with most_operators, or where the mesh changes its topology over the ranges;
  /// ResourceError where it does not fit into memory; Interrupted. A cache that cannot be written
  /// is a remark.
  /// @param plan  of the scene.
  /// @param cases  none unless scene.numerics.surface.probes.
  /// @pre scene.numerics.surface.wanted()
  OperatorSurface(const Scene& scene, const Plan& plan, const ProbingScenes& cases,
                  const CachePolicy& cache, const RunContext& context);
  ~OperatorSurface();

  /// The operator of a scene of the surface's family, whose H is summed up as columns are asked
  /// for: see require_definite(). Throws InputError where its mesh has another topology.
  /// @param plan  of the scene.
  PreparedOperator at(const Scene& scene, const Plan& plan) const;

  int n_nodes() const { return grid_.n_nodes(); }
  /// The exact scene at a node of the grid, 0 being the centre, and at all check points.
  Scene node_scene(int node) const { return scene_at(grid_.node(node)); }
  std::vector<Scene> check_scenes() const;
  /// w of a scene of the family, an entry per node: a value there is Σ_k w_k value_k.
  Eigen::VectorXd weights(const Scene& scene) const;
  /// The bulk problem of such a scene: the centre's, unless the mesh moves.
  std::shared_ptr<const BulkProblem> problem_of(const Scene& scene, const Plan& plan) const;

  bool from_cache() const { return from_cache_; }
  const std::string& remark() const { return remark_; }  ///< "not kept", ...

 private:
  struct Frame;  ///< mesh and unknowns of the centre.
  Scene scene_at(const Eigen::VectorXd& x) const;
  void build(const std::string& name, const ProbingScenes& cases, const CachePolicy& cache,
             const RunContext& context);
  std::shared_ptr<const FaultOperator> exact_at(const Eigen::VectorXd& x, const CachePolicy& cache,
                                                const RunContext& context) const;
  Mesh moved_mesh(const Scene& scene, const Plan& plan) const;
  void move_points(const Mesh& mesh, Scene& scene) const;
  void put_geometry(Scene scene, const Plan& plan, FaultOperator& op) const;

  Scene centre_;  ///< exact: without a surface.
  SurfaceRequest request_;
  std::vector<SurfaceAxis> axes_;
  std::shared_ptr<const Frame> frame_;
  StoredSurface surface_;
  SparseGrid grid_;
  bool from_cache_ = false;
  std::string remark_;
};

/// Throws InputError unless H of an interpolated operator is positive definite over the jumps
/// listed, which is looked at where it was used: of those that moved in a case.
void require_definite(const FaultOperator& op, const std::vector<int>& dofs);

Scene without_surface(Scene scene);

}  // namespace faultsim
