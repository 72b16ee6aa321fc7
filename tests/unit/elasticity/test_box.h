#pragma once

#include <functional>
#include <vector>

#include "simulator/elasticity/elasticity.h"

namespace faultsim::test {

/// A fault on the grid plane x = i·dx of a test box: the patch of cells [j0, j1) x [k0, k1).
/// Nodes on the patch's rim are split only where the rim is on the outside of the box.
struct Split {
  int i, j0, j1, k0, k1;
};

using Mapping = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Box [0, size.x] x [0, size.y] x [-size.z, 0] of n cells, split, then mapped. Material 0, no
/// pressure region. Minus is the side of smaller x.
Mesh make_box(const std::array<int, 3>& n, const Eigen::Vector3d& size,
              const std::vector<Split>& splits, const Mapping& map = nullptr);

/// A split through the whole box.
Split through(int i, const std::array<int, 3>& n);

/// x ← x + z cot(dip): planes x = const then dip that way (seen from above towards -x).
Mapping shear_to_dip(double dip_degrees);

/// Moves nodes that are off the faults by up to `share` of the smallest cell edge (outside too).
void distort(Mesh& mesh, double smallest_edge, double share);

/// Exchanges the sides of all faults: n and strike turn round, dip stays.
void swap_sides(Mesh& mesh);

/// Front and back of a mesh of one cell in y become one: plane strain.
void make_plane_strain(Mesh& mesh, double thickness);

/// u_n = 0 on each side given.
std::vector<DisplacementCondition> rollers(const std::vector<BoundaryGroup>& sides);

/// Prescribes u = translation + gradient x on all sides for load 0.
std::vector<DisplacementCondition> affine(const Eigen::Vector3d& translation,
                                          const Eigen::Matrix3d& gradient);

std::vector<BoundaryGroup> all_sides();

/// Solves K u = f, given K's lower triangle.
Eigen::VectorXd solve(const SparseMatrix& lower, const Eigen::VectorXd& f);

/// The same mesh without faults: both copies of a node are independent.
Mesh without_faults(Mesh mesh);

}  // namespace faultsim::test
