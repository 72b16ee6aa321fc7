#include "simulator/elasticity/rigid_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <span>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/errors.h"

namespace faultsim {
namespace {

// Squares: a motion counts as free when what holds it is 1e-6 of what holds the best held one.
constexpr double kFree = 1e-12;

}  // namespace

Pieces find_pieces(const Mesh& mesh) {
  DisjointSets sets(mesh.nodes.size());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const std::span<const int> nodes = mesh.cells[cell];
    for (const int node : nodes) sets.join(nodes[0], node);
  }
  for (std::size_t i = 0; i < mesh.tied_to.size(); ++i) {
    sets.join(static_cast<int>(i), mesh.tied_to[i]);
  }
  Pieces pieces;
  std::vector<int> number(mesh.nodes.size(), -1);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    int& piece = number[sets.find(mesh.cells[cell][0])];
    if (piece < 0) {
      piece = pieces.n_pieces++;
      pieces.n_cells.push_back(0);
    }
    ++pieces.n_cells[piece];
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    pieces.of_node.push_back(number[sets.find(static_cast<int>(i))]);
    FAULTSIM_DEMAND(pieces.of_node.back() >= 0, "node ", i, " belongs to no cell");
  }
  DisjointSets bodies(static_cast<std::size_t>(pieces.n_pieces));
  for (const FaultSurface& fault : mesh.faults) {
    for (const FaultNode& node : fault.nodes) {
      bodies.join(pieces.of_node[node.minus_node], pieces.of_node[node.plus_node]);
    }
  }
  pieces.body.assign(static_cast<std::size_t>(pieces.n_pieces), -1);
  for (int p = 0; p < pieces.n_pieces; ++p) {
    const int first = bodies.find(p);  // the lowest of its body
    pieces.body[p] = first == p ? pieces.n_bodies++ : pieces.body[first];
  }
  return pieces;
}

Eigen::AlignedBox3d extent_of(const Mesh& mesh, const std::function<bool(int)>& member) {
  Eigen::AlignedBox3d extent;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if (member(i)) extent.extend(mesh.nodes[i]);
  }
  return extent;
}

Eigen::Matrix<double, 3, 6> RigidModes::at(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d r = (x - centre) / size;
  Eigen::Matrix<double, 3, 6> u;
  u << 1, 0, 0, 0, r.z(), -r.y(),  //
      0, 1, 0, -r.z(), 0, r.x(),   //
      0, 0, 1, r.y(), -r.x(), 0;
  return u;
}

RigidModes rigid_modes(const Mesh& mesh, const std::function<bool(int)>& member,
                       const std::function<bool(int, int)>& is_fixed) {
  const Eigen::AlignedBox3d extent = extent_of(mesh, member);
  FAULTSIM_DEMAND(!extent.isEmpty(), "no nodes");
  RigidModes modes;
  modes.centre = extent.center();
  modes.size = 0.5 * extent.diagonal().norm();
  const int n_nodes = static_cast<int>(mesh.nodes.size());
  Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Zero();
  const auto hold = [&held](const Eigen::Matrix<double, 1, 6>& row) {
    held += row.transpose() * row;
  };
  for (int i = 0; i < n_nodes; ++i) {
    if (!member(i)) continue;
    const Eigen::Matrix<double, 3, 6> u = modes.at(mesh.nodes[i]);
    for (int c = 0; c < 3; ++c) {
      if (is_fixed(i, c) || (mesh.plane_strain && c == 1)) hold(u.row(c));
    }
    const int root = mesh.tied_to.empty() ? i : mesh.tied_to[i];
    if (root == i) continue;
    const Eigen::Matrix<double, 3, 6> difference = u - modes.at(mesh.nodes[root]);
    for (int c = 0; c < 3; ++c) hold(difference.row(c));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(held);
  const double limit = kFree * eigen.eigenvalues()[5];
  int n_free = 0;  // the eigenvalues ascend
  while (n_free < 6 && eigen.eigenvalues()[n_free] <= limit) ++n_free;
  modes.free = eigen.eigenvectors().leftCols(n_free);
  return modes;
}

std::string describe(const RigidModes& modes) {
  static const std::array<const char*, 6> kNames = {"move along x", "move along y", "move along z",
                                                    "turn about x", "turn about y", "turn about z"};
  if (modes.free.cols() == 0) return "";
  std::string text;
  int n_named = 0;
  for (int m = 0; m < 6; ++m) {
    if (modes.free.row(m).norm() < 0.999) continue;  // not free by itself
    text += (n_named++ == 0 ? "" : ", ") + std::string(kNames[m]);
  }
  if (n_named < modes.free.cols()) text += n_named == 0 ? "turn" : ", turn about some point";
  return text;
}

}  // namespace faultsim
