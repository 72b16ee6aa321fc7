#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <span>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/elasticity/element.h"

namespace faultsim {
namespace {

double per_thickness(const Mesh& mesh) { return mesh.plane_strain ? 1 / mesh.thickness : 1; }

/// Pᵀ F.
Eigen::VectorXd gathered(const DofMap& dofs, const Eigen::Matrix3Xd& forces) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(dofs.n_unknowns());
  for (Eigen::Index node = 0; node < forces.cols(); ++node) {
    for (int c = 0; c < 3; ++c) {
      for (const DofMap::Term& term : dofs.terms(static_cast<int>(node), c)) {
        f[term.unknown] += term.coefficient * forces(c, node);
      }
    }
  }
  return f;
}

Eigen::Matrix3Xd no_forces(const Mesh& mesh) {
  return Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(mesh.nodes.size()));
}

/// ∫ N_a n dA of a bilinear face, 3 x 4, by 2x2 Gauss points (exact).
Eigen::Matrix<double, 3, 4> bilinear_area_vectors(const Mesh& mesh, std::span<const int> nodes) {
  constexpr std::array<std::array<int, 2>, 4> kCorner = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double point = 1 / std::sqrt(3.0);
  Eigen::Matrix<double, 3, 4> result = Eigen::Matrix<double, 3, 4>::Zero();
  for (const auto& gauss : kCorner) {
    const double xi = point * gauss[0], eta = point * gauss[1];
    Eigen::Vector3d along_xi = Eigen::Vector3d::Zero(), along_eta = Eigen::Vector3d::Zero();
    Eigen::RowVector4d shape;
    for (std::size_t a = 0; a < 4; ++a) {
      const Eigen::Vector3d& x = mesh.nodes[nodes[a]];
      along_xi += kCorner[a][0] * (1 + kCorner[a][1] * eta) / 4 * x;
      along_eta += kCorner[a][1] * (1 + kCorner[a][0] * xi) / 4 * x;
      shape[static_cast<int>(a)] = (1 + kCorner[a][0] * xi) * (1 + kCorner[a][1] * eta) / 4;
    }
    result += along_xi.cross(along_eta) * shape;
  }
  return result;
}

/// The same of a face: of a flat quadratic triangle a third of it at each middle of a side.
Eigen::Matrix3Xd nodal_area_vectors(const Mesh& mesh, const BoundaryFace& face) {
  const std::span<const int> nodes = face.nodes();
  if (nodes.size() == 4) return bilinear_area_vectors(mesh, nodes);
  const Eigen::Vector3d &a = mesh.nodes[nodes[0]], &b = mesh.nodes[nodes[1]],
                        &c = mesh.nodes[nodes[2]];
  Eigen::Matrix3Xd result = Eigen::Matrix3Xd::Zero(3, 6);
  result.rightCols<3>().colwise() = (b - a).cross(c - a) / 6;
  return result;
}

}  // namespace

Eigen::VectorXd pressure_load(const Mesh& mesh, const DofMap& dofs, int region) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    if (mesh.region[cell] != region || mesh.region_fraction[cell] == 0) continue;
    const std::span<const int> nodes = mesh.cells[cell];
    with_element(mesh, static_cast<int>(cell), [&](const auto& element) {
      // ∫ div v over the cell is its volume times the mean dilatation, with B-bar and without.
      const double factor = per_thickness(mesh) * element.volume * mesh.region_fraction[cell];
      for (int a = 0; a < element.kNodes; ++a)
        forces.col(nodes[a]) += factor * element.mean_gradient.row(a).transpose();
    });
  }
  return gathered(dofs, forces);
}

std::vector<std::pair<int, double>> dilatation_load(const Mesh& mesh, const DofMap& dofs,
                                                    int cell) {
  const std::span<const int> nodes = mesh.cells[cell];
  std::map<int, double> load;
  with_element(mesh, cell, [&](const auto& element) {
    const double volume = per_thickness(mesh) * element.volume;
    for (int a = 0; a < element.kNodes; ++a) {
      for (int c = 0; c < 3; ++c) {
        for (const DofMap::Term& term : dofs.terms(nodes[a], c))
          load[term.unknown] += term.coefficient * volume * element.mean_gradient(a, c);
      }
    }
  });
  return {load.begin(), load.end()};
}

Eigen::Matrix3Xd nodal_stress_forces(const Mesh& mesh, const std::vector<BoundaryGroup>& groups,
                                     const Eigen::Matrix3d& stress) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  for (const BoundaryFace& face : mesh.boundary) {
    if (!contains(groups, face.group)) continue;
    const bool is_front_or_back = face.group == Side::y_min || face.group == Side::y_max;
    if (mesh.plane_strain && is_front_or_back) continue;
    const Eigen::Matrix3Xd areas = nodal_area_vectors(mesh, face);
    const std::span<const int> nodes = face.nodes();
    for (Eigen::Index a = 0; a < areas.cols(); ++a)
      forces.col(nodes[a]) += per_thickness(mesh) * stress * areas.col(a);
  }
  return forces;
}

Eigen::VectorXd stress_load(const Mesh& mesh, const DofMap& dofs,
                            const std::vector<BoundaryGroup>& groups,
                            const Eigen::Matrix3d& stress) {
  return gathered(dofs, nodal_stress_forces(mesh, groups, stress));
}

Eigen::VectorXd displacement_load(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                                  const DofMap& dofs, int load, bool mean_dilatation) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  if (!dofs.has_prescribed(load)) return gathered(dofs, forces);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const std::span<const int> nodes = mesh.cells[cell];
    Eigen::VectorXd prescribed(3 * std::ssize(nodes));
    for (int p = 0; p < prescribed.size(); ++p)
      prescribed[p] = dofs.prescribed(load, nodes[p / 3], p % 3);
    if (prescribed.isZero(0)) continue;
    const auto& material = materials.at(mesh.material[cell]);
    with_element(mesh, static_cast<int>(cell), [&](const auto& element) {
      const Eigen::VectorXd force =
          element_stiffness(element, material, mean_dilatation) * prescribed;
      for (Eigen::Index a = 0; a < element.kNodes; ++a)
        forces.col(nodes[a]) -= per_thickness(mesh) * force.segment<3>(3 * a);
    });
  }
  return gathered(dofs, forces);
}

Eigen::Matrix3Xd nodal_displacement(const Mesh& mesh, const DofMap& dofs, const Eigen::VectorXd& x,
                                    const std::vector<double>& load_factors) {
  FAULTSIM_DEMAND(x.size() == dofs.n_unknowns(), x.size(), " of ", dofs.n_unknowns());
  Eigen::Matrix3Xd u = no_forces(mesh);
  for (Eigen::Index node = 0; node < u.cols(); ++node) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (const DofMap::Term& term : dofs.terms(static_cast<int>(node), c)) {
        sum += term.coefficient * x[term.unknown];
      }
      for (std::size_t k = 0; k < load_factors.size(); ++k) {
        const int load = static_cast<int>(k);
        if (load_factors[k] == 0 || !dofs.has_prescribed(load)) continue;
        sum += load_factors[k] * dofs.prescribed(load, static_cast<int>(node), c);
      }
      u(c, node) = sum;
    }
  }
  return u;
}

}  // namespace faultsim
