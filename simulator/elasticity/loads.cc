#include <Eigen/Geometry>
#include <cmath>
#include <map>

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
Eigen::Matrix<double, 3, 4> nodal_area_vectors(const Mesh& mesh, const BoundaryFace& face) {
  constexpr std::array<std::array<int, 2>, 4> kCorner = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const double point = 1 / std::sqrt(3.0);
  Eigen::Matrix<double, 3, 4> result = Eigen::Matrix<double, 3, 4>::Zero();
  for (const auto& gauss : kCorner) {
    const double xi = point * gauss[0], eta = point * gauss[1];
    Eigen::Vector3d along_xi = Eigen::Vector3d::Zero(), along_eta = Eigen::Vector3d::Zero();
    Eigen::RowVector4d shape;
    for (std::size_t a = 0; a < 4; ++a) {
      const Eigen::Vector3d& x = mesh.nodes[face.nodes[a]];
      along_xi += kCorner[a][0] * (1 + kCorner[a][1] * eta) / 4 * x;
      along_eta += kCorner[a][1] * (1 + kCorner[a][0] * xi) / 4 * x;
      shape[static_cast<int>(a)] = (1 + kCorner[a][0] * xi) * (1 + kCorner[a][1] * eta) / 4;
    }
    result += along_xi.cross(along_eta) * shape;
  }
  return result;
}

}  // namespace

Eigen::VectorXd pressure_load(const Mesh& mesh, const DofMap& dofs, int region) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    if (mesh.region[cell] != region || mesh.region_fraction[cell] == 0) continue;
    const Element element = make_element(mesh, static_cast<int>(cell));
    // ∫ div v over the cell is its volume times the mean dilatation, with B-bar and without.
    const double factor = per_thickness(mesh) * element.volume * mesh.region_fraction[cell];
    for (int a = 0; a < 8; ++a) {
      forces.col(mesh.cells[cell][a]) += factor * element.mean_gradient.row(a).transpose();
    }
  }
  return gathered(dofs, forces);
}

std::vector<std::pair<int, double>> dilatation_load(const Mesh& mesh, const DofMap& dofs,
                                                    int cell) {
  const Element element = make_element(mesh, cell);
  const double volume = per_thickness(mesh) * element.volume;
  std::map<int, double> load;
  for (int a = 0; a < 8; ++a) {
    for (int c = 0; c < 3; ++c) {
      for (const DofMap::Term& term : dofs.terms(mesh.cells[cell][a], c)) {
        load[term.unknown] += term.coefficient * volume * element.mean_gradient(a, c);
      }
    }
  }
  return {load.begin(), load.end()};
}

Eigen::Matrix3Xd nodal_stress_forces(const Mesh& mesh, const std::vector<Side>& sides,
                                     const Eigen::Matrix3d& stress) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  for (const BoundaryFace& face : mesh.boundary) {
    if (!contains(sides, face.side)) continue;
    const bool is_front_or_back = face.side == Side::y_min || face.side == Side::y_max;
    if (mesh.plane_strain && is_front_or_back) continue;
    const Eigen::Matrix<double, 3, 4> areas = nodal_area_vectors(mesh, face);
    for (int a = 0; a < 4; ++a) {
      forces.col(face.nodes[a]) += per_thickness(mesh) * stress * areas.col(a);
    }
  }
  return forces;
}

Eigen::VectorXd stress_load(const Mesh& mesh, const DofMap& dofs, const std::vector<Side>& sides,
                            const Eigen::Matrix3d& stress) {
  return gathered(dofs, nodal_stress_forces(mesh, sides, stress));
}

Eigen::VectorXd displacement_load(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                                  const DofMap& dofs, int load, bool b_bar) {
  Eigen::Matrix3Xd forces = no_forces(mesh);
  if (!dofs.has_prescribed(load)) return gathered(dofs, forces);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    Eigen::Matrix<double, 24, 1> prescribed;
    for (int p = 0; p < 24; ++p) {
      const int node = mesh.cells[cell][p / 3];
      prescribed[p] = dofs.prescribed(load, node, p % 3);
    }
    if (prescribed.isZero(0)) continue;
    const auto& material = materials.at(mesh.material[cell]);
    const Element element = make_element(mesh, static_cast<int>(cell));
    const Eigen::Matrix<double, 24, 1> force =
        element_stiffness(element, material, b_bar) * prescribed;
    for (Eigen::Index a = 0; a < 8; ++a) {
      forces.col(mesh.cells[cell][a]) -= per_thickness(mesh) * force.segment<3>(3 * a);
    }
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
