#include "simulator/elasticity/creep.h"

#include <cmath>
#include <span>
#include <type_traits>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Deviator of the symmetric gradient of u at a Gauss point: xx yy zz xy yz xz.
template <int Nodes>
Eigen::Matrix<double, 6, 1> strain_deviator(const Eigen::Matrix<double, 3, Nodes>& u,
                                            const Eigen::Matrix<double, Nodes, 3>& gradient) {
  const Eigen::Matrix3d g = u * gradient;
  const double mean = g.trace() / 3;
  Eigen::Matrix<double, 6, 1> e;
  e << g(0, 0) - mean, g(1, 1) - mean, g(2, 2) - mean, (g(0, 1) + g(1, 0)) / 2,
      (g(1, 2) + g(2, 1)) / 2, (g(0, 2) + g(2, 0)) / 2;
  return e;
}

Eigen::Matrix3d tensor(const Eigen::Matrix<double, 6, 1>& s) {
  Eigen::Matrix3d t;
  t << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return t;
}

/// Advances the deviators s of a cell at its Gauss points (6 x points); returns ∫ s ∇N (3 x nodes).
/// @param stiffness  Pa, of the strain's deviator over the step.
template <int Nodes, int Points>
Eigen::Matrix<double, 3, Nodes> advance_cell(const CellElement<Nodes, Points>& element,
                                             const Eigen::Matrix<double, 3, Nodes>& u, double decay,
                                             double stiffness,
                                             Eigen::Ref<Eigen::Matrix<double, 6, Points>> s) {
  Eigen::Matrix<double, 3, Nodes> force = Eigen::Matrix<double, 3, Nodes>::Zero();
  for (std::size_t g = 0; g < element.weight.size(); ++g) {
    const auto point = static_cast<Eigen::Index>(g);
    s.col(point) =
        decay * s.col(point) + stiffness * strain_deviator<Nodes>(u, element.gradient[g]);
    force += element.weight[g] * tensor(s.col(point)) * element.gradient[g].transpose();
  }
  return force;
}

}  // namespace

CreepCells::CreepCells(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                       const std::vector<double>& viscosity, const DofMap& dofs)
    : mesh_(mesh), dofs_(dofs) {
  FAULTSIM_DEMAND(viscosity.size() == materials.size(), viscosity.size(), " viscosities of ",
                  materials.size(), " materials");
  std::vector<int> place(materials.size(), -1);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto m = static_cast<std::size_t>(mesh.material[cell]);
    if (!std::isfinite(viscosity[m])) continue;
    if (place[m] < 0) {
      place[m] = static_cast<int>(materials_.size());
      materials_.push_back(mesh.material[cell]);
      shear_modulus_.push_back(shear_modulus(materials[m]));
    }
    cells_.push_back(static_cast<int>(cell));
    material_of_.push_back(place[m]);
  }
}

CreepStress CreepCells::at_rest() const {
  const Eigen::Index rows =
      Eigen::Index{6} *
      (mesh_.cells.shape() == CellShape::hexahedron ? Element::kPoints : Tetrahedron::kPoints);
  return {Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(cells_.size())),
          Eigen::MatrixXd::Zero(dofs_.n_unknowns(), static_cast<Eigen::Index>(materials_.size()))};
}

void CreepCells::advance(const Eigen::Matrix3Xd& displacement, const std::vector<MaxwellStep>& step,
                         CreepStress& stress) const {
  FAULTSIM_DEMAND(step.size() == materials_.size(), step.size(), " of ", materials_.size());
  const double scale = mesh_.plane_strain ? 1 / mesh_.thickness : 1;
  stress.force.setZero();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::span<const int> nodes = mesh_.cells[cells_[i]];
    const auto m = static_cast<std::size_t>(material_of_[i]);
    const double stiffness = 2 * shear_modulus_[m] * step[m].shear_factor;
    with_element(mesh_, cells_[i], [&](const auto& element) {
      constexpr int kNodes = std::remove_cvref_t<decltype(element)>::kNodes;
      constexpr int kPoints = std::remove_cvref_t<decltype(element)>::kPoints;
      Eigen::Matrix<double, 3, kNodes> u;
      for (int a = 0; a < kNodes; ++a) u.col(a) = displacement.col(nodes[a]);
      Eigen::Map<Eigen::Matrix<double, 6, kPoints>> s(
          stress.deviator.col(static_cast<Eigen::Index>(i)).data());
      const Eigen::Matrix<double, 3, kNodes> force =
          advance_cell<kNodes, kPoints>(element, u, step[m].decay, stiffness, s);
      for (int a = 0; a < kNodes; ++a) {
        for (int c = 0; c < 3; ++c) {
          for (const DofMap::Term& term : dofs_.terms(nodes[a], c)) {
            stress.force(term.unknown, static_cast<Eigen::Index>(m)) +=
                scale * term.coefficient * force(c, a);
          }
        }
      }
    });
  }
}

}  // namespace faultsim
