#include "tests/unit/elasticity/test_box.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace faultsim::test {
namespace {

class BoxMaker {
 public:
  BoxMaker(const std::array<int, 3>& n, const Eigen::Vector3d& size, const Mapping& map) : n_(n) {
    for (int k = 0; k <= n[2]; ++k) {
      for (int j = 0; j <= n[1]; ++j) {
        for (int i = 0; i <= n[0]; ++i) {
          const Eigen::Vector3d x(size.x() * i / n[0], size.y() * j / n[1],
                                  size.z() * k / n[2] - size.z());
          mesh_.nodes.push_back(map ? map(x) : x);
        }
      }
    }
  }

  void split(const Split& s) {
    FaultSurface fault;
    fault.name = "fault_" + std::to_string(mesh_.faults.size());
    for (int j = s.j1; j >= s.j0; --j) {
      for (int k = s.k1; k >= s.k0; --k) {
        const bool inside_j = (j > s.j0 || j == 0) && (j < s.j1 || j == n_[1]);
        const bool inside_k = (k > s.k0 || k == 0) && (k < s.k1 || k == n_[2]);
        fault.points.push_back(at(s.i, j, k));
        fault.node_of_point.push_back(inside_j && inside_k ? static_cast<int>(fault.nodes.size())
                                                           : -1);
        if (!(inside_j && inside_k)) continue;
        plus_[id(s.i, j, k)] = static_cast<int>(mesh_.nodes.size());
        mesh_.nodes.push_back(at(s.i, j, k));
        FaultNode node;
        node.minus_node = id(s.i, j, k);
        node.plus_node = plus_[node.minus_node];
        node.normal = (at(s.i, 1, 0) - at(s.i, 0, 0)).cross(at(s.i, 0, 1) - at(s.i, 0, 0));
        node.normal.normalize();
        node.strike = node.normal.cross(Eigen::Vector3d::UnitZ()).normalized();
        node.dip = node.normal.cross(node.strike);
        node.area = 0;
        fault.nodes.push_back(node);
      }
    }
    add_faces(s, fault);
    mesh_.faults.push_back(fault);
  }

  Mesh finish() {
    for (int k = 0; k < n_[2]; ++k) {
      for (int j = 0; j < n_[1]; ++j) {
        for (int i = 0; i < n_[0]; ++i) add_cell(i, j, k);
      }
    }
    mesh_.material.assign(mesh_.cells.size(), 0);
    mesh_.region.assign(mesh_.cells.size(), -1);
    mesh_.region_fraction.assign(mesh_.cells.size(), 0);
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
      mesh_.tied_to.push_back(static_cast<int>(i));
    }
    share_pairs(mesh_);
    return std::move(mesh_);
  }

 private:
  int id(int i, int j, int k) const { return i + (n_[0] + 1) * (j + (n_[1] + 1) * k); }
  int cell(int i, int j, int k) const { return i + n_[0] * (j + n_[1] * k); }
  const Eigen::Vector3d& at(int i, int j, int k) const {
    return mesh_.nodes[static_cast<std::size_t>(id(i, j, k))];
  }

  void add_faces(const Split& s, FaultSurface& fault) {
    for (int j = s.j1 - 1; j >= s.j0; --j) {
      for (int k = s.k1 - 1; k >= s.k0; --k) {
        FaultFace face;
        const int column = s.j1 - 1 - j, row = s.k1 - 1 - k;
        const int n_rows = s.k1 - s.k0 + 1, first = column * n_rows + row;
        face.points = {first, first + 1, first + n_rows + 1, first + n_rows};
        face.area = 0.5 * (at(s.i, j + 1, k + 1) - at(s.i, j, k))
                              .cross(at(s.i, j + 1, k) - at(s.i, j, k + 1))
                              .norm();
        face.minus_cell = cell(s.i - 1, j, k);
        face.plus_cell = cell(s.i, j, k);
        for (std::size_t a = 0; a < 4; ++a) {
          face.nodes[a] = fault.node_of_point[static_cast<std::size_t>(face.points[a])];
          if (face.nodes[a] < 0) continue;
          fault.nodes[static_cast<std::size_t>(face.nodes[a])].area += face.area / 4;
        }
        fault.faces.push_back(face);
      }
    }
  }

  void add_cell(int i, int j, int k) {
    const auto corner = [&](int di, int dj, int dk) {
      const int node = id(i + di, j + dj, k + dk);
      const auto plus = plus_.find(node);
      return di == 0 && plus != plus_.end() ? plus->second : node;
    };
    const std::array<int, 8> c = {corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0),
                                  corner(0, 1, 0), corner(0, 0, 1), corner(1, 0, 1),
                                  corner(1, 1, 1), corner(0, 1, 1)};
    const int index = static_cast<int>(mesh_.cells.size());
    mesh_.cells.add(c);
    const auto face = [&](Side side, std::size_t p, std::size_t q, std::size_t r, std::size_t s) {
      mesh_.boundary.push_back({index, side, {c[p], c[q], c[r], c[s], -1, -1}});
    };
    if (i == 0) face(Side::x_min, 0, 4, 7, 3);
    if (i == n_[0] - 1) face(Side::x_max, 1, 2, 6, 5);
    if (j == 0) face(Side::y_min, 0, 1, 5, 4);
    if (j == n_[1] - 1) face(Side::y_max, 3, 7, 6, 2);
    if (k == 0) face(Side::z_min, 0, 3, 2, 1);
    if (k == n_[2] - 1) face(Side::z_max, 4, 5, 6, 7);
  }

  std::array<int, 3> n_;
  Mesh mesh_;
  std::map<int, int> plus_;
};

}  // namespace

Mesh make_box(const std::array<int, 3>& n, const Eigen::Vector3d& size,
              const std::vector<Split>& splits, const Mapping& map) {
  BoxMaker maker(n, size, map);
  for (const Split& split : splits) maker.split(split);
  return maker.finish();
}

Split through(int i, const std::array<int, 3>& n) { return {i, 0, n[1], 0, n[2]}; }

Mapping shear_to_dip(double dip_degrees) {
  const double cot = 1 / std::tan(dip_degrees * std::acos(-1.0) / 180);
  return [cot](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(x.x() + x.z() * cot, x.y(), x.z());
  };
}

void distort(Mesh& mesh, double smallest_edge, double share) {
  std::vector<char> keep(mesh.nodes.size(), 0);
  for (const FaultSurface& fault : mesh.faults) {
    for (const Eigen::Vector3d& x : fault.points) {
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        if ((mesh.nodes[i] - x).norm() < 1e-9 * smallest_edge) keep[i] = 1;
      }
    }
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (keep[i]) continue;
    for (int c = 0; c < 3; ++c) mesh.nodes[i][c] += share * smallest_edge * uniform(random);
  }
}

void swap_sides(Mesh& mesh) {
  for (FaultSurface& fault : mesh.faults) {
    for (FaultNode& node : fault.nodes) {
      std::swap(node.minus_node, node.plus_node);
      node.normal = -node.normal;
      node.strike = -node.strike;
    }
    for (FaultFace& face : fault.faces) std::swap(face.minus_cell, face.plus_cell);
  }
  share_pairs(mesh);
}

void make_plane_strain(Mesh& mesh, double thickness) {
  mesh.plane_strain = true;
  mesh.thickness = thickness;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].y() < thickness / 2) continue;
    for (std::size_t c = 0; c < mesh.cells.size();
         ++c) {  // corner pairs (0,3), (1,2), (4,7), (5,6) lie along y
      const auto cell = mesh.cells[c];
      for (const auto& [front, back] : {std::pair(0, 3), {1, 2}, {4, 7}, {5, 6}}) {
        if (cell[static_cast<std::size_t>(back)] == static_cast<int>(i)) {
          mesh.tied_to[i] = cell[static_cast<std::size_t>(front)];
        }
      }
    }
  }
  for (FaultSurface& fault : mesh.faults) {
    std::vector<FaultNode> merged;
    std::vector<int> number;
    for (FaultNode node : fault.nodes) {
      node.minus_node = mesh.tied_to[static_cast<std::size_t>(node.minus_node)];
      node.plus_node = mesh.tied_to[static_cast<std::size_t>(node.plus_node)];
      node.area /= thickness;
      const auto same = std::find_if(merged.begin(), merged.end(), [&](const FaultNode& other) {
        return other.minus_node == node.minus_node;
      });
      number.push_back(static_cast<int>(same - merged.begin()));
      if (same == merged.end()) {
        merged.push_back(node);
      } else {
        same->area += node.area;
      }
    }
    fault.nodes = merged;
    for (int& node : fault.node_of_point)
      node = node < 0 ? -1 : number[static_cast<std::size_t>(node)];
    for (FaultFace& face : fault.faces) {
      face.area /= thickness;
      for (int& node : face.nodes) node = node < 0 ? -1 : number[static_cast<std::size_t>(node)];
    }
  }
  share_pairs(mesh);
}

std::vector<DisplacementCondition> rollers(const std::vector<BoundaryGroup>& sides) {
  std::vector<DisplacementCondition> conditions;
  for (const BoundaryGroup side : sides) {
    DisplacementCondition condition{
        side, {false, false, false}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1};
    condition.components[static_cast<std::size_t>(side.index) / 2] = true;
    conditions.push_back(condition);
  }
  return conditions;
}

std::vector<DisplacementCondition> affine(const Eigen::Vector3d& translation,
                                          const Eigen::Matrix3d& gradient) {
  std::vector<DisplacementCondition> conditions;
  for (const BoundaryGroup side : all_sides()) {
    conditions.push_back({side, {true, true, true}, translation, gradient, 0});
  }
  return conditions;
}

std::vector<BoundaryGroup> all_sides() {
  return {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min, Side::z_max};
}

Mesh without_faults(Mesh mesh) {
  mesh.faults.clear();
  mesh.copies.clear();
  return mesh;
}

Eigen::VectorXd solve(const SparseMatrix& lower, const Eigen::VectorXd& f) {
  return Eigen::SimplicialLDLT<SparseMatrix>(lower).solve(f);
}

}  // namespace faultsim::test
